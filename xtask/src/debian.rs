//! Debian packages, where they exist and we may install them.

use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
};

use anyhow::{Context, Result, bail};

use crate::process::{self, command};

/// Installs those of `packages` that are missing; quick if none is.
///
/// # Errors
///
/// Fails if this is not Debian, if we are not root, or if a package is not
/// available; the error says what to type.
pub fn ensure(packages: &[&str]) -> Result<()> {
    static LISTS_ARE_FRESH: AtomicBool = AtomicBool::new(false);

    if !is_debian() {
        bail!(
            "this is not Debian: the packages {} are not available",
            packages.join(" ")
        );
    }
    let missing: Vec<&str> = packages
        .iter()
        .copied()
        .filter(|name| !is_installed(name))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let list = missing.join(" ");
    if !is_root() {
        bail!(
            "missing packages; install them with: sudo apt-get install --no-install-recommends {list}"
        );
    }
    if !LISTS_ARE_FRESH.swap(true, Ordering::Relaxed) {
        process::run(command("apt-get").args(["update", "--quiet"]))?;
    }
    process::run(
        command("apt-get")
            .args(["install", "--quiet", "--yes", "--no-install-recommends"])
            .args(missing)
            .env("DEBIAN_FRONTEND", "noninteractive"),
    )
    .with_context(|| format!("cannot install {list}"))
}

/// Installs packages where that is possible, and says why it is not on a Debian where it is not.
pub fn try_ensure(packages: &[&str]) {
    if is_debian()
        && let Err(error) = ensure(packages)
    {
        eprintln!("{error:#}");
    }
}

/// Whether this machine has Debian's package manager.
pub fn is_debian() -> bool {
    Path::new("/etc/debian_version").exists() && which::which("apt-get").is_ok()
}

/// Whether a package that has a service can be installed without starting it, as in most containers.
pub fn starts_no_services() -> bool {
    Path::new("/usr/sbin/policy-rc.d").exists()
}

/// Whether packages can be installed without asking for permission.
pub fn is_root() -> bool {
    process::output(command("id").arg("-u")).is_ok_and(|id| id == "0")
}

fn is_installed(package: &str) -> bool {
    process::output(command("dpkg-query").args([
        "--show",
        "--showformat=${db:Status-Status}",
        package,
    ]))
    .is_ok_and(|status| status == "installed")
}
