//! Python: the cluster example, the peers of the tests, programs that are Python packages, and their lists.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};

use crate::{
    process::{self, command},
    project::Project,
};

/// The oldest Python that these packages support.
const OLDEST_PYTHON: (u32, u32) = (3, 11);

/// The example's folder.
pub fn example(project: &Project) -> PathBuf {
    project.root.join("examples/cluster")
}

/// The folder of the peers that are in Python.
pub fn peers(project: &Project) -> PathBuf {
    project.root.join("tests/interop/python")
}

/// The Python of a virtual environment with exactly the packages that the
/// list of a folder names; recreated when the list changes.
///
/// # Errors
///
/// Fails when Python or its venv module is missing or too old, or the packages
/// cannot be installed.
pub fn ensure_environment(project: &Project, of: &Path) -> Result<PathBuf> {
    let list = of.join("requirements.txt");
    let wanted =
        fs::read_to_string(&list).with_context(|| format!("cannot read {}", list.display()))?;
    let name = of.strip_prefix(&project.root).unwrap_or(of);
    let name = name.to_string_lossy().replace(['/', '\\'], "-");
    let folder = project.target.join("python").join(name);
    // Written last, so that an interrupted environment is recreated.
    let stamp = folder.join("installed.txt");
    let python = folder.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    let works = || process::output(command(&python).arg("--version")).is_ok();
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) && works() {
        return Ok(python);
    }

    let system = system_python()?;
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    process::run(command(system).args(["-m", "venv"]).arg(&folder))
        .context("cannot create a virtual environment")?;
    process::run(
        pip(&python)
            // Nothing that is not on the list may be installed silently.
            .args(["install", "--quiet", "--no-deps", "--requirement"])
            .arg(&list),
    )
    .with_context(|| format!("cannot install the packages of {}", list.display()))?;
    fs::write(&stamp, wanted).with_context(|| format!("cannot write {}", stamp.display()))?;
    Ok(python)
}

/// A program of cargo's that is a Python package: from the list with hashes in `xtask/NAME`, so that everybody runs the same.
///
/// # Errors
///
/// Those of [`ensure_environment`].
pub fn program(project: &Project, name: &str) -> Result<PathBuf> {
    let python = ensure_environment(project, &project.root.join("xtask").join(name))?;
    Ok(python.with_file_name(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
}

/// `pip` of an environment.
pub fn pip(python: &Path) -> Command {
    let mut pip = command(python);
    pip.args(["-m", "pip", "--disable-pip-version-check"]);
    pip
}

/// The machine's own Python.
fn system_python() -> Result<PathBuf> {
    let (major, minor) = OLDEST_PYTHON;
    let needed = format!("Python {major}.{minor} or newer is required: https://www.python.org");
    for name in ["python3", "python"] {
        let Ok(found) = which::which(name) else {
            continue;
        };
        let text = process::output(command(&found).arg("--version"))?;
        match version(&text) {
            Some(number) if number >= OLDEST_PYTHON => return Ok(found),
            _ => bail!("{needed}, found {text}"),
        }
    }
    bail!(needed)
}

/// `Python 3.11.7` is 3 and 11.
fn version(text: &str) -> Option<(u32, u32)> {
    let mut numbers = text.strip_prefix("Python ")?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_is_the_first_two_numbers() {
        assert_eq!(version("Python 3.11.7"), Some((3, 11)));
        assert_eq!(version("Python 3.14.0rc1"), Some((3, 14)));
        assert_eq!(version("pyenv: no such command"), None);
    }
}
