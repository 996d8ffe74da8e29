//! `cargo xtask fuzz`: all fuzz targets, one after the other, by cargo-fuzz.

use std::{fs, path::Path};

use anyhow::{Context, Result, bail, ensure};

use crate::{
    process::{self, nightly},
    project::Project,
    python,
};

/// The target that takes longest for each input, and the part of the time that it gets, in shares of the others.
const SLOW: (&str, f64) = ("pipeline", 4.0);
/// Targets that take each byte for a decision. Their comparisons give libFuzzer no guidance, and watching them takes
/// half of the time.
const DECIDING: [&str; 2] = ["inspect", "pipeline"];

/// Runs the given targets, or all, for `minutes` together. Returns `false` if one found something.
pub fn run(project: &Project, minutes: f64, names: &[String]) -> Result<bool> {
    let mut targets = Vec::new();
    for file in fs::read_dir(project.root.join("fuzz/fuzz_targets"))? {
        let path = file?.path();
        targets.push(path.file_stem().unwrap_or_default().display().to_string());
    }
    targets.sort();
    if let Some(unknown) = names.iter().find(|name| !targets.contains(name)) {
        let known = targets.join(", ");
        bail!("no target is called {unknown}; they are: {known}");
    }
    targets.retain(|target| names.is_empty() || names.contains(target));
    ensure!(
        process::output(nightly("rustc").arg("--version")).is_ok(),
        "fuzzing needs a nightly compiler: get it with `rustup toolchain install nightly --profile minimal`"
    );
    let cargo_fuzz = which::which("cargo-fuzz").or_else(|_| python::program(project, "cargo-fuzz"));
    let cargo_fuzz =
        cargo_fuzz.context("cargo-fuzz is missing: get it with `cargo install cargo-fuzz`")?;

    let share = |target: &str| if target == SLOW.0 { SLOW.1 } else { 1.0 };
    let all: f64 = targets.iter().map(|target| share(target)).sum();
    let mut failed = Vec::new();
    for target in &targets {
        let seconds = (minutes * 60.0 * share(target) / all).ceil();
        if let Err(error) = fuzz(project, &cargo_fuzz, target, seconds) {
            eprintln!("{error:#}");
            failed.push(target.as_str());
        }
    }
    if !failed.is_empty() {
        println!(
            "failed: {}. Put the input that cargo-fuzz names into fuzz/seeds/TARGET/, and `cargo test --test main fuzz` replays it.",
            failed.join(", ")
        );
    }
    Ok(failed.is_empty())
}

/// Runs one target. Its corpus is kept for the next time.
fn fuzz(project: &Project, cargo_fuzz: &Path, target: &str, seconds: f64) -> Result<()> {
    let corpus = project.target.join("fuzz/corpus").join(target);
    fs::create_dir_all(&corpus).with_context(|| corpus.display().to_string())?;
    let mut command = nightly(cargo_fuzz);
    command
        .current_dir(&project.root)
        // The library has no unsafe code, so a sanitizer would find little, and halve the speed.
        .args(["fuzz", "run", target, "--sanitizer", "none"]);
    // Dependencies compiled in two ways overwrite each other in one folder.
    let folder = if DECIDING.contains(&target) {
        command.arg("--no-trace-compares");
        "fuzz-plain"
    } else {
        "fuzz"
    };
    process::run(
        command
            .arg("--target-dir")
            .arg(project.target.join(folder))
            .arg(corpus)
            .arg(project.root.join("fuzz/seeds").join(target))
            .arg("--")
            .arg(format!("-max_total_time={seconds}"))
            // Inputs that take longer, in seconds, or more memory, in MB, are finds.
            .args(["-timeout=30", "-rss_limit_mb=2048", "-print_final_stats=1"]),
    )
}
