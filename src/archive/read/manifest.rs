//! Cusp's own zip: manifest.json says everything, the poses and places of models included.

use serde_json::Value;

use super::bytes::clean;
use super::container::Archive;
use super::metadata::with_thicknesses;
use super::{
    Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, PrintedCopy, positive,
};
use crate::model::{ModelUnit, Pose};

const FILE: &str = "manifest.json";

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let manifest = archive.read_json(FILE)?;
    let bad = |setting: &str| PrintFileError::bad_setting(FILE, setting);
    let mask = &manifest["mask"];
    let length = |key: &str| positive(mask[key].as_f64()).ok_or_else(|| bad(key));
    let side = |key: &str| {
        let value = mask[key].as_u64().and_then(|side| side.try_into().ok());
        value.ok_or_else(|| bad(key))
    };
    let is_mirrored = mask["is_mirrored"].as_bool();
    let entries = manifest["layer_files"].as_array();
    let entries = entries.ok_or_else(|| bad("layer_files"))?;
    let mut layers = Vec::with_capacity(entries.len());
    let mut masks = Vec::with_capacity(entries.len());
    for entry in entries {
        layers.push(Layer {
            z_mm: entry["z_mm"].as_f64().ok_or_else(|| bad("z_mm"))?,
            exposure_s: entry["exposure_s"].as_f64(),
            stated_lit_pixels: entry["lit_pixels"].as_u64(),
            ..Layer::default()
        });
        let name = entry["file"].as_str().ok_or_else(|| bad("file"))?;
        masks.push(name.to_owned());
    }
    let pixels = [side("width")?, side("height")?];
    let pixel_mm = [length("pitch_mm")?, length("pitch_y_mm")?];
    let resin = &manifest["resin"];
    let text = |value: &Value| value.as_str().and_then(clean);
    Ok(Contents {
        metadata: Metadata {
            version: manifest["schema"].as_u64().map(|schema| schema.to_string()),
            printer: printer(&manifest).and_then(clean),
            resin: text(&resin["name"]),
            is_mirrored_x: Some(is_mirrored.ok_or_else(|| bad("is_mirrored"))?),
            is_mirrored_y: Some(false),
            bottom_exposure_s: resin["bottom_exposure_s"].as_f64(),
            bottom_layers: resin["bottom_layers"].as_u64().map(|layers| layers as u32),
            print_time_s: manifest["print_time_s"].as_f64(),
            volume_ml: manifest["resin_ml"].as_f64(),
            uses_layer_values: Some(true),
            ..Metadata::new(Format::Png, pixels, pixel_mm)
        },
        layers: with_thicknesses(layers),
        coding: Coding::Png,
        places: Places::InZip(masks),
        pictures: Vec::new(),
        // A converted file has no models.
        copies: match &manifest["models"] {
            Value::Null => None,
            _ => Some(copies(&manifest).ok_or_else(|| bad("placements"))?),
        },
        findings: Vec::new(),
    })
}

/// The printer: by name, or described among the options of a plan.
fn printer(manifest: &Value) -> Option<&str> {
    let chosen = &manifest["options"]["printer"];
    let names = [chosen, &chosen["model"], &manifest["printer"]];
    names.into_iter().find_map(Value::as_str)
}

/// The copies, or `None` if a number of theirs is invalid.
fn copies(manifest: &Value) -> Option<Vec<PrintedCopy>> {
    let models = manifest["models"].as_array()?;
    let copy = |place: &Value| {
        let model = place["model"].as_u64()?;
        let mut models = models.iter();
        let own = models.find(|own| own["model"].as_u64() == Some(model))?;
        let middle_mm = [place["x_mm"].as_f64()?, place["y_mm"].as_f64()?];
        Some(PrintedCopy {
            model: model as usize,
            pose: pose(&own["options"], &manifest["options"])?,
            turn_deg: place["turn_deg"].as_u64()?.try_into().ok()?,
            middle_mm,
        })
    };
    manifest["placements"]
        .as_array()?
        .iter()
        .map(copy)
        .collect()
}

/// The pose among the options of a model, or else among those of all.
fn pose(own: &Value, shared: &Value) -> Option<Pose> {
    let of = |key: &str| match &own[key] {
        Value::Null => &shared[key],
        own => own,
    };
    let rotation = match of("rotation") {
        Value::Null => None,
        Value::Array(parts) => {
            let parts: Option<Vec<f64>> = parts.iter().map(Value::as_f64).collect();
            Some(parts?.try_into().ok()?)
        }
        _ => return None,
    };
    let height_mm = match of("height_mm") {
        Value::Null => None,
        height => Some(height.as_f64()?),
    };
    let unit = match &shared["unit"] {
        Value::Null => None,
        unit => Some(ModelUnit::named(unit.as_str()?.as_bytes())?),
    };
    Some(Pose {
        rotation,
        height_mm,
        unit,
    })
}
