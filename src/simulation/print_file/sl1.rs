//! Prusa's SL1 and SL1S, as `PrusaSlicer` and Cusp write them: config.ini and prusaslicer.ini.
//!
//! `PrusaSlicer` states the display in landscape. With `display_orientation = portrait` it draws a mask with x and y
//! exchanged, and mirrored once more than `display_mirror_x` says (`RasterBase::Trafo`). Cusp draws a portrait mask as the
//! model stands.

use std::collections::HashMap;

use super::{Archive, Settings, SimulationError, bad_setting, positive};
use crate::format::Format;
use crate::simulation::mask::Flips;

const CONFIG: &str = "config.ini";
const SLICER: &str = "prusaslicer.ini";

pub fn read(archive: &mut Archive<'_>) -> Result<Settings, SimulationError> {
    let (config, slicer) = (Ini::read(archive, CONFIG)?, Ini::read(archive, SLICER)?);
    let later_mm = config.length("layerHeight")?;
    let first_mm = match slicer.get("initial_layer_height") {
        Some(_) => slicer.length("initial_layer_height")?,
        None => later_mm,
    };
    let layers = config.count("numFast")? + config.count("numSlow")?;
    let job = config.get("jobDir");
    let job = job.ok_or_else(|| bad_setting(CONFIG, "jobDir"))?;

    let long = (
        slicer.count("display_pixels_x")?,
        slicer.length("display_width")?,
    );
    let short = (
        slicer.count("display_pixels_y")?,
        slicer.length("display_height")?,
    );
    let is_portrait = slicer.get("display_orientation") == Some("portrait");
    let ((width, width_mm), (height, height_mm)) = if is_portrait {
        (short, long)
    } else {
        (long, short)
    };
    if width.min(height) == 0 {
        return Err(bad_setting(SLICER, "display_pixels_x"));
    }
    let is_ours = config
        .get("prusaSlicerVersion")
        .is_some_and(|version| version.starts_with("Cusp"));
    let is_turned = is_portrait && !is_ours;
    let flag = |key: &str| slicer.get(key).is_some_and(|value| value != "0");
    Ok(Settings {
        format: Format::Sl1,
        pixels: [width, height],
        pitch_mm: [width_mm / f64::from(width), height_mm / f64::from(height)],
        flips: Flips {
            mirror_x: flag("display_mirror_x") != is_turned,
            mirror_y: flag("display_mirror_y"),
            exchange: is_turned,
        },
        // Products, not sums: errors do not add up.
        z_mm: std::iter::once(0.0)
            .chain((0..layers).map(|layer| first_mm + f64::from(layer) * later_mm))
            .collect(),
        masks: (0..layers)
            .map(|layer| format!("{job}{layer:05}.png"))
            .collect(),
        pose: None,
    })
}

/// A file of lines `key = value`.
struct Ini {
    file: &'static str,
    values: HashMap<String, String>,
}

impl Ini {
    fn read(archive: &mut Archive<'_>, file: &'static str) -> Result<Self, SimulationError> {
        let text = archive.read_text(file)?;
        let pairs = text.lines().filter_map(|line| line.split_once('='));
        let values = pairs.map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
        Ok(Self {
            file,
            values: values.collect(),
        })
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.values.get(key).map(String::as_str)
    }

    fn length(&self, key: &str) -> Result<f64, SimulationError> {
        let value = self.get(key).and_then(|value| value.parse().ok());
        positive(value).ok_or_else(|| bad_setting(self.file, key))
    }

    fn count(&self, key: &str) -> Result<u32, SimulationError> {
        let value = self.get(key).and_then(|value| value.parse().ok());
        value.ok_or_else(|| bad_setting(self.file, key))
    }
}
