//! No bytes make the readers of binary files panic, or hold much more memory than the file justifies.

use std::io::{Cursor, Write};
use std::ops::Range;

use cusp_slicer::archive::read::{Inspection, PrintFile, inspect_masks, surface};
use cusp_slicer::convert::{Conversion, Target};
use cusp_slicer::format::Format;
use cusp_slicer::model::read::read;
use cusp_slicer::model::{Mesh, weights as facet_weights};
use cusp_slicer::progress::silent;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::alone;

/// Larger print files only take longer.
const MOST_PIXELS: u64 = 1 << 20;

/// Previews, which no decision depends on and which take up to 195 KB: the offset of a format's first bytes, these
/// bytes, and the range of the previews.
const PREVIEWS: [(usize, &[u8], Range<usize>); 2] = [
    (4, b"\x07\0\0\0DLP\0", 194..195_308),
    (0, b"ANYCUBIC\0\0\0\0\x05\x02", 192..75_456),
];

/// The same of CTB, whose previews end where the print's settings begin: byte 0x54 says where.
const CTB: &[u8] = &[0x86, 0, 0xFD, 0x12];
const CTB_PREVIEWS: usize = 0x90;
const CTB_SETTINGS: usize = 0x54;
/// Bound of the end of previews in a file: no preview is larger.
const MOST_PREVIEW_BYTES: usize = 1 << 16;

/// Range of the previews in a file that begins like this, if seeds lack them.
fn previews(bytes: &[u8]) -> Option<Range<usize>> {
    if bytes.starts_with(CTB) {
        let end = bytes[CTB_SETTINGS.min(bytes.len())..].first_chunk()?;
        let end = (u32::from_le_bytes(*end) as usize).min(MOST_PREVIEW_BYTES);
        return (CTB_PREVIEWS < end).then_some(CTB_PREVIEWS..end);
    }
    let mut known = PREVIEWS.into_iter();
    let found =
        known.find(|(at, magic, _)| bytes.get(*at..).is_some_and(|it| it.starts_with(magic)));
    found.map(|(.., place)| place)
}

/// A model.
pub fn model(bytes: &[u8]) {
    alone(|| {
        let contents = read(bytes);
        match contents {
            Ok(contents) => drop(Mesh::from_triangles(&contents.triangles)),
            Err(error) => drop(error.to_string()),
        }
    });
}

/// A print file. Those that are no zips lack their previews, so that changes are not spent on them.
pub fn print_file(bytes: &[u8]) {
    alone(|| match previews(bytes) {
        Some(place) if bytes.len() >= place.start => {
            let (head, rest) = bytes.split_at(place.start);
            read_print_file(&[head, &vec![0; place.len()], rest].concat());
        }
        _ => read_print_file(bytes),
    });
}

/// The same without the previews that the input of [`print_file`] lacks.
pub fn without_previews(mut bytes: Vec<u8>) -> Vec<u8> {
    if let Some(place) = previews(&bytes) {
        bytes.drain(place);
    }
    bytes
}

fn read_print_file(bytes: &[u8]) {
    let file = match PrintFile::open(bytes) {
        Ok(file) => file,
        Err(error) => return drop(error.to_string()),
    };
    let metadata = file.metadata();
    let layers = file.layers().len() as u64;
    if metadata.mask_pixels().saturating_mul(layers) > MOST_PIXELS {
        return;
    }
    let mut masks = Vec::new();
    let inspection = inspect_masks(&file, &mut |mask| masks.push(mask), &mut silent);
    let inspection = inspection.expect("nobody cancels");
    for warning in &inspection.warnings {
        drop(warning.to_string());
    }
    // These take longer than the rest together, so a few inputs are enough.
    let draw: u64 = bytes.iter().copied().map(u64::from).sum();
    if draw.is_multiple_of(256) {
        surface(
            file.layers(),
            &masks,
            metadata.pixels_from_above(),
            metadata.pixel_mm_from_above(),
        );
    }
    if draw % 64 == 1 {
        convert(&file, &inspection, Format::MASKS[(draw / 64 % 9) as usize]);
    }
    for place in 0..file.previews() {
        file.preview(place);
    }
}

/// A file that can be converted can be read then, and has as many layers.
fn convert(file: &PrintFile<'_>, inspection: &Inspection, format: Format) {
    let target = Target {
        format: Some(format),
        printer: None,
        mirror: None,
        resin: None,
    };
    let conversion = match Conversion::new(file, inspection, &target) {
        Ok(conversion) => conversion,
        Err(error) => return drop(error.to_string()),
    };
    let Ok(bytes) = conversion.write(Vec::new(), &mut silent) else {
        return;
    };
    let converted = PrintFile::open(&*bytes).expect("what is written can be read");
    assert_eq!(converted.layers().len(), file.layers().len());
    for layer in 0..file.layers().len() {
        let mask = converted.mask(layer, converted.metadata().flips());
        mask.expect("what is written can be decoded");
    }
}

/// The parts of a zip: a model's, or a print file's. Packed only here, since changes to a whole zip would fail at its checksums.
/// Each part is the length of its name, a byte; that of its contents, two; then both.
pub fn packed(bytes: &[u8]) {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut rest = bytes;
    while let Some((&[name, low, high], after)) = rest.split_first_chunk() {
        let (name, after) = after.split_at(usize::from(name).min(after.len()));
        let contents = usize::from(u16::from_le_bytes([low, high]));
        let (contents, after) = after.split_at(contents.min(after.len()));
        // Two parts of one name are no zip.
        let started = writer.start_file(String::from_utf8_lossy(name), stored);
        if started.is_ok() {
            writer.write_all(contents).expect("memory takes all");
        }
        rest = after;
    }
    let Ok(zip) = writer.finish() else {
        return;
    };
    let zip = zip.into_inner();
    alone(|| read_print_file(&zip));
    model(&zip);
}

/// A part as [`packed`] has it, unless it is too long.
pub fn packed_part(name: &str, contents: &[u8]) -> Vec<u8> {
    let (Ok(name_length), Ok(length)) = (u8::try_from(name.len()), u16::try_from(contents.len()))
    else {
        return Vec::new();
    };
    let mut part = vec![name_length];
    part.extend(length.to_le_bytes());
    part.extend(name.as_bytes());
    part.extend(contents);
    part
}

/// The mesh that [`weights`] are for.
pub const WEIGHED_CORNERS: [f32; 18] = [
    0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, //
    0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
];

/// Weights of facets. Those that can be read are written as the same bytes.
pub fn weights(bytes: &[u8]) {
    match facet_weights::from_bytes(bytes, &WEIGHED_CORNERS) {
        Ok(weights) => assert_eq!(facet_weights::to_bytes(&weights, &WEIGHED_CORNERS), bytes),
        Err(error) => drop(error.to_string()),
    }
}
