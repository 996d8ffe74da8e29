//! The best building direction (section 4.3): a search on the Gaussian sphere for the way up that prints in the fewest layers
//! with the least error.
//!
//! Directions are measured one by one, by profile and plan alone: no copy of the mesh, no rays. Energies follow from all the
//! metrics together, rings of directions around the local [`minima`] refine these, and the best are those that differ.
//! [`Search`] is the driver: it says what to measure next, and does no work and no I/O of its own. Threads, workers and
//! machines run its tasks; who runs which, and when, makes no difference.

pub(crate) mod directions;
mod energy;
mod error;
mod refine;
mod search;
pub mod shard;
mod surface;

use serde::{Deserialize, Serialize};
#[cfg(target_arch = "wasm32")]
use tsify::Tsify;

pub use energy::minima;
pub use error::SearchError;
pub use search::{Search, SearchResult, Task, TaskResult};
pub(crate) use surface::{Placement, Surface, search_bytes};

/// What is searched for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct SearchOptions {
    /// How many directions are looked along, spread evenly over the sphere. The axes of the file, and those that lay a large flat
    /// of the model on the plate or turn it up, come on top.
    pub directions: usize,
    /// How much the cost counts against the quality, α of eq. 25, from 0 to 1.
    pub alpha: f64,
    /// What the first term of the energy is.
    pub cost: Cost,
    /// What the second term is.
    pub quality: Quality,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            directions: 1000,
            alpha: 0.5,
            cost: Cost::Layers,
            quality: Quality::Error,
        }
    }
}

/// The most directions of a search.
pub const MAX_DIRECTIONS: usize = 100_000;

impl SearchOptions {
    /// Finds what cannot be searched for.
    pub(crate) fn check(&self) -> Result<(), SearchError> {
        if !(1..=MAX_DIRECTIONS).contains(&self.directions) {
            return Err(SearchError::Directions {
                directions: self.directions,
                most: MAX_DIRECTIONS,
            });
        }
        if !(0.0..=1.0).contains(&self.alpha) {
            return Err(SearchError::Alpha { alpha: self.alpha });
        }
        Ok(())
    }
}

/// What printing in a direction costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Cost {
    /// The number of layers, K.
    #[default]
    Layers,
    /// The time that they take.
    Time,
}

/// What printing in a direction does to the surface; less is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// The largest error of a layer, max `ε_k`: the geometric error of table 3. Plans keep it below the tolerance, and mostly
    /// near it.
    #[default]
    Error,
    /// The roughness of the surface on average.
    Roughness,
    /// The area that would need support.
    Overhang,
}

/// A way to stand on the plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify), tsify(missing_as_null))]
pub struct Candidate {
    /// The unit vector that points up from the plate, as the model stands in its file.
    pub direction: [f64; 3],
    /// The quaternion x, y, z, w that turns the model so.
    pub rotation: [f64; 4],
    /// Extent of the model when it stands so.
    pub size_mm: [f64; 3],
    /// Why it cannot be printed so, if it cannot.
    pub excluded: Option<Exclusion>,
    /// What printing it so gives; absent if it is excluded.
    pub metrics: Option<Metrics>,
    /// F of eq. 25, from 0 to 1; absent before it is rated, and if it is excluded.
    pub energy: Option<f64>,
}

/// Why a direction is no choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum Exclusion {
    /// The model is wider or deeper than the plate, however it is turned on it.
    TooLarge,
    /// It is higher than the printer prints.
    TooHigh,
    /// There is no plan within tolerance.
    NoPlan,
}

/// What printing in a direction gives.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Metrics {
    /// Layers of the plan, K.
    pub layers: usize,
    /// Time that they take.
    pub print_time_s: f64,
    /// The largest error of a layer, in the metric's unit.
    pub max_error: f64,
    /// The roughness Ra of the surface on average by area, each facet by its angle (eq. 7) and the thickness of the layers
    /// that it meets.
    pub roughness_mm: f64,
    /// Area that faces down at less than 45° from level and is not on the plate: what would need support.
    pub overhang_mm2: f64,
}

/// What the terms of energies are relative to: the largest of all directions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Scale {
    /// The largest cost: layers, or seconds.
    pub cost: f64,
    /// The largest quality figure: the metric's unit, mm, or mm².
    pub quality: f64,
}
