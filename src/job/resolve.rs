//! Resolves options: every default of metric, printer and format is settled and checked, once. No stage behind
//! [`Options::resolve`] reads an option.

use std::sync::Arc;

use super::stages::parts::{
    Filament, Layering, Output, Raster, Resolved, Sampling, Target, Thicknesses,
};
use super::{Error, LAYERS_MM, Minimize, Options, OptionsError, Planner, Snap};
use crate::filament::NOZZLES_MM;
use crate::format::Format;
use crate::grid::Bins;
use crate::mask::{LEVELS, Samples};
use crate::model::Pose;
use crate::plan::{Limits, PlanError, uniform};
use crate::prepare::{BadLength, Hollowing, Supporting};
use crate::printer::{self, PRINTERS, Printer, PrinterChoice};
use crate::profile::Metric;

/// The widest feature that compensation leaves alone.
const MOST_FEATURE_MM: f64 = 10.0;

impl Options {
    /// Settles and checks everything that does not depend on the model.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`].
    pub(crate) fn resolve(&self) -> Result<Resolved, Error> {
        self.settled().resolve_settled()
    }

    fn resolve_settled(&self) -> Result<Resolved, Error> {
        let printer = find_printer(self.printer.as_ref())?;
        let filament = self.check_filament(printer.as_deref())?;
        let mut layering = self.layering(printer.as_deref())?;
        if filament.is_some() {
            layering.resin.print_through = None;
            layering.greys = 1;
        }
        let mut sampling = self.sampling(printer.as_deref())?;
        sampling.wider_mm = layering.support_wider_mm(self.supports.is_some());
        Ok(Resolved {
            layering,
            sampling,
            output: Output {
                format: self
                    .format
                    .or(printer.as_deref().map(|printer| printer.format))
                    .unwrap_or_default(),
                is_mirrored: self
                    .mirror
                    .or(printer.as_deref().map(|printer| printer.is_mirrored))
                    .unwrap_or(false),
                printer,
                filament,
                allow_floating: self.allow_floating,
            },
        })
    }

    /// Rounds the minimum thickness that an error suggests down to whole micrometres, so that people can type it. Bins must
    /// stay the same, or the suggestion might not hold; if they do not, it is dropped.
    pub(crate) fn typeable(&self, mut error: Error) -> Error {
        if let Error::Plan(PlanError::Infeasible {
            largest_layer_min_mm: largest_mm,
            ..
        }) = &mut error
        {
            let bin_mm_at = |layer_min_mm: f64| {
                let options = Self {
                    layer_min_mm: Some(layer_min_mm),
                    ..self.clone()
                };
                options
                    .resolve()
                    .ok()
                    .map(|resolved| resolved.layering.bin_mm)
            };
            let bin_mm = bin_mm_at(self.settled().range_mm()[0]);
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
        check_prepared(self.hollow.as_ref(), self.supports.as_ref())?;
        let mut supports = self.supports.clone();
        if let (Some(supports), Some(film_kpa)) =
            (&mut supports, printer.and_then(|it| it.film_kpa))
        {
            let profile = supports.profile.insert(supports.profile());
            profile.film_kpa.get_or_insert(film_kpa);
        }
        Ok(Sampling {
            hollow: self.hollow.clone(),
            supports,
            wider_mm: 0.0,
            pose: Pose {
                rotation: self.rotation,
                height_mm: self.height_mm,
                unit: self.unit,
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
        let usual = self.default_tolerance();
        let target = match (self.tolerance, self.max_layers, self.max_time_s) {
            (Some(tolerance), None, None) => Target::Tolerance(tolerance),
            (None, Some(layers), None) => Target::Layers(layers),
            (None, None, Some(time_s)) => Target::Time(time_s),
            // No default volume suits all models.
            (None, None, None) if self.metric == Metric::Volume => Target::AtLeast(usual),
            (None, None, None) => Target::Tolerance(usual),
            _ => return Err(OptionsError::SeveralTargets.into()),
        };
        let thicknesses = self.thicknesses()?;
        let [layer_min_mm, layer_max_mm] = self.range_mm();
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
                layer_min_mm,
                layer_max_mm,
                tolerance: 0.0,
                ranges: self.ranges.clone(),
                planes_mm: self.planes_mm.clone(),
                first_layer_mm: self.first_layer_mm,
                step_mm,
            },
            thicknesses,
            snap_mm2: (self.snap == Snap::Auto).then_some(self.flat_area_mm2),
            saliency: self.saliency,
            weight_min: self.weight_min,
            resin: self.resin.clone(),
            compensation: printer.map_or(self.resin.compensation, |printer| {
                self.resin.compensation.and(printer.compensation)
            }),
            min_feature_mm: self.min_feature_mm()?,
            greys: match (printer, &self.resin.print_through) {
                (Some(printer), Some(_)) if printer.proportional_greys => self.antialias,
                _ => 1,
            },
        };
        let bins = Bins {
            count: 1,
            size_mm: bin_mm,
        };
        if let Planner::Uniform { layer_mm } = self.planner {
            uniform::thickness_in_bins(bins, layer_mm)?;
        } else {
            let limits = layering.limits(self.tolerance.unwrap_or(usual));
            limits.check(bins)?;
            if let Some(most_mm) = self.support_layer_mm {
                limits.thickness(bins, layer_min_mm, most_mm)?;
            }
        }
        if self.support_layer_mm.is_some() && !self.planner.is_adaptive() {
            return Err(OptionsError::Contradictory {
                option: "support_layer_mm",
                other: "planner",
            }
            .into());
        }
        Ok(layering)
    }

    fn min_feature_mm(&self) -> Result<f64, OptionsError> {
        let value_mm = self.min_feature_mm.unwrap_or(0.0);
        if (0.0..=MOST_FEATURE_MM).contains(&value_mm) {
            return Ok(value_mm);
        }
        Err(OptionsError::BadLength {
            option: "min_feature_mm",
            value_mm,
            least_mm: 0.0,
            most_mm: MOST_FEATURE_MM,
        })
    }

    /// The thickness rule of the optimal planner.
    fn thicknesses(&self) -> Result<Thicknesses, OptionsError> {
        let rules = [
            (!self.thicknesses_mm.is_empty()).then(|| {
                let thicknesses = Thicknesses::Of(self.thicknesses_mm.clone());
                ("thicknesses_mm", thicknesses)
            }),
            self.max_thicknesses
                .map(|count| ("max_thicknesses", Thicknesses::AtMost(count))),
            self.max_change_mm
                .map(|change_mm| ("max_change_mm", Thicknesses::Gradual(change_mm))),
        ];
        let mut rules = rules.into_iter().flatten();
        let Some((option, rule)) = rules.next() else {
            return Ok(Thicknesses::Any);
        };
        let others = [
            rules.next().map(|(other, _)| other),
            (self.planner != Planner::Optimal).then_some("planner"),
            (self.minimize != Minimize::Layers).then_some("minimize"),
            self.max_layers.map(|_| "max_layers"),
            self.max_time_s.map(|_| "max_time_s"),
        ];
        match others.into_iter().flatten().next() {
            Some(other) => Err(OptionsError::Contradictory { option, other }),
            None => Ok(rule),
        }
    }

    /// Minimum and maximum thickness of layers outside height ranges: those of the given thicknesses, if there are any.
    fn range_mm(&self) -> [f64; 2] {
        let mut given_mm = self.thicknesses_mm.iter().copied();
        let Some(first_mm) = given_mm.next() else {
            let [least_mm, most_mm] = LAYERS_MM;
            let least_mm = self.layer_min_mm.unwrap_or(least_mm);
            return [least_mm, self.layer_max_mm.unwrap_or(most_mm)];
        };
        given_mm.fold([first_mm; 2], |[least_mm, greatest_mm], mm| {
            [least_mm.min(mm), greatest_mm.max(mm)]
        })
    }

    /// Settings of a file for a slicer of filament printers, if the format is for one: a nozzle that prints the layers.
    /// It is an error if an option applies to resin printers only.
    fn check_filament(&self, printer: Option<&Printer>) -> Result<Option<Filament>, OptionsError> {
        let (slicer, nozzle_mm, first_layer_mm) =
            match (self.filament(), self.nozzle_mm, self.first_layer_mm) {
                (None, None, _) => return Ok(None),
                (Some(slicer), Some(nozzle_mm), Some(first_layer_mm)) => {
                    (slicer, nozzle_mm, first_layer_mm)
                }
                _ => {
                    return Err(OptionsError::NozzleWithoutFilament {
                        formats: Format::FILAMENT,
                    });
                }
            };
        if let (Some(format), Some(printer)) = (self.format, printer) {
            return Err(OptionsError::ResinPrinter {
                format,
                model: printer.model.clone(),
            });
        }
        let of_resin = [
            self.hollow.as_ref().map(|_| "hollow"),
            self.support_layer_mm.map(|_| "support_layer_mm"),
            self.supports.as_ref().map(|_| "supports"),
            self.max_time_s.map(|_| "max_time_s"),
            (self.minimize == Minimize::Time).then_some("minimize"),
        ];
        if let (Some(other), Some(format)) = (of_resin.into_iter().flatten().next(), self.format) {
            let option = format.name();
            return Err(OptionsError::Contradictory { option, other });
        }
        let [least_mm, most_mm] = NOZZLES_MM;
        if !(least_mm..=most_mm).contains(&nozzle_mm) {
            return Err(OptionsError::BadNozzle {
                nozzle_mm,
                least_mm,
                most_mm,
            });
        }
        let layers = slicer.layers(nozzle_mm);
        for [layer_min_mm, layer_max_mm] in self.thicknesses_mm() {
            if layer_min_mm < layers.least_mm || layer_max_mm > layers.most_mm {
                return Err(OptionsError::NozzleLayers {
                    slicers: slicer.names().to_vec(),
                    nozzle_mm,
                    nozzle_min_mm: layers.least_mm,
                    nozzle_max_mm: layers.most_mm,
                    layer_min_mm,
                    layer_max_mm,
                });
            }
        }
        Ok(Some(Filament {
            slicer,
            nozzle_mm,
            first_layer_mm,
        }))
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
                    model: printer.model.clone(),
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
                    model: printer.model.clone(),
                    printer_step_mm: printer.step_mm,
                    step_mm,
                })
            }
            _ => Ok(()),
        }
    }

    /// Minimum and maximum thickness wherever the options give them: of uniform layers or of all layers, of each height range,
    /// and of the first layer.
    fn thicknesses_mm(&self) -> Vec<[f64; 2]> {
        let first_mm = self.first_layer_mm.map(|layer_mm| [layer_mm; 2]);
        if let Planner::Uniform { layer_mm } = self.planner {
            return std::iter::once([layer_mm; 2]).chain(first_mm).collect();
        }
        let ranges = self.ranges.iter();
        let ranges = ranges.map(|range| [range.layer_min_mm, range.layer_max_mm]);
        let all = std::iter::once(self.range_mm());
        let given = self.thicknesses_mm.iter().map(|&layer_mm| [layer_mm; 2]);
        let below_mm = self.support_layer_mm.map(|layer_mm| [layer_mm; 2]);
        all.chain(given)
            .chain(ranges)
            .chain(first_mm)
            .chain(below_mm)
            .collect()
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
                let all = self.range_mm();
                let mut thicknesses = self.thicknesses_mm().into_iter().flatten().chain(all);
                let is_whole = thicknesses.all(|thickness_mm| is_multiple(thickness_mm, BIN_MM));
                if is_whole { BIN_MM } else { BIN_MM / 2.0 }
            }
        }
    }
}

/// The printer that is chosen, checked.
///
/// # Errors
/// [`OptionsError::UnknownPrinter`], [`OptionsError::BadPrinter`].
pub(crate) fn find_printer(
    choice: Option<&PrinterChoice>,
) -> Result<Option<Arc<Printer>>, OptionsError> {
    let printer = match choice {
        None => return Ok(None),
        Some(PrinterChoice::Own(printer)) => Arc::clone(printer),
        Some(PrinterChoice::Named(name)) => {
            printer::named(name).ok_or_else(|| OptionsError::UnknownPrinter {
                printer: name.clone(),
                similar: printer::similar(name),
                known: PRINTERS.len(),
            })?
        }
    };
    let checked = printer.check();
    checked.map_err(|field| OptionsError::BadPrinter {
        printer: printer.name.clone(),
        field,
    })?;
    Ok(Some(printer))
}

/// The default height of a bin in millimetres. It divides most layer thicknesses in use.
pub const BIN_MM: f64 = 0.002;

/// A quotient this close to a whole number counts as whole.
const ROUNDING: f64 = 1e-6;

fn is_multiple(length_mm: f64, of_mm: f64) -> bool {
    let quotient = length_mm / of_mm;
    quotient.round() >= 1.0 && (quotient - quotient.round()).abs() <= ROUNDING
}

/// Checks the lengths of voids and supports.
///
/// # Errors
/// [`OptionsError::BadLength`].
pub(super) fn check_prepared(
    hollow: Option<&Hollowing>,
    supports: Option<&Supporting>,
) -> Result<(), OptionsError> {
    let checks = [
        hollow.map(Hollowing::check),
        supports.map(Supporting::check),
    ];
    let bad = checks.into_iter().flatten().find_map(Result::err);
    bad.map_or(
        Ok(()),
        |BadLength {
             option,
             value_mm,
             least_mm,
             most_mm,
         }| {
            Err(OptionsError::BadLength {
                option,
                value_mm,
                least_mm,
                most_mm,
            })
        },
    )
}
