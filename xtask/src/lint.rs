//! `cargo xtask lint`: static checks.

use anyhow::Result;

use crate::{
    modules,
    process::{self, cargo},
    project::Project,
    wasm,
};

/// Runs all checks, each regardless of the others. Returns `false` if one failed;
/// a check that cannot run has failed.
pub fn run(project: &Project) -> bool {
    let checks: [(&str, &dyn Fn() -> Result<()>); 5] = [
        ("modules", &|| modules::check(project)),
        ("fmt", &|| {
            process::run(cargo(project).args(["fmt", "--all", "--check"]))
        }),
        ("clippy", &|| {
            process::run(
                cargo(project)
                    .args(["clippy", "--workspace", "--all-targets"])
                    .args(["--", "-D", "warnings"]),
            )
        }),
        ("clippy for wasm", &|| wasm::clippy(project)),
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
