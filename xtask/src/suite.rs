//! `cargo xtask test`: every test, step by step.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, ExitStatus},
    time::Instant,
};

use anyhow::{Context, Result};
use clap::ValueEnum;
use tempfile::TempDir;

use crate::{
    browser, counts, debian, node, process,
    project::Project,
    python,
    report::{self, Record, Verdict, judge, judge_optional},
    runner_output::{self, Tally},
    wasm,
};

/// A driver for machines without a GPU, and the loader that finds it.
const VULKAN_PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// The web servers of docs/hosting.md.
const SERVER_PACKAGES: [&str; 3] = ["nginx-light", "lighttpd", "lighttpd-mod-deflate"];

/// Browsers of engines other than Chromium's, and a screen in memory for them.
const ENGINE_PACKAGES: [&str; 3] = ["firefox-esr", "webkit2gtk-driver", "xvfb"];

/// The steps, in the order in which they run.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Step {
    /// Unit, integration and documentation tests, natively
    Native,
    /// Instructions, allocations and bytes of print files, against benches/counts.json
    Counts,
    /// Print files, read by the crates of others (tests/interop/)
    Interop,
    /// The GPU tests once more, on the Vulkan driver that Chromium ships
    Gpu,
    /// Build the wasm package and the page
    Build,
    /// tests/web.rs in a headless browser, WebGPU included
    Wasm,
    /// The page's types
    Check,
    /// The page's unit tests
    Unit,
    /// The built page in a headless browser
    E2e,
    /// The main paths over the built page in browsers of other engines
    Engines,
    /// Orientation searches and batches on several worker processes (examples/cluster)
    Cluster,
}

/// Runs the given steps, or all, each regardless of the results before it, and
/// prints a summary. Returns `false` if anything failed.
///
/// # Errors
///
/// Fails if no temporary folder can be created.
pub fn run(project: &Project, steps: &[Step]) -> Result<bool> {
    let scratch = TempDir::with_prefix("cusp-test-")?;
    let mut records: Vec<Record> = Vec::new();
    let mut build_failed = false;
    for &step in Step::value_variants() {
        if !steps.is_empty() && !steps.contains(&step) {
            continue;
        }
        let name = step
            .to_possible_value()
            .context("a step is hidden")?
            .get_name()
            .to_owned();
        println!("\n=== {name} ===");
        let started = Instant::now();
        let needs_build = matches!(step, Step::Check | Step::E2e | Step::Engines);
        let (verdict, tally) = if needs_build && build_failed {
            (
                Verdict::Failed("not run: the build failed".into()),
                Tally::default(),
            )
        } else {
            step.run(project, scratch.path())
                .unwrap_or_else(|error| (Verdict::Failed(format!("{error:#}")), Tally::default()))
        };
        if let Verdict::Failed(why) = &verdict {
            eprintln!("{name} failed: {why}");
            build_failed |= step == Step::Build;
        }
        records.push(Record {
            step: name,
            verdict,
            tally,
            elapsed: started.elapsed(),
        });
    }
    print!("{}", report::summary(&records));
    Ok(report::is_good(&records))
}

impl Step {
    fn run(self, project: &Project, scratch: &Path) -> Result<(Verdict, Tally)> {
        match self {
            Self::Native => {
                ensure_vulkan();
                let mut cargo = process::cargo(project);
                cargo.args(["test", "--workspace", "--no-fail-fast"]);
                // Without it, the tests that need it are reported as ignored.
                match python::ensure_environment(project, &python::peers(project)) {
                    Ok(python) => drop(cargo.env("CUSP_PEERS_PYTHON", python)),
                    Err(error) => eprintln!("no peers in Python: {error:#}"),
                }
                cargo_test(&mut cargo, scratch)
            }
            Self::Counts => counts::run(project, scratch),
            Self::Interop => cargo_test(&mut interop(project), scratch),
            Self::Gpu => {
                ensure_vulkan();
                gpu_on_swiftshader(project, scratch)
            }
            Self::Build => {
                wasm::build(project)?;
                node::build_page(project)?;
                Ok((Verdict::Passed, Tally::default()))
            }
            Self::Wasm => cargo_test(&mut wasm::test_command(project)?, scratch),
            Self::Check => {
                process::run(node::npm(project)?.args(["run", "check"]))?;
                Ok((Verdict::Passed, Tally::default()))
            }
            Self::Unit => vitest(&mut node::npm(project)?, "test", scratch, judge),
            Self::E2e => {
                let chromium = browser::chromium()?;
                ensure_servers();
                // The shop verifies plans with it.
                let cusp = build_cusp(project)?;
                vitest(
                    node::npm(project)?
                        .env("CHROMIUM", chromium)
                        .env("CUSP", cusp),
                    "e2e",
                    scratch,
                    judge,
                )
            }
            Self::Engines => {
                // Where they are missing all the same, their tests show as ignored.
                debian::try_ensure(&ENGINE_PACKAGES);
                // Files are compared with those that it writes.
                let cusp = build_cusp(project)?;
                let mut npm = node::npm(project)?;
                vitest(npm.env("CUSP", cusp), "engines", scratch, judge_optional)
            }
            Self::Cluster => cluster(project),
        }
    }
}

/// Runs a cargo test command and counts its tests.
fn cargo_test(command: &mut Command, scratch: &Path) -> Result<(Verdict, Tally)> {
    // Vulkan drivers need a private folder and complain at length without one.
    let (status, text) = process::tee(command.env("XDG_RUNTIME_DIR", scratch))?;
    Ok(judge(status, runner_output::libtest(&text)))
}

/// Runs an npm script that calls vitest, and counts its tests.
fn vitest(
    npm: &mut Command,
    script: &str,
    scratch: &Path,
    judge: fn(ExitStatus, Result<Tally>) -> (Verdict, Tally),
) -> Result<(Verdict, Tally)> {
    let file = scratch.join(format!("{script}.json"));
    let mut to_file = std::ffi::OsString::from("--outputFile.json=");
    to_file.push(&file);
    npm.args(["run", script, "--", "--reporter=default", "--reporter=json"])
        .arg(to_file);
    let (status, _) = process::tee(npm)?;
    let tally = fs::read_to_string(&file)
        .context("vitest left no report")
        .and_then(|json| runner_output::vitest(&json));
    Ok(judge(status, tally))
}

/// A workspace of its own, so its features and profiles differ, and what it builds
/// is kept apart.
fn interop(project: &Project) -> Command {
    let mut cargo = process::cargo(project);
    cargo
        .args(["test", "--no-fail-fast", "--manifest-path"])
        .arg(project.root.join("tests/interop/Cargo.toml"))
        .env("CARGO_TARGET_DIR", project.target.join("interop"));
    cargo
}

/// A second, independent driver: what passes on both does not depend on the
/// quirks of one.
fn gpu_on_swiftshader(project: &Project, scratch: &Path) -> Result<(Verdict, Tally)> {
    let Some(driver) = browser::chromium()
        .ok()
        .and_then(|path| browser::swiftshader(&path))
    else {
        let why = "no browser that ships the SwiftShader Vulkan driver";
        return Ok((Verdict::Skipped(why.into()), Tally::default()));
    };
    cargo_test(
        process::cargo(project)
            .args(["test", "--workspace", "--test", "external", "gpu::"])
            // The loader's older and newer name for the same thing.
            .env("VK_ICD_FILENAMES", &driver)
            .env("VK_DRIVER_FILES", &driver),
        scratch,
    )
}

/// The examples that distribute searches and batches among worker processes.
fn cluster(project: &Project) -> Result<(Verdict, Tally)> {
    let python = match python::ensure_environment(project, &python::example(project)) {
        Ok(python) => python,
        Err(error) => return Ok((Verdict::Skipped(format!("{error:#}")), Tally::default())),
    };
    process::run(python::pip(&python).arg("check"))
        .context("requirements.txt does not name all packages")?;
    let cusp = build_cusp(project)?;
    let (status, text) = process::tee(
        process::command(python)
            .current_dir(python::example(project))
            .args([
                "-m",
                "unittest",
                "-v",
                "test_orient",
                "test_slice",
                "test_schemas",
            ])
            .env("CUSP", cusp)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )?;
    Ok(judge(status, runner_output::unittest(&text)))
}

/// Builds the command line for tests that call it, and returns its path.
fn build_cusp(project: &Project) -> Result<PathBuf> {
    process::run(process::cargo(project).args(["build", "--workspace", "--bin", "cusp"]))?;
    let name = format!("debug/cusp{}", std::env::consts::EXE_SUFFIX);
    Ok(project.target.join(name))
}

/// Installs a Vulkan driver on Debian. Elsewhere the machine's own is used;
/// without one, the GPU tests show as ignored.
pub fn ensure_vulkan() {
    debian::try_ensure(&VULKAN_PACKAGES);
}

/// Installs web servers on Debian, unless that would start them. Without one, its test shows as ignored.
fn ensure_servers() {
    if debian::starts_no_services() {
        debian::try_ensure(&SERVER_PACKAGES);
    }
}
