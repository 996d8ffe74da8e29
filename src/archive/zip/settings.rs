//! Settings of printers as JSON: templates in which a text such as `$layer_mm` stands for a value of the job. Most
//! settings never change, and take less room as text than as code.

use serde_json::{Value, json};

use super::{File, LayerEntry, joined_bounds, json_file};
use crate::archive::{ArchiveError, PrintJob, Screen, tidy};
use crate::printer::Printer;

/// The values of a job by their names in templates.
pub struct Settings {
    values: Vec<(&'static str, Value)>,
}

impl Settings {
    /// Numbers with a fraction become `number`'s.
    pub fn new(job: &PrintJob<'_>, layers: &[LayerEntry], number: fn(f64) -> Value) -> Self {
        let PrintJob {
            screen:
                Screen {
                    pixels,
                    pitch_mm,
                    antialias,
                    is_mirrored,
                },
            resin,
            ..
        } = *job;
        let [x_mm, y_mm] = job.screen.size_mm();
        let [x_min_mm, y_min_mm, x_max_mm, y_max_mm] = job.screen.bounds_mm(joined_bounds(layers));
        let layer_mm = job.usual_mm();
        let numbers = [
            ("$screen_x_mm", x_mm),
            ("$screen_y_mm", y_mm),
            ("$plate_z_mm", job.volume_mm()[2]),
            ("$pitch_x_mm", pitch_mm[0]),
            ("$pitch_y_mm", pitch_mm[1]),
            ("$pitch_x_um", pitch_mm[0] * 1e3),
            ("$pitch_y_um", pitch_mm[1] * 1e3),
            ("$x_min_mm", x_min_mm),
            ("$x_max_mm", x_max_mm),
            ("$y_min_mm", y_min_mm),
            ("$y_max_mm", y_max_mm),
            ("$top_mm", layers.last().map_or(0.0, |layer| layer.z_mm)),
            ("$layer_mm", layer_mm),
            ("$layer_um", layer_mm * 1e3),
            ("$exposure_s", resin.exposure_s(layer_mm)),
            ("$bottom_exposure_s", resin.bottom_exposure_s),
            ("$wait_s", resin.wait_s),
            ("$lift_mm", resin.lift_mm),
            ("$lift_mm_min", resin.lift_mm_min),
            ("$lift_mm_s", resin.lift_mm_min / 60.0),
            ("$return_mm_min", resin.return_mm_min),
            ("$return_mm_s", resin.return_mm_min / 60.0),
            ("$density_g_ml", resin.density_g_ml),
            ("$volume_ml", job.resin_ml),
            ("$weight_g", job.resin_ml * resin.density_g_ml),
        ];
        let counts = [
            ("$columns", u64::from(pixels[0])),
            ("$rows", u64::from(pixels[1])),
            ("$middle_column", u64::from(pixels[0] / 2)),
            ("$middle_row", u64::from(pixels[1] / 2)),
            ("$antialias", u64::from(antialias)),
            ("$is_mirrored", u64::from(is_mirrored)),
            ("$layers", layers.len() as u64),
            (
                "$bottom_layers",
                resin.bottom_layers.min(layers.len()) as u64,
            ),
            ("$transition_layers", job.transition_layers as u64),
            ("$has_layer_settings", u64::from(job.needs_layer_settings())),
            ("$time_s", job.print_time_s().round() as u64),
        ];
        let version = env!("CARGO_PKG_VERSION");
        // The sign parts the four names from one another: maker, resin, film and setting.
        let resin_name = resin.name.replace('@', " ");
        let texts = [
            (
                "$machine",
                job.printer.map_or("Unknown", Printer::machine).to_owned(),
            ),
            (
                "$resin_setting",
                format!("Generic@{resin_name}@Unknown@Cusp"),
            ),
            ("$resin", resin_name),
            ("$version", version.to_owned()),
            ("$software", format!("Cusp {version}")),
        ];
        let numbers = numbers.map(|(name, value)| (name, number(tidy(value))));
        let counts = counts.map(|(name, count)| (name, json!(count)));
        let texts = texts.map(|(name, text)| (name, json!(text)));
        Self {
            values: numbers.into_iter().chain(counts).chain(texts).collect(),
        }
    }

    /// Adds or replaces a value.
    pub fn set(&mut self, name: &'static str, value: Value) {
        self.values.insert(0, (name, value));
    }

    /// The files of a template: an object with their names and contents.
    pub fn files(&self, template: &str) -> Result<Vec<File>, ArchiveError> {
        let mut files: Value = serde_json::from_str(template).map_err(ArchiveError::write)?;
        self.fill(&mut files);
        let files = files.as_object().into_iter().flatten();
        files.map(|(name, value)| json_file(name, value)).collect()
    }

    fn fill(&self, value: &mut Value) {
        match value {
            Value::String(text) => {
                if let Some((_, found)) = self.values.iter().find(|(name, _)| name == text) {
                    *value = found.clone();
                }
            }
            Value::Array(items) => items.iter_mut().for_each(|item| self.fill(item)),
            Value::Object(fields) => fields.values_mut().for_each(|field| self.fill(field)),
            _ => {}
        }
    }
}
