//! Print files that are zips of masks. Each format has a source file of its own.
//!
//! A format decides how masks are named and stored, and which other files the zip holds. This module encodes the masks on
//! all cores and writes the zip.

pub mod chitubox;
pub mod png;
pub mod sl1;
pub mod uvj;

use std::io::Write;
use std::ops::Range;

use flate2::{Compress, Compression, FlushCompress};
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};
use serde::Serialize;

use super::png::{Depth, encode};
use super::{ArchiveError, Encoder, PrintJob};
use crate::mask::{Light, MaskCursor, Masks};
use crate::parallel::map_in_groups;
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
}

/// Name and contents of a file in a zip.
pub type File = (String, Vec<u8>);

/// What differs between formats.
pub trait Container: Sync {
    /// Refuses a plan that the format cannot express.
    fn check(&self, _job: &PrintJob<'_>) -> Result<(), ArchiveError> {
        Ok(())
    }

    /// How masks without anti-aliasing are stored. Masks with it are always grey.
    fn depth(&self) -> Depth {
        Depth::Grey
    }

    /// The name of a layer's mask.
    fn mask_name(&self, layer: usize) -> String;

    /// The files besides the masks.
    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError>;
}

/// Encodes a container.
pub struct Zip(pub &'static dyn Container);

/// Number of consecutive layers that one thread encodes. The mask is copied once for each such run.
const RUN: usize = 8;

impl Encoder for Zip {
    fn check(&self, job: &PrintJob<'_>) -> Result<(), ArchiveError> {
        self.0.check(job)
    }

    /// There is no limit on the number and size of files: from 65,535 files or 4 GiB on, the zip is a zip64.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError> {
        let container = self.0;
        let PrintJob {
            masks,
            plan,
            exposure_s,
            ..
        } = *job;
        let (z_mm, thickness_mm) = (plan.z_mm(), plan.thickness_mm());
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
                        z_mm: z_mm[layer + 1],
                        thickness_mm: thickness_mm[layer],
                        exposure_s: exposure_s[layer],
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
        zip.finish().map_err(ArchiveError::write)?;
        Ok(())
    }
}

/// The modification time of all files: the earliest that a zip can store. With the real time, the same plan would give
/// different bytes each time.
const MODIFIED: UtcDateTime = match UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0) {
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
        Light::Samples(_) => Depth::Grey,
    };
    let mut deflater = Deflater::new();
    layers
        .map(|layer| {
            cursor.seek(masks, layer);
            Ok(Mask {
                png: deflater.deflate(&encode(masks, &cursor, depth))?,
                lit_pixels: cursor.lit_pixels(),
            })
        })
        .collect()
}
