//! Why a print file cannot be simulated.

use crate::model::MeshError;
use crate::progress::Cancelled;

/// Why a print file cannot be simulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The model cannot stand in the pose of the print file.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The print file is no zip, or a damaged one.
    #[error(
        "it is not a zip of masks ({system}); give a print file in the format png, chitubox, uvj or sl1"
    )]
    NotAZip {
        /// What the reader of zips said.
        system: String,
    },
    /// A zip, but without the settings of any known format.
    #[error(
        "it has none of run.gcode, config.json, config.ini and manifest.json, so its heights are unknown; give a print \
         file in the format png, chitubox, uvj or sl1"
    )]
    UnknownFormat,
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
        /// What a parser said.
        system: String,
    },
    /// A setting is missing, or is not what it must be.
    #[error("its {file} does not say {setting} in a form that can be read; export it again")]
    BadSetting {
        /// Name in the zip.
        file: String,
        /// Name of the setting.
        setting: String,
    },
    /// A mask has another size than the settings say.
    #[error(
        "its mask {name} is {width} × {height} pixels, but its settings say {columns} × {rows}; export it again"
    )]
    MaskSize {
        /// Name in the zip.
        name: String,
        /// Columns of the mask.
        width: u32,
        /// Rows of the mask.
        height: u32,
        /// Columns by the settings.
        columns: u32,
        /// Rows by the settings.
        rows: u32,
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
    /// A layer is not above the one before.
    #[error("its layer {layer} ends at {z_mm} mm, not above the layer below; export it again")]
    ZOrder {
        /// Number of the layer, from 1.
        layer: usize,
        /// Its top.
        z_mm: f64,
    },
    /// No pixel of any mask is lit.
    #[error("no pixel of its masks is lit, so it prints nothing; slice the model again")]
    AllBlack,
}
