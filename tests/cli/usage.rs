//! Help, exit codes and stderr.

use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, model, on_cpu, sphere};
use crate::common::{binary_stl, solids};

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
fn bad_usage_is_json_for_programs() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    for (arguments, words) in [
        (
            &["plan", &ball, "--json", "--tolerence", "1"][..],
            "unexpected argument '--tolerence' found",
        ),
        (
            &["slice", "--json"],
            "required arguments were not provided: --output",
        ),
        (
            &["slice", &ball, "-o", "-", "--json"],
            "would both write to standard output",
        ),
    ] {
        let output = cusp(arguments);
        assert_eq!(output.status.code(), Some(2));
        let failed: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(failed["error"]["code"], "usage");
        let message = failed["error"]["message"].as_str().unwrap();
        assert!(message.contains(words), "{message}");
    }
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
    assert_fails(
        &cusp(&["plan", &ball, "--tolerance", "NaN"]),
        2,
        "0 or more",
    );
    assert_fails(&cusp(&["plan", &ball, "--metric", "beauty"]), 2, "cusp");
    assert_fails(&cusp(&["plan", &ball, "--range", "0:5"]), 2, "0:5=0.1:0.1");
    let two = ["plan", &ball, "--tolerance", "1", "--max-layers", "9"];
    assert_fails(&cusp(&two), 2, "cannot be used with");
    assert_fails(&cusp(&["tradeoff", &ball, "--points", "1"]), 2, "--points");
    let layer = ["plan", &ball, "--planner", "uniform", "--layer", "thin"];
    assert_fails(&cusp(&layer), 2, "finest");
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
        (b"a poem about a cube", "not a model that Cusp can read"),
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
        "is more than the greatest",
    );
}

#[test]
fn a_file_of_another_kind_is_named() {
    let folder = TempDir::new().unwrap();
    let head = b"ISO-10303-21;\nHEADER;\n";
    let model = model(&folder, "part.stl", head);
    let said = "this is a STEP file, which Cusp does not read; export the model as STL, 3MF or OBJ";
    for command in ["info", "plan", "orient"] {
        assert_fails(&cusp(&[command, &model]), 1, said);
    }
}

/// Without a display, Mesa would complain on stderr although none is needed.
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
                // There may be neither a GPU nor a driver that emulates one.
                _ => assert!(
                    backend == "gpu" && words.contains("no usable GPU"),
                    "{words}"
                ),
            }
            assert!(words.lines().count() <= 1, "{words}");
        }
    }
    // Cusp's own messages still get through after the search.
    let (code, words) = without_display(&["plan", &open, "--backend", "auto"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(!words.is_empty());
    for line in words.lines() {
        assert!(line.starts_with("cusp: warning: "), "{words}");
    }
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
