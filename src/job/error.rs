//! Any error of the library, with a stable code and typed details for programs.

use serde::Serialize;

use super::OptionsError;
use crate::archive::ArchiveError;
use crate::grid::GridError;
use crate::ldi::LdiError;
use crate::model::MeshError;
use crate::model::read::ReadError;
use crate::model::weights::WeightsError;
use crate::orientation::SearchError;
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::MergeError;
use crate::plan::PlanError;

/// Any error of the library. Its text is one sentence that says what to do; serialised, it is its
/// code with the object of its typed details.
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
        /// The layer asked for, from 0.
        layer: usize,
        /// Layers of the plan.
        layers: usize,
    },
    /// Masks were asked for before there was a plan.
    #[error("there is no plan yet; make one first")]
    #[serde(rename = "no-plan")]
    NoPlan,
    /// The options contradict each other or cannot be read.
    #[error(transparent)]
    #[serde(untagged)]
    Options(#[from] OptionsError),
    /// The file could not be read as a model.
    #[error(transparent)]
    #[serde(untagged)]
    Read(#[from] ReadError),
    /// The triangles are no usable mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Mesh(#[from] MeshError),
    /// Pixels or bins cannot be laid out.
    #[error(transparent)]
    #[serde(untagged)]
    Grid(#[from] GridError),
    /// The weights are none, or those of another mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Weights(#[from] WeightsError),
    /// Sampling failed.
    #[error(transparent)]
    #[serde(untagged)]
    Ldi(#[from] LdiError),
    /// There is no plan.
    #[error(transparent)]
    #[serde(untagged)]
    Plan(#[from] PlanError),
    /// The print file could not be written.
    #[error(transparent)]
    #[serde(untagged)]
    Archive(#[from] ArchiveError),
    /// There is no such search, or it was given what is not its own.
    #[error(transparent)]
    #[serde(untagged)]
    Search(#[from] SearchError),
    /// Parts of a search do not make a whole.
    #[cfg(not(target_arch = "wasm32"))]
    #[error(transparent)]
    #[serde(untagged)]
    Merge(#[from] MergeError),
}

impl Error {
    /// Stable name of the error for programs: the code that it is serialised with.
    pub fn code(&self) -> String {
        let serialised = serde_json::to_value(self).unwrap_or_default();
        let code = serialised["code"].as_str();
        code.unwrap_or_default().to_owned()
    }
}

#[cfg(test)]
mod tests;
