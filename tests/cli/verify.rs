//! `verify`, and its agreement with `plan` and `slice`.

use glam::Vec3;
use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu, sphere, whole_json};
use crate::common::{binary_stl, solids};
use crate::read::package;

#[test]
fn verify_accepts_what_plan_and_slice_made_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let model = sphere(&folder);
    let options = [
        "--rotation",
        "0.1,0,-0.2,1",
        "--format",
        "chitubox",
        "--aa",
        "2",
    ];
    let plan = folder.path().join("plan.json").display().to_string();
    let print = folder.path().join("print.zip").display().to_string();
    let sliced = on_cpu(&[&["slice", &model, "-o", &print, "--json"], &options[..]].concat());
    std::fs::write(&plan, &sliced.stdout).unwrap();
    let output = cusp(&["verify", &plan, &model, "--print", &print, "--json"]);
    let verified = json(&output);
    assert_eq!(verified["layers"], json(&sliced)["layers"]);
    assert_eq!(verified["print_is_same"], true);
    assert!(cusp(&["verify", &plan, &model]).status.success());

    let mut bytes = std::fs::read(&print).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&print, bytes).unwrap();
    let output = cusp(&["verify", &plan, &model, "--print", &print]);
    assert_fails(&output, 1, "not the print file that this plan gives");

    let cheaper = String::from_utf8(sliced.stdout).unwrap();
    let cheaper = cheaper.replace("\"resin_ml\":", "\"resin_ml\":0.5e-9,\"was\":");
    std::fs::write(&plan, cheaper).unwrap();
    assert_fails(&cusp(&["verify", &plan, &model]), 1, "resin_ml is 5e-10");
    assert_fails(&cusp(&["verify", &model, &model]), 1, "UTF-8");
}

#[test]
fn every_command_that_plans_gives_the_same_warnings() {
    let folder = TempDir::new().unwrap();
    let mut floating = solids::cuboid(Vec3::new(6.0, 6.0, 1.0));
    let ball = solids::sphere(2.0, 3);
    floating.extend(solids::moved(&ball, Vec3::new(3.0, 3.0, 6.0)));
    let model = model(&folder, "floating.stl", &binary_stl(&floating));
    let plan = folder.path().join("plan.json").display().to_string();
    let print = folder.path().join("print.zip").display().to_string();

    let planned = on_cpu(&["plan", &model, "--pitch", "0.1", "--json"]);
    std::fs::write(&plan, &planned.stdout).unwrap();
    let warnings = json(&planned)["warnings"].clone();
    let black = &warnings[0];
    assert_eq!(black["code"], "black-layers");
    let layers = black["detail"]["layers"].as_u64().unwrap();
    assert!(layers > 10, "{black}");
    let sliced = on_cpu(&["slice", &model, "-o", &print, "--pitch", "0.1", "--json"]);
    assert_eq!(json(&sliced)["warnings"], warnings);
    let verified = cusp(&["verify", &plan, &model, "--print", &print, "--json"]);
    assert_eq!(json(&verified)["warnings"], warnings);
    let said = format!("cusp: warning: {layers} layers of the plan are black, from 1.");
    for output in [planned, sliced, verified] {
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(stderr.contains(&said), "{stderr}");
    }
}

#[test]
fn choices_of_reading_are_in_the_plan_and_verify_follows_them() {
    let folder = TempDir::new().unwrap();
    let mut bowl = solids::sphere(8.0, 3);
    bowl.retain(|corners| corners.iter().all(|corner| corner.z < 4.0));
    let surface = package::object(1, &bowl).replace("\"model\"", "\"surface\"");
    let text = package::model("", &surface, "<item objectid=\"1\"/>");
    let model = model(&folder, "bowl.3mf", &package::package(&text, &[]));
    let choices = ["--surfaces", "--curved-caps"];
    assert_fails(&cusp(&["info", &model]), 1, "no facets to print");
    let info = json(&cusp(&[&["info", &model, "--json"], &choices[..]].concat()));
    assert_eq!(info["holes"], 1);
    let plan = folder.path().join("plan.json").display().to_string();
    let planned = on_cpu(&[&["plan", &model, "--json"], &choices[..]].concat());
    std::fs::write(&plan, &planned.stdout).unwrap();
    let file = &json(&planned)["models"][0]["file"];
    assert_eq!(
        (&file["surfaces"], &file["curved_caps"]),
        (&true.into(), &true.into())
    );
    assert!(cusp(&["verify", &plan, &model]).status.success());
    let other = String::from_utf8(planned.stdout).unwrap();
    let other = other.replace("\"surfaces\":true,", "");
    std::fs::write(&plan, other).unwrap();
    assert_fails(&cusp(&["verify", &plan, &model]), 1, "no facets to print");
    let job = folder.path().join("job.json");
    let text = r#"{ "models": [{ "file": "bowl.3mf", "copies": 2, "surfaces": true, "curved_caps": true }] }"#;
    std::fs::write(&job, text).unwrap();
    let job = job.display().to_string();
    let planned = json(&on_cpu(&[
        "plan",
        &job,
        "--printer",
        "mars-4-ultra",
        "--json",
    ]));
    let file = &planned["models"][0]["file"];
    assert_eq!(
        (&file["surfaces"], &file["curved_caps"]),
        (&true.into(), &true.into())
    );
}

#[test]
fn weights_go_from_file_to_plan_and_back_through_verify() {
    let folder = TempDir::new().unwrap();
    let model = sphere(&folder);
    let weights = folder.path().join("ball.weights").display().to_string();
    assert!(cusp(&["saliency", &model, "-o", &weights]).status.success());
    let plain = json(&on_cpu(&["plan", &model, "--json"]));
    let weighted = on_cpu(&[
        "plan",
        &model,
        "--weights",
        &weights,
        "--weight-min",
        "0.5",
        "--json",
    ]);
    let salient = on_cpu(&[
        "plan",
        &model,
        "--saliency",
        "--weight-min",
        "0.5",
        "--json",
    ]);
    // The weights file gives the same plan as `--saliency`.
    assert_eq!(json(&weighted)["z_mm"], json(&salient)["z_mm"]);
    assert!(json(&weighted)["layers"].as_u64() < plain["layers"].as_u64());
    assert_eq!(plain["models"][0]["weights_crc32"], Value::Null);

    let plan = folder.path().join("plan.json").display().to_string();
    std::fs::write(&plan, &weighted.stdout).unwrap();
    assert!(
        cusp(&["verify", &plan, &model, "--weights", &weights])
            .status
            .success()
    );
    assert_fails(
        &cusp(&["verify", &plan, &model]),
        1,
        "other weights of facets",
    );
    let other = self::model(&folder, "cube.stl", &binary_stl(&solids::cube(2.0)));
    let refused = on_cpu(&["plan", &other, "--weights", &weights]);
    assert_fails(&refused, 1, "these weights are for another mesh");
    let refused = on_cpu(&["plan", &model, "--weights", &model]);
    assert_fails(&refused, 1, "no file of weights");
    let refused = on_cpu(&["plan", &model, "--weight-min", "2"]);
    assert_fails(&refused, 1, "from 0 to 1");
}

#[test]
fn the_plans_of_plates_are_verified_by_the_job_file_whole_and_one_by_one() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let ball = sphere(&folder);
    let weights = path("ball.weights");
    assert!(cusp(&["saliency", &ball, "-o", &weights]).status.success());
    let column = solids::cuboid(Vec3::new(3.0, 2.0, 5.0));
    model(&folder, "column.stl", &binary_stl(&column));
    let job = path("job.json");
    let written = r#"{
        "models": [
            { "file": "column.stl", "copies": 12, "tolerance": 0.05 },
            { "file": "ball.stl", "copies": 2, "height_mm": 4, "weights": "ball.weights" }
        ],
        "options": { "pixels": [200, 120], "pitch_mm": 0.1, "backend": "cpu", "format": "png" }
    }"#;
    std::fs::write(&job, written).unwrap();
    let (plan, print) = (path("plan.json"), path("print.zip"));
    let sliced = cusp(&["slice", &job, "-o", &print, "--json"]);
    std::fs::write(&plan, &sliced.stdout).unwrap();
    let whole = whole_json(&sliced);
    let count = whole["plates"].as_array().unwrap().len();
    assert_eq!(count, 2);
    let verified = whole_json(&cusp(&["verify", &plan, &job, "--json"]));
    assert_eq!(verified["resin_ml"], whole["resin_ml"]);
    assert_eq!(verified["plates"].as_array().unwrap().len(), count);

    // The manifest and the masks of each print file.
    for number in 1..=count {
        let print = path(&format!("print-{number}.zip"));
        let mut zip = zip::ZipArchive::new(std::fs::File::open(&print).unwrap()).unwrap();
        let manifest = path("manifest.json");
        let mut file = std::fs::File::create(&manifest).unwrap();
        std::io::copy(&mut zip.by_name("manifest.json").unwrap(), &mut file).unwrap();
        let output = cusp(&["verify", &manifest, &job, "--print", &print, "--json"]);
        assert_eq!(json(&output)["print_is_same"], true);
        let other = path(&format!("print-{}.zip", count + 1 - number));
        let output = cusp(&["verify", &manifest, &job, "--print", &other]);
        assert_fails(&output, 1, "not the print file that this plan gives");
    }

    // Models in their order do for the job file, except for weights; the first alone does not.
    let column = path("column.stl");
    assert_fails(
        &cusp(&["verify", &plan, &column, &ball]),
        1,
        "other weights",
    );
    assert_fails(&cusp(&["verify", &plan, &column]), 1, "give all models");

    // A lie anywhere is found.
    let refuses = |change: &dyn Fn(&mut Value), words: &str| {
        let mut lie = whole.clone();
        change(&mut lie);
        std::fs::write(&plan, lie.to_string()).unwrap();
        assert_fails(&cusp(&["verify", &plan, &job]), 1, words);
    };
    let first = |lie: &mut Value, key: &str, value: Value| lie["plates"][0][key] = value;
    refuses(&|lie| lie["resin_ml"] = 0.5.into(), "resin_ml is 0.5");
    refuses(
        &|lie| lie["plates"].as_array_mut().unwrap().truncate(1),
        "print_time_s is",
    );
    refuses(
        &|lie| lie["plates"] = Value::Array(Vec::new()),
        "it has no plates",
    );
    refuses(&|lie| first(lie, "plate", 1.into()), "plate is 1");
    refuses(
        &|lie| {
            let key = "print_time_s";
            lie["plates"][0]["models"][0][key] = 1.0.into();
        },
        "print_time_s is 1.0",
    );
    refuses(
        &|lie| lie["plates"][0]["models"][0]["options"]["tolerance"] = 0.5.into(),
        "it is not what the model and its options give",
    );
    refuses(
        &|lie| lie["plates"][0]["models"][0]["options"]["copies"] = 3.into(),
        "copies is 3",
    );
    refuses(
        &|lie| {
            let place = lie["plates"][0]["placements"][0].clone();
            lie["plates"][0]["placements"][1] = place;
        },
        "overlap on plate 1",
    );
    refuses(
        &|lie| lie["plates"][0]["models"][0]["model"] = 7.into(),
        "a model 8, and 2 are given",
    );
    // Another file in the place of a model.
    std::fs::write(&plan, whole.to_string()).unwrap();
    let other = binary_stl(&solids::cube(2.0));
    std::fs::write(path("column.stl"), other).unwrap();
    assert_fails(&cusp(&["verify", &plan, &job]), 1, "another model");
}

#[test]
fn a_model_alone_on_each_of_several_plates_keeps_options_of_its_own() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let wide = solids::cuboid(Vec3::new(16.0, 9.0, 3.0));
    model(&folder, "wide.stl", &binary_stl(&wide));
    let (job, plan) = (path("job.json"), path("plan.json"));
    let written = r#"{
        "models": [{ "file": "wide.stl", "copies": 2, "tolerance": 0.03, "height_mm": 4 }],
        "options": { "pixels": [240, 140], "pitch_mm": 0.1, "backend": "cpu" }
    }"#;
    std::fs::write(&job, written).unwrap();
    let planned = cusp(&["plan", &job, "--json"]);
    let whole = whole_json(&planned);
    for plate in 0..2 {
        let placements = whole["plates"][plate]["placements"].as_array().unwrap();
        assert_eq!(placements.len(), 1);
        assert_eq!(placements[0]["x_mm"].as_f64().unwrap_or(0.0), 0.0);
        assert_eq!(
            whole["plates"][plate]["models"][0]["options"]["tolerance"],
            0.03
        );
    }
    std::fs::write(&plan, &planned.stdout).unwrap();
    let verified = cusp(&["verify", &plan, &job, "--json"]);
    assert!(
        verified.status.success(),
        "{}",
        String::from_utf8_lossy(&verified.stderr)
    );
    // One plate's plan states that it is one of several, by a valid number.
    let mut second = whole["plates"][1].clone();
    second["schema"] = whole["schema"].clone();
    std::fs::write(&plan, second.to_string()).unwrap();
    assert!(cusp(&["verify", &plan, &job]).status.success());
    second["plate"] = 2.into();
    std::fs::write(&plan, second.to_string()).unwrap();
    assert_fails(
        &cusp(&["verify", &plan, &job]),
        1,
        "plate does not match the rest",
    );
}
