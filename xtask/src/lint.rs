//! `cargo xtask lint`: static checks.

use anyhow::Result;

use crate::{
    modules, node,
    process::{self, cargo},
    project::Project,
    wasm,
};

/// Runs all checks, each regardless of the others. Returns `false` if one failed;
/// a check that cannot run has failed.
pub fn run(project: &Project) -> bool {
    let checks: [(&str, &dyn Fn() -> Result<()>); 9] = [
        ("modules", &|| modules::check(project)),
        ("fmt", &|| {
            process::run(cargo(project).args(["fmt", "--all", "--check"]))
        }),
        // Clippy would have to compile all that its tests need a second time.
        ("fmt of peers", &|| {
            format_apart(project, "peers/Cargo.toml")
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
        ("clippy", &|| {
            process::run(
                cargo(project)
                    .args(["clippy", "--workspace", "--all-targets"])
                    .args(["--", "-D", "warnings"]),
            )
        }),
        ("clippy for wasm", &|| wasm::clippy(project)),
        ("oxlint", &|| oxlint(project)),
        ("doc", &|| {
            process::run(
                cargo(project)
                    .args(["doc", "--workspace", "--no-deps"])
                    .env("RUSTDOCFLAGS", "-D warnings"),
            )
        }),
    ];
    let mut failed = Vec::new();
    for (name, check) in checks {
        if let Err(error) = check() {
            eprintln!("error: {error:#}");
            failed.push(name);
        }
    }
    if failed.is_empty() {
        println!("lint: ok");
    } else {
        println!("lint: FAILED: {}", failed.join(", "));
    }
    failed.is_empty()
}

/// Checks the format of a workspace of its own.
fn format_apart(project: &Project, manifest: &str) -> Result<()> {
    process::run(cargo(project).args(["fmt", "--manifest-path", manifest, "--check"]))
}

/// Lints the TypeScript. Its rules know types, and without those that the wasm
/// package declares they would report every value of them.
fn oxlint(project: &Project) -> Result<()> {
    wasm::build(project)?;
    process::run(node::npm(project)?.args(["run", "--silent", "lint"]))
}
