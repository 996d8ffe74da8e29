//! Prusa's SL1 and SL1S: config.ini and prusaslicer.ini, with one thickness for all layers.

use std::fmt::Write as _;

use super::{Container, File, LayerEntry};
use crate::archive::{ArchiveError, PrintJob, millionths, thousandths};

pub struct Sl1;

/// The name of the job, which begins the names of masks.
const JOB: &str = "cusp";

/// Columns and rows of the larger preview.
const PREVIEW: [u32; 2] = [800, 480];

impl Container for Sl1 {
    fn mask_name(&self, layer: usize) -> String {
        format!("{JOB}{layer:05}.png")
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)(PREVIEW[0]);
        Ok(vec![
            ("config.ini".to_owned(), config(job, layers).into_bytes()),
            (
                "prusaslicer.ini".to_owned(),
                prusaslicer(job, layers).into_bytes(),
            ),
            (
                "thumbnail/thumbnail400x400.png".to_owned(),
                look.png([400, 400]),
            ),
            (
                "thumbnail/thumbnail800x480.png".to_owned(),
                look.png(PREVIEW),
            ),
        ])
    }
}

fn ini(pairs: &[(&str, String)]) -> String {
    let mut text = String::new();
    for (key, value) in pairs {
        let _ = writeln!(text, "{key} = {value}");
    }
    text
}

/// The thickness of all layers but the first.
fn layer_mm(layers: &[LayerEntry]) -> f64 {
    layers.get(1).unwrap_or(&layers[0]).thickness_mm
}

fn config(job: &PrintJob<'_>, layers: &[LayerEntry]) -> String {
    let resin = job.resin;
    let layer_mm = layer_mm(layers);
    let slow = resin.bottom_layers.min(layers.len());
    let name = resin.name.replace(['\n', '\r'], " ");
    let is_first_model = job
        .printer
        .and_then(|printer| printer.reads.first())
        .is_some_and(|extension| extension == "sl1");
    let (model, profile) = if is_first_model {
        ("SL1", "Original Prusa SL1")
    } else {
        ("SL1S", "Original Prusa SL1S SPEED")
    };
    ini(&[
        ("action", "print".to_owned()),
        ("expTime", thousandths(resin.exposure_s(layer_mm))),
        ("expTimeFirst", thousandths(resin.bottom_exposure_s)),
        (
            "fileCreationTimestamp",
            "1980-01-01 at 00:00:00 UTC".to_owned(),
        ),
        ("hollow", "0".to_owned()),
        ("jobDir", JOB.to_owned()),
        ("layerHeight", millionths(layer_mm)),
        ("materialName", name),
        ("numFade", job.transition_layers.to_string()),
        ("numFast", (layers.len() - slow).to_string()),
        ("numSlow", slow.to_string()),
        ("printProfile", format!("{} mm", millionths(layer_mm))),
        ("printTime", thousandths(job.print_time_s())),
        ("printerModel", model.to_owned()),
        ("printerProfile", profile.to_owned()),
        ("printerVariant", "default".to_owned()),
        (
            "prusaSlicerVersion",
            concat!("Cusp-", env!("CARGO_PKG_VERSION")).to_owned(),
        ),
        ("usedMaterial", thousandths(job.resin_ml)),
    ])
}

fn prusaslicer(job: &PrintJob<'_>, layers: &[LayerEntry]) -> String {
    let layer_mm = layer_mm(layers);
    let screen = &job.screen;
    // The display's sides are given in landscape, even where masks are in portrait.
    let is_portrait = screen.pixels[1] > screen.pixels[0];
    let [long, short] = if is_portrait { [1, 0] } else { [0, 1] };
    let side_mm = screen.size_mm();
    ini(&[
        ("printer_technology", "SLA".to_owned()),
        ("display_width", thousandths(side_mm[long])),
        ("display_height", thousandths(side_mm[short])),
        ("display_pixels_x", screen.pixels[long].to_string()),
        ("display_pixels_y", screen.pixels[short].to_string()),
        ("display_mirror_x", u8::from(screen.is_mirrored).to_string()),
        ("display_mirror_y", "0".to_owned()),
        (
            "display_orientation",
            if is_portrait { "portrait" } else { "landscape" }.to_owned(),
        ),
        ("layer_height", millionths(layer_mm)),
        ("initial_layer_height", millionths(layers[0].thickness_mm)),
        ("exposure_time", thousandths(job.resin.exposure_s(layer_mm))),
        (
            "initial_exposure_time",
            thousandths(job.resin.bottom_exposure_s),
        ),
        ("faded_layers", job.transition_layers.to_string()),
        ("gamma_correction", "1".to_owned()),
    ])
}
