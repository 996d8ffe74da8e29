//! Errors of simulating a print file.

use crate::archive::read::PrintFileError;
use crate::model::MeshError;
use crate::progress::Cancelled;

/// Error of simulating a print file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A model cannot stand in the pose of the print file.
    #[error("{error}")]
    Mesh {
        /// The model, by its index.
        model: usize,
        /// Error of its mesh.
        error: MeshError,
    },
    /// The copies cannot stand where the print file places them.
    #[error(transparent)]
    Places(#[from] MeshError),
    /// The print file cannot be read.
    #[error(transparent)]
    File(#[from] PrintFileError),
    /// A model stands in its masks that was not given.
    #[error(
        "it prints a model {model_number}, and {models} {} given; give all models in their order, or the job file",
        if *models == 1 { "is" } else { "are" }
    )]
    NoModel {
        /// The model, counted from 1.
        model_number: usize,
        /// Models that were given.
        models: usize,
    },
    /// Several models are given, and nothing says where their copies stand.
    #[error(
        "it does not say where its copies stand; give a job file with places, as `cusp plate` writes it"
    )]
    NoPlaces,
    /// A layer is not above the one before.
    #[error("its layer {layer} ends at {z_mm} mm, not above the layer below; export it again")]
    ZOrder {
        /// Number of the layer, from 1.
        layer: usize,
        /// Its top.
        z_mm: f64,
    },
    /// A layer without an exposure, where cure below layers is simulated.
    #[error(
        "its layer {layer} states no exposure, which says how deep it cures; convert it to a format that does"
    )]
    NoExposure {
        /// Number of the layer, from 1.
        layer: usize,
    },
    /// No pixel of any mask is lit.
    #[error("no pixel of its masks is lit, so it prints nothing; slice the model again")]
    AllBlack,
}
