//! All errors of the library as one type, with a stable code and typed details for programs.

use serde::Serialize;

use super::OptionsError;
use crate::archive::ArchiveError;
use crate::arrange::ArrangeError;
use crate::grid::GridError;
use crate::inspect::LimitsError;
use crate::ldi::LdiError;
use crate::model::MeshError;
use crate::model::read::ReadError;
use crate::model::weights::WeightsError;
use crate::orientation::SearchError;
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::MergeError;
use crate::plan::PlanError;
use crate::price::PriceError;

/// Any error of the library. `Display` writes one sentence that says what to do; serialised, an error is its code and an
/// object of typed details.
#[derive(Debug, thiserror::Error, Serialize)]
#[cfg_attr(
    target_arch = "wasm32",
    derive(tsify::Tsify),
    tsify(rename = "NestedError")
)]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum Error {
    /// The plan has no such layer.
    #[error("there is no layer {layer}; the plan has {layers}, from 0")]
    #[serde(rename = "no-layer")]
    NoLayer {
        /// The requested layer, from 0.
        layer: usize,
        /// Number of layers of the plan.
        layers: usize,
    },
    /// Masks, a profile or a print file were requested before a plan was made.
    #[error("there is no plan yet; make one first")]
    #[serde(rename = "no-plan")]
    NoPlan,
    /// The job takes more memory than it may. Plans and print files need the least; checks, single masks and masks that make up
    /// for growth need all hits.
    #[error(
        "this takes about {needed_bytes} bytes of memory, and {allowed_bytes} are allowed; allow more, or choose larger pixels"
    )]
    #[serde(rename = "memory-bound")]
    MemoryBound {
        /// Bytes that it takes.
        needed_bytes: u64,
        /// Bytes that it may take.
        allowed_bytes: u64,
    },
    /// The job takes more processor time than it may.
    #[error(
        "{} takes about {needed_s} s of processor time, and {allowed_s} are allowed; allow more{}",
        work.noun(),
        work.way()
    )]
    #[serde(rename = "time-bound")]
    TimeBound {
        /// The work that takes it.
        work: Work,
        /// Seconds that it takes, of all processors together.
        needed_s: f64,
        /// Seconds that it may take.
        allowed_s: f64,
    },
    /// Pieces of supported models begin with nothing below them, and would float in the vat.
    #[error(
        "{} nothing below, the largest of {volume_mm3:.2} mm³ in layer {layer_number} at {:.2}, {:.2}, {:.2}; add supports there, turn the \
         model, or allow floating pieces",
        if *pieces == 1 { "a piece begins with".to_owned() } else { format!("{pieces} pieces begin with") },
        at_mm[0],
        at_mm[1],
        at_mm[2]
    )]
    #[serde(rename = "floating-pieces")]
    FloatingPieces {
        /// Number of such pieces.
        pieces: usize,
        /// Volume of the largest.
        volume_mm3: f64,
        /// The layer in which it begins, from 1.
        layer_number: usize,
        /// Its place, as in findings.
        at_mm: [f64; 3],
    },
    /// The options contradict each other or cannot be read.
    #[error(transparent)]
    #[serde(untagged)]
    Options(#[from] OptionsError),
    /// The file could not be read as a model.
    #[error(transparent)]
    #[serde(untagged)]
    Read(#[from] ReadError),
    /// The triangles do not form a usable mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Mesh(#[from] MeshError),
    /// Pixels or bins cannot be laid out.
    #[error(transparent)]
    #[serde(untagged)]
    Grid(#[from] GridError),
    /// The weights are invalid, or belong to another mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Weights(#[from] WeightsError),
    /// Sampling failed.
    #[error(transparent)]
    #[serde(untagged)]
    Ldi(#[from] LdiError),
    /// Planning failed.
    #[error(transparent)]
    #[serde(untagged)]
    Plan(#[from] PlanError),
    /// Models cannot be arranged on plates, or cannot stay where they are.
    #[error(transparent)]
    #[serde(untagged)]
    Arrange(#[from] ArrangeError),
    /// The print file could not be written.
    #[error(transparent)]
    #[serde(untagged)]
    Archive(#[from] ArchiveError),
    /// Limits of the checks are invalid.
    #[error(transparent)]
    #[serde(untagged)]
    Limits(#[from] LimitsError),
    /// The options of a search are invalid, or it rejected a result.
    #[error(transparent)]
    #[serde(untagged)]
    Search(#[from] SearchError),
    /// There is no price.
    #[error(transparent)]
    #[serde(untagged)]
    Price(#[from] PriceError),
    /// The parts of a search cannot be merged.
    #[cfg(not(target_arch = "wasm32"))]
    #[error(transparent)]
    #[serde(untagged)]
    Merge(#[from] MergeError),
}

/// Work that takes processor time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Work {
    /// Hits of rays, which are as many as pixels that facets cover.
    Hits,
    /// Errors of layers: bins times thicknesses.
    Layers,
    /// Saliency: vertices times the cells within reach of them.
    Saliency,
    /// Everything together, where no part of it alone is certain to take too long.
    All,
}

impl Work {
    fn noun(self) -> &'static str {
        match self {
            Self::Hits => "sampling the model",
            Self::Layers => "planning",
            Self::Saliency => "saliency",
            Self::All => "this",
        }
    }

    fn way(self) -> &'static str {
        match self {
            Self::Hits => ", or choose larger pixels",
            Self::Layers => ", or choose larger bins or fewer thicknesses",
            Self::Saliency => ", do without saliency, or give the model fewer facets",
            Self::All => "",
        }
    }
}

impl Error {
    /// The stable code of the error, as serialised.
    pub fn code(&self) -> String {
        let serialised = serde_json::to_value(self).unwrap_or_default();
        let code = serialised["code"].as_str();
        code.unwrap_or_default().to_owned()
    }
}

#[cfg(test)]
mod tests;
