//! Preparation of a posed model before it is sampled: voids and supports, as bodies of their own class.
//!
//! They are never cut from the model or joined with it: [`crate::model::Winding`] decides along each ray which ranges
//! are printed.

mod basins;
mod cavities;
mod columns;
mod drain;
mod hollow;
mod joined;
mod lattice;
mod lengths;
mod pillars;
mod pits;
mod plug;
mod round;
mod shell;
mod support;
mod surface;
mod surface_nets;

pub use drain::{AutoDrain, Drain};
pub(crate) use hollow::LEAST_WALL_MM;
pub use hollow::{Hollowing, Infill, Void, hollow};
pub use joined::Closed;
pub(crate) use lengths::BadLength;
pub use pillars::Pillar;
pub use plug::plugs;
pub use shell::Shell;
pub(crate) use support::{FILM_KPA, LEAST_GAP_MM, MOST_SUPPORT_MM, peel_n};
pub use support::{
    SupportLoad, SupportPoint, SupportProfile, SupportStrength, Supporting, Supports, support,
};
