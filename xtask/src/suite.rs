//! `cargo xtask test`: every test, step by step.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    thread,
    time::Instant,
};

use anyhow::{Result, ensure};
use clap::ValueEnum;

use crate::{
    browser, counts, debian, node, process,
    project::Project,
    python, serve,
    tally::{self, Record, Tally},
    wasm,
};

/// A driver for machines without a GPU, and the loader that finds it.
const VULKAN_PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// The web servers of docs/hosting.md.
const SERVER_PACKAGES: [&str; 3] = ["nginx-light", "lighttpd", "lighttpd-mod-deflate"];

/// Browsers of engines other than Chromium's, and a screen in memory for them.
const ENGINE_PACKAGES: [&str; 3] = ["firefox-esr", "webkit2gtk-driver", "xvfb"];

/// The folder of tests that read and write our files with programs of others.
const INTEROP: &str = "tests/interop";

/// The steps, in the order of the summary.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Step {
    /// Unit, integration and documentation tests, natively
    Native,
    /// Instructions, allocations and bytes of print files, against benches/counts.json
    Counts,
    /// Print files, read by the crates of others, and jobs distributed by examples/dask
    Interop,
    /// The comparisons of GPU and CPU once more, on the Vulkan driver that Chromium ships
    Gpu,
    /// Build the wasm modules and the page
    Build,
    /// wasm/tests in a headless browser, WebGPU included
    Wasm,
    /// The page's unit tests
    Unit,
    /// The built page in a headless browser
    E2e,
    /// The main paths over the built page in browsers of other engines
    Engines,
}

/// Runs the given steps, or all, each regardless of the results before it, and
/// prints a summary. Returns `false` if anything failed.
pub fn run(project: &Project, steps: &[Step]) -> Result<bool> {
    let scratch = tempfile::tempdir()?;
    let lane = |lane: &[Step]| -> Vec<Record> {
        let chosen = lane
            .iter()
            .filter(|step| steps.is_empty() || steps.contains(step));
        let run = |step: &Step| step.record(project, scratch.path());
        chosen.map(run).collect()
    };
    // Compilers leave a core idle now and then, and so do browsers that wait for a module. Those of the last steps want both cores.
    let mut records = thread::scope(|scope| {
        let beside = scope.spawn(|| lane(&[Step::Build, Step::Wasm, Step::Unit]));
        let mut records = lane(&[Step::Native, Step::Counts, Step::Interop, Step::Gpu]);
        records.extend(beside.join().expect("no panic"));
        records
    });
    records.extend(lane(&[Step::E2e, Step::Engines]));
    Ok(tally::summarise(&records))
}

impl Step {
    fn record(self, project: &Project, scratch: &Path) -> Record {
        let value = self.to_possible_value().expect("no step is hidden");
        let step = value.get_name().to_owned();
        println!("\n=== {step} ===");
        let started = Instant::now();
        let result = self.run(project, scratch);
        if let Err(error) = &result {
            eprintln!("{step} failed: {error:#}");
        }
        Record {
            step,
            result,
            elapsed: started.elapsed(),
        }
    }

    fn run(self, project: &Project, scratch: &Path) -> Result<Tally> {
        match self {
            Self::Native => {
                ensure_vulkan();
                let mut cargo = process::cargo(project);
                cargo.args(["test", "--workspace", "--no-fail-fast"]);
                // Without it, the tests that need it are reported as ignored.
                match python::ensure_environment(project, &Path::new(INTEROP).join("python")) {
                    Ok(python) => drop(cargo.env("CUSP_PEERS_PYTHON", python)),
                    Err(error) => eprintln!("no peers in Python: {error:#}"),
                }
                cargo_test(&mut cargo, scratch)
            }
            Self::Counts => counts::run(project, scratch),
            Self::Interop => interop(project, scratch),
            Self::Gpu => gpu_on_swiftshader(project, scratch),
            Self::Build => serve::build(project).map(|()| Tally::default()),
            Self::Wasm => cargo_test(&mut wasm::test_command(project)?, scratch),
            Self::Unit => vitest(&mut node::npm(project)?, "test", scratch),
            Self::E2e => {
                debian::try_ensure(&SERVER_PACKAGES);
                let mut npm = page(project)?;
                vitest(
                    npm.env("CHROMIUM", browser::chromium()?)
                        // The shop verifies plans with it.
                        .env("CUSP", build_cusp(project)?),
                    "e2e",
                    scratch,
                )
            }
            Self::Engines => {
                // If they are still missing, their tests show as ignored.
                debian::try_ensure(&ENGINE_PACKAGES);
                let mut npm = page(project)?;
                // Files are compared with those that it writes.
                vitest(npm.env("CUSP", build_cusp(project)?), "engines", scratch)
            }
        }
    }
}

/// npm with a built page.
fn page(project: &Project) -> Result<Command> {
    ensure!(
        project.www.join("dist/index.html").exists(),
        "the page is not built"
    );
    node::npm(project)
}

/// Runs a cargo test command and counts its tests.
fn cargo_test(command: &mut Command, scratch: &Path) -> Result<Tally> {
    // Vulkan drivers need a private folder and complain at length without one.
    let (status, text) = process::tee(command.env("XDG_RUNTIME_DIR", scratch))?;
    Tally::of_libtest(status, &text)
}

/// Runs an npm script that calls vitest, and counts its tests.
fn vitest(npm: &mut Command, script: &str, scratch: &Path) -> Result<Tally> {
    let file = scratch.join(format!("{script}.json"));
    npm.args(["run", script, "--", "--reporter=default", "--reporter=json"])
        .arg(format!("--outputFile.json={}", file.display()));
    let (status, _) = process::tee(npm)?;
    Tally::of_vitest(status, &fs::read_to_string(&file).unwrap_or_default())
}

/// A workspace of its own, whose dependencies do not burden others. Dependencies of both are compiled once.
fn interop(project: &Project, scratch: &Path) -> Result<Tally> {
    let mut tally = cargo_test(
        process::cargo(project)
            .args(["test", "--no-fail-fast", "--manifest-path"])
            .arg(project.root.join(INTEROP).join("Cargo.toml")),
        scratch,
    )?;
    let folder = Path::new(INTEROP).join("cluster");
    let python = match python::ensure_environment(project, &folder) {
        Ok(python) => python,
        Err(error) => {
            tally
                .ignored
                .push(format!("cluster (all of it), {error:#}"));
            return Ok(tally);
        }
    };
    let (status, text) = process::tee(
        process::command(python)
            .current_dir(project.root.join(folder))
            .args(["-m", "unittest", "-v"])
            .env("CUSP", build_cusp(project)?)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )?;
    let cluster = Tally::of_unittest(status, &text)?;
    tally.passed += cluster.passed;
    tally.failed.extend(cluster.failed);
    tally.ignored.extend(cluster.ignored);
    Ok(tally)
}

/// A second, independent driver: what passes on both does not depend on the quirks of one.
fn gpu_on_swiftshader(project: &Project, scratch: &Path) -> Result<Tally> {
    let chromium = browser::chromium();
    let Some(driver) = chromium.ok().and_then(|path| browser::swiftshader(&path)) else {
        let why = "all of it, no browser that ships the SwiftShader Vulkan driver".into();
        return Ok(Tally {
            ignored: vec![why],
            ..Tally::default()
        });
    };
    cargo_test(
        process::cargo(project)
            .args(["test", "--workspace", "--test", "external", "gpu::", "--"])
            // The same solids again: what differs between drivers shows on them as they are.
            .args(["mirrored", "turned", "shuffled", "shifted"].map(|it| format!("--skip={it}")))
            // The loader's older and newer name for the same thing.
            .env("VK_ICD_FILENAMES", &driver)
            .env("VK_DRIVER_FILES", &driver),
        scratch,
    )
}

/// Builds the command line for tests that call it, and returns its path.
fn build_cusp(project: &Project) -> Result<PathBuf> {
    // With a test, dependencies have the features that tests ask for, and nothing is compiled a second time.
    process::run(
        process::cargo(project)
            .args(["build", "--workspace", "--bin", "cusp"])
            .args(["--test", "external"]),
    )?;
    let name = format!("debug/cusp{}", std::env::consts::EXE_SUFFIX);
    Ok(project.target.join(name))
}

/// Installs a Vulkan driver on Debian. Elsewhere the machine's own is used;
/// without one, the GPU tests show as ignored.
pub fn ensure_vulkan() {
    debian::try_ensure(&VULKAN_PACKAGES);
}
