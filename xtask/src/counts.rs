//! `cargo xtask counts`: figures that do not depend on the machine, held against those of `benches/counts.json`.
//!
//! Times on a shared machine vary by a quarter, so CI cannot hold them to anything. It holds what a program does instead: the instructions
//! and the allocations of the jobs in `benches/counts.rs`, on one thread, and the length of print files. `BLESS=1` records them anew.

use std::{
    collections::{BTreeMap, VecDeque},
    env, fmt, fs,
    path::{Path, PathBuf},
    sync::Mutex,
    thread,
};

use anyhow::{Context, Result, bail};
use serde_json::{Map, Value, json};

use crate::{
    bench, debian, process,
    project::Project,
    report::Verdict,
    runner_output::{Ignored, Tally},
};

/// Where the figures are recorded.
const RECORD: &str = "benches/counts.json";
/// The bench that has the jobs.
const BENCH: &str = "counts";
/// Its function within which valgrind counts.
const COUNTED: &str = "--toggle-collect=counts::counted*";
const VALGRIND: &str = "valgrind";
/// glibc chooses how to copy memory by the processor. Some have one instruction for it, which valgrind counts once per byte; without these,
/// all copy alike.
const PLAIN_COPIES: &str = "glibc.cpu.hwcaps=-ERMS,-FSRM,-AVX,-AVX2,-AVX512F,-AVX512VL";
/// The figure of a job that needs valgrind, and depends on the compiler.
const INSTRUCTIONS: &str = "instructions";
/// The kind of the sizes of print files.
const FILE_BYTES: &str = "file_bytes";
/// How much figures of a kind may grow, in percent, where nothing is recorded.
///
/// Instructions are the same in every run on one machine, to a few thousands. 2 % is for other processors and versions of glibc, which copy
/// memory by other loops, and for what the compiler decides otherwise after an unrelated change. It does not add up: figures are held
/// against the record, not the last run. Reports hold times, whose digits take a few bytes more or less. Print files are the same everywhere.
const TOLERANCES: [(&str, f64); 4] = [
    (INSTRUCTIONS, 2.0),
    ("allocations", 1.0),
    ("allocated_bytes", 1.0),
    (FILE_BYTES, 0.0),
];

/// One figure: what it is of, and what it counts.
type Name = (String, String);
/// Figures by name.
type Figures = BTreeMap<Name, u64>;

/// What became of a figure.
#[derive(Debug, PartialEq)]
enum Outcome {
    /// It is as recorded, or nearly.
    Kept,
    /// It is smaller by more than the tolerance.
    Shrunk,
    /// It is larger by more than the tolerance.
    Grown,
    /// It is not in the record.
    New,
    /// It is in the record only.
    Gone,
}

/// A figure, now and as recorded.
#[derive(Debug, PartialEq)]
struct Compared {
    name: Name,
    now: u64,
    recorded: u64,
    outcome: Outcome,
}

impl Compared {
    fn is_failure(&self) -> bool {
        matches!(self.outcome, Outcome::Grown | Outcome::New | Outcome::Gone)
    }
}

impl fmt::Display for Compared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name: (of, kind),
            now,
            recorded,
            ..
        } = self;
        let word = match self.outcome {
            Outcome::Kept => "ok",
            Outcome::Shrunk => "shrunk",
            Outcome::Grown => "GROWN",
            Outcome::New => "NEW",
            Outcome::Gone => "GONE",
        };
        let percent = change_percent(*recorded, *now);
        write!(
            f,
            "{word:<8}{of:<16}{kind:<16}{now:>14} was {recorded:>14} {percent:>+8.2} %"
        )
    }
}

/// Counts, compares and prints. With `BLESS=1` it records.
///
/// # Errors
///
/// Fails when the bench cannot be built or run, or the record cannot be read or written.
pub fn run(project: &Project, scratch: &Path) -> Result<(Verdict, Tally)> {
    let executable = build(project)?;
    let mut counted: Value =
        serde_json::from_str(&process::output(&mut process::command(&executable))?)
            .context("the bench prints no JSON")?;
    let compiler = compiler(project)?;
    counted["compiler"] = json!(compiler);
    let path = project.root.join(RECORD);
    let recorded = fs::read_to_string(&path).map_or(Ok(Value::Null), |text| {
        serde_json::from_str(&text).with_context(|| format!("cannot read {}", path.display()))
    })?;
    let is_blessed = env::var_os("BLESS").is_some_and(|it| it == "1");
    let missing = missing(&recorded, &compiler, is_blessed);
    if missing.is_none() {
        count_instructions(&executable, scratch, &mut counted)?;
    }
    if is_blessed {
        if let Some(why) = missing {
            bail!("nothing recorded: {why}");
        }
        counted["tolerance_percent"] = tolerances(&recorded);
        fs::write(&path, format!("{counted:#}\n"))?;
        println!("{RECORD} is recorded");
        return Ok((Verdict::Passed, Tally::default()));
    }
    let tolerances = tolerances(&recorded);
    let compared = compare(&figures(&recorded), &figures(&counted), &tolerances);
    Ok(judge(&compared, missing.as_deref()))
}

/// Builds the bench, and returns its path.
///
/// The dependencies are those of the tests, which a release build would compile anew for minutes. The crate itself is compiled as for release:
/// in one unit, since where units end decides what is copied into callers, and that alone changed counts by up to 10 %. Without the command
/// line, the crate takes half as long.
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
    bench::executable(cargo.env("CARGO_INCREMENTAL", "0"), BENCH)
}

/// Why instructions cannot be counted, or not be compared.
fn missing(recorded: &Value, compiler: &str, is_blessed: bool) -> Option<String> {
    if which::which(VALGRIND).is_err()
        && let Err(error) = debian::ensure(&[VALGRIND])
    {
        return Some(format!("no valgrind: {error:#}"));
    }
    let by = recorded["compiler"].as_str().unwrap_or(compiler);
    (by != compiler && !is_blessed).then(|| {
        format!("recorded with rustc {by}, not {compiler}: BLESS=1 cargo xtask counts records anew")
    })
}

/// The compiler's version and what it compiles for.
fn compiler(project: &Project) -> Result<String> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let text = process::output(
        process::command(rustc)
            .current_dir(&project.root)
            .arg("-vV"),
    )?;
    let field = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name));
        line.with_context(|| format!("rustc says no {name}"))
    };
    Ok(format!("{} {}", field("release: ")?, field("host: ")?))
}

/// Adds the instructions to what was counted of each job. Jobs run side by side: what one does has no effect on the count of another.
fn count_instructions(executable: &Path, scratch: &Path, counted: &mut Value) -> Result<()> {
    let jobs = counted["jobs"].as_object_mut().context("no jobs")?;
    let names: VecDeque<String> = jobs.keys().cloned().collect();
    let queue = Mutex::new(names);
    let counts = Mutex::new(Vec::new());
    let next = || queue.lock().ok()?.pop_front();
    let work = || {
        while let Some(name) = next() {
            let count = instructions(executable, &name, scratch);
            if let Ok(mut counts) = counts.lock() {
                counts.push((name, count));
            }
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    for (name, count) in counts.into_inner().unwrap_or_default() {
        jobs[&name][INSTRUCTIONS] = json!(count.with_context(|| name.clone())?);
    }
    Ok(())
}

/// The instructions of one job.
fn instructions(executable: &Path, job: &str, scratch: &Path) -> Result<u64> {
    let file: PathBuf = scratch.join(format!("{job}.callgrind"));
    let mut to_file = std::ffi::OsString::from("--callgrind-out-file=");
    to_file.push(&file);
    eprintln!("counting the instructions of {job}");
    process::output(
        process::command(VALGRIND)
            .args(["--tool=callgrind", COUNTED])
            .arg(to_file)
            .arg(executable)
            .arg(job)
            .env("GLIBC_TUNABLES", PLAIN_COPIES),
    )?;
    let text = fs::read_to_string(&file).context("valgrind left no file")?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
    match total.and_then(|total| total.trim().parse().ok()) {
        Some(0) | None => bail!("valgrind did not see the job"),
        Some(count) => Ok(count),
    }
}

/// The recorded tolerances, or those to begin with.
fn tolerances(recorded: &Value) -> Value {
    match &recorded["tolerance_percent"] {
        Value::Null => TOLERANCES
            .into_iter()
            .map(|(kind, percent)| (kind.to_owned(), json!(percent)))
            .collect::<Map<_, _>>()
            .into(),
        tolerances => tolerances.clone(),
    }
}

/// The figures in a record.
fn figures(record: &Value) -> Figures {
    let object = |value: &Value| value.as_object().cloned().unwrap_or_default();
    let mut figures = Figures::new();
    for (job, counts) in object(&record["jobs"]) {
        for (kind, count) in object(&counts) {
            figures.insert((job.clone(), kind), count.as_u64().unwrap_or_default());
        }
    }
    for (format, bytes) in object(&record["files"]) {
        let name = (format, FILE_BYTES.to_owned());
        figures.insert(name, bytes.as_u64().unwrap_or_default());
    }
    figures
}

/// Compares all figures of both. One that has no tolerance must be as recorded.
fn compare(recorded: &Figures, now: &Figures, tolerances: &Value) -> Vec<Compared> {
    let names = recorded
        .keys()
        .chain(now.keys().filter(|name| !recorded.contains_key(name)));
    let compare = |name: &Name| {
        let percent = tolerances[&name.1].as_f64().unwrap_or_default();
        let (was, is) = (recorded.get(name), now.get(name));
        let outcome = match (was, is) {
            (None, _) => Outcome::New,
            (_, None) => Outcome::Gone,
            (Some(&was), Some(&is)) => match change_percent(was, is) {
                change if change > percent => Outcome::Grown,
                change if change < -percent => Outcome::Shrunk,
                _ => Outcome::Kept,
            },
        };
        Compared {
            name: name.clone(),
            now: is.copied().unwrap_or_default(),
            recorded: was.copied().unwrap_or_default(),
            outcome,
        }
    };
    names.map(compare).collect()
}

fn change_percent(was: u64, is: u64) -> f64 {
    if was == is {
        return 0.0;
    }
    (is as f64 / was as f64 - 1.0) * 100.0
}

/// Prints all figures and counts them like tests. Instructions are ignored by name if there is a reason for it.
fn judge(compared: &[Compared], missing: Option<&str>) -> (Verdict, Tally) {
    let mut tally = Tally::default();
    let mut failed = Vec::new();
    for figure in compared {
        let (of, kind) = &figure.name;
        if let Some(why) = missing
            && kind == INSTRUCTIONS
        {
            tally.ignored.push(Ignored {
                name: format!("{of} {kind}"),
                reason: why.to_owned(),
            });
            continue;
        }
        println!("{figure}");
        if figure.is_failure() {
            tally.failed += 1;
            failed.push(format!("{of} {kind}"));
        } else {
            tally.passed += 1;
        }
    }
    let count = |wanted: &Outcome| {
        let all = compared.iter().filter(|figure| figure.outcome == *wanted);
        all.count()
    };
    if count(&Outcome::Shrunk) > 0 {
        println!(
            "Some have shrunk: BLESS=1 cargo xtask counts records that, so that they stay so."
        );
    }
    if !failed.is_empty() {
        println!(
            "Where that is meant, BLESS=1 cargo xtask counts records it; say why in the commit."
        );
        return (Verdict::Failed(failed.join(", ")), tally);
    }
    (Verdict::Passed, tally)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(instructions: u64, bytes: u64) -> Figures {
        figures(&json!({
            "jobs": { "read": { "instructions": instructions, "allocations": 50 } },
            "files": { "goo": bytes },
        }))
    }

    /// The outcomes of the goo's bytes, of allocations and of instructions.
    fn outcomes(recorded: &Figures, now: &Figures) -> Vec<Outcome> {
        let compared = compare(recorded, now, &tolerances(&Value::Null));
        compared.into_iter().map(|it| it.outcome).collect()
    }

    #[test]
    fn growth_beyond_the_tolerance_fails() {
        use Outcome::{Grown, Kept, Shrunk};
        let recorded = record(1_000_000, 613_492);
        let outcomes = |instructions, bytes| outcomes(&recorded, &record(instructions, bytes));
        assert_eq!(outcomes(1_000_000, 613_492), [Kept, Kept, Kept]);
        assert_eq!(outcomes(1_019_999, 613_492), [Kept, Kept, Kept]);
        assert_eq!(outcomes(1_020_001, 613_492), [Kept, Kept, Grown]);
        assert_eq!(outcomes(979_999, 613_492), [Kept, Kept, Shrunk]);
        // Print files are held to the byte.
        assert_eq!(outcomes(1_000_000, 613_493), [Grown, Kept, Kept]);
        assert_eq!(outcomes(1_000_000, 613_491), [Shrunk, Kept, Kept]);
    }

    #[test]
    fn one_grown_figure_fails_the_step() {
        let tolerances = tolerances(&Value::Null);
        let recorded = record(1_000_000, 613_492);
        let judged = |now: &Figures, missing| judge(&compare(&recorded, now, &tolerances), missing);
        let (verdict, tally) = judged(&record(1_030_000, 613_492), None);
        assert_eq!(verdict, Verdict::Failed("read instructions".into()));
        assert_eq!((tally.passed, tally.failed), (2, 1));
        let (verdict, tally) = judged(&record(900_000, 613_492), None);
        assert_eq!(verdict, Verdict::Passed);
        assert_eq!((tally.passed, tally.failed), (3, 0));
    }

    #[test]
    fn figures_that_are_new_or_gone_fail() {
        let some = record(1_000_000, 613_492);
        let none = Figures::new();
        assert_eq!(outcomes(&none, &some), [const { Outcome::New }; 3]);
        assert_eq!(outcomes(&some, &none), [const { Outcome::Gone }; 3]);
    }

    #[test]
    fn without_valgrind_instructions_are_ignored_by_name() {
        let recorded = record(1_000_000, 613_492);
        let mut now = recorded.clone();
        now.retain(|(_, kind), _| kind != INSTRUCTIONS);
        let compared = compare(&recorded, &now, &tolerances(&Value::Null));
        let (verdict, tally) = judge(&compared, Some("no valgrind"));
        assert_eq!(verdict, Verdict::Passed);
        assert_eq!((tally.passed, tally.failed), (2, 0));
        assert_eq!(tally.ignored.len(), 1);
        assert_eq!(tally.ignored[0].name, "read instructions");
        assert_eq!(tally.ignored[0].reason, "no valgrind");
    }
}
