//! How much work a plan is, before it is made.

use super::parts::{Layering, Target, Thicknesses};
use super::{Error, Minimize, Planner};
use crate::grid::Bins;
use crate::plan::timed::MOST_BOTTOM_LAYERS;
use crate::profile::Metric;

/// Layers whose errors a processor measures in a second, at most.
const LAYERS_PER_S: f64 = 1e9;
/// Plans that a search for a tolerance comes to, without those that end early.
const SEARCHES: f64 = 20.0;

/// Checks that a plan in these bins takes no more than this processor time.
///
/// # Errors
/// [`Error::TimeBound`].
pub fn check(bins: Bins, layering: &Layering, allowed_s: f64) -> Result<(), Error> {
    let needed_s = layers_to_measure(bins, layering) / LAYERS_PER_S;
    if needed_s <= allowed_s {
        return Ok(());
    }
    Err(Error::TimeBound {
        needed_s: needed_s.ceil(),
        allowed_s,
    })
}

/// How often a planner measures the error of a layer: bins times thicknesses, unless the fewest layers are wanted under a metric
/// that adds up.
fn layers_to_measure(bins: Bins, layering: &Layering) -> f64 {
    let limits = layering.limits(0.0);
    let (Ok(unit), Ok(thickness)) = (
        limits.unit(bins),
        limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm),
    ) else {
        // The plan says what is wrong.
        return 0.0;
    };
    let planes = bins.count as f64 / f64::from(unit);
    let is_found_by_time = matches!(layering.target, Target::Time(_));
    let is_by_time = is_found_by_time || layering.minimize == Minimize::Time;
    let adds_up = !matches!(layering.metric, Metric::Volume | Metric::Deviation);
    let is_any = layering.thicknesses == Thicknesses::Any;
    let is_optimal = layering.planner == Planner::Optimal;
    let is_linear = is_any && adds_up && !is_by_time || !is_optimal;
    let thicknesses = f64::from(thickness.end() - thickness.start() + 1).min(planes);
    // The layers above a plane end at the top.
    let layers = if is_linear {
        planes
    } else {
        (planes - thicknesses / 2.0) * thicknesses
    };
    // What a layer costs depends on how many bottom layers are below it.
    let of_bottom = if is_by_time {
        layering.resin.bottom_layers.min(MOST_BOTTOM_LAYERS) as f64 + 1.0
    } else {
        1.0
    };
    let searches = match layering.target {
        Target::Tolerance(_) => 1.0,
        Target::AtLeast(_) | Target::Layers(_) | Target::Time(_) => SEARCHES,
    };
    layers * of_bottom * searches
}
