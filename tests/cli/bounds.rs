//! Limits on the harm of a hostile plan, a closed pipe and text from outside.

use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{cusp, json, model, names, on_cpu, sphere};
use crate::common::{binary_stl, solids};

/// The error that a command printed in JSON.
fn error(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(1));
    let said: Value = serde_json::from_slice(&output.stdout).unwrap();
    said["error"].clone()
}

/// A plan of this model in a file, after a change.
fn changed_plan(folder: &TempDir, of: &str, change: impl FnOnce(&mut Value)) -> String {
    let mut plan = json(&on_cpu(&["plan", of, "--pitch", "0.3", "--json"]));
    change(&mut plan);
    model(folder, "plan.json", plan.to_string().as_bytes())
}

#[test]
fn failures_are_said_in_json_with_their_code_details_and_file() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let absent = folder.path().join("absent.stl").display().to_string();
    let found = error(&cusp(&["plan", &absent, "--json"]));
    assert_eq!(found["code"], "file");
    assert!(found["message"].as_str().unwrap().contains("absent.stl"));

    let found = error(&on_cpu(&["plan", &ball, "--tolerance", "1e-9", "--json"]));
    assert_eq!(
        (&found["code"], &found["file"]),
        (&json!("infeasible"), &json!(ball))
    );
    assert!(found["detail"]["least_tolerance"].is_f64());

    let lie = changed_plan(&folder, &ball, |plan| plan["resin_ml"] = json!(7.0));
    let found = error(&cusp(&["verify", &lie, &ball, "--json"]));
    assert_eq!(
        (&found["code"], &found["file"]),
        (&json!("differs"), &json!(lie))
    );
    assert_eq!(found["detail"]["key"], "resin_ml");
    assert_eq!(found["detail"]["claimed"], 7.0);
}

#[test]
fn every_command_that_prints_for_programs_says_failures_to_them() {
    let folder = TempDir::new().unwrap();
    let absent = folder.path().join("absent").display().to_string();
    let out = folder.path().join("out").display().to_string();
    let svg = folder.path().join("out.svg").display().to_string();
    let calls: [&[&str]; 13] = [
        &["orient", &absent],
        &["slice", &absent, "-o", &out],
        &["plan", &absent],
        &["contours", &absent, "-o", &svg],
        &["tradeoff", &absent],
        &["compare", &absent],
        &["check", &absent],
        &["verify", &absent, &absent],
        &["simulate", &absent, &absent],
        &["inspect", &absent],
        &["convert", &absent, &out],
        &["saliency", &absent, "-o", &out],
        &["info", &absent],
    ];
    for call in calls {
        let found = error(&cusp(&[call, &["--json"]].concat()));
        assert!(found["message"].is_string(), "{call:?}: {found}");
    }
}

#[test]
fn of_several_models_to_orient_those_that_fail_say_so_in_their_lines() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let absent = folder.path().join("absent.stl").display().to_string();
    let output = on_cpu(&["orient", &absent, &ball, "--directions", "20", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(
        (&lines[0]["error"]["code"], &lines[0]["error"]["file"]),
        (&json!("file"), &json!(absent))
    );
    assert!(lines[1]["best"].is_array());
}

/// The path that an error names, and a change of a plan that leads to it.
type Change = (&'static str, fn(&mut Value));

#[test]
fn a_plan_that_contradicts_itself_is_refused_before_any_work() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let changes: [Change; 4] = [
        ("layers", |plan| plan["layers"] = json!(-1)),
        ("z_mm", |plan| {
            _ = plan["z_mm"].as_array_mut().unwrap().pop();
        }),
        ("exposure_s", |plan| plan["exposure_s"] = json!([])),
        ("z_mm[3]", |plan| plan["z_mm"][3] = json!(0.0)),
    ];
    for (key, change) in changes {
        // With these options nothing could be sampled.
        let plan = changed_plan(&folder, &ball, |plan| {
            plan["options"]["rays"] = json!(100_000_000);
            change(plan);
        });
        let found = error(&cusp(&["verify", &plan, &ball, "--json"]));
        assert_eq!(
            (&found["code"], &found["detail"]["key"]),
            (&json!("contradicts"), &json!(key))
        );
    }
}

#[test]
fn what_would_take_too_long_is_refused_before_it_is_planned() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(20.0)));
    // Two million bins times as many thicknesses, for each of many tolerances.
    let hours = [
        "--metric",
        "volume",
        "--max-layers",
        "1000",
        "--bin",
        "0.00001",
        "--pitch",
        "0.3",
    ];
    let hours = [
        &hours[..],
        &[
            "--layer-min",
            "0.00001",
            "--layer-max",
            "1000",
            "--snap",
            "off",
        ],
    ]
    .concat();
    let call = ["plan", &cube, "--json", "--max-cpu-time", "60"];
    let found = error(&on_cpu(&[&call, &hours[..]].concat()));
    assert_eq!(found["code"], "time-bound");
    assert_eq!(found["detail"]["work"], "layers");
    assert_eq!(found["detail"]["allowed_s"], 60.0);
    assert!(found["detail"]["needed_s"].as_f64().unwrap() > 3600.0);

    // 350 million hits.
    let call = ["plan", &cube, "--json", "--max-cpu-time", "2"];
    let found = error(&on_cpu(&[&call, &["--pitch", "0.0015"][..]].concat()));
    assert_eq!(found["code"], "time-bound");
    assert_eq!(found["detail"]["work"], "hits");
    assert!(found["detail"]["needed_s"].as_f64().unwrap() > 2.0);
}

#[test]
fn what_takes_longer_than_allowed_is_ended() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(20.0)));
    let zip = folder.path().join("cube.zip").display().to_string();
    // Some seconds: the estimate before lets it begin.
    let long = [
        "--metric",
        "deviation",
        "--minimize",
        "time",
        "--bin",
        "0.0005",
        "--layer-max",
        "2",
    ];
    let call = ["slice", &cube, "-o", &zip, "--json", "--max-cpu-time", "1"];
    let found = error(&on_cpu(&[&call, &long[..]].concat()));
    assert_eq!(found["code"], "time-bound");
    assert_eq!(found["detail"]["work"], "all");
    assert_eq!(super::names(&folder), ["cube.stl"]);
}

#[test]
fn text_from_outside_is_shown_and_does_not_act() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let key = "x\n\u{1b}[31mcusp: all is well\u{202e}";
    let plan = changed_plan(&folder, &ball, |plan| plan["mask"][key] = json!(1));
    let output = cusp(&["verify", &plan, &ball, "--json"]);
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("x\\u{a}\\u{1b}[31mcusp"), "{said}");
    assert!(!said.contains(['\u{1b}', '\u{202e}']));
    let found = error(&output);
    assert_eq!(
        found["detail"]["key"],
        "mask.x\\u{a}\\u{1b}[31mcusp: all is well\\u{202e}"
    );
}

#[test]
#[cfg(unix)]
fn json_that_nobody_can_read_is_a_failure() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    // The status of the command itself, in a pipe that is closed by the time it prints.
    let script = "{ \"$0\" plan \"$1\" --backend cpu --pitch 0.3 --json; echo $? >&2; } | true";
    let output = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_cusp"), &ball])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("cusp: standard output: "), "{said}");
    assert!(said.ends_with("1\n"), "{said}");
}

#[test]
#[cfg(unix)]
fn a_large_file_that_is_no_model_is_refused_by_its_first_bytes() {
    let folder = TempDir::new().unwrap();
    let path = model(&folder, "large.stl", b"\x89PNG is not an STL");
    // Sparse: more than there is memory.
    let file = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    file.set_len(1 << 42).unwrap();
    let output = cusp(&["info", &path]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("large.stl: ")
    );
}

#[test]
#[cfg(target_os = "linux")]
fn whatever_addresses_are_left_a_file_is_whole_or_none() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(20.0, 5)));
    let path = |name: &str| folder.path().join(name).display().to_string();
    let slice = |zip: &str, limit_kb: u32| {
        Command::new("sh")
            .args(["-c", &format!("ulimit -v {limit_kb}; exec \"$0\" \"$@\"")])
            .args([env!("CARGO_BIN_EXE_cusp"), "slice", &ball, "-o", &path(zip)])
            .args(["--printer", "saturn-3-ultra", "--backend", "cpu"])
            .output()
            .unwrap()
    };
    let whole = slice("whole.goo", 100_000_000);
    assert!(whole.status.success(), "{whole:?}");
    let expected = std::fs::read(path("whole.goo")).unwrap();
    let (mut written, mut refused) = (0, 0);
    for limit_kb in (100_000..1_000_000).step_by(60_000) {
        let output = slice("out.goo", limit_kb);
        if output.status.success() {
            assert!(
                std::fs::read(path("out.goo")).unwrap() == expected,
                "{limit_kb}"
            );
            std::fs::remove_file(path("out.goo")).unwrap();
            written += 1;
        } else {
            assert!(!output.stderr.is_empty());
            refused += 1;
        }
        // Not a signal's 134, and not a shell's 126 or 127 for a program that cannot start.
        let code = output.status.code().unwrap();
        assert!([0, 1].contains(&code), "{limit_kb}: {output:?}");
        assert_eq!(names(&folder), ["ball.stl", "whole.goo"]);
    }
    assert!(written > 0 && refused > 0, "{written} {refused}");
}
