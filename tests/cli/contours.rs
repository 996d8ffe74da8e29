//! `contours`.

use std::f64::consts::{PI, TAU};
use std::fs;

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, names, on_cpu, sphere};
use crate::common::{binary_stl, solids};

#[test]
fn contours_have_the_layers_of_the_plan() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let plan = json(&on_cpu(&["plan", &ball, "--json", "--layer-max", "0.2"]));
    let planes: Vec<f64> = serde_json::from_value(plan["z_mm"].clone()).unwrap();
    for (name, mark) in [("ball.svg", "<g id="), ("ball.CLI", "$$LAYER/")] {
        let path = folder.path().join(name).display().to_string();
        let options = [
            "contours",
            &ball,
            "-o",
            &path,
            "--layer-max",
            "0.2",
            "--json",
        ];
        let report = json(&on_cpu(&options));
        let layers = plan["layers"].as_u64().unwrap();
        assert_eq!(report["layers"], layers);
        let sections = report["sections"].as_array().unwrap();
        for (section, planes) in sections.iter().zip(planes.windows(2)) {
            let number = |name: &str| section[name].as_f64().unwrap();
            assert_eq!([number("bottom_mm"), number("top_mm")], planes);
            assert!((number("section_mm") - planes[0].midpoint(planes[1])).abs() < 1e-9);
            // The facets of the ball are between two spheres.
            let radius = |of: f64| {
                (of * of - (number("section_mm") - 3.0).powi(2))
                    .max(0.0)
                    .sqrt()
            };
            let (inner, outer) = (radius(2.97), radius(3.0));
            let areas = PI * inner * inner..PI * outer * outer;
            assert!(areas.contains(&number("area_mm2")), "{section}");
            assert!(
                (TAU * inner..TAU * outer).contains(&number("perimeter_mm")),
                "{section}"
            );
        }
        let volume = report["volume_mm3"].as_f64().unwrap();
        assert!((110.0..113.2).contains(&volume), "{volume}");
        let text = fs::read_to_string(&path).unwrap();
        // In a CLI file, there is one more at the plate.
        let zero = u64::from(mark == "$$LAYER/");
        assert_eq!(text.matches(mark).count() as u64, layers + zero);
    }
    let shown = on_cpu(&[
        "contours",
        &ball,
        "-o",
        &folder.path().join("a.svg").display().to_string(),
    ]);
    let shown = String::from_utf8(shown.stdout).unwrap();
    assert!(
        shown.contains("cut at their middles") && shown.contains(" with 0 holes"),
        "{shown}"
    );
}

#[test]
fn a_tolerance_leaves_out_points() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let path = folder.path().join("ball.svg").display().to_string();
    let points = |tolerance: &str| {
        let report = json(&on_cpu(&[
            "contours",
            &ball,
            "-o",
            &path,
            "--simplify",
            tolerance,
            "--json",
        ]));
        report["points"].as_u64().unwrap()
    };
    assert!(points("0") > points("0.01") && points("0.01") > points("0.1"));
}

#[test]
fn other_files_than_svg_and_cli_are_refused_before_any_work() {
    let folder = TempDir::new().unwrap();
    let absent = "absent.stl";
    assert_fails(
        &cusp(&["contours", absent, "-o", "contours.dxf"]),
        2,
        ".svg or .cli",
    );
    assert_fails(
        &cusp(&["contours", absent, "-o", "contours"]),
        2,
        ".svg or .cli",
    );
    assert_fails(
        &cusp(&["contours", absent, "-o", "a.svg", "--simplify", "-1"]),
        2,
        "--simplify",
    );
    let path = folder.path().join("a.svg").display().to_string();
    assert_fails(&cusp(&["contours", absent, "-o", &path]), 1, "absent.stl");
    let flat = model(&folder, "ball.stl", &binary_stl(&solids::sphere(3.0, 3)));
    assert_fails(
        &on_cpu(&[
            "contours",
            &flat,
            "-o",
            &path,
            "--layer-min",
            "0.2",
            "--layer-max",
            "0.1",
        ]),
        1,
        "ball.stl",
    );
    assert_eq!(names(&folder), ["ball.stl"], "no file is left behind");
}
