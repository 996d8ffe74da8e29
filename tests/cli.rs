//! The command line as its users meet it: exit codes, one sentence of error, JSON, whole files.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::path::PathBuf;
use std::process::{Command, Output};

use common::{assert_near, binary_stl, solids};
use serde_json::Value;
use tempfile::TempDir;

fn cusp(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(arguments)
        .output()
        .unwrap()
}

fn sphere(folder: &TempDir) -> String {
    model(folder, "ball.stl", &binary_stl(&solids::sphere(3.0, 4)))
}

fn model(folder: &TempDir, name: &str, bytes: &[u8]) -> String {
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path.to_str().unwrap().to_owned()
}

fn json(output: &Output) -> Value {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Asserts that a command fails with `code` and says `words` in one line, nothing on stdout.
#[track_caller]
fn assert_fails(output: &Output, code: i32, words: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{stderr}");
    assert!(stderr.contains(words), "{stderr}");
    assert!(output.stdout.is_empty());
    if code == 1 {
        assert_eq!(stderr.trim_end().lines().count(), 1, "{stderr}");
    }
}

#[test]
fn help_names_every_command_and_option() {
    let help = cusp(&["--help"]);
    let text = String::from_utf8(help.stdout).unwrap();
    assert!(help.status.success());
    for word in ["slice", "plan", "info"] {
        assert!(text.contains(word), "{word}");
    }
    let text = String::from_utf8(cusp(&["slice", "--help"]).stdout).unwrap();
    for option in [
        "--output",
        "--json",
        "--height",
        "--pixels",
        "--pitch",
        "--layer-min",
        "--layer-max",
        "--tolerance",
        "--bin",
        "--metric",
        "--planner",
        "--layer",
        "--backend",
    ] {
        assert!(text.contains(option), "{option}");
    }
}

#[test]
fn plan_prints_one_json_object_with_every_key() {
    let folder = TempDir::new().unwrap();
    let report = json(&cusp(&[
        "plan",
        &sphere(&folder),
        "--json",
        "--backend",
        "cpu",
    ]));
    for key in [
        "layers",
        "height_mm",
        "z_mm",
        "thickness_mm",
        "max_error_mm",
        "tolerance_mm",
        "metric",
        "planner",
        "backend",
        "adapter",
        "bins",
        "bin_mm",
        "facets",
        "hits",
        "mask",
        "warnings",
        "timings_ms",
    ] {
        assert!(report.get(key).is_some(), "{key}");
    }
    for key in ["load", "ldi", "profile", "plan", "masks", "total"] {
        assert!(report["timings_ms"][key].is_number(), "{key}");
    }
    let z_mm: Vec<f64> = report["z_mm"]
        .as_array()
        .unwrap()
        .iter()
        .map(|z| z.as_f64().unwrap())
        .collect();
    let layers = report["layers"].as_u64().unwrap() as usize;
    assert_eq!((z_mm.len(), z_mm[0]), (layers + 1, 0.0));
    assert_near(z_mm[layers], 6.0, 1e-9);
    for thickness in z_mm.windows(2).map(|layer| layer[1] - layer[0]) {
        assert!(
            (0.05 - 1e-9..=0.15 + 1e-9).contains(&thickness),
            "{thickness}"
        );
    }
    assert!(report["max_error_mm"].as_f64().unwrap() <= 0.065 + 1e-9);
    assert_eq!(
        (&report["metric"], &report["backend"]),
        (&"cusp".into(), &"cpu".into())
    );
    assert_eq!(report["mask"]["width"], 2048);
}

#[test]
fn slice_writes_a_whole_zip_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let (model, zip) = (sphere(&folder), folder.path().join("out.zip"));
    let output = cusp(&[
        "slice",
        &model,
        "-o",
        zip.to_str().unwrap(),
        "--pixels",
        "300x200",
        "--pitch",
        "0.04",
        "--height",
        "3",
        "--json",
    ]);
    let report = json(&output);
    assert_eq!(report["mask"]["width"], 300);
    assert_near(report["height_mm"].as_f64().unwrap(), 3.0, 1e-6);
    let archive = zip::ZipArchive::new(std::fs::File::open(&zip).unwrap()).unwrap();
    assert_eq!(archive.len() as u64, report["layers"].as_u64().unwrap() + 1);
    let mut names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["ball.stl", "out.zip"]);
}

#[test]
fn a_failed_slice_leaves_the_old_file() {
    let folder = TempDir::new().unwrap();
    let zip = model(&folder, "out.zip", b"precious");
    let output = cusp(&["slice", &sphere(&folder), "-o", &zip, "--tolerance", "0.01"]);
    assert_fails(&output, 1, "raise the tolerance");
    assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn uniform_takes_a_layer_thickness() {
    let folder = TempDir::new().unwrap();
    let model = sphere(&folder);
    let report = json(&cusp(&[
        "plan",
        &model,
        "--planner",
        "uniform",
        "--layer",
        "0.1",
        "--json",
    ]));
    assert_eq!(
        (&report["layers"], &report["planner"]),
        (&60.into(), &"uniform".into())
    );
    assert_fails(
        &cusp(&["plan", &model, "--planner", "uniform"]),
        2,
        "--layer",
    );
}

#[test]
fn info_describes_the_model() {
    let folder = TempDir::new().unwrap();
    let model = model(&folder, "box.stl", &binary_stl(&solids::cube(20.0)));
    let info = json(&cusp(&["info", &model, "--json"]));
    assert_eq!(
        (&info["facets"], &info["vertices"]),
        (&12.into(), &8.into())
    );
    assert_eq!(
        (&info["closed"], &info["degenerate_facets"]),
        (&true.into(), &0.into())
    );
    assert_near(info["volume_mm3"].as_f64().unwrap(), 8000.0, 1e-6);
    let text = String::from_utf8(cusp(&["info", &model]).stdout).unwrap();
    assert!(text.contains("20.000 × 20.000 × 20.000 mm"), "{text}");
}

#[test]
fn bad_input_is_one_clear_sentence_and_exit_code_1() {
    let folder = TempDir::new().unwrap();
    let mut nan = binary_stl(&solids::cube(1.0));
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    let good = binary_stl(&solids::cube(1.0));
    let flat = binary_stl(&solids::cube(1.0)[2..4]);
    for (bytes, words) in [
        (&b""[..], "empty"),
        (b"a poem about a cube", "no STL"),
        (&good[..200], "ends at byte 200"),
        (&nan, "byte 96"),
        (
            b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 z\n",
            "line 4",
        ),
    ] {
        let path = model(&folder, "bad.stl", bytes);
        assert_fails(&cusp(&["info", &path]), 1, words);
        assert_fails(&cusp(&["plan", &path]), 1, words);
    }
    assert_fails(
        &cusp(&["plan", &model(&folder, "flat.stl", &flat)]),
        1,
        "no height",
    );
    assert_fails(
        &cusp(&["info", "/nowhere/at all.stl"]),
        1,
        "/nowhere/at all.stl",
    );
    let ball = sphere(&folder);
    let too_small = cusp(&["plan", &ball, "--pixels", "100x100", "--pitch", "0.05"]);
    assert_fails(&too_small, 1, "a scale of 0.8333 fits");
    assert_fails(
        &cusp(&["plan", &ball, "--tolerance", "0.01"]),
        1,
        "at z = 0.000 mm",
    );
    assert_fails(
        &cusp(&["plan", &ball, "--layer-min", "0.2"]),
        1,
        "widen the range",
    );
}

#[test]
fn bad_usage_is_exit_code_2() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    assert_fails(&cusp(&[]), 2, "Usage");
    assert_fails(&cusp(&["slice", &ball]), 2, "--output");
    assert_fails(
        &cusp(&["plan", &ball, "--pixels", "100"]),
        2,
        "columns and rows",
    );
    assert_fails(&cusp(&["plan", &ball, "--pixels", "9x9"]), 2, "--pitch");
    assert_fails(&cusp(&["plan", &ball, "--height", "-4"]), 2, "--height");
    assert_fails(&cusp(&["plan", &ball, "--tolerance", "NaN"]), 2, "positive");
    assert_fails(&cusp(&["plan", &ball, "--metric", "beauty"]), 2, "cusp");
}
