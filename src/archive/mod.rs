//! Print files: zips of masks, one file a format.
//!
//! A format says how masks are named and stored and which other files there are; this module encodes the masks on all
//! cores and writes the zip.

mod chitubox;
mod plain;
pub mod png;
mod preview;
pub mod runs;
mod sl1;
mod uvj;

use std::io::Write;
use std::ops::Range;

use flate2::{Compress, Compression, FlushCompress};
use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};
use serde::Serialize;

use crate::exposure::Resin;
use crate::format::Format;
use crate::ldi::Ldi;
use crate::mask::{Light, MaskCursor, Masks};
use crate::mesh::Mesh;
use crate::parallel::map_in_groups;
use crate::printer::Printer;
use crate::progress::{Cancelled, Progress, report};
use crate::report::Report;

impl Format {
    fn container(self) -> &'static dyn Container {
        match self {
            Self::Png => &plain::Plain,
            Self::Chitubox => &chitubox::Chitubox,
            Self::Uvj => &uvj::Uvj,
            Self::Sl1 => &sl1::Sl1,
        }
    }
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

    fn write(error: impl std::fmt::Display) -> Self {
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
pub struct Job<'a> {
    /// The masks, seen from the side that the printer lights from.
    pub masks: &'a Masks,
    /// The plan.
    pub report: &'a Report,
    /// The printer, if it is one that is known by name.
    pub printer: Option<&'a Printer>,
    /// The resin.
    pub resin: &'a Resin,
    /// The model, for previews.
    pub mesh: &'a Mesh,
    /// The rays that it was sampled along.
    pub ldi: &'a Ldi,
}

/// A layer of a print file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerEntry {
    /// Name of the mask in the zip.
    pub file: String,
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// Thickness of the layer in millimetres.
    pub thickness_mm: f64,
    /// Seconds of exposure.
    pub exposure_s: f64,
    /// White pixels of the mask.
    pub lit_pixels: u64,
}

/// Name and contents of a file in a zip.
type File = (String, Vec<u8>);

/// What tells formats apart.
trait Container: Sync {
    /// Refuses a plan that the format cannot express.
    fn check(&self, _job: &Job<'_>) -> Result<(), ArchiveError> {
        Ok(())
    }

    /// How masks are stored whose pixels are either lit or dark; all others are grey.
    fn depth(&self) -> png::Depth {
        png::Depth::Grey
    }

    /// The name of a layer's mask.
    fn mask_name(&self, layer: usize) -> String;

    /// The files beside the masks.
    fn files(&self, job: &Job<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError>;
}

/// Layers that one thread encodes in a row; the mask is copied once for each such run.
const RUN: usize = 8;

/// Writes a print file from its beginning to its end, and returns the writer.
///
/// The bytes depend on the job alone, not on threads or machine. Whatever their number and size, they are written right:
/// from 65,535 files or 4 GiB on by the rules of zip64.
///
/// # Errors
/// [`ArchiveError`].
pub fn write<W: Write>(
    format: Format,
    job: &Job<'_>,
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    let container = format.container();
    container.check(job)?;
    let Job { masks, report, .. } = *job;
    let mut zip = ZipArchiveWriter::new(writer);
    let mut layers: Vec<LayerEntry> = Vec::with_capacity(masks.layers());

    let mut ahead = masks.cursor();
    let runs = (0..masks.layers()).step_by(RUN).map(|first| {
        ahead.seek(masks, first);
        (ahead.clone(), first..(first + RUN).min(masks.layers()))
    });
    map_in_groups(
        runs,
        |(cursor, layers)| encode_run(container, masks, cursor, layers),
        |encoded: Result<Vec<Mask>, ArchiveError>| {
            for Mask { png, lit_pixels } in encoded? {
                let layer = layers.len();
                let file = container.mask_name(layer);
                add(&mut zip, &file, &png)?;
                layers.push(LayerEntry {
                    file,
                    z_mm: report.z_mm[layer + 1],
                    thickness_mm: report.thickness_mm[layer],
                    exposure_s: report.exposure_s[layer],
                    lit_pixels,
                });
            }
            Ok::<_, ArchiveError>(())
        },
        progress,
        [0.0, 1.0],
    )?;

    if layers.iter().all(|layer| layer.lit_pixels == 0) {
        return Err(ArchiveError::AllBlack);
    }
    let mut deflater = Deflater::new();
    for (name, bytes) in container.files(job, &layers)? {
        add(&mut zip, &name, &deflater.deflate(&bytes)?)?;
    }
    zip.finish().map_err(ArchiveError::write)
}

/// Adds a file. Without dates archives are reproducible.
fn add<W: Write>(
    zip: &mut ZipArchiveWriter<W>,
    name: &str,
    file: &Deflated,
) -> Result<(), ArchiveError> {
    let builder = zip
        .new_file(name)
        .compression_method(CompressionMethod::DEFLATE);
    let (mut entry, _) = builder.start().map_err(ArchiveError::write)?;
    entry.write_all(&file.bytes).map_err(ArchiveError::write)?;
    let sum = DataDescriptorOutput::new(file.crc, file.length);
    entry.finish(sum).map_err(ArchiveError::write)?;
    Ok(())
}

/// A file as it stands in a zip.
struct Deflated {
    bytes: Vec<u8>,
    crc: u32,
    length: u64,
}

/// Deflates file after file.
struct Deflater(Compress);

impl Deflater {
    /// Streams of masks repeat themselves at short distances, which the fourth level finds: the first takes a quarter of
    /// the time, but leaves a sixth more.
    const LEVEL: u32 = 4;

    fn new() -> Self {
        Self(Compress::new(Compression::new(Self::LEVEL), false))
    }

    fn deflate(&mut self, file: &[u8]) -> Result<Deflated, ArchiveError> {
        self.0.reset();
        let mut bytes = Vec::with_capacity(file.len() / 2 + 1024);
        loop {
            let rest = &file[self.0.total_in() as usize..];
            let status = self.0.compress_vec(rest, &mut bytes, FlushCompress::Finish);
            match status.map_err(ArchiveError::write)? {
                flate2::Status::StreamEnd => break,
                _ => bytes.reserve(file.len() / 2 + 1024),
            }
        }
        Ok(Deflated {
            bytes,
            crc: rawzip::crc32(file),
            length: file.len() as u64,
        })
    }
}

struct Mask {
    png: Deflated,
    lit_pixels: u64,
}

fn encode_run(
    container: &dyn Container,
    masks: &Masks,
    mut cursor: MaskCursor,
    layers: Range<usize>,
) -> Result<Vec<Mask>, ArchiveError> {
    let depth = match cursor.light() {
        Light::Bits(_) => container.depth(),
        Light::Samples(_) => png::Depth::Grey,
    };
    let mut deflater = Deflater::new();
    layers
        .map(|layer| {
            cursor.seek(masks, layer);
            Ok(Mask {
                png: deflater.deflate(&png::encode(masks, &cursor, depth))?,
                lit_pixels: cursor.lit_pixels(),
            })
        })
        .collect()
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
