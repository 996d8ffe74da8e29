//! `cargo xtask lint`: static checks.

use std::{
    cell::RefCell,
    thread::{self, ScopedJoinHandle},
};

use anyhow::{Result, anyhow, bail};

use crate::{
    modules, node,
    process::{self, cargo},
    project::Project,
    supply, wasm,
};

/// The check that needs the WebAssembly package.
const OXLINT: &str = "oxlint";

/// Runs the checks of the given names, or all, each regardless of the others. Returns `false` if one failed; a check that cannot
/// run has failed, but for those that need another machine, which are named.
///
/// # Errors
///
/// Fails if no check has one of the names.
pub fn run(project: &Project, names: &[String]) -> Result<bool> {
    thread::scope(|scope| {
        // A module is linked by one thread, which takes minutes: the other checks run beside it.
        let build = is_chosen(OXLINT, names).then(|| scope.spawn(|| wasm::build(project)));
        check(project, names, &RefCell::new(build))
    })
}

fn is_chosen(name: &str, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|chosen| chosen == name)
}

type Build<'a> = RefCell<Option<ScopedJoinHandle<'a, Result<()>>>>;

fn check(project: &Project, names: &[String], build: &Build<'_>) -> Result<bool> {
    let ignored = RefCell::new(Vec::new());
    let checks: [(&str, &dyn Fn() -> Result<()>); 11] = [
        ("modules", &|| modules::check(project)),
        ("fmt", &|| {
            process::run(cargo(project).args(["fmt", "--all", "--check"]))
        }),
        // Clippy would have to compile all that its tests need a second time.
        ("fmt of interop", &|| {
            format_apart(project, "tests/interop/Cargo.toml")
        }),
        ("fmt of fuzz", &|| format_apart(project, "fuzz/Cargo.toml")),
        // Nothing else compiles it: it needs a nightly compiler to run.
        ("check of fuzz", &|| {
            process::run(
                cargo(project)
                    .args(["check", "--manifest-path", "fuzz/Cargo.toml"])
                    .env("CARGO_TARGET_DIR", project.target.join("fuzz")),
            )
        }),
        ("cargo deny", &|| {
            ignored.borrow_mut().extend(supply::check_crates(project)?);
            Ok(())
        }),
        ("npm licences", &|| supply::check_npm(project)),
        ("clippy", &|| {
            process::run(
                cargo(project)
                    .args(["clippy", "--workspace", "--all-targets"])
                    .args(["--", "-D", "warnings"]),
            )
        }),
        ("doc", &|| {
            process::run(
                cargo(project)
                    .args(["doc", "--workspace", "--no-deps"])
                    .env("RUSTDOCFLAGS", "-D warnings"),
            )
        }),
        (OXLINT, &|| oxlint(project, build.take())),
        // In the target folder of that package, so after it.
        ("clippy for wasm", &|| wasm::clippy(project)),
    ];
    if let Some(unknown) = names
        .iter()
        .find(|&name| !checks.iter().any(|(known, _)| known == name))
    {
        let known = checks.map(|(name, _)| name).join(", ");
        bail!("no check is called {unknown}; they are: {known}");
    }
    let mut failed = Vec::new();
    for (name, check) in checks {
        if !is_chosen(name, names) {
            continue;
        }
        if let Err(error) = check() {
            eprintln!("error: {error:#}");
            failed.push(name);
        }
    }
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

/// Checks the format of a workspace of its own.
fn format_apart(project: &Project, manifest: &str) -> Result<()> {
    process::run(cargo(project).args(["fmt", "--manifest-path", manifest, "--check"]))
}

/// Lints the TypeScript. Its rules know types, and without those that the wasm
/// package declares they would report every value of them.
fn oxlint(project: &Project, build: Option<ScopedJoinHandle<'_, Result<()>>>) -> Result<()> {
    if let Some(build) = build {
        build.join().map_err(|_| anyhow!("the build panicked"))??;
    }
    process::run(node::npm(project)?.args(["run", "--silent", "lint"]))
}
