//! GOO, Elegoo's format, and PRZ, which is Phrozen's name for it: a header, and layers one after the other.

use super::bytes::{Fields, Order};
use super::metadata::with_thicknesses;
use super::preview::Picture;
use super::runs::{Coverage, Reader};
use super::{
    Coding, Contents, FileFinding, Format, Layer, LayerFault, Metadata, Places, PrintFileError,
};

/// Bytes at offset 4, and again at the end after three zeros.
const MAGIC: [u8; 8] = [7, 0, 0, 0, 0x44, 0x4C, 0x50, 0];
/// Length of the header.
const HEADER: u64 = 195_477;
/// Length of a layer without its data: the definition, and two bytes after the data.
const LAYER: u64 = 72;
/// End of a definition, and of a layer's data.
const MARK: [u8; 2] = [0x0D, 0x0A];
/// The only printer whose files have the lowest byte first.
const LITTLE_ENDIAN: &str = "ELEGOO Jupiter 2";
const TABLE: &str = "header";

pub fn is(bytes: &[u8]) -> bool {
    bytes.get(4..12) == Some(&MAGIC)
}

pub fn read(bytes: &[u8]) -> Result<Contents, PrintFileError> {
    let order = order(bytes)?;
    let fields = Fields { bytes, order };
    let version = fields.text(0, 4)?.unwrap_or_default();
    if version != "V3.0" {
        return Err(PrintFileError::UnknownVersion {
            format: Format::Goo,
            version,
            known: "V3.0",
        });
    }
    let metadata = metadata(fields, version)?;
    let mut findings = Vec::new();
    let (layers, places) = layers(fields, &mut findings)?;
    let preview = |at: u64, side: u32| Picture::Words {
        pixels: [side, side],
        order,
        place: at..at + 2 * u64::from(side * side),
    };
    Ok(Contents {
        metadata,
        layers: with_thicknesses(layers),
        coding: Coding::Goo {
            is_fine: fields.u8(195_474)? != 0,
        },
        places: Places::InFile(places),
        pictures: vec![preview(27_108, 290), preview(194, 116)],
        copies: None,
        findings,
    })
}

/// The order of bytes: the header says at one place how long it is.
fn order(bytes: &[u8]) -> Result<Order, PrintFileError> {
    let by = |order| Fields { bytes, order };
    for order in [Order::Big, Order::Little] {
        if u64::from(by(order).u32(195_470)?) == HEADER {
            return Ok(order);
        }
    }
    let printer = by(Order::Big).text(92, 32)?;
    if printer.as_deref() == Some(LITTLE_ENDIAN) {
        return Ok(Order::Little);
    }
    Err(PrintFileError::bad_setting(TABLE, "offset of the layers"))
}

fn metadata(fields: Fields<'_>, version: String) -> Result<Metadata, PrintFileError> {
    let pixels = [195_314, 195_316].map(|at| fields.u16(at));
    let pixels = [u32::from(pixels[0].clone()?), u32::from(pixels[1].clone()?)];
    let plate_mm = [
        fields.finite(195_320)?,
        fields.finite(195_324)?,
        fields.finite(195_328)?,
    ];
    let mut pixel_mm = [0.0; 2];
    for axis in 0..2 {
        let side = super::side(pixels[axis], plate_mm[axis]);
        pixel_mm[axis] = side.ok_or_else(|| {
            PrintFileError::bad_setting(TABLE, ["columns and plate x", "rows and plate y"][axis])
        })?;
    }
    let weight_g = fields.finite(195_454)?;
    let software = [fields.text(12, 32)?, fields.text(44, 24)?];
    Ok(Metadata {
        version: Some(version),
        software: super::joined(&software),
        printer: fields.text(92, 32)?,
        resin: fields.text(156, 32)?,
        plate_mm,
        is_mirrored_x: Some(fields.u8(195_318)? != 0),
        is_mirrored_y: Some(fields.u8(195_319)? != 0),
        layer_mm: Some(fields.f32(195_332)?),
        exposure_s: Some(fields.f32(195_336)?),
        bottom_exposure_s: Some(fields.f32(195_369)?),
        bottom_layers: Some(fields.u32(195_373)?),
        transition_layers: Some(u32::from(fields.u16(195_475)?)),
        print_time_s: Some(f64::from(fields.u32(195_446)?)),
        volume_ml: volume_ml(fields.finite(195_450)?, weight_g),
        weight_g,
        uses_layer_values: Some(fields.u8(195_445)? != 0),
        ..Metadata::new(Format::Goo, pixels, pixel_mm)
    })
}

/// The volume is in mm³ by the specification, and in ml as some programs write it: the weight decides, since a
/// millilitre of resin weighs about a gram.
fn volume_ml(volume: Option<f64>, weight_g: Option<f64>) -> Option<f64> {
    let is_in_ml = |volume: f64| weight_g.is_some_and(|weight_g| weight_g > 0.1 * volume);
    let volume = volume?;
    Some(if is_in_ml(volume) {
        volume
    } else {
        volume / 1000.0
    })
}

type Walked = (Vec<Layer>, Vec<std::ops::Range<u64>>);

/// Walks from layer to layer by the lengths of their data.
fn layers(fields: Fields<'_>, findings: &mut Vec<FileFinding>) -> Result<Walked, PrintFileError> {
    let count = super::checked_layers(fields.u32(195_310)?, fields.len() - HEADER, LAYER)?;
    let (mut layers, mut places) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (mut at, mut unmarked) = (HEADER, super::Tally::default());
    for number in 1..=count {
        let layer = layer(fields, at)?;
        let start = at + 70;
        let end = start + u64::from(fields.u32(at + 66)?);
        let marks = [fields.slice(at + 64, 2)?, fields.slice(end, 2)?];
        if marks != [MARK; 2] {
            unmarked.count(number, ());
        }
        layers.push(layer);
        places.push(start..end);
        at = end + 2;
    }
    if let Some((first_layer, ())) = unmarked.first {
        findings.push(FileFinding::MissingMarks {
            layers: unmarked.layers,
            first_layer,
        });
    }
    let end = [&[0; 3][..], &MAGIC].concat();
    if fields.bytes.get(at as usize..at as usize + end.len()) != Some(&end) {
        findings.push(FileFinding::MissingEnd);
    }
    Ok((layers, places))
}

fn layer(fields: Fields<'_>, at: u64) -> Result<Layer, PrintFileError> {
    let sum = |one: Option<f64>, two: Option<f64>| Some(one? + two?);
    let waits = fields.u8(195_340)? != 0;
    let before_exposure = if waits { 26 } else { 14 };
    let wait = |offset: u64| fields.finite(at + offset);
    Ok(Layer {
        z_mm: fields.f32(at + 6)?,
        exposure_s: Some(fields.f32(at + 10)?),
        wait_before_exposure_s: wait(before_exposure)?,
        wait_before_lift_s: wait(18)?.filter(|_| waits),
        wait_after_lift_s: wait(22)?.filter(|_| waits),
        lift_mm: sum(fields.finite(at + 30)?, fields.finite(at + 38)?),
        lift_mm_min: fields.finite(at + 34)?,
        retract_mm_min: fields.finite(at + 50)?,
        ..Layer::default()
    })
}

/// Decodes a layer's data, from the 0x55 to the checksum. Runs of data with a wrong checksum are passed on
/// nevertheless. With `is_fine` greys go to 255, otherwise to 15.
pub fn decode(data: &[u8], is_fine: bool, coverage: &mut Coverage<'_>) -> Result<(), LayerFault> {
    let [0x55, chunks @ .., stated] = data else {
        return Err(LayerFault::BadRun { byte: 0 });
    };
    let sum = chunks.iter().fold(0u8, |sum, &byte| sum.wrapping_add(byte));
    let runs = decode_chunks(chunks, is_fine, coverage);
    if *stated != !sum {
        return Err(LayerFault::WrongChecksum {
            stated: *stated,
            computed: !sum,
        });
    }
    runs
}

fn decode_chunks(
    chunks: &[u8],
    is_fine: bool,
    coverage: &mut Coverage<'_>,
) -> Result<(), LayerFault> {
    let mut reader = Reader::new(chunks);
    let mut value = 0u8;
    while let Some(first) = reader.next() {
        let (kind, detail, low) = (first >> 6, first >> 4 & 3, first & 15);
        let count = if kind == 2 {
            let changed = if detail < 2 {
                value.checked_add(low)
            } else {
                value.checked_sub(low)
            };
            value = changed.ok_or_else(|| reader.fault())?;
            reader
                .number(u32::from(detail & 1))
                .map(|length| if detail & 1 == 1 { length } else { 1 })?
        } else {
            value = match kind {
                0 => 0,
                1 => reader.more()?,
                _ => 0xFF,
            };
            u32::from(low) + 16 * reader.number(u32::from(detail))?
        };
        let grey = if is_fine { value } else { value.min(15) * 17 };
        coverage.run(grey, count)?;
    }
    coverage.finish()
}
