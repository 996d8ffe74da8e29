//! `cargo xtask fuzz`: all fuzz targets, one after the other.

use std::{
    fmt::Write as _,
    fs::{self, File},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail, ensure};

use crate::{
    process::{self, command},
    project::Project,
    python,
    toolchain::nightly,
};

/// The target that takes longest for each input, and the part of the time that it gets, in shares of the others.
const SLOW: (&str, u32) = ("pipeline", 4);
/// Targets that take each byte for a decision. Comparisons that they make tell libFuzzer nothing, and watching them takes half of the time.
const DECIDING: [&str; 2] = ["inspect", "pipeline"];
/// Inputs that take longer than this, in seconds, are finds. None should take one, but the clock also runs while others work.
const MOST_S: u32 = 30;
/// Inputs that take more memory than this, in MB, are finds.
const MOST_MB: u32 = 2048;

/// What came of a target.
struct Outcome {
    target: String,
    executions: u64,
    elapsed: Duration,
    /// The input that broke it, if one did.
    found: Option<PathBuf>,
    /// How the run ended, if it did not end well.
    failure: Option<String>,
}

/// Runs the given targets, or all, for so many minutes together. Returns `false` if one found something.
///
/// # Errors
///
/// Fails if no target has one of the names, there is no nightly compiler, or the targets cannot be built.
pub fn run(project: &Project, minutes: f64, names: &[String]) -> Result<bool> {
    ensure!(minutes > 0.0, "{minutes} minutes are no time");
    let known = targets(&project.root.join("fuzz/fuzz_targets"))?;
    if let Some(unknown) = names.iter().find(|name| !known.contains(name)) {
        bail!(
            "no target is called {unknown}; they are: {}",
            known.join(", ")
        );
    }
    let chosen = known
        .into_iter()
        .filter(|target| names.is_empty() || names.contains(target));
    let chosen: Vec<(String, u32)> = chosen
        .map(|target| {
            let shares = if target == SLOW.0 { SLOW.1 } else { 1 };
            (target, shares)
        })
        .collect();
    let all: u32 = chosen.iter().map(|(_, shares)| shares).sum();

    let programs: Vec<PathBuf> = chosen
        .iter()
        .map(|(target, _)| build(project, target))
        .collect::<Result<_>>()?;
    let mut outcomes = Vec::new();
    for ((target, shares), program) in chosen.into_iter().zip(programs) {
        let seconds = minutes * 60.0 * f64::from(shares) / f64::from(all);
        outcomes.push(fuzz(project, &program, target, seconds.ceil() as u64)?);
    }
    print!("{}", table(&outcomes));
    Ok(outcomes.iter().all(|outcome| outcome.failure.is_none()))
}

/// The names of all targets.
fn targets(folder: &Path) -> Result<Vec<String>> {
    let files =
        fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names = Vec::new();
    for file in files {
        let path = file?.path();
        names.extend(
            path.file_stem()
                .map(|name| name.to_string_lossy().into_owned()),
        );
    }
    names.sort();
    Ok(names)
}

/// Builds a target. Returns its program.
fn build(project: &Project, target: &str) -> Result<PathBuf> {
    let version = process::output(nightly("rustc").arg("-vV")).unwrap_or_default();
    ensure!(
        version.contains("-nightly"),
        "fuzzing needs a nightly compiler: get it with `rustup toolchain install nightly --profile minimal`"
    );
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .context("the compiler does not say what it compiles for")?;
    let mut cargo_fuzz = nightly(cargo_fuzz(project)?);
    cargo_fuzz
        .current_dir(&project.root)
        // The library has no unsafe code, so a sanitizer would find little, and halve the speed.
        .args(["fuzz", "build", target, "--sanitizer", "none"]);
    // Dependencies compiled in two ways overwrite each other in one folder.
    let folder = if DECIDING.contains(&target) {
        cargo_fuzz.arg("--no-trace-compares");
        "fuzz-plain"
    } else {
        "fuzz"
    };
    let folder = project.target.join(folder);
    process::run(cargo_fuzz.arg("--target-dir").arg(&folder))?;
    Ok(folder.join(host).join("release").join(target))
}

/// cargo-fuzz: the one that is installed, or from a list with hashes.
fn cargo_fuzz(project: &Project) -> Result<PathBuf> {
    if let Ok(installed) = which::which("cargo-fuzz") {
        return Ok(installed);
    }
    python::program(project, "cargo-fuzz")
        .context("cargo-fuzz is missing: get it with `cargo install cargo-fuzz`")
}

/// Runs one target. Its corpus is kept for the next time, beside what it prints.
fn fuzz(project: &Project, program: &Path, target: String, seconds: u64) -> Result<Outcome> {
    let kept = project.target.join("fuzz/kept").join(&target);
    let corpus = kept.join("corpus");
    let found = kept.join("found");
    for folder in [&corpus, &found] {
        fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    }
    let path = kept.join("log.txt");
    let log = File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
    eprintln!("{target}: {seconds} s");
    let started = Instant::now();
    let status = command(program)
        .arg(&corpus)
        .arg(project.root.join("fuzz/seeds").join(&target))
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-timeout={MOST_S}"))
        .arg(format!("-rss_limit_mb={MOST_MB}"))
        .arg(format!("-artifact_prefix={}/", found.display()))
        .arg("-print_final_stats=1")
        .stdout(log.try_clone()?)
        .stderr(log)
        .status()
        .with_context(|| format!("cannot start {target}"))?;
    let text = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let text = String::from_utf8_lossy(&text);
    Ok(Outcome {
        executions: executions(&text).unwrap_or_default(),
        elapsed: started.elapsed(),
        found: found_input(&text),
        failure: (!status.success()).then(|| format!("{status}; see {}", path.display())),
        target,
    })
}

/// The number of inputs that were run, as libFuzzer prints it at the end.
fn executions(log: &str) -> Option<u64> {
    let mut lines = log.lines().rev();
    let number = lines.find_map(|line| line.strip_prefix("stat::number_of_executed_units:"))?;
    number.trim().parse().ok()
}

/// The input that broke the target, as libFuzzer prints where it is.
fn found_input(log: &str) -> Option<PathBuf> {
    let mut lines = log.lines();
    let path = lines.find_map(|line| line.split_once("Test unit written to "))?;
    Some(path.1.trim().into())
}

/// A table of the targets, and what they found.
fn table(outcomes: &[Outcome]) -> String {
    let mut text = format!(
        "\n{:<12}{:>14}{:>10}{:>10}\n",
        "target", "executions", "time", "a second"
    );
    let mut line = |words: std::fmt::Arguments<'_>| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{words}");
    };
    for outcome in outcomes {
        let seconds = outcome.elapsed.as_secs_f64();
        line(format_args!(
            "{:<12}{:>14}{seconds:>9.0}s{:>10.0}",
            outcome.target,
            outcome.executions,
            outcome.executions as f64 / seconds.max(1e-3),
        ));
    }
    for Outcome {
        target,
        found,
        failure,
        ..
    } in outcomes
    {
        let Some(failure) = failure else {
            continue;
        };
        match found {
            Some(path) => line(format_args!(
                "failed: {target}: {}\n  Put it into fuzz/seeds/{target}/ and `cargo test --test main fuzz::` replays it.",
                path.display()
            )),
            None => line(format_args!("failed: {target}: {failure}")),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str = "\
INFO: Running with entropic power schedule (0xFF, 100).
#131072\tpulse  cov: 1200 ft: 3400 corp: 210/9Kb exec/s: 43690 rss: 61Mb
thread '<unnamed>' panicked at src/lib.rs:1:1
artifact_prefix='/a/'; Test unit written to /a/crash-0123
Base64: AAA=
stat::number_of_executed_units: 140001
stat::average_exec_per_sec:     43000
";

    #[test]
    fn a_log_says_how_many_inputs_ran_and_which_one_failed() {
        assert_eq!(executions(LOG), Some(140_001));
        assert_eq!(found_input(LOG), Some("/a/crash-0123".into()));
        assert_eq!(executions(""), None);
        assert_eq!(found_input("stat::number_of_executed_units: 5"), None);
    }

    #[test]
    fn the_table_names_what_was_found() {
        let outcome = |found: Option<&str>, failure: Option<&str>| Outcome {
            target: "model".into(),
            executions: 3000,
            elapsed: Duration::from_secs(2),
            found: found.map(Into::into),
            failure: failure.map(Into::into),
        };
        let text = table(&[
            outcome(None, None),
            outcome(Some("/a/crash-0123"), Some("signal")),
        ]);
        assert!(
            text.contains("\nmodel                 3000        2s      1500\n"),
            "{text}"
        );
        assert!(text.contains("failed: model: /a/crash-0123\n"), "{text}");
        assert!(!table(&[outcome(None, None)]).contains("failed"));
    }
}
