//! `verify`, and what it must agree on with `plan` and `slice`.

use glam::Vec3;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{binary_stl, solids};
use crate::{assert_fails, cusp, json, model, on_cpu, sphere};

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
    assert_eq!(plain["weights_crc32"], Value::Null);

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
