//! `check`: findings, limits and verdicts.

use glam::Vec3;
use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, of_only_plate, on_cpu};
use crate::common::{binary_stl, solids};

/// A hollow ball, whose inside no hole drains.
fn hollow(folder: &TempDir) -> String {
    let mut triangles = solids::sphere(3.0, 4);
    triangles.extend(solids::inverted(&solids::sphere(2.5, 4)));
    model(folder, "hollow.stl", &binary_stl(&triangles))
}

#[test]
fn a_hollow_ball_is_rejected_with_the_reason() {
    let folder = TempDir::new().unwrap();
    let hollow = hollow(&folder);
    let output = on_cpu(&["check", &hollow, "--pitch", "0.05"]);
    assert_eq!(output.status.code(), Some(1));
    let shown = String::from_utf8(output.stdout).unwrap();
    assert!(shown.starts_with("verdict   reject"), "{shown}");
    assert!(shown.contains("1 × trap, reject"), "{shown}");
    assert!(shown.contains("make two holes"), "{shown}");
    assert!(output.stderr.is_empty());
}

#[test]
fn a_shop_sets_what_it_accepts() {
    let folder = TempDir::new().unwrap();
    let hollow = hollow(&folder);
    let lenient = model(
        &folder,
        "limits.json",
        br#"{ "severity": { "trap": "ignore" } }"#,
    );
    let check = |options: &[&str]| {
        let output = on_cpu(&[&["check", &hollow, "--pitch", "0.05", "--json"], options].concat());
        let checked = serde_json::from_slice(&output.stdout);
        of_only_plate(checked.unwrap())
    };
    let checked = check(&[]);
    assert_eq!(checked["verdict"], "reject");
    let trap = &checked["models"][0]["findings"][0];
    assert_eq!(
        (&trap["code"], &trap["severity"]),
        (&"trap".into(), &"reject".into())
    );
    let volume_mm3 = trap["volume_mm3"].as_f64().unwrap();
    let ball_mm3 = std::f64::consts::PI * 4.0 / 3.0 * 2.5f64.powi(3);
    assert!((volume_mm3 / ball_mm3 - 1.0).abs() < 0.02, "{volume_mm3}");
    assert_eq!(checked["limits"]["wall_mm"], 0.4);
    let checked = check(&["--limits", &lenient]);
    assert_eq!(checked["verdict"], "ok");
    assert_eq!(
        checked["models"][0]["findings"].as_array().unwrap().len(),
        0
    );
}

#[test]
fn a_cube_is_printed() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(5.0)));
    let checked = json(&on_cpu(&["check", &cube, "--pitch", "0.05", "--json"]));
    assert_eq!(checked["verdict"], "ok");
    assert_eq!(checked["models"][0]["bodies"], 1);
    assert_eq!(checked["models"][0]["peel"]["contact"], 1.0);
}

#[test]
fn limits_that_cannot_be_used_are_named() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(5.0)));
    for (text, reason) in [
        (
            r#"{ "wall_mm": 900 }"#,
            "wall_mm is 900, but must be from 0 to 20",
        ),
        (
            r#"{ "walls_mm": 1 }"#,
            "unknown field `walls_mm`: did you mean `wall_mm`?",
        ),
        (r#"{ "severity": { "trap": "ok" } }"#, "unknown variant"),
    ] {
        let limits = model(&folder, "limits.json", text.as_bytes());
        let output = on_cpu(&["check", &cube, "--limits", &limits]);
        assert_fails(&output, 1, "limits.json");
        assert_fails(&output, 1, reason);
    }
    assert_fails(
        &on_cpu(&["check", &cube, "--limits", "absent.json"]),
        1,
        "absent.json",
    );
}

#[test]
fn each_model_of_a_job_is_checked_in_the_layers_of_its_plate() {
    let folder = TempDir::new().unwrap();
    let mut floating = solids::cuboid(Vec3::new(6.0, 6.0, 1.0));
    let ball = solids::sphere(2.0, 3);
    floating.extend(solids::moved(&ball, Vec3::new(3.0, 3.0, 6.0)));
    model(&folder, "floating.stl", &binary_stl(&floating));
    model(&folder, "cube.stl", &binary_stl(&solids::cube(5.0)));
    let job = r#"{
        "models": [{ "file": "floating.stl" }, { "file": "cube.stl", "copies": 3 }],
        "options": { "pixels": [400, 300], "pitch_mm": 0.1, "backend": "cpu" }
    }"#;
    let job = model(&folder, "job.json", job.as_bytes());
    let output = cusp(&["check", &job, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(checked["verdict"], "reject");
    let [floating, cube] = &checked["plates"][0]["models"].as_array().unwrap()[..] else {
        panic!("{checked}");
    };
    let alone: Value = serde_json::from_slice(
        &on_cpu(&[
            "check",
            &folder.path().join("floating.stl").display().to_string(),
            "--pixels",
            "400x300",
            "--pitch",
            "0.1",
            "--json",
        ])
        .stdout,
    )
    .unwrap();
    assert_eq!(
        floating["counts"],
        alone["plates"][0]["models"][0]["counts"]
    );
    assert_eq!(
        (&cube["model"], &cube["verdict"]),
        (&1.into(), &"ok".into())
    );
    let text = String::from_utf8(cusp(&["check", &job]).stdout).unwrap();
    assert!(text.contains("floating.stl\nverdict   reject"), "{text}");
    assert!(text.contains("cube.stl\nverdict   ok"), "{text}");
}
