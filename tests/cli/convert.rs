//! `convert`.

use std::fs;

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, names, on_cpu, sphere};

/// A ball, 3 mm high, sliced for a printer that reads GOO.
fn print_file(folder: &TempDir) -> String {
    let print = folder.path().join("print.goo").display().to_string();
    let ball = sphere(folder);
    let options = ["--printer", "mars-4-ultra", "--height", "3"];
    let sliced = on_cpu(&[&["slice", &ball, "-o", &print][..], &options].concat());
    assert!(sliced.status.success());
    print
}

#[test]
fn a_print_file_becomes_one_of_another_format() {
    let folder = TempDir::new().unwrap();
    let print = print_file(&folder);
    let old = json(&cusp(&["inspect", &print, "--json"]));
    let layers = |found: &serde_json::Value| -> Vec<_> {
        let layers = found["layer_values"].as_array().unwrap().iter();
        let values = |layer: &serde_json::Value| {
            ["z_mm", "exposure_s", "lit_pixels"].map(|key| layer[key].clone())
        };
        layers.map(values).collect()
    };
    for (name, options, format) in [
        ("a.zip", &[][..], "png"),
        ("b.zip", &["--format", "chitubox"], "chitubox"),
        ("c.ctb", &[], "ctb"),
        ("d.PRZ", &[], "goo"),
        // The printer's format, if the extension decides nothing.
        ("e.file", &[], "goo"),
        ("f.zip", &["--printer", "mars-4-ultra"], "goo"),
    ] {
        let new = folder.path().join(name).display().to_string();
        let output = cusp(&[&["convert", &print, &new], options].concat());
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{name}");
        let says = String::from_utf8(output.stdout).unwrap();
        let start = format!(
            "{new}: {format} for the Elegoo Mars 4 Ultra, {} layers",
            old["layers"]
        );
        assert!(says.starts_with(&start), "{says}");
        let found = json(&cusp(&["inspect", &new, "--json"]));
        assert_eq!(found["format"], format, "{name}");
        assert_eq!(found["warnings"], serde_json::json!([]), "{name}");
        assert_eq!(layers(&found), layers(&old), "{name}");
    }
    // With another resin, the same masks have other exposures.
    let resin = model(
        &folder,
        "resin.json",
        br#"{"bottom_layers": 1, "exposures": [[0.05, 7.5]]}"#,
    );
    let slower = folder.path().join("slower.goo").display().to_string();
    assert!(
        cusp(&["convert", &print, &slower, "--resin", &resin])
            .status
            .success()
    );
    let found = json(&cusp(&["inspect", &slower, "--json"]));
    assert_eq!(found["exposure_range_s"], serde_json::json!([7.5, 30.0]));
    // Of exposures that are measured for thinner layers alone, its own are no measurement.
    let measured = model(
        &folder,
        "measured.json",
        br#"{"bottom_layers": 1, "exposures": [[0.02, 4], [0.03, 5]]}"#,
    );
    let output = cusp(&["convert", &print, &slower, "--resin", &measured, "--json"]);
    let says = String::from_utf8(output.stderr.clone()).unwrap();
    assert!(says.contains("is extrapolated"), "{says}");
    let warnings = &json(&output)["warnings"];
    assert_eq!(warnings.as_array().map(Vec::len), Some(1));
    assert_eq!(warnings[0]["code"], "extrapolated-exposures");
    assert_eq!(warnings[0]["detail"]["thickest_mm"], 0.03);
}

#[test]
fn what_cannot_be_converted_leaves_no_file() {
    let folder = TempDir::new().unwrap();
    let print = print_file(&folder);
    let new = folder.path().join("new.goo").display().to_string();
    let fails = |arguments: &[&str], words: &str| {
        assert_fails(&cusp(&[&["convert"], arguments].concat()), 1, words);
    };
    fails(&[&print, &print], "is the print file to read itself");
    fails(&["absent.goo", &new], "absent.goo");
    fails(&[&print, &new, "--printer", "mars-9"], "no printer mars-9");
    fails(
        &[&print, &new, "--printer", "saturn-2"],
        "slice the model for that printer",
    );
    fails(
        &[&print, &new, "--format", "sl1"],
        "one exposure above the bottom layers",
    );
    let no_masks = "hold a model and its layers, and no masks; slice the model itself";
    for format in ["prusa-3mf", "orca-3mf"] {
        fails(&[&print, &new, "--format", format], no_masks);
    }
    let ball = folder.path().join("ball.stl").display().to_string();
    fails(&[&ball, &new], "it is no print file");
    let half = fs::read(&print).unwrap();
    let half = model(&folder, "half.goo", &half[..half.len() / 2]);
    fails(&[&half, &new], "cut short");
    assert_eq!(names(&folder), ["ball.stl", "half.goo", "print.goo"]);
}

#[test]
fn a_model_with_layers_is_no_print_file_and_every_command_says_so() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let [filament, new] =
        ["ball.3mf", "new.goo"].map(|name| folder.path().join(name).display().to_string());
    let words = "ball.3mf: it is a 3MF model with layers for slicers of filament printers, not a print file: it has no masks; \
                 open it in that slicer, or slice it here for a resin printer";
    for format in ["prusa-3mf", "orca-3mf"] {
        let sliced = on_cpu(&["slice", &ball, "-o", &filament, "--format", format]);
        assert!(sliced.status.success());
        for arguments in [
            &["inspect", &filament][..],
            &["simulate", &ball, &filament],
            &["convert", &filament, &new],
        ] {
            assert_fails(&cusp(arguments), 1, words);
        }
    }
    assert_eq!(names(&folder), ["ball.3mf", "ball.stl"]);
}
