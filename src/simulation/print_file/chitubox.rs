//! The zip of `ChiTuBox`: run.gcode begins with settings in comments, and moves the plate to each layer's height.

use std::collections::HashMap;

use super::{Archive, Settings, SimulationError, bad_setting, positive};
use crate::format::Format;
use crate::simulation::mask::Flips;

const FILE: &str = "run.gcode";

pub fn read(archive: &mut Archive<'_>) -> Result<Settings, SimulationError> {
    let text = archive.read_text(FILE)?;
    let bad = |setting: &str| bad_setting(FILE, setting);
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
        Ok::<_, SimulationError>((columns, length_mm / f64::from(columns)))
    };
    let (width, pitch_x) = side("resolutionX", "machineX")?;
    let (height, pitch_y) = side("resolutionY", "machineY")?;
    let is_mirrored = match head.get("mirror") {
        Some(value) => *value != "0",
        None => head.get("projectType") == Some(&"LCD_mirror"),
    };
    let (masks, z_mm) = layers(&text).ok_or_else(|| bad("each layer's mask and height"))?;
    Ok(Settings {
        format: Format::Chitubox,
        pixels: [width, height],
        pitch_mm: [pitch_x, pitch_y],
        flips: Flips {
            mirror_x: is_mirrored,
            ..Flips::default()
        },
        z_mm,
        masks,
        pose: None,
    })
}

/// The masks that are shown, and the heights of their boundaries: a layer is cured where the plate is when the light goes
/// on. `None` if the light goes on without a mask or a height.
fn layers(text: &str) -> Option<(Vec<String>, Vec<f64>)> {
    let (mut masks, mut z_mm) = (Vec::new(), vec![0.0]);
    let (mut shown, mut z): (Option<String>, Option<f64>) = (None, None);
    for line in text.lines() {
        let command = line.split(';').next().unwrap_or_default().trim();
        let mut words = command.split_whitespace();
        match words.next() {
            Some("M6054") => shown = command.split('"').nth(1).map(str::to_owned),
            Some("G0" | "G1") => {
                if let Some(height) = words.find_map(|word| word.strip_prefix('Z')) {
                    z = Some(height.parse().ok()?);
                }
            }
            Some("M106") if command != "M106 S0" && shown.is_some() => {
                masks.push(shown.take()?);
                z_mm.push(z?);
            }
            _ => {}
        }
    }
    Some((masks, z_mm))
}
