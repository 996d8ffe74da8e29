//! The best orientation (section 4.3): a search on the Gaussian sphere for the building direction with few layers and a
//! small error.
//!
//! Each direction is measured by profile and plan alone, without rays or a copy of the mesh. The metrics of all candidates
//! together determine their energies. Rings of directions then refine the local [`minima`], and the best distinct candidates
//! are the result. [`Search`] drives this as a state machine: it hands out directions to measure, and does no work or I/O
//! itself. Threads, workers or machines run its tasks in any order, and the result is the same.
//!
//! Without rays, facets hidden inside other bodies count, as in live previews. The plan that follows leaves them out.

mod basins;
pub(crate) mod directions;
mod energy;
mod error;
mod extents;
mod minima;
mod overlaps;
pub mod packed;
mod refine;
mod search;
pub mod shard;
mod supports;
mod surface;

use serde::{Deserialize, Serialize};
#[cfg(target_arch = "wasm32")]
use tsify::Tsify;

pub use energy::minima;
pub use error::SearchError;
pub use search::{Search, SearchResult, Task, TaskResult};
pub(crate) use surface::{Placement, Surface, search_bytes};

/// Options of the orientation search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct SearchOptions {
    /// Number of directions to measure, spread evenly over the sphere. The axes of the file and the normals of large flats
    /// are added, each in both senses.
    pub directions: usize,
    /// Weight of the cost against the quality, α of eq. 25, from 0 to 1.
    pub alpha: f64,
    /// The first term of the energy.
    pub cost: Cost,
    /// The second term of the energy.
    pub quality: Quality,
    /// Weights of all terms, in place of `alpha`, `cost` and `quality`: what a print needs is seldom two terms alone. Only their ratios
    /// count.
    pub ranking: Option<Terms>,
    /// Excludes orientations with a larger area that would need support, in mm²; no limit if absent.
    pub most_overhang_mm2: Option<f64>,
    /// Excludes orientations with more islands; no limit if absent.
    pub most_islands: Option<usize>,
    /// Excludes orientations with a larger area of cups, in mm²; no limit if absent.
    pub most_cups_mm2: Option<f64>,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            directions: 1000,
            alpha: 0.5,
            cost: Cost::Layers,
            quality: Quality::Error,
            ranking: None,
            most_overhang_mm2: None,
            most_islands: None,
            most_cups_mm2: None,
        }
    }
}

/// Maximum of [`SearchOptions::directions`].
pub const MAX_DIRECTIONS: usize = 100_000;

impl SearchOptions {
    /// Checks the number of directions, α and the limits.
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
        let limits = [
            ("most_overhang_mm2", self.most_overhang_mm2),
            ("most_cups_mm2", self.most_cups_mm2),
        ];
        let weights = self.ranking.into_iter().flat_map(Terms::to_array);
        let weights = weights.map(|weight| ("ranking", Some(weight)));
        for (limit, value) in limits.into_iter().chain(weights) {
            if let Some(value) = value.filter(|it| !(0.0..=f64::MAX).contains(it)) {
                return Err(SearchError::Limit { limit, value });
            }
        }
        Ok(())
    }
}

/// The cost of an orientation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Cost {
    /// The number of layers, K.
    #[default]
    Layers,
    /// The print time.
    Time,
}

/// The quality of the surface in an orientation; less is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// The largest error of a layer, max `ε_k`: the geometric error of table 3. Plans keep it within the tolerance, and
    /// usually close to it.
    #[default]
    Error,
    /// The mean roughness of the surface.
    Roughness,
    /// The area that would need support.
    Overhang,
    /// The number of islands.
    Islands,
    /// The area of cups.
    Cups,
    /// The volume of supports.
    Supports,
    /// The area in which supports touch the model, weighted.
    Contacts,
}

/// An orientation with its metrics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify), tsify(missing_as_null))]
pub struct Candidate {
    /// The unit vector that points up from the plate, in the frame of the file.
    pub direction: [f64; 3],
    /// The rotation from the pose in the file: a quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// Extent of the model in this orientation, in x, y and z.
    pub size_mm: [f64; 3],
    /// Reason for which the orientation cannot or should not be printed; absent if it can.
    pub excluded: Option<Exclusion>,
    /// Metrics of the orientation; absent if it cannot be printed.
    pub metrics: Option<Metrics>,
    /// F of eq. 25, from 0 to 1; absent if not rated yet, or if excluded.
    pub energy: Option<f64>,
}

/// Reason for which an orientation cannot be printed, or should not by the limits of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum Exclusion {
    /// The model is wider or deeper than the plate, however it is rotated about z.
    TooLarge,
    /// The model is higher than the printer's build volume.
    TooHigh,
    /// No plan keeps the tolerance.
    NoPlan,
    /// A larger area than the limit would need support.
    Overhang,
    /// There are more islands than the limit.
    Islands,
    /// The area of cups is larger than the limit.
    Cups,
}

impl Exclusion {
    /// Returns true if the orientation cannot be printed at all, whatever the limits of the search.
    pub fn is_impossible(self) -> bool {
        match self {
            Self::TooLarge | Self::TooHigh | Self::NoPlan => true,
            Self::Overhang | Self::Islands | Self::Cups => false,
        }
    }
}

/// Metrics of an orientation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Metrics {
    /// Number of layers, K.
    pub layers: usize,
    /// Print time.
    pub print_time_s: f64,
    /// The largest error of a layer, in the metric's unit.
    pub max_error: f64,
    /// Mean roughness Ra, weighted by area. That of a facet follows from its angle (eq. 7) and the mean thickness of the
    /// layers that it meets.
    pub roughness_mm: f64,
    /// Area that faces down at less than 45° from level and is not on the plate: it would need support.
    pub overhang_mm2: f64,
    /// Number of islands: parts that begin above the plate with nothing below them. An estimate from the surface alone, as that of
    /// cups: see `docs/printability.md`.
    pub islands: usize,
    /// The areas of cups together, each where it is largest: hollows that are open only away from the plate, and suck at the film.
    pub cups_mm2: f64,
    /// Volume of supports, as `docs/supports.md` estimates it.
    pub support_ml: f64,
    /// Area in which supports touch the model, estimated likewise; each contact counts with the weight of the surface there.
    pub contact_mm2: f64,
}

/// Declares the terms once: as fields, and as an array in the same order.
macro_rules! terms {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// Terms of energies, less of each being better: their weights, or their largest values of all directions, in the units of
        /// [`Metrics`].
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
        #[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
        #[cfg_attr(target_arch = "wasm32", derive(Tsify))]
        #[serde(default, deny_unknown_fields)]
        pub struct Terms {
            $($(#[$doc])* pub $name: f64,)*
        }

        impl Terms {
            /// Names of the terms, in the order of [`Self::to_array`].
            pub const NAMES: [&str; 10] = [$(stringify!($name),)*];

            /// The terms in the order of [`Self::NAMES`].
            pub fn to_array(self) -> [f64; 10] {
                [$(self.$name,)*]
            }

            /// The terms from that order.
            pub fn from_array([$($name,)*]: [f64; 10]) -> Self {
                Self { $($name,)* }
            }
        }
    };
}

terms! {
    /// The number of layers.
    layers,
    /// The print time.
    time,
    /// The largest error of a layer.
    error,
    /// The mean roughness of the surface.
    roughness,
    /// The area that would need support.
    overhang,
    /// The number of islands.
    islands,
    /// The area of cups.
    cups,
    /// The volume of supports.
    supports,
    /// The area in which supports touch the model, weighted.
    contacts,
    /// The height of the model, in mm.
    height,
}
