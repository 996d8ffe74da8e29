//! The cusp height (eq. 3 to 6). The density is the largest |`n_z`| of the surface in each bin. The error of a layer is
//! the height of the steps that its edge leaves on the surface, in millimetres.

use super::steepest::densities;

/// The default tolerance in millimetres, as in the paper.
pub const DEFAULT_TOLERANCE_MM: f64 = 0.065;

/// The density of each bin, 0 to 1, from its largest `n_z²`; 0 where there is no surface.
pub fn density(steepest: &[f32]) -> Vec<f32> {
    densities(steepest, density_of)
}

/// The density of a surface with this `n_z²`.
pub(super) fn density_of(square: f32) -> f32 {
    square.sqrt()
}
