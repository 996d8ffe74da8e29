//! Paths in the checkout.

use std::{
    env, fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

use anyhow::{Context, Result};

/// The folders that the commands work in. All paths are absolute.
pub struct Project {
    /// The checkout's root.
    pub root: PathBuf,
    /// The npm project: page, element and package.
    pub www: PathBuf,
    /// Cargo's target folder. xtask keeps its own files there too, so that `cargo
    /// clean` removes them.
    pub target: PathBuf,
}

impl Project {
    /// The project that this xtask was started from.
    pub fn here() -> Result<Self> {
        // The variable that cargo sets at run time is correct even if a target
        // folder was moved with its checkout; the built-in one is not.
        let manifest =
            env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").into());
        let root = Path::new(&manifest)
            .parent()
            .context("xtask is not in a workspace")?
            .to_path_buf();
        let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
        Ok(Self {
            www: root.join("www"),
            target: root.join(target),
            root,
        })
    }

    /// The version of a package that Cargo.lock pins.
    pub fn locked_version(&self, package: &str) -> Result<String> {
        let lock = fs::read_to_string(self.root.join("Cargo.lock")).context("no Cargo.lock")?;
        let name = format!("name = \"{package}\"");
        // The line after a name is its version.
        let line = lock.lines().skip_while(|line| *line != name).nth(1);
        line.and_then(|line| line.strip_prefix("version = \"")?.strip_suffix('"'))
            .with_context(|| format!("Cargo.lock does not name {package}"))
            .map(str::to_owned)
    }
}

/// The time of the latest change of a file, or of anything in a folder; none if it does not exist.
pub fn modified(path: &Path) -> Option<SystemTime> {
    let data = fs::metadata(path).ok()?;
    let mut latest = data.modified().ok()?;
    if data.is_dir() {
        for entry in fs::read_dir(path).ok()?.flatten() {
            latest = modified(&entry.path()).map_or(latest, |time| time.max(latest));
        }
    }
    Some(latest)
}
