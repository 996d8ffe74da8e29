//! Interrupts from a terminal.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::{model, names};
use crate::common::{binary_stl, solids};

/// The command with default signal handling, as from a terminal. A program that runs the tests in the background may
/// ignore interrupts, and children inherit that.
fn with_default_signals() -> Command {
    let cusp = env!("CARGO_BIN_EXE_cusp");
    if cfg!(target_os = "linux") {
        let mut command = Command::new("env");
        command.args(["--default-signal", cusp]);
        command
    } else {
        Command::new(cusp)
    }
}

/// Options of tens of thousands of layers, which take many seconds to write.
const MANY_LAYERS: [&str; 8] = [
    "--planner",
    "uniform",
    "--layer",
    "0.0005",
    "--bin",
    "0.0005",
    "--layer-min",
    "0.0005",
];

/// Interrupts a process, as a terminal does.
fn interrupt(child: &Child) {
    let process = child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &process]).status();
    assert!(kill.unwrap().success());
}

#[test]
fn an_interrupt_stops_a_batch_in_which_a_model_is_bad() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 5)));
    let absent = folder.path().join("absent.stl").display().to_string();
    // This search takes minutes.
    let mut child = with_default_signals()
        .args(["orient", &absent, &ball, &ball, "--directions", "20000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut words = BufReader::new(child.stderr.take().unwrap()).lines();
    let first = words.next().unwrap().unwrap();
    assert!(first.contains("absent.stl"), "{first}");
    interrupt(&child);
    let rest: Vec<String> = words.map(Result::unwrap).collect();
    assert_eq!(rest, ["cusp: cancelled"]);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(output.stdout.is_empty());
}

/// Waits until a process handles interrupts itself.
#[cfg(target_os = "linux")]
fn wait_for_its_handler(child: &mut Child) {
    const INTERRUPT: u64 = 1 << 1;
    let clock = Instant::now();
    loop {
        assert!(clock.elapsed() < Duration::from_mins(2), "no handler");
        assert_eq!(child.try_wait().unwrap(), None, "ended too soon");
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = caught.and_then(|caught| u64::from_str_radix(caught.trim(), 16).ok());
        if caught.is_some_and(|caught| caught & INTERRUPT != 0) {
            return;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_stops_long_work_that_writes_nothing() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 6)));
    let print = folder.path().join("print.zip").display().to_string();
    let sliced = Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(["slice", &ball, "-o", &print, "--backend", "cpu"])
        .output();
    assert!(sliced.unwrap().status.success());
    // Masks of a 12K screen as bytes: they take seconds to unpack.
    let large = folder.path().join("large.zip").display().to_string();
    let sliced = Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(["slice", &ball, "-o", &large, "--backend", "cpu"])
        .args(["--printer", "saturn-4-ultra-12k", "--format", "chitubox"])
        .args(["--planner", "uniform", "--layer", "0.02"])
        .output();
    assert!(sliced.unwrap().status.success());
    let copy = folder.path().join("copy.goo").display().to_string();
    let works: [&[&str]; 5] = [
        &["simulate", &ball, &print],
        &["inspect", &large],
        &["convert", &large, &copy],
        // Six thicknesses take minutes.
        &[
            "plan",
            &ball,
            "--max-thicknesses",
            "6",
            "--backend",
            "cpu",
            "--height",
            "60",
        ],
        // A search for a tolerance among a million bins reports no progress, and takes hours.
        &[
            "plan",
            &ball,
            "--metric",
            "volume",
            "--max-layers",
            "1000",
            "--bin",
            "0.00002",
            "--layer-min",
            "0.00002",
            "--layer-max",
            "1000",
            "--pitch",
            "0.3",
            "--backend",
            "cpu",
        ],
    ];
    for work in works {
        let mut child = with_default_signals()
            .args(work)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_its_handler(&mut child);
        // Into the work itself.
        std::thread::sleep(Duration::from_millis(300));
        interrupt(&child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "cusp: cancelled\n");
        assert_eq!(output.status.code(), Some(130), "{work:?}");
        assert!(output.stdout.is_empty());
    }
    assert!(!Path::new(&copy).exists());
}

/// Returns true if a process has begun to write a file in a folder, which need not have a name yet.
fn is_writing(child: &Child, folder: &TempDir) -> bool {
    let open = format!("/proc/{}/fd", child.id());
    // Elsewhere it has a name.
    let place = if Path::new(&open).exists() {
        Path::new(&open)
    } else {
        folder.path()
    };
    std::fs::read_dir(place).is_ok_and(|mut files| {
        files.any(|file| {
            let path = file.unwrap().path();
            let target = path.read_link().unwrap_or_else(|_| path.clone());
            let is_output = target.starts_with(folder.path())
                && target.extension().is_none_or(|it| it != "stl");
            is_output && std::fs::metadata(&path).is_ok_and(|file| file.len() > 0)
        })
    })
}

fn wait_until_it_writes(child: &mut Child, folder: &TempDir) {
    let clock = Instant::now();
    while !is_writing(child, folder) {
        assert!(clock.elapsed() < Duration::from_mins(2), "never wrote");
        assert_eq!(child.try_wait().unwrap(), None, "ended before it wrote");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn an_interrupt_leaves_the_old_file_and_no_other() {
    let folder = TempDir::new().unwrap();
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 4)));
    let zip = model(&folder, "out.zip", b"precious");
    let mut child = with_default_signals()
        .args(["slice", &ball, "-o", &zip, "--backend", "cpu"])
        .args(MANY_LAYERS)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until_it_writes(&mut child, &folder);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "cusp: cancelled\n");
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(names(&folder), ["ball.stl", "out.zip"]);
    assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
}

#[test]
fn an_interrupted_batch_leaves_whole_files_alone() {
    let folder = TempDir::new().unwrap();
    let small = model(&folder, "small.stl", &binary_stl(&solids::cube(1.0)));
    let ball = model(&folder, "ball.stl", &binary_stl(&solids::sphere(10.0, 4)));
    let other = model(&folder, "other.stl", &binary_stl(&solids::sphere(9.0, 4)));
    let prints = folder.path().join("prints");
    std::fs::create_dir(&prints).unwrap();
    // The small one takes a moment, the others many seconds.
    let mut child = with_default_signals()
        .args(["slice", &small, &ball, &other, "--json", "--backend", "cpu"])
        .arg("-o")
        .arg(&prints)
        .args(MANY_LAYERS)
        .args(["--pitch", "0.02"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Its line comes once it is done.
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let line = lines.next().unwrap().unwrap();
    assert!(line.contains("small.zip"), "{line}");
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "cusp: cancelled\n");
    assert_eq!(output.status.code(), Some(130));
    assert!(lines.next().is_none());
    let files = std::fs::read_dir(&prints).unwrap();
    let files: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
    assert_eq!(files, ["small.zip"]);
}

#[test]
#[cfg(target_os = "linux")]
fn where_a_hang_up_is_ignored_an_end_still_tidies_up() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(20.0)));
    let zip = folder.path().join("out.zip").display().to_string();
    let mut child = Command::new("env")
        .args([
            "--default-signal",
            "--ignore-signal=HUP",
            env!("CARGO_BIN_EXE_cusp"),
        ])
        .args(["slice", &cube, "-o", &zip, "--backend", "cpu"])
        .args(MANY_LAYERS)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until_it_writes(&mut child, &folder);
    let process = child.id().to_string();
    for (signal, ends) in [("-HUP", false), ("-TERM", true)] {
        let kill = Command::new("kill").args([signal, &process]).status();
        assert!(kill.unwrap().success());
        if !ends {
            std::thread::sleep(Duration::from_millis(300));
            assert_eq!(child.try_wait().unwrap(), None, "a hang-up ended it");
        }
    }
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(names(&folder), ["cube.stl"]);
}

#[test]
#[cfg(target_os = "linux")]
fn nothing_is_left_of_a_command_that_is_killed() {
    let folder = TempDir::new().unwrap();
    let cube = model(&folder, "cube.stl", &binary_stl(&solids::cube(20.0)));
    let zip = model(&folder, "out.zip", b"precious");
    let mut child = Command::new(env!("CARGO_BIN_EXE_cusp"))
        .args(["slice", &cube, "-o", &zip, "--backend", "cpu"])
        .args(MANY_LAYERS)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until_it_writes(&mut child, &folder);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(names(&folder), ["cube.stl", "out.zip"]);
    assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
}
