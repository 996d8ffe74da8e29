//! The identity of a model's file.

use serde::{Deserialize, Serialize};

/// Identifies the file of a model by its length and checksum.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ModelFile {
    /// Length in bytes.
    pub bytes: usize,
    /// CRC-32 of the contents, as in zips.
    pub crc32: u32,
}
