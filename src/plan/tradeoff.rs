//! The inverse problem: the tolerance that gives a number of layers or a print time, and the trade-off curve of all three.

use serde::Serialize;

use super::optimal::{self, Objective};
use super::snap_cost::SnapPlanes;
use super::{Limits, Plan, PlanError};
use crate::profile::LayerErrors;
use crate::resin::Resin;

/// A point of the trade-off curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TradeoffPoint {
    /// The tolerance, in the metric's unit.
    pub tolerance: f64,
    /// Number of layers of the best plan.
    pub layers: usize,
    /// Its largest error, in the metric's unit.
    pub max_error: f64,
    /// Its print time in seconds.
    pub print_time_s: f64,
}

/// Requirement on a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// At most this number of layers.
    Layers(usize),
    /// At most this print time in seconds.
    Time(f64),
}

/// The best plans for `points` tolerances. They run from the smallest tolerance with a plan to the largest error of the
/// best plan without a tolerance, and are closer together at the lower end.
///
/// # Errors
/// [`PlanError`] if the limits allow no plan at any tolerance.
pub fn curve(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: SnapPlanes<'_>,
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
        // Quadratic spacing: closer together where tolerances are tight, and basic arithmetic alone.
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

/// The smallest tolerance with a plan that meets the goal, in the metric's unit, rounded up to six significant digits. Snap planes
/// have no say: a plan within that tolerance meets the goal if they cost nothing.
///
/// # Errors
/// [`PlanError::LayersOutOfReach`] or [`PlanError::TimeOutOfReach`] if no plan meets it; another [`PlanError`] if the limits
/// allow no plan at any tolerance.
pub fn tolerance_for(
    errors: &LayerErrors,
    limits: &Limits,
    resin: &Resin,
    goal: Goal,
) -> Result<f64, PlanError> {
    // A time needs its own objective: with the fewest layers, a looser tolerance might take longer.
    let objective = match goal {
        Goal::Layers(_) => Objective::Layers,
        Goal::Time(_) => Objective::Time(resin),
    };
    let meets = |plan: &Plan| match goal {
        Goal::Layers(layers) => plan.layers() <= layers,
        Goal::Time(time_s) => plan.print_time_s(resin) <= time_s,
    };
    // No error is this large, so there is a plan wherever layers add up.
    let loosest = optimal::within(errors, limits, SnapPlanes::NONE, objective, u64::MAX)?
        .map_err(|blocked| optimal::infeasible(&blocked, errors, limits, objective))?;
    if !meets(&loosest) {
        return Err(match goal {
            Goal::Layers(layers) => PlanError::LayersOutOfReach {
                layers,
                least_layers: loosest.layers(),
            },
            Goal::Time(time_s) => PlanError::TimeOutOfReach {
                time_s,
                least_time_s: loosest.print_time_s(resin).ceil(),
            },
        });
    }
    let most = loosest.max_error_steps(errors);
    let least = least_steps(most, |tolerance| {
        let plan = best_within(errors, limits, SnapPlanes::NONE, objective, tolerance)?;
        Ok(plan.as_ref().is_some_and(meets))
    })?;
    Ok(round_up(errors.to_value(least)))
}

/// The smallest tolerance for which there is a plan, in the metric's unit, rounded up to six significant digits.
pub fn least_tolerance(
    errors: &LayerErrors,
    limits: &Limits,
    objective: Objective<'_>,
) -> Option<f64> {
    let loosest = best_within(errors, limits, SnapPlanes::NONE, objective, u64::MAX).ok()??;
    let most = loosest.max_error_steps(errors);
    let least = least_steps(most, |tolerance| {
        Ok(best_within(errors, limits, SnapPlanes::NONE, objective, tolerance)?.is_some())
    });
    Some(round_up(errors.to_value(least.ok()?)))
}

/// The largest minimum layer thickness, below that of `limits`, for which there is a plan within the tolerance.
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
        best_within(errors, &lowered, SnapPlanes::NONE, objective, tolerance)
            .is_ok_and(|plan| plan.is_some())
    };
    let present = (limits.layer_min_mm / unit_mm).ceil() as u64;
    if present < 2 || !has_plan(1) {
        return None;
    }
    // A lower minimum allows every plan that a higher one does.
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
    snap_planes: SnapPlanes<'_>,
    objective: Objective<'_>,
    tolerance: u64,
) -> Result<Option<Plan>, PlanError> {
    Ok(optimal::within(errors, limits, snap_planes, objective, tolerance)?.ok())
}

/// The smallest number for which `holds` is true, by bisection. It must be true for `most`, and monotonic: if it is true
/// for a number, then for all larger ones.
pub(super) fn least_steps(
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

/// Rounds up to six significant digits: short, and still sufficient as a tolerance.
pub(super) fn round_up(value: f64) -> f64 {
    if value <= 0.0 {
        return value;
    }
    let mut scale = 1.0;
    while value * scale < 1e5 {
        scale *= 10.0;
    }
    ((value * scale) - 1e-9).ceil() / scale
}
