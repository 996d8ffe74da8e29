//! The zip of ChiTuBox: run.gcode begins with settings in comments, and moves the plate to each layer's height.

use std::collections::HashMap;

use super::bytes::clean;
use super::container::Archive;
use super::metadata::with_thicknesses;
use super::preview::Picture;
use super::{Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, positive};

const FILE: &str = "run.gcode";

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let text = archive.read_text(FILE)?;
    let bad = |setting: &str| PrintFileError::bad_setting(FILE, setting);
    let comments = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix(';'));
    let head: HashMap<&str, &str> = comments
        .filter_map(|comment| comment.split_once(':'))
        .map(|(key, value)| (key.trim(), value.trim()))
        .collect();
    let side = |pixels: &str, length: &str| {
        let columns = head.get(pixels).and_then(|value| value.parse::<u32>().ok());
        let columns = columns.filter(|&columns| columns > 0);
        let columns = columns.ok_or_else(|| bad(pixels))?;
        let length_mm = head.get(length).and_then(|value| value.parse().ok());
        let length_mm = positive(length_mm).ok_or_else(|| bad(length))?;
        Ok::<_, PrintFileError>((columns, length_mm))
    };
    let (width, length_x) = side("resolutionX", "machineX")?;
    let (height, length_y) = side("resolutionY", "machineY")?;
    let pitch = [length_x / f64::from(width), length_y / f64::from(height)];
    let is_mirrored = match head.get("mirror") {
        Some(value) => *value != "0",
        None => head.get("projectType") == Some(&"LCD_mirror"),
    };
    let (masks, layers) = layers(&text).ok_or_else(|| bad("each layer's mask and height"))?;
    let any_number = |key: &str| head.get(key).and_then(|value| value.parse::<f64>().ok());
    let number = |key: &str| any_number(key).filter(|value| value.is_finite());
    let name = |key: &str| head.get(key).and_then(|value| clean(value));
    let previews = ["preview.png", "preview_cropping.png"].into_iter();
    let previews = previews.filter(|name| archive.has(name));
    Ok(Contents {
        metadata: Metadata {
            printer: name("machineType"),
            resin: name("resin"),
            plate_mm: [Some(length_x), Some(length_y), number("machineZ")],
            is_mirrored_x: Some(is_mirrored),
            is_mirrored_y: Some(false),
            layer_mm: any_number("layerHeight"),
            exposure_s: any_number("normalExposureTime"),
            bottom_exposure_s: any_number("bottomLayerExposureTime")
                .or_else(|| any_number("bottomLayExposureTime")),
            bottom_layers: number("bottomLayerCount")
                .or_else(|| number("bottomLayCount"))
                .map(|layers| layers as u32),
            print_time_s: number("estimatedPrintTime"),
            volume_ml: number("volume"),
            weight_g: number("weight"),
            uses_layer_values: Some(true),
            ..Metadata::new(Format::Chitubox, [width, height], pitch)
        },
        layers: with_thicknesses(layers),
        coding: Coding::Png,
        places: Places::InZip(masks),
        pictures: previews.map(|name| Picture::Png(name.to_owned())).collect(),
        copies: None,
        findings: Vec::new(),
    })
}

/// Commands to the printer since the light last went out.
#[derive(Default)]
struct Told {
    mask: Option<String>,
    is_lit: bool,
    highest_mm: Option<f64>,
    lift_mm_min: Option<f64>,
    retract_mm_min: Option<f64>,
    wait_s: Option<f64>,
}

impl Told {
    /// The state once the light is off: after a layer, the mask alone.
    fn in_the_dark(self) -> Self {
        if !self.is_lit {
            return self;
        }
        Self {
            mask: self.mask,
            ..Self::default()
        }
    }
}

/// The masks that are shown, and their layers: a layer is cured where the plate is when the light goes on. `None` if the
/// light goes on without a mask or a height.
fn layers(text: &str) -> Option<(Vec<String>, Vec<Layer>)> {
    let (mut masks, mut layers) = (Vec::new(), Vec::<Layer>::new());
    let (mut told, mut z): (Told, Option<f64>) = (Told::default(), None);
    for line in text.lines() {
        let command = line.split(';').next().unwrap_or_default().trim();
        let mut words = command.split_whitespace();
        let number = |letter: char| {
            let mut words = command.split_whitespace();
            words.find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok())
        };
        match words.next() {
            Some("M6054") => told.mask = command.split('"').nth(1).map(str::to_owned),
            Some("G0" | "G1") => {
                if let Some(height) = words.find_map(|word| word.strip_prefix('Z')) {
                    let height = height.parse().ok()?;
                    if told.highest_mm.is_none() {
                        (told.highest_mm, told.lift_mm_min) = (Some(height), number('F'));
                    } else {
                        told.retract_mm_min = number('F');
                    }
                    z = Some(height);
                }
            }
            Some("G4") => {
                let seconds = number('P').map(|milliseconds| milliseconds / 1000.0);
                match layers.last_mut() {
                    Some(layer) if told.is_lit => layer.exposure_s = seconds,
                    _ => told.wait_s = seconds,
                }
            }
            Some("M106") if command == "M106 S0" => told = told.in_the_dark(),
            Some("M106") if told.mask.is_some() => {
                masks.push(told.mask.take()?);
                let z_mm = z?;
                layers.push(Layer {
                    z_mm,
                    wait_before_exposure_s: told.wait_s,
                    lift_mm: told.highest_mm.map(|highest_mm| highest_mm - z_mm),
                    lift_mm_min: told.lift_mm_min,
                    retract_mm_min: told.retract_mm_min,
                    ..Layer::default()
                });
                told.is_lit = true;
            }
            _ => {}
        }
    }
    Some((masks, layers))
}
