//! Prusa's SL1 and SL1S, as PrusaSlicer and Cusp write them: config.ini and prusaslicer.ini.
//!
//! PrusaSlicer states the display in landscape. With `display_orientation = portrait` it draws a mask with x and y
//! exchanged, and mirrored once more than `display_mirror_x` says (`RasterBase::Trafo`). Cusp draws a portrait mask as the
//! model stands.

use std::collections::HashMap;
use std::path::Path;

use super::bytes::clean;
use super::container::Archive;
use super::metadata::with_thicknesses;
use super::preview::Picture;
use super::{Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, positive};

const CONFIG: &str = "config.ini";
const SLICER: &str = "prusaslicer.ini";

/// Number of layers that printers expose like the first one, whatever the file says; then the exposure fades.
const BOTTOM_LAYERS: u32 = 3;

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let (config, slicer) = (Ini::read(archive, CONFIG)?, Ini::read(archive, SLICER)?);
    let later_mm = config.length("layerHeight")?;
    let first_mm = match slicer.get("initial_layer_height") {
        Some(_) => slicer.length("initial_layer_height")?,
        None => later_mm,
    };
    let (slow, fast) = (config.count("numSlow")?, config.count("numFast")?);
    // Each layer has a file.
    let (layers, most) = (u64::from(slow) + u64::from(fast), archive.len() as u64);
    if layers > most {
        return Err(PrintFileError::TooManyLayers { layers, most });
    }
    let layers = layers as u32;
    let job = config.get("jobDir");
    let job = job.ok_or_else(|| PrintFileError::bad_setting(CONFIG, "jobDir"))?;

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
        return Err(PrintFileError::bad_setting(SLICER, "display_pixels_x"));
    }
    let is_ours = config
        .get("prusaSlicerVersion")
        .is_some_and(|version| version.starts_with("Cusp"));
    let is_turned = is_portrait && !is_ours;
    let flag = |key: &str| slicer.get(key).is_some_and(|value| value != "0");
    let layer = |layer: u32| Layer {
        // Products, not sums: errors do not add up.
        z_mm: first_mm + f64::from(layer) * later_mm,
        ..Layer::default()
    };
    let pixel_mm = [width_mm / f64::from(width), height_mm / f64::from(height)];
    let is_png = |name: &str| Path::new(name).extension() == Some("png".as_ref());
    let is_preview = |name: &String| name.starts_with("thumbnail/") && is_png(name);
    let previews = archive.names().filter(is_preview);
    Ok(Contents {
        metadata: Metadata {
            software: config.get("prusaSlicerVersion").and_then(clean),
            printer: config.get("printerModel").and_then(clean),
            resin: config.get("materialName").and_then(clean),
            plate_mm: [
                Some(width_mm),
                Some(height_mm),
                slicer.number("max_print_height"),
            ],
            is_mirrored_x: Some(flag("display_mirror_x") != is_turned),
            is_mirrored_y: Some(flag("display_mirror_y")),
            is_turned,
            layer_mm: Some(later_mm),
            exposure_s: config.any_number("expTime"),
            bottom_exposure_s: config.any_number("expTimeFirst"),
            bottom_layers: Some(BOTTOM_LAYERS),
            transition_layers: config.number("numFade").map(|layers| layers as u32),
            print_time_s: config.number("printTime"),
            volume_ml: config.number("usedMaterial"),
            ..Metadata::new(Format::Sl1, [width, height], pixel_mm)
        },
        layers: with_thicknesses((0..layers).map(layer).collect()),
        coding: Coding::Png,
        places: Places::InZip(
            (0..layers)
                .map(|layer| format!("{job}{layer:05}.png"))
                .collect(),
        ),
        pictures: previews.map(Picture::Png).collect(),
        copies: None,
        findings: Vec::new(),
    })
}

/// A file of lines `key = value`.
struct Ini {
    file: &'static str,
    values: HashMap<String, String>,
}

impl Ini {
    fn read(archive: &mut Archive<'_>, file: &'static str) -> Result<Self, PrintFileError> {
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

    /// A number, finite or not.
    fn any_number(&self, key: &str) -> Option<f64> {
        self.get(key)?.parse().ok()
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.any_number(key).filter(|value| value.is_finite())
    }

    fn length(&self, key: &str) -> Result<f64, PrintFileError> {
        let value = self.get(key).and_then(|value| value.parse().ok());
        positive(value).ok_or_else(|| PrintFileError::bad_setting(self.file, key))
    }

    fn count(&self, key: &str) -> Result<u32, PrintFileError> {
        let value = self.get(key).and_then(|value| value.parse().ok());
        value.ok_or_else(|| PrintFileError::bad_setting(self.file, key))
    }
}
