//! Rust's standard library for wasm, built from Debian's source package.
//!
//! Debian ships the current compiler and its source, but no library for wasm.
//! Cargo can build one (`-Zbuild-std`) in half a minute. Where the compiler
//! looks for its libraries, it serves every later build as rustup's would.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};

use crate::{
    process::{self, command},
    project::Project,
    toolchain::{Toolchain, WASM_TARGET},
};

/// Stamp file beside the libraries: names the compiler that built them.
const STAMP: &str = "built-from-source-for";
/// An empty crate, built for the sake of its dependencies.
const SEED: &str = "wasm_std_seed";

/// Whether the libraries exist and match the current compiler.
pub fn is_current(toolchain: &Toolchain) -> bool {
    let current = || -> Result<bool> {
        let stamp = fs::read_to_string(library_folder(toolchain)?.join(STAMP))?;
        Ok(stamp == compiler_version(toolchain)?)
    };
    toolchain.program("rustc").exists() && current().unwrap_or(false)
}

/// Builds the libraries and installs them where the compiler looks.
///
/// # Errors
///
/// Fails if the build fails or the compiler's folder is not writable.
pub fn build(toolchain: &Toolchain, project: &Project) -> Result<()> {
    if is_current(toolchain) {
        return Ok(());
    }
    let seed = project.target.join("wasm-std");
    fs::create_dir_all(seed.join("src"))?;
    fs::write(seed.join("src/lib.rs"), "")?;
    fs::write(
        seed.join("Cargo.toml"),
        format!(
            "[package]\nname = \"{SEED}\"\nedition = \"2024\"\n\n\
             [profile.release]\npanic = \"abort\"\n\n[workspace]\n"
        ),
    )?;
    let built = seed.join("target");
    process::run(
        toolchain
            .cargo(project, [])?
            .current_dir(&seed)
            .env("CARGO_TARGET_DIR", &built)
            // The switch that lets a stable compiler build its own library.
            .env("RUSTC_BOOTSTRAP", "1")
            // Cargo omits bitcode from what it does not link with LTO itself,
            // and the project's release profile needs it. Setting the flags
            // here also keeps the project's own (.cargo/config.toml) out of a
            // library that every project on the machine will use.
            .env("RUSTFLAGS", "-Cembed-bitcode=yes")
            .args(["build", "--release", "--target", WASM_TARGET])
            .arg("-Zbuild-std=std,panic_abort,test,proc_macro"),
    )
    .context("cannot build the standard library for wasm")?;

    let folder = library_folder(toolchain)?;
    install(&built.join(WASM_TARGET).join("release/deps"), &folder)
        .with_context(|| format!("cannot put the standard library into {}", folder.display()))?;
    fs::write(folder.join(STAMP), compiler_version(toolchain)?)?;
    Ok(())
}

/// The compiled libraries in a folder.
///
/// # Errors
///
/// Fails when the folder cannot be read.
pub fn libraries(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut libraries = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "rlib")
        {
            libraries.push(path);
        }
    }
    Ok(libraries)
}

/// Replaces the libraries in `to`: the compiler rejects two builds of one crate
/// side by side.
fn install(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for old in libraries(to)? {
        fs::remove_file(old)?;
    }
    for library in libraries(from)? {
        let name = library.file_name().unwrap_or_default();
        if !name.to_string_lossy().starts_with(&format!("lib{SEED}-")) {
            fs::copy(&library, to.join(name))?;
        }
    }
    Ok(())
}

fn library_folder(toolchain: &Toolchain) -> Result<PathBuf> {
    rustc(
        toolchain,
        &["--print", "target-libdir", "--target", WASM_TARGET],
    )
    .map(PathBuf::from)
}

fn compiler_version(toolchain: &Toolchain) -> Result<String> {
    rustc(toolchain, &["-vV"])
}

fn rustc(toolchain: &Toolchain, arguments: &[&str]) -> Result<String> {
    process::output(
        command(toolchain.program("rustc"))
            .args(arguments)
            .env_remove("LD_LIBRARY_PATH"),
    )
}
