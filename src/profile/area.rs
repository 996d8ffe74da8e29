//! The area deviation (eq. 11 to 14): the density is |A′| / A, and the error of a layer the part by which its section
//! grows or shrinks on the way up, without a unit.

use crate::grid::Bins;

/// The error that a layer may have where nobody says: a tenth of the section.
pub const DEFAULT_TOLERANCE: f64 = 0.1;

/// The greatest density a millimetre. The formula has no bound: at a tip A is 0, at a flat A′ has none. With this cap,
/// layers of 0.05 mm keep the default tolerance everywhere.
pub const CAP: f32 = 2.0;

/// The densities of bins from the areas of their sections (eq. 14); nothing lies above the last one.
pub fn density(areas_mm2: &[f64], bins: Bins) -> Vec<f32> {
    let above = areas_mm2.iter().skip(1).chain(&[0.0]);
    areas_mm2
        .iter()
        .zip(above)
        .map(|(&area, &above)| {
            let change = (above - area).abs();
            if change == 0.0 {
                0.0
            } else if change >= f64::from(CAP) * bins.size_mm * area {
                CAP
            } else {
                (change / (bins.size_mm * area)) as f32
            }
        })
        .collect()
}
