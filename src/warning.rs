//! Warnings: what users should know although the job went on.

use serde::Serialize;

use crate::ldi::GpuFault;
use crate::model::ModelUnit;
use crate::model::read::PartKind;
use crate::plan::uniform::UniformLayers;
use crate::profile::Metric;
use crate::resin::Resin;

/// Size of a model if its file is in a unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct UnitReading {
    /// The unit.
    pub unit: ModelUnit,
    /// The longest side in millimetres.
    pub size_mm: f64,
}

/// Something that the user should know although the job went on: a stable code and typed details. `Display` writes one
/// sentence.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Warning {
    /// Facets without an area were dropped.
    DegenerateFacets {
        /// Number of such facets.
        facets: usize,
    },
    /// The whole mesh was inside out, so all facets were turned over.
    InsideOut,
    /// Facets faced another way than their neighbours or their body, and were turned over.
    TurnedFacets {
        /// Number of such facets.
        facets: usize,
    },
    /// Facets cannot all face the same way, as on a Möbius strip, or where three meet at an edge.
    Unorientable {
        /// Edges at which they disagree.
        edges: usize,
    },
    /// The mesh has edges without a partner; its holes were closed by caps.
    OpenMesh {
        /// Edges without a partner.
        open_edges: usize,
        /// Holes that were closed.
        holes: usize,
    },
    /// Objects of a 3MF are not printed: supports of other programs, surfaces, and objects that a user turned off.
    SkippedObjects {
        /// Number of such objects.
        objects: usize,
    },
    /// A part of a project is subtracted from the others, as its slicer does.
    SubtractedPart {
        /// Its name.
        name: String,
    },
    /// A part of a project is not printed: it only guides the slicer that made it.
    SkippedPart {
        /// Its name.
        name: String,
        /// Its kind.
        kind: PartKind,
    },
    /// The project has several plates, of which one was read.
    OtherPlates {
        /// The plate, from 1.
        plate_number: u32,
        /// Number of plates.
        plates: u32,
    },
    /// The file states no unit, and in millimetres the model is under 1 mm, or wider than any plate that is known.
    OddSize {
        /// The longest side, if the file is in millimetres.
        size_mm: f64,
        /// The same in other units, where that is usual.
        readings: Vec<UnitReading>,
    },
    /// The file states another unit than the options, and its own counts.
    UnitStated {
        /// The unit of the file.
        stated: ModelUnit,
        /// The unit of the options.
        given: ModelUnit,
    },
    /// The model is nowhere thick enough for a void with its walls, so it stays solid.
    NothingHollowed {
        /// Thickness of the walls.
        wall_mm: f64,
        /// Diameter of the smallest cavity.
        cavity_mm: f64,
    },
    /// Drain holes are asked for, and the model has no closed cavity that they could drain.
    NothingToDrain,
    /// A drain hole does not meet the void, so it was left out.
    DrainAstray {
        /// Its place among those asked for, from 1.
        drain_number: usize,
    },
    /// No hole drains these parts of the void: nothing leads out of them on a level or downward.
    Undrained {
        /// Number of such parts.
        basins: usize,
    },
    /// Cavities of the model stay closed, with the resin in them: they lie too near the outside to be joined to the void, or struts hold
    /// the shell around them.
    ClosedCavities {
        /// Number of such cavities.
        cavities: usize,
        /// Volume of all of them.
        volume_mm3: f64,
        /// A point in the largest, in millimetres from the middle of the plate.
        at_mm: [f64; 3],
    },
    /// A support is asked for at a point that is not on the surface.
    SupportAstray {
        /// Its place among those asked for, from 1.
        point_number: usize,
    },
    /// No support reaches these points without touching the model on its way.
    Unsupported {
        /// Number of such points.
        points: usize,
    },
    /// Bodies of the file are its supports: printed, and left out of profiles and compensation.
    OwnSupports {
        /// Number of places where they hold the model.
        tips: usize,
        /// True if supports of the options replace them.
        replaced: bool,
    },
    /// Rays pass through holes of the mesh, and are closed by the caps alone.
    UnclosedRays {
        /// Number of such rays.
        unclosed: usize,
        /// Number of all rays.
        rays: usize,
    },
    /// No ray meets bodies of the model, which are narrower than a pixel: no mask shows them.
    MissedBodies {
        /// Number of such bodies.
        bodies: usize,
        /// The middle of the largest, in millimetres from the middle of the plate.
        at_mm: [f64; 3],
    },
    /// Layers exceed the tolerance, which this planner does not guarantee.
    ToleranceExceeded {
        /// Name of the planner.
        planner: String,
        /// Metric of the tolerance and the error.
        metric: Metric,
        /// The tolerance, in the metric's unit.
        tolerance: f64,
        /// The largest error, in the metric's unit.
        max_error: f64,
    },
    /// Layers keep the tolerance on the sampled surface, but exceed it on the mesh.
    ToleranceExceededOnMesh {
        /// Metric of the tolerance and the error.
        metric: Metric,
        /// The tolerance, in the metric's unit.
        tolerance: f64,
        /// The largest error, in the metric's unit.
        max_error: f64,
    },
    /// The surface intersects itself, so the areas of sections are measured by rays.
    SampledSections,
    /// Layers do not add up to the model's height, so the top was moved.
    TopMoved {
        /// Top of the print, in millimetres.
        top_mm: f64,
        /// Height of the model in millimetres.
        height_mm: f64,
    },
    /// The masks of some layers are black.
    BlackLayers {
        /// Number of black layers.
        layers: usize,
        /// Bottom of the lowest one, in millimetres above the plate.
        from_mm: f64,
    },
    /// Compensation erases parts of masks that are no thicker than the compensation and have no remaining lit area
    /// nearby.
    ErasedParts {
        /// Number of layers with such parts.
        layers: usize,
        /// Bottom of the lowest one, in millimetres above the plate.
        from_mm: f64,
        /// The largest area that it erases in one layer, in square millimetres.
        area_mm2: f64,
    },
    /// Roofs are so thin that even their last layer alone cures too deep.
    ThinRoofs {
        /// Their area in square millimetres.
        area_mm2: f64,
        /// The most by which one is too low, in millimetres.
        deep_mm: f64,
        /// The first of them, from the middle of its model and above the plate.
        at_mm: [f64; 3],
    },
    /// Light through the roofs of gaps cures all of the resin in them.
    ClosedGaps {
        /// Their area in square millimetres.
        area_mm2: f64,
        /// The first of them, from the middle of its model and above the plate.
        at_mm: [f64; 3],
    },
    /// The printer or its file takes one thickness for all layers, and the plan has several. Its print file will be refused.
    OneThickness {
        /// Make and model of the printer, or the name of the format.
        taker: String,
        /// The best uniform layers within tolerance, if any are.
        best: Option<UniformLayers>,
    },
    /// Layers are thinner or thicker than those whose exposures are measured, so theirs follow the curve through the nearest two.
    ExtrapolatedExposures {
        /// Number of such layers.
        layers: usize,
        /// The thinnest layer whose exposure is measured, in millimetres.
        thinnest_mm: f64,
        /// The thickest one.
        thickest_mm: f64,
    },
    /// It is not known if the printer prints layers of several thicknesses.
    UntriedThicknesses {
        /// Make and model of the printer.
        model: String,
    },
    /// It is not known if these slicers print the layers of a plan unchanged.
    UntriedSlicer {
        /// Names of the slicers.
        slicers: Vec<&'static str>,
    },
    /// The mesh does not fit into the buffers of the GPU; the CPU was used instead.
    GpuTooSmall {
        /// Bytes that the mesh needs.
        needed_bytes: u64,
        /// Size of the largest buffer in bytes.
        limit_bytes: u64,
    },
    /// The GPU failed; the CPU was used instead.
    GpuFailed {
        /// The fault.
        fault: GpuFault,
        /// Untranslated message of the system, if it gave one.
        system: Option<String>,
    },
}

impl Warning {
    /// The warning about layers of these thicknesses whose exposure is beyond those that are measured.
    pub(crate) fn of_exposures(resin: &Resin, thickness_mm: &[f64]) -> Option<Self> {
        /// Rounding error of thicknesses, which are whole bins.
        const ROUNDING_MM: f64 = 1e-6;
        let [thinnest_mm, thickest_mm] = resin.measured_mm()?;
        let measured_mm = thinnest_mm - ROUNDING_MM..=thickest_mm + ROUNDING_MM;
        let exposed = thickness_mm.iter().skip(resin.bottom_layers);
        let layers = exposed.filter(|it| !measured_mm.contains(it)).count();
        (layers > 0).then_some(Self::ExtrapolatedExposures {
            layers,
            thinnest_mm,
            thickest_mm,
        })
    }

    /// Returns true if it depends on the machine, not on the plan.
    pub(crate) fn is_of_the_machine(&self) -> bool {
        matches!(self, Self::GpuTooSmall { .. } | Self::GpuFailed { .. })
    }

    /// The sentences about reading a model.
    fn of_reading(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::DegenerateFacets { facets } => {
                write!(f, "left out {} without area", counted(*facets, "facet"))
            }
            Self::InsideOut => f.write_str("the mesh was inside out, and was turned over"),
            Self::TurnedFacets { facets } => write!(
                f,
                "turned over {} that faced the wrong way",
                counted(*facets, "facet")
            ),
            Self::Unorientable { edges } => write!(
                f,
                "facets cannot all face the same way at {}; what is inside there is a guess: look at the masks",
                counted(*edges, "edge")
            ),
            Self::OpenMesh { open_edges, holes } => write!(
                f,
                "the mesh is not closed: {} without a partner, {} closed by caps; look at the masks",
                counted(*open_edges, "edge"),
                counted(*holes, "hole"),
            ),
            Self::SkippedObjects { objects } => write!(
                f,
                "{} of the file left out: supports, surfaces, or not to be printed",
                counted(*objects, "object")
            ),
            Self::SubtractedPart { name } => write!(f, "the part “{name}” is subtracted"),
            Self::SkippedPart { name, kind } => {
                let kind = match kind {
                    PartKind::Negative => "negative part",
                    PartKind::Modifier => "modifier",
                    PartKind::SupportBlocker => "support blocker",
                    PartKind::SupportEnforcer => "support enforcer",
                };
                write!(f, "the {kind} “{name}” is left out")
            }
            Self::OtherPlates {
                plate_number,
                plates,
            } => write!(f, "plate {plate_number} of {plates} is read"),
            _ => Ok(()),
        }
    }

    /// The sentences about parts that no mask shows.
    fn of_vanishing(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MissedBodies {
                bodies,
                at_mm: [x, y, z],
            } => write!(
                f,
                "all masks miss {} of the model, the largest at {x}, {y}, {z}: narrower than a pixel, and hit by no \
                 ray; thicken it, or choose smaller pixels",
                either(*bodies, "body", "bodies"),
            ),
            Self::BlackLayers { layers, from_mm } => write!(
                f,
                "{} of the plan {} black, from {from_mm:.3} mm up: parts hang in the air, or are thinner than a pixel; look at the \
                 masks there",
                counted(*layers, "layer"),
                if *layers == 1 { "is" } else { "are" },
            ),
            Self::ErasedParts {
                layers,
                from_mm,
                area_mm2,
            } => write!(
                f,
                "compensation erases parts of {}, from {from_mm:.3} mm up, at most {area_mm2:.2} mm² in a layer: they are too \
                 thin for it; thicken them, or set a minimum feature width",
                counted(*layers, "layer"),
            ),
            Self::ThinRoofs {
                area_mm2,
                deep_mm,
                at_mm: [x, y, z],
            } => write!(
                f,
                "light cures through thin roofs of {area_mm2:.2} mm², whose undersides are up to {deep_mm:.3} mm too low, the first at \
                 {x}, {y}, {z}; thicken them, or turn the model"
            ),
            Self::ClosedGaps {
                area_mm2,
                at_mm: [x, y, z],
            } => write!(
                f,
                "light cures through roofs down to the floor and closes gaps over {area_mm2:.2} mm², the first at \
                 {x}, {y}, {z}; widen them, or turn the model"
            ),
            _ => Ok(()),
        }
    }

    /// The sentences about voids and their holes.
    fn of_preparing(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NothingHollowed { wall_mm, cavity_mm } => write!(
                f,
                "the model stays solid: it is nowhere thick enough for walls of {wall_mm} mm around a cavity of {cavity_mm} mm"
            ),
            Self::NothingToDrain => f.write_str(
                "the model has no closed cavity, so no drain hole was made; hollow it first",
            ),
            Self::DrainAstray { drain_number } => write!(
                f,
                "drain hole {drain_number} meets no void, and was left out; place it where the model is hollow, or turn it inward"
            ),
            Self::Undrained { basins } => write!(
                f,
                "{} full, since no hole there drains sideways or downward; place holes there, or turn the model",
                either(*basins, "part of the void stays", "parts of the void stay")
            ),
            Self::ClosedCavities {
                cavities,
                volume_mm3,
                at_mm: [x, y, z],
            } => write!(
                f,
                "{} closed, with {volume_mm3:.1} mm³ of resin, the largest at {x}, {y}, {z}; make holes to them, \
                 or fill them",
                either(
                    *cavities,
                    "cavity of the model stays",
                    "cavities of the model stay"
                )
            ),
            Self::SupportAstray { point_number } => write!(
                f,
                "support {point_number} is not on the model, and was left out; place it on the surface"
            ),
            Self::Unsupported { points } => write!(
                f,
                "{} without a support, since the model is in the way on all sides; turn the model",
                counted(*points, "point")
            ),
            Self::OwnSupports { tips, replaced } => write!(
                f,
                "supports of the file hold the model at {}; {}",
                counted(*tips, "point"),
                if *replaced {
                    "those that you chose replace them"
                } else {
                    "they are printed unchanged"
                }
            ),
            _ => Ok(()),
        }
    }

    /// The sentences about printers and slicers.
    fn of_printing(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::OneThickness { taker, best } => {
                write!(
                    f,
                    "{taker} takes one thickness for all layers, and this plan has several"
                )?;
                match best {
                    Some(best) => write!(f, "; {best} keep the tolerance"),
                    None => f.write_str("; choose the uniform planner"),
                }
            }
            Self::ExtrapolatedExposures {
                layers,
                thinnest_mm,
                thickest_mm,
            } => write!(
                f,
                "the exposure of {} is extrapolated, since exposures are measured from {thinnest_mm} to {thickest_mm} mm alone; \
                 measure theirs, or keep the minimum and maximum layer thickness within that range",
                counted(*layers, "layer"),
            ),
            Self::UntriedThicknesses { model } => write!(
                f,
                "it is not confirmed that the {model} prints layers of several thicknesses; print what `cusp calibrate layers` \
                 makes and measure it, or choose the uniform planner"
            ),
            Self::UntriedSlicer { slicers } => write!(
                f,
                "it is not confirmed that {} prints the layers of such a file as planned; compare the number and the heights of the \
                 layers in its preview before you print",
                slicers.join(" or ")
            ),
            _ => Ok(()),
        }
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::DegenerateFacets { .. }
            | Self::InsideOut
            | Self::TurnedFacets { .. }
            | Self::Unorientable { .. }
            | Self::OpenMesh { .. }
            | Self::SkippedObjects { .. }
            | Self::SubtractedPart { .. }
            | Self::SkippedPart { .. }
            | Self::OtherPlates { .. } => self.of_reading(f),
            Self::OddSize { size_mm, readings } => odd_size(f, *size_mm, readings),
            Self::UnitStated { stated, given } => write!(
                f,
                "the file is in {}, as it states, and not in {}",
                stated.plural(),
                given.plural()
            ),
            Self::NothingHollowed { .. }
            | Self::NothingToDrain
            | Self::DrainAstray { .. }
            | Self::Undrained { .. }
            | Self::ClosedCavities { .. }
            | Self::SupportAstray { .. }
            | Self::Unsupported { .. }
            | Self::OwnSupports { .. } => self.of_preparing(f),
            Self::UnclosedRays { unclosed, rays } => write!(
                f,
                "{unclosed} of {rays} rays pass holes of the mesh, which caps close; look at the masks"
            ),
            Self::MissedBodies { .. }
            | Self::BlackLayers { .. }
            | Self::ErasedParts { .. }
            | Self::ThinRoofs { .. }
            | Self::ClosedGaps { .. } => self.of_vanishing(f),
            Self::ToleranceExceeded {
                metric,
                tolerance,
                max_error,
                ..
            } => write!(
                f,
                "the error reaches {}, more than the tolerance of {}",
                metric.format(*max_error),
                metric.format(*tolerance)
            ),
            Self::ToleranceExceededOnMesh {
                metric,
                tolerance,
                max_error,
            } => write!(
                f,
                "on the mesh itself the error reaches {}, more than the tolerance of {}: rays miss a part of the surface",
                metric.format(*max_error),
                metric.format(*tolerance)
            ),
            Self::SampledSections => f.write_str(
                "the surface crosses itself, so that areas of sections are counted along rays",
            ),
            Self::TopMoved { top_mm, height_mm } => write!(
                f,
                "the print ends at {top_mm} mm, since layers do not add up to {height_mm} mm"
            ),
            Self::OneThickness { .. }
            | Self::ExtrapolatedExposures { .. }
            | Self::UntriedThicknesses { .. }
            | Self::UntriedSlicer { .. } => self.of_printing(f),
            Self::GpuTooSmall {
                needed_bytes,
                limit_bytes,
            } => write!(
                f,
                "the CPU did the work of the GPU: the mesh needs a buffer of {needed_bytes} bytes, and the GPU offers {limit_bytes}"
            ),
            Self::GpuFailed { fault, system } => {
                let fault = fault.in_words(system.as_deref());
                write!(f, "the CPU did the work of the GPU, which failed: {fault}")
            }
        }
    }
}

/// Asks for the unit of a model of an odd size.
fn odd_size(
    f: &mut std::fmt::Formatter<'_>,
    size_mm: f64,
    readings: &[UnitReading],
) -> std::fmt::Result {
    write!(
        f,
        "the file states no unit; in millimeters the model is {size_mm} mm long; "
    )?;
    for reading in readings {
        let UnitReading { unit, size_mm } = reading;
        write!(f, "in {} it would be {size_mm} mm; ", unit.plural())?;
    }
    f.write_str("set its unit if that is another")
}

/// A number with its noun: "1 hole", "2 holes".
fn counted(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A number with its noun, of which both forms are given.
fn either(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}
