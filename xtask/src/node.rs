//! npm: the packages and scripts of `www/`.

use std::{fs, path::PathBuf, process::Command, time::SystemTime};

use anyhow::{Context, Result, bail};

use crate::{
    process::{self, command},
    project::Project,
};

/// The oldest Node that the page's tools support.
const OLDEST_NODE: u32 = 20;

/// `npm` in the page's folder, with its packages installed.
///
/// # Errors
///
/// Fails when Node is missing or too old, or the packages cannot be installed.
pub fn npm(project: &Project) -> Result<Command> {
    ensure_packages(project)?;
    Ok(bare_npm(project))
}

/// Builds `www/dist`. The wasm package must have been built.
///
/// # Errors
///
/// Fails when the packages cannot be installed or the build fails.
pub fn build_page(project: &Project) -> Result<()> {
    process::run(npm(project)?.args(["run", "build"]))
}

/// The folder of the packages' executables.
pub fn bin(project: &Project) -> PathBuf {
    project.www.join("node_modules/.bin")
}

/// Installs exactly what the lock file names, if that is newer than what is
/// installed.
///
/// # Errors
///
/// Fails when Node is missing or too old, or npm fails.
pub fn ensure_packages(project: &Project) -> Result<()> {
    check_node()?;
    // npm writes this file at the end of each installation.
    let installed = modified(project.www.join("node_modules/.package-lock.json"));
    let locked = modified(project.www.join("package-lock.json"));
    if installed.is_some() && installed >= locked {
        return Ok(());
    }
    process::run(bare_npm(project).args(["ci", "--no-audit", "--no-fund"]))
        .context("cannot install the page's packages")
}

fn bare_npm(project: &Project) -> Command {
    // On Windows npm is a script, found only by its full name.
    let program = which::which("npm").unwrap_or_else(|_| "npm".into());
    let mut npm = command(program);
    npm.current_dir(&project.www);
    npm
}

fn check_node() -> Result<()> {
    let found = process::output(command("node").arg("--version"))
        .with_context(|| format!("Node {OLDEST_NODE} or newer is required: https://nodejs.org"))?;
    match major(&found) {
        Some(number) if number >= OLDEST_NODE => Ok(()),
        _ => bail!("Node {OLDEST_NODE} or newer is required, found {found}: https://nodejs.org"),
    }
}

/// `v20.20.2` is 20.
fn major(version: &str) -> Option<u32> {
    version.strip_prefix('v')?.split('.').next()?.parse().ok()
}

fn modified(path: PathBuf) -> Option<SystemTime> {
    fs::metadata(path).and_then(|data| data.modified()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn major_is_the_first_number() {
        assert_eq!(major("v20.20.2"), Some(20));
        assert_eq!(major("20"), None);
    }
}
