//! The stages of the work, their order and their share of a task's time.

use std::ops::ControlFlow;

use serde::Serialize;
use web_time::Instant;

use crate::ldi::LdiError;
use crate::progress::Cancelled;

/// A part of the work, for showing progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Reading the model.
    Load,
    /// Finding what stands out.
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
        }
    }
}

/// Called with the stage at work and the fraction of it that is done; `Break` cancels.
pub type StageProgress<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

/// Something that a user waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// Reading a model.
    Load,
    /// Planning layers, with everything that a plan needs.
    Plan,
    /// Writing a print file.
    Export,
    /// Searching for the best orientation.
    Orient,
}

impl Task {
    /// The stages of the task in their order, each with its share of the time. Shares add up to 1: rays are most of a plan,
    /// whatever the model and the machine.
    pub fn stages(self) -> &'static [(Stage, f64)] {
        match self {
            Self::Load => &[(Stage::Load, 1.0)],
            Self::Plan => &[
                (Stage::Load, 0.05),
                (Stage::Saliency, 0.05),
                (Stage::Ldi, 0.7),
                (Stage::Profile, 0.1),
                (Stage::Plan, 0.1),
            ],
            Self::Export => &[(Stage::Masks, 1.0)],
            Self::Orient => &[(Stage::Saliency, 0.05), (Stage::Orientation, 0.95)],
        }
    }

    /// How much of the task is done, from 0 to 1, when `fraction` of a stage is; `None` for a stage of another task.
    pub fn done(self, stage: Stage, fraction: f64) -> Option<f64> {
        let mut before = 0.0;
        for &(other, share) in self.stages() {
            if other == stage {
                return Some(before + share * fraction.clamp(0.0, 1.0));
            }
            before += share;
        }
        None
    }
}

/// Reports that `fraction` of a stage is done, and turns a wish to stop into an error.
pub(super) fn report(
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
pub(super) fn ms_since(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64() * 1e3
}
