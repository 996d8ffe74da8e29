//! Layers of one thickness: the plan that most slicers make.

use serde::Serialize;

use super::limits::whole_bins;
use super::{Plan, PlanError};
use crate::grid::Bins;
use crate::quantity::Quantity;

/// Uniform layers in short.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct UniformLayers {
    /// Thickness of each in millimetres.
    pub layer_mm: f64,
    /// Number of layers.
    pub layers: usize,
}

impl std::fmt::Display for UniformLayers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} uniform layers of {} mm", self.layers, self.layer_mm)
    }
}

/// Layers of `layer_mm` each, from the plate to the top, on a first layer of as many bins as `first_layer` unless that is 0.
///
/// The last layer is the last one whose middle, where its mask is sampled, lies below the top. The printed
/// height therefore differs from the model's by at most half a layer.
///
/// # Errors
/// [`PlanError::Quantity`], [`PlanError::NotWholeBins`], [`PlanError::LayerTooThick`].
pub fn plan(
    bins: Bins,
    height_mm: f64,
    layer_mm: f64,
    first_layer: u32,
) -> Result<Plan, PlanError> {
    let thickness = thickness_in_bins(bins, layer_mm)?;
    let Some(layers) = layers_above(bins, height_mm, thickness, first_layer) else {
        return Err(PlanError::LayerTooThick {
            layer_mm,
            height_mm,
        });
    };
    let thickness = thickness as u32;
    let mut boundaries = vec![0];
    let first = u32::from(first_layer == 0);
    boundaries.extend((first..=layers).map(|layer| first_layer + layer * thickness));
    Ok(Plan {
        bins,
        boundaries,
        snap_planes: Vec::new(),
        exempt_layers: usize::from(first_layer > 0),
    })
}

/// Number of layers of `thickness` bins above the first layer, if the middle of one is below the top.
pub(crate) fn layers_above(
    bins: Bins,
    height_mm: f64,
    thickness: f64,
    first_layer: u32,
) -> Option<u32> {
    let above_mm = height_mm - bins.boundary_mm(first_layer);
    let layers = (above_mm / bins.size_mm / thickness - 0.5).ceil().max(1.0);
    (0.5 * thickness * bins.size_mm < above_mm).then_some(layers as u32)
}

/// A layer thickness as a whole number of bins, which it must be.
///
/// # Errors
/// [`PlanError::Quantity`], [`PlanError::NotWholeBins`].
pub fn thickness_in_bins(bins: Bins, layer_mm: f64) -> Result<f64, PlanError> {
    whole_bins(bins, Quantity::Layer, layer_mm)
}
