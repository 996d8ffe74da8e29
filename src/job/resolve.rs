//! Resolves options into a job: every default of metric, printer and format is settled and checked, once. No stage behind
//! [`Options::resolve`] reads an option.
//!
//! Stages work from the parts of the job. The parts are comparable, so they are also the keys under which results are kept.

use super::{Backend, Error, GpuMethod, Minimize, Options, OptionsError, Planner, Snap};
use crate::format::Format;
use crate::grid::{Bins, Grid, GridError};
use crate::mask::{LEVELS, Samples};
use crate::model::{Bounds, Pose};
use crate::plan::optimal::Objective;
use crate::plan::{Limits, PlanError, uniform};
use crate::printer::{self, PRINTERS, Printer};
use crate::profile::{Metric, Source};
use crate::resin::Resin;

/// Resolved options.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Job {
    pub sampling: Sampling,
    pub layering: Layering,
    pub output: Output,
}

/// What the LDI depends on, besides the model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sampling {
    pub pose: Pose,
    pub raster: Raster,
    /// Height of the printer's build volume.
    pub greatest_height_mm: Option<f64>,
    pub samples: Samples,
    pub backend: Backend,
    pub gpu_method: GpuMethod,
}

/// How the masks' pixels are laid out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Raster {
    /// This many along the model's longer horizontal side.
    Around { pixels: u32 },
    /// As many of this pitch as cover the model.
    OfPitch { pitch_mm: f64 },
    /// Those of a plate, with the model at the centre.
    Plate {
        pixels: [u32; 2],
        pitch_mm: [f64; 2],
    },
}

/// What the plan depends on, besides the rays.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layering {
    pub bin_mm: f64,
    pub metric: Metric,
    pub source: Source,
    pub planner: Planner,
    pub target: Target,
    pub minimize: Minimize,
    /// The limits of plans, except for the tolerance.
    limits: Limits,
    /// Minimum area, in mm², of a flat that gets a plane. `None` if no planes are put at flats and sharp changes.
    pub snap_mm2: Option<f64>,
    pub saliency: bool,
    pub weight_min: f64,
    pub resin: Resin,
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

/// What the print file depends on, besides the plan and the rays.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub format: Format,
    pub is_mirrored: bool,
    pub printer: Option<&'static Printer>,
}

impl Options {
    /// Settles and checks everything that does not depend on the model.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`].
    pub(crate) fn resolve(&self) -> Result<Job, Error> {
        let printer = self.known_printer()?;
        Ok(Job {
            layering: self.layering(printer)?,
            sampling: self.sampling(printer)?,
            output: Output {
                format: self
                    .format
                    .or(printer.map(|printer| printer.format))
                    .unwrap_or_default(),
                is_mirrored: self
                    .mirror
                    .or(printer.map(|printer| printer.is_mirrored))
                    .unwrap_or(false),
                printer,
            },
        })
    }

    /// Rounds the minimum thickness that an error suggests down to whole micrometres, so that people can type it. Bins must
    /// stay the same, or the suggestion might not hold; if they do not, it is dropped.
    pub(crate) fn typeable(&self, mut error: PlanError) -> PlanError {
        if let PlanError::Infeasible {
            largest_layer_min_mm: largest_mm,
            ..
        } = &mut error
        {
            let bin_mm_at = |layer_min_mm: f64| {
                let options = Self {
                    layer_min_mm,
                    ..self.clone()
                };
                options.resolve().ok().map(|job| job.layering.bin_mm)
            };
            let bin_mm = bin_mm_at(self.layer_min_mm);
            *largest_mm = largest_mm.and_then(|largest_mm| {
                let below_um = (largest_mm * 1e3 + ROUNDING).floor();
                let mut choices_mm = [below_um, below_um - 1.0].map(|um| um / 1e3).into_iter();
                choices_mm.find(|&mm| mm > 0.0 && bin_mm_at(mm) == bin_mm)
            });
        }
        error
    }

    /// Checks everything that does not depend on the model.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`].
    pub fn check(&self) -> Result<(), Error> {
        self.resolve().map(|_| ())
    }

    fn known_printer(&self) -> Result<Option<&'static Printer>, OptionsError> {
        let Some(name) = &self.printer else {
            return Ok(None);
        };
        let unknown = || OptionsError::UnknownPrinter {
            printer: name.clone(),
            known: PRINTERS.iter().map(|printer| printer.name).collect(),
        };
        printer::named(name).map(Some).ok_or_else(unknown)
    }

    fn sampling(&self, printer: Option<&Printer>) -> Result<Sampling, OptionsError> {
        let pixels = self.pixels.or(printer.map(|printer| printer.pixels));
        let given_mm = self
            .pitch_mm
            .map(|x_mm| [x_mm, self.pitch_y_mm.unwrap_or(x_mm)]);
        let preset_mm = printer.map(|printer| printer.pitch_um.map(|pitch_um| pitch_um / 1e3));
        let raster = match (pixels, given_mm.or(preset_mm)) {
            (Some(pixels), Some(pitch_mm)) => Raster::Plate { pixels, pitch_mm },
            (None, Some([x_mm, y_mm])) if x_mm == y_mm => Raster::OfPitch { pitch_mm: x_mm },
            (None, None) => Raster::Around { pixels: self.rays },
            (Some(_), None) | (None, Some(_)) => return Err(OptionsError::PixelsWithoutPitch),
        };
        Ok(Sampling {
            pose: Pose {
                rotation: self.rotation,
                height_mm: self.height_mm,
            },
            raster,
            greatest_height_mm: printer.map(|printer| printer.volume_mm[2]),
            samples: Samples::of_level(self.antialias).ok_or(OptionsError::BadAntialias {
                antialias: self.antialias,
                known: LEVELS,
            })?,
            backend: self.backend,
            gpu_method: self.gpu_method,
        })
    }

    fn layering(&self, printer: Option<&Printer>) -> Result<Layering, Error> {
        self.check_printer(printer)?;
        if !(0.0..=1.0).contains(&self.weight_min) {
            let weight_min = self.weight_min;
            return Err(OptionsError::BadWeightMin { weight_min }.into());
        }
        self.resin.check().map_err(PlanError::from)?;
        let usual = self.metric.default_tolerance();
        let target = match (self.tolerance, self.max_layers, self.max_time_s) {
            (Some(tolerance), None, None) => Target::Tolerance(tolerance),
            (None, Some(layers), None) => Target::Layers(layers),
            (None, None, Some(time_s)) => Target::Time(time_s),
            // No default volume suits all models.
            (None, None, None) if self.metric == Metric::Volume => Target::AtLeast(usual),
            (None, None, None) => Target::Tolerance(usual),
            _ => return Err(OptionsError::SeveralTargets.into()),
        };
        let step_mm = match self.planner {
            // Uniform layers have the thickness that is given, not a multiple of the step.
            Planner::Uniform { .. } => None,
            _ => self.step_mm.or(printer.map(|printer| printer.step_mm)),
        };
        let bin_mm = self.bin_mm.unwrap_or_else(|| self.usual_bin_mm(step_mm));
        let layering = Layering {
            bin_mm,
            metric: self.metric,
            source: self.source,
            planner: self.planner,
            target,
            minimize: self.minimize,
            limits: Limits {
                layer_min_mm: self.layer_min_mm,
                layer_max_mm: self.layer_max_mm,
                tolerance: 0.0,
                ranges: self.ranges.clone(),
                planes_mm: self.planes_mm.clone(),
                step_mm,
            },
            snap_mm2: (self.snap == Snap::Auto).then_some(self.flat_area_mm2),
            saliency: self.saliency,
            weight_min: self.weight_min,
            resin: self.resin.clone(),
        };
        let bins = Bins {
            count: 1,
            size_mm: bin_mm,
        };
        match self.planner {
            Planner::Uniform { layer_mm } => {
                uniform::thickness_in_bins(bins, layer_mm)?;
            }
            _ => layering
                .limits(self.tolerance.unwrap_or(usual))
                .check(bins)?,
        }
        Ok(layering)
    }

    /// Checks that the printer can make the layers and the step.
    fn check_printer(&self, printer: Option<&Printer>) -> Result<(), OptionsError> {
        let Some(printer) = printer else {
            return Ok(());
        };
        let [printer_min_mm, printer_max_mm] = printer.layer_mm;
        for [layer_min_mm, layer_max_mm] in self.thicknesses_mm() {
            if layer_min_mm < printer_min_mm || layer_max_mm > printer_max_mm {
                return Err(OptionsError::PrinterLayers {
                    model: printer.model,
                    printer_min_mm,
                    printer_max_mm,
                    layer_min_mm,
                    layer_max_mm,
                });
            }
        }
        match self.step_mm {
            Some(step_mm) if !is_multiple(step_mm, printer.step_mm) => {
                Err(OptionsError::PrinterStep {
                    model: printer.model,
                    printer_step_mm: printer.step_mm,
                    step_mm,
                })
            }
            _ => Ok(()),
        }
    }

    /// Minimum and maximum thickness wherever the options give them: of uniform layers, or of all layers and of each height
    /// range.
    fn thicknesses_mm(&self) -> Vec<[f64; 2]> {
        if let Planner::Uniform { layer_mm } = self.planner {
            return vec![[layer_mm; 2]];
        }
        let ranges = self.ranges.iter();
        let ranges = ranges.map(|range| [range.layer_min_mm, range.layer_max_mm]);
        let all = std::iter::once([self.layer_min_mm, self.layer_max_mm]);
        all.chain(ranges).collect()
    }

    /// The default height of a bin. With a step, it is the largest height up to [`BIN_MM`] that divides the step; otherwise
    /// [`BIN_MM`], or half of it if a thickness needs that.
    fn usual_bin_mm(&self, step_mm: Option<f64>) -> f64 {
        match step_mm {
            // An invalid step is rejected where it is used.
            Some(step_mm) if step_mm >= ROUNDING => {
                step_mm / (step_mm / BIN_MM - ROUNDING).ceil().max(1.0)
            }
            Some(_) => BIN_MM,
            None => {
                // Uniform layers are compared with those of the minimum and maximum thickness.
                let all = [self.layer_min_mm, self.layer_max_mm];
                let mut thicknesses = self.thicknesses_mm().into_iter().flatten().chain(all);
                let is_whole = thicknesses.all(|thickness_mm| is_multiple(thickness_mm, BIN_MM));
                if is_whole { BIN_MM } else { BIN_MM / 2.0 }
            }
        }
    }
}

/// The default height of a bin in millimetres. It divides most layer thicknesses in use.
pub const BIN_MM: f64 = 0.002;

/// A quotient this close to a whole number counts as whole.
const ROUNDING: f64 = 1e-6;

fn is_multiple(length_mm: f64, of_mm: f64) -> bool {
    let quotient = length_mm / of_mm;
    quotient.round() >= 1.0 && (quotient - quotient.round()).abs() <= ROUNDING
}

impl Sampling {
    /// The pixels of the masks for a model of these bounds.
    ///
    /// # Errors
    /// [`GridError`], also if the model does not fit the printer.
    pub fn grid(&self, bounds: &Bounds) -> Result<Grid, GridError> {
        let grid = match self.raster {
            Raster::Plate { pixels, pitch_mm } => Grid::plate(bounds, pixels, pitch_mm)?,
            Raster::OfPitch { pitch_mm } => Grid::of_pitch(bounds, pitch_mm)?,
            Raster::Around { pixels } => Grid::around(bounds, pixels)?,
        };
        let model_mm_z = bounds.size().z;
        match self.greatest_height_mm {
            Some(printer_mm_z) if model_mm_z > printer_mm_z => Err(GridError::ModelTooHigh {
                model_mm_z,
                printer_mm_z,
                fitting_scale: (printer_mm_z / model_mm_z * 1e4).floor() / 1e4,
            }),
            _ => Ok(grid),
        }
    }

    /// The requested height, or `size_mm` rounded to the nanometre, which removes the noise of single precision.
    pub fn height_mm(&self, size_mm: f64) -> f64 {
        let asked_mm = self.pose.height_mm;
        asked_mm.unwrap_or_else(|| (size_mm * 1e6).round() / 1e6)
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

    /// What plans minimize.
    pub fn objective(&self) -> Objective<'_> {
        match self.minimize {
            Minimize::Layers => Objective::Layers,
            Minimize::Time => Objective::Time(&self.resin),
        }
    }
}
