//! The stages of a job, and progress through them.

use std::ops::ControlFlow;

use serde::Serialize;
use web_time::Instant;

use crate::ldi::LdiError;
use crate::progress::Cancelled;

/// A stage of a job, for showing progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Reading the model.
    Load,
    /// Computing saliency.
    Saliency,
    /// Searching for the best orientation.
    Orientation,
    /// Sampling the layered depth image.
    Ldi,
    /// Making the profile.
    Profile,
    /// Planning.
    Plan,
    /// Making and writing the masks.
    Masks,
    /// Checking the masks.
    Inspect,
}

impl Stage {
    /// The name of the stage, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Saliency => "saliency",
            Self::Orientation => "orientation",
            Self::Ldi => "ldi",
            Self::Profile => "profile",
            Self::Plan => "plan",
            Self::Masks => "masks",
            Self::Inspect => "inspect",
        }
    }

    /// The fraction of the whole task that is done, 0 to 1, when `fraction` of this stage is done. Reading, searching and
    /// writing are tasks of one stage each.
    pub fn done(self, fraction: f64) -> f64 {
        let fraction = fraction.clamp(0.0, 1.0);
        let Some(place) = PLANNING.iter().position(|&(stage, _)| stage == self) else {
            return fraction;
        };
        let before: f64 = PLANNING[..place].iter().map(|&(_, share)| share).sum();
        before + PLANNING[place].1 * fraction
    }
}

/// The stages of planning in order, with the share of the time that each takes. Rays take most of it, on any model and
/// machine.
const PLANNING: [(Stage, f64); 4] = [
    (Stage::Saliency, 0.0625),
    (Stage::Ldi, 0.75),
    (Stage::Profile, 0.0625),
    (Stage::Plan, 0.125),
];

/// Called with the current stage and the fraction of it that is done. [`ControlFlow::Break`] cancels.
pub type StageProgress<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

/// Reports that `fraction` of a stage is done, and turns a cancellation into an error.
pub(in crate::job) fn report(
    progress: &mut StageProgress<'_>,
    stage: Stage,
    fraction: f64,
) -> Result<(), LdiError> {
    match progress(stage, fraction) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(LdiError::Cancelled(Cancelled)),
    }
}

/// Milliseconds since `clock` was started.
pub(in crate::job) fn ms_since(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planning_runs_from_zero_to_one_without_a_gap() {
        let mut done = 0.0;
        for (stage, _) in PLANNING {
            assert_eq!(stage.done(0.0).to_bits(), f64::to_bits(done), "{stage:?}");
            assert!(stage.done(0.5) > done);
            done = stage.done(1.0);
        }
        assert_eq!(done.to_bits(), 1f64.to_bits());
    }

    #[test]
    fn a_stage_that_is_a_task_by_itself_counts_alone() {
        for stage in [Stage::Load, Stage::Orientation, Stage::Masks] {
            assert_eq!(stage.done(0.25).to_bits(), 0.25f64.to_bits());
            assert_eq!(stage.done(7.0).to_bits(), 1f64.to_bits());
        }
    }
}
