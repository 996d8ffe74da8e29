//! npm: the packages and scripts of `www/`.

use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::{
    process::{self, command},
    project::{Project, modified},
};

/// The oldest Node that the page's tools support.
const OLDEST_NODE: u32 = 20;

/// `npm` in the page's folder, with its packages installed.
pub fn npm(project: &Project) -> Result<Command> {
    ensure_packages(project)?;
    Ok(bare_npm(project))
}

/// Installs exactly the packages of the lock file, if it is newer than those installed.
pub fn ensure_packages(project: &Project) -> Result<()> {
    let needed = format!("Node {OLDEST_NODE} or newer is required: https://nodejs.org");
    let found = process::output(command("node").arg("--version")).context(needed.clone())?;
    // `v20.20.2` is 20.
    let major = found.trim_start_matches('v').split('.').next();
    let major = major.and_then(|major| major.parse::<u32>().ok());
    ensure!(major >= Some(OLDEST_NODE), "{needed}, found {found}");

    // npm writes this file at the end of each installation.
    let installed = modified(&project.www.join("node_modules/.package-lock.json"));
    if installed.is_some() && installed >= modified(&project.www.join("package-lock.json")) {
        return Ok(());
    }
    process::run(bare_npm(project).args(["ci", "--no-audit", "--no-fund"]))
        .context("cannot install the page's packages")
}

fn bare_npm(project: &Project) -> Command {
    // On Windows npm is a script, found only by its full name.
    let mut npm = command(which::which("npm").unwrap_or_else(|_| "npm".into()));
    npm.current_dir(&project.www);
    npm
}
