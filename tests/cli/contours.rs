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

/// The boxes around the outer rings of the lowest layer of an SVG, mm.
fn lowest_boxes(svg: &str) -> Vec<[f64; 4]> {
    let layer = svg.split("<g id=").nth(1).unwrap();
    let paths = layer.split(" d=\"").skip(1);
    let boxes = paths.map(|path| {
        let ring = path.split(['z', '"']).next().unwrap();
        let numbers = ring.split(|it: char| !(it.is_ascii_digit() || it == '.' || it == '-'));
        let numbers: Vec<f64> = numbers.flat_map(str::parse).collect();
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for point in numbers.chunks_exact(2) {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        [low[0], low[1], high[0], high[1]]
    });
    boxes.collect()
}

#[test]
fn contours_of_a_plate_are_those_of_each_model_where_its_copies_stand() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let block = model(
        &folder,
        "block.stl",
        &binary_stl(&solids::cuboid([8.0, 4.0, 3.0].into())),
    );
    let plate = [&*format!("{ball}:2"), &block];
    let same = ["--json", "--pixels", "1000x600", "--pitch", "0.05"];
    let path = folder.path().join("plate.svg").display().to_string();
    let command = [&["contours"][..], &plate, &same, &["-o", &path]].concat();
    let report = json(&on_cpu(&command));
    let command = [&["plan", "--arrange"][..], &plate, &same].concat();
    let plan = json(&on_cpu(&command));
    assert_eq!(report["layers"], plan["layers"]);
    let volume = report["volume_mm3"].as_f64().unwrap();
    assert!(
        (2.0 * 110.0 + 96.0..2.0 * 113.2 + 96.1).contains(&volume),
        "{volume}"
    );
    // Each outline surrounds the place of one copy, and has its turn.
    let boxes = lowest_boxes(&fs::read_to_string(&path).unwrap());
    let placements = plan["placements"].as_array().unwrap();
    assert_eq!((boxes.len(), placements.len()), (3, 3));
    for place in placements {
        let number = |name: &str| place[name].as_f64().unwrap_or(0.0);
        let (x, y) = (number("x_mm"), number("y_mm"));
        let at = |it: &&[f64; 4]| {
            (it[0] + it[2] - 2.0 * x).abs() < 2e-3 && (it[1] + it[3] - 2.0 * y).abs() < 2e-3
        };
        let found = boxes
            .iter()
            .find(at)
            .unwrap_or_else(|| panic!("{place}: {boxes:?}"));
        if place["model"] == 1 {
            let (sin, cos) = number("turn_deg").to_radians().sin_cos();
            let size = [
                8.0 * cos.abs() + 4.0 * sin.abs(),
                8.0 * sin.abs() + 4.0 * cos.abs(),
            ];
            assert!((found[2] - found[0] - size[0]).abs() < 1e-3, "{found:?}");
            assert!((found[3] - found[1] - size[1]).abs() < 1e-3, "{found:?}");
        }
    }
}

#[test]
fn each_plate_has_a_file_of_contours() {
    let folder = TempDir::new().unwrap();
    let ball = format!("{}:3", sphere(&folder));
    let path = folder.path().join("balls.cli").display().to_string();
    let small = ["--pixels", "300x150", "--pitch", "0.05", "-o", &path];
    let shown = on_cpu(&[&["contours", &ball][..], &small].concat());
    assert!(
        shown.status.success(),
        "{}",
        String::from_utf8_lossy(&shown.stderr)
    );
    assert_eq!(names(&folder), ["ball.stl", "balls-1.cli", "balls-2.cli"]);
    let shown = String::from_utf8(shown.stdout).unwrap();
    assert!(shown.contains("balls-2.cli\nlayers"), "{shown}");
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
