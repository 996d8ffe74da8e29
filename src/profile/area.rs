//! The area deviation (eq. 11 to 14). The density is |A′| / A. The error of a layer is the fraction by which its section
//! grows or shrinks from bottom to top; it has no unit.

use crate::grid::Bins;

/// The default tolerance: a tenth of the section.
pub const DEFAULT_TOLERANCE: f64 = 0.1;

/// The maximum density, per millimetre. The formula is unbounded: A is 0 at a tip, and A′ is infinite at a flat. With
/// this cap, layers of 0.05 mm stay within the default tolerance everywhere.
pub const CAP: f32 = 2.0;

/// The density of each bin from the areas of sections (eq. 14). The area above the last bin is 0.
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
