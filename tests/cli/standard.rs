//! Standard input and output in place of files.

use std::fs::File;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use super::{assert_fails, cusp, json, names, sphere};

const QUICK: [&str; 4] = ["--pitch", "0.1", "--backend", "cpu"];

fn reading(path: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(arguments)
        .stdin(File::open(path).unwrap())
        .output()
        .unwrap()
}

#[test]
fn a_model_and_its_print_file_may_go_through_pipes() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let print = folder.path().join("ball.zip").display().to_string();
    let arguments = [&["slice", &ball, "-o", &print], &QUICK[..]].concat();
    let described = cusp(&arguments).stdout;
    let piped = reading(&ball, &[&["slice", "-", "-o", "-"], &QUICK[..]].concat());
    assert!(piped.status.success());
    assert!(piped.stdout == std::fs::read(&print).unwrap());
    // The words for people are on stderr, but for the time that it took.
    let words = |text: &[u8]| -> Vec<String> {
        let text = String::from_utf8(text.to_vec()).unwrap();
        let lines = text.lines().filter(|line| !line.starts_with("sampled"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(words(&piped.stderr), words(&described));
    assert_eq!(words(&piped.stderr).len(), 8);

    let report = json(&reading(
        &ball,
        &[&["plan", "-", "--json"], &QUICK[..]].concat(),
    ));
    assert!(report["layers"].as_u64().unwrap() > 10);
    let info = json(&reading(&ball, &["info", "-", "--json"]));
    assert_eq!(info, json(&cusp(&["info", &ball, "--json"])));

    let inspected = json(&reading(&print, &["inspect", "-", "--json"]));
    assert_eq!(inspected["layers"], report["layers"]);
    let converted = reading(&print, &["convert", "-", "-", "--format", "uvj"]);
    assert!(converted.status.success());
    let uvj = folder.path().join("ball.uvj").display().to_string();
    std::fs::write(&uvj, &converted.stdout).unwrap();
    let inspected = json(&cusp(&["inspect", &uvj, "--json"]));
    assert_eq!(
        (&inspected["format"], &inspected["layers"]),
        (&"uvj".into(), &report["layers"])
    );
    let weights = reading(&ball, &["saliency", "-", "-o", "-"]);
    assert!(weights.status.success() && weights.stdout.len() > 1000);
    assert_eq!(names(&folder), ["ball.stl", "ball.uvj", "ball.zip"]);
}

#[test]
fn two_things_on_one_stream_are_refused() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let json = ["slice", &ball, "-o", "-", "--json"];
    let mask = ["inspect", &ball, "--layer", "1", "-o", "-", "--json"];
    for arguments in [&json[..], &mask] {
        let output = cusp(arguments);
        assert_eq!(output.status.code(), Some(2));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(stderr.contains("both write to standard output"), "{stderr}");
    }
    for command in ["plan", "info", "orient"] {
        assert_fails(&reading(&ball, &[command, "-", "-"]), 2, "is one model");
    }
    // It has no name.
    let prints = folder.path().display().to_string();
    assert_fails(
        &reading(&ball, &["slice", "-", "-o", &prints]),
        1,
        "no name",
    );
}

#[test]
fn what_is_wrong_with_standard_input_is_said_of_it() {
    let output = Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(["plan", "-"])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_fails(&output, 1, "cusp: standard input: ");
}

#[cfg(target_os = "linux")]
#[test]
fn a_print_file_does_not_go_to_a_terminal() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let host = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&host).unwrap();
    unlockpt(&host).unwrap();
    let name = ptsname(&host, Vec::new()).unwrap();
    let terminal = File::options()
        .write(true)
        .open(name.to_str().unwrap())
        .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(["slice", &ball, "-o", "-"])
        .stdout(terminal)
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    assert_fails(&output, 1, "standard output: this is a terminal");
}
