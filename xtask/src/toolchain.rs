//! The compiler for wasm.
//!
//! Usually the one that built xtask, with rustup's wasm target. Where rustup
//! cannot fetch a target but Debian's packages are available, Debian's compiler
//! builds everything for wasm; native builds stay with rustup's.

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};

use crate::{
    debian,
    process::{self, command, path_with},
    project::Project,
    wasm_std,
};

/// The target of the browser build.
pub const WASM_TARGET: &str = "wasm32-unknown-unknown";

/// Debian's current compiler, beside the distribution's default one.
const COMPILER_PACKAGES: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "lld-22"];
const CLIPPY_PACKAGE: &str = "rust-web-clippy";
const LINKER: &str = "wasm-ld-22";

/// What rustup's cargo sets for xtask, and would mislead the cargo of another toolchain.
const VARIABLES: [&str; 5] = [
    "CARGO",
    "RUSTC",
    "RUSTDOC",
    "RUSTUP_TOOLCHAIN",
    "LD_LIBRARY_PATH",
];

/// A program that runs with rustup's nightly toolchain, or is one of it.
pub fn nightly(program: impl AsRef<OsStr>) -> Command {
    let mut rustup = command("rustup");
    for name in VARIABLES {
        rustup.env_remove(name);
    }
    rustup.args(["run", "nightly"]).arg(program);
    rustup
}

/// A compiler with a standard library for [`WASM_TARGET`].
pub enum Toolchain {
    /// The compiler on `PATH`.
    Default,
    /// Debian's, in this folder under the usual names.
    Debian {
        /// A folder with only Debian's cargo, rustc and related tools, so that
        /// putting it first on `PATH` changes nothing else.
        bin: PathBuf,
    },
}

impl Toolchain {
    /// Finds or sets up a compiler for wasm.
    ///
    /// # Errors
    ///
    /// Fails if neither way works; the error says what is missing and how to
    /// get it.
    pub fn ensure(project: &Project) -> Result<Self> {
        if has_wasm_std(command("rustc").current_dir(&project.root)) {
            return Ok(Self::Default);
        }
        // Asking rustup costs a network round trip: skip it where it has failed before.
        let bin = project.target.join("debian-rust");
        if debian::is_debian() {
            link_tools(&bin)?;
        }
        let debian = Self::Debian { bin };
        if wasm_std::is_current(&debian) && debian::ensure(&COMPILER_PACKAGES).is_ok() {
            return Ok(debian);
        }
        let Err(no_target) = add_target(project) else {
            return Ok(Self::Default);
        };
        eprintln!("{no_target:#}");
        if !debian::is_debian() {
            bail!(
                "no standard library for {WASM_TARGET}. Get it with `rustup target add {WASM_TARGET}` \
                 (rustup: https://rustup.rs)"
            );
        }
        eprintln!("rustup has no {WASM_TARGET} here: setting up Debian's compiler for it");
        debian.set_up(project).with_context(|| {
            format!(
                "no standard library for {WASM_TARGET}: get it with `rustup target add {WASM_TARGET}`; \
                 without it, as root, this command sets up Debian's compiler ({})",
                COMPILER_PACKAGES.join(" ")
            )
        })?;
        Ok(debian)
    }

    /// The same compiler's clippy.
    ///
    /// # Errors
    ///
    /// Fails when it is missing and cannot be installed.
    pub fn ensure_clippy(&self) -> Result<()> {
        match self {
            Self::Default => process::output(command("cargo").args(["clippy", "--version"]))
                .map(drop)
                .context("clippy is missing: install it with `rustup component add clippy`"),
            Self::Debian { bin } => {
                debian::ensure(&[CLIPPY_PACKAGE])?;
                link_tools(bin)
            }
        }
    }

    /// A command that compiles for wasm or calls something that does.
    /// `folders` come first on its `PATH`.
    ///
    /// # Errors
    ///
    /// Fails when a folder's name cannot be part of `PATH`.
    pub fn command<'a>(
        &'a self,
        project: &Project,
        program: &Path,
        folders: impl IntoIterator<Item = &'a Path>,
    ) -> Result<Command> {
        let mut command = command(program);
        command.current_dir(&project.root);
        command.env("CARGO_TARGET_DIR", wasm_target_folder(project));
        // Cargo ignores the profile's panic setting for tests. On this target it
        // changes nothing, but a difference would compile each dependency twice.
        command.env("CARGO_PROFILE_RELEASE_PANIC", "unwind");
        match self {
            Self::Default => {
                command.env("PATH", path_with(folders)?);
            }
            Self::Debian { bin } => {
                command.env(
                    "PATH",
                    path_with([bin.as_path()].into_iter().chain(folders))?,
                );
                for name in VARIABLES {
                    command.env_remove(name);
                }
                command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", LINKER);
            }
        }
        Ok(command)
    }

    /// This compiler's `cargo`, for wasm.
    ///
    /// # Errors
    ///
    /// As [`Self::command`].
    pub fn cargo<'a>(
        &'a self,
        project: &Project,
        folders: impl IntoIterator<Item = &'a Path>,
    ) -> Result<Command> {
        self.command(project, &self.program("cargo"), folders)
    }

    /// The path of one of the compiler's programs.
    pub fn program(&self, name: &str) -> PathBuf {
        match self {
            Self::Default => name.into(),
            Self::Debian { bin } => bin.join(name),
        }
    }

    fn set_up(&self, project: &Project) -> Result<()> {
        debian::ensure(&COMPILER_PACKAGES)?;
        if !debian::is_root() {
            bail!("only root may write to the compiler's folder");
        }
        if let Self::Debian { bin } = self {
            link_tools(bin)?;
        }
        wasm_std::build(self, project)
    }
}

/// Cargo's target folder for wasm builds. Two compilers that share a folder
/// rebuild each other's output.
pub fn wasm_target_folder(project: &Project) -> PathBuf {
    project.target.join("wasm")
}

/// Whether this `rustc` has a standard library for wasm.
fn has_wasm_std(rustc: &mut Command) -> bool {
    let Ok(folder) =
        process::output(rustc.args(["--print", "target-libdir", "--target", WASM_TARGET]))
    else {
        return false;
    };
    wasm_std::libraries(Path::new(&folder)).is_ok_and(|files| {
        files
            .iter()
            .any(|file| file_name(file).starts_with("libstd-"))
    })
}

fn add_target(project: &Project) -> Result<()> {
    let mut rustup = command("rustup");
    process::output(
        rustup
            .args(["target", "add", WASM_TARGET])
            .current_dir(&project.root),
    )
    .map(drop)
}

/// Fills `bin` with links to the installed Debian tools.
fn link_tools(bin: &Path) -> Result<()> {
    fs::create_dir_all(bin)?;
    for tool in ["cargo", "rustc", "rustdoc", "cargo-clippy", "clippy-driver"] {
        let installed = Path::new("/usr/bin").join(tool);
        let link = bin.join(tool);
        if installed.exists() && !link.exists() {
            symlink(&installed, &link)?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn symlink(original: &Path, link: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(original, link)
}

/// Debian always has links; this only lets xtask compile elsewhere.
#[cfg(not(unix))]
fn symlink(original: &Path, link: &Path) -> std::io::Result<()> {
    fs::copy(original, link).map(drop)
}

fn file_name(path: &Path) -> std::borrow::Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}
