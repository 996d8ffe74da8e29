//! Print files as their readers see them: what the settings say, and where the masks are. Each format has a file of its
//! own; nothing here is shared with the code that writes print files.

mod chitubox;
mod manifest;
mod sl1;
mod uvj;

use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::result::ZipError;

use super::SimulationError;
use super::mask::{Flips, Mask};
use crate::format::Format;
use crate::grid::MAX_SIDE;
use crate::model::Pose;

/// What the settings of a print file say.
#[derive(Debug, Clone)]
pub(super) struct Settings {
    /// The file's format.
    pub format: Format,
    /// Columns and rows of the masks as stored.
    pub pixels: [u32; 2],
    /// Sides of a pixel of the masks as stored, in millimetres.
    pub pitch_mm: [f64; 2],
    /// How stored masks become masks seen from above.
    pub flips: Flips,
    /// Heights of layer boundaries from 0 upward, in millimetres: one more than there are layers.
    pub z_mm: Vec<f64>,
    /// Name of each layer's mask in the zip, from the plate upward.
    pub masks: Vec<String>,
    /// How the model stands, if the file says so. Its bounding box is then at the centre of the masks.
    pub pose: Option<Pose>,
}

/// A print file, held in memory.
pub(super) struct PrintFile<'a> {
    archive: Archive<'a>,
    /// What it says of itself.
    pub settings: Settings,
}

impl<'a> PrintFile<'a> {
    /// Reads the settings, in whatever format they are.
    pub fn open(bytes: &'a [u8]) -> Result<Self, SimulationError> {
        let zip = ZipArchive::new(Cursor::new(bytes));
        let mut archive = Archive(zip.map_err(|error| SimulationError::NotAZip {
            system: error.to_string(),
        })?);
        let settings = read_settings(&mut archive)?;
        check(&settings)?;
        Ok(Self { archive, settings })
    }

    /// Decodes a layer's mask, seen from above.
    pub fn mask(&self, layer: usize) -> Result<Mask, SimulationError> {
        let name = &self.settings.masks[layer];
        // A copy shares the directory with the original, and has a place of its own.
        let png = self.archive.clone().read(name)?;
        Mask::read(&png, self.settings.pixels, self.settings.flips, name)
    }
}

fn read_settings(archive: &mut Archive<'_>) -> Result<Settings, SimulationError> {
    if archive.has("manifest.json") {
        manifest::read(archive)
    } else if archive.has("run.gcode") {
        chitubox::read(archive)
    } else if archive.has("config.json") {
        uvj::read(archive)
    } else if archive.has("config.ini") {
        sl1::read(archive)
    } else {
        Err(SimulationError::UnknownFormat)
    }
}

fn check(settings: &Settings) -> Result<(), SimulationError> {
    let [width, height] = settings.pixels;
    let side = 1..=MAX_SIDE;
    if !side.contains(&width) || !side.contains(&height) {
        return Err(SimulationError::TooManyPixels {
            width,
            height,
            max_side: MAX_SIDE,
        });
    }
    for (layer, pair) in settings.z_mm.windows(2).enumerate() {
        if !pair.is_sorted_by(|below, above| below < above) {
            return Err(SimulationError::ZOrder {
                layer: layer + 1,
                z_mm: pair[1],
            });
        }
    }
    Ok(())
}

/// The zip. Copies share its directory.
#[derive(Clone)]
struct Archive<'a>(ZipArchive<Cursor<&'a [u8]>>);

impl Archive<'_> {
    fn has(&self, name: &str) -> bool {
        self.0.index_for_name(name).is_some()
    }

    fn read(&mut self, name: &str) -> Result<Vec<u8>, SimulationError> {
        let mut bytes = Vec::new();
        let mut file = self.0.by_name(name).map_err(|error| match error {
            ZipError::FileNotFound => SimulationError::MissingFile {
                name: name.to_owned(),
            },
            error => bad_file(name, &error),
        })?;
        let read = file.read_to_end(&mut bytes);
        read.map_err(|error| bad_file(name, &error))?;
        Ok(bytes)
    }

    fn read_text(&mut self, name: &str) -> Result<String, SimulationError> {
        String::from_utf8(self.read(name)?).map_err(|error| bad_file(name, &error))
    }

    fn read_json(&mut self, name: &str) -> Result<serde_json::Value, SimulationError> {
        serde_json::from_slice(&self.read(name)?).map_err(|error| bad_file(name, &error))
    }
}

fn bad_file(name: &str, error: &dyn std::fmt::Display) -> SimulationError {
    SimulationError::BadFile {
        name: name.to_owned(),
        system: error.to_string(),
    }
}

fn bad_setting(file: &str, setting: &str) -> SimulationError {
    SimulationError::BadSetting {
        file: file.to_owned(),
        setting: setting.to_owned(),
    }
}

/// A length that a file states, if it is a positive number.
fn positive(length: Option<f64>) -> Option<f64> {
    length.filter(|length| length.is_finite() && *length > 0.0)
}
