//! `cargo xtask counts`: the cost of the core, in figures that do not depend on the machine's speed. Growth fails.
//!
//! Instructions, by valgrind, and allocations of the jobs of `benches/counts.rs`, on one thread, and the length of print files.
//! `BLESS=1` records them.

use std::{
    collections::BTreeMap,
    env, fs,
    path::{Path, PathBuf},
    sync::Mutex,
    thread,
};

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};

use crate::{bench, debian, process, project::Project, tally::Tally};

/// File in which the figures are recorded.
const RECORD: &str = "benches/counts.json";
const VALGRIND: &str = "valgrind";
/// glibc chooses how to copy memory by the processor. Some have one instruction for it, which valgrind counts once per byte; without these,
/// all copy alike.
const PLAIN_COPIES: &str = "glibc.cpu.hwcaps=-ERMS,-FSRM,-AVX,-AVX2,-AVX512F,-AVX512VL";
/// The figure of a job that needs valgrind, and depends on the compiler.
const INSTRUCTIONS: &str = "instructions";

/// Figures by their subject and their unit.
type Figures = BTreeMap<(String, String), f64>;

/// Counts, compares and prints. With `BLESS=1` it records.
pub fn run(project: &Project, scratch: &Path) -> Result<Tally> {
    let executable = build(project)?;
    let counted = process::output(&mut process::command(&executable))?;
    let mut counted: Value = serde_json::from_str(&counted).context("the bench prints no JSON")?;
    let rustc = process::output(
        process::command("rustc")
            .current_dir(&project.root)
            .arg("-vV"),
    )?;
    let fields = rustc.lines().filter_map(|line| line.split_once(": "));
    let fields: BTreeMap<&str, &str> = fields.collect();
    counted["compiler"] = json!(format!("{} {}", fields["release"], fields["host"]));
    let path = project.root.join(RECORD);
    let mut recorded: Value = serde_json::from_str(&fs::read_to_string(&path)?)?;

    let is_blessed = env::var_os("BLESS").is_some_and(|it| it == "1");
    let missing = if let Err(error) = which::which(VALGRIND).or_else(|_| {
        debian::ensure(&[VALGRIND])?;
        Ok::<PathBuf, anyhow::Error>(VALGRIND.into())
    }) {
        Some(format!("no valgrind: {error:#}"))
    } else if counted["compiler"] != recorded["compiler"] && !is_blessed {
        let (by, now) = (&recorded["compiler"], &counted["compiler"]);
        Some(format!(
            "recorded with {by}, not {now}: BLESS=1 cargo xtask counts records them again"
        ))
    } else {
        count_instructions(&executable, scratch, &mut counted)?;
        None
    };
    if is_blessed {
        if let Some(why) = missing {
            bail!("nothing recorded: {why}");
        }
        counted["tolerance_percent"] = recorded["tolerance_percent"].take();
        fs::write(&path, format!("{counted:#}\n"))?;
        println!("{RECORD} is recorded");
        return Ok(Tally::default());
    }
    let tolerances = recorded["tolerance_percent"].take();
    let mut tally = compare(&figures(&recorded), &figures(&counted), &tolerances);
    if let Some(why) = missing {
        let is_missing = |name: &String| name.starts_with(INSTRUCTIONS);
        for name in tally.failed.extract_if(.., |name| is_missing(name)) {
            tally.ignored.push(format!("{name}, {why}"));
        }
    }
    if !tally.failed.is_empty() {
        println!(
            "Where growth is meant, BLESS=1 cargo xtask counts records it; say why in the commit."
        );
    }
    Ok(tally)
}

/// Builds the bench, and returns its path.
///
/// The dependencies are those of the tests, which a release build would spend minutes compiling again. The crate itself
/// is compiled as for release: in one unit, since the ends of units decide what is copied into callers, and that alone
/// changed counts by up to 10 %. Without the command line, the crate takes half as long.
fn build(project: &Project) -> Result<PathBuf> {
    let mut cargo = process::cargo(project);
    cargo.args(["build", "--workspace", "--no-default-features"]);
    for setting in [
        "codegen-units=1",
        "opt-level=3",
        "debug-assertions=false",
        "overflow-checks=false",
    ] {
        cargo.arg(format!(
            "--config=profile.dev.package.cusp-slicer.{setting}"
        ));
    }
    bench::executable(cargo.env("CARGO_INCREMENTAL", "0"), "counts")
}

/// Adds the instructions to the figures of each job. Jobs run side by side: one has no effect on the count of another.
fn count_instructions(executable: &Path, scratch: &Path, counted: &mut Value) -> Result<()> {
    let jobs = counted["jobs"].as_object_mut().context("no jobs")?;
    let queue: Mutex<Vec<_>> = Mutex::new(jobs.iter_mut().collect());
    let work = || -> Result<()> {
        loop {
            let Some((name, job)) = queue.lock().expect("no panic").pop() else {
                return Ok(());
            };
            job[INSTRUCTIONS] = instructions(executable, name, scratch)?.into();
        }
    };
    thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut results = workers.into_iter().map(|it| it.join().expect("no panic"));
        results.try_for_each(|result| result)
    })
}

/// The instructions of one job, within the bench's function `counted`.
fn instructions(executable: &Path, job: &str, scratch: &Path) -> Result<u64> {
    let file = scratch.join(format!("{job}.callgrind"));
    eprintln!("counting the instructions of {job}");
    process::output(
        process::command(VALGRIND)
            .args(["--tool=callgrind", "--toggle-collect=counts::counted*"])
            .arg(format!("--callgrind-out-file={}", file.display()))
            .arg(executable)
            .arg(job)
            .env("GLIBC_TUNABLES", PLAIN_COPIES),
    )?;
    let text = fs::read_to_string(&file).context("valgrind left no file")?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
    let count = total.and_then(|total| total.trim().parse().ok());
    count
        .filter(|&count| count > 0)
        .context("valgrind did not see the job")
}

/// The figures of a record.
fn figures(record: &Value) -> Figures {
    let mut figures = Figures::new();
    let object = |value: &Value| value.as_object().cloned().unwrap_or_default();
    for (job, counts) in object(&record["jobs"]) {
        for (kind, count) in object(&counts) {
            figures.insert((kind, job.clone()), count.as_f64().unwrap_or_default());
        }
    }
    for (format, bytes) in object(&record["files"]) {
        let name = ("file_bytes".to_owned(), format);
        figures.insert(name, bytes.as_f64().unwrap_or_default());
    }
    figures
}

/// Compares and prints all figures of both. A figure fails that has grown by more than the tolerance of its kind, or is in one of them only.
fn compare(recorded: &Figures, now: &Figures, tolerances: &Value) -> Tally {
    let mut tally = Tally::default();
    let mut names: Vec<_> = recorded.keys().chain(now.keys()).collect();
    names.sort();
    names.dedup();
    for name @ (kind, of) in names {
        let tolerance = tolerances[kind].as_f64().unwrap_or_default();
        let (was, is) = (recorded.get(name), now.get(name));
        let percent = match (was, is) {
            (Some(was), Some(is)) => (is / was - 1.0) * 100.0,
            _ => f64::INFINITY,
        };
        let show = |figure: Option<&f64>| figure.map_or_else(|| "none".into(), f64::to_string);
        let word = if percent > tolerance {
            "FAILED"
        } else if percent < -tolerance {
            "shrunk"
        } else {
            "ok"
        };
        let (is, was) = (show(is), show(was));
        println!("{word:<8}{kind:<16}{of:<16}{is:>14} was {was:>14} {percent:>+8.2} %");
        if percent > tolerance {
            tally.failed.push(format!("{kind} {of}"));
        } else {
            tally.passed += 1;
        }
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_beyond_the_tolerance_and_figures_of_one_side_fail() {
        let record = |instructions: u64, bytes: u64| {
            let jobs = json!({ "read": { INSTRUCTIONS: instructions } });
            figures(&json!({ "jobs": jobs, "files": { "goo": bytes } }))
        };
        let tolerances = json!({ INSTRUCTIONS: 2.0 });
        let recorded = record(1_000_000, 613_492);
        let failed = |now: &Figures| compare(&recorded, now, &tolerances).failed;
        assert_eq!(failed(&record(1_019_999, 613_492)), [""; 0]);
        assert_eq!(failed(&record(1_020_001, 613_000)), ["instructions read"]);
        // Print files are held to the byte.
        assert_eq!(failed(&record(900_000, 613_493)), ["file_bytes goo"]);
        assert_eq!(failed(&Figures::new()).len(), 2);
    }
}
