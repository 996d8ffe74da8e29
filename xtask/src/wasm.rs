//! The wasm package: building, browser tests, lints and size.

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};
use flate2::{Compression, write::GzEncoder};

use crate::{
    bill, browser, node,
    process::{self, path_with},
    project::Project,
    split::{self, LaterExports},
    toolchain::{self, Toolchain, WASM_TARGET},
    tools::Tools,
};

/// A WebAssembly module of the page.
struct Module {
    /// The package that it is built from.
    package: &'static str,
    /// Name of its files, relative to the page's folder, without extensions.
    files: &'static str,
    /// The size budget, gzipped, in bytes.
    budget: usize,
    /// What is in a part of its own, which the page fetches when it first calls one of these exports, and that part's budget.
    later: Option<(LaterExports, usize)>,
}

/// What the slicer's later part is for. Loading, planning and showing a model, writing its print file, the quality curve and the
/// price of an order need none of these.
const LATER: LaterExports = LaterExports {
    names: &[
        "calibrate_layers",
        // Hollowing and supports.
        "later_arrived",
        "orientationsearch",
        "plate",
        "slicer_compare",
        "slicer_evaluate",
        "slicer_inspect",
        "slicer_plugs",
        "slicer_read_weights",
        "slicer_search",
        "slicer_weights_file",
    ],
};

/// The slicer, and what the page fetches when it is wanted: what drives a GPU for a plan, the readers of models other than STL,
/// and those of print files.
const MODULES: [Module; 4] = [
    Module {
        package: "cusp-slicer",
        files: "pkg/cusp_slicer",
        budget: 408_000,
        later: Some((LATER, 177_000)),
    },
    Module {
        package: "cusp-gpu",
        files: "pkg/gpu/cusp_gpu",
        budget: 83_000,
        later: None,
    },
    Module {
        package: "cusp-models",
        files: "pkg/models/cusp_models",
        budget: 72_000,
        later: None,
    },
    Module {
        package: "cusp-reader",
        files: "pkg/reader/cusp_reader",
        budget: 221_000,
        later: None,
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

    /// The names of its WebAssembly files.
    fn wasm_files(&self) -> Vec<String> {
        let ends = self.parts().map(|(end, _)| end);
        ends.map(|end| format!("{}{end}", self.name())).collect()
    }

    /// The ends of the names of its WebAssembly files, with their budgets.
    fn parts(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let later = self.later.map(|(_, budget)| (LATER_END, budget));
        [(FIRST_END, self.budget)].into_iter().chain(later)
    }
}

const FIRST_END: &str = "_bg.wasm";
const LATER_END: &str = "_later.wasm";

/// Not binaryen's "all features": that writes import sections that no browser reads yet.
const OPTIMISE: &str = "-O3";
/// Has the linker tell what uses what, which is gone once it has put in numbers: see [`split`].
const TELL_USES: &str = "-Clink-arg=--emit-relocs";

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
        .try_for_each(|module| build_module(module, project, &toolchain, &tools))?;
    let rustc = process::output(process::command(toolchain.program("rustc")).arg("--version"))?;
    let modules = MODULES.iter().map(|it| (it.package, it.wasm_files()));
    bill::write_of_modules(project, WASM_TARGET, &rustc, modules)
}

fn build_module(
    module: &Module,
    project: &Project,
    toolchain: &Toolchain,
    tools: &Tools,
) -> Result<()> {
    let tell = module.later.map(|_| TELL_USES);
    process::run(
        toolchain
            .cargo(project, [])?
            .args(["rustc", "--release", "--target", WASM_TARGET])
            .args(["--package", module.package, "--lib", NO_COMMAND_LINE])
            // Beside a library for Rust, it would not be optimised as a whole.
            .args(["--crate-type", "cdylib", "--"])
            .args(tell),
    )?;
    let compiled = toolchain::wasm_target_folder(project)
        .join(WASM_TARGET)
        .join("release")
        .join(format!("{}.wasm", module.name()));
    // Cargo knows when there is nothing to do; the tools would spend seconds on the same module again.
    if is_packed(module, &compiled, project) {
        return Ok(());
    }
    let linked = fs::read(&compiled)?;
    let later_slots = match module.later {
        Some((later, _)) => split::later_slots(&linked, later)
            .with_context(|| format!("cannot split {}", module.name()))?,
        None => Default::default(),
    };

    let folder = toolchain::wasm_target_folder(project).join("packed");
    fs::create_dir_all(&folder)?;
    let stripped = folder.join(format!("{}.wasm", module.name()));
    fs::write(&stripped, split::without_relocations(&linked)?)?;
    let whole = bind(module, &stripped, project, tools)?;

    let out = module.file(project, "");
    fs::create_dir_all(out.parent().unwrap_or(&project.www))?;
    for end in [".js", ".d.ts", "_bg.wasm.d.ts"] {
        fs::copy(
            folder.join(format!("{}{end}", module.name())),
            module.file(project, end),
        )?;
    }
    let first = match module.later {
        Some((later, _)) => {
            let parts = split::split(&whole, later, &later_slots)
                .with_context(|| format!("cannot split {}", module.name()))?;
            fs::write(module.file(project, LATER_END), parts.later)?;
            parts.first
        }
        None => whole,
    };
    fs::write(module.file(project, FIRST_END), first)?;
    Ok(())
}

/// Binds a compiled module to JavaScript, beside it, and optimises it.
fn bind(module: &Module, compiled: &Path, project: &Project, tools: &Tools) -> Result<Vec<u8>> {
    let folder = compiled.parent().unwrap_or(&project.target);
    process::run(
        process::command(&tools.wasm_bindgen)
            .arg(compiled)
            .args(["--target", "web", "--out-name", module.name(), "--out-dir"])
            .arg(folder),
    )?;
    let optimised = folder.join(format!("{}_optimised.wasm", module.name()));
    process::run(
        process::command(wasm_opt(project)?)
            .arg(folder.join(format!("{}{FIRST_END}", module.name())))
            .args([OPTIMISE, "--output"])
            .arg(&optimised),
    )?;
    Ok(fs::read(&optimised)?)
}

fn wasm_opt(project: &Project) -> Result<PathBuf> {
    let npm_bin = node::bin(project);
    which::which_in(
        "wasm-opt",
        Some(path_with([npm_bin.as_path()])?),
        &project.root,
    )
    .context("no wasm-opt: the page's npm package \"binaryen\" has it")
}

/// Whether the module is newer than everything it is built from.
fn is_packed(module: &Module, compiled: &Path, project: &Project) -> bool {
    let modified = |path: PathBuf| fs::metadata(path).and_then(|data| data.modified()).ok();
    let own = project.root.join("xtask").join("src");
    let made_of = [
        compiled.to_owned(),
        // The lock file has wasm-bindgen's version; the rest decides what becomes of the module.
        project.root.join("Cargo.lock"),
        own.join("wasm.rs"),
        own.join("split.rs"),
        own.join("split").join("module.rs"),
        own.join("split").join("uses.rs"),
    ];
    let times: Option<Vec<_>> = made_of.map(modified).into_iter().collect();
    let Some(newest) = times.into_iter().flatten().max() else {
        return false;
    };
    let ends = module.parts().map(|(end, _)| end);
    [".js", ".d.ts"]
        .into_iter()
        .chain(ends)
        .all(|end| modified(module.file(project, end)).is_some_and(|time| time > newest))
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
        for (end, budget) in module.parts() {
            let file = module.file(project, end);
            let bytes =
                fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
            let gzipped = gzipped_size(&bytes)?;
            println!(
                "www/{}{end}: {} bytes, {gzipped} gzipped, budget {budget}",
                module.files,
                bytes.len(),
            );
            if gzipped > budget {
                eprintln!("error: over the budget by {} bytes", gzipped - budget);
                is_within = false;
            }
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
