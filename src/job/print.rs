//! The print file of a plan.

use std::io::Write;

use super::stages::parts::Output;
use super::stages::planned::Planned;
use super::{Error, Report};
use crate::archive::{self, Layer, Look, MaskSource, PrintJob, Screen};
use crate::progress::Progress;

/// Writes the print file of a plan that is exported as `output`, with these masks.
///
/// # Errors
/// [`Error::Archive`].
pub(super) fn write_print<W: Write>(
    planned: &Planned,
    output: &Output,
    report: &Report,
    masks: MaskSource<'_>,
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
    let job = PrintJob {
        screen: screen_of(planned, output),
        layers: &layers,
        masks,
        height_mm: report.height_mm,
        resin: &planned.layering.resin,
        transition_layers: 0,
        resin_ml: report.resin_ml,
        printer: output.printer.as_deref(),
        best_uniform: &|| planned.best_uniform(),
        look,
        manifest: &|| report.manifest(),
    };
    Ok(archive::write(output.format, &job, writer, progress)?)
}

/// The screen that shows the masks of a plan.
pub(super) fn screen_of(planned: &Planned, output: &Output) -> Screen {
    let grid = &planned.first().of.grid;
    Screen {
        pixels: [grid.width, grid.height],
        pitch_mm: [grid.pitch_mm, grid.pitch_y_mm],
        is_mirrored: output.is_mirrored,
        antialias: planned.first().of.sampling.samples.sublayers,
    }
}
