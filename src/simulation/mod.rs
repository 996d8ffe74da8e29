//! What a print file prints, measured against the model: an independent check of finished print files, whoever wrote them.
//!
//! [`simulate`] builds the printed solid from the masks and heights of a print file, each lit pixel as high as its layer, and
//! measures two one-sided distances between its surface and the model's: how far the print is from the model
//! ([`Simulation::print_to_model`]), and how far the model is from the print ([`Simulation::model_to_print`]). The first
//! finds what is printed but should not be; the second what should be printed but is not.
//!
//! It shares no code with profiles, planners, masks and encoders, so their defects are not its own. It reads models as they
//! do, and print files by [`crate::archive::read`].
//!
//! Both distances may be off by up to half a pixel's diagonal, because that is what masks resolve. Grey pixels count as
//! printed from half brightness on.

mod deviation;
mod error;
mod hidden;
mod model_to_print;
mod nearest;
mod print_to_model;
mod printed;

use glam::DVec2;
use serde::Serialize;

pub use deviation::{Deviation, LayerDeviation};
pub use error::SimulationError;

use crate::archive::read::PrintFile;
use crate::format::Format;
use crate::model::{Mesh, Pose};
use crate::progress::{Progress, report};
use deviation::Tally;
use hidden::Visibility;
use nearest::Facets;
use printed::Printed;

/// What is known about a print file besides what it says. Given values take precedence over the file's.
#[derive(Debug, Clone, Copy, Default)]
pub struct Knowledge {
    /// How the model stands.
    pub pose: Option<Pose>,
    /// Whether the masks are mirrored left to right.
    pub is_mirrored: Option<bool>,
}

/// Where the masks are relative to the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// The file says that the model's bounding box is at their centre.
    Stated,
    /// The file does not say so, but the bounding box of lit pixels is at their centre as well, to a pixel.
    Centre,
    /// The bounding box of lit pixels is elsewhere, and is taken for the model's in x and y.
    LitPixels,
}

/// The printed solid, measured against the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Simulation {
    /// Format of the print file.
    pub format: Format,
    /// Number of layers.
    pub layers: usize,
    /// Height of the print.
    pub height_mm: f64,
    /// Extent of the model in x, y and z, as it stands.
    pub model_mm: [f64; 3],
    /// Columns and rows of the masks.
    pub pixels: [u32; 2],
    /// Sides of a pixel.
    pub pixel_mm: [f64; 2],
    /// Half the diagonal of a pixel: what masks do not resolve, and by which any distance may be off.
    pub half_pixel_diagonal_mm: f64,
    /// Where the masks are relative to the model.
    pub placement: Placement,
    /// The centre of the masks relative to that of the model's bounding box, in x and y.
    pub offset_mm: [f64; 2],
    /// By how much the greatest distances may be too small, because surfaces are asked at points: half a pixel.
    pub precision_mm: f64,
    /// Number of facets that are left out because they are not on the surface of the solid: between overlapping bodies, for
    /// example.
    pub hidden_facets: usize,
    /// From the print to the model.
    pub print_to_model: Deviation,
    /// From the model to the print.
    pub model_to_print: Deviation,
}

/// Measures a print file against `model`, a mesh as it is in its file, with holes capped.
///
/// Holds the bytes and, as runs, all masks in memory. The result does not depend on the number of threads.
///
/// # Errors
/// [`SimulationError`].
pub fn simulate(
    model: &Mesh,
    print_file: &[u8],
    knowledge: &Knowledge,
    progress: &mut Progress<'_>,
) -> Result<Simulation, SimulationError> {
    report(progress, 0.0)?;
    let file = PrintFile::open(print_file)?;
    if let Some(copies) = file.copies().filter(|copies| *copies > 1) {
        return Err(SimulationError::Several { copies });
    }
    let mut flips = file.about().flips();
    if let Some(is_mirrored) = knowledge.is_mirrored {
        flips.mirror_x = is_mirrored;
    }
    let pose = knowledge.pose.or(file.pose());
    let mesh = model.on_plate(&pose.unwrap_or_default())?;
    let mut printed = Printed::read(&file, flips, progress, [0.0, 0.2])?;
    let (placement, offset) = place(&mut printed, &mesh, file.pose().is_some());

    let mut facets = Facets::of(&mesh);
    let visibility = hidden::classify(&mesh, &facets, progress, [0.2, 0.3])?;
    let is_hidden: Vec<bool> = visibility
        .iter()
        .map(|&it| it == Visibility::Hidden)
        .collect();
    let hidden_facets = is_hidden.iter().filter(|&&it| it).count();
    facets.skip(is_hidden);
    let from_print = print_to_model::measure(&printed, &facets, progress, [0.3, 0.65])?;
    let from_model =
        model_to_print::measure(&mesh, &facets, &visibility, &printed, progress, [0.65, 1.0])?;

    let deviation = |tallies: &[Tally]| Deviation::of(tallies, &printed.z_mm);
    Ok(Simulation {
        format: file.about().format,
        layers: printed.layers(),
        height_mm: printed.z_mm[printed.layers()],
        model_mm: mesh.bounds().size().to_array(),
        pixels: printed.pixels,
        pixel_mm: printed.pitch.to_array(),
        half_pixel_diagonal_mm: printed.pitch.length() / 2.0,
        placement,
        offset_mm: offset.to_array(),
        precision_mm: model_to_print::precision_mm(&printed),
        hidden_facets,
        print_to_model: deviation(&from_print),
        model_to_print: deviation(&from_model),
    })
}

/// Moves the masks to their place, and returns what told it and how far their centre is from the model's.
fn place(printed: &mut Printed, mesh: &Mesh, is_stated: bool) -> (Placement, DVec2) {
    let bounds = mesh.bounds();
    let lit = printed.lit_centre();
    let (placement, offset) = if is_stated {
        (Placement::Stated, DVec2::ZERO)
    } else if lit.abs().cmple(printed.pitch).all() {
        (Placement::Centre, DVec2::ZERO)
    } else {
        (Placement::LitPixels, -lit)
    };
    printed.corner += (bounds.min + bounds.max).truncate() * 0.5 + offset;
    (placement, offset)
}
