//! Cusp's own zip: manifest.json says everything, the model's pose included.

use serde_json::Value;

use super::{Archive, Settings, SimulationError, bad_setting, positive};
use crate::format::Format;
use crate::model::Pose;
use crate::simulation::mask::Flips;

const FILE: &str = "manifest.json";

pub fn read(archive: &mut Archive<'_>) -> Result<Settings, SimulationError> {
    let manifest = archive.read_json(FILE)?;
    let bad = |setting: &str| bad_setting(FILE, setting);
    let mask = &manifest["mask"];
    let length = |key: &str| positive(mask[key].as_f64()).ok_or_else(|| bad(key));
    let side = |key: &str| {
        let value = mask[key].as_u64().and_then(|side| side.try_into().ok());
        value.ok_or_else(|| bad(key))
    };
    let is_mirrored = mask["is_mirrored"].as_bool();
    let layers = manifest["layer_files"].as_array();
    let layers = layers.ok_or_else(|| bad("layer_files"))?;
    let mut z_mm = vec![0.0];
    let mut masks = Vec::with_capacity(layers.len());
    for layer in layers {
        z_mm.push(layer["z_mm"].as_f64().ok_or_else(|| bad("z_mm"))?);
        let name = layer["file"].as_str().ok_or_else(|| bad("file"))?;
        masks.push(name.to_owned());
    }
    Ok(Settings {
        format: Format::Png,
        pixels: [side("width")?, side("height")?],
        pitch_mm: [length("pitch_mm")?, length("pitch_y_mm")?],
        flips: Flips {
            mirror_x: is_mirrored.ok_or_else(|| bad("is_mirrored"))?,
            ..Flips::default()
        },
        z_mm,
        masks,
        pose: Some(pose(&manifest["options"]).ok_or_else(|| bad("rotation"))?),
    })
}

/// The pose among the options, or `None` if its numbers are none.
fn pose(options: &Value) -> Option<Pose> {
    let rotation = match &options["rotation"] {
        Value::Null => None,
        Value::Array(parts) => {
            let parts: Option<Vec<f64>> = parts.iter().map(Value::as_f64).collect();
            Some(parts?.try_into().ok()?)
        }
        _ => return None,
    };
    let height_mm = match &options["height_mm"] {
        Value::Null => None,
        height => Some(height.as_f64()?),
    };
    Some(Pose {
        rotation,
        height_mm,
    })
}
