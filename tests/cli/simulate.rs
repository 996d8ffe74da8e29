//! `simulate`, and an interrupt of it.

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu};
use crate::common::{binary_stl, solids};

#[test]
fn a_print_file_is_measured_against_its_model() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(3.0, 4)));
    let print = folder.path().join("print.ctb").display().to_string();
    let options = [
        "--pitch",
        "0.04",
        "--format",
        "chitubox",
        "--metric",
        "deviation",
    ];
    let sliced = on_cpu(&[&["slice", &ball, "-o", &print, "--json"], &options[..]].concat());
    let report = json(&sliced);
    let simulation = json(&cusp(&["simulate", &ball, &print, "--json"]));
    assert_eq!(simulation["layers"], report["layers"]);
    assert_eq!(simulation["format"], "chitubox");
    let bound_mm = report["max_deviation_mm"].as_f64().unwrap()
        + simulation["half_pixel_diagonal_mm"].as_f64().unwrap();
    let greatest_mm = simulation["print_to_model"]["max_mm"].as_f64().unwrap();
    assert!(
        (0.01..=bound_mm).contains(&greatest_mm),
        "{greatest_mm} of {bound_mm}"
    );
    let layers = simulation["print_to_model"]["layers"].as_array().unwrap();
    assert_eq!(layers.len() as u64, report["layers"].as_u64().unwrap());

    let shown = cusp(&["simulate", &ball, &print]);
    let shown = String::from_utf8(shown.stdout).unwrap();
    let figure = format!("print to model  at most {greatest_mm:.4} mm");
    assert!(
        shown.contains(&figure) && shown.contains("model to print"),
        "{shown}"
    );

    // Scaled to another height than it was printed at, the model is elsewhere.
    let scaled = json(&cusp(&[
        "simulate", &ball, &print, "--height", "5", "--json",
    ]));
    assert!(scaled["print_to_model"]["max_mm"].as_f64().unwrap() > 0.4);
}

#[test]
fn files_that_cannot_be_measured_are_named() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(3.0, 3)));
    assert_fails(&cusp(&["simulate", &ball, &ball]), 1, "ball.stl");
    assert_fails(&cusp(&["simulate", &ball, "absent.zip"]), 1, "absent.zip");
    assert_fails(&cusp(&["simulate", "absent.stl", &ball]), 1, "absent.stl");
}
