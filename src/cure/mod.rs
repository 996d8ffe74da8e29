//! Print-through: cure below a layer, where nothing stops the light. See `docs/print-through.md`.
//!
//! Light fades by Jacobs' working curve, and the doses of all lit layers above a point add up. A lit layer therefore cures
//! below its bottom, the deeper the more layers are lit above it.

mod fit;

pub use fit::{Bridge, CureFit, FEWEST_BRIDGES, fit};

use crate::plan::Plan;
use crate::resin::{PrintThrough, Resin, exp, ln};

/// Distance over which a dose fades to nothing, in penetration depths: to 1e-13.
const FAR: f64 = 30.0;

/// Doses that the layers of a plan leave below them. A dose is a multiple of the critical one, from which on resin is solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Cure {
    boundaries_mm: Vec<f64>,
    /// Dose of each layer at its bottom.
    own: Vec<f64>,
    /// Dose at each boundary of all layers above it.
    above: Vec<f64>,
    /// Cured bottom of each layer where all layers above it are lit.
    bottoms_mm: Vec<f64>,
    penetration_mm: f64,
    retained: f64,
}

/// Lit layers of a column without a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitRange {
    /// The lowest layer.
    pub first: usize,
    /// Fraction of that layer's light: less than 1 where it is grey.
    pub brightness: f64,
    /// The first dark layer above.
    pub end: usize,
}

impl LitRange {
    /// A range without grey.
    pub fn white(first: usize, end: usize) -> Self {
        Self {
            first,
            brightness: 1.0,
            end,
        }
    }
}

/// Light that reaches a range of a column from the lit layers above it.
#[derive(Debug, Clone, Copy)]
pub struct Light {
    /// The lowest lit layer above.
    layer: usize,
    /// Dose at its bottom.
    dose: f64,
}

impl Cure {
    /// The doses of a plan's layers by the exposures of a resin. `None` if the resin states no print-through.
    ///
    /// Cost: linear in layers.
    pub fn of_plan(plan: &Plan, resin: &Resin) -> Option<Self> {
        let print_through = resin.print_through.as_ref()?;
        let boundaries_mm = plan.z_mm();
        let exposures_s = resin.exposures_s(&plan.thickness_mm());
        Some(Self::new(print_through, resin, boundaries_mm, &exposures_s))
    }

    /// The doses of layers between these boundaries, from the plate upward, with these exposures.
    pub fn new(
        print_through: &PrintThrough,
        resin: &Resin,
        boundaries_mm: Vec<f64>,
        exposures_s: &[f64],
    ) -> Self {
        let penetration_mm = resin.penetration_mm;
        let reference_s = resin.exposure_s(resin.layer_mm);
        let depth_mm = resin.layer_mm + print_through.overcure_mm;
        let reference = exp(depth_mm / penetration_mm);
        let layers = exposures_s.len();
        let mut cure = Self {
            own: vec![0.0; layers],
            above: vec![0.0; layers + 1],
            bottoms_mm: vec![0.0; layers],
            boundaries_mm,
            penetration_mm,
            retained: print_through.retained,
        };
        for layer in (0..layers).rev() {
            let fade = cure.fade(layer, layer + 1);
            cure.own[layer] = exposures_s[layer] / reference_s * reference * fade;
            cure.above[layer] = cure.own[layer] + fade * cure.above[layer + 1];
            let range = LitRange::white(layer, layers);
            cure.bottoms_mm[layer] = cure.solid_to_mm(range, cure.above[layer]);
        }
        cure
    }

    /// Fraction of a dose at one boundary that is left at a lower one.
    fn fade(&self, low: usize, high: usize) -> f64 {
        if self.is_far(low, high) {
            return 0.0;
        }
        exp((self.boundaries_mm[low] - self.boundaries_mm[high]) / self.penetration_mm)
    }

    /// Height down to which resin is solid below a range, if the dose at its bottom is this.
    fn solid_to_mm(&self, range: LitRange, dose: f64) -> f64 {
        let own = range.brightness * self.own[range.first];
        let counted = own + self.retained * (dose - own);
        self.boundaries_mm[range.first] - self.penetration_mm * ln(counted)
    }

    /// Dose at the bottom of a range that is lit from above by `light`.
    fn dose(&self, range: LitRange, light: Option<Light>) -> f64 {
        let LitRange { first, end, .. } = range;
        let fade = self.fade(first, end);
        let from_above = light.map_or(0.0, |light| self.fade(end, light.layer) * light.dose);
        let white = self.above[first] - fade * (self.above[end] - from_above);
        white - (1.0 - range.brightness) * self.own[first]
    }

    /// Cured bottom of a range that is lit from above by `light`.
    pub fn bottom_mm(&self, range: LitRange, light: Option<Light>) -> f64 {
        if range.brightness == 1.0 && self.is_far(range.first, range.end) {
            return self.bottoms_mm[range.first];
        }
        self.solid_to_mm(range, self.dose(range, light))
    }

    /// Returns true if nothing is left at one boundary of a dose at a higher one.
    fn is_far(&self, low: usize, high: usize) -> bool {
        self.boundaries_mm[high] - self.boundaries_mm[low] > FAR * self.penetration_mm
    }

    /// The part of a range that must be lit, so that its cured bottom is nearest to `z_mm`. Its lowest layer may be grey in this number of
    /// equal steps up to white, 1 for none.
    pub fn raised(&self, range: LitRange, light: Option<Light>, z_mm: f64, greys: u32) -> LitRange {
        let from = |first| LitRange::white(first, range.end);
        let error_mm = |first| self.bottom_mm(from(first), light) - z_mm;
        let (mut below, mut below_mm) = (range.first, error_mm(range.first));
        let mut next = None;
        while below_mm < 0.0 && below + 1 < range.end {
            let next_mm = error_mm(below + 1);
            if next_mm > 0.0 {
                next = Some((from(below + 1), next_mm));
                break;
            }
            (below, below_mm) = (below + 1, next_mm);
        }
        let mut nearest = (from(below), below_mm.abs());
        let greys = (greys > 1 && below_mm < 0.0)
            .then(|| self.greys_near(from(below), light, z_mm, greys))
            .into_iter()
            .flatten()
            .map(|it| (it, (self.bottom_mm(it, light) - z_mm).abs()));
        for other in next.into_iter().chain(greys) {
            if other.1 < nearest.1 {
                nearest = other;
            }
        }
        nearest.0
    }

    /// The range with the two greys in its lowest layer between which the dose at `z_mm` is the critical one, except for black and white, and
    /// for those too dark to cure at the film.
    fn greys_near(
        &self,
        range: LitRange,
        light: Option<Light>,
        z_mm: f64,
        greys: u32,
    ) -> impl Iterator<Item = LitRange> {
        let own = self.own[range.first];
        let others = self.retained * (self.dose(range, light) - own);
        let wanted = exp((self.boundaries_mm[range.first] - z_mm) / self.penetration_mm);
        let steps = f64::from(greys);
        let darker = ((wanted - others) / own * steps).floor();
        let at_film = own * exp(self.thickness_mm(range.first) / self.penetration_mm);
        let has_above = range.first + 1 < range.end;
        let cures = move |grey: f64| has_above || grey / steps * at_film >= 1.0;
        let greys = [darker, darker + 1.0].into_iter();
        greys
            .filter(move |grey| (1.0..steps).contains(grey) && cures(*grey))
            .map(move |grey| LitRange {
                brightness: grey / steps,
                ..range
            })
    }

    /// The light below a range that is lit from above by `light`.
    pub fn light_below(&self, range: LitRange, light: Option<Light>) -> Light {
        Light {
            layer: range.first,
            dose: self.dose(range, light),
        }
    }

    /// Thickness of a layer.
    pub fn thickness_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer + 1] - self.boundaries_mm[layer]
    }

    /// Bottom of a layer.
    pub fn boundary_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer]
    }

    /// The doses by the same exposures at the ends of the intervals in which a resin's values are known.
    pub fn within(plan: &Plan, resin: &Resin) -> Vec<Self> {
        let Some(nominal) = &resin.print_through else {
            return Vec::new();
        };
        let exposures_s = resin.exposures_s(&plan.thickness_mm());
        let mut cures = Vec::new();
        for part in [0.8, 1.2] {
            for overcure_mm in [nominal.overcure_mm - 0.02, nominal.overcure_mm + 0.02] {
                for retained in [0.5, 1.0] {
                    let print_through = PrintThrough {
                        overcure_mm,
                        retained,
                    };
                    let resin = Resin {
                        penetration_mm: part * resin.penetration_mm,
                        ..resin.clone()
                    };
                    cures.push(Self::new(&print_through, &resin, plan.z_mm(), &exposures_s));
                }
            }
        }
        cures
    }

    /// The plane from which on layers cure down to a flat that faces down, if they are as thick as here.
    pub fn plane_mm(&self, flat_mm: f64) -> f64 {
        let layers = self.own.len();
        let first = self.boundaries_mm.partition_point(|&it| it < flat_mm);
        if first >= layers {
            return flat_mm;
        }
        flat_mm
            + self.depth_mm(
                self.raised(LitRange::white(first, layers), None, flat_mm, 1)
                    .first,
            )
    }

    /// Depth to which a layer cures below its bottom, where all layers above it are lit.
    pub fn depth_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer] - self.bottoms_mm[layer]
    }
}
