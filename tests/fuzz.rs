//! The fuzz targets on every compiler: their seeds, which include what fuzzing has found, and some changes to each.
//!
//! `BLESS=1 cargo test --test main fuzz::` rewrites the seeds that are made by code, and leaves the others.

#[path = "../fuzz/src/lib.rs"]
#[expect(
    dead_code,
    reason = "only libFuzzer's processes work on their own thread"
)]
mod targets;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use crate::common::Slicer;
use cusp_slicer::format::Format;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{Backend, JobOptions, Options, Planner};
use cusp_slicer::model::weights;
use cusp_slicer::printer::PRINTERS;
use cusp_slicer::resin::Resin;
use glam::Vec3;

use crate::common::{binary_stl, quiet, solids};
use targets::readers::{WEIGHED_CORNERS, packed_part, without_previews};
use targets::{TARGETS, Target, settings};

/// Changed copies of each seed: together they take a few seconds.
const CHANGES: u64 = 150;

fn folder(target: &str) -> PathBuf {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    seeds.join(target)
}

/// The seeds of a target by their names, in order.
fn seeds(target: &str) -> Vec<(String, Vec<u8>)> {
    let files = fs::read_dir(folder(target)).unwrap();
    let mut seeds: Vec<_> = files
        .map(|file| file.unwrap())
        .map(|file| {
            let name = file.file_name().into_string().unwrap();
            (name, fs::read(file.path()).unwrap())
        })
        .collect();
    seeds.sort();
    seeds
}

/// Runs a target, and keeps the input if it panics.
fn run(target: Target, bytes: &[u8], of: &str) {
    if catch_unwind(AssertUnwindSafe(|| target(bytes))).is_err() {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(of.replace('/', "-"));
        fs::write(&file, bytes).unwrap();
        panic!("{of}: the input is in {}", file.display());
    }
}

/// Runs a target on its seeds and on changed copies, the same ones every time.
#[track_caller]
fn replay(name: &str) {
    if std::env::var_os("BLESS").is_some() {
        make(name);
    }
    let target = TARGETS.iter().find(|(known, _)| *known == name).unwrap().1;
    let seeds = seeds(name);
    assert!(!seeds.is_empty());
    for (seed, bytes) in seeds {
        run(target, &bytes, &format!("{name}/{seed}"));
        for change in 0..CHANGES {
            let mut random = fastrand::Rng::with_seed(change);
            let changed = changed(bytes.clone(), &mut random);
            run(target, &changed, &format!("{name}/{seed} {change}"));
        }
    }
}

/// Some changes like those of fuzzers.
fn changed(mut bytes: Vec<u8>, random: &mut fastrand::Rng) -> Vec<u8> {
    for _ in 0..random.usize(1..5) {
        if bytes.is_empty() {
            return bytes;
        }
        let at = random.usize(..bytes.len());
        let end = (at + random.usize(1..9)).min(bytes.len());
        match random.u8(..7) {
            0 => bytes[at] = random.u8(..),
            1 => bytes[at] ^= 1 << random.u8(..8),
            2 => bytes[at..end].fill([0, 0xff, b'9', b' '][random.usize(..4)]),
            3 => drop(bytes.drain(at..end)),
            4 => {
                let again = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, again));
            }
            5 => bytes.insert(at, random.u8(..)),
            _ => bytes.truncate(at),
        }
    }
    bytes
}

#[test]
fn inspections_survive_any_boxes() {
    replay("inspect");
}

#[test]
fn readers_of_models_survive_any_bytes() {
    replay("model");
}

#[test]
fn readers_of_zips_survive_any_parts() {
    replay("packed");
}

#[test]
fn plans_keep_their_promises_whatever_the_model_and_options() {
    replay("pipeline");
}

#[test]
fn readers_of_plans_survive_any_text() {
    replay("plan");
}

#[test]
fn readers_of_print_files_survive_any_bytes() {
    replay("print_file");
}

#[test]
fn readers_of_settings_survive_any_text() {
    replay("settings");
}

#[test]
fn readers_of_weights_survive_any_bytes() {
    replay("weights");
}

/// Writes the seeds of a target that code makes.
fn make(target: &str) {
    let seeds = match target {
        "inspect" | "pipeline" => random_seeds(target),
        "model" => models(),
        "packed" => packed(),
        "plan" => vec![("plan.json".to_owned(), settings::made_plan().into_bytes())],
        "print_file" => print_files(),
        "settings" => settings_of_all_kinds(),
        _ => vec![(
            "two.weights".to_owned(),
            weights::to_bytes(&[0.25, 1.0], &WEIGHED_CORNERS),
        )],
    };
    fs::create_dir_all(folder(target)).unwrap();
    for (name, bytes) in seeds {
        fs::write(folder(target).join(name), bytes).unwrap();
    }
}

/// Bytes that decide on models and options: one seed for each further promise, and each kind of model.
fn random_seeds(target: &str) -> Vec<(String, Vec<u8>)> {
    (0..21)
        .map(|seed| {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut bytes: Vec<u8> = (0..120).map(|_| random.u8(..)).collect();
            bytes[0] = seed as u8;
            bytes[1] = seed as u8 / 7;
            (format!("{target}-{seed:02}"), bytes)
        })
        .collect()
}

fn models() -> Vec<(String, Vec<u8>)> {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let facets = facets.map(|facet: [usize; 3]| {
        let vertices = facet.map(|corner| {
            let Vec3 { x, y, z } = corners[corner];
            format!("vertex {x} {y} {z}\n")
        });
        let vertices = vertices.concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    });
    let stl = facets.concat();
    let obj = "# a pyramid\nmtllib a.mtl\no a\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nv 0.5 .5 1e0\nvt 0 0\nvn 0 0 1\n\
               g sides\nf 1 2 5\nf 2/1 3/1 5/1\nf 3//1 4//1 5//1\nf -2 -5 -1\nusemtl b\nf 4/1/1 3/1/1 2/1/1 1/1/1\n";
    vec![
        ("binary.stl".to_owned(), binary_stl(&solids::cube(1.0))),
        (
            "text.stl".to_owned(),
            format!("solid a\n{stl}endsolid a\n").into(),
        ),
        ("pyramid.obj".to_owned(), obj.into()),
    ]
}

/// Print files of every format, with few pixels.
fn small_print_files() -> Vec<(String, Vec<u8>)> {
    // Previews of flat faces are short.
    let pyramid = solids::cone(0.5, 0.8, 1);
    let mut slicer = Slicer::load(&binary_stl(&pyramid)).unwrap();
    let formats = Format::MASKS.into_iter();
    formats
        .map(|format| {
            let options = Options {
                pixels: Some([24, 16]),
                pitch_mm: Some(0.07),
                format: Some(format),
                planner: Planner::Uniform { layer_mm: 0.2 },
                antialias: 4,
                backend: Backend::Cpu,
                ..Options::default()
            };
            pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
            let (file, report) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
            (
                format!("{}.{}", format.name(), report.print_file.extension),
                file,
            )
        })
        .collect()
}

fn print_files() -> Vec<(String, Vec<u8>)> {
    let files = small_print_files().into_iter();
    let files = files.map(|(name, bytes)| (name, without_previews(bytes)));
    // Zips are the seeds of `packed`; one shows how they are packed.
    files
        .filter(|(name, bytes)| name.starts_with("png") || !bytes.starts_with(b"PK"))
        .collect()
}

fn packed() -> Vec<(String, Vec<u8>)> {
    let files = small_print_files().into_iter();
    let zips = files.filter(|(_, bytes)| bytes.starts_with(b"PK"));
    let mut seeds: Vec<_> = zips.map(|(name, bytes)| (name, parts(&bytes))).collect();
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let vertices =
        corners.map(|Vec3 { x, y, z }| format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>"));
    let model = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"inch\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources><object id=\"1\" type=\"model\"><mesh>\
         <vertices>{}</vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
         <triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>\n\
         <object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 2 0 0\"/></components></object>\
         </resources>\n<build><item objectid=\"1\"/><item objectid=\"2\" printable=\"1\"/></build></model>\n",
        vertices.concat()
    );
    let relationships = "<?xml version=\"1.0\"?>\n<Relationships \
        xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Target=\"/3D/3dmodel.model\" Id=\"a\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let parts = [("_rels/.rels", relationships), ("3D/3dmodel.model", &model)];
    let parts = parts.map(|(name, text)| packed_part(name, text.as_bytes()));
    seeds.push(("pyramid.3mf".to_owned(), parts.concat()));
    seeds
}

/// The parts of a zip as [`targets::readers::packed`] has them, without previews, of which changes would find nothing.
fn parts(zip: &[u8]) -> Vec<u8> {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(zip)).unwrap();
    let mut parts = Vec::new();
    for place in 0..archive.len() {
        let mut part = archive.by_index(place).unwrap();
        let mut contents = Vec::new();
        std::io::copy(&mut part, &mut contents).unwrap();
        if contents.len() < 3000 {
            parts.extend(packed_part(&part.name().unwrap(), &contents));
        }
    }
    parts
}

fn settings_of_all_kinds() -> Vec<(String, Vec<u8>)> {
    let options = Options {
        rotation: Some([0.0, 0.5, 0.0, 1.0]),
        ranges: vec![cusp_slicer::plan::HeightRange {
            from_mm: 1.0,
            to_mm: 2.5,
            layer_min_mm: 0.05,
            layer_max_mm: 0.1,
        }],
        planes_mm: vec![3.25],
        hollow: Some(cusp_slicer::prepare::Hollowing::default()),
        supports: Some(cusp_slicer::prepare::Supporting::default()),
        planner: Planner::Uniform { layer_mm: 0.05 },
        printer: Some("saturn-3-ultra".into()),
        ..Options::default()
    };
    let job = JobOptions {
        models: vec![cusp_slicer::job::ModelOptions::default(); 2],
        ..JobOptions::default()
    };
    let prices = r#"{"currency":"EUR","setup":5,"machine_per_h":2.5,"resin_per_ml":0.2,"supports":0.3,"minimum":12,
        "finishes":[{"name":"sanded","per_copy":3,"per_ml":0.1}],"quantity_breaks":[{"copies":5,"discount":0.1}]}"#;
    let text = |value: Result<String, serde_json::Error>| value.unwrap().into_bytes();
    let resin = Resin {
        exposures: vec![[0.05, 2.5], [0.1, 4.0]],
        ..Resin::default()
    };
    vec![
        (
            "options.json".to_owned(),
            text(serde_json::to_string(&options)),
        ),
        ("job.json".to_owned(), text(serde_json::to_string(&job))),
        ("resin.json".to_owned(), text(serde_json::to_string(&resin))),
        (
            "printer.json".to_owned(),
            text(serde_json::to_string(&*PRINTERS[0])),
        ),
        (
            "limits.json".to_owned(),
            text(serde_json::to_string(&Limits::default())),
        ),
        ("prices.json".to_owned(), prices.into()),
    ]
}
