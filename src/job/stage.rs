//! The stages of the work, and progress through them.

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
