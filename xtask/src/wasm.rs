//! The wasm package: building, browser tests, lints and size.

use std::{fs, io::Write, path::PathBuf, process::Command};

use anyhow::{Context, Result, bail};
use flate2::{Compression, write::GzEncoder};

use crate::{
    browser, node,
    process::{self, path_with},
    project::Project,
    toolchain::{self, Toolchain, WASM_TARGET},
    tools::Tools,
};

/// A WebAssembly module of the page.
struct Module {
    /// The package that it is built from.
    package: &'static str,
    /// Folder of the package.
    folder: &'static str,
    /// Name of its files, relative to the page's folder, without extensions.
    files: &'static str,
    /// The size budget, gzipped, in bytes.
    budget: usize,
}

/// The slicer, and what the page fetches when it is wanted: what drives a GPU for a plan, the readers of models other than STL,
/// and those of print files.
const MODULES: [Module; 4] = [
    Module {
        package: "cusp-slicer",
        folder: ".",
        files: "pkg/cusp_slicer",
        budget: 570_000,
    },
    Module {
        package: "cusp-gpu",
        folder: "gpu",
        files: "pkg/gpu/cusp_gpu",
        budget: 83_000,
    },
    Module {
        package: "cusp-models",
        folder: "models",
        files: "pkg/models/cusp_models",
        budget: 72_000,
    },
    Module {
        package: "cusp-reader",
        folder: "reader",
        files: "pkg/reader/cusp_reader",
        budget: 221_000,
    },
];

impl Module {
    /// Its name, without the folder.
    fn name(&self) -> &'static str {
        self.files.rsplit('/').next().unwrap_or(self.files)
    }

    fn file(&self, project: &Project, end: &str) -> PathBuf {
        project.www.join(format!("{}{end}", self.files))
    }
}

/// Leaves out the command line, a default feature: cargo would otherwise compile
/// it for wasm along with the tests.
const NO_COMMAND_LINE: &str = "--no-default-features";
/// Tests drive the GPU themselves.
const WITH_GPU: [&str; 2] = ["--features", "gpu"];
/// Software GPUs are slow; the runner's own limit is 20 seconds for all tests.
const BROWSER_TEST_SECONDS: &str = "900";

/// Builds `www/pkg`.
///
/// # Errors
///
/// Fails when a tool is missing and cannot be installed, or the build fails.
pub fn build(project: &Project) -> Result<()> {
    let toolchain = Toolchain::ensure(project)?;
    let tools = Tools::ensure(project)?;
    node::ensure_packages(project)?;
    MODULES
        .iter()
        .try_for_each(|module| build_module(module, project, &toolchain, &tools))
}

fn build_module(
    module: &Module,
    project: &Project,
    toolchain: &Toolchain,
    tools: &Tools,
) -> Result<()> {
    process::run(
        toolchain
            .cargo(project, [])?
            .args(["build", "--release", "--target", WASM_TARGET])
            .args(["--package", module.package, "--lib", NO_COMMAND_LINE]),
    )?;
    // Cargo knows when there is nothing to do; wasm-pack would spend seconds
    // optimising the same module again.
    if is_packed(module, project) {
        return Ok(());
    }
    // Without wasm-opt on PATH, wasm-pack would silently skip that step.
    let npm_bin = node::bin(project);
    which::which_in(
        "wasm-opt",
        Some(path_with([npm_bin.as_path()])?),
        &project.root,
    )
    .context("no wasm-opt: the page's npm package \"binaryen\" has it")?;
    process::run(
        toolchain
            .command(
                project,
                &tools.wasm_pack,
                [tools.bin.as_path(), npm_bin.as_path()],
            )?
            .args(["build", module.folder, "--release", "--target", "web"])
            // Use what was just found; download nothing.
            .args(["--mode", "no-install", "--no-pack", "--out-dir"])
            .args([module.file(project, "").parent().unwrap_or(&project.www)])
            .args(["--out-name", module.name(), "--", NO_COMMAND_LINE]),
    )
}

/// Whether the module is newer than everything it is built from.
fn is_packed(module: &Module, project: &Project) -> bool {
    let modified = |path: PathBuf| fs::metadata(path).and_then(|data| data.modified()).ok();
    let compiled = toolchain::wasm_target_folder(project)
        .join(WASM_TARGET)
        .join("release")
        .join(format!("{}.wasm", module.name()));
    // The manifest has wasm-opt's flags, the lock file wasm-bindgen's version.
    let made_of = [
        compiled,
        project.root.join(module.folder).join("Cargo.toml"),
        project.root.join("Cargo.lock"),
    ];
    let times: Option<Vec<_>> = made_of.map(modified).into_iter().collect();
    let Some(newest) = times.into_iter().flatten().max() else {
        return false;
    };
    [".js", ".d.ts", "_bg.wasm"]
        .map(|end| module.file(project, end))
        .into_iter()
        .all(|file| modified(file).is_some_and(|time| time > newest))
}

/// The tests of tests/web.rs, to be run in a browser.
///
/// Not `wasm-pack test`: that compiles every test of the package for wasm before
/// it runs this one, and most are native only.
///
/// # Errors
///
/// Fails when a tool or the browser is missing and cannot be installed.
pub fn test_command(project: &Project) -> Result<Command> {
    let toolchain = Toolchain::ensure(project)?;
    let tools = Tools::ensure(project)?;
    let chromium = browser::chromium()?;
    let mut cargo = toolchain.cargo(project, [tools.bin.as_path()])?;
    cargo
        .args(["test", "--release", "--target", WASM_TARGET])
        .args(["--test", "web", NO_COMMAND_LINE])
        .args(WITH_GPU)
        .env(
            "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER",
            &tools.test_runner,
        )
        .env("CHROMEDRIVER", browser::chromedriver(&chromium)?)
        .env("WASM_BINDGEN_TEST_ONLY_WEB", "1")
        .env("WASM_BINDGEN_TEST_TIMEOUT", BROWSER_TEST_SECONDS)
        .env("WASM_BINDGEN_TEST_DRIVER_TIMEOUT", "60")
        .env(
            "WASM_BINDGEN_TEST_WEBDRIVER_JSON",
            browser::webdriver_settings(project, &chromium)?,
        );
    // Otherwise the runner may prefer another browser's driver.
    for name in ["GECKODRIVER", "SAFARIDRIVER"] {
        cargo.env_remove(name).env_remove(format!("{name}_REMOTE"));
    }
    Ok(cargo)
}

/// Lints the code that is compiled only for wasm.
///
/// # Errors
///
/// Fails when clippy is missing and cannot be installed, or finds something.
pub fn clippy(project: &Project) -> Result<()> {
    let toolchain = Toolchain::ensure(project)?;
    toolchain.ensure_clippy()?;
    let clippy = |arguments: &[&str]| {
        process::run(
            toolchain
                .cargo(project, [])?
                // In release, to share the macros and build scripts with the build.
                .args(["clippy", "--release", "--target", WASM_TARGET])
                .args(arguments)
                .args(["--", "-D", "warnings"]),
        )
    };
    // One by one: each module has other features.
    for module in &MODULES {
        clippy(&["--package", module.package, "--lib", NO_COMMAND_LINE])?;
    }
    clippy(&[&["--test", "web", NO_COMMAND_LINE], &WITH_GPU[..]].concat())
}

/// Reports the sizes of the built modules. Returns `false` if one is over its budget.
///
/// # Errors
///
/// Fails when there is no module.
pub fn check_size(project: &Project) -> Result<bool> {
    let mut is_within = true;
    for module in &MODULES {
        let file = module.file(project, "_bg.wasm");
        let bytes = fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let gzipped = gzipped_size(&bytes)?;
        println!(
            "www/{}_bg.wasm: {} bytes, {gzipped} gzipped, budget {}",
            module.files,
            bytes.len(),
            module.budget,
        );
        if gzipped > module.budget {
            eprintln!(
                "error: over the budget by {} bytes",
                gzipped - module.budget
            );
            is_within = false;
        }
    }
    Ok(is_within)
}

fn gzipped_size(bytes: &[u8]) -> Result<usize> {
    if !bytes.starts_with(b"\0asm") {
        bail!("this is no wasm module");
    }
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_modules_are_weighed() {
        let mut module = b"\0asm\x01\0\0\0".to_vec();
        module.resize(100_000, 0);
        assert!((20..1_000).contains(&gzipped_size(&module).unwrap()));
        assert!(gzipped_size(b"<!doctype html>").is_err());
    }
}
