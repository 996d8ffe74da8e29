//! Filament roundness: the cusp height, but at least what the round side of a filament shows. The density is the larger of 0.184 and the
//! largest |`n_z`| of the surface in each bin. The error of a layer is in millimetres.
//!
//! Layers show on a vertical wall as well: Wasserfall, Hendrich and Zhang, "Adaptive slicing for the FDM
//! process revisited", *IEEE CASE* 2017, measured that it leaves an error of 0.184 times the thickness of the layer. `PrusaSlicer`
//! limits its adaptive layers by the same number.

/// The default tolerance in millimetres: that of the cusp height, from which the error differs on steep walls alone. These may
/// then have layers of up to 0.35 mm.
pub const DEFAULT_TOLERANCE_MM: f64 = super::cusp::DEFAULT_TOLERANCE_MM;

/// The density of a vertical wall.
pub const OF_A_WALL: f32 = 0.184;

/// The density of each bin, 0.184 to 1, from its largest `n_z²`. It is that of a wall where there is no surface: rays meet no upright
/// walls, and every layer has a wall.
pub fn density(steepest: &[f32]) -> Vec<f32> {
    let squares = steepest.iter().map(|square| square.max(0.0));
    squares.map(density_of).collect()
}

/// The density of a surface with this `n_z²`.
pub(super) fn density_of(square: f32) -> f32 {
    let slope = square.sqrt();
    if slope > OF_A_WALL { slope } else { OF_A_WALL }
}
