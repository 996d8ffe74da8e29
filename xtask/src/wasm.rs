//! The WebAssembly modules: building, size, browser tests and lints. wasm-pack does the work.

use std::{
    env,
    ffi::OsString,
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
    sync::Mutex,
};

use anyhow::{Context, Result, ensure};
use flate2::{Compression, write::GzEncoder};

use crate::{
    browser, node,
    process::{self, command},
    project::{Project, modified},
};

const TARGET: &str = "wasm32-unknown-unknown";

/// A module of the page: a build of the package `wasm/`.
struct Module {
    /// Name of its files in www/pkg.
    name: &'static str,
    /// Features that it is built with.
    features: &'static [&'static str],
    /// The size budget, gzipped, in bytes: to notice a jump.
    budget: usize,
}

/// The slicer, and the reader of print files, which the page alone fetches.
const MODULES: [Module; 2] = [
    Module {
        name: "cusp_slicer",
        features: &[],
        budget: 859_000,
    },
    Module {
        name: "cusp_reader",
        features: &["--features", "reader"],
        budget: 235_000,
    },
];

/// Everything that a module is made from.
const SOURCES: [&str; 7] = [
    "src",
    "shaders",
    "wasm/src",
    "wasm/Cargo.toml",
    "Cargo.toml",
    "Cargo.lock",
    ".cargo/config.toml",
];

impl Module {
    fn file(&self, project: &Project) -> PathBuf {
        project
            .www
            .join("pkg")
            .join(format!("{}_bg.wasm", self.name))
    }

    /// Written after each build.
    fn stamp(&self, project: &Project) -> PathBuf {
        project.target.join(format!("{}.built", self.name))
    }

    fn is_current(&self, project: &Project) -> bool {
        let newest = SOURCES.map(|source| modified(&project.root.join(source)));
        let built = modified(&self.stamp(project));
        self.file(project).exists() && built > newest.into_iter().max().flatten()
    }

    fn build(&self, project: &Project) -> Result<()> {
        // wasm-pack would bind and optimise the same module again.
        if self.is_current(project) {
            return Ok(());
        }
        process::run(
            wasm_pack(project)?
                .args(["build", "wasm", "--target", "web", "--release", "--no-pack"])
                .args(["--mode", "no-install", "--out-dir", "../www/pkg"])
                .args(["--out-name", self.name, "--"])
                .args(self.features),
        )?;
        process::run(command("node").current_dir(&project.www).arg("facts.mjs"))?;
        fs::write(self.stamp(project), "").context("cannot write the stamp of a build")
    }
}

/// Compiles the slicer, as a first step of [`build`] that needs no packages of npm.
pub fn compile(project: &Project) -> Result<()> {
    if MODULES[0].is_current(project) {
        return Ok(());
    }
    process::run(
        process::cargo(project)
            .args(["build", "--lib", "--release", "--target", TARGET])
            .args(["--package", "cusp-wasm"]),
    )
}

/// Builds `www/pkg`. A second call, from another thread too, waits for the first.
pub fn build(project: &Project) -> Result<()> {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock();
    node::ensure_packages(project)?;
    ensure_tools(project)?;
    MODULES.iter().try_for_each(|module| module.build(project))
}

/// Finds wasm-pack, wasm-bindgen and the target, or installs them where cargo and rustup install for everyone.
pub fn ensure_tools(project: &Project) -> Result<()> {
    let libraries = process::output(command("rustc").current_dir(&project.root).args([
        "--print",
        "target-libdir",
        "--target",
        TARGET,
    ]))?;
    if !Path::new(&libraries).exists() {
        process::run(command("rustup").args(["target", "add", TARGET])).with_context(|| {
            format!("no standard library for {TARGET}: get it with `rustup target add {TARGET}`")
        })?;
    }
    // wasm-bindgen's programs and library share an unstable format, so the versions must be equal.
    let version = project.locked_version("wasm-bindgen")?;
    let path = path(project)?;
    let has = |program: &str, version: &str| {
        which::which_in(program, Some(&path), &project.root)
            .map_err(Into::into)
            .and_then(|program| process::output(command(program).arg("--version")))
            .is_ok_and(|text| text.contains(version))
    };
    let is_bound = has("wasm-bindgen", &version) && has("wasm-bindgen-test-runner", &version);
    let missing: Vec<String> = [
        (!is_bound).then(|| format!("wasm-bindgen-cli@{version}")),
        (!has("wasm-pack", "")).then(|| "wasm-pack".to_owned()),
    ]
    .into_iter()
    .flatten()
    .collect();
    if missing.is_empty() {
        return Ok(());
    }
    eprintln!("installing {} (a minute or two, once)", missing.join(", "));
    let scratch = tempfile::tempdir()?;
    process::run(
        process::cargo(project)
            // Not `--locked`: a published lock file names withdrawn versions. Without features: those are for downloads.
            .args(["install", "--no-default-features"])
            .args(missing)
            // They run for a second or two: optimising them is not worth the minutes.
            .env("CARGO_TARGET_DIR", scratch.path())
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0")
            .env("CARGO_PROFILE_RELEASE_LTO", "off")
            .env("CARGO_PROFILE_RELEASE_DEBUG", "false"),
    )
}

/// `PATH` with the page's wasm-opt, and cargo's own folder of programs.
fn path(project: &Project) -> Result<OsString> {
    let cargo_home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let cargo_home = cargo_home.or_else(|| Some(env::home_dir()?.join(".cargo")));
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = [project.www.join("node_modules/.bin")]
        .into_iter()
        .chain(env::split_paths(&path))
        .chain(cargo_home.map(|folder| folder.join("bin")));
    Ok(env::join_paths(folders)?)
}

fn wasm_pack(project: &Project) -> Result<Command> {
    let path = path(project)?;
    let mut wasm_pack = command(which::which_in("wasm-pack", Some(&path), &project.root)?);
    wasm_pack
        .current_dir(&project.root)
        .env("CARGO_TARGET_DIR", &project.target)
        .env("PATH", path);
    Ok(wasm_pack)
}

/// The tests of wasm/tests, to be run in a browser.
pub fn test_command(project: &Project) -> Result<Command> {
    ensure_tools(project)?;
    let chromium = browser::chromium()?;
    let mut wasm_pack = wasm_pack(project)?;
    wasm_pack
        .args(["test", "--release", "--headless", "--chrome"])
        .args(["--mode", "no-install", "--chromedriver"])
        .arg(browser::chromedriver(&chromium)?)
        // Whatever stands behind the package goes to cargo.
        .arg("wasm")
        // Software GPUs are slow; the runner's own limit is 20 seconds for all tests.
        .env("WASM_BINDGEN_TEST_TIMEOUT", "900")
        .env("WASM_BINDGEN_TEST_DRIVER_TIMEOUT", "60")
        .env(
            "WASM_BINDGEN_TEST_WEBDRIVER_JSON",
            browser::webdriver_settings(project, &chromium)?,
        );
    Ok(wasm_pack)
}

/// Lints the code that is compiled only for wasm.
pub fn clippy(project: &Project) -> Result<()> {
    for module in &MODULES {
        process::run(
            process::cargo(project)
                // In release, to share the macros and build scripts with the build.
                .args(["clippy", "--release", "--target", TARGET])
                .args(["--package", "cusp-wasm", "--all-targets"])
                .args(module.features)
                .args(["--", "-D", "warnings"]),
        )?;
    }
    Ok(())
}

/// Reports the sizes of the built modules. Returns `false` if one is over its budget.
pub fn check_size(project: &Project) -> Result<bool> {
    let mut is_within = true;
    for module in &MODULES {
        let file = module.file(project);
        let bytes = fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
        ensure!(bytes.starts_with(b"\0asm"), "this is no wasm module");
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&bytes)?;
        let gzipped = encoder.finish()?.len();
        let Module { name, budget, .. } = module;
        println!(
            "{name}: {} bytes, {gzipped} gzipped, budget {budget}",
            bytes.len()
        );
        if gzipped > *budget {
            eprintln!("error: over the budget by {} bytes", gzipped - budget);
            is_within = false;
        }
    }
    Ok(is_within)
}
