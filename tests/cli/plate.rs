//! Several models on plates.

use std::process::Output;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{assert_fails, cusp, model, names, slab, sphere, whole_json as parsed};
use crate::common::{binary_stl, solids};

/// A plate of 40 × 30 mm.
const SMALL: [&str; 6] = ["--pixels", "400x300", "--pitch", "0.1", "--backend", "cpu"];

fn small(arguments: &[&str]) -> Output {
    cusp(&[arguments, &SMALL].concat())
}

fn path_in(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

#[test]
fn models_and_copies_are_sliced_into_one_print_file() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let print = path_in(&folder, "plate.zip");
    let three = format!("{ball}:3");
    let report = parsed(&small(&[
        "slice",
        &three,
        &slab,
        "--arrange",
        "-o",
        &print,
        "--json",
    ]));
    let plates = report["plates"].as_array().unwrap();
    assert_eq!(plates.len(), 1);
    let models = &plates[0]["models"];
    assert_eq!(models[0]["copies"], 3);
    assert_eq!(models[1]["copies"], 1);
    let inspected = parsed(&cusp(&["inspect", &print, "--json"]));
    assert_eq!(inspected["layers"], plates[0]["layers"]);
    // The zip says what stands where.
    let file = std::fs::File::open(&print).unwrap();
    let mut zip = zip::ZipArchive::new(file).unwrap();
    let manifest: Value = serde_json::from_reader(zip.by_name("manifest.json").unwrap()).unwrap();
    assert_eq!(manifest["placements"], plates[0]["placements"]);
}

#[test]
fn one_copy_arranged_is_reported_as_several_are_and_printed_as_alone() {
    let folder = TempDir::new().unwrap();
    let slab = slab(&folder);
    // This format has no manifest, which would name the plate.
    let (alone, arranged) = (
        path_in(&folder, "alone.goo"),
        path_in(&folder, "arranged.goo"),
    );
    let sliced = |rest: &[&str]| {
        let output = small(&[&["slice", &slab, "--format", "goo"], rest].concat());
        assert!(output.status.success());
        output
    };
    sliced(&["-o", &alone]);
    let one = parsed(&sliced(&["--arrange", "--json", "-o", &arranged]));
    assert!(std::fs::read(alone).unwrap() == std::fs::read(arranged).unwrap());
    let two = parsed(&sliced(&[
        "--arrange",
        "--copies",
        "2",
        "--json",
        "-o",
        &path_in(&folder, "two.goo"),
    ]));
    let keys = |report: &Value| {
        let plate = report["plates"][0].as_object().unwrap();
        plate.keys().cloned().collect::<Vec<_>>()
    };
    assert_eq!(keys(&one), keys(&two));
    assert_eq!(one["plates"][0]["models"][0]["copies"], 1);
}

#[test]
fn a_job_file_holds_models_options_and_places() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let job = path_in(&folder, "plate.json");
    let output = small(&[
        "plate",
        &ball,
        "--copies",
        "5",
        "--spacing",
        "1",
        "-o",
        &job,
    ]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("plate 1 of 1: 5 × "));
    let mut written: Value = serde_json::from_slice(&std::fs::read(&job).unwrap()).unwrap();
    assert_eq!(written["placements"].as_array().unwrap().len(), 5);
    assert_eq!(written["options"]["pixels"], json!([400, 300]));
    // Without options on the command line: they are in the file.
    let report = parsed(&cusp(&["plan", &job, "--json"]));
    assert_eq!(report["plates"][0]["placements"], written["placements"]);
    // Places can be edited by hand, models have tolerances of their own, and paths are relative to the file.
    written["placements"].as_array_mut().unwrap().truncate(2);
    written["models"][0]["copies"] = 2.into();
    written["models"][0]["file"] = "ball.stl".into();
    written["models"][0]["tolerance"] = 0.055.into();
    std::fs::write(&job, written.to_string()).unwrap();
    let report = parsed(&cusp(&["plan", &job, "--json"]));
    let model = &report["plates"][0]["models"][0];
    assert_eq!(model["copies"], 2);
    assert!(model["max_error"].as_f64().unwrap() <= 0.055 + 1e-9);
    // The command line goes before the file, and --arrange places copies again.
    let report = parsed(&cusp(&[
        "plan",
        &job,
        "--arrange",
        "--layer-max",
        "0.1",
        "--json",
    ]));
    assert_eq!(report["plates"][0]["models"][0]["copies"], 2);
    assert_eq!(report["plates"][0]["options"]["layer_max_mm"], 0.1);
}

#[test]
fn several_plates_are_numbered_print_files() {
    let folder = TempDir::new().unwrap();
    let square = solids::cuboid(glam::Vec3::new(18.0, 13.0, 1.0));
    let square = model(&folder, "square.stl", &binary_stl(&square));
    let print = path_in(&folder, "job.zip");
    let five = format!("{square}:5");
    assert!(
        small(&["slice", &five, "--arrange", "-o", &print])
            .status
            .success()
    );
    assert_eq!(names(&folder), ["job-1.zip", "job-2.zip", "square.stl"]);
    let prints = path_in(&folder, "prints");
    std::fs::create_dir(&prints).unwrap();
    assert!(
        small(&["slice", &five, "--arrange", "-o", &prints])
            .status
            .success()
    );
    let again = std::fs::read(folder.path().join("prints/plate-2.zip")).unwrap();
    assert!(again == std::fs::read(folder.path().join("job-2.zip")).unwrap());
    let piped = small(&["slice", &five, "--arrange", "-o", "-"]);
    assert_fails(&piped, 1, "2 plates");
}

#[test]
fn a_mesh_is_exported_as_it_stands_before_turns_and_of_one_model_alone() {
    let folder = TempDir::new().unwrap();
    let bar = solids::cuboid(glam::Vec3::new(20.0, 4.0, 2.0));
    let bar = model(&folder, "bar.stl", &binary_stl(&bar));
    let (job, mesh) = (path_in(&folder, "job.json"), path_in(&folder, "mesh.stl"));
    let turned = r#"{ "models": [{ "file": "bar.stl" }], "placements": [{ "model": 0, "x_mm": 0, "y_mm": 0, "turn_deg": 90 }] }"#;
    std::fs::write(&job, turned).unwrap();
    let planned = small(&["plan", &job, "--export", &mesh]);
    assert!(
        planned.status.success(),
        "{}",
        String::from_utf8_lossy(&planned.stderr)
    );
    let info = parsed(&cusp(&["info", &mesh, "--json"]));
    let size: Vec<f64> = serde_json::from_value(info["size_mm"].clone()).unwrap();
    assert!(
        (size[0] - 20.0).abs() < 1e-3 && (size[1] - 4.0).abs() < 1e-3,
        "{size:?}"
    );
    let several = r#"{ "models": [{ "file": "bar.stl" }, { "file": "bar.stl" }] }"#;
    std::fs::write(&job, several).unwrap();
    assert_fails(
        &small(&["plan", &job, "--export", &mesh]),
        2,
        "of one model",
    );
    assert_fails(
        &small(&["plan", &bar, &bar, "--export", &mesh]),
        2,
        "of one model",
    );
}

#[test]
fn what_cannot_be_a_plate_is_said() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let print = path_in(&folder, "plate.zip");
    let refused = cusp(&[
        "slice",
        &ball,
        "--arrange",
        "-o",
        &print,
        "--backend",
        "cpu",
    ]);
    assert_fails(&refused, 1, "choose a printer");
    assert_fails(&small(&["plan", &ball, "--copies", "3"]), 2, "--arrange");
    assert_fails(
        &small(&["plan", &ball, "--arrange", "--turn", "7"]),
        1,
        "7°",
    );
    let high = small(&["plan", &ball, "--arrange", "--height", "60"]);
    assert_fails(&high, 1, "60.000");
    let both = small(&["slice", &ball, &ball, "-o", &print]);
    assert_fails(&both, 2, "--arrange");
    let weights = path_in(&folder, "ball.weights");
    assert!(cusp(&["saliency", &ball, "-o", &weights]).status.success());
    assert_fails(
        &small(&["plan", &ball, &ball, "--arrange", "--weights", &weights]),
        2,
        "job file",
    );
    let job = path_in(&folder, "job.json");
    for (text, words) in [
        ("{\"models\": [{\"file\": \"none.stl\"}]}", "none.stl"),
        ("{\"models\": [{\"fiel\": \"ball.stl\"}]}", "fiel"),
        ("{\"models\": []}", "no model"),
        (
            r#"{"models": [{"file": "ball.stl"}, {"file": "ball.stl"}], "placements": [{"model": 0, "x_mm": 0, "y_mm": 0}, {"model": 1, "x_mm": 9, "y_mm": 0}, {"model": 11, "x_mm": 9, "y_mm": 9}]}"#,
            "no model 12",
        ),
    ] {
        std::fs::write(&job, text).unwrap();
        assert_fails(&small(&["plan", &job]), 1, words);
    }
    assert!(!std::path::Path::new(&print).exists());
}

#[test]
fn weights_of_a_job_file_belong_to_their_model() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let weights = path_in(&folder, "ball.weights");
    assert!(cusp(&["saliency", &ball, "-o", &weights]).status.success());
    let job = path_in(&folder, "job.json");
    let models =
        json!([{ "file": ball, "weights": "ball.weights" }, { "file": slab, "copies": 2 }]);
    std::fs::write(&job, json!({ "models": models }).to_string()).unwrap();
    let report = parsed(&small(&["plan", &job, "--json"]));
    let models = &report["plates"][0]["models"];
    assert!(models[0]["weights_crc32"].is_number());
    assert!(models[1]["weights_crc32"].is_null());
    // Arranging the job again keeps them.
    let again = path_in(&folder, "again.json");
    assert!(small(&["plate", &job, "-o", &again]).status.success());
    let again = parsed(&cusp(&["plan", &again, "--json"]));
    assert_eq!(again["plates"][0]["models"], *models);
}
