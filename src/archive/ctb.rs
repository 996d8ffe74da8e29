//! CTB, version 3, as printers of 2019 to 2021 read it.
//!
//! Later versions carry another company's copyright notice or are encrypted with its key, so they stay out.

use std::io::Write;

use super::fields::{ByteOrder, Fields};
use super::preview::{PreviewScene, rgb565};
use super::raster::for_each_run;
use super::{ArchiveError, Canvas, EncodedLayer, Encoder, PrintJob, encode_layers};
use crate::mask::{LayerRuns, Run};
use crate::printer::Printer;
use crate::progress::Progress;

pub struct Ctb;

const MAGIC: u32 = 0x12fd_0086;
const VERSION: u32 = 3;
/// The version of the slicer that wrote files of version 3.
const SLICER_VERSION: u32 = 0x0106_0300;
/// The key of scrambled layers. It hides nothing, but some printers refuse files without one.
const KEY: u32 = 0x4375_7370;
/// 1980-01-01 in minutes since 1970: constant, so that a job always gives the same bytes.
const MODIFIED: u32 = 5_258_880;
const FULL_LIGHT: u16 = 255;
/// Columns and rows of the previews.
const PREVIEWS: [[u32; 2]; 2] = [[400, 300], [200, 125]];

const HEADER_BYTES: u32 = 112;
const PREVIEW_BYTES: u32 = 32;
const PRINT_BYTES: u32 = 60;
const SLICER_BYTES: u32 = 76;
const TABLE_BYTES: u32 = 36;
/// Bytes before the data of each layer.
const LAYER_BYTES: u32 = 84;
/// The longest run.
const LONGEST: u32 = (1 << 28) - 1;

impl Encoder for Ctb {
    fn layer(
        &self,
        canvas: Canvas,
        runs: &LayerRuns,
        layer: usize,
    ) -> Result<EncodedLayer, ArchiveError> {
        let data = data(runs.of_layer(layer), canvas.area());
        Ok(EncodedLayer::new(data, runs.of_layer(layer)))
    }

    /// The table of layers stands before the layers, so all are encoded before the first byte is written. Memory: the size of
    /// the file.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError> {
        let mut layers = Vec::with_capacity(job.layers.len());
        encode_layers(
            job,
            self,
            &mut |layer, EncodedLayer { mut data, .. }| {
                scramble(&mut data, layer as u32);
                layers.push(data);
                Ok(())
            },
            progress,
        )?;
        let head = head(job);
        writer.write_all(&head)?;
        let table = table(job, &layers, head.len());
        for row in &table {
            writer.write_all(row)?;
        }
        for (data, row) in layers.iter().zip(&table) {
            let mut bytes = row.clone();
            layer_settings(
                &mut Fields::new(&mut bytes, ByteOrder::Little),
                job,
                data.len(),
            );
            writer.write_all(&bytes)?;
            writer.write_all(data)?;
        }
        Ok(())
    }
}

/// Everything before the table of layers.
fn head(job: &PrintJob<'_>) -> Vec<u8> {
    let PrintJob { screen, resin, .. } = *job;
    let machine = job.printer.map_or("", Printer::machine);
    let look = (job.look)(PREVIEWS[0][0]);
    let previews = PREVIEWS.map(|size| preview(&look, size));
    let large_at = HEADER_BYTES;
    let small_at = large_at + PREVIEW_BYTES + previews[0].len() as u32;
    let print_at = small_at + PREVIEW_BYTES + previews[1].len() as u32;
    let slicer_at = print_at + PRINT_BYTES;
    let machine_at = slicer_at + SLICER_BYTES;
    let table_at = machine_at + machine.len() as u32;
    let usual_mm = job.usual_mm();
    let bottom_layers = resin.bottom_layers as u32;

    let mut bytes = Vec::with_capacity(table_at as usize);
    let mut fields = Fields::new(&mut bytes, ByteOrder::Little);
    fields.u32(MAGIC);
    fields.u32(VERSION);
    for side_mm in job.volume_mm() {
        fields.f32(side_mm);
    }
    fields.zeros(8);
    fields.f32(job.layers.last().map_or(0.0, |layer| layer.z_mm));
    fields.f32(usual_mm);
    fields.f32(resin.exposure_s(usual_mm));
    fields.f32(resin.bottom_exposure_s);
    // Light-off delay: the rest after the return takes its place.
    fields.f32(0.0);
    fields.u32(bottom_layers);
    fields.u32(screen.pixels[0]);
    fields.u32(screen.pixels[1]);
    fields.u32(large_at);
    fields.u32(table_at);
    fields.u32(job.layers.len() as u32);
    fields.u32(small_at);
    fields.u32(job.print_time_s() as u32);
    fields.u32(screen.is_mirrored.into());
    fields.u32(print_at);
    fields.u32(PRINT_BYTES);
    // Greys are in the masks.
    fields.u32(1);
    fields.u16(FULL_LIGHT);
    fields.u16(FULL_LIGHT);
    fields.u32(KEY);
    fields.u32(slicer_at);
    fields.u32(SLICER_BYTES);

    for ((at, [width, height]), data) in [large_at, small_at]
        .into_iter()
        .zip(PREVIEWS)
        .zip(&previews)
    {
        fields.u32(width);
        fields.u32(height);
        fields.u32(at + PREVIEW_BYTES);
        fields.u32(data.len() as u32);
        fields.zeros(16);
        fields.bytes(data);
    }

    for _bottom_and_others in 0..2 {
        fields.f32(resin.lift_mm);
        fields.f32(resin.lift_mm_min);
    }
    fields.f32(resin.return_mm_min);
    fields.f32(job.resin_ml);
    fields.f32(job.resin_ml * resin.density_g_ml);
    fields.f32(0.0);
    fields.f32(0.0);
    fields.f32(0.0);
    fields.u32(bottom_layers);
    fields.zeros(16);

    // There is no second stage, and no rest after the lift.
    fields.zeros(28);
    fields.u32(machine_at);
    fields.u32(machine.len() as u32);
    fields.bytes(&[if screen.antialias > 1 { 15 } else { 7 }]);
    fields.u16(0);
    let per_layer = (VERSION as u8) << 4;
    fields.bytes(&[if job.needs_layer_settings() {
        per_layer
    } else {
        0
    }]);
    fields.u32(MODIFIED);
    fields.u32(screen.antialias);
    fields.u32(SLICER_VERSION);
    fields.f32(resin.wait_s);
    fields.f32(0.0);
    fields.u32(job.transition_layers as u32);
    fields.zeros(12);
    fields.bytes(machine.as_bytes());
    debug_assert_eq!(bytes.len(), table_at as usize);
    bytes
}

/// The row of each layer in the table, which begins `table_at` bytes into the file.
fn table(job: &PrintJob<'_>, layers: &[Vec<u8>], table_at: usize) -> Vec<Vec<u8>> {
    let mut at = table_at as u64 + u64::from(TABLE_BYTES) * layers.len() as u64;
    let rows = job.layers.iter().zip(layers).map(|(layer, data)| {
        at += u64::from(LAYER_BYTES);
        let mut row = Vec::with_capacity(LAYER_BYTES as usize);
        let mut fields = Fields::new(&mut row, ByteOrder::Little);
        fields.f32(layer.z_mm);
        fields.f32(layer.exposure_s);
        fields.f32(0.0);
        // The place within a page of 2^32 bytes, and the page.
        fields.u32(at as u32);
        fields.u32(data.len() as u32);
        fields.u32((at >> 32) as u32);
        fields.u32(LAYER_BYTES);
        fields.zeros(8);
        at += data.len() as u64;
        row
    });
    rows.collect()
}

/// Writes the fields that follow a layer's row where it is repeated before the layer's data.
fn layer_settings(fields: &mut Fields<'_>, job: &PrintJob<'_>, data_bytes: usize) {
    let resin = job.resin;
    fields.u32(LAYER_BYTES + data_bytes as u32);
    for value in [
        resin.lift_mm,
        resin.lift_mm_min,
        0.0,
        0.0,
        resin.return_mm_min,
        0.0,
        0.0,
        0.0,
        0.0,
        resin.wait_s,
        f64::from(FULL_LIGHT),
    ] {
        fields.f32(value);
    }
}

/// A preview: pixels of 15 bits, and runs of at least three.
fn preview(look: &PreviewScene, size: [u32; 2]) -> Vec<u8> {
    const REPEATS: u16 = 1 << 5;
    const COUNT: u16 = 0x3000;
    const LONGEST: usize = 0xfff;
    let mut bytes = Vec::new();
    for run in look.greys(size).chunk_by(|a, b| a == b) {
        let pixel = rgb565(run[0]) & !REPEATS;
        for run in run.chunks(LONGEST) {
            if run.len() < 3 {
                bytes.extend(run.iter().flat_map(|_| pixel.to_le_bytes()));
            } else {
                bytes.extend((pixel | REPEATS).to_le_bytes());
                bytes.extend((COUNT + (run.len() - 1) as u16).to_le_bytes());
            }
        }
    }
    bytes
}

/// The runs of a mask: seven bits of grey, and a length if it is not 1.
fn data(runs: impl Iterator<Item = Run>, area: u64) -> Vec<u8> {
    const HAS_LENGTH: u8 = 1 << 7;
    let mut bytes = Vec::new();
    for_each_run(
        runs,
        area,
        |grey| grey >> 1,
        |_| LONGEST,
        |grey, count| {
            let [top, high, middle, low] = count.to_be_bytes();
            match count {
                1 => bytes.push(grey),
                2..0x80 => bytes.extend([grey | HAS_LENGTH, low]),
                0x80..0x4000 => bytes.extend([grey | HAS_LENGTH, 0x80 | middle, low]),
                0x4000..0x20_0000 => {
                    bytes.extend([grey | HAS_LENGTH, 0xc0 | high, middle, low]);
                }
                _ => bytes.extend([grey | HAS_LENGTH, 0xe0 | top, high, middle, low]),
            }
        },
    );
    bytes
}

/// Scrambles the data of a layer; a second time undoes it.
fn scramble(data: &mut [u8], layer: u32) {
    let step = KEY.wrapping_mul(0x2d83_cdac).wrapping_add(0xd8a8_3423);
    let first = layer.wrapping_mul(0x1e15_30cd).wrapping_add(0xec3d_47cd);
    let mut key = first.wrapping_mul(step);
    for bytes in data.chunks_mut(4) {
        for (byte, key) in bytes.iter_mut().zip(key.to_le_bytes()) {
            *byte ^= key;
        }
        key = key.wrapping_add(step);
    }
}
