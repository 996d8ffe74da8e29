//! CTB, Chitubox's format, as plain files: versions 2 to 5. Everything is found by offset.

use super::bytes::{Fields, Order};
use super::metadata::with_thicknesses;
use super::preview::Picture;
use super::runs::{Coverage, Reader};
use super::{
    Coding, Contents, Format, Layer, LayerFault, Metadata, Places, PrintFileError, UnreadKind,
};

/// First bytes of a file, by its kind.
#[derive(Clone, Copy)]
pub enum Magic {
    /// Versions 2 to 5, the `GKtwo`'s among them.
    Plain,
    /// The first printers' cbddlp.
    Cbddlp,
    /// Encrypted.
    Encrypted,
}

pub fn magic(bytes: &[u8]) -> Option<Magic> {
    let magic = bytes.first_chunk::<4>()?;
    match u32::from_le_bytes(*magic) {
        0x12FD_0086 | 0x12FD_0106 | 0xFF22_0810 => Some(Magic::Plain),
        0x12FD_0019 => Some(Magic::Cbddlp),
        0x12FD_0107 => Some(Magic::Encrypted),
        _ => None,
    }
}

/// Bytes of a layer in the layer table.
const ROW: u64 = 36;
/// Bytes before a layer's data, from version 3 on.
const BEFORE_DATA: u64 = 84;
const TABLE: &str = "header";

pub fn read(bytes: &[u8], magic: Magic) -> Result<Contents, PrintFileError> {
    match magic {
        Magic::Plain => {}
        Magic::Encrypted => return Err(PrintFileError::EncryptedCtb),
        Magic::Cbddlp => {
            return Err(PrintFileError::Unread {
                kind: UnreadKind::Cbddlp,
            });
        }
    }
    let fields = Fields {
        bytes,
        order: Order::Little,
    };
    let version = fields.u32(4)?;
    if !(2..=5).contains(&version) {
        return Err(PrintFileError::UnknownVersion {
            format: Format::Ctb,
            version: version.to_string(),
            known: "2, 3, 4 or 5",
        });
    }
    let metadata = metadata(fields, version)?;
    let (layers, places) = layers(fields, version)?;
    let mut pictures = Vec::new();
    for at in [0x3C, 0x48] {
        let record = u64::from(fields.u32(at)?);
        if record != 0 {
            let start = u64::from(fields.u32(record + 8)?);
            pictures.push(Picture::Ctb {
                pixels: [fields.u32(record)?, fields.u32(record + 4)?],
                place: start..start + u64::from(fields.u32(record + 12)?),
            });
        }
    }
    Ok(Contents {
        metadata,
        layers: with_thicknesses(layers),
        coding: Coding::Ctb {
            key: fields.u32(0x64)?,
        },
        places: Places::InFile(places),
        pictures,
        copies: None,
        findings: Vec::new(),
    })
}

fn metadata(fields: Fields<'_>, version: u32) -> Result<Metadata, PrintFileError> {
    let pixels = [fields.u32(0x34)?, fields.u32(0x38)?];
    let plate_mm = [
        fields.finite(0x8)?,
        fields.finite(0xC)?,
        fields.finite(0x10)?,
    ];
    let mut pixel_mm = [0.0; 2];
    for axis in 0..2 {
        let side = super::side(pixels[axis], plate_mm[axis]);
        pixel_mm[axis] = side.ok_or_else(|| {
            PrintFileError::bad_setting(TABLE, ["columns and plate x", "rows and plate y"][axis])
        })?;
    }
    let mut metadata = Metadata {
        version: Some(version.to_string()),
        plate_mm,
        is_mirrored_x: Some(fields.u32(0x50)? != 0),
        is_mirrored_y: Some(false),
        layer_mm: Some(fields.f32(0x20)?),
        exposure_s: Some(fields.f32(0x24)?),
        bottom_exposure_s: Some(fields.f32(0x28)?),
        bottom_layers: Some(fields.u32(0x30)?),
        print_time_s: Some(f64::from(fields.u32(0x4C)?)),
        ..Metadata::new(Format::Ctb, pixels, pixel_mm)
    };
    let parameters = u64::from(fields.u32(0x54)?);
    if parameters != 0 {
        metadata.volume_ml = fields.finite(parameters + 0x14)?;
        metadata.weight_g = fields.finite(parameters + 0x18)?;
    }
    let slicer = u64::from(fields.u32(0x68)?);
    if slicer != 0 {
        let name = u64::from(fields.u32(slicer + 0x1C)?);
        let length = u64::from(fields.u32(slicer + 0x20)?);
        metadata.printer = fields.text(name, length)?;
        metadata.uses_layer_values = Some(fields.u8(slicer + 0x27)? != 0);
        metadata.transition_layers = Some(fields.u32(slicer + 0x3C)?);
        if version >= 5 {
            metadata.resin = resin(fields, u64::from(fields.u32(slicer + 0x40)?))?;
        }
    }
    Ok(metadata)
}

/// Type and name of the resin, from the print parameters of version 5.
fn resin(fields: Fields<'_>, parameters: u64) -> Result<Option<String>, PrintFileError> {
    if parameters == 0 {
        return Ok(None);
    }
    let resin = u64::from(fields.u32(parameters + 0x50)?);
    if resin == 0 {
        return Ok(None);
    }
    let text = |length: u64, place: u64| {
        let place = u64::from(fields.u32(resin + place)?);
        fields.text(place, u64::from(fields.u32(resin + length)?))
    };
    Ok(super::joined(&[text(0xC, 0x10)?, text(0x14, 0x18)?]))
}

type Table = (Vec<Layer>, Vec<std::ops::Range<u64>>);

fn layers(fields: Fields<'_>, version: u32) -> Result<Table, PrintFileError> {
    let count = super::checked_layers(fields.u32(0x44)?, fields.len(), ROW)?;
    let table = u64::from(fields.u32(0x40)?);
    let (mut layers, mut places) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for row in 0..count as u64 {
        let at = table + row * ROW;
        let mut layer = Layer {
            z_mm: fields.f32(at)?,
            exposure_s: Some(fields.f32(at + 4)?),
            wait_before_exposure_s: fields.finite(at + 8)?,
            ..Layer::default()
        };
        let start = u64::from(fields.u32(at + 20)?) << 32 | u64::from(fields.u32(at + 12)?);
        let end = start.saturating_add(u64::from(fields.u32(at + 16)?));
        let has_more = version >= 3 && u64::from(fields.u32(at + 24)?) == BEFORE_DATA;
        if has_more && (BEFORE_DATA..=fields.len()).contains(&start) {
            read_more(fields, start - BEFORE_DATA, version, &mut layer)?;
        }
        layers.push(layer);
        places.push(start..end);
    }
    Ok((layers, places))
}

/// Reads what stands before a layer's data.
fn read_more(
    fields: Fields<'_>,
    at: u64,
    version: u32,
    layer: &mut Layer,
) -> Result<(), PrintFileError> {
    let (lift, second) = (fields.finite(at + 0x28)?, fields.finite(at + 0x30)?);
    layer.lift_mm = if version < 4 {
        lift.map(|lift| lift + second.unwrap_or(0.0))
    } else {
        lift
    };
    layer.lift_mm_min = fields.finite(at + 0x2C)?;
    layer.retract_mm_min = fields.finite(at + 0x38)?;
    layer.wait_before_lift_s = fields.finite(at + 0x44)?;
    layer.wait_after_lift_s = fields.finite(at + 0x48)?;
    // Older settings have a light-off delay in the table, newer ones a rest here.
    let rest_s = fields.finite(at + 0x4C)?.filter(|&rest_s| rest_s > 0.0);
    layer.wait_before_exposure_s = rest_s.or(layer.wait_before_exposure_s);
    Ok(())
}

/// Key stream that scrambles data, four bytes at a time: each word is the one before plus a constant step.
struct Scrambling {
    step: u32,
    word: u32,
}

impl Scrambling {
    fn new(key: u32, layer: u32) -> Self {
        let step = key.wrapping_mul(0x2D83_CDAC).wrapping_add(0xD8A8_3423);
        let word = layer.wrapping_mul(0x1E15_30CD).wrapping_add(0xEC3D_47CD);
        Self {
            step,
            word: word.wrapping_mul(step),
        }
    }

    fn undo(mut self, data: &[u8]) -> Vec<u8> {
        let mut plain = data.to_vec();
        for bytes in plain.chunks_mut(4) {
            for (byte, mask) in bytes.iter_mut().zip(self.word.to_le_bytes()) {
                *byte ^= mask;
            }
            self.word = self.word.wrapping_add(self.step);
        }
        plain
    }
}

/// Decodes a layer's data. With key 0 it is not scrambled.
pub fn decode(
    data: &[u8],
    key: u32,
    layer: u32,
    coverage: &mut Coverage<'_>,
) -> Result<(), LayerFault> {
    let plain = match key {
        0 => data.into(),
        _ => std::borrow::Cow::from(Scrambling::new(key, layer).undo(data)),
    };
    let mut reader = Reader::new(&plain);
    while let Some(first) = reader.next() {
        let seven = first & 0x7F;
        let grey = if seven == 0 { 0 } else { 2 * seven + 1 };
        let count = if first & 0x80 == 0 {
            1
        } else {
            let length = reader.more()?;
            let (more, bits) = match length.leading_ones() {
                ones @ 0..=3 => (ones, 7 - ones),
                _ => return Err(reader.fault()),
            };
            let high = u32::from(length) & ((1 << bits) - 1);
            high << (8 * more) | reader.number(more)?
        };
        coverage.run(grey, count)?;
    }
    coverage.finish()
}
