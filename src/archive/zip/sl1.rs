//! Prusa's SL1 and SL1S: config.ini and prusaslicer.ini, with one thickness for all layers.

use std::fmt::Write as _;

use super::{Container, File, LayerEntry};
use crate::archive::preview::Look;
use crate::archive::{ArchiveError, PrintJob, thousandths};
use crate::format::Format;

pub struct Sl1;

/// The name of the job, which begins the names of masks.
const JOB: &str = "cusp";

impl Container for Sl1 {
    fn check(&self, job: &PrintJob<'_>) -> Result<(), ArchiveError> {
        // The thickness of the first layer may differ.
        let mut later = job.plan.thickness_mm().into_iter().skip(1);
        let second = later.next();
        if later.any(|thickness_mm| Some(thickness_mm) != second) {
            return Err(ArchiveError::UniformOnly {
                format: Format::Sl1,
                others: Format::VARIABLE,
            });
        }
        Ok(())
    }

    fn mask_name(&self, layer: usize) -> String {
        format!("{JOB}{layer:05}.png")
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = Look::new(job.mesh, job.ldi);
        Ok(vec![
            ("config.ini".to_owned(), config(job, layers).into_bytes()),
            (
                "prusaslicer.ini".to_owned(),
                prusaslicer(job, layers).into_bytes(),
            ),
            (
                "thumbnail/thumbnail400x400.png".to_owned(),
                look.png(400, 400),
            ),
            (
                "thumbnail/thumbnail800x480.png".to_owned(),
                look.png(800, 480),
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
        ("layerHeight", thousandths(layer_mm)),
        ("materialName", name),
        // No transition layers: all bottom layers have the same exposure.
        ("numFade", "0".to_owned()),
        ("numFast", (layers.len() - slow).to_string()),
        ("numSlow", slow.to_string()),
        ("printProfile", format!("{} mm", thousandths(layer_mm))),
        ("printTime", thousandths(job.print_time_s())),
        ("printerModel", "SL1S".to_owned()),
        ("printerProfile", "Original Prusa SL1S SPEED".to_owned()),
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
    let grid = &job.masks.grid;
    // The display's sides are given in landscape, even where masks are in portrait.
    let is_portrait = grid.height > grid.width;
    let (long, short) = if is_portrait {
        ((grid.height, grid.pitch_y_mm), (grid.width, grid.pitch_mm))
    } else {
        ((grid.width, grid.pitch_mm), (grid.height, grid.pitch_y_mm))
    };
    let mm = |side: (u32, f64)| thousandths(f64::from(side.0) * side.1);
    ini(&[
        ("printer_technology", "SLA".to_owned()),
        ("display_width", mm(long)),
        ("display_height", mm(short)),
        ("display_pixels_x", long.0.to_string()),
        ("display_pixels_y", short.0.to_string()),
        ("display_mirror_x", u8::from(job.is_mirrored).to_string()),
        ("display_mirror_y", "0".to_owned()),
        (
            "display_orientation",
            if is_portrait { "portrait" } else { "landscape" }.to_owned(),
        ),
        ("layer_height", thousandths(layer_mm)),
        ("initial_layer_height", thousandths(layers[0].thickness_mm)),
        ("exposure_time", thousandths(job.resin.exposure_s(layer_mm))),
        (
            "initial_exposure_time",
            thousandths(job.resin.bottom_exposure_s),
        ),
        ("faded_layers", "0".to_owned()),
        ("gamma_correction", "1".to_owned()),
    ])
}
