//! The cusp height (eq. 3 to 6). The density is the largest |`n_z`| of the surface in each bin. The error of a layer is
//! the height of the steps that its edge leaves on the surface, in millimetres.

use super::{ErrorRule, Row, SlopeDensity};

/// The row of the cusp height. The default tolerance is the paper's.
pub(super) const ROW: Row = Row {
    name: "cusp",
    unit: "mm",
    default_tolerance: 0.065,
    tolerances: [0.001, 1.0],
    greatest_density: Some(1.0),
    is_distance: true,
    error: ErrorRule::Slope(&Cusp),
};

struct Cusp;

impl SlopeDensity for Cusp {
    fn of(&self, square: f32) -> f32 {
        density_of(square)
    }
}

/// The density of a surface with this `n_z²`.
pub(super) fn density_of(square: f32) -> f32 {
    square.sqrt()
}
