//! Print files made byte by byte from the descriptions of their formats, and the readers' results.

mod ctb;
mod damage;
mod goo;
mod photon_workshop;
mod surface;
mod zips;

use std::collections::HashSet;
use std::io::{Cursor, Write as _};
use std::ops::ControlFlow;
use std::process::Command;

use cusp_slicer::archive::read::{
    FileFinding, Flips, Inspection, LayerFault, PrintFile, PrintFileError, inspect,
};
use cusp_slicer::progress::{Cancelled, silent};
use serde_json::Value;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A file of which the fields are filled in by offset.
struct Blank {
    bytes: Vec<u8>,
    is_big_endian: bool,
}

impl Blank {
    fn new(length: usize, is_big_endian: bool) -> Self {
        Self {
            bytes: vec![0; length],
            is_big_endian,
        }
    }

    fn put<const N: usize>(&mut self, at: usize, mut bytes: [u8; N]) -> &mut Self {
        if self.is_big_endian {
            bytes.reverse();
        }
        self.text(at, bytes)
    }

    fn u8(&mut self, at: usize, value: u8) -> &mut Self {
        self.put(at, [value])
    }

    fn u16(&mut self, at: usize, value: u16) -> &mut Self {
        self.put(at, value.to_le_bytes())
    }

    fn u32(&mut self, at: usize, value: u32) -> &mut Self {
        self.put(at, value.to_le_bytes())
    }

    fn f32(&mut self, at: usize, value: f32) -> &mut Self {
        self.put(at, value.to_le_bytes())
    }

    fn text(&mut self, at: usize, text: impl AsRef<[u8]>) -> &mut Self {
        let text = text.as_ref();
        self.bytes[at..at + text.len()].copy_from_slice(text);
        self
    }

    /// Appends zeros, and returns where they begin.
    fn grow(&mut self, length: usize) -> usize {
        let at = self.bytes.len();
        self.bytes.resize(at + length, 0);
        at
    }

    /// Appends bytes, and returns where they begin.
    fn add(&mut self, bytes: &[u8]) -> usize {
        let at = self.grow(0);
        self.bytes.extend_from_slice(bytes);
        at
    }
}

fn open(bytes: &[u8]) -> PrintFile<'_> {
    PrintFile::open(bytes).unwrap()
}

fn error(bytes: &[u8]) -> PrintFileError {
    PrintFile::open(bytes)
        .err()
        .unwrap_or_else(|| panic!("it was read"))
}

fn inspected(bytes: &[u8]) -> Inspection {
    inspect(&open(bytes), &mut silent).unwrap()
}

fn warnings(bytes: &[u8]) -> Vec<FileFinding> {
    inspected(bytes).warnings
}

/// The fault of a file's only bad layer.
#[track_caller]
fn only_fault(bytes: &[u8]) -> (usize, LayerFault) {
    let faults: Vec<_> = warnings(bytes)
        .into_iter()
        .filter_map(|finding| match finding {
            FileFinding::BadLayers {
                layers: 1,
                first_layer,
                fault,
            } => Some((first_layer, fault)),
            _ => None,
        })
        .collect();
    assert_eq!(faults.len(), 1, "{faults:?}");
    faults[0].clone()
}

/// The pixels of a layer, row by row.
fn pixels(file: &PrintFile<'_>, layer: usize) -> Vec<u8> {
    let mut pixels = Vec::new();
    file.runs(layer, &mut |grey, count| {
        pixels.extend(std::iter::repeat_n(grey, count as usize));
    })
    .unwrap();
    // The mask agrees: it is lit from half of the brightness on.
    let [width, height] = file.metadata().pixels.map(|side| side as i32);
    let mask = file.mask(layer, Flips::default()).unwrap();
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    for (&pixel, (column, row)) in pixels.iter().zip(places) {
        assert_eq!(mask.is_lit(column, row), pixel >= 128, "{column}, {row}");
    }
    pixels
}

/// A zip of these files.
pub fn zipped(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        zip.start_file(name.as_str(), SimpleFileOptions::default())
            .unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

#[test]
fn what_is_no_print_file_is_named() {
    for bytes in [&b""[..], b"x", b"a poem about a cube", &[0; 4000]] {
        assert_eq!(error(bytes), PrintFileError::UnknownKind);
    }
    let zip = zipped(&[("readme.txt".to_owned(), b"hello".to_vec())]);
    assert_eq!(error(&zip), PrintFileError::UnknownZip);
    let model = ("3D/3dmodel.model".to_owned(), b"<model/>".to_vec());
    for layers in [
        None,
        Some("Metadata/Slic3r_PE_layer_heights_profile.txt"),
        Some("Metadata/layer_heights_profile.txt"),
    ] {
        let layers_file = layers.map(|name| (name.to_owned(), b"1|0;0.2".to_vec()));
        let files: Vec<_> = [model.clone()].into_iter().chain(layers_file).collect();
        let has_layers = layers.is_some();
        assert_eq!(error(&zipped(&files)), PrintFileError::Model { has_layers });
    }
    let damaged = error(&zip[..zip.len() - 30]);
    assert!(matches!(damaged, PrintFileError::DamagedZip { .. }));
}

#[test]
fn an_inspection_can_be_cancelled() {
    let file = goo::goo(&[]);
    assert_eq!(warnings(&file), [FileFinding::NoLayers]);
    let mut stop = |_: f64| ControlFlow::Break(());
    assert_eq!(inspect(&open(&file), &mut stop), Err(Cancelled));
}

/// The properties that a JSON Schema describes, at any depth.
fn described(schema: &Value) -> HashSet<&String> {
    let Value::Object(fields) = schema else {
        return HashSet::new();
    };
    let properties = schema["properties"].as_object().into_iter().flatten();
    let own = properties.filter(|(_, it)| it["description"].is_string());
    let own = own.map(|(name, _)| name);
    own.chain(fields.values().flat_map(described)).collect()
}

#[test]
fn the_schema_describes_every_value() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cusp"));
    let printed = command.args(["schema", "inspect"]).output().unwrap().stdout;
    let schema: Value = serde_json::from_slice(&printed).unwrap();
    let described = described(&schema);
    let file = photon_workshop::photon_workshop(516, &[(0.05, photon_workshop::white())]);
    let found = serde_json::to_value(inspected(&file)).unwrap();
    let layer = &found["layer_values"][0];
    let names = [&found, layer].map(|object| object.as_object().unwrap().keys());
    for name in names.into_iter().flatten() {
        assert!(described.contains(name), "{name}");
    }
}

#[test]
fn errors_and_findings_are_a_code_with_details() {
    let error = PrintFileError::Truncated {
        needed_bytes: 12,
        found_bytes: 7,
    };
    let expected = serde_json::json!({
        "code": "truncated",
        "detail": { "needed_bytes": 12, "found_bytes": 7 },
    });
    assert_eq!(serde_json::to_value(error).unwrap(), expected);
    let finding = FileFinding::BadLayers {
        layers: 2,
        first_layer: 3,
        fault: LayerFault::TooFewPixels {
            pixels: 5,
            expected: 6,
        },
    };
    let fault = serde_json::json!({
        "code": "too-few-pixels",
        "detail": { "pixels": 5, "expected": 6 },
    });
    let expected = serde_json::json!({
        "code": "bad-layers",
        "detail": { "layers": 2, "first_layer": 3, "fault": fault },
    });
    assert_eq!(serde_json::to_value(&finding).unwrap(), expected);
    let sentence = "2 layers are damaged, first layer 3: its runs cover 5 of 6 pixels; copy or export the file again";
    assert_eq!(finding.to_string(), sentence);
}
