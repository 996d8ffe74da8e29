//! Errors of reading a print file, or a layer of it.

use serde::Serialize;

use super::Format;

/// Names of the formats that can be read, for a sentence.
fn known() -> String {
    let [others @ .., last] = Format::MASKS.map(Format::name);
    format!("{} or {last}", others.join(", "))
}

/// A kind of print file that is recognised, and cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum UnreadKind {
    /// The file of the first ChiTuBox printers: photon and cbddlp.
    Cbddlp,
    /// A file of Photon Workshop whose masks are planes of bits: pws, pw0 and pwx.
    PlanesOfBits,
    /// A zip of Anycubic whose layers are outlines.
    Outlines,
}

impl UnreadKind {
    fn in_words(self) -> &'static str {
        match self {
            Self::Cbddlp => "a cbddlp or photon file of the first ChiTuBox printers",
            Self::PlanesOfBits => "a Photon Workshop file with one plane of bits a grey",
            Self::Outlines => "an Anycubic zip with outlines instead of masks",
        }
    }
}

/// Error of reading a print file. `Display` writes one sentence that begins with the file as "it"; serialised, an error
/// is its code and an object of typed details.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PrintFileError {
    /// Neither a zip nor a binary print file.
    #[error(
        "it is no print file that can be read; give one in the format {}",
        known()
    )]
    UnknownKind,
    /// A zip, but damaged.
    #[error("it is a damaged zip ({system}); copy or export it again")]
    DamagedZip {
        /// The zip reader's message.
        system: String,
    },
    /// A zip, but without the settings of any known format.
    #[error(
        "it is a zip without the settings of any known format, such as run.gcode or manifest.json, so its heights are \
         unknown; give a print file in the format {}",
        known()
    )]
    UnknownZip,
    /// A 3MF: a model without masks, maybe with layers for slicers of filament printers.
    #[error(
        "it is a 3MF model{}, not a print file: it has no masks; {}",
        if *has_layers { " with layers for slicers of filament printers" } else { "" },
        if *has_layers {
            "open it in that slicer, or slice it here for a resin printer"
        } else {
            "slice it first"
        }
    )]
    Model {
        /// True if it has layers, as the formats prusa-3mf and orca-3mf have.
        has_layers: bool,
    },
    /// A CTB that only its maker's programs and printers can read.
    #[error(
        "it is an encrypted CTB file, which cannot be read without its maker's key; save it again as plain CTB, as GOO or \
         as a zip of masks"
    )]
    EncryptedCtb,
    /// A print file of a kind that cannot be read.
    #[error(
        "it is {}, which cannot be read; save it again in the format {}",
        kind.in_words(),
        known()
    )]
    Unread {
        /// The kind.
        kind: UnreadKind,
    },
    /// A version of a format that cannot be read.
    #[error(
        "it is a {} file of version {version}, which cannot be read; save it again as version {known}",
        format.name()
    )]
    UnknownVersion {
        /// The format.
        format: Format,
        /// The file's version.
        version: String,
        /// The versions that can be read.
        known: &'static str,
    },
    /// The file ends too early.
    #[error(
        "it is cut short: its settings need {needed_bytes} bytes, and it has {found_bytes}; copy or export it again"
    )]
    Truncated {
        /// Length that its settings require.
        needed_bytes: u64,
        /// Length of the file.
        found_bytes: u64,
    },
    /// It declares more layers than it can hold.
    #[error("it declares {layers} layers and has room for {most} at most; copy or export it again")]
    TooManyLayers {
        /// Number of layers that the settings declare.
        layers: u64,
        /// The most that fit into a file of this size.
        most: u64,
    },
    /// A file of the zip is missing.
    #[error("it has no {name}, although its settings count on it; export it again")]
    MissingFile {
        /// Name in the zip.
        name: String,
    },
    /// A file of the zip cannot be read.
    #[error("its {name} cannot be read ({system}); export it again")]
    BadFile {
        /// Name in the zip.
        name: String,
        /// The parser's message.
        system: String,
    },
    /// A file of the zip is larger than it can be.
    #[error("its {name} unpacks to more than {most_bytes} bytes; export it again")]
    TooLarge {
        /// Name in the zip.
        name: String,
        /// The largest size allowed.
        most_bytes: u64,
    },
    /// A setting is missing or invalid.
    #[error("its {file} does not say {setting} in a form that can be read; export it again")]
    BadSetting {
        /// Name in the zip, or of the table in a binary file.
        file: String,
        /// Name of the setting.
        setting: String,
    },
    /// More pixels than a mask can have.
    #[error("its masks are {width} × {height} pixels, and there can be {max_side} a side")]
    TooManyPixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Maximum number in x and y.
        max_side: u32,
    },
    /// The mask of a layer cannot be read.
    #[error("its layer {layer} cannot be read: {fault}; export it again")]
    Layer {
        /// Number of the layer, from 1.
        layer: usize,
        /// The fault.
        fault: LayerFault,
    },
}

impl PrintFileError {
    pub(super) fn bad_setting(file: &str, setting: &str) -> Self {
        Self::BadSetting {
            file: file.to_owned(),
            setting: setting.to_owned(),
        }
    }

    pub(super) fn bad_file(name: &str, error: &dyn std::fmt::Display) -> Self {
        Self::BadFile {
            name: name.to_owned(),
            system: error.to_string(),
        }
    }
}

/// Fault in the mask of a layer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LayerFault {
    /// It is not in the zip.
    #[error("there is no {name}")]
    MissingMask {
        /// Name in the zip.
        name: String,
    },
    /// It cannot be unpacked or decoded.
    #[error("{name} is damaged ({system})")]
    BadMask {
        /// Name in the zip.
        name: String,
        /// The decoder's message.
        system: String,
    },
    /// It has another size than the settings say.
    #[error("{name} is {width} × {height} pixels, and the settings ask for {columns} × {rows}")]
    MaskSize {
        /// Name in the zip.
        name: String,
        /// Columns of the image.
        width: u32,
        /// Rows of the image.
        height: u32,
        /// Columns that it should have.
        columns: u32,
        /// Rows that it should have.
        rows: u32,
    },
    /// Its data lies beyond the end of the file.
    #[error("its data ends at byte {end_byte}, and the file at byte {file_bytes}")]
    OutsideFile {
        /// End of the data in the file.
        end_byte: u64,
        /// Length of the file.
        file_bytes: u64,
    },
    /// Its data is no sequence of runs.
    #[error("byte {byte} of its data is no run of pixels")]
    BadRun {
        /// Offset in the layer's data.
        byte: u64,
    },
    /// Its runs end before the last pixel.
    #[error("its runs cover {pixels} of {expected} pixels")]
    TooFewPixels {
        /// Pixels that they cover.
        pixels: u64,
        /// Pixels of the mask.
        expected: u64,
    },
    /// Its runs go on after the last pixel.
    #[error("its runs cover more than {expected} pixels")]
    TooManyPixels {
        /// Pixels of the mask.
        expected: u64,
    },
    /// Its data was changed after it was written.
    #[error("its checksum is {stated}, and that of its data {computed}")]
    WrongChecksum {
        /// The checksum in the file.
        stated: u8,
        /// The checksum of the data.
        computed: u8,
    },
}
