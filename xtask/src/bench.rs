//! `cargo xtask bench`: benchmarks, and one that other machines can run.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use anyhow::{Context, Result};
use clap::Parser;

use crate::{against, process, project::Project, suite};

/// Name of the bench that [`pack`] makes a folder of.
const GPU: &str = "gpu";

/// In place of a bench: all of the command line, against another revision.
const ALL: &str = "all";

/// Paths at which Vulkan's loader may lie.
const LOADERS: [&str; 4] = [
    "/usr/lib/x86_64-linux-gnu/libvulkan.so.1",
    "/usr/lib/aarch64-linux-gnu/libvulkan.so.1",
    "/usr/lib64/libvulkan.so.1",
    "/usr/lib/libvulkan.so.1",
];

/// Runs the bench with this name, or all.
pub fn run(project: &Project, name: Option<&str>, arguments: &[String]) -> Result<()> {
    if name == Some(ALL) {
        let words =
            std::iter::once("cargo xtask bench all").chain(arguments.iter().map(String::as_str));
        return against::run(project, &against::Arguments::parse_from(words));
    }
    if name == Some(GPU) {
        let folder = pack(project)?;
        let script = folder.join("run.sh");
        eprintln!(
            "{} is all that another machine needs: sh run.sh",
            folder.display()
        );
        return process::show(process::command("sh").arg(script).args(arguments));
    }
    let mut cargo = process::cargo(project);
    cargo.arg("bench");
    match name {
        Some(name) => cargo.args(["--bench", name, "--"]).args(arguments),
        None => cargo.arg("--benches"),
    };
    process::show(&mut cargo)
}

/// Builds a bench, with this cargo command, and returns the path of its executable.
pub fn executable(cargo: &mut Command, name: &str) -> Result<PathBuf> {
    cargo
        .args(["--bench", name, "--message-format=json"])
        .stderr(Stdio::inherit());
    process::output(cargo)?
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["target"]["name"] == name)
        .find_map(|message| message["executable"].as_str().map(PathBuf::from))
        .context("cargo named no executable")
}

/// Puts all that the GPU bench needs into one folder, and returns it. Its models are made by code.
fn pack(project: &Project) -> Result<PathBuf> {
    suite::ensure_vulkan();
    let mut cargo = process::cargo(project);
    let executable = executable(cargo.args(["bench", "--no-run"]), GPU)?;
    let folder = project.target.join("bench-gpu");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(folder.join("lib"))?;
    fs::copy(&executable, folder.join("cusp-bench-gpu"))
        .with_context(|| executable.display().to_string())?;
    if let Some(loader) = LOADERS.map(Path::new).into_iter().find(|it| it.exists()) {
        fs::copy(loader, folder.join("lib/libvulkan.so.1"))?;
    }
    let driver = serde_json::json!({
        "file_format_version": "1.0.0",
        "ICD": { "library_path": "libGLX_nvidia.so.0", "api_version": "1.3.0" }
    });
    fs::write(folder.join("nvidia.json"), driver.to_string())?;
    fs::write(folder.join("run.sh"), RUN)?;
    Ok(folder)
}

const RUN: &str = r#"#!/bin/sh
# Prints a table of both GPU methods and the CPU. Arguments: further models, as STL files.
here=$(cd "$(dirname "$0")" && pwd)
libraries=$(ldconfig -p 2>/dev/null || /sbin/ldconfig -p 2>/dev/null)
# A machine may have a driver, and not the loader that finds it, or the driver, and not the file that names it: containers do.
case $libraries in
*libvulkan.so.1*) ;;
*) export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" ;;
esac
if [ -z "$(ls /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json 2>/dev/null)" ]; then
    export VK_ICD_FILENAMES="${VK_ICD_FILENAMES:-$here/nvidia.json}"
fi
exec "$here/cusp-bench-gpu" "$@"
"#;
