//! A zip of one-bit PNG masks with a manifest: the default download.
//!
//! `layers/00000.png` upward from the plate, white where the resin is cured, row 0 at the largest y;
//! `manifest.json` is the report with an entry for every layer.

use std::io::{Seek, Write};
use std::ops::Range;

use serde::Serialize;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::ArchiveError;
use crate::mask::{MaskCursor, Masks};
use crate::parallel::map_in_groups;
use crate::progress::{Progress, report};
use crate::report::{Report, Warning, counted};

/// Layers that one thread encodes in a row; the mask is copied once for each such run.
const RUN: usize = 4;

/// A layer in `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerEntry {
    /// Name of the mask in the zip.
    pub file: String,
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// Thickness of the layer in millimetres.
    pub thickness_mm: f64,
    /// White pixels of the mask.
    pub lit_pixels: u64,
}

#[derive(Serialize)]
struct Manifest<'a> {
    #[serde(flatten)]
    report: &'a Report,
    layer_files: Vec<LayerEntry>,
}

/// Writes the masks of all layers and the manifest, and returns the writer. Layers whose masks are black
/// add a warning to the report.
///
/// The bytes of the masks depend on `masks` alone, not on threads or machine.
///
/// # Errors
/// [`ArchiveError`].
pub fn write<W: Write + Seek>(
    masks: &Masks,
    report_of_plan: &mut Report,
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    // PNGs are deflated already; the fixed default date keeps archives reproducible.
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut zip = ZipWriter::new(writer);
    let mut layer_files = Vec::with_capacity(masks.layers());

    let mut ahead = masks.cursor();
    let runs = (0..masks.layers()).step_by(RUN).map(|first| {
        ahead.seek(masks, first);
        (ahead.clone(), first..(first + RUN).min(masks.layers()))
    });
    map_in_groups(
        runs,
        |(cursor, layers)| encode_run(masks, cursor, layers),
        |encoded: Result<Vec<Encoded>, ArchiveError>| {
            for mask in encoded? {
                let layer = layer_files.len();
                let entry = LayerEntry {
                    file: format!("layers/{layer:05}.png"),
                    z_mm: report_of_plan.z_mm[layer + 1],
                    thickness_mm: report_of_plan.thickness_mm[layer],
                    lit_pixels: mask.lit_pixels,
                };
                zip.start_file(&entry.file, options)
                    .map_err(ArchiveError::write)?;
                zip.write_all(&mask.png).map_err(ArchiveError::write)?;
                layer_files.push(entry);
            }
            Ok::<_, ArchiveError>(())
        },
        progress,
        [0.0, 1.0],
    )?;

    let black = layer_files
        .iter()
        .filter(|entry| entry.lit_pixels == 0)
        .count();
    if black == layer_files.len() {
        return Err(ArchiveError::AllBlack);
    }
    if black > 0 {
        let message = format!("{} of the plan are black", counted(black, "layer"));
        let warning = Warning::new("black-layers", message);
        // The same plan may be written again.
        if !report_of_plan.warnings.contains(&warning) {
            report_of_plan.warnings.push(warning);
        }
    }
    let manifest = Manifest {
        report: report_of_plan,
        layer_files,
    };
    zip.start_file("manifest.json", options)
        .map_err(ArchiveError::write)?;
    serde_json::to_writer(&mut zip, &manifest).map_err(ArchiveError::write)?;
    zip.finish().map_err(ArchiveError::write)
}

struct Encoded {
    png: Vec<u8>,
    lit_pixels: u64,
}

fn encode_run(
    masks: &Masks,
    mut cursor: MaskCursor,
    layers: Range<usize>,
) -> Result<Vec<Encoded>, ArchiveError> {
    layers
        .map(|layer| {
            cursor.seek(masks, layer);
            Ok(Encoded {
                png: encode(masks, &cursor)?,
                lit_pixels: cursor.lit_pixels(),
            })
        })
        .collect()
}

/// A mask as a one-bit greyscale PNG. Rows repeat from one to the next, which filter `up` turns
/// into zeros.
fn encode(masks: &Masks, mask: &MaskCursor) -> Result<Vec<u8>, ArchiveError> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, masks.grid.width, masks.grid.height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Up);
    let mut writer = encoder.write_header().map_err(ArchiveError::write)?;
    writer
        .write_image_data(mask.bits())
        .map_err(ArchiveError::write)?;
    writer.finish().map_err(ArchiveError::write)?;
    Ok(png)
}
