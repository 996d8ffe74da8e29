//! The other way round: from layers or time to the tolerance, and the curve of all three.

use serde::Serialize;

use super::optimal::{self, Objective};
use super::{Limits, Plan, PlanError};
use crate::profile::LayerErrors;
use crate::resin::Resin;

/// A point of the trade-off curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TradeoffPoint {
    /// The tolerance, in the metric's unit.
    pub tolerance: f64,
    /// Layers of the best plan.
    pub layers: usize,
    /// Its largest error, in the metric's unit.
    pub max_error: f64,
    /// Its time in seconds.
    pub print_time_s: f64,
}

/// What a plan must come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// At most so many layers.
    Layers(usize),
    /// At most so many seconds.
    Time(f64),
}

/// Best plans for `points` tolerances, from the least that there is a plan for to the least of the plan with the fewest
/// layers, closer together at the lower end.
///
/// # Errors
/// [`PlanError`] for limits that no tolerance makes good.
pub fn curve(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
    resin: &Resin,
    points: usize,
) -> Result<Vec<TradeoffPoint>, PlanError> {
    let loosest = best_within(errors, limits, snap_planes, objective, u64::MAX)?;
    let Some(loosest) = loosest else {
        return Ok(Vec::new());
    };
    let most = loosest.max_error_steps(errors).max(1);
    let least = least_steps(most, |tolerance| {
        Ok(best_within(errors, limits, snap_planes, objective, tolerance)?.is_some())
    })?;
    let last = points.max(2) - 1;
    let mut curve = Vec::with_capacity(last + 1);
    for point in 0..=last {
        // Closer together where tolerances are tight, and by basic arithmetic alone.
        let part = point as f64 / last as f64;
        let tolerance = least + ((most - least) as f64 * (part * part)) as u64;
        let Some(plan) = best_within(errors, limits, snap_planes, objective, tolerance)? else {
            continue;
        };
        curve.push(TradeoffPoint {
            tolerance: errors.to_value(tolerance),
            layers: plan.layers(),
            max_error: plan.max_error(errors),
            print_time_s: plan.print_time_s(resin),
        });
    }
    Ok(curve)
}

/// The least tolerance whose best plan meets the goal, in the metric's unit, rounded up to six digits.
///
/// # Errors
/// [`PlanError::OutOfReach`] if none does; [`PlanError`] for limits that no tolerance makes good.
pub fn tolerance_for(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    resin: &Resin,
    goal: Goal,
) -> Result<f64, PlanError> {
    // The shortest time needs its own objective, or a looser tolerance might take longer.
    let objective = match goal {
        Goal::Layers(_) => Objective::Layers,
        Goal::Time(_) => Objective::Time(resin),
    };
    let meets = |plan: &Plan| match goal {
        Goal::Layers(layers) => plan.layers() <= layers,
        Goal::Time(time_s) => plan.print_time_s(resin) <= time_s,
    };
    let loosest = best_within(errors, limits, snap_planes, objective, u64::MAX)?;
    let Some(loosest) = loosest.as_ref().filter(|plan| meets(plan)) else {
        let (wanted, least) = match (goal, loosest) {
            (Goal::Layers(layers), plan) => (
                format!("at most {layers} layers"),
                plan.map_or(String::new(), |plan| format!("{} layers", plan.layers())),
            ),
            (Goal::Time(time_s), plan) => (
                format!("a time of at most {time_s} s"),
                plan.map_or(String::new(), |plan| {
                    format!("{} s", plan.print_time_s(resin).ceil())
                }),
            ),
        };
        return Err(PlanError::OutOfReach { wanted, least });
    };
    let most = loosest.max_error_steps(errors);
    let least = least_steps(most, |tolerance| {
        let plan = best_within(errors, limits, snap_planes, objective, tolerance)?;
        Ok(plan.as_ref().is_some_and(meets))
    })?;
    Ok(round_up(errors.to_value(least)))
}

/// The least tolerance for which there is a plan, in the metric's unit, rounded up to six digits.
pub fn least_tolerance(
    errors: &LayerErrors,
    limits: &Limits,
    objective: Objective<'_>,
) -> Option<f64> {
    let loosest = best_within(errors, limits, &[], objective, u64::MAX).ok()??;
    let most = loosest.max_error_steps(errors);
    let least = least_steps(most, |tolerance| {
        Ok(best_within(errors, limits, &[], objective, tolerance)?.is_some())
    });
    Some(round_up(errors.to_value(least.ok()?)))
}

/// The largest least layer thickness, below that of `limits`, for which there is a plan within their tolerance.
pub fn largest_layer_min_mm(
    errors: &LayerErrors,
    limits: &Limits,
    objective: Objective<'_>,
) -> Option<f64> {
    let bins = errors.bins();
    let unit_mm = f64::from(limits.unit(bins).ok()?) * bins.size_mm;
    let tolerance = errors.to_steps(limits.tolerance);
    let has_plan = |units: u64| {
        let lowered = Limits {
            layer_min_mm: units as f64 * unit_mm,
            ..limits.clone()
        };
        best_within(errors, &lowered, &[], objective, tolerance).is_ok_and(|plan| plan.is_some())
    };
    let present = (limits.layer_min_mm / unit_mm).ceil() as u64;
    if present < 2 || !has_plan(1) {
        return None;
    }
    // Thinner layers allow all that thicker ones do.
    let (mut good, mut bad) = (1, present);
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if has_plan(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Some((good as f64 * unit_mm * 1e6).round() / 1e6)
}

fn best_within(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
    tolerance: u64,
) -> Result<Option<Plan>, PlanError> {
    Ok(optimal::within(errors, limits, snap_planes, objective, tolerance)?.ok())
}

/// The least number up to `most`, for which it holds, for which `holds` does; it then holds for all larger ones.
fn least_steps(
    most: u64,
    mut holds: impl FnMut(u64) -> Result<bool, PlanError>,
) -> Result<u64, PlanError> {
    let (mut low, mut high) = (0, most);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle)? {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Ok(high)
}

/// The number rounded up to six digits, so that it is short and still enough.
fn round_up(value: f64) -> f64 {
    if value <= 0.0 {
        return value;
    }
    let mut scale = 1.0;
    while value * scale < 1e5 {
        scale *= 10.0;
    }
    ((value * scale) - 1e-9).ceil() / scale
}
