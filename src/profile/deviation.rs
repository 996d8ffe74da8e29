//! The deviation: the greatest distance, in millimetres, from the surface of the printed stack to the model.
//!
//! The mask of a layer is sampled at its middle. From any point of its outline a path of steepest descent over the model's surface
//! leads down towards the plane below the layer, and one of steepest ascent up towards the plane above. A path that rises by dz moves
//! sideways by at most dz tan θ, where sin θ is the largest |`n_z`| over the normal cones at that height. For a layer from a to c with
//! middle m, the lower edge of its wall is therefore no farther from the model than
//!
//! > min over z from a to m of √((T(m) − T(z))² + (z − a)²), with T(z) the integral of tan θ up to z,
//!
//! and the upper edge likewise. The larger of the two bounds everything that the layer adds to the printed surface: its walls, and the
//! shelves between it and its neighbours. On an even slope it is t/2 · |`n_z`|, where a layer ends beside a flat it is the distance to
//! the flat, and it is never more than t/2, the way straight up or down to the middle.

use super::{Reach, STEPS_PER_BIN};
use crate::grid::Bins;

/// The default tolerance in millimetres: half the default cusp height, which lies on both sides of the surface.
pub const DEFAULT_TOLERANCE_MM: f64 = 0.0325;

/// Weights are rounded up to multiples of one over this.
const WEIGHT_LEVELS: u8 = 8;

/// The sideways way of paths along the height of a model, which determines the deviation of any layer.
#[derive(Debug, Clone)]
pub struct DeviationError {
    pub(super) bins: Bins,
    levels: Vec<Level>,
}

/// The surface whose weight is at least that of the level.
#[derive(Debug, Clone)]
struct Level {
    weight: f64,
    /// T at each half of a bin, from the plate upward, in bins.
    run: Vec<f64>,
}

impl Level {
    fn new(weight: f64, steepest: &[f32]) -> Self {
        // Farther than any layer is thick, so that no path leads past a flat.
        let flat = 4.0 * steepest.len() as f64 + 4.0;
        let mut run = Vec::with_capacity(2 * steepest.len() + 1);
        let mut sum = 0.0;
        run.push(sum);
        for &square in steepest {
            let square = f64::from(square);
            let tangent = if square <= 0.0 {
                0.0
            } else if square < 1.0 {
                (square / (1.0 - square)).sqrt().min(flat)
            } else {
                flat
            };
            run.push(sum + 0.5 * tangent);
            sum += tangent;
            run.push(sum);
        }
        Self { weight, run }
    }

    /// T at a number of half bins. Above the model nothing is added.
    fn run(&self, halves: usize) -> f64 {
        self.run[halves.min(self.run.len() - 1)]
    }
}

impl DeviationError {
    /// Deviations of the layers of a model from the largest `n_z²` over the normal cones in each bin: see
    /// [`super::normal_cones`]. Bins without surface have a negative value.
    pub fn new(steepest: &[f32], bins: Bins) -> Self {
        Self {
            bins,
            levels: vec![Level::new(1.0, steepest)],
        }
    }

    /// As [`Self::new`], with deviations multiplied by weights. For each of [`weight_levels`] there are the values of the surface
    /// with at least that weight.
    pub fn weighted(levels: &[(f32, Vec<f32>)], bins: Bins) -> Self {
        let levels = levels.iter();
        Self {
            bins,
            levels: levels
                .map(|(weight, steepest)| Level::new(f64::from(*weight), steepest))
                .collect(),
        }
    }

    /// The layers that begin at a boundary, held against a tolerance in steps.
    pub(super) fn above(&self, lower: u32, tolerance: u64) -> DeviationsAbove<'_> {
        // A step more, so that rounding never ends a search too early.
        let beyond = (tolerance as f64 + 1.0) / STEPS_PER_BIN;
        DeviationsAbove {
            lower,
            tolerance,
            beyond: beyond * beyond,
            levels: &self.levels,
            nearest: vec![[0; 2]; self.levels.len()],
        }
    }
}

/// The deviations of layers that begin at the same boundary, from the thinnest to the thickest.
#[derive(Debug)]
pub(super) struct DeviationsAbove<'a> {
    lower: u32,
    tolerance: u64,
    /// The square of a deviation, in bins, that is certainly beyond the tolerance.
    beyond: f64,
    levels: &'a [Level],
    /// For each level the boundaries at which the paths down and up come nearest to the edges of the wall, counted from `lower`. As
    /// layers get thicker, neither moves down: the farther the middle is, the more it costs to go past a boundary.
    nearest: Vec<[u32; 2]>,
}

impl DeviationsAbove<'_> {
    /// The layer that ends at `upper`.
    pub(super) fn up_to(&mut self, upper: u32) -> Reach {
        let mut most = 0.0;
        for (level, nearest) in self.levels.iter().zip(&mut self.nearest) {
            let weight = level.weight * level.weight;
            let below = weight * level.below(self.lower, upper, &mut nearest[0]);
            // The middle moves up as a layer grows, and the lower edge with it farther from the model.
            if below > self.beyond {
                return Reach::BeyondFromHere;
            }
            let above = weight * level.above(self.lower, upper, &mut nearest[1]);
            most = if most < below { below } else { most };
            most = if most < above { above } else { most };
        }
        if most > self.beyond {
            return Reach::Beyond;
        }
        let error = (most.sqrt() * STEPS_PER_BIN + 0.5) as u64;
        if error <= self.tolerance {
            Reach::Within(error)
        } else {
            Reach::Beyond
        }
    }
}

impl Level {
    /// The square of the deviation at the lower edge of a layer, in bins. `nearest` is that of a thinner layer, and becomes this one's.
    fn below(&self, lower: u32, upper: u32, nearest: &mut u32) -> f64 {
        let middle = lower + upper;
        let half = 0.5 * f64::from(upper - lower);
        let mut least = half * half;
        let at_middle = self.run(middle as usize);
        for rise in *nearest..=middle / 2 - lower {
            let upward = f64::from(rise * rise);
            if upward >= least {
                break;
            }
            let sideways = at_middle - self.run(2 * (lower + rise) as usize);
            let square = sideways * sideways + upward;
            if square < least {
                least = square;
                *nearest = rise;
            }
        }
        least
    }

    /// The same at the upper edge.
    fn above(&self, lower: u32, upper: u32, nearest: &mut u32) -> f64 {
        let middle = lower + upper;
        let half = 0.5 * f64::from(upper - lower);
        let mut least = half * half;
        let at_middle = self.run(middle as usize);
        for boundary in (*nearest + lower).max(middle.div_ceil(2))..=upper {
            let sideways = self.run(2 * boundary as usize) - at_middle;
            let sideways = sideways * sideways;
            if sideways >= least {
                break;
            }
            let downward = f64::from(upper - boundary);
            let square = sideways + downward * downward;
            if square < least {
                least = square;
                *nearest = boundary - lower;
            }
        }
        least
    }
}

/// The levels of weights from the least up, each with the one below: weights above that are rounded up to the level.
pub fn weight_levels() -> impl Iterator<Item = (f32, f32)> {
    let level = |number: u8| f32::from(number) / f32::from(WEIGHT_LEVELS);
    (0..WEIGHT_LEVELS).map(move |below| (level(below), level(below + 1)))
}
