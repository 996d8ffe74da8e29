//! Print-through: cure below a layer, where nothing stops the light. See `docs/print-through.md`.
//!
//! Light fades by Jacobs' working curve, and the doses of all lit layers above a point add up. A lit layer therefore cures
//! below its bottom, the deeper the more layers are lit above it.

mod fit;

pub use fit::{Bridge, CureFit, FEWEST_BRIDGES, fit};

use std::ops::Range;

use crate::plan::Plan;
use crate::resin::{PrintThrough, Resin, exp, ln};

/// Distance over which a dose fades to nothing, in penetration depths: to 6e-6, which moves a bottom by a nanometre.
const FAR: f64 = 12.0;

/// Maximum number of tops in the table of bottoms, for each first layer.
const TABULATED_TOPS: usize = 256;

/// Number of layers among which the nearest bottom is searched at once.
const NEAREST: usize = 5;

/// Doses that the layers of a plan leave below them. A dose is a multiple of the critical one, from which on resin is solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Cure {
    boundaries_mm: Vec<f64>,
    /// Dose of each layer at its bottom.
    own: Vec<f64>,
    /// Dose at each boundary of all layers above it.
    above: Vec<f64>,
    /// White ranges without light from above, by their first layer.
    columns: Vec<Columns>,
    /// Cured bottoms of those with an end that is far.
    far_mm: Vec<f64>,
    /// Cured bottoms of those that end near.
    near_mm: Vec<f64>,
    penetration_mm: f64,
    retained: f64,
}

/// White ranges from one layer upward.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Columns {
    /// The lowest end that is far.
    far_end: usize,
    /// Index of the bottom of the lowest end; those of the others follow, up to the one that is far.
    near: usize,
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
            columns: Vec::with_capacity(layers),
            far_mm: Vec::with_capacity(layers),
            near_mm: Vec::new(),
            boundaries_mm,
            penetration_mm,
            retained: print_through.retained,
        };
        for layer in (0..layers).rev() {
            let fade = cure.fade(layer, layer + 1);
            cure.own[layer] = exposures_s[layer] / reference_s * reference * fade;
            cure.above[layer] = cure.own[layer] + fade * cure.above[layer + 1];
        }
        cure.tabulate_bottoms();
        cure
    }

    /// Computes the bottoms of white ranges without light from above.
    fn tabulate_bottoms(&mut self) {
        let layers = self.own.len();
        let mut far_end = 0;
        for first in 0..layers {
            while far_end <= layers && (far_end <= first || !self.is_far(first, far_end)) {
                far_end += 1;
            }
            let bottom_mm = |end| {
                let range = LitRange::white(first, end);
                self.solid_to_mm(range, self.dose(range, None))
            };
            let near = self.near_mm.len();
            let near_ends = first + 1..far_end.min(first + 1 + TABULATED_TOPS);
            let near_mm: Vec<f64> = near_ends.map(bottom_mm).collect();
            let far_mm = bottom_mm(layers);
            self.columns.push(Columns { far_end, near });
            self.far_mm.push(far_mm);
            self.near_mm.extend(near_mm);
        }
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
    #[inline]
    pub fn bottom_mm(&self, range: LitRange, light: Option<Light>) -> f64 {
        if range.brightness == 1.0 {
            let columns = &self.columns[range.first];
            if range.end >= columns.far_end {
                return self.far_mm[range.first];
            }
            let above = range.end - range.first - 1;
            if light.is_none() && above < TABULATED_TOPS {
                return self.near_mm[columns.near + above];
            }
        }
        self.computed_mm(range, light)
    }

    #[inline(never)]
    fn computed_mm(&self, range: LitRange, light: Option<Light>) -> f64 {
        self.solid_to_mm(range, self.dose(range, light))
    }

    /// Returns true if nothing is left at one boundary of a dose at a higher one.
    fn is_far(&self, low: usize, high: usize) -> bool {
        self.boundaries_mm[high] - self.boundaries_mm[low] > FAR * self.penetration_mm
    }

    /// The part of some layers that must be lit, so that its cured bottom is nearest to `z_mm`. Its lowest layer may be grey in this number of
    /// equal steps up to white, 1 for none.
    pub fn raised(
        &self,
        layers: Range<usize>,
        light: Option<Light>,
        z_mm: f64,
        greys: u32,
    ) -> LitRange {
        let end = layers.end;
        if greys == 1
            && let Some(first) = self.nearest_far(&layers, z_mm)
        {
            return LitRange::white(first, end);
        }
        let white = |first| LitRange::white(first, end);
        let error_mm = |range| self.bottom_mm(range, light) - z_mm;
        let mut below = layers.start;
        let mut below_mm = error_mm(white(below));
        let mut nearest = (below, below_mm.abs());
        while below_mm < 0.0 && below + 1 < end {
            let next = below + 1;
            let next_mm = error_mm(white(next));
            if next_mm.abs() < nearest.1 {
                nearest = (next, next_mm.abs());
            }
            if next_mm > 0.0 {
                break;
            }
            (below, below_mm) = (next, next_mm);
        }
        let mut nearest = (white(nearest.0), nearest.1);
        if greys > 1 && below_mm < 0.0 {
            for grey in self.greys_near(white(below), light, z_mm, greys) {
                let grey_mm = error_mm(grey).abs();
                if grey_mm < nearest.1 {
                    nearest = (grey, grey_mm);
                }
            }
        }
        nearest.0
    }

    /// The layer of [`Self::raised`] without greys, if the end is far and the layer is one of the lowest, whose bottoms rise: most are.
    /// Compares them all, as processors cannot predict where a search would end.
    #[inline]
    fn nearest_far(&self, layers: &Range<usize>, z_mm: f64) -> Option<usize> {
        let candidates = layers.start..layers.start + NEAREST;
        let bottoms_mm = self.far_mm.get(candidates.clone())?;
        let is_found = layers.end >= self.columns[candidates.end - 1].far_end
            && bottoms_mm[NEAREST - 1] > z_mm
            && bottoms_mm.is_sorted();
        let mut nearest = (layers.start, f64::INFINITY);
        for (layer, bottom_mm) in candidates.zip(bottoms_mm) {
            let error_mm = (bottom_mm - z_mm).abs();
            if error_mm < nearest.1 {
                nearest = (layer, error_mm);
            }
        }
        is_found.then_some(nearest.0)
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

    /// The light that a range, lit from above by `light`, leaves for one that ends at this layer. `None` if nothing is left there.
    pub fn light_below(&self, range: LitRange, light: Option<Light>, end: usize) -> Option<Light> {
        (!self.is_far(end, range.first)).then(|| Light {
            layer: range.first,
            dose: self.dose(range, light),
        })
    }

    /// Thickness of a layer.
    pub fn thickness_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer + 1] - self.boundaries_mm[layer]
    }

    /// Bottom of a layer.
    pub fn boundary_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer]
    }

    /// The doses by the same exposures where a resin differs from its values: penetration by 20 %, and with each the least and the largest
    /// doses below layers, of an overcure that differs by 0.02 mm, and of half or all of earlier doses. Others cure to bottoms between those.
    pub fn within(plan: &Plan, resin: &Resin) -> Vec<Self> {
        let Some(nominal) = &resin.print_through else {
            return Vec::new();
        };
        let exposures_s = resin.exposures_s(&plan.thickness_mm());
        let parts = [0.8, 1.2].into_iter();
        parts
            .flat_map(|part| [(part, -0.02, 0.5), (part, 0.02, 1.0)])
            .map(|(part, by_mm, retained)| {
                let print_through = PrintThrough {
                    overcure_mm: nominal.overcure_mm + by_mm,
                    retained,
                };
                let resin = Resin {
                    penetration_mm: part * resin.penetration_mm,
                    ..resin.clone()
                };
                Self::new(&print_through, &resin, plan.z_mm(), &exposures_s)
            })
            .collect()
    }

    /// The plane from which on layers cure down to a flat that faces down, if they are as thick as here.
    pub fn plane_mm(&self, flat_mm: f64) -> f64 {
        let layers = self.own.len();
        let first = self.boundaries_mm.partition_point(|&it| it < flat_mm);
        if first >= layers {
            return flat_mm;
        }
        flat_mm + self.depth_mm(self.raised(first..layers, None, flat_mm, 1).first)
    }

    /// Depth to which a layer cures below its bottom, where all layers above it are lit.
    pub fn depth_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer] - self.bottom_mm(LitRange::white(layer, self.own.len()), None)
    }
}
