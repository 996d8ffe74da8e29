//! Kinds of print files: what they are called, and what leaves with them. [`crate::archive`] writes them.

use serde::{Deserialize, Serialize};

/// A file that printers or other programs take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// One-bit PNGs and a manifest.json.
    #[default]
    Png,
    /// The zip of `ChiTuBox`: run.gcode with a height and an exposure for every layer.
    Chitubox,
    /// UVJ: config.json with a height and an exposure for every layer.
    Uvj,
    /// Prusa's SL1 and SL1S, for layers of one thickness.
    Sl1,
}

impl Format {
    /// What the name of such a file ends with, without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png | Self::Chitubox => "zip",
            Self::Uvj => "uvj",
            Self::Sl1 => "sl1",
        }
    }

    /// The media type of such a file. A zip with an extension of its own is no `application/zip`, or browsers would
    /// unpack or rename it.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Png | Self::Chitubox => "application/zip",
            Self::Uvj | Self::Sl1 => "application/octet-stream",
        }
    }
}
