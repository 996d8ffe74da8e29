//! The cusp height (eq. 3 to 6): the density is the largest |`n_z`| of the surface in each bin, and the error of a
//! layer the height in millimetres of the steps that its edge leaves.

use super::steepest::densities;

/// The error that a layer may have where nobody says, in millimetres: the paper's.
pub const DEFAULT_TOLERANCE_MM: f64 = 0.065;

/// The densities of bins from the largest `n_z²` of each; 0 where there is no surface. Bounded by 1.
pub fn density(steepest: &[f32]) -> Vec<f32> {
    densities(steepest, density_of)
}

/// The density of a surface by its `n_z²`.
pub(super) fn density_of(square: f32) -> f32 {
    square.sqrt()
}
