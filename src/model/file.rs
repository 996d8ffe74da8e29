//! The identity of a model's file, and what is known from it besides the triangles.

use serde::{Deserialize, Serialize};

use super::ModelUnit;
use super::read::{Contents, Part, PlateChoice};
use crate::crc::crc32;

/// Identifies the file of a model by its length and checksum.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ModelFile {
    /// Length in bytes.
    pub bytes: usize,
    /// CRC-32 of the contents, as in zips.
    pub crc32: u32,
    /// The plate that was read, if it is a project of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<PlateChoice>,
}

impl ModelFile {
    /// The identity of a file with these contents.
    pub fn of(bytes: &[u8]) -> Self {
        Self {
            bytes: bytes.len(),
            crc32: crc32(bytes),
            plate: None,
        }
    }
}

/// What is known from a model's file besides the triangles.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FileFacts {
    /// The identity of the file.
    pub file: ModelFile,
    /// The unit that the file states, if it does.
    pub unit: Option<ModelUnit>,
    /// Objects that are not printed; see [`Contents::skipped_objects`].
    pub skipped_objects: usize,
    /// Parts that are no solids, each once.
    pub parts: Vec<Part>,
}

impl FileFacts {
    /// The facts of a file with these bytes, read as `contents`.
    pub fn new(bytes: &[u8], contents: &Contents) -> Self {
        Self {
            file: ModelFile {
                plate: contents.plate,
                ..ModelFile::of(bytes)
            },
            unit: contents.unit,
            skipped_objects: contents.skipped_objects,
            parts: contents.parts.clone(),
        }
    }
}
