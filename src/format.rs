//! Print formats: names, file extensions and media types. [`crate::archive`] writes the files.

use serde::{Deserialize, Serialize};

/// A print format: a kind of file that printers or other programs read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// One-bit PNGs and a manifest.json.
    #[default]
    Png,
    /// The zip of ChiTuBox: run.gcode with a height and an exposure for every layer.
    Chitubox,
    /// UVJ: config.json with a height and an exposure for every layer.
    Uvj,
    /// Prusa's SL1 and SL1S, for layers of one thickness.
    Sl1,
    /// Elegoo's GOO, and Phrozen's PRZ.
    Goo,
    /// Anycubic's binary files of 2020 to 2023: pwmx, pm3, pm5s and others.
    PhotonWorkshop,
    /// Anycubic's zips of 2024 and later: pm4u, pm7, pwsz and others.
    AnycubicZip,
    /// CTB, version 3, not encrypted.
    Ctb,
    /// NanoDLP, for layers of one thickness.
    Nanodlp,
    /// A 3MF for PrusaSlicer: the model, and the heights of its layers, which filament printers print.
    #[serde(rename = "prusa-3mf")]
    #[cfg_attr(feature = "cli", value(name = "prusa-3mf"))]
    Prusa3mf,
    /// The same for OrcaSlicer and Bambu Studio; untried.
    #[serde(rename = "orca-3mf")]
    #[cfg_attr(feature = "cli", value(name = "orca-3mf"))]
    Orca3mf,
}

impl Format {
    /// The formats that hold masks, for resin printers.
    pub const MASKS: [Self; 9] = [
        Self::Png,
        Self::Chitubox,
        Self::Uvj,
        Self::Sl1,
        Self::Goo,
        Self::PhotonWorkshop,
        Self::AnycubicZip,
        Self::Ctb,
        Self::Nanodlp,
    ];

    /// The formats for slicers of filament printers: they hold a model and the heights of its layers, and no masks.
    pub const FILAMENT: [Self; 2] = [Self::Prusa3mf, Self::Orca3mf];

    /// All formats.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::MASKS.into_iter().chain(Self::FILAMENT)
    }

    /// Returns true if its files hold masks, for resin printers.
    pub fn has_masks(self) -> bool {
        self.row().container != Container::Model
    }

    /// Returns true if its files are zips of masks, each deflated: that takes much longer than reading their runs.
    pub fn is_zip(self) -> bool {
        self.row().container == Container::Zip
    }

    /// The formats that have a thickness for every layer, and that some printer or program is known to read it from.
    pub const VARIABLE: [Self; 5] = [Self::Goo, Self::Ctb, Self::Chitubox, Self::Uvj, Self::Png];

    /// The thicknesses that its files can have.
    pub fn thicknesses(self) -> FormatThicknesses {
        self.row().thicknesses
    }

    /// The number of greys of its masks, black and white included.
    pub fn grey_levels(self) -> u32 {
        self.row().grey_levels
    }

    /// The name of the format, as in options.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The file extension, without a dot, if no printer says otherwise.
    pub fn extension(self) -> &'static str {
        self.row().extension
    }

    /// The media type. A zip with an extension of its own is not declared as `application/zip`, because browsers might
    /// unpack or rename it.
    pub fn media_type(self) -> &'static str {
        match self.extension() {
            "zip" => "application/zip",
            "3mf" => "model/3mf",
            _ => "application/octet-stream",
        }
    }

    /// The row of the format. What writes its files is listed in [`crate::archive`], what reads them in [`crate::archive::read`].
    fn row(self) -> Row {
        let masks = |name, extension, container| Row {
            name,
            extension,
            container,
            thicknesses: FormatThicknesses::Any,
            grey_levels: 256,
        };
        match self {
            Self::Png => masks("png", "zip", Container::Zip),
            Self::Chitubox => masks("chitubox", "zip", Container::Zip),
            Self::Uvj => masks("uvj", "uvj", Container::Zip),
            Self::Sl1 => Row {
                thicknesses: FormatThicknesses::OneAboveFirst,
                ..masks("sl1", "sl1", Container::Zip)
            },
            Self::Goo => masks("goo", "goo", Container::Binary),
            Self::PhotonWorkshop => Row {
                grey_levels: 16,
                ..masks("photon-workshop", "pwmx", Container::Binary)
            },
            Self::AnycubicZip => Row {
                grey_levels: 16,
                ..masks("anycubic-zip", "pwsz", Container::Zip)
            },
            Self::Ctb => Row {
                grey_levels: 128,
                ..masks("ctb", "ctb", Container::Binary)
            },
            Self::Nanodlp => Row {
                thicknesses: FormatThicknesses::One,
                ..masks("nanodlp", "nanodlp", Container::Zip)
            },
            Self::Prusa3mf => masks("prusa-3mf", "3mf", Container::Model),
            Self::Orca3mf => masks("orca-3mf", "3mf", Container::Model),
        }
    }
}

/// Everything that distinguishes a format from others, except its words, writer and reader.
struct Row {
    name: &'static str,
    extension: &'static str,
    container: Container,
    thicknesses: FormatThicknesses,
    grey_levels: u32,
}

/// Kind of content.
#[derive(PartialEq, Eq)]
enum Container {
    /// A zip of masks.
    Zip,
    /// Masks in a layout of its own.
    Binary,
    /// The model, with the heights of its layers.
    Model,
}

/// The layer thicknesses that a file can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormatThicknesses {
    /// Each layer has its own.
    Any,
    /// One for all layers but the first.
    OneAboveFirst,
    /// One for all layers.
    One,
}
