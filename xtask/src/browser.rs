//! Chromium, chromedriver, and the software GPU that Chromium ships.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};

use crate::{
    debian,
    process::{self, command},
    project::Project,
};

/// Chromium without windows, and the package of it: tests of the page take an eighth less time in it.
const HEADLESS: &str = "chromium-headless-shell";
const BROWSERS: [&str; 6] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
];

/// Quiet, self-contained, and with WebGPU on Chromium's own software adapter:
/// the same picture on every machine, whatever GPU it has.
const FLAGS: [&str; 8] = [
    "--headless",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
];

/// Finds a Chromium: the `CHROMIUM` variable, [`HEADLESS`], which it installs on
/// Debian as root, or any on `PATH` or among macOS' applications.
pub fn chromium() -> Result<PathBuf> {
    find("CHROMIUM", HEADLESS, HEADLESS)
        .or_else(|| BROWSERS.iter().find_map(|name| which::which(name).ok()))
        .context(
            "no browser found: install Chrome or Chromium, or set CHROMIUM to its path \
             (Debian: apt-get install chromium-headless-shell)",
        )
}

/// Finds the chromedriver that fits a browser: the `CHROMEDRIVER` variable, `PATH`; on Debian, as root, installs one.
pub fn chromedriver(chromium: &Path) -> Result<PathBuf> {
    let driver = find("CHROMEDRIVER", "chromedriver", "chromium-driver").context(
        "no chromedriver found: install the one of your browser's version and put it on PATH \
         (https://googlechromelabs.github.io/chrome-for-testing; Debian: apt-get install chromium-driver)",
    )?;
    let (browser, own) = (major_version(chromium)?, major_version(&driver)?);
    ensure!(
        browser == own,
        "chromedriver has version {own}, the browser {browser}: they must match"
    );
    Ok(driver)
}

fn find(variable: &str, program: &str, package: &str) -> Option<PathBuf> {
    let installed = || which::which(program).ok();
    let named = env::var_os(variable).map(PathBuf::from);
    named.or_else(installed).or_else(|| {
        debian::ensure(&[package]).ok()?;
        installed()
    })
}

/// The Vulkan driver that Chromium ships: a second, independent implementation
/// to run native GPU tests on. `None` if the browser ships none.
pub fn swiftshader(chromium: &Path) -> Option<PathBuf> {
    let beside = chromium.canonicalize().ok()?.parent()?.to_path_buf();
    [
        "/usr/lib/chromium",
        "/usr/lib/chromium-browser",
        "/opt/google/chrome",
    ]
    .into_iter()
    .map(PathBuf::from)
    .chain([beside])
    .map(|folder| folder.join("vk_swiftshader_icd.json"))
    .find(|file| file.exists())
}

/// Writes the settings that the wasm test runner passes to chromedriver, and returns the file.
pub fn webdriver_settings(project: &Project, chromium: &Path) -> Result<PathBuf> {
    let settings = serde_json::json!({
        "goog:chromeOptions": { "binary": chromium, "args": FLAGS }
    });
    let file = project.target.join("webdriver.json");
    fs::create_dir_all(&project.target)?;
    fs::write(&file, settings.to_string())?;
    Ok(file)
}

/// The first number in `Chromium 156.0.8078.73 built on …`.
fn major_version(program: &Path) -> Result<u32> {
    let text = process::output(command(program).arg("--version"))?;
    let mut words = text.split_whitespace();
    words
        .find_map(|word| word.split_once('.')?.0.parse().ok())
        .with_context(|| format!("no version in \"{text}\""))
}
