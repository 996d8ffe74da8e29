//! UVJ: config.json has the height of each layer. It does not say whether masks are mirrored, nor how the model stands.

use super::{Archive, Settings, SimulationError, bad_setting, positive};
use crate::format::Format;
use crate::simulation::mask::Flips;

const FILE: &str = "config.json";

pub fn read(archive: &mut Archive<'_>) -> Result<Settings, SimulationError> {
    let config = archive.read_json(FILE)?;
    let bad = |setting: &str| bad_setting(FILE, setting);
    let size = &config["Properties"]["Size"];
    let side = |key: &str| {
        let pixels = size[key].as_u64().and_then(|side| side.try_into().ok());
        let pixels: u32 = pixels.filter(|&side| side > 0).ok_or_else(|| bad(key))?;
        let length_mm = positive(size["Millimeter"][key].as_f64());
        let length_mm = length_mm.ok_or_else(|| bad("Millimeter"))?;
        Ok::<_, SimulationError>((pixels, length_mm / f64::from(pixels)))
    };
    let ((width, pitch_x), (height, pitch_y)) = (side("X")?, side("Y")?);
    let layers = config["Layers"].as_array().ok_or_else(|| bad("Layers"))?;
    let mut z_mm = vec![0.0];
    for layer in layers {
        z_mm.push(layer["Z"].as_f64().ok_or_else(|| bad("Z"))?);
    }
    Ok(Settings {
        format: Format::Uvj,
        pixels: [width, height],
        pitch_mm: [pitch_x, pitch_y],
        flips: Flips::default(),
        masks: (0..layers.len())
            .map(|layer| format!("slice/{layer:08}.png"))
            .collect(),
        z_mm,
        pose: None,
    })
}
