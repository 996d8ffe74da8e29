//! UVJ: config.json has the height of each layer. It does not say whether masks are mirrored, nor how the model stands.

use serde_json::Value;

use super::container::Archive;
use super::metadata::with_thicknesses;
use super::preview::Picture;
use super::{Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, positive};

const FILE: &str = "config.json";

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let config = archive.read_json(FILE)?;
    let bad = |setting: &str| PrintFileError::bad_setting(FILE, setting);
    let properties = &config["Properties"];
    let size = &properties["Size"];
    let side = |key: &str| {
        let pixels = size[key].as_u64().and_then(|side| side.try_into().ok());
        let pixels: u32 = pixels.filter(|&side| side > 0).ok_or_else(|| bad(key))?;
        let length_mm = positive(size["Millimeter"][key].as_f64());
        let length_mm = length_mm.ok_or_else(|| bad("Millimeter"))?;
        Ok::<_, PrintFileError>((pixels, length_mm))
    };
    let ((width, length_x), (height, length_y)) = (side("X")?, side("Y")?);
    let pitch = [length_x / f64::from(width), length_y / f64::from(height)];
    let entries = config["Layers"].as_array().ok_or_else(|| bad("Layers"))?;
    let layers: Option<Vec<Layer>> = entries.iter().map(layer).collect();
    let bottom = &properties["Bottom"];
    let previews = ["preview/huge.png", "preview/tiny.png"].into_iter();
    let previews = previews.filter(|name| archive.has(name));
    Ok(Contents {
        metadata: Metadata {
            plate_mm: [Some(length_x), Some(length_y), None],
            layer_mm: size["LayerHeight"].as_f64(),
            exposure_s: properties["Exposure"]["LightOnTime"].as_f64(),
            bottom_exposure_s: bottom["LightOnTime"].as_f64(),
            bottom_layers: bottom["Count"].as_u64().map(|layers| layers as u32),
            uses_layer_values: Some(true),
            ..Metadata::new(Format::Uvj, [width, height], pitch)
        },
        layers: with_thicknesses(layers.ok_or_else(|| bad("Z"))?),
        coding: Coding::Png,
        places: Places::InZip(
            (0..entries.len())
                .map(|layer| format!("slice/{layer:08}.png"))
                .collect(),
        ),
        pictures: previews.map(|name| Picture::Png(name.to_owned())).collect(),
        copies: None,
        findings: Vec::new(),
    })
}

fn layer(entry: &Value) -> Option<Layer> {
    let exposure = &entry["Exposure"];
    Some(Layer {
        z_mm: entry["Z"].as_f64()?,
        exposure_s: exposure["LightOnTime"].as_f64(),
        wait_before_exposure_s: exposure["LightOffTime"].as_f64(),
        lift_mm: exposure["LiftHeight"].as_f64(),
        lift_mm_min: exposure["LiftSpeed"].as_f64(),
        retract_mm_min: exposure["RetractSpeed"].as_f64(),
        ..Layer::default()
    })
}
