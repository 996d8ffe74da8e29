//! Print files that are zips of masks. Each format has a source file of its own.
//!
//! A format decides how masks are named and stored, and which other files the zip holds. This module encodes the masks on
//! all cores and writes the zip.

pub mod anycubic;
pub mod chitubox;
pub mod masks;
pub mod nanodlp;
mod settings;
pub mod sl1;
pub mod uvj;

use std::cell::RefCell;
use std::io::Write;

use flate2::{Compress, Compression, FlushCompress};
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};
use serde::Serialize;
use serde_json::Value;

use super::png::Depth;
use super::survey::{Bounds, Survey, joined};
use super::{ArchiveError, Canvas, EncodedLayer, Encoder, Layer, PrintJob, encode_layers};
use crate::archive::png;
use crate::mask::{LayerRuns, Run};
use crate::progress::Progress;

/// A layer of a print file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerEntry {
    /// Name of the mask in the zip.
    pub file: String,
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// Thickness of the layer in millimetres.
    pub thickness_mm: f64,
    /// Exposure in seconds.
    pub exposure_s: f64,
    /// Number of pixels of the mask that are not black.
    pub lit_pixels: u64,
    /// Its lit areas, for formats that state them.
    #[serde(skip)]
    pub survey: Option<Survey>,
}

impl LayerEntry {
    /// The survey, in a format that asks for surveys.
    fn survey(&self) -> &Survey {
        let survey = self.survey.as_ref();
        survey.expect("layers of this format are surveyed")
    }
}

/// The box of the lit pixels of all layers.
fn joined_bounds(layers: &[LayerEntry]) -> Option<Bounds> {
    let bounds = layers.iter().filter_map(|layer| layer.survey().bounds);
    bounds.reduce(joined)
}

/// A file of JSON.
fn json_file(name: &str, value: &Value) -> Result<File, ArchiveError> {
    let bytes = serde_json::to_vec(value).map_err(ArchiveError::write)?;
    Ok((name.to_owned(), bytes))
}

/// Name and contents of a file in a zip.
pub type File = (String, Vec<u8>);

/// A zip format of masks and settings.
pub trait Container: Sync {
    /// The name of a layer's mask.
    fn mask_name(&self, layer: usize) -> String;

    /// Encodes a mask.
    fn mask(&self, canvas: Canvas, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        png::encode(runs, canvas.pixels, Depth::Grey)
    }

    /// Returns true if [`LayerEntry::survey`] is needed.
    fn needs_survey(&self) -> bool {
        false
    }

    /// The files besides the masks.
    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError>;
}

/// Encodes a container.
pub struct Zip(pub &'static dyn Container);

impl Encoder for Zip {
    fn layer(
        &self,
        canvas: Canvas,
        runs: &LayerRuns,
        layer: usize,
    ) -> Result<EncodedLayer, ArchiveError> {
        let runs = || runs.of_layer(layer);
        let file = deflate(&self.0.mask(canvas, &mut runs()))?;
        let survey = || Survey::of(runs(), canvas.pixels);
        Ok(EncodedLayer {
            inflated: Some((file.crc, file.length)),
            survey: self.0.needs_survey().then(survey),
            ..EncodedLayer::new(file.bytes, runs())
        })
    }

    /// There is no limit on the number and size of files: from 65,535 files or 4 GiB on, the zip is a zip64.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError> {
        let container = self.0;
        let mut zip = ZipArchiveWriter::new(writer);
        let mut layers: Vec<LayerEntry> = Vec::with_capacity(job.layers.len());
        encode_layers(
            job,
            self,
            &mut |layer, encoded| {
                let name = container.mask_name(layer);
                let (crc, length) = encoded.inflated.unwrap_or_default();
                let file = Deflated {
                    bytes: encoded.data,
                    crc,
                    length,
                };
                add(&mut zip, &name, &file)?;
                let Layer {
                    z_mm,
                    thickness_mm,
                    exposure_s,
                } = job.layers[layer];
                layers.push(LayerEntry {
                    file: name,
                    z_mm,
                    thickness_mm,
                    exposure_s,
                    lit_pixels: encoded.lit_pixels,
                    survey: encoded.survey,
                });
                Ok(())
            },
            progress,
        )?;
        for (name, bytes) in container.files(job, &layers)? {
            add(&mut zip, &name, &deflate(&bytes)?)?;
        }
        zip.finish().map_err(ArchiveError::write)?;
        Ok(())
    }
}

/// The modification time of all files: the earliest that a zip can store. With the real time, the same plan would give
/// different bytes each time.
pub const MODIFIED: UtcDateTime = match UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0) {
    Some(date) => date,
    None => unreachable!(),
};

/// Adds a file to the zip.
fn add<W: Write>(
    zip: &mut ZipArchiveWriter<W>,
    name: &str,
    file: &Deflated,
) -> Result<(), ArchiveError> {
    let builder = zip
        .new_file(name)
        .compression_method(CompressionMethod::DEFLATE)
        .last_modified(MODIFIED);
    let (mut entry, _) = builder.start().map_err(ArchiveError::write)?;
    entry.write_all(&file.bytes).map_err(ArchiveError::write)?;
    let sum = DataDescriptorOutput::new(file.crc, file.length);
    entry.finish(sum).map_err(ArchiveError::write)?;
    Ok(())
}

/// A file as stored in a zip.
struct Deflated {
    bytes: Vec<u8>,
    crc: u32,
    length: u64,
}

thread_local! {
    /// Made once for each thread: its tables take a third of a megabyte.
    static DEFLATER: RefCell<Deflater> = RefCell::new(Deflater::new());
}

/// Deflates a file.
fn deflate(file: &[u8]) -> Result<Deflated, ArchiveError> {
    DEFLATER.with_borrow_mut(|deflater| deflater.deflate(file))
}

/// Deflates one file after another.
struct Deflater(Compress);

impl Deflater {
    /// Streams of masks repeat at short distances, which level 4 finds. Level 1 takes a quarter of the time, but leaves
    /// files a sixth larger.
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
            crc: crate::crc::crc32(file),
            length: file.len() as u64,
        })
    }
}
