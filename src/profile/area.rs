//! The area deviation (eq. 11 to 14). The density is |A′| / A. The error of a layer is the fraction by which its section
//! grows or shrinks from bottom to top; it has no unit.

use super::{ErrorRule, Row};
use crate::grid::Bins;

/// The row of the area deviation. The default tolerance is a tenth of the section.
pub(super) const ROW: Row = Row {
    name: "area",
    unit: "",
    default_tolerance: 0.1,
    tolerances: [0.001, 2.0],
    greatest_density: Some(CAP),
    is_distance: false,
    error: ErrorRule::Area,
};

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

/// The largest fraction by which a section changes within a layer of these boundaries, without the cap: what [`CAP`] hides where a
/// plan takes a shelf into a layer. Where the section below is empty, a change counts 1.
pub fn largest_change(areas_mm2: &[f64], boundaries: &[u32]) -> f64 {
    let mut largest = 0.0;
    for layer in boundaries.windows(2) {
        let end = (layer[1] as usize).min(areas_mm2.len());
        let bins = areas_mm2.get(layer[0] as usize..end).unwrap_or_default();
        let change: f64 = bins
            .windows(2)
            .map(|pair| match pair[0] {
                below if below > 0.0 => (pair[1] - below).abs() / below,
                _ if pair[1] > 0.0 => 1.0,
                _ => 0.0,
            })
            .sum();
        if largest < change {
            largest = change;
        }
    }
    largest
}
