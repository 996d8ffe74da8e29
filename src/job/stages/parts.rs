//! Resolved options in parts: what each stage works from. They are comparable, so they are also the keys under which results are kept.

use std::sync::Arc;

use glam::DVec2;

use crate::compensation::Compensation;
use crate::filament::FilamentSlicer;
use crate::format::Format;
use crate::grid::{Bins, Grid, GridError};
use crate::job::{Backend, GpuMethod, Minimize, Planner};
use crate::mask::{Samples, Side};
use crate::model::{Bounds, Mesh, Pose};
use crate::plan::Limits;
use crate::plan::optimal::Objective;
use crate::prepare::{Hollowing, Supporting};
use crate::printer::Printer;
use crate::profile::{Metric, Source};
use crate::resin::Resin;

/// Resolved options.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Resolved {
    pub sampling: Sampling,
    pub layering: Layering,
    pub output: Output,
}

/// Inputs of the LDI, besides the model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sampling {
    pub pose: Pose,
    pub hollow: Option<Hollowing>,
    pub supports: Option<Supporting>,
    /// Width by which supports are made wider on each side, as masks are narrower than what they print; 0 without any.
    pub wider_mm: f64,
    pub raster: Raster,
    /// Height of the printer's build volume.
    pub greatest_height_mm: Option<f64>,
    pub samples: Samples,
    pub backend: Backend,
    pub gpu_method: GpuMethod,
}

/// Layout of the masks' pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Raster {
    /// A number of pixels along the model's longer horizontal side.
    Around { pixels: u32 },
    /// The fewest pixels of a pitch that cover the model.
    OfPitch { pitch_mm: f64 },
    /// The pixels of a plate, with the model at its centre.
    Plate {
        pixels: [u32; 2],
        pitch_mm: [f64; 2],
    },
}

/// Inputs of the plan, besides the rays.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layering {
    pub bin_mm: f64,
    pub metric: Metric,
    pub source: Source,
    pub planner: Planner,
    pub target: Target,
    pub minimize: Minimize,
    /// The limits of plans, except for the tolerance.
    pub(in crate::job) limits: Limits,
    pub thicknesses: Thicknesses,
    /// Minimum area, in mm², of a flat that gets a plane. `None` if no planes are put at flats and sharp changes.
    pub snap_mm2: Option<f64>,
    pub saliency: bool,
    pub weight_min: f64,
    pub resin: Resin,
    /// Compensation for the resin and the printer together.
    pub compensation: Compensation,
    /// The least width that making up for it leaves; 0 for none.
    pub min_feature_mm: f64,
    /// Steps of brightness that put cured bottoms between those of layers: anti-aliased masks on a printer whose greys cure in proportion, of
    /// a resin that states its print-through. 1 for none.
    pub greys: u32,
}

/// The tolerance that a plan keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Target {
    /// This one, in the metric's unit.
    Tolerance(f64),
    /// This one, or the smallest that a plan keeps if that is larger.
    AtLeast(f64),
    /// The smallest that needs at most this many layers.
    Layers(usize),
    /// The smallest that prints in at most this many seconds.
    Time(f64),
}

/// Thicknesses within the limits that layers may have, and their order, if the optimal planner chooses them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Thicknesses {
    /// Any.
    Any,
    /// These, in millimetres.
    Of(Vec<f64>),
    /// At most this many distinct ones.
    AtMost(usize),
    /// Changing by at most this many millimetres from layer to layer.
    Gradual(f64),
}

/// Inputs of the print file, besides the plan and the rays.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub format: Format,
    pub is_mirrored: bool,
    pub printer: Option<Arc<Printer>>,
    /// For a slicer of filament printers, in place of masks.
    pub filament: Option<Filament>,
    /// True if pieces that float in the vat are no reason to refuse it.
    pub allow_floating: bool,
}

/// Inputs of a file for a slicer of filament printers, besides plan and model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Filament {
    pub slicer: FilamentSlicer,
    pub nozzle_mm: f64,
    pub first_layer_mm: f64,
}

impl Output {
    /// The side from which the printer shows the masks.
    pub fn side(&self) -> Side {
        if self.is_mirrored {
            Side::Below
        } else {
            Side::Above
        }
    }
}

impl Layering {
    /// Returns true if stages after the survey pass over all rays, several times for each plan.
    pub fn needs_rays(&self) -> bool {
        self.source == Source::Sampled
            || !self.compensation.is_none()
            || self.resin.print_through.is_some()
    }

    /// [`Sampling::wider_mm`] of a model with or without supports.
    pub fn support_wider_mm(&self, has_supports: bool) -> f64 {
        if has_supports {
            self.compensation.xy_mm.max(0.0)
        } else {
            0.0
        }
    }
}

impl Sampling {
    /// The pixels of the masks for a model of these bounds, lifted above the plate by `lift_mm`.
    ///
    /// # Errors
    /// [`GridError`], also if the model does not fit the printer.
    pub fn grid(&self, bounds: &Bounds, lift_mm: f64) -> Result<Grid, GridError> {
        let grid = match self.raster {
            Raster::Plate { pixels, pitch_mm } => Grid::plate(bounds, pixels, pitch_mm)?,
            Raster::OfPitch { pitch_mm } => Grid::of_pitch(bounds, pitch_mm)?,
            Raster::Around { pixels } => Grid::around(bounds, pixels)?,
        };
        let model_mm_z = bounds.size().z + lift_mm;
        match self.greatest_height_mm {
            Some(printer_mm_z) if model_mm_z > printer_mm_z => Err(GridError::ModelTooHigh {
                model_mm_z,
                printer_mm_z,
                fitting_scale: ((printer_mm_z - lift_mm) / bounds.size().z * 1e4).floor() / 1e4,
            }),
            _ => Ok(grid),
        }
    }

    /// Refuses a model that does not fit the printer in its pose. If copies may turn, refuses only models longer than the plate's diagonal:
    /// arranging decides about the others.
    ///
    /// # Errors
    /// [`GridError`].
    pub fn check_fit(
        &self,
        bounds: &Bounds,
        lift_mm: f64,
        may_turn: bool,
    ) -> Result<(), GridError> {
        match self.grid(bounds, lift_mm) {
            Err(GridError::ModelTooLarge {
                model_mm_x,
                model_mm_y,
                grid_mm_x,
                grid_mm_y,
                ..
            }) if may_turn && model_mm_x.max(model_mm_y) <= grid_mm_x.hypot(grid_mm_y) => Ok(()),
            fit => fit.map(drop),
        }
    }

    /// The pixels of the masks for a model with its supports.
    ///
    /// # Errors
    /// [`GridError`], also if the supports extend beyond the printer's plate.
    pub fn grid_around(&self, grid: Grid, printed: &Bounds) -> Result<Grid, GridError> {
        let wider = grid.containing(printed)?;
        if !matches!(self.raster, Raster::Plate { .. }) || wider == grid {
            return Ok(wider);
        }
        let covered = [
            f64::from(grid.width) * grid.pitch_mm,
            f64::from(grid.height) * grid.pitch_y_mm,
        ];
        let middle = grid.corner_mm + DVec2::new(covered[0], -covered[1]) / 2.0;
        let size = 2.0 * (printed.max.truncate() - middle).max(middle - printed.min.truncate());
        Err(GridError::ModelTooLarge {
            model_mm_x: size.x,
            model_mm_y: size.y,
            grid_mm_x: covered[0],
            grid_mm_y: covered[1],
            fitting_scale: ((covered[0] / size.x).min(covered[1] / size.y) * 1e4).floor() / 1e4,
        })
    }

    /// The weights of facets that say where no contact and no drain hole may be, if they do.
    pub fn protected<'a>(&self, weights: Option<&'a [f32]>) -> Option<&'a [f32]> {
        let of_supports = self.supports.iter().map(|it| it.protect);
        let of_drains = self.hollow.iter().filter_map(|it| it.auto_drain);
        let mut protect = of_supports.chain(of_drains.map(|it| it.protect));
        weights.filter(|_| protect.any(|it| it))
    }

    /// Distance by which supports of the options lift the model above the plate.
    pub fn made_lift_mm(&self) -> f64 {
        let supports = self.supports.as_ref();
        supports.map_or(0.0, |it| it.profile().lift_mm)
    }

    /// The same, or that of the supports in the model's file.
    pub fn lift_mm(&self, model: &Mesh) -> f64 {
        match self.supports {
            Some(_) => self.made_lift_mm(),
            None => model.raised_mm(),
        }
    }

    /// The requested height, or `size_mm` rounded to the nanometre, which removes the noise of single precision; plus
    /// the lift of supports.
    pub fn height_mm(&self, size_mm: f64, lift_mm: f64) -> f64 {
        let asked_mm = self.pose.height_mm;
        asked_mm.unwrap_or_else(|| (size_mm * 1e6).round() / 1e6) + lift_mm
    }
}

impl Layering {
    /// The limits of plans with this tolerance.
    pub fn limits(&self, tolerance: f64) -> Limits {
        Limits {
            tolerance,
            ..self.limits.clone()
        }
    }

    /// Minimum and maximum layer thickness of a plan in these bins, in millimetres: rounded inward to whole motor steps, or
    /// to whole bins if there is no step.
    pub fn layer_range_mm(&self, bins: Bins) -> [f64; 2] {
        let Limits {
            layer_min_mm,
            layer_max_mm,
            ..
        } = self.limits;
        let limits = &self.limits;
        let range = limits.thickness(bins, layer_min_mm, layer_max_mm);
        match (range, limits.unit(bins)) {
            (Ok(range), Ok(unit)) => {
                [*range.start(), *range.end()].map(|units| bins.boundary_mm(units * unit))
            }
            // Uniform layers may be planned with a range that holds no thickness.
            _ => [layer_min_mm, layer_max_mm],
        }
    }

    /// Quantity that plans minimize.
    pub fn objective(&self) -> Objective<'_> {
        match self.minimize {
            Minimize::Layers => Objective::Layers,
            Minimize::Time => Objective::Time(&self.resin),
        }
    }
}
