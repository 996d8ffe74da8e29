//! Print files, one file a format, from masks, plan and exposures.

pub mod png;
mod preview;
pub mod runs;
mod zip;

use std::io::Write;

use serde::Serialize;
use serde_json::Value;

use crate::format::Format;
use crate::ldi::Ldi;
use crate::mask::Masks;
use crate::model::Mesh;
use crate::plan::Plan;
use crate::printer::Printer;
use crate::progress::{Cancelled, Progress, report};
use crate::resin::Resin;

/// The encoder of a format.
fn encoder(format: Format) -> &'static dyn Encoder {
    match format {
        Format::Png => &zip::Zip(zip::png::Png),
        Format::Chitubox => &zip::Zip(zip::chitubox::Chitubox),
        Format::Uvj => &zip::Zip(zip::uvj::Uvj),
        Format::Sl1 => &zip::Zip(zip::sl1::Sl1),
    }
}

/// What tells formats apart. A zip of masks is a [`zip::Container`] instead, in a [`zip::Zip`].
trait Encoder {
    /// Refuses a plan that the format cannot express.
    fn check(&self, _job: &PrintJob<'_>) -> Result<(), ArchiveError> {
        Ok(())
    }

    /// Writes the file from its beginning to its end. Fails with [`ArchiveError::AllBlack`] if no mask is lit.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError>;
}

/// Why a print file could not be written.
#[derive(Debug, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ArchiveError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    #[serde(rename = "cancelled")]
    Cancelled(#[from] Cancelled),
    /// No pixel of any mask is lit.
    #[error(
        "all masks are black: the model encloses nothing that the middle of a layer meets; check \
         the model, or choose thinner layers"
    )]
    #[serde(rename = "all-black")]
    AllBlack,
    /// The format has one thickness for all layers, and the plan has several.
    #[error(
        "{format} files have one thickness for all layers, and this plan has several; choose the format chitubox, uvj or \
         png, or the uniform planner"
    )]
    #[serde(rename = "uniform-only")]
    UniformOnly {
        /// The format asked for.
        format: &'static str,
    },
    /// Bytes could not be written: the disk is full, say.
    #[error("the print file could not be written: {reason}")]
    #[serde(rename = "archive-write")]
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
            Self::UniformOnly { .. } => "uniform-only",
            Self::Write { .. } => "archive-write",
        }
    }

    /// The error of a write that failed.
    pub(crate) fn write(error: impl std::fmt::Display) -> Self {
        Self::Write {
            reason: error.to_string(),
        }
    }
}

impl From<std::io::Error> for ArchiveError {
    fn from(error: std::io::Error) -> Self {
        Self::write(error)
    }
}

/// What a print file is made from.
#[derive(Clone, Copy)]
pub struct PrintJob<'a> {
    /// The masks, seen from the side that the printer lights from.
    pub masks: &'a Masks,
    /// Whether that is from below: rows run from right to left.
    pub is_mirrored: bool,
    /// The plan.
    pub plan: &'a Plan,
    /// Height of the model in millimetres; the plan's top may differ by part of a layer.
    pub height_mm: f64,
    /// Seconds of exposure of each layer.
    pub exposure_s: &'a [f64],
    /// The resin.
    pub resin: &'a Resin,
    /// Resin that the model takes, in millilitres.
    pub resin_ml: f64,
    /// The printer, if one was named.
    pub printer: Option<&'a Printer>,
    /// The model, for previews.
    pub mesh: &'a Mesh,
    /// The rays that it was sampled along.
    pub ldi: &'a Ldi,
    /// An object that describes the whole job, for formats of ours.
    pub manifest: &'a Value,
}

impl PrintJob<'_> {
    /// Time that the layers take, in seconds.
    fn print_time_s(&self) -> f64 {
        self.plan.print_time_s(self.resin)
    }
}

/// Writes a print file from its beginning to its end, and returns the writer.
///
/// The bytes depend on the job alone, not on threads or machine.
///
/// # Errors
/// [`ArchiveError`].
pub fn write<W: Write>(
    format: Format,
    job: &PrintJob<'_>,
    mut writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    let encoder = encoder(format);
    encoder.check(job)?;
    encoder.encode(job, &mut writer, progress)?;
    Ok(writer)
}

/// Text of numbers without idle digits: to a thousandth of the unit.
fn thousandths(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() || text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
