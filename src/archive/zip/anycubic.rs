//! Anycubic's zips of 2024 and later, pm7 and pwsz for example: masks in pw0, settings as JSON with a thickness and an
//! exposure for each layer, and a table of the layers' areas.
//!
//! Firmware is said to be strict about types of numbers. Values that are fractions in files of Anycubic's own slicer
//! are written with a decimal point, `46.0` say, and values that are integers there, without.

use serde_json::{Value, json};

use super::settings::Settings;
use super::{Container, File, LayerEntry, joined_bounds, json_file};
use crate::archive::fields::{ByteOrder, Fields};
use crate::archive::survey::Survey;
use crate::archive::{ArchiveError, Canvas, PrintJob, Screen, pw0, tidy};
use crate::mask::Run;

pub struct Anycubic;

/// Settings that printers expect, after files of Anycubic's own slicer. Lifts have one stage: the second has no height.
/// No curve of exposures is selected and the printer's own mode is off, so the printer keeps to the exposures and
/// speeds here. The image format is always called `pwszImg`, and `property` and the constants of print times are the
/// same for all printers.
const TEMPLATE: &str = include_str!("anycubic.json");

/// The format's name for its masks.
const IMAGE_FORMAT: &str = "pw0Img";
/// The extension for printers that do not say.
const USUAL_SUFFIX: &str = "pwsz";
/// Columns and rows of the previews: two on the printer, one in the maker's cloud.
const PREVIEWS: [[u32; 2]; 3] = [[224, 168], [336, 252], [800, 600]];
const SOFTWARE: &str = concat!("Cusp ", env!("CARGO_PKG_VERSION"));

impl Container for Anycubic {
    fn mask_name(&self, layer: usize) -> String {
        format!("layer_images/layer_{layer}.{IMAGE_FORMAT}")
    }

    fn mask(&self, canvas: Canvas, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        pw0::encode(runs, canvas.area())
    }

    fn needs_survey(&self) -> bool {
        true
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)(PREVIEWS[2][0]);
        let mut settings = Settings::new(job, layers, Value::from);
        let suffix = job.printer.and_then(|printer| printer.reads.first());
        settings.set(
            "$suffix",
            json!(suffix.map_or(USUAL_SUFFIX, String::as_str)),
        );
        let mut files = settings.files(TEMPLATE)?;
        files.push(json_file(
            "layers_controller.conf",
            &layers_controller(job, layers),
        )?);
        for (index, size) in PREVIEWS.into_iter().enumerate() {
            let name = format!("preview_images/preview_{index}.png");
            files.push((name, look.png(size)));
        }
        files.push(("scene.slice".to_owned(), scene(&job.screen, layers)));
        Ok(files)
    }
}

fn layers_controller(job: &PrintJob<'_>, layers: &[LayerEntry]) -> Value {
    let resin = job.resin;
    let layers = layers.iter().enumerate().map(|(index, layer)| {
        json!({
            "exposure_time": tidy(layer.exposure_s),
            "layer_index": index,
            "layer_minheight": tidy(layer.z_mm - layer.thickness_mm),
            "layer_thickness": tidy(layer.thickness_mm),
            "zup_height": tidy(resin.lift_mm),
            "zup_speed": tidy(resin.lift_mm_min / 60.0),
        })
    });
    json!({ "count": layers.len(), "paras": layers.collect::<Value>() })
}

/// The table of layers: heights, areas and boxes.
fn scene(screen: &Screen, layers: &[LayerEntry]) -> Vec<u8> {
    let count = layers.len() as u32;
    let pixel_mm2 = screen.pitch_mm[0] * screen.pitch_mm[1];
    let mut bytes = Vec::with_capacity(400 + 64 * layers.len());
    let mut fields = Fields::new(&mut bytes, ByteOrder::Little);
    fields.text("ANYCUBIC-PWSZ", 16);
    fields.text(SOFTWARE, 64);
    // The kind of file that printers expect, its version, the kind of slices, and millimetres.
    for number in [3, 1, 0, 0] {
        fields.u32(number);
    }
    fields.f32(1.0);
    fields.u32(count);
    let [left_mm, first_mm, right_mm, last_mm] = screen.bounds_mm(joined_bounds(layers));
    let top_mm = layers.last().map_or(0.0, |layer| layer.z_mm);
    for number in [left_mm, first_mm, 0.0, right_mm, last_mm, top_mm] {
        fields.f32(number);
    }
    fields.u32(0);
    fields.zeros(4 * 64);
    fields.bytes(b"<---");
    fields.u32(count);
    for layer in layers {
        let Survey { bounds, areas } = layer.survey();
        fields.f32(layer.z_mm);
        fields.f32(layer.lit_pixels as f64 * pixel_mm2);
        for number in screen.bounds_mm(*bounds) {
            fields.f32(number);
        }
        fields.u32(areas.len() as u32);
        let largest = areas.iter().max().copied().unwrap_or(0);
        fields.f32(largest as f64 * pixel_mm2);
        fields.zeros(4 * 8);
    }
    fields.bytes(b"--->");
    bytes
}
