//! `cargo xtask lint`: every check that reads the sources.

use std::{cell::RefCell, thread};

use anyhow::{Result, bail};

use crate::{
    modules, node,
    process::{self, cargo, command},
    project::Project,
    python, wasm,
};

/// The workspaces, with the checks of cargo-deny for each. Only the first one is shipped, so duplicates matter only
/// there.
const WORKSPACES: [(&str, &[&str]); 3] = [
    ("Cargo.toml", &["bans", "licenses", "sources"]),
    ("fuzz/Cargo.toml", &["licenses", "sources"]),
    ("tests/interop/Cargo.toml", &["licenses", "sources"]),
];

/// Lints the TypeScript. Its rules know types, and without those of the built modules they would report every value of them.
const OXLINT: &str = "oxlint";

/// Runs the checks with these names, or all, each regardless of the others. Returns `false` if one failed; a check that cannot
/// run has failed, but for those that need another machine, which are named.
pub fn run(project: &Project, names: &[String]) -> Result<bool> {
    let ignored = RefCell::new(Vec::new());
    let checks: [(&str, &dyn Fn() -> Result<()>); 9] = [
        ("modules", &|| modules::check(project)),
        ("fmt", &|| {
            process::run(cargo(project).args(["fmt", "--all", "--check"]))?;
            // Clippy would have to compile all that their tests need a second time.
            WORKSPACES[1..].iter().try_for_each(|(manifest, _)| {
                process::run(cargo(project).args(["fmt", "--check", "--manifest-path", manifest]))
            })
        }),
        ("deny", &|| {
            ignored.borrow_mut().extend(deny(project)?);
            Ok(())
        }),
        ("clippy", &|| {
            process::run(
                cargo(project)
                    .args(["clippy", "--workspace", "--all-targets"])
                    .args(["--", "-D", "warnings"]),
            )
        }),
        // Nothing else compiles it: it needs a nightly compiler to run.
        ("fuzz", &|| {
            process::run(cargo(project).args(["check", "--manifest-path", "fuzz/Cargo.toml"]))
        }),
        ("doc", &|| {
            process::run(
                cargo(project)
                    .args(["doc", "--workspace", "--no-deps"])
                    .env("RUSTDOCFLAGS", "-D warnings"),
            )
        }),
        ("wasm", &|| wasm::clippy(project)),
        (OXLINT, &|| {
            wasm::build(project)?;
            process::run(node::npm(project)?.args(["run", "--silent", "lint"]))
        }),
        ("types", &|| {
            wasm::build(project)?;
            process::run(node::npm(project)?.args(["run", "--silent", "check"]))
        }),
    ];
    if let Some(unknown) = names
        .iter()
        .find(|&name| !checks.iter().any(|(known, _)| known == name))
    {
        let known = checks.map(|(name, _)| name).join(", ");
        bail!("no check is called {unknown}; they are: {known}");
    }
    let is_chosen = |name: &str| names.is_empty() || names.iter().any(|chosen| chosen == name);
    let failed = thread::scope(|scope| {
        // One thread links a module for a minute: the other checks run in the meantime. A failure shows in the check.
        if is_chosen(OXLINT) {
            scope.spawn(|| wasm::build(project));
        }
        let mut failed = Vec::new();
        for (name, check) in checks {
            if !is_chosen(name) {
                continue;
            }
            if let Err(error) = check() {
                eprintln!("error: {error:#}");
                failed.push(name);
            }
        }
        failed
    });
    for what in ignored.take() {
        println!("ignored: {what}");
    }
    if failed.is_empty() {
        println!("lint: ok");
    } else {
        println!("lint: FAILED: {}", failed.join(", "));
    }
    Ok(failed.is_empty())
}

/// Checks the crates of all workspaces: licences, sources, duplicates and advisories. Returns what could not be checked here, and why.
fn deny(project: &Project) -> Result<Vec<String>> {
    let program = python::program(project, "cargo-deny")?;
    let call = |manifest: &str| {
        let mut command = command(&program);
        command
            .current_dir(&project.root)
            .args(["--locked", "--log-level", "warn"])
            .args(["--config", "deny.toml", "--manifest-path", manifest]);
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
