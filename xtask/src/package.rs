//! `cargo xtask package`: both packages as they would be published, without publishing them.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use crate::{
    bill, node,
    process::{self, cargo},
    project::Project,
    toolchain::nightly,
    wasm,
};

/// What a package may consist of, by the first folder or, with at most one `*`, the name. Each must be there.
struct Contents {
    allowed: &'static [&'static str],
    /// The largest size of what is uploaded, in bytes.
    budget: u64,
}

const CRATE: Contents = Contents {
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
        "examples/cluster/README.md",
        bill::FILE,
        "shaders/",
        "src/",
        "www/examples/shop/README.md",
    ],
    budget: 1_400_000,
};

const NPM: Contents = Contents {
    allowed: &[
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "NOTICES.txt",
        "README.md",
        "package.json",
        "sbom.json",
        "cusp_*.wasm",
        "types/",
        // Chunks have the hash of their content in their names.
        "*.js",
    ],
    budget: 1_400_000,
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
    judge("versions", same_versions(project));
    judge("npm package", npm_package(project));
    judge("crate", crate_package(project));
    if process::output(nightly("rustc").arg("--version")).is_ok() {
        judge("documentation", document(project));
    } else {
        println!("ignored: documentation as docs.rs builds it — no nightly toolchain");
    }
    println!("package: {}", if good { "ok" } else { "FAILED" });
    good
}

/// Checks that both packages have the same version: a server recomputes what a page has sent.
fn same_versions(project: &Project) -> Result<()> {
    let manifest = fs::read_to_string(project.root.join("Cargo.toml"))?;
    let description = fs::read_to_string(project.www.join("package.json"))?;
    let manifest: toml::Value = toml::from_str(&manifest).context("Cargo.toml")?;
    let description: serde_json::Value = serde_json::from_str(&description)?;
    let of_crate = manifest["package"]["version"].as_str();
    let of_npm = description["version"].as_str();
    ensure!(
        of_crate.is_some() && of_crate == of_npm,
        "Cargo.toml has {of_crate:?}, www/package.json {of_npm:?}"
    );
    Ok(())
}

/// What `npm publish --json` says of a package.
#[derive(Deserialize)]
struct Published {
    files: Vec<PublishedFile>,
}

#[derive(Deserialize)]
struct PublishedFile {
    path: String,
}

fn npm_package(project: &Project) -> Result<()> {
    wasm::build(project)?;
    process::run(node::npm(project)?.args(["run", "package"]))?;
    let folder = project.www.join("dist-package");
    let tarball = only_file(&folder, "tgz")?;
    // npm takes what is no path for a repository's name.
    let argument = format!("./{}", tarball.file_name().unwrap_or_default().display());
    let said = process::output(
        node::npm(project)?
            .current_dir(&folder)
            .args(["publish", "--dry-run", "--json"])
            .arg(argument),
    )?;
    let published: BTreeMap<String, Published> =
        serde_json::from_str(&said).context("npm publish")?;
    let files = published
        .into_values()
        .flat_map(|package| package.files)
        .map(|file| file.path)
        .collect();
    check("npm package", &NPM, files, &folder, &tarball)
}

fn crate_package(project: &Project) -> Result<()> {
    let crates = bill::write_of_crate(project)?;
    println!("{}: {crates} crates", bill::FILE);
    let listed = process::output(cargo(project).args(["package", "--list", "--allow-dirty"]))?;
    // Not compiled once more: it is what the tests have compiled.
    process::output(cargo(project).args(["publish", "--dry-run", "--no-verify", "--allow-dirty"]))?;
    let folder = project.target.join("package");
    let files = listed.lines().map(str::to_owned).collect();
    // Cargo keeps apart what it only tries.
    let packed = only_file(&folder.join("tmp-crate"), "crate");
    let packed = packed.or_else(|_| only_file(&folder, "crate"))?;
    check("crate", &CRATE, files, &project.root, &packed)
}

/// The file of a folder with an extension.
fn only_file(folder: &Path, extension: &str) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut found = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|it| it == extension));
    let first = found.next();
    let first = first.with_context(|| format!("no .{extension} in {}", folder.display()))?;
    ensure!(
        found.next().is_none(),
        "more than one .{extension} in {}",
        folder.display()
    );
    Ok(first)
}

/// Checks the files, the links of the readme and the size of what is uploaded.
fn check(
    name: &str,
    contents: &Contents,
    mut files: Vec<String>,
    folder: &Path,
    uploaded: &Path,
) -> Result<()> {
    for file in &mut files {
        *file = file.replace('\\', "/");
    }
    let readme = fs::read_to_string(folder.join("README.md"))?;
    let size = fs::metadata(uploaded)?.len();
    let budget = contents.budget;
    println!(
        "{name}: {} files, {size} bytes, budget {budget}",
        files.len()
    );
    let mut wrong = wrong_contents(contents.allowed, &files);
    wrong.extend(
        links(&readme)
            .filter(|link| !leads_somewhere(link, &files))
            .map(|link| format!("README.md: {link} is not in the package")),
    );
    if size > budget {
        wrong.push(format!("over the budget by {} bytes", size - budget));
    }
    ensure!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    Ok(())
}

/// Files that do not belong into a package, and what is missing.
fn wrong_contents(allowed: &[&str], files: &[String]) -> Vec<String> {
    let is = |file: &str, pattern: &str| match pattern.split_once('*') {
        Some((start, end)) => {
            !file.contains('/') && file.starts_with(start) && file[start.len()..].ends_with(end)
        }
        None if pattern.ends_with('/') => file.starts_with(pattern),
        None => file == pattern,
    };
    let strangers = files
        .iter()
        .filter(|file| !allowed.iter().any(|pattern| is(file, pattern)))
        .map(|file| format!("{file} does not belong into it"));
    let missing = allowed
        .iter()
        .filter(|pattern| !files.iter().any(|file| is(file, pattern)))
        .map(|pattern| format!("{pattern} is missing"));
    strangers.chain(missing).collect()
}

/// Where the links and images of a text in Markdown lead. What looks like one in code is none.
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

/// Whether a link leads to a file of the package, to a place in the text itself, or to another host.
fn leads_somewhere(link: &str, files: &[String]) -> bool {
    let path = link.split('#').next().unwrap_or_default();
    path.is_empty() || link.starts_with("https://") || files.iter().any(|file| file == path)
}

/// Documents the library as docs.rs does, with the features that the manifest names for it. What that compiles is kept apart.
fn document(project: &Project) -> Result<()> {
    let manifest = fs::read_to_string(project.root.join("Cargo.toml"))?;
    let features = docs_features(&manifest)?.join(",");
    process::run(
        nightly("cargo")
            .current_dir(&project.root)
            .args(["rustdoc", "--locked", "--lib", "--package", "cusp-slicer"])
            .args(["--no-default-features", "--features", &features])
            .args(["--", "--cfg", "docsrs", "-D", "warnings"])
            .env("CARGO_TARGET_DIR", project.target.join("docsrs")),
    )
}

/// The features of `[package.metadata.docs.rs]`.
fn docs_features(manifest: &str) -> Result<Vec<String>> {
    let manifest: toml::Value = toml::from_str(manifest).context("Cargo.toml")?;
    let features = ["package", "metadata", "docs", "rs", "features"]
        .iter()
        .try_fold(&manifest, |table, key| table.get(key))
        .context("Cargo.toml names no features for docs.rs")?;
    Ok(features.clone().try_into()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    #[test]
    fn leftovers_do_not_belong_into_a_package() {
        let allowed = ["README.md", "*.js", "cusp_*.wasm", "types/"];
        let good = [
            "README.md",
            "view-1a2b.js",
            "cusp_gpu_bg.wasm",
            "types/a/b.d.ts",
        ];
        assert_eq!(wrong_contents(&allowed, &files(&good)), [""; 0]);
        for stranger in [
            "pkg/cusp.js",
            "other.wasm",
            "README.md.orig",
            "typesx",
            "e2e/a.js",
        ] {
            let wrong = wrong_contents(&allowed, &files(&[&good[..], &[stranger]].concat()));
            assert_eq!(wrong, [format!("{stranger} does not belong into it")]);
        }
        let wrong = wrong_contents(&allowed, &files(&good[1..]));
        assert_eq!(wrong, ["README.md is missing"]);
    }

    #[test]
    fn links_are_found_outside_of_code() {
        let text = "[a](b.md) and ![c](d.png \"e\")\n```\n[f](g)\n```\n    [h](i)\n| [j](k#l) |";
        assert_eq!(links(text).collect::<Vec<_>>(), ["b.md", "d.png", "k#l"]);
    }

    #[test]
    fn a_link_leads_into_the_package_or_to_another_host() {
        let files = files(&["docs/cli.md"]);
        for good in [
            "docs/cli.md",
            "docs/cli.md#batches",
            "#here",
            "https://rustup.rs",
        ] {
            assert!(leads_somewhere(good, &files), "{good}");
        }
        for bad in [
            "docs/none.md",
            "../docs/cli.md",
            "http://rustup.rs",
            "cli.md#a",
        ] {
            assert!(!leads_somewhere(bad, &files), "{bad}");
        }
    }

    #[test]
    fn the_features_for_documentation_are_the_manifests() {
        let manifest = "[package.metadata.docs.rs]\nfeatures = [\"read\"]";
        assert_eq!(docs_features(manifest).unwrap(), ["read"]);
        assert!(docs_features("[package]").is_err());
    }
}
