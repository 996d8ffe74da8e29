//! Progress and cancellation: one callback that every long stage takes.

use std::ops::ControlFlow;

/// A stage calls this from time to time with the fraction of its work that is done, 0 to 1.
///
/// Returning [`ControlFlow::Break`] cancels the stage, which then returns [`Cancelled`].
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// A stage stopped because its [`Progress`] callback cancelled it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, serde::Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[error("cancelled")]
pub struct Cancelled;

/// Reports `fraction`, and turns a cancellation into an error so that stages can use `?`.
pub(crate) fn report(progress: &mut Progress<'_>, fraction: f64) -> Result<(), Cancelled> {
    match progress(fraction) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Cancelled),
    }
}

/// A callback that shows nothing and never cancels.
pub fn silent(_fraction: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
