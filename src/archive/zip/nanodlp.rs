//! NanoDLP: masks `1.png` and so on, three pixels of the screen in a pixel of the image, and settings as JSON, with one
//! thickness for all layers.
//!
//! Fields that nothing is known to depend on are 0 or empty, as in files of other slicers. Readers disagree on which
//! numbers have a decimal point: mslicer's requires it in lengths, areas and exposures, and rejects it in waits and lifts.

use serde_json::{Value, json};

use super::settings::Settings;
use super::{Container, File, LayerEntry, json_file};
use crate::archive::png::{self, Depth};
use crate::archive::survey::Survey;
use crate::archive::{ArchiveError, Canvas, PrintJob, Screen, tidy};
use crate::mask::Run;

pub struct Nanodlp;

/// Some programs read `options.json`, some `slicer.json`: both say the same. The g-code around layers stays empty: it is the
/// machine's own. `TotalSolidArea` of the plate is millilitres of resin, whatever its name says.
const TEMPLATE: &str = include_str!("nanodlp.json");

/// Columns and rows of the preview.
const PREVIEW: [u32; 2] = [607, 487];

impl Container for Nanodlp {
    fn mask_name(&self, layer: usize) -> String {
        format!("{}.png", layer + 1)
    }

    fn mask(&self, canvas: Canvas, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        png::encode(runs, canvas.pixels, Depth::Thirds)
    }

    fn needs_survey(&self) -> bool {
        true
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)(PREVIEW[0]);
        let mut settings = Settings::new(job, layers, |number| json!(number));
        let resin = job.resin;
        for (name, number) in [
            ("$short_layer_um", job.usual_mm() * 1e3),
            ("$short_wait_s", resin.wait_s),
            ("$short_lift_mm", resin.lift_mm),
            ("$short_lift_mm_min", resin.lift_mm_min),
            ("$short_return_mm_min", resin.return_mm_min),
        ] {
            settings.set(name, short(tidy(number)));
        }
        let mut files = settings.files(TEMPLATE)?;
        let info = layers.iter().map(|layer| info(&job.screen, layer));
        files.push(json_file("info.json", &info.collect())?);
        files.push(("3d.png".to_owned(), look.png(PREVIEW)));
        Ok(files)
    }
}

/// A number, without a decimal point if it is whole.
fn short(value: f64) -> Value {
    if value.fract() == 0.0 {
        json!(value as i64)
    } else {
        json!(value)
    }
}

/// Areas of a layer in mm², and the first and last lit columns and rows.
fn info(screen: &Screen, layer: &LayerEntry) -> Value {
    let Survey { bounds, areas } = layer.survey();
    let mm2 = |pixels: u64| tidy(pixels as f64 * screen.pitch_mm[0] * screen.pitch_mm[1]);
    let [left, top, right, bottom] = bounds.unwrap_or([0, 0, 1, 1]);
    json!({
        "TotalSolidArea": mm2(layer.lit_pixels),
        "LargestArea": mm2(areas.iter().max().copied().unwrap_or(0)),
        "SmallestArea": mm2(areas.iter().min().copied().unwrap_or(0)),
        "MinX": left,
        "MinY": top,
        "MaxX": right - 1,
        "MaxY": bottom - 1,
        "AreaCount": areas.len(),
    })
}
