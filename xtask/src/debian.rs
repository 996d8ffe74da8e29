//! Debian packages, where they exist and we may install them.

use std::{path::Path, sync::Once};

use anyhow::{Result, bail};

use crate::process::{self, command};

/// Installs those of `packages` that are missing; quick if none is.
pub fn ensure(packages: &[&str]) -> Result<()> {
    static FRESH_LISTS: Once = Once::new();

    let all = packages.join(" ");
    if !Path::new("/etc/debian_version").exists() {
        bail!("this is not Debian: the packages {all} are not available");
    }
    let mut query = command("dpkg-query");
    query.args(["--show", "--showformat=${db:Status-Status} "]);
    if process::output(query.args(packages))
        .is_ok_and(|text| text.split_whitespace().all(|status| status == "installed"))
    {
        return Ok(());
    }
    if process::output(command("id").arg("-u"))? != "0" {
        bail!(
            "missing packages; install them with: sudo apt-get install --no-install-recommends {all}"
        );
    }
    FRESH_LISTS.call_once(|| {
        if let Err(error) = process::run(command("apt-get").args(["update", "--quiet"])) {
            eprintln!("{error:#}");
        }
    });
    process::run(
        command("apt-get")
            .args(["install", "--quiet", "--yes", "--no-install-recommends"])
            // Two lanes of tests may install at the same time.
            .args(["-o", "DPkg::Lock::Timeout=300"])
            .args(packages)
            .env("DEBIAN_FRONTEND", "noninteractive"),
    )
}

/// Installs packages where that is possible, and says why it is not where it is not.
pub fn try_ensure(packages: &[&str]) {
    if let Err(error) = ensure(packages) {
        eprintln!("{error:#}");
    }
}
