//! The print that a print file makes, measured against the model: an independent check of finished print files from any
//! program.
//!
//! [`simulate`] builds the printed solid from the masks and heights of a print file, each lit pixel as high as its
//! layer, and measures two one-sided distances between its surface and the model's: from the print to the model
//! ([`Simulation::print_to_model`]), and from the model to the print ([`Simulation::model_to_print`]). The first finds
//! material that is printed but should not be; the second material that should be printed but is not.
//!
//! It shares no code with profiles, planners, masks and encoders, so their defects are not its own. It reads models as they
//! do, and print files by [`crate::archive::read`].
//!
//! Both distances may be off by up to half a pixel's diagonal, because that is what masks resolve. Grey pixels count as
//! printed from half brightness on. With a resin that states its print-through, layers also cure below their bottoms
//! ([`Knowledge::cure`]), and grey pixels get light in proportion to their brightness.

mod cured;
mod deviation;
mod error;
mod hidden;
mod model_to_print;
mod nearest;
mod print_to_model;
mod printed;

use glam::{DVec2, DVec3};
use serde::Serialize;

pub use deviation::{Deviation, LayerDeviation};
pub use error::SimulationError;

use crate::archive::read::{PrintFile, PrintedCopy};
use crate::format::Format;
use crate::model::read::Contents;
use crate::model::{FacetClass, Mesh, MeshError, ModelUnit, Pose, TURNS};
use crate::parallel;
use crate::progress::{Progress, report};
use crate::resin::Resin;
use deviation::Tally;
use hidden::Visibility;
use nearest::Facets;
use printed::Printed;

/// Knowledge about a print file besides its contents. Given values take precedence over the file's.
#[derive(Debug, Clone, Default)]
pub struct Knowledge {
    /// The pose of each model before turns.
    pub pose: Option<Pose>,
    /// The copies in the masks, where the file does not say it.
    pub copies: Vec<PrintedCopy>,
    /// True if the masks are mirrored left to right.
    pub is_mirrored: Option<bool>,
    /// A resin, by whose print-through the layers cure deeper than they are thick.
    pub cure: Option<Resin>,
}

/// A model in the frame of its file.
#[derive(Debug, Clone)]
pub struct Original {
    /// Its mesh, with holes capped.
    pub mesh: Mesh,
    /// The unit that the file states, from which the mesh was converted.
    pub unit: Option<ModelUnit>,
}

impl Original {
    /// The model of a file.
    ///
    /// # Errors
    /// [`MeshError`].
    pub fn of(contents: &Contents) -> Result<Self, MeshError> {
        Ok(Self {
            mesh: Mesh::from_triangles(&contents.triangles)?,
            unit: contents.unit,
        })
    }
}

/// Placement of the masks relative to the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// The file says where each copy is, or the caller does: a model alone has its bounding box at their centre.
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
    /// Number of copies of models.
    pub copies: usize,
    /// Extent in x, y and z of the model in its pose, or of all copies together.
    pub model_mm: [f64; 3],
    /// Columns and rows of the masks.
    pub pixels: [u32; 2],
    /// Sides of a pixel.
    pub pixel_mm: [f64; 2],
    /// Half the diagonal of a pixel: what masks do not resolve, and by which any distance may be off.
    pub half_pixel_diagonal_mm: f64,
    /// Placement of the masks relative to the model.
    pub placement: Placement,
    /// The centre of the masks relative to that of the model's bounding box, in x and y.
    pub offset_mm: [f64; 2],
    /// Amount by which the greatest distances may be too small, because surfaces are sampled at points: half a pixel.
    pub precision_mm: f64,
    /// Number of facets that are left out because they are not on the surface of the solid: between overlapping bodies, for
    /// example.
    pub hidden_facets: usize,
    /// From the print to the model.
    pub print_to_model: Deviation,
    /// From the model to the print.
    pub model_to_print: Deviation,
}

/// Measures a print file against all models that it prints.
///
/// Holds the bytes and, as runs, all masks in memory. The result does not depend on the number of threads.
///
/// # Errors
/// [`SimulationError`].
pub fn simulate(
    models: &[Original],
    print_file: &[u8],
    knowledge: &Knowledge,
    progress: &mut Progress<'_>,
) -> Result<Simulation, SimulationError> {
    report(progress, 0.0)?;
    let file = PrintFile::open(print_file)?;
    let mut flips = file.metadata().flips();
    if let Some(is_mirrored) = knowledge.is_mirrored {
        flips.mirror_x = is_mirrored;
    }
    let stated = file.copies().unwrap_or(&knowledge.copies);
    let is_stated = !stated.is_empty();
    // As in its file, in the middle.
    let alone = [PrintedCopy::default()];
    let copies = match (stated, models) {
        ([], [_]) => &alone,
        ([], _) => return Err(SimulationError::NoPlaces),
        _ => stated,
    };
    let mesh = standing(models, copies, knowledge.pose)?;
    let mut printed = Printed::read(&file, flips, progress, [0.0, 0.2])?;
    let (placement, offset) = if is_stated {
        (Placement::Stated, DVec2::ZERO)
    } else {
        place(&mut printed, &mesh)
    };
    if let Some(resin) = &knowledge.cure
        && let Some(print_through) = &resin.print_through
    {
        let layers = file.layers().iter().enumerate();
        let exposures_s = layers.map(|(layer, it)| {
            let exposure_s = it.exposure_s;
            exposure_s.ok_or(SimulationError::NoExposure { layer: layer + 1 })
        });
        let exposures_s: Vec<f64> = exposures_s.collect::<Result<_, _>>()?;
        let layers = (0..file.layers().len()).collect();
        let greys = parallel::map(layers, |layer| file.greys(layer, flips));
        let greys: Vec<_> = greys.into_iter().collect::<Result<_, _>>()?;
        printed = cured::cured(printed, &greys, &exposures_s, resin, print_through);
    }

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
        format: file.metadata().format,
        layers: printed.layers(),
        height_mm: printed.z_mm[printed.layers()],
        copies: copies.len(),
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

/// All copies at their places, in one mesh.
fn standing(
    models: &[Original],
    copies: &[PrintedCopy],
    pose: Option<Pose>,
) -> Result<Mesh, SimulationError> {
    let placed = |copy: &PrintedCopy| {
        let original = models.get(copy.model).ok_or(SimulationError::NoModel {
            model_number: copy.model.saturating_add(1),
            models: models.len(),
        })?;
        let pose = pose.unwrap_or(copy.pose);
        let pose = Pose {
            unit: pose.unit.filter(|_| original.unit.is_none()),
            ..pose
        };
        let turned = pose.turned(copy.turn_deg % 360 * TURNS / 360);
        let mesh = original.mesh.on_plate(&turned);
        mesh.map_err(|error| SimulationError::Mesh {
            model: copy.model,
            error,
        })
    };
    if let [alone] = copies
        && alone.middle_mm == [0.0; 2]
    {
        return placed(alone);
    }
    let mut triangles = Vec::new();
    for copy in copies {
        let mesh = placed(copy)?;
        let [x_mm, y_mm] = copy.middle_mm;
        let moved = |vertex: u32| {
            let at = mesh.vertices[vertex as usize].as_dvec3() + DVec3::new(x_mm, y_mm, 0.0);
            at.as_vec3()
        };
        let surface = mesh.of_class(FacetClass::Surface).iter();
        triangles.extend(surface.map(|facet| facet.map(moved)));
    }
    Ok(Mesh::from_triangles(&triangles)?)
}

/// Moves the masks to their place, and returns the source of that place and the distance of their centre from the
/// model's.
fn place(printed: &mut Printed, mesh: &Mesh) -> (Placement, DVec2) {
    let bounds = mesh.bounds();
    let lit = printed.lit_centre();
    let (placement, offset) = if lit.abs().cmple(printed.pitch).all() {
        (Placement::Centre, DVec2::ZERO)
    } else {
        (Placement::LitPixels, -lit)
    };
    printed.corner += (bounds.min + bounds.max).truncate() * 0.5 + offset;
    (placement, offset)
}
