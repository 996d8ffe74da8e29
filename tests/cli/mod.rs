//! The command line as users see it: exit codes, one-line errors, JSON, and complete files.

mod batch;
mod bounds;
mod calibrate;
mod check;
mod config;
mod contours;
mod convert;
mod examples;
mod files;
mod info;
mod inspect;
#[cfg(unix)]
mod interrupt;
mod orient;
mod packaging;
mod plan;
mod plate;
mod price;
mod simulate;
mod standard;
mod thicknesses;
mod usage;
mod verify;

use std::path::PathBuf;
use std::process::{Command, Output};

use crate::common::{binary_stl, solids};
use serde_json::Value;
use tempfile::TempDir;

fn cusp(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Runs on the CPU, so that every machine gives the same result.
fn on_cpu(arguments: &[&str]) -> Output {
    cusp(&[arguments, &["--backend", "cpu"]].concat())
}

fn names(folder: &TempDir) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn sphere(folder: &TempDir) -> String {
    model(folder, "ball.stl", &binary_stl(&solids::sphere(3.0, 4)))
}

fn model(folder: &TempDir, name: &str, bytes: &[u8]) -> String {
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A slab tilted off every axis.
fn slab(folder: &TempDir) -> String {
    let mut slab = solids::cuboid(glam::Vec3::new(9.0, 7.0, 2.0));
    let askew = glam::Quat::from_xyzw(0.3, -0.4, 0.1, 0.8).normalize();
    for corner in slab.iter_mut().flatten() {
        *corner = askew * *corner;
    }
    model(folder, "slab.stl", &binary_stl(&slab))
}

/// The JSON of a command; of a job of one plate, that plate with the rest.
fn json(output: &Output) -> Value {
    of_only_plate(whole_json(output))
}

fn of_only_plate(mut whole: Value) -> Value {
    let plates = whole.get_mut("plates").and_then(Value::as_array_mut);
    let Some(mut only) = plates.filter(|plates| plates.len() == 1).and_then(Vec::pop) else {
        return whole;
    };
    let whole = whole.as_object_mut().unwrap();
    for (key, value) in whole.iter_mut().filter(|it| it.0 != "plates") {
        let of_plate = only.as_object_mut().unwrap();
        of_plate.entry(key.clone()).or_insert(value.take());
    }
    only
}

fn whole_json(output: &Output) -> Value {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Asserts that a command fails with exit code `code`, writes `words` to stderr, and nothing to stdout. With code 1,
/// stderr must be a single line.
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
