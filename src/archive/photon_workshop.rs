//! Anycubic's binary files, versions 516, 517 and 518: tables that a mark at the beginning points to, then the layers.

use std::io::Write;

use super::fields::{ByteOrder, Fields};
use super::preview::rgb565;
use super::survey::{Bounds, bounds_of, joined};
use super::{ArchiveError, Canvas, EncodedLayer, Encoder, PrintJob, encode_layers, pw0};
use crate::mask::LayerRuns;
use crate::printer::Printer;
use crate::progress::Progress;

pub struct PhotonWorkshop;

/// The version for printers that do not say.
const USUAL_VERSION: u32 = 517;
/// Columns and rows of the previews.
const PREVIEW: [u32; 2] = [224, 168];
const SECOND_PREVIEW: [u32; 2] = [330, 190];
/// Levels of grey.
const GREYS: u32 = 16;
/// The background of the preview on the printer.
const BACKGROUND: u32 = 6_506_241;

impl Encoder for PhotonWorkshop {
    fn layer(
        &self,
        canvas: Canvas,
        runs: &LayerRuns,
        layer: usize,
    ) -> Result<EncodedLayer, ArchiveError> {
        let runs = || runs.of_layer(layer);
        let boxes = runs().map(|run| bounds_of(run, canvas.pixels[0]));
        Ok(EncodedLayer {
            bounds: boxes.reduce(joined),
            ..EncodedLayer::new(pw0::encode(runs(), canvas.area()), runs())
        })
    }

    /// The tables stand before the layers, so all are encoded before the first byte is written. Memory: the size of the file.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError> {
        let version = job.printer.and_then(|printer| printer.file_version);
        let version = version.unwrap_or(USUAL_VERSION);
        let mut layers = Vec::with_capacity(job.layers.len());
        let mut bounds: Option<Bounds> = None;
        encode_layers(
            job,
            self,
            &mut |_, layer| {
                bounds = bounds.into_iter().chain(layer.bounds).reduce(joined);
                layers.push(layer);
                Ok(())
            },
            progress,
        )?;
        let head = head(job, version, &layers, bounds);
        writer.write_all(&head)?;
        for layer in &layers {
            writer.write_all(&layer.data)?;
        }
        Ok(())
    }
}

/// Offsets of a version's tables in the file.
struct Tables {
    version: u32,
    header: u32,
    preview: u32,
    colours: u32,
    layers: u32,
    extra: u32,
    machine: u32,
    software: u32,
    model: u32,
    sublayers: u32,
    second_preview: u32,
    images: u32,
}

impl Tables {
    fn new(version: u32, layers: u32) -> Self {
        let preview_bytes = |[width, height]: [u32; 2]| 28 + 2 * width * height;
        let from = |first: u32, length: u32| if version >= first { length } else { 0 };
        // Lengths in the order of the tables; a table that the version does not have takes none.
        let lengths = [
            52 + from(517, 4) + from(518, 8),
            16 + header_bytes(version),
            preview_bytes(PREVIEW),
            28,
            20 + 32 * layers,
            72,
            machine_bytes(version),
            from(517, 164),
            from(517, 48),
            from(518, 24 + 44 * layers),
            from(518, preview_bytes(SECOND_PREVIEW)),
        ];
        let mut end = 0;
        let ends = lengths.map(|length| {
            end += length;
            end
        });
        let [
            header,
            preview,
            colours,
            layers,
            extra,
            machine,
            software,
            model,
            sublayers,
            second_preview,
            images,
        ] = ends;
        Self {
            version,
            header,
            preview,
            colours,
            layers,
            extra,
            machine,
            software,
            model,
            sublayers,
            second_preview,
            images,
        }
    }

    fn write_mark(&self, fields: &mut Fields<'_>) {
        fields.text("ANYCUBIC", 12);
        fields.u32(self.version);
        fields.u32(match self.version {
            516 => 8,
            517 => 9,
            _ => 11,
        });
        fields.u32(self.header);
        fields.u32(if self.version >= 517 {
            self.software
        } else {
            0
        });
        for start in [
            self.preview,
            self.colours,
            self.layers,
            self.extra,
            self.machine,
            self.images,
        ] {
            fields.u32(start);
        }
        if self.version >= 517 {
            fields.u32(self.model);
        }
        if self.version >= 518 {
            fields.u32(self.sublayers);
            fields.u32(self.second_preview);
        }
    }
}

/// Length that the header states: without its name and the length itself.
fn header_bytes(version: u32) -> u32 {
    match version {
        516 => 84,
        517 => 92,
        _ => 96,
    }
}

fn machine_bytes(version: u32) -> u32 {
    if version >= 518 { 224 } else { 156 }
}

/// Everything before the layers.
fn head(
    job: &PrintJob<'_>,
    version: u32,
    layers: &[EncodedLayer],
    bounds: Option<Bounds>,
) -> Vec<u8> {
    let tables = Tables::new(version, layers.len() as u32);
    let mut bytes = Vec::with_capacity(tables.images as usize);
    let mut fields = Fields::new(&mut bytes, ByteOrder::Little);
    tables.write_mark(&mut fields);
    write_header(&mut fields, job, version);
    write_preview(&mut fields, job, "PREVIEW", PREVIEW, [b'x', 0, 0, 0]);
    write_colours(&mut fields, job.screen.antialias);
    let mut at = tables.images;
    let starts = layers.iter().map(|layer| {
        let start = at;
        at += layer.data.len() as u32;
        start
    });
    let starts: Vec<u32> = starts.collect();
    write_layers(&mut fields, job, &starts, layers);
    write_extra(&mut fields, job);
    write_machine(&mut fields, job, version);
    if version >= 517 {
        write_software(&mut fields);
        write_model(&mut fields, job, bounds);
    }
    if version >= 518 {
        write_sublayers(&mut fields, &starts, layers);
        let mark = [0xc5, 0x10, 0, 0];
        write_preview(&mut fields, job, "PREVIEW2", SECOND_PREVIEW, mark);
    }
    debug_assert_eq!(bytes.len(), tables.images as usize);
    bytes
}

fn write_layers(
    fields: &mut Fields<'_>,
    job: &PrintJob<'_>,
    starts: &[u32],
    layers: &[EncodedLayer],
) {
    let count = layers.len() as u32;
    fields.text("LAYERDEF", 12);
    fields.u32(4 + 32 * count);
    fields.u32(count);
    for ((start, layer), settings) in starts.iter().zip(layers).zip(job.layers) {
        fields.u32(*start);
        fields.u32(layer.data.len() as u32);
        fields.f32(job.resin.lift_mm);
        fields.f32(job.resin.lift_mm_min / 60.0);
        fields.f32(settings.exposure_s);
        fields.f32(settings.thickness_mm);
        fields.u32(layer.lit_pixels as u32);
        fields.u32(0);
    }
}

fn write_software(fields: &mut Fields<'_>) {
    fields.text("Cusp", 32);
    fields.u32(164);
    fields.text(env!("CARGO_PKG_VERSION"), 32);
    fields.text("", 64);
    fields.text("3.3-CoreProfile", 32);
}

fn write_model(fields: &mut Fields<'_>, job: &PrintJob<'_>, bounds: Option<Bounds>) {
    fields.text("MODEL", 12);
    fields.u32(48);
    let [left_mm, first_mm, right_mm, last_mm] = job.screen.bounds_mm(bounds);
    let top_mm = job.layers.last().map_or(0.0, |layer| layer.z_mm);
    for coordinate_mm in [left_mm, first_mm, 0.0, right_mm, last_mm, top_mm] {
        fields.f32(coordinate_mm);
    }
    // No supports.
    fields.zeros(8);
}

/// Writes the table of sublayers. A layer with several exposures has several images; here each has one.
fn write_sublayers(fields: &mut Fields<'_>, starts: &[u32], layers: &[EncodedLayer]) {
    let count = layers.len() as u32;
    fields.text("SUBIMGS", 12);
    fields.u32(24 + 44 * count);
    fields.u32(count);
    fields.u32(1);
    for (start, layer) in starts.iter().zip(layers) {
        fields.u32(*start);
        fields.u32(layer.data.len() as u32);
        fields.u32(layer.lit_pixels as u32);
        fields.zeros(32);
    }
}

fn write_header(fields: &mut Fields<'_>, job: &PrintJob<'_>, version: u32) {
    let PrintJob { screen, resin, .. } = *job;
    let usual_mm = job.usual_mm();
    fields.text("HEADER", 12);
    fields.u32(header_bytes(version));
    fields.f32(screen.pitch_mm[0].max(screen.pitch_mm[1]) * 1e3);
    fields.f32(usual_mm);
    fields.f32(resin.exposure_s(usual_mm));
    fields.f32(resin.wait_s);
    fields.f32(resin.bottom_exposure_s);
    fields.f32(resin.bottom_layers as f64);
    fields.f32(resin.lift_mm);
    fields.f32(resin.lift_mm_min / 60.0);
    fields.f32(resin.return_mm_min / 60.0);
    fields.f32(job.resin_ml);
    fields.u32(screen.antialias);
    fields.u32(screen.pixels[0]);
    fields.u32(screen.pixels[1]);
    fields.f32(job.resin_ml * resin.density_g_ml);
    fields.f32(0.0);
    fields.text("$", 4);
    fields.u32(job.needs_layer_settings().into());
    fields.u32(job.print_time_s() as u32);
    fields.u32(job.transition_layers as u32);
    // The fade is linear, and lifts have one stage.
    fields.zeros(8);
    if version >= 517 {
        // Grey, blur and kind of resin.
        fields.zeros(8);
    }
    if version >= 518 {
        // The printer keeps to these exposures.
        fields.u32(0);
    }
}

fn write_preview(
    fields: &mut Fields<'_>,
    job: &PrintJob<'_>,
    name: &str,
    size: [u32; 2],
    mark: [u8; 4],
) {
    fields.text(name, 12);
    fields.u32(28 + 2 * size[0] * size[1]);
    fields.u32(size[0]);
    fields.bytes(&mark);
    fields.u32(size[1]);
    for grey in (job.look)(size[0].max(size[1])).greys(size) {
        fields.u16(rgb565(grey));
    }
}

fn write_colours(fields: &mut Fields<'_>, antialias: u32) {
    fields.u32(0);
    fields.u32(GREYS);
    for level in 1..=GREYS {
        fields.bytes(&[(level * 255 / antialias.max(GREYS)) as u8]);
    }
    fields.u32(0);
}

fn write_extra(fields: &mut Fields<'_>, job: &PrintJob<'_>) {
    let resin = job.resin;
    let (lift_mm_s, return_mm_s) = (resin.lift_mm_min / 60.0, resin.return_mm_min / 60.0);
    fields.text("EXTRA", 12);
    // Less than the length of the table, but printers expect this number.
    fields.u32(24);
    for _bottom_and_others in 0..2 {
        fields.u32(2);
        fields.f32(resin.lift_mm);
        fields.f32(lift_mm_s);
        fields.f32(return_mm_s);
        fields.f32(0.0);
        fields.f32(lift_mm_s);
        fields.f32(return_mm_s);
    }
}

fn write_machine(fields: &mut Fields<'_>, job: &PrintJob<'_>, version: u32) {
    let screen = &job.screen;
    fields.text("MACHINE", 12);
    fields.u32(machine_bytes(version));
    fields.text(job.printer.map_or("", Printer::machine), 96);
    fields.text("pw0Img", 16);
    fields.u32(GREYS);
    fields.u32(match version {
        516 => 1,
        517 => 7,
        _ => 15,
    });
    for side_mm in job.volume_mm() {
        fields.f32(side_mm);
    }
    fields.u32(version);
    fields.u32(BACKGROUND);
    if version >= 518 {
        for pitch_mm in screen.pitch_mm {
            fields.f32(pitch_mm * 1e3);
        }
        fields.zeros(32);
        fields.u32(1);
        fields.u32(0);
        fields.u16(screen.pixels[0] as u16);
        fields.u16(screen.pixels[1] as u16);
        fields.zeros(16);
    }
}
