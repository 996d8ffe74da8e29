//! `plan`, `tradeoff` and `compare`.

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu, slab, sphere, whole_json};
use crate::common::assert_near;

#[test]
fn plan_prints_one_json_object_with_every_key() {
    let folder = TempDir::new().unwrap();
    let report = json(&on_cpu(&["plan", &sphere(&folder), "--json"]));
    for key in [
        "layers",
        "height_mm",
        "z_mm",
        "thickness_mm",
        "tolerance",
        "max_error",
        "max_error_mm",
        "unit",
        "metric",
        "source",
        "planner",
        "print_time_s",
        "exposure_s",
        "resin_ml",
        "printer",
        "snapped_mm",
        "uniform",
        "backend",
        "adapter",
        "gpu_method",
        "bins",
        "bin_mm",
        "models",
        "placements",
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
fn every_metric_and_planner_can_be_asked_for() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let plan = |more: &[&str]| {
        let fixed = [
            "plan", &ball, "--json", "--pixels", "200x200", "--pitch", "0.04",
        ];
        json(&on_cpu(&[&fixed[..], more].concat()))
    };
    for (metric, unit) in [
        ("cusp", "mm"),
        ("roughness", "mm"),
        ("area", ""),
        ("volume", "mm³"),
    ] {
        for source in ["exact", "sampled"] {
            let report = plan(&["--metric", metric, "--source", source]);
            assert_eq!(
                (&report["metric"], &report["unit"]),
                (&metric.into(), &unit.into())
            );
            let error = if source == "exact" {
                "max_error"
            } else {
                "sampled_error"
            };
            let [error, tolerance] = [error, "tolerance"].map(|key| report[key].as_f64().unwrap());
            assert!(
                error <= tolerance * (1.0 + 1e-6),
                "{metric}, {source}: {error} {tolerance}"
            );
        }
    }
    for planner in ["optimal", "greedy", "local"] {
        assert_eq!(plan(&["--planner", planner])["planner"], planner);
    }
    for (layer, layers) in [("finest", 120), ("coarsest", 40), ("0.1", 60)] {
        let report = plan(&["--planner", "uniform", "--layer", layer]);
        assert_eq!(report["layers"], layers, "{layer}");
    }
    let slow = br#"{"exposure_s": 20, "penetration_mm": 0.05, "wait_s": 1, "lift_mm": 0}"#;
    let slow = model(&folder, "slow.json", slow);
    let fast_growing = ["--resin", slow.as_str()];
    let quick = plan(&[&fast_growing[..], &["--minimize", "time"]].concat());
    let few = plan(&fast_growing);
    assert!(quick["layers"].as_u64() > few["layers"].as_u64());
    assert!(quick["print_time_s"].as_f64() < few["print_time_s"].as_f64());
}

#[test]
fn planes_ranges_and_steps_are_kept() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let constraints = "--range 0:1=0.1:0.1 --plane 2.34 --step 0.02 --tolerance 0.11";
    let mut arguments = vec!["plan", &ball, "--json"];
    arguments.extend(constraints.split(' '));
    let report = json(&on_cpu(&arguments));
    let z_mm: Vec<f64> = report["z_mm"]
        .as_array()
        .unwrap()
        .iter()
        .map(|z| z.as_f64().unwrap())
        .collect();
    assert_eq!(
        z_mm[..11],
        [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    );
    assert!(z_mm.contains(&2.34));
    assert!(
        z_mm.iter()
            .all(|z| ((z / 0.02).round() * 0.02 - z).abs() < 1e-9)
    );
}

#[test]
fn uniform_takes_a_layer_thickness() {
    let folder = TempDir::new().unwrap();
    let model = sphere(&folder);
    let report = json(&on_cpu(&[
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
    assert_fails(
        &cusp(&["plan", &model, "--layer", "0.1"]),
        2,
        "--planner uniform",
    );
    assert_fails(
        &cusp(&[
            "slice",
            &model,
            "-o",
            "x.zip",
            "--planner",
            "optimal",
            "--layer",
            "0.1",
        ]),
        2,
        "Usage: cusp slice",
    );
}

#[test]
fn the_trade_off_and_the_comparison_are_shown_and_agree_with_plans() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let curve = json(&on_cpu(&["tradeoff", &ball, "--json", "--points", "20"]));
    let points = curve["points"].as_array().unwrap();
    assert_eq!(points.len(), 20);
    let text = |value: &serde_json::Value| value.to_string();
    let same = json(&on_cpu(&[
        "plan",
        &ball,
        "--json",
        "--max-layers",
        &text(&points[7]["layers"]),
    ]));
    assert_eq!(same["layers"], points[7]["layers"]);
    assert!(same["tolerance"].as_f64() <= points[7]["tolerance"].as_f64());
    let soon = json(&on_cpu(&["plan", &ball, "--json", "--max-time", "900"]));
    assert!(soon["print_time_s"].as_f64().unwrap() <= 900.0);
    assert_fails(
        &on_cpu(&["plan", &ball, "--max-layers", "39"]),
        1,
        "it takes at least 40",
    );

    let comparison = json(&on_cpu(&["compare", &ball, "--json"]));
    let rows = comparison["rows"].as_array().unwrap();
    let planners: Vec<&str> = rows
        .iter()
        .map(|row| row["planner"].as_str().unwrap())
        .collect();
    assert_eq!(
        planners,
        ["coarsest", "optimal", "greedy", "local", "finest"]
    );
    let plan = json(&on_cpu(&["plan", &ball, "--json"]));
    assert_eq!(rows[1]["layers"], plan["layers"]);
    assert_eq!(rows[0], plan["uniform"]["coarsest"]);
    for command in ["tradeoff", "compare"] {
        let output = on_cpu(&[command, &ball]);
        let shown = String::from_utf8(output.stdout).unwrap();
        assert!(
            shown.contains(" min") && shown.contains("largest error"),
            "{shown}"
        );
    }
}

#[test]
fn plates_have_a_curve_and_a_comparison_each() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    // The slab has a plate of its own: two high ones fit side by side.
    let plate = ["--pixels", "160x110", "--pitch", "0.1", "--json"];
    let run = |rest: &[&str]| whole_json(&on_cpu(&[rest, &plate[..]].concat()));
    let balls = format!("{ball}:2");
    let plans = run(&["plan", "--arrange", &balls, &slab]);
    let planned = plans["plates"].as_array().unwrap();
    assert_eq!(planned.len(), 2);
    let compared = run(&["compare", &balls, &slab]);
    let curves = run(&["tradeoff", &balls, &slab, "--points", "5"]);
    for (number, plan) in planned.iter().enumerate() {
        let optimal = &compared["plates"][number]["rows"][1];
        assert_eq!(optimal["layers"], plan["layers"]);
        let points = curves["plates"][number]["points"].as_array().unwrap();
        let finest = points.iter().map(|point| point["layers"].as_u64()).max();
        let tolerance = plan["tolerance"].as_f64();
        let within = points
            .iter()
            .filter(|it| it["tolerance"].as_f64() <= tolerance);
        let fewest = within.map(|point| point["layers"].as_u64()).min();
        assert!(finest >= Some(plan["layers"].as_u64()), "{curves}");
        assert!(fewest >= Some(plan["layers"].as_u64()), "{curves}");
    }
    assert_ne!(curves["plates"][0], curves["plates"][1]);
    let output = on_cpu(&[
        "compare", &balls, &slab, "--pixels", "160x110", "--pitch", "0.1",
    ]);
    let shown = String::from_utf8(output.stdout).unwrap();
    assert!(shown.contains("plate 2 of 2"), "{shown}");
    // A message names the model by its file.
    let output = on_cpu(&[
        "compare", &ball, &slab, "--pixels", "50x50", "--pitch", "0.1",
    ]);
    assert_fails(&output, 1, "ball.stl is 6.000 × 6.000 mm");
    assert!(!String::from_utf8_lossy(&output.stderr).contains("plate: "));
}

#[test]
fn a_supported_model_is_lifted_and_written_for_other_programs() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let plan = |options: &[&str]| {
        let usual: &[&str] = &["plan", &ball, "--pitch", "0.05", "--json"];
        json(&on_cpu(&[usual, options].concat()))
    };
    let bare = plan(&[]);
    let supported = plan(&["--supports", "light", "--lift", "4"]);
    let height_mm = |report: &serde_json::Value| report["height_mm"].as_f64().unwrap();
    assert_near(height_mm(&supported) - height_mm(&bare), 4.0, 1e-9);
    let points = supported["models"][0]["supported"]["points"].clone();
    assert!(!points.as_array().unwrap().is_empty());

    // The points of the report in a file give the same print.
    let supports = serde_json::json!({ "strength": "light", "points": points });
    let file = folder.path().join("supports.json");
    std::fs::write(&file, supports.to_string()).unwrap();
    let file = file.to_str().unwrap();
    let again = plan(&["--supports", file, "--lift", "4"]);
    assert_eq!(again["resin_ml"], supported["resin_ml"]);
    assert_eq!(again["z_mm"], supported["z_mm"]);

    // The exported model has the resin of the print.
    for name in ["held.stl", "held.3mf"] {
        let held = folder.path().join(name);
        let held = held.to_str().unwrap();
        plan(&["--supports", "light", "--lift", "4", "--export", held]);
        let other = json(&on_cpu(&["plan", held, "--pitch", "0.05", "--json"]));
        let ml = |report: &serde_json::Value| report["resin_ml"].as_f64().unwrap();
        assert_near(ml(&other), ml(&supported), 1e-3 * ml(&supported));
        assert_near(height_mm(&other), height_mm(&supported), 1e-5);
    }
    assert_fails(
        &cusp(&["plan", &ball, "--lift", "4"]),
        1,
        "--lift, --raft and --support-size are for supported models: add --supports",
    );
    // Sizes by name, a raft, and thick layers below the model.
    let sized = plan(&[
        "--supports",
        "light",
        "--raft",
        "--support-size",
        "spacing_mm=2",
        "--support-size",
        "lift_mm=6",
        "--support-layer",
        "0.2",
    ]);
    let profile = &sized["options"]["supports"]["profile"];
    assert_eq!(profile["spacing_mm"], 2.0);
    assert_eq!(profile["raft"], true);
    assert_eq!(profile["contact_mm"], 0.3);
    assert_near(height_mm(&sized) - height_mm(&bare), 6.0, 1e-9);
    assert_eq!(sized["thickness_mm"][0], 0.2);
    for (size, message) in [
        ("spacing=2", "did you mean `spacing_mm`"),
        ("spacing_mm", "give a name and a number"),
        ("spacing_mm=0.1", "spacing_mm"),
    ] {
        let output = cusp(&["plan", &ball, "--supports", "auto", "--support-size", size]);
        assert!(!output.status.success());
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(text.contains(message), "{text}");
    }
    let obj = folder.path().join("held.obj");
    assert_fails(
        &cusp(&["plan", &ball, "--export", obj.to_str().unwrap()]),
        2,
        "expected a name that ends in .stl or .3mf",
    );
}

#[test]
fn a_piece_that_floats_is_refused_by_slice() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    // No point of it is held.
    let file = folder.path().join("none.json");
    std::fs::write(&file, r#"{ "points": [] }"#).unwrap();
    let output = folder.path().join("ball.zip");
    let slice = |further: &[&str]| {
        let paths = [&file, &output].map(|path| path.to_str().unwrap());
        let usual = [
            "slice",
            &ball,
            "--pitch",
            "0.05",
            "--supports",
            paths[0],
            "-o",
            paths[1],
        ];
        on_cpu(&[&usual, further].concat())
    };
    assert_fails(&slice(&[]), 1, "a piece begins with nothing below");
    assert!(!output.exists());
    assert!(slice(&["--allow-floating"]).status.success());
    assert!(output.exists());
}
