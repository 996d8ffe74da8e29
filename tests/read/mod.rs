//! Reading models: valid files of every kind, and an error with its position for every invalid one.

mod damage;
mod kinds;
mod mirrored;
mod obj;
pub mod package;
mod refused;
mod stl;
mod threemf;
mod units;
