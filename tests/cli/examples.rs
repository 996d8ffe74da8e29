//! The commands of docs/cli.md, run as they stand there.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use tempfile::TempDir;

use crate::common::{binary_stl, solids};
use crate::read::package;

const CLI: &str = include_str!("../../docs/cli.md");

/// The commands: lines of code that begin with `cusp`, some after a prompt, without comments. Those that write into system folders
/// are left out.
fn commands() -> Vec<&'static str> {
    let code = CLI.lines().filter_map(|line| line.strip_prefix("    "));
    let commands = code.filter_map(|line| {
        let line = line.strip_prefix("$ ").unwrap_or(line);
        line.starts_with("cusp ").then_some(line)
    });
    let without_comments = commands.map(|it| it.split(" #").next().unwrap_or(it).trim_end());
    without_comments
        .filter(|it| !it.contains("/usr/"))
        .collect()
}

/// Runs a line of a shell in a folder.
fn run(line: &str, folder: &Path) -> Result<(), String> {
    let program = Path::new(env!("CARGO_BIN_EXE_cusp")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell
        .args(["-c", line])
        .current_dir(folder)
        .env("PATH", path);
    let output = shell.output().unwrap();
    if output.status.success() {
        return Ok(());
    }
    Err(format!(
        "{line}: {}",
        String::from_utf8_lossy(&output.stderr)
    ))
}

/// The files that the commands name.
fn fill(folder: &Path) {
    let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).unwrap();
    let cone = solids::cone(6.0, 5.0, 16);
    for name in ["model", "body", "ring", "spot", "stanford-bunny"] {
        write(&format!("{name}.stl"), &binary_stl(&cone));
    }
    write("knob.3mf", &package::of(&solids::cone(3.0, 4.0, 16)));
    write("resin.json", br#"{ "exposure_s": 2.5 }"#);
    let prices =
        br#"{ "currency": "EUR", "setup": 5, "finishes": [{ "name": "sanded", "per_copy": 2 }] }"#;
    write("prices.json", prices);
    write("cusp.toml", b"layer_min_mm = 0.05\nrays = 512\n");
    for line in [
        "cusp slice model.stl -o model.zip --json > plan.json",
        "cusp slice stanford-bunny.stl -o bunny.zip",
        "cusp slice model.stl --printer mars-4-ultra -o print.goo && cp print.goo plate.goo",
    ] {
        run(line, folder).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn the_commands_of_the_document_run_as_they_stand_there() {
    let folder = TempDir::new().unwrap();
    fill(folder.path());
    let commands = commands();
    assert!(commands.len() > 25, "{commands:?}");
    let next = AtomicUsize::new(0);
    let work = || -> Result<(), String> {
        while let Some(line) = commands.get(next.fetch_add(1, Ordering::Relaxed)) {
            let own = TempDir::new().unwrap();
            for file in fs::read_dir(folder.path()).unwrap() {
                let file = file.unwrap();
                fs::copy(file.path(), own.path().join(file.file_name())).unwrap();
            }
            run(line, own.path())?;
        }
        Ok(())
    };
    thread::scope(|scope| {
        let both = [scope.spawn(work), scope.spawn(work)];
        for result in both {
            result.join().unwrap().unwrap();
        }
    });
}
