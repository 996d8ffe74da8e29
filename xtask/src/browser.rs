//! Chromium, chromedriver, and the software GPU that Chromium ships.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};

use crate::{
    debian,
    process::{self, command},
    project::Project,
};

const BROWSERS: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];
const MACOS_BROWSERS: [&str; 2] = [
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
];
const PACKAGES: [&str; 2] = ["chromium", "chromium-driver"];

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

/// Finds a Chromium: the `CHROMIUM` variable, `PATH`, macOS' applications; on
/// Debian, as root, installs one.
///
/// # Errors
///
/// Fails if none is found or can be installed.
pub fn chromium() -> Result<PathBuf> {
    if let Some(path) = env::var_os("CHROMIUM") {
        return Ok(path.into());
    }
    installed_chromium()
        .or_else(|| {
            debian::ensure(&PACKAGES).ok()?;
            installed_chromium()
        })
        .context(
            "no browser found: install Chrome or Chromium, or set CHROMIUM to its path \
             (Debian: apt-get install chromium chromium-driver)",
        )
}

/// Finds the chromedriver that fits a browser: the `CHROMEDRIVER` variable,
/// `PATH`; on Debian, as root, installs one.
///
/// # Errors
///
/// Fails if there is none, or its version differs from the browser's.
pub fn chromedriver(chromium: &Path) -> Result<PathBuf> {
    let on_path = || which::which("chromedriver").ok();
    let driver = env::var_os("CHROMEDRIVER")
        .map(PathBuf::from)
        .or_else(on_path)
        .or_else(|| {
            debian::ensure(&PACKAGES).ok()?;
            on_path()
        })
        .context(
            "no chromedriver found: install the one of your browser's version and put it on PATH \
             (https://googlechromelabs.github.io/chrome-for-testing; Debian: apt-get install chromium-driver)",
        )?;
    let (browser, own) = (major_version(chromium)?, major_version(&driver)?);
    if browser != own {
        bail!("chromedriver has version {own}, the browser {browser}: they must match");
    }
    Ok(driver)
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

/// Writes what the wasm test runner passes to chromedriver, and returns the file.
///
/// # Errors
///
/// Fails when the file cannot be written.
pub fn webdriver_settings(project: &Project, chromium: &Path) -> Result<PathBuf> {
    let settings = serde_json::json!({
        "goog:chromeOptions": { "binary": chromium, "args": FLAGS }
    });
    let file = project.target.join("webdriver.json");
    fs::create_dir_all(&project.target)?;
    fs::write(&file, serde_json::to_string_pretty(&settings)?)?;
    Ok(file)
}

fn installed_chromium() -> Option<PathBuf> {
    BROWSERS
        .iter()
        .find_map(|name| which::which(name).ok())
        .or_else(|| {
            MACOS_BROWSERS
                .iter()
                .map(PathBuf::from)
                .find(|path| path.exists())
        })
}

fn major_version(program: &Path) -> Result<u32> {
    let text = process::output(command(program).arg("--version"))?;
    major(&text).with_context(|| format!("no version in \"{text}\""))
}

/// The first number in `Chromium 156.0.8078.73 built on …`.
fn major(text: &str) -> Option<u32> {
    text.split_whitespace().find_map(|word| {
        let (number, _) = word.split_once('.')?;
        number.parse().ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn major_version_is_found_among_words() {
        assert_eq!(
            major("Chromium 156.0.8078.73 built on Debian 12.5"),
            Some(156)
        );
        assert_eq!(major("Google Chrome 99.1.2.3"), Some(99));
        assert_eq!(major("no numbers. here"), None);
    }
}
