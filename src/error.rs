//! Any error of the library, with a stable code and typed details for programs.

use serde::Serialize;

use crate::archive::ArchiveError;
use crate::grid::GridError;
use crate::ldi::LdiError;
use crate::mesh::MeshError;
use crate::plan::PlanError;
use crate::stl::StlError;
use crate::weights::WeightsError;

/// Any error of the library. Its text is one sentence that says what to do; serialised, it is the
/// object of its typed details.
#[derive(Debug, thiserror::Error, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Error {
    /// The bytes are no usable STL.
    #[error(transparent)]
    Stl(#[from] StlError),
    /// The triangles are no usable mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Pixels or bins cannot be laid out.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The weights are none, or those of another mesh.
    #[error(transparent)]
    Weights(#[from] WeightsError),
    /// Sampling failed.
    #[error(transparent)]
    Ldi(#[from] LdiError),
    /// There is no plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The print file could not be written.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// The options contradict each other or cannot be read.
    #[error("{reason}")]
    Options {
        /// What is wrong and how to put it right.
        reason: String,
    },
    /// Masks were asked for before there was a plan.
    #[error("there is no plan yet; make one first")]
    NoPlan,
}

impl Error {
    /// Stable name of the error for programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Stl(error) => error.code(),
            Self::Mesh(error) => error.code(),
            Self::Grid(error) => error.code(),
            Self::Weights(error) => error.code(),
            Self::Ldi(error) => error.code(),
            Self::Plan(error) => error.code(),
            Self::Archive(error) => error.code(),
            Self::Options { .. } => "bad-options",
            Self::NoPlan => "no-plan",
        }
    }
}
