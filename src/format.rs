//! Print formats: names, file extensions and media types. [`crate::archive`] writes the files.

use serde::{Deserialize, Serialize};

/// A print format: a kind of file that printers or other programs read.
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
    /// The formats that have a thickness for every layer.
    pub const VARIABLE: [Self; 3] = [Self::Chitubox, Self::Uvj, Self::Png];

    /// The name of the format, as in options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Chitubox => "chitubox",
            Self::Uvj => "uvj",
            Self::Sl1 => "sl1",
        }
    }

    /// The file extension, without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png | Self::Chitubox => "zip",
            Self::Uvj => "uvj",
            Self::Sl1 => "sl1",
        }
    }

    /// The media type. A zip with an extension of its own is not declared as `application/zip`, because browsers might
    /// unpack or rename it.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Png | Self::Chitubox => "application/zip",
            Self::Uvj | Self::Sl1 => "application/octet-stream",
        }
    }
}
