//! Small random models with random limits, and every plan that the limits allow.

use cusp_slicer::plan::segment::Segments;
use cusp_slicer::plan::{HeightRange, Limits, Plan, PlanError};
use cusp_slicer::profile::LayerErrors;

use super::{limits, random_errors};
use crate::common::bins;
use crate::common::oracle::Rules;

/// A model of bins of 1 mm with limits.
pub struct Case {
    pub count: usize,
    pub errors: LayerErrors,
    pub limits: Limits,
    /// The limits in bins.
    pub rules: Rules,
    /// Text that is shown when a test fails.
    pub text: String,
}

/// A model of at most `most` bins, under any kind of errors and limits.
pub fn random(random: &mut fastrand::Rng, most: usize) -> Case {
    let count = random.usize(1..=most);
    let (errors, text) = random_errors(random, count);
    let least = random.usize(1..=3);
    let greatest = least + random.usize(0..=3);
    let tolerance = f64::from(random.u32(1..=40)) / 10.0;
    let mut limits = limits(least as f64, greatest as f64, tolerance);
    let mut rules = Rules::plain(count, (least, greatest));
    if random.u8(0..4) == 0 {
        limits.step_mm = Some(2.0);
        rules.step = 2;
    }
    if random.u8(0..4) == 0 && count > 2 {
        let plane = random.usize(1..count) / rules.step * rules.step;
        if plane > 0 {
            limits.planes_mm = vec![plane as f64];
            rules.planes = vec![plane];
        }
    }
    // It may be outside the range of thicknesses, or too thick for the plane above it.
    let first_layer = random.usize(1..=5).next_multiple_of(rules.step);
    if random.u8(0..4) == 0 && count > first_layer {
        limits.first_layer_mm = Some(first_layer as f64);
        rules.first_layer = first_layer;
    }
    if random.u8(0..4) == 0 && count > 4 {
        let (from, to) = (2, 4);
        let (least, greatest) = (random.usize(1..=2), random.usize(2..=3));
        limits.ranges = vec![HeightRange {
            from_mm: from as f64,
            to_mm: to as f64,
            layer_min_mm: least as f64,
            layer_max_mm: greatest as f64,
        }];
        let ends = [from, to].into_iter();
        let above_first = ends.filter(|&end| end >= rules.first_layer);
        rules.planes.extend(above_first);
        rules.thickness[from..to].fill((least, greatest));
    }
    let text = format!("{text} {limits:?}");
    Case {
        count,
        errors,
        limits,
        rules,
        text,
    }
}

impl Case {
    /// The top of a plan of any thicknesses, if limits allow one.
    pub fn top(&self) -> Result<u32, PlanError> {
        let segments = Segments::new(bins(self.count), &self.limits, &[])?.segments;
        Ok(segments[segments.len() - 1].upper())
    }

    /// The boundaries of every plan within limits and tolerance that ends at a height, found by trying every set of planes.
    pub fn plans_to(&self, top: u32) -> Vec<Vec<u32>> {
        let tolerance = self.errors.to_steps(self.limits.tolerance);
        let is_possible = |layer: &[u32]| {
            let (below, above) = (layer[0] as usize, layer[1] as usize);
            if below == 0 && self.rules.first_layer > 0 {
                return above == self.rules.first_layer;
            }
            let Some(&(least, greatest)) = self.rules.thickness.get(below) else {
                return false;
            };
            (least..=greatest).contains(&(above - below))
                && above.is_multiple_of(self.rules.step)
                && self.errors.steps_between(layer[0], layer[1]) <= tolerance
        };
        (0..1u32 << (top - 1))
            .map(|planes| {
                let within = (1..top).filter(|plane| planes >> (plane - 1) & 1 == 1);
                std::iter::once(0).chain(within).chain([top]).collect()
            })
            .filter(|plan: &Vec<u32>| {
                let mut demanded = self.rules.planes.iter();
                demanded.all(|&plane| plan.contains(&(plane as u32)))
                    && plan.windows(2).all(is_possible)
            })
            .collect()
    }

    /// The boundaries of the layers that the tolerance covers.
    pub fn covered<'a>(&self, boundaries: &'a [u32]) -> &'a [u32] {
        &boundaries[usize::from(self.rules.first_layer > 0)..]
    }

    /// The sum of the errors of a plan's layers, and the largest of them, in steps.
    pub fn sum_and_worst(&self, boundaries: &[u32]) -> (u64, u64) {
        let layers = self.covered(boundaries).windows(2);
        let errors = layers.map(|layer| self.errors.steps_between(layer[0], layer[1]));
        let errors: Vec<u64> = errors.collect();
        (
            errors.iter().sum(),
            errors.iter().copied().max().unwrap_or(0),
        )
    }

    /// Layers and largest error of a plan.
    pub fn layers_and_worst(&self, boundaries: &[u32]) -> (usize, u64) {
        (boundaries.len() - 1, self.sum_and_worst(boundaries).1)
    }
}

/// The thicknesses between boundaries.
pub fn thicknesses(boundaries: &[u32]) -> Vec<u32> {
    boundaries
        .windows(2)
        .map(|layer| layer[1] - layer[0])
        .collect()
}

/// Asserts that a planner kept no snap planes, which it was not given.
pub fn assert_without_snap_planes(plan: &Plan) {
    assert!(plan.snap_planes.is_empty(), "{plan:?}");
}
