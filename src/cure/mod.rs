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
            cure.bottoms_mm[layer] = cure.solid_to_mm(layer, cure.above[layer]);
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

    /// Height down to which resin is solid below a layer, if the dose at its bottom is this.
    fn solid_to_mm(&self, layer: usize, dose: f64) -> f64 {
        let own = self.own[layer];
        let counted = own + self.retained * (dose - own);
        self.boundaries_mm[layer] - self.penetration_mm * ln(counted)
    }

    /// Dose at the bottom of a layer where all layers from it up to `end` are lit, and those above by `light`.
    fn dose(&self, layer: usize, end: usize, light: Option<Light>) -> f64 {
        let fade = self.fade(layer, end);
        let from_above = light.map_or(0.0, |light| self.fade(end, light.layer) * light.dose);
        self.above[layer] - fade * (self.above[end] - from_above)
    }

    /// Cured bottom of a column that is lit from a layer up to `end`, and above by `light`.
    pub fn bottom_mm(&self, layer: usize, end: usize, light: Option<Light>) -> f64 {
        if self.is_far(layer, end) {
            return self.bottoms_mm[layer];
        }
        self.solid_to_mm(layer, self.dose(layer, end, light))
    }

    /// Returns true if nothing is left at one boundary of a dose at a higher one.
    fn is_far(&self, low: usize, high: usize) -> bool {
        self.boundaries_mm[high] - self.boundaries_mm[low] > FAR * self.penetration_mm
    }

    /// The layer from which on a column up to `end` must be lit, so that its cured bottom is nearest to `z_mm`; at least `first`.
    pub fn first_lit(&self, first: usize, end: usize, light: Option<Light>, z_mm: f64) -> usize {
        let error_mm = |layer| self.bottom_mm(layer, end, light) - z_mm;
        let (mut best, mut layer) = ((first, error_mm(first)), first);
        let mut here_mm = best.1;
        while here_mm < 0.0 && layer + 1 < end {
            layer += 1;
            here_mm = error_mm(layer);
            if here_mm.abs() < best.1.abs() {
                best = (layer, here_mm);
            }
        }
        best.0
    }

    /// The light below a column that is lit from a layer up to `end`, and above by `light`.
    pub fn light_below(&self, layer: usize, end: usize, light: Option<Light>) -> Light {
        let dose = self.dose(layer, end, light);
        Light { layer, dose }
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
        flat_mm + self.depth_mm(self.first_lit(first, layers, None, flat_mm))
    }

    /// Depth to which a layer cures below its bottom, where all layers above it are lit.
    pub fn depth_mm(&self, layer: usize) -> f64 {
        self.boundaries_mm[layer] - self.bottoms_mm[layer]
    }
}
