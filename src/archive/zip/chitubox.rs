//! The zip of ChiTuBox: masks `1.png` and so on, and run.gcode, which gives each layer its own height and exposure. A
//! dozen printers read it, and other programs convert it.

use std::fmt::Write as _;

use super::{Container, File, LayerEntry};
use crate::archive::{ArchiveError, PrintJob, thousandths};
use crate::printer::Printer;

pub struct Chitubox;

/// Columns and rows of the larger preview.
const PREVIEW: [u32; 2] = [954, 850];

impl Container for Chitubox {
    fn mask_name(&self, layer: usize) -> String {
        format!("{}.png", layer + 1)
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)(PREVIEW[0]);
        Ok(vec![
            ("run.gcode".to_owned(), run_gcode(job, layers).into_bytes()),
            ("preview.png".to_owned(), look.png(PREVIEW)),
            ("preview_cropping.png".to_owned(), look.png([168, 150])),
        ])
    }
}

fn run_gcode(job: &PrintJob<'_>, layers: &[LayerEntry]) -> String {
    let PrintJob {
        printer,
        resin,
        screen,
        ..
    } = *job;
    let volume_mm = job.volume_mm();
    let mm = thousandths;
    let usual_mm = job.usual_mm();
    let head = [
        ("fileName", "model".to_owned()),
        (
            "machineType",
            printer.map_or("custom", Printer::machine).to_owned(),
        ),
        ("estimatedPrintTime", mm(job.print_time_s())),
        ("volume", mm(job.resin_ml)),
        ("resin", resin.name.replace(['\n', '\r'], " ")),
        ("weight", mm(job.resin_ml * resin.density_g_ml)),
        ("price", "0".to_owned()),
        ("layerHeight", mm(usual_mm)),
        ("resolutionX", screen.pixels[0].to_string()),
        ("resolutionY", screen.pixels[1].to_string()),
        ("machineX", mm(volume_mm[0])),
        ("machineY", mm(volume_mm[1])),
        ("machineZ", mm(volume_mm[2])),
        (
            "projectType",
            if screen.is_mirrored {
                "LCD_mirror"
            } else {
                "Normal"
            }
            .to_owned(),
        ),
        ("normalExposureTime", mm(resin.exposure_s(usual_mm))),
        // Some readers look for the misspelt key.
        ("bottomLayExposureTime", mm(resin.bottom_exposure_s)),
        ("bottomLayerExposureTime", mm(resin.bottom_exposure_s)),
        ("normalDropSpeed", mm(resin.return_mm_min)),
        ("normalLayerLiftHeight", mm(resin.lift_mm)),
        ("normalLayerLiftSpeed", mm(resin.lift_mm_min)),
        ("bottomLayerLiftHeight", mm(resin.lift_mm)),
        ("bottomLayerLiftSpeed", mm(resin.lift_mm_min)),
        ("lightOffTime", mm(resin.wait_s)),
        ("bottomLightOffTime", mm(resin.wait_s)),
        ("bottomPWMLight", "255".to_owned()),
        ("PWMLight", "255".to_owned()),
        ("antiAliasLevel", screen.antialias.to_string()),
        ("bottomLayCount", resin.bottom_layers.to_string()),
        ("bottomLayerCount", resin.bottom_layers.to_string()),
        ("totalLayer", layers.len().to_string()),
        ("mirror", u8::from(screen.is_mirrored).to_string()),
    ];
    let mut text = String::new();
    for (key, value) in head {
        let _ = writeln!(text, ";{key}:{value}");
    }
    text.push_str("\n;START_GCODE_BEGIN\nG21;\nG90;\nM106 S0;\nM17;\nG28 Z0;\n;START_GCODE_END\n");
    // Readers take a layer without a lift for a pause.
    let lift_mm = resin.lift_mm.max(0.1);
    for (index, layer) in layers.iter().enumerate() {
        let _ = write!(
            text,
            "\n;LAYER_START:{index}\nM6054 \"{}\";\nG0 Z{} F{};\nG0 Z{} F{};\nG4 P{};\nM106 S255;\nG4 P{};\nM106 S0;\n;LAYER_END\n",
            layer.file,
            mm(layer.z_mm + lift_mm),
            mm(resin.lift_mm_min),
            mm(layer.z_mm),
            mm(resin.return_mm_min),
            milliseconds(resin.wait_s),
            milliseconds(layer.exposure_s),
        );
    }
    let top_mm = layers.last().map_or(0.0, |layer| layer.z_mm);
    let _ = write!(
        text,
        "\n;END_GCODE_BEGIN\nM106 S0;\nG1 Z{} F{};\nM18;\n;END_GCODE_END\n",
        mm((top_mm + lift_mm).max(volume_mm[2])),
        mm(resin.lift_mm_min)
    );
    text
}

fn milliseconds(seconds: f64) -> u64 {
    (seconds * 1e3).round() as u64
}
