//! Layers of one thickness, the plan that slicers make by default.

use super::{Plan, PlanError};
use crate::grid::{Bins, positive};

/// Layers of `layer_mm` each, from the plate to the top.
///
/// The last layer is the last one whose middle, where its mask is sampled, lies below the top, so that
/// the printed height differs from the model's by at most half a layer.
///
/// # Errors
/// [`PlanError::Grid`], [`PlanError::NotWholeBins`].
pub fn plan(bins: Bins, height_mm: f64, layer_mm: f64) -> Result<Plan, PlanError> {
    positive("the layer thickness", layer_mm)?;
    let thickness = bins.floor(layer_mm);
    if thickness < 1.0 || bins.ceil(layer_mm) > thickness {
        return Err(PlanError::NotWholeBins {
            layer_mm,
            bin_mm: bins.size_mm,
        });
    }
    let layers = (height_mm / bins.size_mm / thickness - 0.5).ceil().max(1.0);
    let (thickness, layers) = (thickness as u32, layers as u32);
    Ok(Plan {
        bins,
        boundaries: (0..=layers).map(|layer| layer * thickness).collect(),
    })
}
