//! Several models on plates.

use std::process::Output;

use cusp_slicer::job::LoadedModel;
use cusp_slicer::model::weights;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{assert_fails, cusp, model, names, slab, sphere, whole_json as parsed};
use crate::common::{assert_near, binary_stl, solids};

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

#[test]
fn a_project_holds_models_weights_and_options_and_gives_the_print_files_of_the_job_file() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let loaded = LoadedModel::read(&std::fs::read(&ball).unwrap()).unwrap();
    let corners = loaded.positions();
    let weights: Vec<f32> = (0..corners.len() / 9)
        .map(|facet| if facet % 2 == 0 { 1.0 } else { 0.25 })
        .collect();
    let painted = path_in(&folder, "ball.weights");
    std::fs::write(&painted, weights::to_bytes(&weights, &corners)).unwrap();
    let job = json!({
        "models": [
            {"file": &ball, "copies": 2, "weights": &painted, "height_mm": 7.0, "rotation": [0.5, 0.0, 0.0, 0.9]},
            {"file": &slab, "supports": {"strength": "light"}},
        ],
        "options": {"pixels": [400, 300], "pitch_mm": 0.1, "backend": "cpu", "format": "goo"},
        "arranging": {"spacing_mm": 1.5},
    });
    let (by_hand, arranged) = (path_in(&folder, "hand.json"), path_in(&folder, "job.json"));
    std::fs::write(&by_hand, job.to_string()).unwrap();
    let project = path_in(&folder, "plate.3mf");
    for output in [&arranged, &project] {
        assert!(cusp(&["plate", &by_hand, "-o", output]).status.success());
    }
    let sliced = |input: &str, name: &str| {
        let print = path_in(&folder, name);
        let output = cusp(&["slice", input, "--allow-floating", "-o", &print]);
        assert!(output.status.success(), "{output:?}");
        std::fs::read(print).unwrap()
    };
    let expected = sliced(&arranged, "job.goo");
    for file in [&ball, &slab, &painted] {
        std::fs::remove_file(file).unwrap();
    }
    assert!(sliced(&project, "project.goo") == expected);

    // Arranged again, it is another project. Its models have no files that a job file could name.
    let again = path_in(&folder, "again.3mf");
    assert!(cusp(&["plate", &project, "-o", &again]).status.success());
    assert!(sliced(&again, "again.goo") == expected);
    let output = cusp(&["plate", &project, "-o", &path_in(&folder, "no.json")]);
    assert_fails(&output, 1, "write another project, -o NAME.3mf");

    // Read as a model, each copy is an object that stands where the report says.
    let plates = parsed(&cusp(&["plan", &project, "--json"]));
    let places = plates["plates"][0]["placements"].as_array().unwrap();
    let bytes = std::fs::read(&project).unwrap();
    let bodies = boxes(&LoadedModel::read(&bytes).unwrap().positions());
    assert_eq!(bodies.len(), 3);
    let mut middles: Vec<_> = bodies
        .iter()
        .map(|[low, high]| [0, 1].map(|axis| f64::midpoint(low[axis], high[axis])))
        .collect();
    let mut stated: Vec<_> = places
        .iter()
        .map(|place| ["x_mm", "y_mm"].map(|axis| place[axis].as_f64().unwrap() + 100.0))
        .collect();
    for list in [&mut middles, &mut stated] {
        list.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    for (middle, stated) in middles.iter().zip(&stated) {
        assert_near(middle[0], stated[0], 0.11);
        assert_near(middle[1], stated[1], 0.11);
    }
    let of_balls = bodies.iter().filter(|[low, high]| {
        assert_near(low[2], 0.0, 1e-4);
        (high[2] - 7.0).abs() < 1e-4
    });
    assert_eq!(of_balls.count(), 2);
}

/// The first facet of a body, by a path of facets.
fn root(body: &mut [usize], mut it: usize) -> usize {
    while body[it] != it {
        body[it] = body[body[it]];
        it = body[it];
    }
    it
}

/// The boxes around bodies whose facets share corners.
fn boxes(positions: &[f32]) -> Vec<[[f64; 3]; 2]> {
    let facets: Vec<&[f32]> = positions.chunks_exact(9).collect();
    let mut body: Vec<usize> = (0..facets.len()).collect();
    let mut owner = std::collections::HashMap::new();
    for (place, facet) in facets.iter().enumerate() {
        for corner in facet.chunks_exact(3) {
            let key = [corner[0], corner[1], corner[2]].map(f32::to_bits);
            let other = *owner.entry(key).or_insert(place);
            let (a, b) = (root(&mut body, place), root(&mut body, other));
            body[a] = b;
        }
    }
    let mut found = std::collections::BTreeMap::new();
    for (place, facet) in facets.iter().enumerate() {
        let it = found
            .entry(root(&mut body, place))
            .or_insert([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
        for corner in facet.chunks_exact(3) {
            for axis in 0..3 {
                it[0][axis] = it[0][axis].min(f64::from(corner[axis]));
                it[1][axis] = it[1][axis].max(f64::from(corner[axis]));
            }
        }
    }
    found.into_values().collect()
}

#[test]
fn a_damaged_project_is_refused_by_the_part_that_is_wrong() {
    let folder = TempDir::new().unwrap();
    let (ball, project) = (sphere(&folder), path_in(&folder, "plate.3mf"));
    assert!(small(&["plate", &ball, "-o", &project]).status.success());
    let mut whole = zip::ZipArchive::new(std::fs::File::open(&project).unwrap()).unwrap();
    let names = whole.file_names().map(|name| name.unwrap().into_owned());
    let names: Vec<String> = names.collect();
    let mut with = |name: &str, replaced: Option<&str>| {
        let path = path_in(&folder, "damaged.3mf");
        let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
        for own in &names {
            let mut bytes = Vec::new();
            std::io::copy(&mut whole.by_name(own).unwrap(), &mut bytes).unwrap();
            let bytes = match replaced {
                _ if own != name => bytes,
                Some(text) => text.into(),
                None => continue,
            };
            let options = zip::write::SimpleFileOptions::default();
            zip.start_file(&**own, options).unwrap();
            std::io::Write::write_all(&mut zip, &bytes).unwrap();
        }
        zip.finish().unwrap();
        small(&["plan", &path])
    };
    let part = "Metadata/cusp/project.json";
    assert_fails(&with(part, Some("{")), 1, part);
    assert_fails(
        &with("Metadata/cusp/model-1.bin", None),
        1,
        "Metadata/cusp/model-1.bin",
    );
    // Without our part it is a model.
    assert!(with(part, None).status.success());
}
