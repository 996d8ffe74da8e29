//! Tolerances of a plan: that of the job, given or found, and those that models have of their own.

use super::measured::Part;
use super::parts::{Layering, Target};
use crate::plan::PlanError;
use crate::plan::optimal::{self, Objective};
use crate::plan::snap_cost::SnapPlanes;
use crate::plan::tradeoff::{self, Goal};
use crate::profile::largest::{LargestError, Strictness};
use crate::profile::{LayerErrors, Metric, Source};

/// The errors of layers under a metric, with weights and with tolerances of models' own.
pub fn errors_of(
    parts: &[Part<'_>],
    layering: &Layering,
    metric: Metric,
    source: Source,
) -> LayerErrors {
    largest(parts.iter().map(|part| {
        let errors = part.shapes.errors(metric, source);
        let strictness = match (part.tolerance, layering.target) {
            (Some(own), Target::Tolerance(of)) => {
                Strictness::new(errors.to_steps(own), errors.to_steps(of))
            }
            _ => Strictness::NONE,
        };
        (errors, strictness)
    }))
}

/// The errors of one model as they are, or the largest over several.
pub fn largest(errors: impl Iterator<Item = (LayerErrors, Strictness)>) -> LayerErrors {
    let mut errors: Vec<_> = errors.collect();
    match errors.pop() {
        Some((alone, Strictness::NONE)) if errors.is_empty() => alone,
        last => {
            errors.extend(last);
            LayerErrors::Largest(LargestError::new(errors))
        }
    }
}

/// The tolerance of the target, given or found.
pub fn tolerance(errors: &LayerErrors, layering: &Layering) -> Result<f64, PlanError> {
    let goal = match layering.target {
        Target::Tolerance(tolerance) => return Ok(tolerance),
        Target::AtLeast(usual) => {
            let limits = layering.limits(usual);
            let steps = errors.to_steps(usual);
            if optimal::within(errors, &limits, SnapPlanes::NONE, Objective::Layers, steps)?.is_ok()
            {
                return Ok(usual);
            }
            let least = tradeoff::least_tolerance(errors, &limits, Objective::Layers);
            return Ok(least.unwrap_or(usual));
        }
        Target::Layers(layers) => Goal::Layers(layers),
        Target::Time(time_s) => Goal::Time(time_s),
    };
    let limits = layering.limits(0.0);
    tradeoff::tolerance_for(errors, &limits, &layering.resin, goal)
}

/// Models that share a tolerance, and the errors of layers as these models alone decide on them.
pub struct Sharing {
    /// The model, counted from 1, if it has its own.
    pub model_number: Option<usize>,
    pub tolerance: f64,
    /// Errors of layers: those of other models are 0, or beyond every tolerance if they exceed their own.
    pub errors: LayerErrors,
    /// The same with 0 for all layers of the other models.
    pub errors_alone: LayerErrors,
}

/// The tolerances of a plan in which some models have their own, each with the models that share it.
pub fn sharing(parts: &[Part<'_>], layering: &Layering, of: f64) -> Vec<Sharing> {
    let key = |part: &Part<'_>| part.tolerance.map(|_| part.model + 1);
    let mut keys: Vec<_> = parts.iter().map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    let one = |model_number: Option<usize>| {
        let errors_with = |others: &dyn Fn(u64) -> u64| {
            largest(parts.iter().map(|part| {
                let errors = part.shapes.errors(layering.metric, layering.source);
                let strictness = if key(part) == model_number {
                    Strictness::NONE
                } else {
                    let own = errors.to_steps(part.tolerance.unwrap_or(of));
                    Strictness::within_or_not(others(own))
                };
                (errors, strictness)
            }))
        };
        let own = parts.iter().find(|part| key(part) == model_number);
        Sharing {
            model_number,
            tolerance: own.and_then(|part| part.tolerance).unwrap_or(of),
            errors: errors_with(&|own| own),
            errors_alone: errors_with(&|_| u64::MAX),
        }
    };
    keys.into_iter().map(one).collect()
}
