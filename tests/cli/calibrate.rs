//! Prints that measure a printer, and resin files.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{assert_fails, cusp};

#[test]
fn calibration_prints_say_what_to_measure() {
    let folder = TempDir::new().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let towers = place("towers.goo");
    let output = cusp(&[
        "calibrate",
        "layers",
        "--printer",
        "saturn-4",
        "-o",
        &towers,
    ]);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("Measure both: 0.5 and 1.5 mm"), "{text}");
    assert!(fs::read(&towers).unwrap().starts_with(b"V3.0"));

    let grid = place("grid.ctb");
    let output = cusp(&[
        "calibrate",
        "exposure",
        "--printer",
        "ld-002h",
        "--thicknesses",
        "0.05,0.1",
        "--exposures",
        "1.5,2,3",
        "-o",
        &grid,
    ]);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("2  0.1 mm       1.5 s       2 s       3 s"),
        "{text}"
    );
    assert!(fs::read(&grid).unwrap().starts_with(&[0x86, 0, 0xfd, 0x12]));

    let refused = place("towers.sl1");
    let output = cusp(&["calibrate", "layers", "--printer", "sl1s", "-o", &refused]);
    assert_fails(&output, 1, "one thickness for all layers");
    assert!(!folder.path().join("towers.sl1").exists());
}

#[test]
fn measured_exposures_go_into_a_resin_file() {
    let folder = TempDir::new().unwrap();
    let path = folder
        .path()
        .join("resin.json")
        .to_str()
        .unwrap()
        .to_owned();
    let resin = || -> Value { serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap() };
    assert!(
        cusp(&["calibrate", "resin", "0.1=3.5", "0.05=2.4", "-o", &path])
            .status
            .success()
    );
    assert_eq!(resin()["exposures"], json!([[0.05, 2.4], [0.1, 3.5]]));
    // A thickness that was measured again has its new exposure; the others stay.
    assert!(
        cusp(&[
            "calibrate",
            "resin",
            "0.05=2.6",
            "0.03=1.9",
            "--resin",
            &path,
            "-o",
            &path
        ])
        .status
        .success()
    );
    assert_eq!(
        resin()["exposures"],
        json!([[0.03, 1.9], [0.05, 2.6], [0.1, 3.5]])
    );
    let output = cusp(&["calibrate", "resin", "0.05", "-o", &path]);
    assert_fails(&output, 2, "such as 0.05=2.4");
    // The file is a resin for every command.
    let grid = folder.path().join("grid.zip").to_str().unwrap().to_owned();
    let output = cusp(&["calibrate", "layers", "--resin", &path, "-o", &grid]);
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn a_printer_of_ones_own_comes_from_a_file() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.json").to_str().unwrap().to_owned();
    let out = folder
        .path()
        .join("towers.pm5s")
        .to_str()
        .unwrap()
        .to_owned();
    let printer = json!({
        "model": "Mine",
        "pixels": [1200, 800],
        "pitch_um": [50, 50],
        "volume_mm": [60, 40, 100],
        "format": "photon-workshop",
        "file_version": 518,
        "reads": ["pm5s"],
    });
    fs::write(&path, printer.to_string()).unwrap();
    let output = cusp(&["calibrate", "layers", "--printer", &path, "-o", &out]);
    assert!(output.status.success(), "{output:?}");
    assert!(
        fs::read(&out)
            .unwrap()
            .starts_with(b"ANYCUBIC\0\0\0\0\x06\x02\0\0")
    );
    for (wrong, words) in [
        (json!({ "pixels": [1200, 800] }), "pitch_um"),
        (
            json!({ "pixels": [0, 8], "pitch_um": [5, 5], "volume_mm": [1, 1, 1] }),
            "has an invalid pixels",
        ),
        (json!({ "pixles": [1, 8] }), "pixles"),
    ] {
        fs::write(&path, wrong.to_string()).unwrap();
        assert_fails(
            &cusp(&["calibrate", "layers", "--printer", &path, "-o", &out]),
            1,
            words,
        );
    }
}
