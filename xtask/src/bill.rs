//! Bills of materials: which crates are in what is shipped, with their licences.
//!
//! `cargo tree` knows what a package links for a target with its features, `cargo metadata` where the crates lie, and the lock file
//! their checksums. The npm package's bill, which has npm packages too, is made of `www/pkg/crates.json` by `www/package/bill.ts`.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::{
    process::{self, cargo},
    project::Project,
};

/// A crate of somebody else's.
#[derive(Clone, Serialize)]
struct Crate {
    name: String,
    version: String,
    license: String,
    /// SHA-256 of the package, in hexadecimal digits.
    checksum: String,
}

/// Name and version.
type Key = (String, String);

/// The file of the crate's own bill, in the checkout's root, from where Cargo packs it.
pub const FILE: &str = "sbom.json";

/// Writes the crates that are linked into the modules, with their licences' texts: what the npm package must name and repeat.
/// `modules` are packages with the names of their files.
///
/// # Errors
///
/// Fails when Cargo does, or a crate has no licence.
pub fn write_of_modules<'a>(
    project: &Project,
    target: &str,
    rustc: &str,
    modules: impl IntoIterator<Item = (&'a str, Vec<String>)>,
) -> Result<()> {
    #[derive(Serialize)]
    struct Linked {
        #[serde(flatten)]
        own: Crate,
        /// The modules that it is linked into.
        files: Vec<String>,
        notices: Vec<String>,
    }
    let known = Known::read(project, &["--filter-platform", target])?;
    let mut found_in: BTreeMap<Key, Vec<String>> = BTreeMap::new();
    for (package, files) in modules {
        let tree = [
            "--target",
            target,
            "--no-default-features",
            "--package",
            package,
        ];
        for key in linked(project, &tree)? {
            found_in.entry(key).or_default().extend_from_slice(&files);
        }
    }
    let crates = found_in
        .into_iter()
        .map(|(key, files)| {
            let own = known.describe(&key)?;
            let notices = notices(known.folder(&key)?, &own.license)?;
            Ok(Linked {
                own,
                files,
                notices,
            })
        })
        .collect::<Result<Vec<_>>>()?;
    let text = serde_json::to_string_pretty(&json!({ "rustc": rustc, "crates": crates }))?;
    let file = project.www.join("pkg/crates.json");
    // The page's tools watch the folder.
    if fs::read_to_string(&file).is_ok_and(|found| found == text) {
        return Ok(());
    }
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))
}

/// Writes the bill of the crate: what the library and the command line link, on any platform, as the lock file has it. Returns
/// the number of crates.
///
/// # Errors
///
/// As [`write_of_modules`].
pub fn write_of_crate(project: &Project) -> Result<usize> {
    let known = Known::read(project, &[])?;
    let tree = ["--target", "all", "--package", "cusp-slicer"];
    let crates = linked(project, &tree)?
        .iter()
        .map(|key| known.describe(key))
        .collect::<Result<Vec<_>>>()?;
    let own = known.own("cusp-slicer")?;
    let file = project.root.join(FILE);
    fs::write(&file, format!("{}\n", bill(own, &crates)))
        .with_context(|| format!("cannot write {}", file.display()))?;
    Ok(crates.len())
}

/// As `CycloneDX` writes it. No time and no serial number: the same lock file gives the same bytes.
fn bill(own: &Package, crates: &[Crate]) -> Value {
    let address = |name: &str, version: &str| format!("pkg:cargo/{name}@{version}");
    let components: Vec<_> = crates
        .iter()
        .map(|it| {
            json!({
                "type": "library",
                "name": it.name,
                "version": it.version,
                "purl": address(&it.name, &it.version),
                "licenses": [{ "expression": it.license }],
                "hashes": [{ "alg": "SHA-256", "content": it.checksum }],
            })
        })
        .collect();
    json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": { "component": {
            "type": "application",
            "name": own.name,
            "version": own.version,
            "purl": address(&own.name, &own.version),
            "licenses": [{ "expression": own.license }],
        } },
        "components": components,
    })
}

/// The crates of others that are linked into a package, by the arguments of `cargo tree` that say which and where.
fn linked(project: &Project, arguments: &[&str]) -> Result<BTreeSet<Key>> {
    let text = process::output(
        cargo(project)
            .args(["tree", "--locked", "--edges", "normal,no-proc-macro"])
            .args(["--prefix", "none", "--format", "{p}"])
            .args(arguments),
    )?;
    let found: BTreeSet<Key> = text.lines().filter_map(tree_line).collect();
    ensure!(!found.is_empty(), "cargo tree names no crates");
    Ok(found)
}

/// `serde v1.0.229`, which is `serde v1.0.229 (*)` from the second time on. Own packages have their folder behind them.
fn tree_line(line: &str) -> Option<Key> {
    let mut words = line.split(' ');
    let (name, version) = (words.next()?, words.next()?.strip_prefix('v')?);
    let is_of_others = words.all(|word| word == "(*)");
    is_of_others.then(|| (name.to_owned(), version.to_owned()))
}

/// What Cargo says of the packages.
struct Known {
    packages: Vec<Package>,
    checksums: BTreeMap<Key, String>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    manifest_path: PathBuf,
}

impl Known {
    fn read(project: &Project, arguments: &[&str]) -> Result<Self> {
        #[derive(Deserialize)]
        struct Metadata {
            packages: Vec<Package>,
        }
        let metadata = process::output(
            cargo(project)
                .args(["metadata", "--locked", "--format-version", "1"])
                .args(arguments),
        )?;
        let metadata: Metadata = serde_json::from_str(&metadata).context("cargo metadata")?;
        let lock = fs::read_to_string(project.root.join("Cargo.lock"))?;
        Ok(Self {
            packages: metadata.packages,
            checksums: checksums(&lock)?,
        })
    }

    fn package(&self, (name, version): &Key) -> Result<&Package> {
        self.packages
            .iter()
            .find(|it| it.name == *name && it.version == *version)
            .with_context(|| format!("cargo metadata does not name {name} {version}"))
    }

    /// A package of the workspace.
    fn own(&self, name: &str) -> Result<&Package> {
        let found = self.packages.iter().find(|it| it.name == name);
        found.with_context(|| format!("cargo metadata does not name {name}"))
    }

    fn folder(&self, key: &Key) -> Result<&Path> {
        let manifest = &self.package(key)?.manifest_path;
        manifest.parent().context("a manifest without a folder")
    }

    fn describe(&self, key: &Key) -> Result<Crate> {
        let (name, version) = key.clone();
        let license = self.package(key)?.license.as_deref();
        Ok(Crate {
            // Older manifests write it so.
            license: license
                .with_context(|| format!("{name} {version} has no licence"))?
                .replace('/', " OR "),
            checksum: self
                .checksums
                .get(key)
                .with_context(|| format!("Cargo.lock has no checksum of {name} {version}"))?
                .clone(),
            name,
            version,
        })
    }
}

fn checksums(lock: &str) -> Result<BTreeMap<Key, String>> {
    #[derive(Deserialize)]
    struct Lock {
        package: Vec<Locked>,
    }
    #[derive(Deserialize)]
    struct Locked {
        name: String,
        version: String,
        checksum: Option<String>,
    }
    let lock: Lock = toml::from_str(lock).context("Cargo.lock")?;
    let packages = lock.package.into_iter();
    Ok(packages
        .filter_map(|it| Some(((it.name, it.version), it.checksum?)))
        .collect())
}

/// The texts that whoever ships the crate must repeat. Of those of several licences to choose from, MIT's alone.
fn notices(folder: &Path, license: &str) -> Result<Vec<String>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().to_uppercase();
        let is_notice = ["LICEN", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"]
            .iter()
            .any(|start| name.starts_with(start));
        if is_notice && entry.file_type()?.is_file() {
            files.push((name, entry.path()));
        }
    }
    files.sort();
    if license.contains(" OR ") && files.iter().any(|(name, _)| name.contains("MIT")) {
        let other = ["APACHE", "ZLIB", "UNLICENSE", "0BSD"];
        files.retain(|(name, _)| !other.iter().any(|license| name.contains(license)));
    }
    let read = |(_, path): &(String, PathBuf)| {
        let bytes = fs::read(path).with_context(|| path.display().to_string())?;
        let text = String::from_utf8_lossy(&bytes).replace('\r', "");
        Ok(text.trim().to_owned())
    };
    files.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_crates_of_others_are_in_a_bill() {
        let serde = Some(("serde".to_owned(), "1.0.229".to_owned()));
        assert_eq!(tree_line("serde v1.0.229"), serde);
        assert_eq!(tree_line("serde v1.0.229 (*)"), serde);
        assert_eq!(tree_line("cusp-slicer v0.1.0 (/some where/cusp)"), None);
        assert_eq!(tree_line("cusp-slicer v0.1.0 (/cusp) (*)"), None);
        assert_eq!(tree_line(""), None);
    }

    #[test]
    fn of_several_licences_one_text_is_repeated() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["LICENSE-APACHE", "license-mit", "NOTICE.txt", "readme.md"] {
            fs::write(folder.path().join(name), format!("{name}\r\n")).unwrap();
        }
        let found = |license| notices(folder.path(), license).unwrap();
        assert_eq!(found("MIT OR Apache-2.0"), ["license-mit", "NOTICE.txt"]);
        let all = ["LICENSE-APACHE", "license-mit", "NOTICE.txt"];
        assert_eq!(found("MIT AND Apache-2.0"), all);
    }

    #[test]
    fn checksums_are_those_of_the_lock_file() {
        let lock = r#"
[[package]]
name = "own"
version = "1.0.0"

[[package]]
name = "other"
version = "2.0.0"
checksum = "abc"
"#;
        let key = ("other".to_owned(), "2.0.0".to_owned());
        assert_eq!(
            checksums(lock).unwrap(),
            BTreeMap::from([(key, "abc".to_owned())])
        );
    }
}
