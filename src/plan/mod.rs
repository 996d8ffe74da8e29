//! Layer plans: where the planes between layers lie (section 3.3).
//!
//! A planner sees a profile and limits, and nothing else of the model.

pub mod optimal;
pub mod uniform;

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::grid::{Bins, GridError, positive};
use crate::profile::ErrorSum;

/// What every plan must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Least layer thickness in millimetres, `t_min`.
    pub layer_min_mm: f64,
    /// Greatest layer thickness in millimetres, `t_max`.
    pub layer_max_mm: f64,
    /// Greatest error of a layer in millimetres, ε.
    pub tolerance_mm: f64,
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum PlanError {
    /// A limit is no positive length.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The layer range holds no whole number of bins.
    #[error(
        "no whole number of bins of {bin_mm} mm lies between the layer thicknesses \
         {layer_min_mm} and {layer_max_mm} mm; widen the range or choose a smaller bin"
    )]
    EmptyRange {
        /// Least layer thickness.
        layer_min_mm: f64,
        /// Greatest layer thickness.
        layer_max_mm: f64,
        /// Bin size.
        bin_mm: f64,
    },
    /// A uniform layer thickness that is no whole number of bins.
    #[error(
        "the layer thickness {layer_mm} mm is no whole number of bins of {bin_mm} mm; choose a \
         bin that divides it"
    )]
    NotWholeBins {
        /// Layer thickness asked for.
        layer_mm: f64,
        /// Bin size.
        bin_mm: f64,
    },
    /// A uniform layer whose middle, where its mask is sampled, lies above the model.
    #[error("layers of {layer_mm} mm are too thick for a model that is {height_mm} mm high")]
    LayerTooThick {
        /// Layer thickness asked for.
        layer_mm: f64,
        /// Height of the model.
        height_mm: f64,
    },
    /// The paper's infeasible case: K\[N\] = ∞.
    #[error(
        "no plan keeps every layer's error within {tolerance_mm} mm: at z = {height_mm:.3} mm \
         even the layers of least thickness, {layer_min_mm} mm, exceed it; raise the tolerance or \
         lower the least thickness"
    )]
    Infeasible {
        /// The highest plane that layers can reach from the plate; the next one fails.
        height_mm: f64,
        /// The tolerance asked for.
        tolerance_mm: f64,
        /// The least layer thickness asked for.
        layer_min_mm: f64,
    },
    /// The rest of the height below the top fits no layer of the range.
    #[error(
        "layers of {layer_min_mm} to {layer_max_mm} mm do not add up to the model's height: \
         {rest_mm:.3} mm are left above z = {height_mm:.3} mm; widen the range of thicknesses"
    )]
    Remainder {
        /// The highest plane that layers can reach from the plate.
        height_mm: f64,
        /// From there to the top.
        rest_mm: f64,
        /// The least layer thickness asked for.
        layer_min_mm: f64,
        /// The greatest layer thickness asked for.
        layer_max_mm: f64,
    },
}

impl PlanError {
    /// Stable name of the error for programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Grid(error) => error.code(),
            Self::EmptyRange { .. } => "layer-range-empty",
            Self::NotWholeBins { .. } => "layer-not-whole-bins",
            Self::LayerTooThick { .. } => "layer-too-thick",
            Self::Infeasible { .. } => "infeasible",
            Self::Remainder { .. } => "infeasible-remainder",
        }
    }
}

/// Layers from the plate upward.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What the boundaries count.
    pub bins: Bins,
    /// Boundaries of layers in bins: 0, then the top of each layer.
    pub boundaries: Vec<u32>,
}

impl Plan {
    /// Number of layers, K.
    pub fn layers(&self) -> usize {
        self.boundaries.len() - 1
    }

    /// Height of every boundary in millimetres, one more than there are layers.
    pub fn z_mm(&self) -> Vec<f64> {
        self.boundaries
            .iter()
            .map(|&boundary| self.bins.boundary_mm(boundary))
            .collect()
    }

    /// Thickness of every layer in millimetres.
    pub fn thickness_mm(&self) -> Vec<f64> {
        self.boundaries
            .windows(2)
            .map(|layer| self.bins.boundary_mm(layer[1] - layer[0]))
            .collect()
    }

    /// Height of the middle of every layer in millimetres, where its mask is sampled.
    pub fn middle_mm(&self) -> Vec<f64> {
        self.boundaries
            .windows(2)
            .map(|layer| f64::from(layer[0] + layer[1]) * 0.5 * self.bins.size_mm)
            .collect()
    }

    /// The largest error of a layer in millimetres.
    pub fn max_error_mm(&self, errors: &ErrorSum) -> f64 {
        let steps = self
            .boundaries
            .windows(2)
            .map(|layer| errors.steps_between(layer[0], layer[1]))
            .max();
        errors.to_mm(steps.unwrap_or(0))
    }
}

impl Limits {
    /// The range of thicknesses in bins of `bin_mm`, ⌈`t_min`/b⌉ to ⌊`t_max`/b⌋.
    ///
    /// # Errors
    /// [`PlanError::Grid`], [`PlanError::EmptyRange`].
    pub fn thickness_in_bins(&self, bins: Bins) -> Result<RangeInclusive<u32>, PlanError> {
        positive("the bin", bins.size_mm)?;
        positive("the least layer thickness", self.layer_min_mm)?;
        positive("the greatest layer thickness", self.layer_max_mm)?;
        positive("the tolerance", self.tolerance_mm)?;
        let least = bins.ceil(self.layer_min_mm).max(1.0);
        let greatest = bins.floor(self.layer_max_mm);
        if least > greatest {
            return Err(PlanError::EmptyRange {
                layer_min_mm: self.layer_min_mm,
                layer_max_mm: self.layer_max_mm,
                bin_mm: bins.size_mm,
            });
        }
        // A layer thicker than the model is as good as one just thicker.
        let limit = bins.count as f64 + 1.0;
        Ok(least.min(limit) as u32..=greatest.min(limit) as u32)
    }
}
