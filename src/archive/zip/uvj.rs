//! UVJ: config.json with a height and an exposure for each layer, and masks in `slice/`.

use serde_json::{Value, json};

use super::{Container, File, LayerEntry};
use crate::archive::{ArchiveError, PrintJob};

pub struct Uvj;

/// The factor by which a layer may exceed the nominal layer height in readers that check it.
const STEP_ROOM: f64 = 1.5;

/// Columns and rows of the larger preview.
const PREVIEW: [u32; 2] = [800, 480];

impl Container for Uvj {
    fn mask_name(&self, layer: usize) -> String {
        format!("slice/{layer:08}.png")
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)(PREVIEW[0]);
        let config = serde_json::to_vec(&config(job, layers)).map_err(ArchiveError::write)?;
        Ok(vec![
            ("config.json".to_owned(), config),
            ("preview/huge.png".to_owned(), look.png(PREVIEW)),
            ("preview/tiny.png".to_owned(), look.png([400, 300])),
        ])
    }
}

fn config(job: &PrintJob<'_>, layers: &[LayerEntry]) -> Value {
    let resin = job.resin;
    let [x_mm, y_mm] = job.screen.size_mm();
    let exposure = |exposure_s: f64| {
        json!({
            "LightOnTime": exposure_s,
            "LightOffTime": resin.wait_s,
            "LightPWM": 255,
            "LiftHeight": resin.lift_mm,
            "LiftSpeed": resin.lift_mm_min,
            "RetractHeight": 0.0,
            "RetractSpeed": resin.return_mm_min,
        })
    };
    let thickness_mm = layers.iter().map(|layer| layer.thickness_mm);
    let thickest_mm = thickness_mm.fold(0.0, f64::max);
    let usual_mm = job.usual_mm();
    let mut bottom = exposure(resin.bottom_exposure_s);
    bottom["Count"] = json!(resin.bottom_layers);
    let layers: Vec<Value> = layers
        .iter()
        .map(|layer| json!({ "Z": layer.z_mm, "Exposure": exposure(layer.exposure_s) }))
        .collect();
    json!({
        "Properties": {
            "Size": {
                "X": job.screen.pixels[0],
                "Y": job.screen.pixels[1],
                "Millimeter": {
                    "X": x_mm,
                    "Y": y_mm,
                },
                "Layers": layers.len(),
                "LayerHeight": usual_mm.max((thickest_mm / STEP_ROOM * 1e3).ceil() / 1e3),
            },
            "Exposure": exposure(resin.exposure_s(usual_mm)),
            "Bottom": bottom,
            "AntiAliasLevel": job.screen.antialias,
        },
        "Layers": layers,
    })
}
