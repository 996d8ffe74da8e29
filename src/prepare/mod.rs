//! What a posed model is prepared with before it is sampled: voids and supports, as bodies of their own class.
//!
//! They are never cut from the model or joined with it: [`crate::model::Winding`] decides along each ray what is printed.

mod basins;
mod columns;
mod drain;
mod hollow;
mod lattice;
mod nets;

pub use drain::{AutoDrain, Drain};
pub(crate) use hollow::TooSmall;
pub use hollow::{Hollowing, Infill, Void, hollow};
pub use nets::Shell;
