//! Filament roundness: the cusp height, but at least what the round side of a filament shows. The density is the larger of 0.184 and the
//! largest |`n_z`| of the surface in each bin. The error of a layer is in millimetres.
//!
//! Layers show on a vertical wall as well: Wasserfall, Hendrich and Zhang, "Adaptive slicing for the FDM
//! process revisited", *IEEE CASE* 2017, measured that it leaves an error of 0.184 times the thickness of the layer. PrusaSlicer
//! limits its adaptive layers by the same number.

use super::{ErrorRule, Row, SlopeDensity, cusp};

/// The row of filament roundness. The default tolerance is that of the cusp height, from which the error differs on steep walls alone.
/// These may then have layers of up to 0.35 mm. Where there is no surface the density is that of a wall: rays meet no upright walls, and
/// every layer has a wall.
pub(super) const ROW: Row = Row {
    name: "filament-roundness",
    unit: "mm",
    default_tolerance: cusp::ROW.default_tolerance,
    tolerances: cusp::ROW.tolerances,
    greatest_density: Some(1.0),
    is_distance: true,
    error: ErrorRule::Slope(&FilamentRoundness),
};

struct FilamentRoundness;

impl SlopeDensity for FilamentRoundness {
    fn of(&self, square: f32) -> f32 {
        let slope = square.sqrt();
        if slope > OF_A_WALL { slope } else { OF_A_WALL }
    }

    fn without(&self) -> f32 {
        OF_A_WALL
    }
}

/// The density of a vertical wall.
const OF_A_WALL: f32 = 0.184;
