//! The surface roughness Ra (eq. 7 to 10). The density is the largest 1 / sin θ of the surface in each bin, where θ is
//! the angle between its normal and z. The error of a layer is in millimetres.
//!
//! A vertical wall has density 1: the error of a layer is its thickness.

use super::{ErrorRule, Row, SlopeDensity};

/// The row of the roughness. The default tolerance is the roughness of a vertical wall in layers of 0.1 mm.
pub(super) const ROW: Row = Row {
    name: "roughness",
    unit: "mm",
    default_tolerance: 0.1,
    tolerances: [0.001, 2.0],
    greatest_density: Some(CAP),
    is_distance: false,
    error: ErrorRule::Slope(&Roughness),
};

struct Roughness;

impl SlopeDensity for Roughness {
    fn of(&self, square: f32) -> f32 {
        density_of(square)
    }
}

/// The maximum density. The formula is unbounded: sin θ is 0 for a horizontal surface. Surfaces less than 30° from
/// horizontal count as if they were at 30°, so layers of 0.05 mm stay within the default tolerance everywhere.
pub const CAP: f32 = 2.0;

/// The density of a surface with this `n_z²`.
pub(crate) fn density_of(square: f32) -> f32 {
    let sine_square = 1.0 - square;
    // Computed unconditionally, so that the compiler can vectorise.
    let density = 1.0 / sine_square.sqrt();
    if sine_square * (CAP * CAP) <= 1.0 {
        CAP
    } else {
        density
    }
}
