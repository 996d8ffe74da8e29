//! Files that are not complete yet.
//!
//! If the system supports it, they have no name until they are complete, so that nothing is left of them however the
//! process ends.

#[cfg(unix)]
use std::fs;
#[cfg(target_os = "linux")]
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

#[cfg(unix)]
use tempfile::Builder;
use tempfile::NamedTempFile;

use crate::watch::note_temporary;

/// The permissions of a new file, but for those that the umask removes.
#[cfg(unix)]
const USUAL_MODE: u32 = 0o666;

/// Folder in which the system lists open files.
#[cfg(target_os = "linux")]
const DESCRIPTORS: &str = "/proc/self/fd";

/// A file that takes the place of another one once it is complete. It has the permissions of that one, or those that the umask gives a
/// new file.
pub enum Unfinished {
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(NamedTempFile),
}

impl Unfinished {
    /// An empty file in the folder of `place`.
    pub fn beside(place: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed_in(parent(place)) {
            if let Ok(old) = fs::metadata(place) {
                file.set_permissions(old.permissions())?;
            }
            return Ok(Self::Unnamed(file));
        }
        let file = named_beside(place)?;
        note_temporary(file.path());
        Ok(Self::Named(file))
    }

    /// Puts the file in its place.
    pub fn persist(self, place: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => {
                // A link replaces no file: only a name does.
                let name = |path: &Path| name(&file, path);
                let named = Builder::new().make_in(parent(place), name)?;
                named.persist(place).map_err(|it| it.error)
            }
            Self::Named(file) => file.persist(place).map_err(|it| it.error).map(drop),
        }
    }
}

#[cfg(unix)]
fn named_beside(place: &Path) -> io::Result<NamedTempFile> {
    use std::os::unix::fs::PermissionsExt;
    let old = fs::metadata(place).ok().map(|old| old.permissions());
    let usual = fs::Permissions::from_mode(USUAL_MODE);
    let mut builder = Builder::new();
    builder.permissions(old.clone().unwrap_or(usual));
    let file = builder.tempfile_in(parent(place))?;
    if let Some(old) = old {
        // The umask may have removed some.
        file.as_file().set_permissions(old)?;
    }
    Ok(file)
}

#[cfg(not(unix))]
fn named_beside(place: &Path) -> io::Result<NamedTempFile> {
    NamedTempFile::new_in(parent(place))
}

/// `None` where files need a name from the start.
#[cfg(target_os = "linux")]
fn unnamed_in(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    if !Path::new(DESCRIPTORS).exists() {
        return None;
    }
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    open(folder, flags, Mode::from_raw_mode(USUAL_MODE))
        .map(File::from)
        .ok()
}

#[cfg(target_os = "linux")]
fn name(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    // Naming a descriptor itself is for privileged processes.
    let descriptor = format!("{DESCRIPTORS}/{}", file.as_raw_fd());
    Ok(linkat(CWD, descriptor, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file.write(bytes),
            Self::Named(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file.flush(),
            Self::Named(file) => file.flush(),
        }
    }
}

/// The folder that a path is in.
pub fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
