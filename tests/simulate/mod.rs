//! Prints of print files, measured against models: closed forms, hand-made files, and a naive oracle.

mod files;
mod oracle;
mod solids;
mod tolerance;

use std::io::{Cursor, Read as _};

use crate::common::Slicer;
use crate::common::solids::Triangles;
use crate::common::{binary_stl, quiet};
use crate::inspect::zipped;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Planner};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::silent;
use cusp_slicer::simulation::{Knowledge, Original, Simulation, SimulationError, simulate};
use serde_json::{Value, json};
use zip::ZipArchive;

/// Uniform layers of `layer_mm`, and square pixels.
fn uniform(layer_mm: f64, pitch_mm: f64) -> Options {
    Options {
        pitch_mm: Some(pitch_mm),
        planner: Planner::Uniform { layer_mm },
        format: Some(Format::Png),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The print file of a model.
fn slice(triangles: &Triangles, options: &Options) -> Vec<u8> {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
    slicer.write_archive(Vec::new(), &mut quiet).unwrap().0
}

fn original(triangles: &Triangles) -> Original {
    Original {
        mesh: Mesh::from_triangles(triangles).unwrap(),
        unit: None,
    }
}

fn measured(triangles: &Triangles, print_file: &[u8], knowledge: &Knowledge) -> Simulation {
    simulate(&[original(triangles)], print_file, knowledge, &mut silent).unwrap()
}

fn sliced_and_measured(triangles: &Triangles, options: &Options) -> Simulation {
    measured(triangles, &slice(triangles, options), &Knowledge::default())
}

fn error(triangles: &Triangles, print_file: &[u8]) -> SimulationError {
    let originals = [original(triangles)];
    simulate(&originals, print_file, &Knowledge::default(), &mut silent).unwrap_err()
}

/// The files of a zip.
fn unzipped(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut zip = ZipArchive::new(Cursor::new(bytes)).unwrap();
    (0..zip.len())
        .map(|index| {
            let mut file = zip.by_index(index).unwrap();
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).unwrap();
            (file.name().unwrap().into_owned(), bytes)
        })
        .collect()
}

/// A copy of a print file of ours with another manifest.
fn with_manifest(print_file: &[u8], change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let mut files = unzipped(print_file);
    let (_, manifest) = files
        .iter_mut()
        .find(|(name, _)| name == "manifest.json")
        .unwrap();
    let mut value = serde_json::from_slice(manifest).unwrap();
    change(&mut value);
    *manifest = serde_json::to_vec(&value).unwrap();
    zipped(&files)
}

/// An 8-bit grey PNG.
fn png_of(width: u32, height: u32, brightness: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let pixels: Vec<u8> = places
        .map(|(column, row)| brightness(column, row))
        .collect();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels).unwrap();
    drop(writer);
    bytes
}

/// A print file by hand, in the form of ours: `tops` are the tops of its layers.
fn by_hand(
    [width, height]: [u32; 2],
    pitch_mm: [f64; 2],
    tops: &[f64],
    brightness: impl Fn(usize, u32, u32) -> u8,
) -> Vec<u8> {
    let name = |layer: usize| format!("{layer}.png");
    let layers: Vec<Value> = tops
        .iter()
        .enumerate()
        .map(|(layer, z_mm)| json!({ "file": name(layer), "z_mm": z_mm }))
        .collect();
    let manifest = json!({
        "options": { "rotation": null, "height_mm": null },
        "models": [{ "model": 0, "options": {} }],
        "placements": [{ "model": 0, "x_mm": 0.0, "y_mm": 0.0, "turn_deg": 0 }],
        "mask": {
            "width": width, "height": height, "is_mirrored": false,
            "pitch_mm": pitch_mm[0], "pitch_y_mm": pitch_mm[1],
        },
        "layer_files": layers,
    });
    let mut files = vec![(
        "manifest.json".to_owned(),
        serde_json::to_vec(&manifest).unwrap(),
    )];
    for layer in 0..tops.len() {
        let mask = |column, row| brightness(layer, column, row);
        files.push((name(layer), png_of(width, height, mask)));
    }
    zipped(&files)
}
