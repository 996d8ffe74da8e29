//! `simulate`, and an interrupt of it.

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu};
use crate::common::{assert_near, binary_stl, solids};

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

#[test]
fn every_copy_on_a_plate_is_measured_where_the_file_or_a_job_says_that_it_stands() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let plate = model(
        &folder,
        "plate.stl",
        &binary_stl(&solids::cuboid(glam::Vec3::new(6.0, 3.0, 1.0))),
    );
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(1.5, 4)));
    let job = path("job.json");
    let arranged = cusp(&[
        "plate", &plate, &ball, "--copies", "2", "--pixels", "400x300", "--pitch", "0.05", "-o",
        &job,
    ]);
    assert!(arranged.status.success());
    let mut file: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&job).unwrap()).unwrap();
    // Blocks turned by 30° at the left, balls at the right: off the middle, so that a mirrored plate is noticed.
    let turned = |model: usize, x_mm: f64, y_mm: f64, turn_deg: u32| serde_json::json!({ "model": model, "x_mm": x_mm, "y_mm": y_mm, "turn_deg": turn_deg });
    file["placements"] = serde_json::json!([
        turned(0, -5.0, 4.0, 30),
        turned(0, -4.0, -3.0, 30),
        turned(1, 6.0, 4.0, 0),
        turned(1, 6.0, -4.0, 0),
    ]);
    std::fs::write(&job, file.to_string()).unwrap();

    let print = path("print.zip");
    let report = json(&on_cpu(&["slice", &job, "-o", &print, "--json"]));
    let found = json(&cusp(&["simulate", &plate, &ball, &print, "--json"]));
    assert_eq!(
        (&found["copies"], &found["placement"]),
        (&4.into(), &"stated".into())
    );
    let max_mm = |found: &serde_json::Value, side: &str| found[side]["max_mm"].as_f64().unwrap();
    let diagonal_mm = found["half_pixel_diagonal_mm"].as_f64().unwrap();
    let bound_mm = report["max_deviation_mm"].as_f64().unwrap() + diagonal_mm;
    assert!(max_mm(&found, "print_to_model") <= bound_mm, "{found}");
    assert!(
        max_mm(&found, "model_to_print") <= 2.0 * bound_mm,
        "{found}"
    );
    assert_eq!(json(&cusp(&["simulate", &job, &print, "--json"])), found);

    // The model that cannot stand is named, and not the first one.
    let flat = [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y];
    let flat = model(&folder, "flat.stl", &binary_stl(&[flat]));
    let output = cusp(&["simulate", &plate, &flat, &print]);
    assert_fails(&output, 1, "flat.stl: the model has no height");

    // A project is a job whose models are inside.
    let project = path("plate.3mf");
    assert!(
        cusp(&["plate", &job, "-o", &project]).status.success(),
        "{project}"
    );
    let of_project = path("project.zip");
    json(&on_cpu(&["slice", &project, "-o", &of_project, "--json"]));
    let simulated = |models: &[&str]| {
        json(&cusp(
            &[&["simulate"], models, &[&of_project, "--json"]].concat(),
        ))
    };
    assert_eq!(simulated(&[&project]), simulated(&[&plate, &ball]));

    // This format does not state copies.
    let other = path("print.ctb.zip");
    let format = ["--format", "chitubox", "-o", &other, "--json"];
    json(&on_cpu(&[&["slice", &job], &format[..]].concat()));
    let same = json(&cusp(&["simulate", &job, &other, "--json"]));
    for side in ["print_to_model", "model_to_print"] {
        assert_near(max_mm(&same, side), max_mm(&found, side), 1e-5);
    }
    assert_fails(
        &cusp(&["simulate", &plate, &ball, &other]),
        1,
        "give a job file with places",
    );
    assert_fails(
        &cusp(&["simulate", &plate, &print]),
        1,
        "it prints a model 2, and 1 is given",
    );

    // A copy that is elsewhere is found there, whatever its neighbours are.
    file["placements"][3]["x_mm"] = 6.4.into();
    std::fs::write(&job, file.to_string()).unwrap();
    let moved = json(&cusp(&["simulate", &job, &other, "--json"]));
    for side in ["print_to_model", "model_to_print"] {
        assert_near(max_mm(&moved, side), 0.4, bound_mm);
        let at_mm = &moved[side]["at_mm"];
        assert!(
            at_mm[0].as_f64() > Some(4.0) && at_mm[1].as_f64() < Some(-2.0),
            "{side}: {at_mm}"
        );
    }
}
