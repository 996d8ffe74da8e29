//! The volume deviation (eq. 15 to 20): the volume, in mm³, between the model and a layer that has the section of its
//! lowest bin throughout.
//!
//! The error of a layer depends on where the layer begins, so there is no density to add up, and planners measure each
//! layer. The volumes of the layer and the model bound the error, so it needs no cap.

use super::{ErrorRule, Row, repeated};
use crate::grid::Bins;

/// The row of the volume deviation. The default tolerance is larger if the model needs more: see [`crate::job::Options::tolerance`].
pub(super) const ROW: Row = Row {
    name: "volume",
    unit: "mm³",
    default_tolerance: 1.0,
    tolerances: [0.001, 1e6],
    greatest_density: None,
    is_distance: false,
    error: ErrorRule::Volume,
};

/// Steps of areas per mm². Sums are of whole numbers, so all machines agree.
const STEPS_PER_MM2: f64 = 1e6;

/// The areas of sections, φ of eq. 17, which determine the error of any layer.
#[derive(Debug, Clone)]
pub struct VolumeError {
    pub(super) bins: Bins,
    /// Area of each bin in millionths of a mm².
    areas: Vec<i64>,
    /// Weight of each bin in parts of [`WEIGHT_ONE`]; empty where all are 1.
    weights: Vec<u64>,
}

/// A weight of 1.
const WEIGHT_ONE: f64 = 65_536.0;

impl VolumeError {
    /// Errors of the layers of a model whose sections have these areas.
    pub fn new(areas_mm2: &[f64], bins: Bins) -> Self {
        let steps = |area: &f64| (area * STEPS_PER_MM2 + 0.5) as i64;
        Self {
            bins,
            areas: areas_mm2.iter().map(steps).collect(),
            weights: Vec::new(),
        }
    }

    /// As [`Self::new`], with the deviation in each bin multiplied by the bin's weight, 0 to 1.
    pub fn weighted(areas_mm2: &[f64], weights: Vec<f32>, bins: Bins) -> Self {
        let parts = |weight| (f64::from(weight) * WEIGHT_ONE + 0.5) as u64;
        Self {
            weights: weights.into_iter().map(parts).collect(),
            ..Self::new(areas_mm2, bins)
        }
    }

    /// The same in finer bins: see [`LayerErrors::split`](super::LayerErrors::split).
    pub(super) fn split(&self, parts: usize) -> Self {
        Self {
            bins: self.bins.split(parts),
            areas: repeated(&self.areas, parts),
            weights: repeated(&self.weights, parts),
        }
    }

    /// Area of a bin in steps; 0 above the last bin.
    fn area(&self, bin: u32) -> i64 {
        self.areas.get(bin as usize).copied().unwrap_or(0)
    }

    /// The steps that the bin from `bin` to `bin + 1` adds to the error of a layer that begins at `lower` (eq. 20).
    pub(super) fn steps_of(&self, lower: u32, bin: u32) -> u64 {
        let steps = self.area(bin).abs_diff(self.area(lower));
        match self.weights.get(bin as usize) {
            None => steps,
            // Wider, as the areas of a model of a kilometre have more than 48 bits.
            Some(weight) => {
                let weighted = u128::from(steps) * u128::from(*weight);
                ((weighted + WEIGHT_ONE as u128 / 2) / WEIGHT_ONE as u128) as u64
            }
        }
    }

    /// Steps of errors per mm³.
    pub(super) fn steps_per_mm3(&self) -> f64 {
        STEPS_PER_MM2 / self.bins.size_mm
    }
}
