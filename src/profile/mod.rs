//! Metric profiles: error density along z, one value a bin (section 3.1).

pub mod cusp;

use serde::{Deserialize, Serialize};

use crate::grid::Bins;

/// What a profile measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Metric {
    /// Cusp height, in millimetres (eq. 3 to 6).
    #[default]
    Cusp,
}

/// The density of deviation errors along the height of a model, φ̃ (section 3.1).
///
/// The error of a layer is the sum of the densities of its bins times the bin size (eq. 1).
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The height ranges that `density` speaks of.
    pub bins: Bins,
    /// φ̃, one value a bin from the plate upward: millimetres of error a millimetre of thickness.
    pub density: Vec<f32>,
}

/// Steps of an error sum a bin of density 1: about the precision of a density.
const STEPS_PER_BIN: f64 = 1e7;

impl Profile {
    /// The running error sum, from which the error of any layer follows in constant time.
    pub fn error_sum(&self) -> ErrorSum {
        let mut total = 0;
        let mut sums = Vec::with_capacity(self.density.len() + 1);
        sums.push(0);
        for &density in &self.density {
            total += (f64::from(density) * STEPS_PER_BIN).round() as u64;
            sums.push(total);
        }
        ErrorSum {
            bins: self.bins,
            sums,
        }
    }
}

/// Errors below each bin boundary, counted in whole ten-millionths of a bin: sums are exact, so that
/// every planner on every machine agrees whether a layer is within tolerance.
#[derive(Debug, Clone)]
pub struct ErrorSum {
    bins: Bins,
    sums: Vec<u64>,
}

impl ErrorSum {
    /// The bins that were summed.
    pub fn bins(&self) -> Bins {
        self.bins
    }

    /// Error of the layer between two boundaries in steps, `ε_k` of eq. 1. There is none above the
    /// last bin.
    pub fn steps_between(&self, lower: u32, upper: u32) -> u64 {
        let last = self.bins.count;
        self.sums[(upper as usize).min(last)] - self.sums[(lower as usize).min(last)]
    }

    /// A number of steps in millimetres.
    pub fn to_mm(&self, steps: u64) -> f64 {
        steps as f64 / STEPS_PER_BIN * self.bins.size_mm
    }

    /// The number of steps nearest to an error in millimetres.
    pub fn to_steps(&self, error_mm: f64) -> u64 {
        (error_mm / self.bins.size_mm * STEPS_PER_BIN).round() as u64
    }
}
