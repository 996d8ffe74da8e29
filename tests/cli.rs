//! The command line as its users meet it: exit codes, one sentence of error, JSON, whole files.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::path::PathBuf;
use std::process::{Command, Output};

use common::{assert_near, binary_stl, solids};
use glam::Vec3;
use serde_json::Value;
use tempfile::TempDir;

fn cusp(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Without a GPU, so that every machine does the same.
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
    for word in ["slice", "plan", "info", "130 interrupted"] {
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
        "--max-layers",
        "--max-time",
        "--bin",
        "--metric",
        "--source",
        "--planner",
        "--minimize",
        "--layer",
        "--range",
        "--plane",
        "--step",
        "--snap",
        "--printer",
        "--format",
        "--resin",
        "--mirror",
        "--backend",
    ] {
        assert!(text.contains(option), "{option}");
    }
}

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
        "sampled_error",
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

/// Mesa complains about a display that nobody asked for, wherever there is none.
#[test]
fn nothing_but_our_own_words_is_on_stderr() {
    let folder = TempDir::new().unwrap();
    let closed = sphere(&folder);
    let mut open = solids::cube(3.0);
    open.pop();
    let open = model(&folder, "open.stl", &binary_stl(&open));
    let plan = folder.path().join("plan.json").display().to_string();
    std::fs::write(&plan, on_cpu(&["plan", &closed, "--json"]).stdout).unwrap();
    let without_display = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cusp"));
        for name in ["XDG_RUNTIME_DIR", "DISPLAY", "WAYLAND_DISPLAY"] {
            command.env_remove(name);
        }
        let output = command.args(arguments).output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let quiet = (Some(0), String::new());
    assert_eq!(without_display(&["verify", &plan, &closed]), quiet);
    for backend in ["auto", "gpu", "cpu"] {
        for command in ["plan", "tradeoff", "compare"] {
            let (code, words) = without_display(&[command, &closed, "--backend", backend]);
            match code {
                Some(0) => assert_eq!(words, "", "{command} {backend}"),
                // There may be no GPU, nor a driver that emulates one.
                _ => assert!(
                    backend == "gpu" && words.contains("no usable GPU"),
                    "{words}"
                ),
            }
            assert!(words.lines().count() <= 1, "{words}");
        }
    }
    // Words of our own still come through after the search.
    let (code, words) = without_display(&["plan", &open, "--backend", "auto"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(!words.is_empty());
    for line in words.lines() {
        assert!(line.starts_with("cusp: warning: "), "{words}");
    }
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
        "at the least it takes 40 layers",
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
fn slice_writes_a_whole_zip_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let (model, zip) = (sphere(&folder), folder.path().join("out.zip"));
    let output = on_cpu(&[
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
    assert_eq!(names(&folder), ["ball.stl", "out.zip"]);
    // A closed model gives no warning, and a pipe is no place for a progress bar.
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

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
fn a_file_of_another_kind_is_named() {
    let folder = TempDir::new().unwrap();
    let head = b"PK\x03\x04\x14\0\x06\0\x08\0[Content_Types].xml";
    let model = model(&folder, "part.stl", head);
    let said = "this is a 3MF file, no STL; export the model as STL";
    for command in ["info", "plan", "orient"] {
        assert_fails(&cusp(&[command, &model]), 1, said);
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
    // What the file says is what the model's own saliency says.
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

#[test]
fn a_failed_slice_leaves_the_old_file() {
    let folder = TempDir::new().unwrap();
    let zip = model(&folder, "out.zip", b"precious");
    let output = on_cpu(&["slice", &sphere(&folder), "-o", &zip, "--tolerance", "0.01"]);
    assert_fails(&output, 1, "raise the tolerance to 0.0");
    assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
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
        assert_fails(&on_cpu(&["plan", &path]), 1, words);
    }
    assert_fails(
        &on_cpu(&["plan", &model(&folder, "flat.stl", &flat)]),
        1,
        "no height",
    );
    assert_fails(
        &cusp(&["info", "/nowhere/at all.stl"]),
        1,
        "/nowhere/at all.stl",
    );
    let ball = sphere(&folder);
    let too_small = on_cpu(&["plan", &ball, "--pixels", "100x100", "--pitch", "0.05"]);
    assert_fails(&too_small, 1, "a scale of 0.8333 fits");
    assert_fails(
        &on_cpu(&["plan", &ball, "--tolerance", "0.01"]),
        1,
        "from z = 0 to 0.05 mm",
    );
    assert_fails(
        &on_cpu(&["plan", &ball, "--layer-min", "0.2"]),
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
    assert_fails(&cusp(&["plan", &ball, "--range", "0:5"]), 2, "0:5=0.1:0.1");
    let two = ["plan", &ball, "--tolerance", "1", "--max-layers", "9"];
    assert_fails(&cusp(&two), 2, "cannot be used with");
    assert_fails(&cusp(&["tradeoff", &ball, "--points", "1"]), 2, "--points");
    let layer = ["plan", &ball, "--planner", "uniform", "--layer", "thin"];
    assert_fails(&cusp(&layer), 2, "finest");
}

#[test]
fn an_output_that_cannot_be_is_refused_before_the_model_is_read() {
    let folder = TempDir::new().unwrap();
    let poem = model(&folder, "poem.stl", b"a poem about a cube");
    let inside = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::create_dir(inside("folder")).unwrap();
    for (output, words) in [
        (poem.clone(), "is the model itself"),
        (inside("folder/../poem.stl"), "is the model itself"),
        (inside("folder"), "is a folder"),
        (inside("nowhere/out.zip"), "there is no folder"),
        (inside("nowhere/"), "there is no folder"),
    ] {
        assert_fails(&on_cpu(&["slice", &poem, "-o", &output]), 1, words);
    }
    assert_eq!(std::fs::read(&poem).unwrap(), b"a poem about a cube");
    assert_eq!(names(&folder), ["folder", "poem.stl"]);
}

#[test]
fn a_closed_stderr_changes_no_exit_code() {
    let folder = TempDir::new().unwrap();
    let mut open = solids::cube(10.0);
    open.pop();
    let open = model(&folder, "open.stl", &binary_stl(&open));
    for (arguments, code) in [
        (&["plan", &open, "--backend", "cpu"][..], 0), // with a warning
        (&["info", "/nowhere.stl"], 1),
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(env!("CARGO_BIN_EXE_cusp"))
            .args(arguments)
            .stderr(writer)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    }
}

#[cfg(unix)]
mod unix {
    use std::io::{BufRead as _, BufReader};
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::path::Path;
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    use super::*;

    const QUICK: [&str; 4] = ["--pitch", "0.1", "--backend", "cpu"];

    fn mode(path: impl AsRef<Path>) -> u32 {
        std::fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn a_link_stays_and_its_file_is_written() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let inside = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        std::fs::create_dir(inside("prints")).unwrap();
        std::fs::write(inside("prints/old.zip"), b"old").unwrap();
        symlink("prints/old.zip", inside("link.zip")).unwrap();
        let output = cusp(&[&["slice", &ball, "-o", &inside("link.zip")], &QUICK[..]].concat());
        assert!(output.status.success());
        assert!(Path::new(&inside("link.zip")).is_symlink());
        assert!(
            std::fs::read(inside("prints/old.zip"))
                .unwrap()
                .starts_with(b"PK")
        );

        symlink("ball.stl", inside("model.zip")).unwrap();
        let output = cusp(&["slice", &ball, "-o", &inside("model.zip")]);
        assert_fails(&output, 1, "is the model itself");
        symlink("nothing.zip", inside("dangling.zip")).unwrap();
        let output = cusp(&["slice", &ball, "-o", &inside("dangling.zip")]);
        assert_fails(&output, 1, "a link to a file that does not exist");
    }

    #[test]
    fn devices_and_pipes_are_refused() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let pipe = folder.path().join("pipe");
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        for output in ["/dev/null", pipe.to_str().unwrap()] {
            let output = cusp(&["slice", &ball, "-o", output]);
            assert_fails(&output, 1, "a device or a pipe");
        }
        assert_eq!(names(&folder), ["ball.stl", "pipe"]);
    }

    #[test]
    fn a_new_file_obeys_the_umask_and_a_replaced_one_keeps_its_mode() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let zip = folder.path().join("out.zip");
        let slice_with_umask_027 = || {
            let status = Command::new("sh")
                .args(["-c", "umask 027; exec \"$@\"", "sh"])
                .args([env!("CARGO_BIN_EXE_cusp"), "slice", &ball, "-o"])
                .arg(&zip)
                .args(QUICK)
                .stdout(Stdio::null())
                .status();
            assert!(status.unwrap().success());
        };
        slice_with_umask_027();
        assert_eq!(mode(&zip), 0o640);
        for kept in [0o600, 0o666] {
            std::fs::set_permissions(&zip, PermissionsExt::from_mode(kept)).unwrap();
            slice_with_umask_027();
            assert_eq!(mode(&zip), kept);
        }
    }

    /// The command with signals as a terminal gives them: whatever runs the tests in the background may
    /// have the interrupt ignored, and a child inherits that.
    fn with_usual_signals() -> Command {
        let cusp = env!("CARGO_BIN_EXE_cusp");
        if cfg!(target_os = "linux") {
            let mut command = Command::new("env");
            command.args(["--default-signal", cusp]);
            command
        } else {
            Command::new(cusp)
        }
    }

    #[test]
    fn an_interrupt_stops_a_batch_in_which_a_model_is_bad() {
        let folder = TempDir::new().unwrap();
        let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 5)));
        let absent = folder.path().join("absent.stl").display().to_string();
        // So many directions take minutes.
        let mut child = with_usual_signals()
            .args(["orient", &absent, &ball, &ball, "--directions", "20000"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut words = BufReader::new(child.stderr.take().unwrap()).lines();
        let first = words.next().unwrap().unwrap();
        assert!(first.contains("absent.stl"), "{first}");
        let process = child.id().to_string();
        let kill = Command::new("kill").args(["-INT", &process]).status();
        assert!(kill.unwrap().success());
        let rest: Vec<String> = words.map(Result::unwrap).collect();
        assert_eq!(rest, ["cusp: cancelled"]);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        assert!(output.stdout.is_empty());
    }

    #[test]
    fn an_interrupt_leaves_the_old_file_and_no_other() {
        let folder = TempDir::new().unwrap();
        let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 4)));
        let zip = model(&folder, "out.zip", b"precious");
        // Tens of thousands of layers: writing them all takes many seconds.
        let mut child = with_usual_signals()
            .args(["slice", &ball, "-o", &zip, "--backend", "cpu"])
            .args([
                "--planner",
                "uniform",
                "--layer",
                "0.0005",
                "--bin",
                "0.0005",
            ])
            .args(["--layer-min", "0.0005"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let is_writing = || {
            std::fs::read_dir(folder.path()).unwrap().any(|entry| {
                let entry = entry.unwrap();
                let is_new = entry.path() != Path::new(&ball) && entry.path() != Path::new(&zip);
                is_new && entry.metadata().is_ok_and(|file| file.len() > 0)
            })
        };
        let clock = Instant::now();
        while !is_writing() {
            assert!(clock.elapsed() < Duration::from_mins(2), "never wrote");
            assert_eq!(child.try_wait().unwrap(), None, "ended before it wrote");
            std::thread::sleep(Duration::from_millis(2));
        }
        let process = child.id().to_string();
        let kill = Command::new("kill").args(["-INT", &process]).status();
        assert!(kill.unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "cusp: cancelled\n");
        assert_eq!(output.status.code(), Some(130));
        assert_eq!(names(&folder), ["ball.stl", "out.zip"]);
        assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
    }
}

/// A slab that stands on an edge, askew.
fn slab(folder: &TempDir) -> String {
    let mut slab = solids::cuboid(glam::Vec3::new(9.0, 7.0, 2.0));
    let askew = glam::Quat::from_xyzw(0.3, -0.4, 0.1, 0.8).normalize();
    for corner in slab.iter_mut().flatten() {
        *corner = askew * *corner;
    }
    model(folder, "slab.stl", &binary_stl(&slab))
}

#[test]
fn orient_finds_the_best_direction_and_applies_it() {
    let folder = TempDir::new().unwrap();
    let model = slab(&folder);
    let flat = folder.path().join("flat.stl").display().to_string();
    let output = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--apply",
        "1",
        "-o",
        &flat,
        "--json",
    ]);
    let found = json(&output);
    let best = &found["best"][0];
    assert_eq!(
        found["model"],
        json(&on_cpu(&["plan", &model, "--json"]))["model"]
    );
    assert!((best["size_mm"][2].as_f64().unwrap() - 2.0).abs() < 1e-4);
    assert!(best["energy"].as_f64() < found["now"]["energy"].as_f64());
    let plan = json(&on_cpu(&["plan", &flat, "--json"]));
    assert_eq!(plan["layers"], best["metrics"]["layers"]);
    // The rotation that it gives says the same.
    let rotation: Vec<String> = best["rotation"]
        .as_array()
        .unwrap()
        .iter()
        .map(Value::to_string)
        .collect();
    let rotation = format!("--rotation={}", rotation.join(","));
    assert_eq!(
        json(&on_cpu(&["plan", &model, &rotation, "--json"]))["layers"],
        plan["layers"]
    );

    let words = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--quality",
        "overhang",
        "--cost",
        "time",
    ]);
    let words = String::from_utf8(words.stdout).unwrap();
    assert!(words.contains("72 directions"), "{words}");
    assert!(words.contains("\nnow "), "{words}");
    assert!(words.contains("--rotation="), "{words}");
    let none = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--tolerance",
        "0.0001",
    ]);
    assert!(none.status.success());
    let none = String::from_utf8(none.stdout).unwrap();
    assert!(
        none.contains("72 without a plan within tolerance"),
        "{none}"
    );
    assert!(none.contains("no orientation"), "{none}");

    assert_fails(&cusp(&["orient", &model, "--apply", "1"]), 2, "--output");
    assert_fails(&cusp(&["orient", &model, "--alpha", "2"]), 2, "from 0 to 1");
    let two = cusp(&["orient", &model, &model, "--apply", "1", "-o", &flat]);
    assert_fails(&two, 1, "--apply is for one model");
    let itself = cusp(&["orient", &model, "--apply", "1", "-o", &model]);
    assert_fails(&itself, 1, "is the model itself");
}

#[test]
fn shards_of_a_batch_give_what_one_process_gives() {
    let folder = TempDir::new().unwrap();
    let [slab, ball] = [slab(&folder), sphere(&folder)];
    let batch = |more: &[&str]| {
        let models = [
            "orient",
            &slab,
            &ball,
            "--directions",
            "40",
            "--bin",
            "0.01",
        ];
        cusp(&[&models[..], more].concat())
    };
    let parts: Vec<String> = (1..=3)
        .map(|number| {
            let part = batch(&["--shard", &format!("{number}/3")]);
            assert!(part.status.success());
            let path = folder.path().join(format!("part-{number}.jsonl"));
            std::fs::write(&path, part.stdout).unwrap();
            path.display().to_string()
        })
        .collect();
    let merge = |places: &[usize]| {
        let parts = places.iter().map(|&place| parts[place].as_str());
        let arguments: Vec<&str> = ["--json", "--merge"].into_iter().chain(parts).collect();
        batch(&arguments)
    };
    let whole = batch(&["--json"]);
    assert_eq!(String::from_utf8_lossy(&whole.stdout).lines().count(), 2);
    assert_eq!(merge(&[2, 0, 1]).stdout, whole.stdout);

    for (places, words) in [
        (&[0, 1][..], "directions are missing"),
        (&[0, 1, 2, 1], "measured twice, in shards 2/3 and 2/3"),
    ] {
        assert_only_bad(&merge(places), "", &[(&slab, words), (&ball, words)]);
    }
    let other = cusp(&["orient", &slab, "--directions", "40", "--merge", &parts[0]]);
    assert_fails(&other, 1, "other options");
    assert_fails(&batch(&["--shard", "4/3"]), 2, "from 1/N to N/N");
    assert_fails(&batch(&["--merge", &slab]), 1, "slab.stl");
}

/// Asserts that a batch gives `stdout`, and that these models are bad, for reasons with these words.
#[track_caller]
fn assert_only_bad(output: &Output, stdout: &str, bad: &[(&str, &str)]) {
    assert_eq!(String::from_utf8_lossy(&output.stdout), stdout);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), bad.len(), "{stderr}");
    for (line, (model, words)) in lines.iter().zip(bad) {
        assert!(line.starts_with(&format!("cusp: {model}: ")), "{line}");
        assert!(line.contains(words), "{line}");
    }
}

#[test]
fn a_bad_model_does_not_stop_the_others_of_a_batch() {
    let folder = TempDir::new().unwrap();
    let [slab, ball] = [slab(&folder), sphere(&folder)];
    let poem = model(&folder, "poem.stl", b"solid as a rock");
    let absent = folder.path().join("absent.stl").display().to_string();
    let orient = |models: &[&str], more: &[&str]| {
        let fixed = ["orient", "--directions", "40", "--bin", "0.01"];
        cusp(&[&fixed[..], models, more].concat())
    };
    let good = |more: &[&str]| {
        let output = orient(&[&slab, &ball], more);
        assert!(output.status.success());
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        String::from_utf8(output.stdout).unwrap()
    };
    let models = [&poem, &slab, &absent, &ball].map(String::as_str);
    let bad = [(poem.as_str(), ""), (absent.as_str(), "No such file")];
    for how in [&[][..], &["--json"], &["--shard", "1/1"]] {
        assert_only_bad(&orient(&models, how), &good(how), &bad);
    }
    // The same models are bad when parts are merged.
    let part = model(&folder, "part.jsonl", good(&["--shard", "1/1"]).as_bytes());
    let merged = orient(&models, &["--json", "--merge", &part]);
    assert_only_bad(&merged, &good(&["--json"]), &bad);
    assert_only_bad(&orient(&[&absent], &[]), "", &bad[1..]);

    // Weights belong to one model.
    let weights = folder.path().join("slab.weights").display().to_string();
    assert!(cusp(&["saliency", &slab, "-o", &weights]).status.success());
    let weighed = ["--json", "--weights", &weights];
    let alone = orient(&[&slab], &weighed);
    assert!(alone.status.success());
    assert_only_bad(
        &orient(&[&ball, &slab], &weighed),
        &String::from_utf8(alone.stdout).unwrap(),
        &[(&ball, "slab.weights: these weights are for another mesh")],
    );

    // What is wrong for every model is said once.
    for (how, words) in [
        (["--layer-min", "0.2"], "cusp: no whole number of steps"),
        (["--printer", "none"], "cusp: there is no printer none"),
        (["--weights", &slab], "no file of weights"),
        (["--weights", &absent], "absent.stl: No such file"),
        (["--resin", &absent], "absent.stl: No such file"),
    ] {
        assert_fails(&orient(&models, &how), 1, words);
        let merge = [&how[..], &["--merge", &part]].concat();
        assert_fails(&orient(&models, &merge), 1, words);
    }
}

#[test]
fn printers_say_which_files_they_read() {
    let text = String::from_utf8(cusp(&["printers"]).stdout).unwrap();
    let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("name ").ends_with("format    reads"));
    assert!(line("sl1s ").ends_with("sl1       sl1s"));
    assert!(line("saturn-3-ultra ").ends_with("chitubox  goo by a converter"));
    let json = json(&cusp(&["printers", "--json"]));
    let printers = json.as_array().unwrap();
    let saturn = printers.iter().find(|it| it["name"] == "saturn-3-ultra");
    assert_eq!(saturn.unwrap()["reads"], serde_json::json!(["goo"]));
}
