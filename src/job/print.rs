//! The print file of a plan.

use std::io::Write;

use super::parts::Output;
use super::planned::Planned;
use super::{Error, Report};
use crate::archive::{self, Layer, Look, PrintJob, Screen};
use crate::mask::RunSource;
use crate::progress::Progress;

/// Writes the print file of a plan that is exported as `output`, with these masks.
///
/// # Errors
/// [`Error::Archive`].
pub(super) fn write_print<W: Write>(
    planned: &Planned,
    output: &Output,
    report: &Report,
    masks: &dyn RunSource,
    look: &dyn Fn() -> Look,
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, Error> {
    let layers: Vec<Layer> = (0..report.layers)
        .map(|layer| Layer {
            z_mm: report.z_mm[layer + 1],
            thickness_mm: report.thickness_mm[layer],
            exposure_s: report.exposure_s[layer],
        })
        .collect();
    let grid = &planned.first().of.grid;
    let job = PrintJob {
        screen: Screen {
            pixels: [grid.width, grid.height],
            pitch_mm: [grid.pitch_mm, grid.pitch_y_mm],
            is_mirrored: output.is_mirrored,
            antialias: planned.first().of.sampling.samples.sublayers,
        },
        layers: &layers,
        masks,
        height_mm: report.height_mm,
        resin: &planned.layering.resin,
        resin_ml: report.resin_ml,
        printer: output.printer.as_deref(),
        best_uniform: &|| planned.best_uniform(),
        look,
        manifest: &|| report.manifest(),
    };
    Ok(archive::write(output.format, &job, writer, progress)?)
}
