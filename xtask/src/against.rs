//! `cargo xtask bench all --against REV`: the command line of this checkout against that of another revision, in one table.
//!
//! Both are driven as processes, since old revisions lack new benches. Rounds of both alternate, and the ratio of a row is the median over
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
use tempfile::TempDir;

use crate::{process, project::Project};

/// What `cargo xtask bench all` takes.
#[derive(Parser)]
#[command(name = "cargo xtask bench all")]
pub struct Arguments {
    /// The revision to compare with, as git names it
    #[arg(long, value_name = "REV")]
    against: String,
    /// How often each is measured
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// Models to measure beside the ball, as STL, OBJ or 3MF; they are scaled to 60 mm
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
/// A 12K screen.
const SCREEN: [&str; 4] = ["--pixels", "11520x5120", "--pitch", "0.019x0.024"];
/// Stages of a plan, by their names in reports.
const STAGES: [(&str, &str); 4] = [
    ("load", "reading"),
    ("ldi", "LDI"),
    ("profile", "profile"),
    ("plan", "planner"),
];

/// A command to measure.
struct Case {
    /// What the rows say.
    name: String,
    /// Its arguments, without model and output.
    arguments: Vec<String>,
    /// The end of the name of the file that it writes, if it writes one.
    output: Option<String>,
    /// Stages with rows of their own.
    stages: &'static [(&'static str, &'static str)],
}

impl Case {
    fn new(name: &str, arguments: &[&str]) -> Self {
        let all = arguments.iter().chain(&SCREEN);
        Self {
            name: name.to_owned(),
            arguments: all.map(|&it| it.to_owned()).collect(),
            output: None,
            stages: &[],
        }
    }

    /// The commands that are measured on every model.
    fn all() -> Vec<Self> {
        let uniform = ["slice", "--planner", "uniform", "--layer", "0.05"];
        let slice = |format: &&str| {
            let arguments = [&uniform[..], &["--format", format]].concat();
            let name = format!("print file, `{format}`");
            Self {
                output: Some((*format).to_owned()),
                ..Self::new(&name, &arguments)
            }
        };
        let plan = Self {
            stages: &STAGES,
            ..Self::new("plan", &["plan", "--json"])
        };
        let mut cases: Vec<Self> = FORMATS.iter().map(slice).collect();
        cases.extend([
            plan,
            Self::new("checks, masks included", &["check", "--json"]),
            Self::new("plan with supports", &["plan", "--supports", "medium"]),
            Self::new(
                "plan of a hollow model",
                &["plan", "--hollow", "2", "--drain", "auto"],
            ),
            Self::new(
                "orientation, 1,000 directions",
                &["orient", "--json", "--directions", "1000"],
            ),
        ]);
        cases
    }
}

/// A model to measure, and the options that it needs.
struct Model {
    name: String,
    path: PathBuf,
    options: &'static [&'static str],
}

/// What one run took: as a whole process, and in each stage of the case. In milliseconds.
struct Run {
    whole_ms: f64,
    stages_ms: Vec<f64>,
    /// Length of the file that it wrote.
    file_bytes: Option<u64>,
}

/// What was measured of a case with one of the two programs.
#[derive(Default)]
struct Measured {
    runs: Vec<Run>,
    peak_mb: Option<f64>,
}

/// Builds the other revision and this checkout, measures both and prints a table.
///
/// # Errors
///
/// Fails when one cannot be built, or this checkout's program fails.
pub fn run(project: &Project, arguments: &Arguments) -> Result<()> {
    let scratch = TempDir::with_prefix("cusp-bench-")?;
    let before = built_at(project, &arguments.against)?;
    let now = built_here(project, scratch.path())?;
    let mut models = vec![Model {
        name: "ball".into(),
        path: scratch.path().join("ball.stl"),
        options: &[],
    }];
    fs::write(&models[0].path, ball(20.0, 199, 202))?;
    for path in &arguments.models {
        models.push(Model {
            name: path.file_stem().unwrap_or_default().display().to_string(),
            path: path.clone(),
            options: &["--height", "60"],
        });
    }
    println!(
        "Against {}: medians of {} alternating rounds on {} cores, on a 12K screen of 11520 × 5120 pixels of 19 × 24 µm\n",
        arguments.against,
        arguments.rounds,
        thread::available_parallelism().map_or(1, usize::from),
    );
    println!(
        "| model | what | ms, before | now | before / now | MB of memory, before | now | before / now | KB of file, before | now | before / now |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for model in &models {
        for case in Case::all() {
            let compared = compare(
                &case,
                model,
                [&before, &now],
                arguments.rounds,
                scratch.path(),
            )
            .with_context(|| format!("{}, {}", model.name, case.name))?;
            for row in rows(&case, &model.name, &compared) {
                println!("{row}");
            }
        }
    }
    Ok(())
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
    if source.exists() {
        // Left by a run that was interrupted.
        process::run(git().args(["worktree", "remove", "--force"]).arg(&source))?;
    }
    process::run(
        git()
            .args(["worktree", "add", "--detach"])
            .args([&source])
            .arg(&commit),
    )?;
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
    fs::copy(
        project.target.join("release").join(program_name()),
        &program,
    )?;
    Ok(program)
}

fn program_name() -> String {
    format!("cusp{}", std::env::consts::EXE_SUFFIX)
}

/// Measures a case with both programs in turn. There is nothing of the first where it fails: it may not know an option.
fn compare(
    case: &Case,
    model: &Model,
    programs: [&Path; 2],
    rounds: u32,
    scratch: &Path,
) -> Result<[Measured; 2]> {
    let mut measured = [Measured::default(), Measured::default()];
    let command = |program: &Path| {
        let mut command = process::command(program);
        command
            .args(&case.arguments)
            .args(model.options)
            .arg(&model.path);
        if let Some(end) = &case.output {
            command.arg("-o").arg(scratch.join(format!("out.{end}")));
        }
        command
    };
    let written = case
        .output
        .as_ref()
        .map(|end| scratch.join(format!("out.{end}")));
    eprint!("{}, {}:", model.name, case.name);
    let mut lacks_it = false;
    // The first round warms up, and measures memory, which takes time.
    for side in 0..2 {
        match peak_megabytes(&mut command(programs[side])) {
            Ok(peak_mb) => measured[side].peak_mb = peak_mb,
            Err(_) if side == 0 => lacks_it = true,
            Err(error) => return Err(error),
        }
    }
    for round in 0..rounds {
        let order = if round % 2 == 0 { [0, 1] } else { [1, 0] };
        for side in order {
            if side == 0 && lacks_it {
                continue;
            }
            let run = timed(&mut command(programs[side]), case, written.as_deref())?;
            eprint!(" {:.0}", run.whole_ms);
            measured[side].runs.push(run);
        }
    }
    eprintln!(" ms");
    Ok(measured)
}

/// Whether a command did its work. `cusp check` ends with 1 where it finds something to reject.
fn is_done(code: Option<i32>, output: &[u8]) -> bool {
    code == Some(0) || code == Some(1) && output.starts_with(b"{")
}

fn timed(command: &mut Command, case: &Case, written: Option<&Path>) -> Result<Run> {
    let clock = Instant::now();
    let output = command.output()?;
    let whole_ms = clock.elapsed().as_secs_f64() * 1e3;
    if !is_done(output.status.code(), &output.stdout) {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    let report: Value = if case.stages.is_empty() {
        Value::Null
    } else {
        serde_json::from_slice(&output.stdout).context("no report")?
    };
    let stage_ms = |&(stage, _): &(&str, &str)| report["timings_ms"][stage].as_f64();
    let stages_ms: Option<Vec<f64>> = case.stages.iter().map(stage_ms).collect();
    Ok(Run {
        whole_ms,
        stages_ms: stages_ms.context("a report without timings")?,
        file_bytes: written
            .map(|file| Ok::<_, anyhow::Error>(fs::metadata(file)?.len()))
            .transpose()?,
    })
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

/// The rows of a case: one of the whole command, and one of each stage.
fn rows(case: &Case, model: &str, [before, now]: &[Measured; 2]) -> Vec<String> {
    let column = |of: &dyn Fn(&Run) -> Option<f64>| {
        let values =
            |measured: &Measured| -> Vec<f64> { measured.runs.iter().filter_map(of).collect() };
        triple(&values(before), &values(now))
    };
    let memory = |measured: &Measured| measured.peak_mb.into_iter().collect::<Vec<f64>>();
    let memory = triple(&memory(before), &memory(now));
    let file = column(&|run| run.file_bytes.map(|bytes| bytes as f64 / 1e3));
    let time = column(&|run| Some(run.whole_ms));
    let mut rows = vec![format!(
        "| {model} | {} | {time} | {memory} | {file} |",
        case.name
    )];
    let none = triple(&[], &[]);
    for (place, (_, stage)) in case.stages.iter().enumerate() {
        let time = column(&|run| run.stages_ms.get(place).copied());
        rows.push(format!(
            "| {model} | {}: {stage} | {time} | {none} | {none} |",
            case.name
        ));
    }
    rows
}

/// Three cells: both medians, and the median of the ratios pair by pair.
fn triple(before: &[f64], now: &[f64]) -> String {
    let ratios: Vec<f64> = before.iter().zip(now).map(|(old, new)| old / new).collect();
    let figure = |value: f64| format!("{value:.*}", usize::from(value < 100.0));
    let cell = |values: &[f64], words: &dyn Fn(f64) -> String| {
        median(values).map_or_else(|| "–".to_owned(), words)
    };
    [
        cell(before, &figure),
        cell(now, &figure),
        cell(&ratios, &|ratio| format!("{ratio:.2}")),
    ]
    .join(" | ")
}

fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// A ball of `rings` × `columns` pairs of facets, as binary STL: 80,000 facets for the ball of `cargo xtask bench slice`.
fn ball(radius: f64, rings: u32, columns: u32) -> Vec<u8> {
    let point = |ring: u32, column: u32| {
        let polar = f64::from(ring) / f64::from(rings) * std::f64::consts::PI;
        let azimuth = f64::from(column % columns) / f64::from(columns) * std::f64::consts::TAU;
        // A pole is one point, whatever the column.
        let around = if ring == 0 || ring == rings {
            0.0
        } else {
            polar.sin()
        };
        [around * azimuth.cos(), around * azimuth.sin(), polar.cos()].map(|it| (it * radius) as f32)
    };
    let mut facets = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let [a, b] = [point(ring, column), point(ring, column + 1)];
            let [c, d] = [point(ring + 1, column), point(ring + 1, column + 1)];
            if ring > 0 {
                facets.push([a, c, b]);
            }
            if ring + 1 < rings {
                facets.push([b, c, d]);
            }
        }
    }
    let mut bytes = vec![0; 80];
    bytes.extend((facets.len() as u32).to_le_bytes());
    for corners in facets {
        // The normal follows from the corners.
        bytes.extend([0; 12]);
        for coordinate in corners.as_flattened() {
            bytes.extend(coordinate.to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(whole_ms: f64) -> Run {
        Run {
            whole_ms,
            stages_ms: Vec::new(),
            file_bytes: Some(5_000_000),
        }
    }

    #[test]
    fn ratios_are_of_pairs() {
        // The machine was half as fast in the last round, for both.
        let of = |times: [f64; 3]| Measured {
            runs: times.map(run).into(),
            peak_mb: Some(120.0),
        };
        let both = [of([200.0, 210.0, 400.0]), of([100.0, 105.0, 200.0])];
        let rows = rows(&Case::new("slice", &[]), "ball", &both);
        let row = "| ball | slice | 210 | 105 | 2.00 | 120 | 120 | 1.00 | 5000 | 5000 | 1.00 |";
        assert_eq!(rows, [row]);
    }

    #[test]
    fn what_the_other_lacks_has_no_ratio() {
        let both = [
            Measured::default(),
            Measured {
                runs: vec![run(3.25)],
                peak_mb: None,
            },
        ];
        let rows = rows(&Case::new("check", &[]), "ball", &both);
        let row = "| ball | check | – | 3.2 | – | – | – | – | – | 5000 | – |";
        assert_eq!(rows, [row]);
    }

    #[test]
    fn the_ball_has_the_volume_of_a_ball() {
        let stl = ball(20.0, 199, 202);
        assert_eq!((stl.len() - 84) / 50, 2 * 202 * 198);
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
        let volume = |facet: &[u8]| {
            let it: Vec<f64> = facet[12..48].chunks(4).map(number).map(f64::from).collect();
            let cross = |i: usize, j: usize| it[3 + i] * it[6 + j] - it[3 + j] * it[6 + i];
            (it[0] * cross(1, 2) + it[1] * cross(2, 0) + it[2] * cross(0, 1)) / 6.0
        };
        let volume: f64 = stl[84..].chunks(50).map(volume).sum();
        let part = volume / (4.0 / 3.0 * std::f64::consts::PI * 20f64.powi(3));
        assert!((0.999..1.0).contains(&part), "{part}");
    }
}
