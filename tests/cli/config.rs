//! Settings from a file.

use serde_json::{Value, json as value};
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu, sphere};

/// The options of a plan of a ball with these arguments.
fn options(folder: &TempDir, arguments: &[&str]) -> Value {
    let ball = sphere(folder);
    let report = json(&on_cpu(&[&["plan", &ball, "--json"], arguments].concat()));
    report["options"].clone()
}

#[test]
fn the_command_line_goes_before_the_file_and_the_file_before_defaults() {
    let folder = TempDir::new().unwrap();
    let settings = r#"
        # The printer in the cellar.
        layer_min_mm = 0.04
        layer_max_mm = 0.12
        antialias = 2
        metric = "roughness"
        snap = "off"
        saliency = true
        planes_mm = [1.5]
        ranges = [{ from_mm = 0, to_mm = 1, layer_min_mm = 0.05, layer_max_mm = 0.05 }]
        planner = { kind = "greedy" }
        rays = 512
        weight_min = 0.5
        [resin]
        exposure_s = 2
    "#;
    let config = model(&folder, "cusp.toml", settings.as_bytes());
    let by_default = options(&folder, &[]);
    let by_file = options(&folder, &["--config", &config]);
    let mut expected = by_default.clone();
    expected["layer_min_mm"] = value!(0.04);
    expected["layer_max_mm"] = value!(0.12);
    expected["antialias"] = value!(2);
    expected["metric"] = value!("roughness");
    expected["snap"] = value!("off");
    expected["saliency"] = value!(true);
    expected["planes_mm"] = value!([1.5]);
    expected["ranges"] =
        value!([{"from_mm": 0.0, "to_mm": 1.0, "layer_min_mm": 0.05, "layer_max_mm": 0.05}]);
    expected["planner"] = value!({"kind": "greedy"});
    expected["rays"] = value!(512);
    expected["weight_min"] = value!(0.5);
    expected["resin"]["exposure_s"] = value!(2.0);
    assert_eq!(by_file, expected);

    // Values that are also the defaults count, if they are on the command line.
    let given = [
        "--config",
        &config,
        "--layer-min",
        "0.05",
        "--layer-max",
        "0.15",
        "--aa",
        "1",
        "--metric",
        "cusp",
        "--snap",
        "auto",
        "--saliency=false",
        "--planner",
        "optimal",
        "--weight-min",
        "0.25",
        "--plane",
        "2.5",
        "--range",
        "0:2=0.05:0.05",
    ];
    let by_both = options(&folder, &given);
    let mut expected = by_default;
    expected["rays"] = value!(512);
    expected["resin"]["exposure_s"] = value!(2.0);
    expected["planes_mm"] = value!([2.5]);
    expected["ranges"] =
        value!([{"from_mm": 0.0, "to_mm": 2.0, "layer_min_mm": 0.05, "layer_max_mm": 0.05}]);
    assert_eq!(by_both, expected);
}

#[test]
fn a_goal_or_a_thickness_rule_replaces_whichever_the_file_has() {
    let folder = TempDir::new().unwrap();
    let config = model(
        &folder,
        "cusp.toml",
        b"tolerance = 0.05\nthicknesses_mm = [0.05, 0.1]\n",
    );
    let by_file = options(&folder, &["--config", &config]);
    assert_eq!(by_file["tolerance"], 0.05);
    let goal = [
        "--config",
        &config,
        "--max-layers",
        "90",
        "--layer-max",
        "0.12",
    ];
    let by_goal = options(&folder, &goal);
    assert_eq!(by_goal["tolerance"], Value::Null);
    assert_eq!(by_goal["max_layers"], 90);
    assert_eq!(by_goal["thicknesses_mm"], value!([]));
    let few = options(&folder, &["--config", &config, "--max-thicknesses", "2"]);
    assert_eq!(
        (&few["tolerance"], &few["max_thicknesses"]),
        (&value!(0.05), &value!(2))
    );
    assert_eq!(few["thicknesses_mm"], value!([]));
}

#[test]
fn what_is_wrong_in_the_file_is_named_with_its_line() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    for (text, line, words) in [
        (
            "layer_min_mm = 0.05\n\nlayer_maximum = 0.1\n",
            3,
            "did you mean `layer_max_mm`?",
        ),
        (
            "qq = 1\n",
            1,
            "unknown field `qq`, expected one of `rotation`, `height_mm`",
        ),
        ("# here\nlayer_min_mm = \"thin\"\n", 2, "expected f64"),
        ("metric = \"beauty\"", 1, "unknown variant `beauty`"),
        ("snap = \"off\"\nlayer_min_mm = = 2", 2, ""),
        ("snap = \"off\"\nsnap = \"auto\"", 2, "duplicate"),
        ("[resin]\nexposure = 3", 2, "unknown field `exposure`"),
        ("weights = 3", 1, "path of a file of weights"),
    ] {
        let config = model(&folder, "cusp.toml", text.as_bytes());
        let output = on_cpu(&["plan", &ball, "--config", &config]);
        assert_fails(&output, 1, &format!("{config}: line {line}: "));
        assert_fails(&output, 1, words);
    }
    let absent = folder.path().join("absent.toml").display().to_string();
    assert_fails(
        &on_cpu(&["plan", &ball, "--config", &absent]),
        1,
        "absent.toml",
    );
}

#[test]
fn files_are_named_from_where_the_file_of_settings_is() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let inside = |name: &str| folder.path().join("shop").join(name).display().to_string();
    std::fs::create_dir(folder.path().join("shop")).unwrap();
    assert!(
        cusp(&["saliency", &ball, "-o", &inside("ball.weights")])
            .status
            .success()
    );
    std::fs::write(inside("resin.json"), r#"{"exposure_s": 2.5}"#).unwrap();
    let own = r#"{"pixels": [300, 200], "pitch_um": [40, 40], "volume_mm": [12, 8, 20]}"#;
    std::fs::write(inside("printer.json"), own).unwrap();
    let settings =
        "weights = \"ball.weights\"\nresin = \"resin.json\"\nprinter = \"printer.json\"\n";
    std::fs::write(inside("cusp.toml"), settings).unwrap();
    let config = inside("cusp.toml");
    let report = json(&on_cpu(&["plan", &ball, "--config", &config, "--json"]));
    assert!(report["models"][0]["weights_crc32"].is_u64());
    assert_eq!(report["resin"]["exposure_s"], 2.5);
    assert_eq!(report["mask"]["width"], 300);

    // Printers by name are no files, and the command line has paths of its own.
    std::fs::write(
        inside("cusp.toml"),
        "printer = \"saturn-3-ultra\"\nresin = \"absent.json\"",
    )
    .unwrap();
    let output = on_cpu(&["plan", &ball, "--config", &config]);
    assert_fails(&output, 1, "absent.json");
    std::fs::write(inside("cusp.toml"), "printer = \"saturn-3-ultra\"").unwrap();
    let resin = inside("resin.json");
    let report = json(&on_cpu(&[
        "plan", &ball, "--config", &config, "--resin", &resin, "--json",
    ]));
    assert_eq!(report["printer"], "saturn-3-ultra");
    assert_eq!(report["resin"]["exposure_s"], 2.5);
}

#[test]
fn every_command_that_plans_takes_a_file_of_settings() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let config = model(&folder, "cusp.toml", b"layer_min_mm = 0.2\n");
    let print = folder.path().join("x.zip").display().to_string();
    let outlines = folder.path().join("x.svg").display().to_string();
    for command in ["slice", "plan", "tradeoff", "compare", "contours", "orient"] {
        let mut arguments = vec![command, &ball, "--config", &config];
        match command {
            "slice" => arguments.extend(["-o", &print]),
            "contours" => arguments.extend(["-o", &outlines]),
            _ => {}
        }
        assert_fails(&on_cpu(&arguments), 1, "is more than the greatest");
    }
}

#[test]
fn the_settings_of_the_page_are_read() {
    let folder = TempDir::new().unwrap();
    // A test of the page records it.
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cli/page.toml");
    let options = options(&folder, &["--config", config]);
    assert_eq!(options["printer"]["model"], "Cellar \"two\"");
    assert_eq!(options["layer_max_mm"], 0.12);
    assert_eq!(options["tolerance"], 0.12);
    assert_eq!(options["format"], "goo");
    assert_eq!(options["saliency"], true);
    assert_eq!(options["resin"]["bottom_layers"], 6);
}
