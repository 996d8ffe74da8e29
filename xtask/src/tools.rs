//! wasm-pack and wasm-bindgen's programs, in the versions that the project needs.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::{
    process::{self, command, path_with},
    project::Project,
};

/// Installed when no wasm-pack is found.
const WASM_PACK: &str = "0.15.1";
/// The oldest version that is accepted: the first that supports `--no-pack` and
/// the current lock file format.
const OLDEST_WASM_PACK: (u32, u32) = (0, 13);

/// Where the programs are.
pub struct Tools {
    /// The folder to put first on `PATH`.
    pub bin: PathBuf,
    /// wasm-pack itself.
    pub wasm_pack: PathBuf,
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

        let mut missing = Vec::new();
        if find(&bin, "wasm-pack", |found| at_least(found, OLDEST_WASM_PACK)).is_none() {
            missing.push(format!("wasm-pack@{WASM_PACK}"));
        }
        let fits = |found: &str| found == wasm_bindgen;
        if find(&bin, "wasm-bindgen", fits).is_none()
            || find(&bin, "wasm-bindgen-test-runner", fits).is_none()
        {
            missing.push(format!("wasm-bindgen-cli@{wasm_bindgen}"));
        }
        if !missing.is_empty() {
            install(project, &root, &missing)?;
        }

        let found = |name: &str, fits: &dyn Fn(&str) -> bool| {
            find(&bin, name, fits)
                .with_context(|| format!("{name} is missing after its installation"))
        };
        Ok(Self {
            wasm_pack: found("wasm-pack", &|found| at_least(found, OLDEST_WASM_PACK))?,
            test_runner: found("wasm-bindgen-test-runner", &fits)?,
            bin,
        })
    }
}

/// Both tools share most of their dependencies, and so one build. Not `--locked`:
/// their published lock files name withdrawn versions.
fn install(project: &Project, root: &Path, packages: &[String]) -> Result<()> {
    eprintln!("installing {} (minutes, once)", packages.join(" and "));
    process::run(
        process::cargo(project)
            .arg("install")
            .args(packages)
            .arg("--root")
            .arg(root)
            // Leaves out TLS, for drivers on other machines.
            .arg("--no-default-features")
            .env("CARGO_TARGET_DIR", root.join("build"))
            // They run for a second or two: optimising them is not worth the minutes.
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0")
            .env("CARGO_PROFILE_RELEASE_LTO", "off"),
    )
    .with_context(|| format!("cannot install {}", packages.join(" ")))
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

/// The version in a line such as `wasm-bindgen 0.2.130` or `wasm-pack 0.15.1 (…)`.
fn version(text: &str) -> Option<&str> {
    text.split_whitespace().nth(1)
}

fn at_least(version: &str, (major, minor): (u32, u32)) -> bool {
    let mut numbers = version
        .split('.')
        .map_while(|number| number.parse::<u32>().ok());
    match (numbers.next(), numbers.next()) {
        (Some(a), Some(b)) => (a, b) >= (major, minor),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_compare_as_numbers() {
        assert!(at_least("0.15.1", (0, 13)));
        assert!(at_least("1.0.0", (0, 13)));
        assert!(!at_least("0.9.1", (0, 13)));
        assert!(!at_least("nightly", (0, 13)));
    }

    #[test]
    fn version_is_the_second_word() {
        assert_eq!(version("wasm-bindgen 0.2.130"), Some("0.2.130"));
        assert_eq!(version("wasm-bindgen"), None);
    }
}
