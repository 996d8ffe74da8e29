//! A job: options resolved once, then the stages in their order, each an immutable value.

mod error;
mod options;
mod options_error;
mod orient;
mod planning;
mod report;
mod resolve;
mod slicer;
mod verify;

pub use error::Error;
pub use options::*;
pub use options_error::OptionsError;
pub use report::*;
pub use slicer::*;
pub use verify::*;
