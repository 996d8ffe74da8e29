//! Print files: one file a container format.

pub mod png_zip;

use serde::Serialize;

use crate::progress::Cancelled;

/// Why a print file could not be written.
#[derive(Debug, thiserror::Error, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum ArchiveError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No pixel of any mask is lit.
    #[error(
        "all masks are black: the model encloses nothing that the middle of a layer meets; check \
         the model, or choose thinner layers"
    )]
    AllBlack,
    /// Bytes could not be written: the disk is full, say.
    #[error("the print file could not be written: {reason}")]
    Write {
        /// What the system said.
        reason: String,
    },
}

impl ArchiveError {
    /// Stable name of the error for programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Cancelled(_) => "cancelled",
            Self::AllBlack => "all-black",
            Self::Write { .. } => "archive-write",
        }
    }

    fn write(error: impl std::fmt::Display) -> Self {
        Self::Write {
            reason: error.to_string(),
        }
    }
}
