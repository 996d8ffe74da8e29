//! The surface roughness Ra (eq. 7 to 10): the density is the largest 1 / sin θ of the surface in each bin, where θ is
//! the angle between its normal and z, and the error of a layer is in millimetres.
//!
//! An upright wall has density 1: its layers are as rough as they are thick.

use super::steepest::densities;

/// The error that a layer may have where nobody says, in millimetres: as rough as walls in layers of 0.1 mm.
pub const DEFAULT_TOLERANCE_MM: f64 = 0.1;

/// The greatest density. The formula has no bound: a level surface has sin θ = 0. Surfaces less than 30° from level
/// count as if they were at 30°, so that layers of 0.05 mm keep the default tolerance everywhere.
pub const CAP: f32 = 2.0;

/// The densities of bins from the largest `n_z²` of each; 0 where there is no surface.
pub fn density(steepest: &[f32]) -> Vec<f32> {
    densities(steepest, density_of)
}

/// The density of a surface by its `n_z²`.
pub(crate) fn density_of(square: f32) -> f32 {
    let sine_square = 1.0 - square;
    // Worked out before it is known to be wanted, so that many go at once.
    let density = 1.0 / sine_square.sqrt();
    if sine_square * (CAP * CAP) <= 1.0 {
        CAP
    } else {
        density
    }
}
