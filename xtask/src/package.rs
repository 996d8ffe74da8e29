//! `cargo xtask package`: both packages as they would be published, without publishing them.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::{
    node,
    process::{self, cargo, nightly},
    project::Project,
    wasm,
};

/// Files that a package may hold, by the first folder or, with at most one `*`, the name. Each must be there.
struct Contents {
    name: &'static str,
    allowed: &'static [&'static str],
    /// The largest size of the uploaded file, in bytes.
    budget: u64,
}

const CRATE: Contents = Contents {
    name: "crate",
    allowed: &[
        ".cargo_vcs_info.json",
        "ARCHITECTURE.md",
        "CHANGELOG.md",
        "Cargo.lock",
        "Cargo.toml",
        "Cargo.toml.orig",
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "README.md",
        "SECURITY.md",
        "docs/",
        "examples/",
        "shaders/",
        "src/",
        "www/examples/shop/README.md",
    ],
    budget: 1_400_000,
};

const NPM: Contents = Contents {
    name: "npm package",
    allowed: &[
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "NOTICES.txt",
        "README.md",
        "REFERENCE.md",
        "package.json",
        "sbom.json",
        "cusp_slicer_bg.wasm",
        "types/",
        // Chunks have the hash of their content in their names.
        "*.js",
    ],
    budget: 1_495_000,
};

/// Builds both packages and checks them, each regardless of the other. Returns `false` if something is wrong.
pub fn run(project: &Project) -> bool {
    let mut good = true;
    let mut judge = |name: &str, result: Result<()>| {
        if let Err(error) = result {
            eprintln!("error: {name}: {error:#}");
            good = false;
        }
    };
    judge("npm package", npm_package(project));
    judge("crate", crate_package(project));
    println!("package: {}", if good { "ok" } else { "FAILED" });
    good
}

fn npm_package(project: &Project) -> Result<()> {
    wasm::build(project)?;
    process::run(node::npm(project)?.args(["run", "package"]))?;
    let folder = project.www.join("dist-package");
    let tarball = only_file(&folder, "tgz")?;
    let said = process::output(
        node::npm(project)?
            .current_dir(&folder)
            .args(["publish", "--dry-run", "--json"])
            // Without a path prefix npm takes the name for a repository's.
            .arg(format!(
                "./{}",
                tarball.file_name().unwrap_or_default().display()
            )),
    )?;
    let published: Value = serde_json::from_str(&said).context("npm publish")?;
    let packages = published
        .as_object()
        .into_iter()
        .flat_map(|all| all.values());
    let files = packages
        .filter_map(|package| package["files"].as_array())
        .flatten()
        .filter_map(|file| file["path"].as_str().map(str::to_owned));
    check(&NPM, &files.collect::<Vec<_>>(), &folder, &tarball)
}

fn crate_package(project: &Project) -> Result<()> {
    let metadata = process::output(cargo(project).args([
        "metadata",
        "--locked",
        "--no-deps",
        "--format-version=1",
    ]))?;
    let metadata: Value = serde_json::from_str(&metadata).context("cargo metadata")?;
    let packages = metadata["packages"].as_array();
    let own = packages.and_then(|all| all.iter().find(|it| it["name"] == "cusp-slicer"));
    let own = own.context("cargo metadata does not name cusp-slicer")?;
    // A server recomputes plans that a page has sent.
    let description = fs::read_to_string(project.www.join("package.json"))?;
    let of_npm = &serde_json::from_str::<Value>(&description)?["version"];
    ensure!(
        own["version"] == *of_npm,
        "Cargo.toml has version {}, www/package.json {of_npm}",
        own["version"]
    );

    let listed = process::output(cargo(project).args(["package", "--list", "--allow-dirty"]))?;
    // Not compiled once more: the tests have compiled it.
    process::output(cargo(project).args(["publish", "--dry-run", "--no-verify", "--allow-dirty"]))?;
    let folder = project.target.join("package");
    let files: Vec<String> = listed.lines().map(|line| line.replace('\\', "/")).collect();
    // Cargo keeps the packages of dry runs apart.
    let packed = only_file(&folder.join("tmp-crate"), "crate");
    let packed = packed.or_else(|_| only_file(&folder, "crate"))?;
    check(&CRATE, &files, &project.root, &packed)?;

    if process::output(nightly("rustc").arg("--version")).is_err() {
        println!("ignored: documentation as docs.rs builds it — no nightly toolchain");
        return Ok(());
    }
    let features = &own["metadata"]["docs"]["rs"]["features"];
    let features = features.as_array().into_iter().flatten();
    let features: Vec<&str> = features.filter_map(Value::as_str).collect();
    process::run(
        nightly("cargo")
            .current_dir(&project.root)
            .args(["rustdoc", "--locked", "--lib", "--package", "cusp-slicer"])
            .args(["--no-default-features", "--features", &features.join(",")])
            .args(["--", "--cfg", "docsrs", "-D", "warnings"])
            .env("CARGO_TARGET_DIR", project.target.join("docsrs")),
    )
}

/// The file of a folder with an extension.
fn only_file(folder: &Path, extension: &str) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut found = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|it| it == extension));
    let first = found.next();
    ensure!(
        found.next().is_none(),
        "more than one .{extension} in {}",
        folder.display()
    );
    first.with_context(|| format!("no .{extension} in {}", folder.display()))
}

/// Checks the files, the links of the readme and the size of the uploaded file.
fn check(contents: &Contents, files: &[String], folder: &Path, uploaded: &Path) -> Result<()> {
    let Contents {
        name,
        allowed,
        budget,
    } = contents;
    let size = fs::metadata(uploaded)?.len();
    println!(
        "{name}: {} files, {size} bytes, budget {budget}",
        files.len()
    );
    let is = |file: &str, pattern: &str| match pattern.split_once('*') {
        Some((start, end)) => {
            !file.contains('/') && file.starts_with(start) && file[start.len()..].ends_with(end)
        }
        None if pattern.ends_with('/') => file.starts_with(pattern),
        None => file == pattern,
    };
    let mut wrong: Vec<String> = files
        .iter()
        .filter(|file| !allowed.iter().any(|pattern| is(file, pattern)))
        .map(|file| format!("{file} does not belong into it"))
        .collect();
    let missing = allowed
        .iter()
        .filter(|pattern| !files.iter().any(|file| is(file, pattern)));
    wrong.extend(missing.map(|pattern| format!("{pattern} is missing")));
    let readme = fs::read_to_string(folder.join("README.md"))?;
    let dead = links(&readme).filter(|link| {
        let path = link.split('#').next().unwrap_or_default();
        !path.is_empty() && !link.starts_with("https://") && !files.iter().any(|it| it == path)
    });
    wrong.extend(dead.map(|link| format!("README.md: {link} is not in the package")));
    ensure!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    ensure!(
        size <= *budget,
        "over the budget by {} bytes",
        size - budget
    );
    Ok(())
}

/// The targets of links and images in Markdown, except in code.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines()
        .filter(move |line| {
            is_code ^= line.starts_with("```");
            !is_code && !line.starts_with("    ")
        })
        .flat_map(|line| line.split("](").skip(1))
        .filter_map(|rest| rest.split([')', ' ']).next())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strangers_gaps_and_dead_links_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let readme = folder.path().join("README.md");
        fs::write(&readme, "[a](docs/a.md#b) ![c](x.png \"d\")\n```\n[e](f)\n").unwrap();
        let contents = Contents {
            name: "test",
            allowed: &["README.md", "docs/", "*.js", "LICENSE"],
            budget: 1000,
        };
        let names = ["README.md", "docs/a.md", "b-1.js", "e2e/b.js"].map(str::to_owned);
        let error = check(&contents, &names, folder.path(), &readme).unwrap_err();
        let expected = "\ne2e/b.js does not belong into it\nLICENSE is missing\n\
                        README.md: x.png is not in the package";
        assert_eq!(error.to_string(), expected);
    }
}
