//! wasm-bindgen's programs, in the version that the project needs.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::{
    process::{self, command, path_with},
    project::Project,
};

/// Where the programs are.
pub struct Tools {
    /// The folder to put first on `PATH`.
    pub bin: PathBuf,
    /// What binds a module to JavaScript.
    pub wasm_bindgen: PathBuf,
    /// The runner of wasm test binaries in a browser.
    pub test_runner: PathBuf,
}

impl Tools {
    /// Finds the programs or installs them under the target folder.
    ///
    /// # Errors
    ///
    /// Fails when Cargo.lock does not name wasm-bindgen or a tool cannot be built.
    pub fn ensure(project: &Project) -> Result<Self> {
        let root = project.target.join("tools");
        let bin = root.join("bin");
        // The programs and the library share an unstable format, so the versions
        // must be equal.
        let wasm_bindgen = project.locked_version("wasm-bindgen")?;

        let fits = |found: &str| found == wasm_bindgen;
        if find(&bin, "wasm-bindgen", fits).is_none()
            || find(&bin, "wasm-bindgen-test-runner", fits).is_none()
        {
            install(project, &root, &format!("wasm-bindgen-cli@{wasm_bindgen}"))?;
        }

        let found = |name: &str| {
            find(&bin, name, fits)
                .with_context(|| format!("{name} is missing after its installation"))
        };
        Ok(Self {
            wasm_bindgen: found("wasm-bindgen")?,
            test_runner: found("wasm-bindgen-test-runner")?,
            bin,
        })
    }
}

/// Not `--locked`: its published lock file names withdrawn versions.
fn install(project: &Project, root: &Path, package: &str) -> Result<()> {
    eprintln!("installing {package} (minutes, once)");
    process::run(
        process::cargo(project)
            .arg("install")
            .arg(package)
            .arg("--root")
            .arg(root)
            // Leaves out TLS, for drivers on other machines.
            .arg("--no-default-features")
            .env("CARGO_TARGET_DIR", root.join("build"))
            // It runs for a second or two: optimising it is not worth the minutes.
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0")
            .env("CARGO_PROFILE_RELEASE_LTO", "off"),
    )
    .with_context(|| format!("cannot install {package}"))
}

/// The first program of this name with an acceptable version: our own, then `PATH`'s.
fn find(bin: &Path, name: &str, fits: impl Fn(&str) -> bool) -> Option<PathBuf> {
    let path = path_with([bin]).ok()?;
    which::which_in_all(name, Some(path), ".")
        .ok()?
        .find(|program| {
            process::output(command(program).arg("--version"))
                .is_ok_and(|text| version(&text).is_some_and(&fits))
        })
}

/// The version in a line such as `wasm-bindgen 0.2.130`.
fn version(text: &str) -> Option<&str> {
    text.split_whitespace().nth(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_is_the_second_word() {
        assert_eq!(version("wasm-bindgen 0.2.130"), Some("0.2.130"));
        assert_eq!(version("wasm-bindgen"), None);
    }
}
