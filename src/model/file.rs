//! The identity of a model's file, and facts about it besides the triangles.

use serde::{Deserialize, Serialize};

use super::ModelUnit;
use super::read::{Contents, Part, PlateChoice, ReadOptions};
use crate::crc::crc32;

/// Identifies the file of a model by its length and checksum.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent choices, each of which may be made or not"
)]
pub struct ModelFile {
    /// Length in bytes.
    pub bytes: usize,
    /// CRC-32 of the contents, as in zips.
    pub crc32: u32,
    /// The plate that was read, if it is a project of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<PlateChoice>,
    /// See [`ReadOptions::surfaces`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub surfaces: bool,
    /// See [`ReadOptions::curved_caps`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub curved_caps: bool,
    /// See [`ReadOptions::supports_as_model`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub supports_as_model: bool,
    /// See [`ReadOptions::mirrored`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirrored: bool,
}

impl ModelFile {
    /// The identity of a file with these contents.
    pub fn of(bytes: &[u8]) -> Self {
        Self {
            bytes: bytes.len(),
            crc32: crc32(bytes),
            plate: None,
            surfaces: false,
            curved_caps: false,
            supports_as_model: false,
            mirrored: false,
        }
    }

    /// The choices with which it was read.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions {
            plate_number: self.plate.map(|plate| plate.plate_number),
            surfaces: self.surfaces,
            curved_caps: self.curved_caps,
            supports_as_model: self.supports_as_model,
            mirrored: self.mirrored,
        }
    }
}

/// Facts about a model's file besides its triangles.
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
    /// The facts of a file, read with these choices as `contents`.
    pub fn new(file: &ModelFile, options: &ReadOptions, contents: &Contents) -> Self {
        Self {
            file: ModelFile {
                plate: contents.plate,
                surfaces: options.surfaces,
                curved_caps: options.curved_caps,
                supports_as_model: options.supports_as_model,
                mirrored: options.mirrored,
                ..*file
            },
            unit: contents.unit,
            skipped_objects: contents.skipped_objects,
            parts: contents.parts.clone(),
        }
    }
}
