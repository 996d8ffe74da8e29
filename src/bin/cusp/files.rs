//! Reads models, and writes files either completely or not at all.

use std::fs;
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use cusp_slicer::Error;
use cusp_slicer::job::Slicer;
use cusp_slicer::model::weights::{self, WeightsError};
use cusp_slicer::progress::Cancelled;
use tempfile::NamedTempFile;

use crate::arguments::Choices;

/// Why a command failed.
pub struct Failure {
    pub exit_code: u8,
    /// The message for the user; `None` if it has already been shown.
    pub message: Option<String>,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self {
            exit_code: 1,
            message: Some(message),
        }
    }
}

impl Failure {
    /// A failure of the library that concerns a file. An interrupt does not name the file.
    pub fn in_file(path: &Path, error: &cusp_slicer::Error) -> Self {
        if error.code() == "cancelled" {
            Self::interrupted()
        } else {
            in_file(path, error).into()
        }
    }

    pub fn interrupted() -> Self {
        Self {
            exit_code: 130,
            message: Some(Cancelled.to_string()),
        }
    }

    /// Bad input that has already been reported.
    pub const TOLD: Self = Self {
        exit_code: 1,
        message: None,
    };
}

pub fn in_file(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

pub fn load(model: &Path) -> Result<Slicer, Failure> {
    let bytes = fs::read(model).map_err(|error| in_file(model, &error))?;
    Slicer::load(&bytes).map_err(|error| Failure::in_file(model, &error))
}

/// A file of weights, not yet matched to a model.
pub struct WeightsFile<'a> {
    path: &'a Path,
    bytes: Vec<u8>,
}

impl<'a> WeightsFile<'a> {
    pub fn read(path: &'a Path) -> Result<Self, Failure> {
        let bytes = fs::read(path).map_err(|error| in_file(path, &error))?;
        // This is wrong for every model.
        if let Err(error @ WeightsError::NotWeights) = weights::from_bytes(&bytes, &[]) {
            return Err(in_file(path, &error).into());
        }
        Ok(Self { path, bytes })
    }

    /// Applies these weights to the facets of the slicer's `model`.
    pub fn paint(&self, slicer: &mut Slicer, model: &Path) -> Result<(), Failure> {
        let weights = weights::from_bytes(&self.bytes, &slicer.positions());
        let painted = weights.map_err(Error::from);
        let painted = painted.and_then(|weights| slicer.set_weights(Some(weights)));
        painted.map_err(|error| in_file(model, &in_file(self.path, &error)).into())
    }
}

/// Loads a model, with the weights of its facets if any are given.
pub fn load_weighted(model: &Path, choices: &Choices) -> Result<Slicer, Failure> {
    load_painted(model, choices.read_weights()?.as_ref())
}

/// Loads a model, and applies weights that have been read.
pub fn load_painted(model: &Path, weights: Option<&WeightsFile<'_>>) -> Result<Slicer, Failure> {
    let mut slicer = load(model)?;
    if let Some(weights) = weights {
        weights.paint(&mut slicer, model)?;
    }
    Ok(slicer)
}

/// A file to write, either completely or not at all.
pub struct Output<'a> {
    /// As the user named it.
    path: &'a Path,
    /// The file itself, or the target of a link, so that links stay links.
    place: PathBuf,
}

impl<'a> Output<'a> {
    /// Checks that a file can be written at `path`, and that it is not the `input`, called `noun`, so that the user learns it
    /// before any work is done.
    pub fn new(path: &'a Path, input: Option<&Path>, noun: &str) -> Result<Self, Failure> {
        let place = place_for(path, input, noun).map_err(|reason| in_file(path, &reason))?;
        Ok(Self { path, place })
    }

    /// Writes the file: what `write` returns takes the place of an older one once it is complete.
    pub fn write<T>(
        &self,
        write: impl FnOnce(Writer) -> Result<(Writer, T), Failure>,
    ) -> Result<T, Failure> {
        // Created before the work, so that a folder without write permission fails at once.
        let file = file_beside(&self.place).map_err(|error| self.failed(&error))?;
        let (writer, result) = write(BufWriter::new(file))?;
        let file = writer.into_inner().map_err(|error| self.failed(&error))?;
        let kept = file.persist(&self.place);
        kept.map_err(|error| self.failed(&error.error))?;
        Ok(result)
    }

    /// The same for bytes that are there.
    pub fn write_bytes(&self, bytes: &[u8]) -> Result<(), Failure> {
        self.write(|mut writer| {
            let written = writer.write_all(bytes);
            written.map_err(|error| self.failed(&error))?;
            Ok((writer, ()))
        })
    }

    /// A failure that concerns this file.
    pub fn failed(&self, error: &dyn std::fmt::Display) -> Failure {
        in_file(self.path, error).into()
    }

    /// A failure of the library that concerns this file.
    pub fn failure(&self, error: &Error) -> Failure {
        Failure::in_file(self.path, error)
    }

    /// Its name, as the user gave it.
    pub fn name(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// The extension that the user named.
    pub fn extension(&self) -> Option<&str> {
        self.path.extension()?.to_str()
    }
}

/// Writes to a file that is not in its place yet.
pub type Writer = BufWriter<NamedTempFile>;

fn place_for(output: &Path, input: Option<&Path>, noun: &str) -> Result<PathBuf, String> {
    match fs::metadata(output) {
        Ok(found) if found.is_dir() => Err("is a folder; name a file in it".to_owned()),
        Ok(found) if !found.is_file() => {
            Err("is a device or a pipe; only a regular file can be written".to_owned())
        }
        Ok(_) => {
            let place = output.canonicalize().map_err(|error| error.to_string())?;
            let input = input.and_then(|input| input.canonicalize().ok());
            if input.is_some_and(|input| input == place) {
                return Err(format!("is the {noun} itself; name another file"));
            }
            Ok(place)
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error.to_string()),
        Err(_) if output.is_symlink() => {
            Err("is a link to a file that does not exist; name that file instead".to_owned())
        }
        Err(_) => {
            let names_folder = output.to_string_lossy().ends_with(std::path::is_separator);
            let folder = if names_folder { output } else { parent(output) };
            if folder.is_dir() {
                Ok(output.to_owned())
            } else {
                Err(format!(
                    "there is no folder {}; create it first",
                    folder.display()
                ))
            }
        }
    }
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A temporary file beside `place`, to be renamed once complete. It has the permissions of the file it replaces, or those that
/// the umask gives a new one.
fn file_beside(place: &Path) -> io::Result<NamedTempFile> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mut builder = tempfile::Builder::new();
        let old = fs::metadata(place).ok().map(|old| old.permissions());
        let usual = fs::Permissions::from_mode(0o666);
        builder.permissions(old.clone().unwrap_or(usual));
        let file = builder.tempfile_in(parent(place))?;
        if let Some(old) = old {
            // The umask may have removed some.
            file.as_file().set_permissions(old)?;
        }
        Ok(file)
    }
    #[cfg(not(unix))]
    NamedTempFile::new_in(parent(place))
}
