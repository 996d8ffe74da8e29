//! GOO, Elegoo's print files, and Phrozen's PRZ: a header with previews, then each layer's settings and its runs.
//!
//! The layout is that of Elegoo's "Goo Format Spec V1.2". Chunks that store differences are left out, as PRZ printers misread
//! them.

use std::io::Write;

use super::fields::{ByteOrder, Fields};
use super::preview::{PreviewScene, rgb565};
use super::raster::for_each_run;
use super::{ArchiveError, Canvas, EncodedLayer, Encoder, Layer, PrintJob, encode_layers};
use crate::mask::{LayerRuns, Run};
use crate::printer::Printer;
use crate::progress::Progress;

pub struct Goo;

const MAGIC: [u8; 8] = [7, 0, 0, 0, b'D', b'L', b'P', 0];
const DELIMITER: [u8; 2] = *b"\r\n";
/// Length of the header, and so where the layers begin.
const HEADER_BYTES: u32 = 195_477;
/// Sides of the previews in pixels.
const PREVIEWS: [u32; 2] = [116, 290];
/// Constant, so that a job always gives the same bytes.
const TIME: &str = "1980-01-01 00:00:00";
/// Full power of the light.
const FULL_LIGHT: u16 = 255;
/// First byte of a layer's data.
const DATA: u8 = 0x55;
/// The longest run of a chunk.
const LONGEST: u32 = (1 << 28) - 1;

impl Encoder for Goo {
    fn layer(
        &self,
        canvas: Canvas,
        runs: &LayerRuns,
        layer: usize,
    ) -> Result<EncodedLayer, ArchiveError> {
        let data = data(runs.of_layer(layer), canvas.area());
        Ok(EncodedLayer::new(data, runs.of_layer(layer)))
    }

    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError> {
        let order = ByteOrder::of_goo(job.printer);
        let moves = Moves::of(job);
        writer.write_all(&header(job, &moves, order))?;
        let mut settings = Vec::new();
        encode_layers(
            job,
            self,
            &mut |layer, EncodedLayer { data, .. }| {
                settings.clear();
                let fields = Fields::new(&mut settings, order);
                let job = &job.layers[layer];
                write_layer(fields, job, &moves, data.len() as u32);
                writer.write_all(&settings)?;
                writer.write_all(&data)?;
                Ok(writer.write_all(&DELIMITER)?)
            },
            progress,
        )?;
        writer.write_all(&[0; 3])?;
        Ok(writer.write_all(&MAGIC)?)
    }
}

/// Moves of the plate between layers.
struct Moves {
    wait_s: f64,
    lift_mm: f64,
    lift_mm_min: f64,
    return_mm_min: f64,
}

impl Moves {
    fn of(job: &PrintJob<'_>) -> Self {
        let resin = job.resin;
        if job.printer.is_some_and(|printer| printer.has_tilting_vat) {
            // The vat tilts instead of a lift; printers misbehave with any other value here.
            return Self {
                wait_s: resin.wait_s,
                lift_mm: 0.05,
                lift_mm_min: 0.05,
                return_mm_min: 0.05,
            };
        }
        Self {
            wait_s: resin.wait_s,
            lift_mm: resin.lift_mm,
            lift_mm_min: resin.lift_mm_min,
            return_mm_min: resin.return_mm_min,
        }
    }
}

fn header(job: &PrintJob<'_>, moves: &Moves, order: ByteOrder) -> Vec<u8> {
    let PrintJob { screen, resin, .. } = *job;
    let look = (job.look)(PREVIEWS[1]);
    let usual_mm = job.usual_mm();
    let mut bytes = Vec::with_capacity(HEADER_BYTES as usize);
    let mut fields = Fields::new(&mut bytes, order);
    fields.bytes(b"V3.0");
    fields.bytes(&MAGIC);
    fields.text("Cusp", 32);
    fields.text(env!("CARGO_PKG_VERSION"), 24);
    fields.text(TIME, 24);
    fields.text(job.printer.map_or("", Printer::machine), 32);
    fields.text("Default", 32);
    fields.text(&resin.name, 32);
    fields.u16(screen.antialias as u16);
    // Levels of grey and of blurring, which the slicer has done.
    fields.u16(0);
    fields.u16(0);
    for side in PREVIEWS {
        fields.bytes(&preview(&look, side));
        fields.bytes(&DELIMITER);
    }
    fields.u32(job.layers.len() as u32);
    fields.u16(screen.pixels[0] as u16);
    fields.u16(screen.pixels[1] as u16);
    fields.bool(screen.is_mirrored);
    fields.bool(false);
    for side_mm in job.volume_mm() {
        fields.f32(side_mm);
    }
    fields.f32(usual_mm);
    fields.f32(resin.exposure_s(usual_mm));
    // Waiting times, and no time without light.
    fields.bool(true);
    fields.f32(0.0);
    for _bottom_and_others in 0..2 {
        for wait_s in [0.0, 0.0, moves.wait_s] {
            fields.f32(wait_s);
        }
    }
    fields.f32(resin.bottom_exposure_s);
    fields.u32(resin.bottom_layers as u32);
    for speed_mm_min in [moves.lift_mm_min, moves.return_mm_min] {
        for _bottom_and_others in 0..2 {
            fields.f32(moves.lift_mm);
            fields.f32(speed_mm_min);
        }
    }
    // There is no second stage.
    for _ in 0..8 {
        fields.f32(0.0);
    }
    fields.u16(FULL_LIGHT);
    fields.u16(FULL_LIGHT);
    fields.bool(job.needs_layer_settings());
    fields.u32(job.print_time_s() as u32);
    fields.f32(job.resin_ml * 1e3);
    fields.f32(job.resin_ml * resin.density_g_ml);
    fields.f32(0.0);
    fields.text("$", 8);
    fields.u32(HEADER_BYTES);
    // Greys of 8 bits.
    fields.bool(true);
    fields.u16(u16::try_from(job.transition_layers).unwrap_or(u16::MAX));
    debug_assert_eq!(bytes.len(), HEADER_BYTES as usize);
    bytes
}

/// A square preview of 16-bit pixels, big-endian in all files.
fn preview(look: &PreviewScene, side: u32) -> Vec<u8> {
    let greys = look.greys([side, side]).into_iter();
    greys.flat_map(|grey| rgb565(grey).to_be_bytes()).collect()
}

fn write_layer(mut fields: Fields<'_>, layer: &Layer, moves: &Moves, data_bytes: u32) {
    // No pause.
    fields.u16(0);
    fields.f32(0.0);
    fields.f32(layer.z_mm);
    fields.f32(layer.exposure_s);
    fields.f32(0.0);
    for wait_s in [0.0, 0.0, moves.wait_s] {
        fields.f32(wait_s);
    }
    for speed_mm_min in [moves.lift_mm_min, moves.return_mm_min] {
        for value in [moves.lift_mm, speed_mm_min, 0.0, 0.0] {
            fields.f32(value);
        }
    }
    fields.u16(FULL_LIGHT);
    fields.bytes(&DELIMITER);
    fields.u32(data_bytes);
}

/// The chunks of a mask, and their checksum.
fn data(runs: impl Iterator<Item = Run>, area: u64) -> Vec<u8> {
    let mut bytes = vec![DATA];
    for_each_run(
        runs,
        area,
        |grey| grey,
        |_| LONGEST,
        |grey, count| chunk(&mut bytes, grey, count),
    );
    let sum = bytes[1..]
        .iter()
        .fold(0u8, |sum, &byte| sum.wrapping_add(byte));
    bytes.push(!sum);
    bytes
}

fn chunk(bytes: &mut Vec<u8>, grey: u8, count: u32) {
    let kind = match grey {
        0 => 0b00,
        255 => 0b11,
        _ => 0b01,
    };
    // The lowest four bits of the count are in the first byte, the others in up to three more.
    let more = match count {
        0..0x10 => 0,
        0x10..0x1000 => 1,
        0x1000..0x10_0000 => 2,
        _ => 3,
    };
    bytes.push(kind << 6 | more << 4 | (count & 0xf) as u8);
    if kind == 0b01 {
        bytes.push(grey);
    }
    // Four bytes are written faster than one to three.
    let end = bytes.len() + usize::from(more);
    let rest = (u64::from(count >> 4) << (8 * (4 - more))) as u32;
    bytes.extend(rest.to_be_bytes());
    bytes.truncate(end);
}
