//! What a model's file is known by.

use serde::{Deserialize, Serialize};

/// What a model's file is known by.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ModelFile {
    /// Its length.
    pub bytes: usize,
    /// Its CRC-32, as zips have it.
    pub crc32: u32,
}
