//! Anycubic's binary file of Photon Workshop, versions 515 to 518: pwmx, pm3, pm5, pm5s and others.

use super::bytes::{Fields, Order};
use super::metadata::with_tops;
use super::preview::Picture;
use super::{Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, UnreadKind};

const MARK: &[u8; 12] = b"ANYCUBIC\0\0\0\0";
/// Bytes of a layer in its table.
const ROW: u64 = 32;

pub fn is(bytes: &[u8]) -> bool {
    bytes.first_chunk() == Some(MARK)
}

/// The file and where its tables are.
#[derive(Clone, Copy)]
struct Tables<'a> {
    fields: Fields<'a>,
    version: u32,
}

impl Tables<'_> {
    /// The offset of a table: what stands at `at` in the mark. Its name is checked.
    fn find(self, at: u64, name: &str) -> Result<u64, PrintFileError> {
        let table = u64::from(self.fields.u32(at)?);
        match self.fields.text(table, 12)? {
            Some(found) if found == name => Ok(table),
            _ => Err(PrintFileError::bad_setting("mark", name)),
        }
    }
}

pub fn read(bytes: &[u8]) -> Result<Contents, PrintFileError> {
    let fields = Fields {
        bytes,
        order: Order::Little,
    };
    let version = fields.u32(0xC)?;
    match version {
        515..=518 => {}
        1 => {
            return Err(PrintFileError::Unread {
                kind: UnreadKind::PlanesOfBits,
            });
        }
        _ => {
            return Err(PrintFileError::UnknownVersion {
                format: Format::PhotonWorkshop,
                version: version.to_string(),
                known: "515, 516, 517 or 518",
            });
        }
    }
    let tables = Tables { fields, version };
    let metadata = metadata(tables)?;
    let (layers, places) = layers(tables)?;
    let mut pictures = vec![preview(fields, tables.find(0x1C, "PREVIEW")?)?];
    if version >= 518 {
        pictures.push(preview(fields, tables.find(0x3C, "PREVIEW2")?)?);
    }
    Ok(Contents {
        metadata,
        layers: with_tops(layers),
        coding: Coding::Pw0,
        places: Places::InFile(places),
        pictures,
        copies: None,
        findings: Vec::new(),
    })
}

fn metadata(tables: Tables<'_>) -> Result<Metadata, PrintFileError> {
    let Tables { fields, version } = tables;
    let header = tables.find(0x14, "HEADER")?;
    let pixels = [fields.u32(header + 0x3C)?, fields.u32(header + 0x40)?];
    let largest_mm = fields.finite(header + 0x10)?.map(|um| um / 1000.0);
    let bottom_layers = fields.finite(header + 0x24)?;
    let mut metadata = Metadata {
        version: Some(version.to_string()),
        layer_mm: Some(fields.f32(header + 0x14)?),
        exposure_s: Some(fields.f32(header + 0x18)?),
        bottom_exposure_s: Some(fields.f32(header + 0x20)?),
        bottom_layers: bottom_layers.map(|layers| layers.round() as u32),
        volume_ml: fields.finite(header + 0x34)?,
        weight_g: fields.finite(header + 0x44)?,
        uses_layer_values: Some(fields.u32(header + 0x50)? != 0),
        print_time_s: Some(f64::from(fields.u32(header + 0x54)?)),
        ..Metadata::new(Format::PhotonWorkshop, pixels, [0.0; 2])
    };
    let mut pixel_mm = [None; 2];
    if version >= 516 {
        metadata.transition_layers = Some(fields.u32(header + 0x58)?);
        let machine = tables.find(0x2C, "MACHINE")?;
        metadata.printer = fields.text(machine + 0x10, 96)?;
        if fields.text(machine + 0x70, 16)?.as_deref() != Some("pw0Img") {
            return Err(PrintFileError::Unread {
                kind: UnreadKind::PlanesOfBits,
            });
        }
        for axis in 0..3 {
            metadata.plate_mm[axis] = fields.finite(machine + 0x88 + 4 * axis as u64)?;
        }
        for axis in 0..2 {
            if version >= 518 {
                let side_um = fields.finite(machine + 0x9C + 4 * axis as u64)?;
                pixel_mm[axis] = super::positive(side_um).map(|um| um / 1000.0);
            }
            let side = super::side(pixels[axis], metadata.plate_mm[axis]);
            pixel_mm[axis] = pixel_mm[axis].or(side);
        }
    }
    if version >= 517 {
        let software = u64::from(fields.u32(0x18)?);
        metadata.software =
            super::joined(&[fields.text(software, 32)?, fields.text(software + 36, 32)?]);
    }
    for (axis, side) in pixel_mm.into_iter().enumerate() {
        let side = side.or(super::positive(largest_mm));
        metadata.pixel_mm[axis] =
            side.ok_or_else(|| PrintFileError::bad_setting("HEADER", "pixel size"))?;
    }
    Ok(metadata)
}

type Table = (Vec<Layer>, Vec<std::ops::Range<u64>>);

fn layers(tables: Tables<'_>) -> Result<Table, PrintFileError> {
    let Tables { fields, version } = tables;
    let table = tables.find(0x24, "LAYERDEF")?;
    let count = super::checked_layers(fields.u32(table + 16)?, fields.len(), ROW)?;
    let wait_s = fields.finite(tables.find(0x14, "HEADER")? + 0x1C)?;
    let retract = fields.finite(tables.find(0x14, "HEADER")? + 0x30)?;
    let by_minute = |speed: Option<f64>| speed.map(|speed| speed * 60.0);
    let (mut layers, mut places) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for row in 0..count as u64 {
        let at = table + 20 + row * ROW;
        let lit = u64::from(fields.u32(at + 24)?);
        layers.push(Layer {
            thickness_mm: fields.f32(at + 20)?,
            exposure_s: Some(fields.f32(at + 16)?),
            wait_before_exposure_s: wait_s,
            lift_mm: fields.finite(at + 8)?,
            lift_mm_min: by_minute(fields.finite(at + 12)?),
            retract_mm_min: by_minute(retract),
            stated_lit_pixels: (version >= 516).then_some(lit),
            ..Layer::default()
        });
        let start = u64::from(fields.u32(at)?);
        places.push(start..start + u64::from(fields.u32(at + 4)?));
    }
    Ok((layers, places))
}

/// A preview: columns, a word, rows, and the pixels.
fn preview(fields: Fields<'_>, table: u64) -> Result<Picture, PrintFileError> {
    let pixels = [fields.u32(table + 16)?, fields.u32(table + 24)?];
    let start = table + 28;
    let length = u64::from(pixels[0]).saturating_mul(2 * u64::from(pixels[1]));
    Ok(Picture::Words {
        pixels,
        order: Order::Little,
        place: start..start.saturating_add(length),
    })
}
