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
//! shelves between it and its neighbours. On an even slope it is t/2 · |`n_z`|, for a layer that ends next to a flat it
//! is the distance to the flat, and it is never more than t/2, the way straight up or down to the middle.

use super::{ErrorRule, Reach, Row, STEPS_PER_BIN};
use crate::grid::Bins;

/// The row of the deviation. The default tolerance is half the default cusp height, which lies on both sides of the surface.
pub(super) const ROW: Row = Row {
    name: "deviation",
    unit: "mm",
    default_tolerance: 0.0325,
    tolerances: [0.0005, 0.5],
    greatest_density: Some(1.0),
    is_distance: true,
    error: ErrorRule::Deviation,
};

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
    /// tan θ in each bin.
    tangents: Vec<f64>,
    /// T at each boundary, in bins.
    run: Vec<f64>,
    /// The largest and the smallest tan θ of the [`WINDOW`] bins from each bin upward.
    largest_ahead: Vec<f64>,
    smallest_ahead: Vec<f64>,
}

/// Bins that a search for the nearest point of a path may leave out at once.
const WINDOW: u32 = 32;

/// The tangent of a flat in a model of `bins` bins: farther than any layer is thick, so that no path leads past it.
fn flat(bins: usize) -> f64 {
    4.0 * bins as f64 + 4.0
}

impl Level {
    fn new(weight: f64, steepest: &[f32]) -> Self {
        let flat = flat(steepest.len());
        let tangents: Vec<f64> = steepest
            .iter()
            .map(|&square| {
                let square = f64::from(square);
                if square <= 0.0 {
                    0.0
                } else if square < 1.0 {
                    (square / (1.0 - square)).sqrt().min(flat)
                } else {
                    flat
                }
            })
            .collect();
        Self::of_tangents(weight, tangents)
    }

    fn of_tangents(weight: f64, tangents: Vec<f64>) -> Self {
        let mut sum = 0.0;
        let mut run = vec![sum];
        run.extend(tangents.iter().map(|tangent| {
            sum += tangent;
            sum
        }));
        Self {
            weight,
            run,
            largest_ahead: ahead(&tangents, |a, b| if a < b { b } else { a }),
            smallest_ahead: ahead(&tangents, |a, b| if b < a { b } else { a }),
            tangents,
        }
    }

    fn split(&self, parts: usize) -> Self {
        let [was, is] = [1, parts].map(|parts| flat(self.tangents.len() * parts));
        let tangents = self.tangents.iter().flat_map(|&tangent| {
            let tangent = if tangent < was { tangent } else { is };
            std::iter::repeat_n(tangent, parts)
        });
        Self::of_tangents(self.weight, tangents.collect())
    }

    /// T at a boundary. Above the model nothing is added.
    fn run(&self, boundary: u32) -> f64 {
        self.run[(boundary as usize).min(self.tangents.len())]
    }

    /// T at a number of half bins.
    #[inline]
    fn run_at_half(&self, halves: u32) -> f64 {
        let bin = halves / 2;
        let half = f64::from(halves % 2) * 0.5;
        self.run(bin) + half * self.tangents.get(bin as usize).copied().unwrap_or(0.0)
    }

    /// The square of the deviation at the lower edge of a layer, in bins. `nearest` is the place of the nearest boundary, counted
    /// from `lower`, for a thinner layer, and becomes that for this one.
    fn below(&self, lower: u32, upper: u32, nearest: &mut u32) -> f64 {
        let middle = lower + upper;
        let half = 0.5 * f64::from(upper - lower);
        let mut least = half * half;
        let at_middle = self.run_at_half(middle);
        for rise in *nearest..=middle / 2 - lower {
            let upward = f64::from(rise);
            if upward * upward >= least {
                break;
            }
            let boundary = lower + rise;
            let sideways = at_middle - self.run(boundary);
            let square = sideways * sideways + upward * upward;
            if square < least {
                least = square;
                *nearest = rise;
            } else if value_at(&self.largest_ahead, boundary) * sideways <= upward {
                // However level the path is ahead, it comes no nearer there.
                let beyond = f64::from(rise + WINDOW);
                if beyond * beyond >= least {
                    break;
                }
            }
        }
        least
    }

    /// The same at the upper edge.
    fn above(&self, lower: u32, upper: u32, nearest: &mut u32) -> f64 {
        let middle = lower + upper;
        let half = 0.5 * f64::from(upper - lower);
        let mut least = half * half;
        let at_middle = self.run_at_half(middle);
        for boundary in (*nearest + lower).max(middle.div_ceil(2))..=upper {
            let sideways = self.run(boundary) - at_middle;
            if sideways * sideways >= least {
                break;
            }
            let downward = f64::from(upper - boundary);
            let square = sideways * sideways + downward * downward;
            if square < least {
                least = square;
                *nearest = boundary - lower;
            } else if upper - boundary <= WINDOW
                && value_at(&self.smallest_ahead, boundary) * sideways >= downward
            {
                // However steep the path is ahead, it comes no nearer there.
                break;
            }
        }
        least
    }
}

/// The value of a bin; 0 above the model.
fn value_at(values: &[f64], bin: u32) -> f64 {
    values.get(bin as usize).copied().unwrap_or(0.0)
}

/// For each value the largest, or whatever `choose` chooses, of the [`WINDOW`] values from it on, with 0 above the model: blocks are run through from both ends,
/// and each window is the end of one and the beginning of the next.
fn ahead(values: &[f64], choose: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let window = WINDOW as usize;
    let mut ends = values.to_vec();
    let mut beginnings = values.to_vec();
    for block in ends.chunks_mut(window) {
        for place in (1..block.len()).rev() {
            block[place - 1] = choose(block[place - 1], block[place]);
        }
    }
    for block in beginnings.chunks_mut(window) {
        for place in 1..block.len() {
            block[place] = choose(block[place - 1], block[place]);
        }
    }
    for (place, value) in ends.iter_mut().enumerate() {
        let last = place + window - 1;
        *value = choose(*value, beginnings[last.min(values.len() - 1)]);
        if last >= values.len() {
            *value = choose(*value, 0.0);
        }
    }
    ends
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

    /// The same in finer bins: see [`LayerErrors::split`](super::LayerErrors::split).
    pub(super) fn split(&self, parts: usize) -> Self {
        Self {
            bins: self.bins.split(parts),
            levels: self.levels.iter().map(|it| it.split(parts)).collect(),
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
            nearest: [[0; 2]; WEIGHT_LEVELS as usize],
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
    nearest: [[u32; 2]; WEIGHT_LEVELS as usize],
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

/// The levels of weights from the least up, each with the one below: weights above that are rounded up to the level.
pub fn weight_levels() -> impl Iterator<Item = (f32, f32)> {
    let level = |number: u8| f32::from(number) / f32::from(WEIGHT_LEVELS);
    (0..WEIGHT_LEVELS).map(move |below| (level(below), level(below + 1)))
}
