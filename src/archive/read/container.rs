//! Zips: files by name, none of them larger than it can be.

use std::borrow::Cow;
use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::result::ZipError;

use super::{Bytes, PrintFileError};

/// Largest unpacked size of a file of settings.
const SETTINGS_BYTES: u64 = 64 << 20;

/// A zip. Copies share its directory.
#[derive(Clone)]
pub(super) struct Archive<'a>(ZipArchive<Cursor<Bytes<'a>>>);

impl<'a> Archive<'a> {
    pub fn open(bytes: Bytes<'a>) -> Result<Self, PrintFileError> {
        let is_zip = bytes.as_ref().starts_with(b"PK");
        let archive = ZipArchive::new(Cursor::new(bytes));
        Ok(Self(archive.map_err(|error| {
            if is_zip {
                PrintFileError::DamagedZip {
                    system: error.to_string(),
                }
            } else {
                PrintFileError::UnknownKind
            }
        })?))
    }

    /// Number of files.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn has(&self, name: &str) -> bool {
        self.0.index_for_name(name).is_some()
    }

    /// Names of all files, except those that are not text.
    pub fn names(&self) -> impl Iterator<Item = String> {
        self.0.file_names().flatten().map(Cow::into_owned)
    }

    /// Unpacks a file, if it is at most this large.
    pub fn read(&mut self, name: &str, most_bytes: u64) -> Result<Vec<u8>, PrintFileError> {
        let mut bytes = Vec::new();
        let file = self.0.by_name(name).map_err(|error| match error {
            ZipError::FileNotFound => PrintFileError::MissingFile {
                name: name.to_owned(),
            },
            error => PrintFileError::bad_file(name, &error),
        })?;
        // One more than allowed, so that the end is seen, and with it the checksum.
        let read = file.take(most_bytes + 1).read_to_end(&mut bytes);
        read.map_err(|error| PrintFileError::bad_file(name, &error))?;
        if bytes.len() as u64 > most_bytes {
            return Err(PrintFileError::TooLarge {
                name: name.to_owned(),
                most_bytes,
            });
        }
        Ok(bytes)
    }

    pub fn read_text(&mut self, name: &str) -> Result<String, PrintFileError> {
        let bytes = self.read(name, SETTINGS_BYTES)?;
        String::from_utf8(bytes).map_err(|error| PrintFileError::bad_file(name, &error))
    }

    /// Null if there is no such file.
    pub fn read_json_if_any(&mut self, name: &str) -> Result<serde_json::Value, PrintFileError> {
        if self.has(name) {
            self.read_json(name)
        } else {
            Ok(serde_json::Value::Null)
        }
    }

    pub fn read_json(&mut self, name: &str) -> Result<serde_json::Value, PrintFileError> {
        let bytes = self.read(name, SETTINGS_BYTES)?;
        serde_json::from_slice(&bytes).map_err(|error| PrintFileError::bad_file(name, &error))
    }
}

/// A finite number, which some programs write as text.
pub(super) fn number(value: &serde_json::Value) -> Option<f64> {
    any_number(value).filter(|number| number.is_finite())
}

/// A number likewise, finite or not: text may say `nan`.
pub(super) fn any_number(value: &serde_json::Value) -> Option<f64> {
    value
        .as_f64()
        .or_else(|| value.as_str()?.trim().parse().ok())
}
