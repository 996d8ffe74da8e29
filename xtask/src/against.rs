//! `cargo xtask bench all --against REV`: the command line of this checkout against that of another revision, in one table.
//!
//! Both are driven as processes, since old revisions lack new benches. Rounds of both alternate, and a ratio is the median over
//! pairs of rounds, so that a machine that becomes slower meanwhile slows down both.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};
use clap::Parser;
use serde_json::Value;

use crate::{process, project::Project};

/// Arguments of `cargo xtask bench all`.
#[derive(Parser)]
#[command(name = "cargo xtask bench all")]
pub struct Arguments {
    /// The revision to compare with, as git names it
    #[arg(long, value_name = "REV")]
    against: String,
    /// Number of measured rounds
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// Models to measure in addition to the ball, as STL, OBJ or 3MF; they are scaled to 60 mm
    models: Vec<PathBuf>,
}

/// The print formats that hold masks.
const FORMATS: [&str; 9] = [
    "png",
    "chitubox",
    "uvj",
    "sl1",
    "goo",
    "photon-workshop",
    "anycubic-zip",
    "ctb",
    "nanodlp",
];
/// Commands without a file, by name.
const COMMANDS: [(&str, &str); 5] = [
    ("plan", "plan --json"),
    ("checks, masks included", "check --json"),
    ("plan with supports", "plan --supports medium"),
    ("plan of a hollow model", "plan --hollow 2 --drain auto"),
    (
        "orientation, 1,000 directions",
        "orient --json --directions 1000",
    ),
];
/// A 12K screen.
const SCREEN: &str = "--pixels 11520x5120 --pitch 0.019x0.024";
/// Stages of `plan --json` that have rows of their own, by their names in reports.
const STAGES: [(&str, &str); 4] = [
    ("load", "reading"),
    ("ldi", "LDI"),
    ("profile", "profile"),
    ("plan", "planner"),
];

/// A command to measure on a model.
struct Case {
    name: String,
    arguments: Vec<String>,
    /// The file that it writes, if it writes one.
    output: Option<PathBuf>,
}

/// Figures of one program, row by row: rounds of times in milliseconds.
#[derive(Default)]
struct Measured {
    whole_ms: Vec<f64>,
    stages_ms: [Vec<f64>; STAGES.len()],
    peak_mb: Vec<f64>,
    file_kb: Vec<f64>,
}

/// Builds the other revision and this checkout, measures both and prints a table.
pub fn run(project: &Project, arguments: &Arguments) -> Result<()> {
    let scratch = tempfile::tempdir()?;
    let programs = [
        built_at(project, &arguments.against)?,
        built_here(project, scratch.path())?,
    ];
    let ball = scratch.path().join("ball.stl");
    fs::write(&ball, self::ball(20.0, 199, 202))?;
    let cores = thread::available_parallelism().map_or(1, usize::from);
    println!(
        "Against {}: medians of {} alternating rounds on {cores} cores, on a 12K screen of 11520 × 5120 pixels of 19 × 24 µm\n",
        arguments.against, arguments.rounds,
    );
    println!(
        "| model | what | ms, before | now | before / now | MB of memory, before | now | before / now | KB of file, before | now | before / now |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for model in [&ball].into_iter().chain(&arguments.models) {
        let name = model.file_stem().unwrap_or_default().display();
        let height = if model == &ball { "" } else { " --height 60" };
        for case in cases(scratch.path(), model, height) {
            eprint!("{name}, {}:", case.name);
            let [before, now] = compare(&case, &programs, arguments.rounds)
                .with_context(|| format!("{name}, {}", case.name))?;
            eprintln!(" ms");
            let row = |what: &str, columns: [(&[f64], &[f64]); 3]| {
                let cells = columns.map(|(before, now)| triple(before, now));
                println!("| {name} | {what} | {} |", cells.join(" | "));
            };
            let none: (&[f64], &[f64]) = (&[], &[]);
            row(
                &case.name,
                [
                    (&before.whole_ms, &now.whole_ms),
                    (&before.peak_mb, &now.peak_mb),
                    (&before.file_kb, &now.file_kb),
                ],
            );
            let stages = before.stages_ms.iter().zip(&now.stages_ms).zip(STAGES);
            for ((before, now), (_, stage)) in stages.filter(|((_, now), _)| !now.is_empty()) {
                let what = format!("{}: {stage}", case.name);
                row(&what, [(before, now), none, none]);
            }
        }
    }
    Ok(())
}

/// The commands that are measured on a model.
fn cases(scratch: &Path, model: &Path, height: &str) -> Vec<Case> {
    let case = |name: &str, words: &str, output: Option<PathBuf>| {
        let words = format!("{words} {SCREEN}{height}");
        let mut arguments: Vec<String> = words.split(' ').map(str::to_owned).collect();
        arguments.push(model.display().to_string());
        if let Some(output) = &output {
            arguments.extend(["-o".to_owned(), output.display().to_string()]);
        }
        Case {
            name: name.to_owned(),
            arguments,
            output,
        }
    };
    let files = FORMATS.iter().map(|format| {
        let words = format!("slice --planner uniform --layer 0.05 --format {format}");
        let output = scratch.join(format!("out.{format}"));
        case(&format!("print file, `{format}`"), &words, Some(output))
    });
    let others = COMMANDS.iter().map(|(name, words)| case(name, words, None));
    files.chain(others).collect()
}

/// The program of another revision, built from a worktree with a target folder of its own, and kept.
fn built_at(project: &Project, revision: &str) -> Result<PathBuf> {
    let git = || {
        let mut git = process::command("git");
        git.current_dir(&project.root);
        git
    };
    let commit =
        process::output(git().args(["rev-parse", "--verify", &format!("{revision}^{{commit}}")]))?;
    let folder = project.target.join("against").join(&commit);
    let program = folder.join(program_name());
    if program.exists() {
        return Ok(program);
    }
    let source = folder.join("source");
    let build = folder.join("build");
    fs::create_dir_all(&folder)?;
    // `--force`: an interrupted run may have left one.
    let add = ["worktree", "add", "--force", "--detach"];
    process::run(git().args(add).arg(&source).arg(&commit))?;
    let result = process::run(
        process::cargo(project)
            .args(["build", "--release", "--locked", "--bin", "cusp"])
            .current_dir(&source)
            .env("CARGO_TARGET_DIR", &build),
    );
    process::run(git().args(["worktree", "remove", "--force"]).arg(&source))?;
    result?;
    fs::copy(build.join("release").join(program_name()), &program)?;
    fs::remove_dir_all(&build)?;
    Ok(program)
}

/// The program of this checkout. A copy, so that a build in the meantime changes nothing.
fn built_here(project: &Project, folder: &Path) -> Result<PathBuf> {
    process::run(process::cargo(project).args(["build", "--release", "--bin", "cusp"]))?;
    let program = folder.join(program_name());
    let built = project.target.join("release").join(program_name());
    fs::copy(built, &program)?;
    Ok(program)
}

fn program_name() -> String {
    format!("cusp{}", std::env::consts::EXE_SUFFIX)
}

/// Measures a case with both programs in turn. The first has no results if it fails: it may not know an option.
fn compare(case: &Case, programs: &[PathBuf; 2], rounds: u32) -> Result<[Measured; 2]> {
    let mut measured = [Measured::default(), Measured::default()];
    let mut lacks_it = false;
    // The first round warms up, and measures memory, which takes time.
    for side in 0..2 {
        match peak_megabytes(process::command(&programs[side]).args(&case.arguments)) {
            Ok(peak_mb) => measured[side].peak_mb.extend(peak_mb),
            Err(_) if side == 0 => lacks_it = true,
            Err(error) => return Err(error),
        }
    }
    for round in 0..rounds {
        let order = if round % 2 == 0 { [0, 1] } else { [1, 0] };
        for side in order {
            if side == 1 || !lacks_it {
                time(case, &programs[side], &mut measured[side])?;
            }
        }
    }
    Ok(measured)
}

/// Returns true if a command did its work. `cusp check` ends with 1 where it finds something to reject.
fn is_done(code: Option<i32>, output: &[u8]) -> bool {
    code == Some(0) || code == Some(1) && output.starts_with(b"{")
}

fn time(case: &Case, program: &Path, measured: &mut Measured) -> Result<()> {
    let clock = Instant::now();
    let output = process::command(program).args(&case.arguments).output()?;
    let whole_ms = clock.elapsed().as_secs_f64() * 1e3;
    if !is_done(output.status.code(), &output.stdout) {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    eprint!(" {whole_ms:.0}");
    measured.whole_ms.push(whole_ms);
    if let Some(file) = &case.output {
        measured
            .file_kb
            .push(fs::metadata(file)?.len() as f64 / 1e3);
    }
    let report: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    // Old revisions report a model without plates.
    let plate = report.pointer("/plates/0").unwrap_or(&report);
    for (stage, times) in STAGES.iter().zip(&mut measured.stages_ms) {
        times.extend(plate["timings_ms"][stage.0].as_f64());
    }
    Ok(())
}

/// The most memory that a command holds, in megabytes; none where the system does not say.
fn peak_megabytes(command: &mut Command) -> Result<Option<f64>> {
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut stdout = child.stdout.take().context("no output")?;
    // Read meanwhile, since a full pipe would stop it.
    let reader = thread::spawn(move || {
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut stdout, &mut bytes).map(|_| bytes)
    });
    let status = format!("/proc/{}/status", child.id());
    let mut peak_kb: Option<f64> = None;
    let exit = loop {
        if let Some(exit) = child.try_wait()? {
            break exit;
        }
        let text = fs::read_to_string(&status).unwrap_or_default();
        let peak = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kb = peak.and_then(|peak| peak.trim().trim_end_matches(" kB").parse().ok());
        peak_kb = kb.or(peak_kb);
        thread::sleep(Duration::from_micros(500));
    };
    let output = reader.join().ok().context("no output")??;
    if !is_done(exit.code(), &output) {
        bail!("{} failed ({exit})", command.get_program().display());
    }
    Ok(peak_kb.map(|kb| kb / 1e3))
}

/// Three cells: both medians, and the median of the ratios pair by pair.
fn triple(before: &[f64], now: &[f64]) -> String {
    let ratios: Vec<f64> = before.iter().zip(now).map(|(old, new)| old / new).collect();
    let cell = |values: &[f64], digits: usize| {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(sorted.len() / 2);
        median.map_or_else(|| "–".to_owned(), |median| format!("{median:.digits$}"))
    };
    [cell(before, 1), cell(now, 1), cell(&ratios, 2)].join(" | ")
}

/// A ball of `rings` × `columns` pairs of facets, as binary STL: 80,000 facets for the ball of `cargo xtask bench slice`.
fn ball(radius: f64, rings: u32, columns: u32) -> Vec<u8> {
    let point = |ring: u32, column: u32| {
        let polar = f64::from(ring) / f64::from(rings) * std::f64::consts::PI;
        let azimuth = f64::from(column % columns) / f64::from(columns) * std::f64::consts::TAU;
        // A pole is one point, whatever the column.
        let is_pole = ring == 0 || ring == rings;
        let around = if is_pole { 0.0 } else { polar.sin() };
        [around * azimuth.cos(), around * azimuth.sin(), polar.cos()].map(|it| (it * radius) as f32)
    };
    let mut facets = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let [a, b] = [point(ring, column), point(ring, column + 1)];
            let [c, d] = [point(ring + 1, column), point(ring + 1, column + 1)];
            facets.extend((ring > 0).then_some([a, c, b]));
            facets.extend((ring + 1 < rings).then_some([b, c, d]));
        }
    }
    let mut bytes = vec![0; 80];
    bytes.extend((facets.len() as u32).to_le_bytes());
    for corners in facets {
        // The normal follows from the corners.
        bytes.extend([0; 12]);
        bytes.extend(
            corners
                .as_flattened()
                .iter()
                .flat_map(|it| it.to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_the_median_over_pairs() {
        assert_eq!(
            triple(&[10.0, 40.0, 12.0], &[5.0, 10.0, 6.0]),
            "12.0 | 6.0 | 2.00"
        );
        assert_eq!(triple(&[], &[5.0]), "– | 5.0 | –");
    }

    #[test]
    fn the_ball_has_facets_enough() {
        let stl = ball(20.0, 199, 202);
        assert_eq!(stl.len(), 84 + 50 * 79_992);
    }
}
