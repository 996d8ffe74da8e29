//! Reads models, and writes files either completely or not at all.

use std::ffi::OsStr;
use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Read as _, Write};
use std::path::{Path, PathBuf};

use cusp_slicer::Error;
use cusp_slicer::job::LoadedModel;
use cusp_slicer::misnamed::with_nearest;
use cusp_slicer::model::read::{HEAD_BYTES, ReadOptions, identify};
use cusp_slicer::model::weights::{self, WeightsError};
use cusp_slicer::printer::PrinterChoice;
use cusp_slicer::resin::Resin;
use serde::de::DeserializeOwned;

use crate::failure::{Failure, in_file, is_standard};
use crate::terminal::{is_on_terminal, take_stdout};
use crate::unfinished::{Unfinished, parent};

/// Reads a JSON file of the user's own.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
    parse_json(path, &text)
}

/// Parses the JSON in a file, which may begin with a byte-order mark.
pub fn parse_json<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, Failure> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let value = serde_json::from_str(text);
    Ok(value.map_err(|error| in_file(path, &with_nearest(&error.to_string())))?)
}

/// The resin of a file, or the default.
pub fn read_resin(path: Option<&Path>) -> Result<Resin, Failure> {
    let Some(path) = path else {
        return Ok(Resin::default());
    };
    read_json(path)
}

/// A known printer, or that of a JSON file.
pub fn printer_choice(printer: &str) -> Result<PrinterChoice, Failure> {
    let path = Path::new(printer);
    if path.extension().is_none_or(|extension| extension != "json") {
        return Ok(PrinterChoice::Named(printer.to_owned()));
    }
    Ok(PrinterChoice::Own(read_json(path)?))
}

/// Reads a file, or standard input to its end.
pub fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = if is_standard(path) {
        let mut bytes = Vec::new();
        let read = io::stdin().read_to_end(&mut bytes);
        read.map(|_| bytes)
    } else {
        fs::read(path)
    };
    Ok(bytes.map_err(|error| in_file(path, &error))?)
}

/// Choices for reading a model, and weights to apply.
#[derive(Default)]
pub struct Reading {
    pub weights: Option<WeightsFile>,
    pub options: ReadOptions,
}

impl Reading {
    /// Reads a model and applies weights.
    pub fn load(&self, model: &Path) -> Result<LoadedModel, Failure> {
        let mut loaded = load(model, &self.options)?;
        if let Some(weights) = &self.weights {
            weights.paint(&mut loaded, model)?;
        }
        Ok(loaded)
    }
}

/// Reads a model. Any other file is refused by its first bytes.
pub fn load(model: &Path, options: &ReadOptions) -> Result<LoadedModel, Failure> {
    if !is_standard(model) {
        let head = head_of(model).map_err(|error| in_file(model, &error))?;
        if let Some((head, length)) = head {
            let identified = identify(&head, length).map_err(Error::from);
            identified.map_err(|error| Failure::in_file(model, &error))?;
        }
    }
    let bytes = read(model)?;
    LoadedModel::read_with(&bytes, options).map_err(|error| Failure::in_file(model, &error))
}

/// The first bytes and the length of a regular file. A pipe can be opened only once.
fn head_of(path: &Path) -> io::Result<Option<(Vec<u8>, u64)>> {
    let metadata = fs::metadata(path)?;
    if !metadata.is_file() {
        return Ok(None);
    }
    let mut head = Vec::new();
    let file = fs::File::open(path)?;
    file.take(HEAD_BYTES as u64).read_to_end(&mut head)?;
    Ok(Some((head, metadata.len())))
}

/// A file of weights, not yet matched to a model.
pub struct WeightsFile {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl WeightsFile {
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let bytes = fs::read(path).map_err(|error| in_file(path, &error))?;
        // This is wrong for every model.
        if let Err(error @ WeightsError::NotWeights) = weights::from_bytes(&bytes, &[]) {
            return Err(in_file(path, &error).into());
        }
        Ok(Self {
            path: path.to_owned(),
            bytes,
        })
    }

    /// Applies these weights to the facets of the model of a file.
    pub fn paint(&self, loaded: &mut LoadedModel, model: &Path) -> Result<(), Failure> {
        let weights = weights::from_bytes(&self.bytes, &loaded.positions());
        let painted = weights.map_err(Error::from);
        let painted = painted.and_then(|weights| loaded.set_weights(Some(weights)));
        painted.map_err(|error| Failure {
            message: Some(in_file(model, &in_file(&self.path, &error))),
            ..Failure::in_file(model, &error)
        })
    }
}

/// The file of each plate: of several, each has its number in the name.
pub fn numbered(output: &Path, plates: usize) -> Vec<PathBuf> {
    if plates == 1 {
        return vec![output.to_owned()];
    }
    let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, end) = (part(output.file_stem()), part(output.extension()));
    let name = |number| output.with_file_name(format!("{stem}-{number}.{end}"));
    (1..=plates).map(name).collect()
}

/// A file to write, either completely or not at all; or standard output, for which that cannot be promised.
pub struct Output<'a> {
    /// Path as given by the user.
    path: &'a Path,
    /// The file itself, or the target of a link, so that links stay links. `None` for standard output.
    place: Option<PathBuf>,
}

impl<'a> Output<'a> {
    /// Checks that a file can be written at `path`, and that it is not the `input`, called `noun`, so that the user learns it
    /// before any work is done.
    pub fn new(path: &'a Path, input: Option<&Path>, noun: &str) -> Result<Self, Failure> {
        if !is_standard(path) {
            let place = place_for(path, input, noun).map_err(|reason| in_file(path, &reason))?;
            return Ok(Self {
                path,
                place: Some(place),
            });
        }
        take_stdout();
        let output = Self { path, place: None };
        if is_on_terminal() {
            return Err(output.failed(&"this is a terminal; redirect it, or name a file"));
        }
        Ok(output)
    }

    /// Writes the file: what `write` returns takes the place of an older one once it is complete.
    pub fn write<T>(
        &self,
        write: impl FnOnce(Writer) -> Result<(Writer, T), Failure>,
    ) -> Result<T, Failure> {
        // Created before the work, so that a folder without write permission fails at once.
        let sink = match &self.place {
            Some(place) => Unfinished::beside(place).map(Sink::File),
            None => Ok(Sink::Standard(io::stdout())),
        };
        let sink = sink.map_err(|error| self.failed(&error))?;
        let (writer, result) = write(BufWriter::with_capacity(BUFFER_BYTES, sink))?;
        let sink = writer.into_inner().map_err(|error| self.failed(&error))?;
        let kept = match (sink, &self.place) {
            (Sink::File(file), Some(place)) => file.persist(place),
            (mut sink, _) => sink.flush(),
        };
        kept.map_err(|error| self.failed(&error))?;
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
    pub fn failed(&self, error: &dyn Display) -> Failure {
        format!("{}: {error}", self.name()).into()
    }

    /// A failure of the library that concerns this file.
    pub fn failure(&self, error: &Error) -> Failure {
        let failure = Failure::in_file(self.path, error);
        Failure {
            message: match &failure.problem {
                Some(_) => Some(format!("{}: {error}", self.name())),
                // An interrupt names no file.
                None => failure.message.clone(),
            },
            ..failure
        }
    }

    /// Its name, as the user gave it.
    pub fn name(&self) -> std::path::Display<'_> {
        match &self.place {
            Some(_) => self.path.display(),
            None => Path::new("standard output").display(),
        }
    }

    /// The extension that the user named.
    pub fn extension(&self) -> Option<&str> {
        self.path.extension()?.to_str()
    }
}

/// Bytes that are written at once: those of many layers.
const BUFFER_BYTES: usize = 1 << 20;

/// Writes to a file that is not in its place yet, or to standard output.
pub type Writer = BufWriter<Sink>;

/// First destination of an output.
pub enum Sink {
    File(Unfinished),
    Standard(io::Stdout),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Standard(stdout) => stdout.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Standard(stdout) => stdout.flush(),
        }
    }
}

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
            let folder = if names_folder(output) {
                output
            } else {
                parent(output)
            };
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

/// Returns true if a path has a separator at its end.
fn names_folder(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::path::is_separator)
}

/// Returns true if print files go into it: a folder that is there, or is named as one.
pub fn is_folder(output: &Path) -> bool {
    names_folder(output) || (!is_standard(output) && output.is_dir())
}

/// Makes a folder that is named with a separator at its end, unless it is there.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    if folder.is_dir() {
        return Ok(());
    }
    if !names_folder(folder) {
        let separator = std::path::MAIN_SEPARATOR;
        let reason =
            format!("there is no such folder; {separator} at the end of its name makes one");
        return Err(in_file(folder, &reason).into());
    }
    Ok(fs::create_dir_all(folder).map_err(|error| in_file(folder, &error))?)
}
