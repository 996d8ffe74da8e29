//! Progress out, cancellation in: one callback shared by every long stage.

use std::ops::ControlFlow;

/// Called by a stage now and then with the fraction of its work that is done, 0 to 1.
///
/// Returning [`ControlFlow::Break`] asks the stage to stop; it then returns [`Cancelled`].
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// A stage stopped because its [`Progress`] callback asked for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, serde::Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[error("cancelled")]
pub struct Cancelled;

/// Reports `fraction` and turns a wish to stop into an error, so that stages can use `?`.
pub(crate) fn report(progress: &mut Progress<'_>, fraction: f64) -> Result<(), Cancelled> {
    match progress(fraction) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Cancelled),
    }
}

/// A callback that never cancels and shows nothing.
pub fn silent(_fraction: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
