//! Paths in the checkout.

use std::{
    env,
    path::{Path, PathBuf},
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
    ///
    /// # Errors
    ///
    /// Fails when the manifest's folder has no parent.
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
    ///
    /// # Errors
    ///
    /// Fails when the lock file cannot be read or does not name the package.
    pub fn locked_version(&self, package: &str) -> Result<String> {
        let path = self.root.join("Cargo.lock");
        let lock = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        locked_version(&lock, package)
            .with_context(|| format!("Cargo.lock does not name {package}"))
            .map(str::to_owned)
    }
}

/// Cargo writes one `name` line and right after it one `version` line a package.
fn locked_version<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let name = format!("name = \"{package}\"");
    let mut lines = lock.lines();
    lines.find(|line| *line == name)?;
    lines
        .next()?
        .strip_prefix("version = \"")?
        .strip_suffix('"')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locked_version_takes_the_whole_name() {
        let lock = "\
[[package]]
name = \"wasm-bindgen-test\"
version = \"0.3.80\"

[[package]]
name = \"wasm-bindgen\"
version = \"0.2.130\"
";
        assert_eq!(locked_version(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(locked_version(lock, "wasm"), None);
    }
}
