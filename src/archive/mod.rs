//! Print files from masks, plan and exposures. Each format has a source file of its own.

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
        Format::Png => &zip::Zip(&zip::png::Png),
        Format::Chitubox => &zip::Zip(&zip::chitubox::Chitubox),
        Format::Uvj => &zip::Zip(&zip::uvj::Uvj),
        Format::Sl1 => &zip::Zip(&zip::sl1::Sl1),
    }
}

/// What differs between formats. A zip of masks implements [`zip::Container`] instead, and [`zip::Zip`] encodes it.
trait Encoder {
    /// Refuses a plan that the format cannot express.
    fn check(&self, _job: &PrintJob<'_>) -> Result<(), ArchiveError> {
        Ok(())
    }

    /// Writes the file sequentially, without seeking. Fails with [`ArchiveError::AllBlack`] if every mask is black.
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
        "{} files have one thickness for all layers, and this plan has several; choose {}, or the \
         uniform planner",
        format.name(),
        others.map(Format::name).join(", ")
    )]
    #[serde(rename = "uniform-only")]
    UniformOnly {
        /// The format asked for.
        format: Format,
        /// The formats that have several.
        others: [Format; 3],
    },
    /// Bytes could not be written: the disk is full, say.
    #[error("the print file could not be written: {system}")]
    #[serde(rename = "archive-write")]
    Write {
        /// What the system said, untranslated.
        system: String,
    },
}

impl ArchiveError {
    /// Wraps the error of a failed write.
    pub(crate) fn write(error: impl std::fmt::Display) -> Self {
        Self::Write {
            system: error.to_string(),
        }
    }
}

impl From<std::io::Error> for ArchiveError {
    fn from(error: std::io::Error) -> Self {
        Self::write(error)
    }
}

/// Everything that goes into a print file.
#[derive(Clone, Copy)]
pub struct PrintJob<'a> {
    /// The masks, as the printer shows them.
    pub masks: &'a Masks,
    /// Whether they are mirrored left to right, for a printer that lights the resin from below.
    pub is_mirrored: bool,
    /// The plan.
    pub plan: &'a Plan,
    /// Height of the model in millimetres. The plan's top may differ from it by part of a layer.
    pub height_mm: f64,
    /// Exposure of each layer in seconds.
    pub exposure_s: &'a [f64],
    /// The resin.
    pub resin: &'a Resin,
    /// Volume of resin in the model, in millilitres.
    pub resin_ml: f64,
    /// The printer, if the job names one.
    pub printer: Option<&'a Printer>,
    /// The model, for previews.
    pub mesh: &'a Mesh,
    /// The hits of the model's rays, for previews.
    pub ldi: &'a Ldi,
    /// Makes an object that describes the whole job, for formats of our own.
    pub manifest: &'a dyn Fn() -> Result<Value, serde_json::Error>,
}

impl PrintJob<'_> {
    /// Total time of all layers, in seconds.
    fn print_time_s(&self) -> f64 {
        self.plan.print_time_s(self.resin)
    }
}

/// Writes a print file sequentially, without seeking, and returns the writer.
///
/// The bytes depend on the job alone, not on the number of threads or the machine.
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

/// Formats a number to at most three decimals, without trailing zeros.
fn thousandths(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() || text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
