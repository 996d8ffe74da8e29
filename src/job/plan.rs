//! The plan of a job: where copies stand, and the layers of each plate.

use std::sync::Arc;

use web_time::Instant;

use super::places::{Layout, placement, screen_of};
use super::plates::Plate;
use super::report::{Origin, SCHEMA, report_of};
use super::resolve::check_prepared;
use super::stages::measured::Shape;
use super::stages::parts::{Layering, Resolved, Target};
use super::stages::planned::{Planned, PlannedModel};
use super::stages::stage::{Stage, StageProgress, ms_since, report as tell};
#[cfg(not(target_arch = "wasm32"))]
use super::stages::work;
use super::{Error, Job, JobOptions, JobReport, Options, OptionsError, Placement, Report, Timings};
use crate::arrange::Place;
use crate::plan::HeightRange;

impl Job {
    /// Arranges the copies, unless placements are given or there is only one, which stands in the middle, and plans the layers of each
    /// plate. The error of a layer is the largest over the models that it reaches. After an error there is no plan;
    /// samples are kept.
    ///
    /// # Errors
    /// Any [`Error`] of these stages; [`Error::Arrange`].
    pub async fn plan(
        &mut self,
        options: &JobOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<JobReport, Error> {
        self.plan_as(options, self.is_alone(options), progress)
            .await?;
        Ok(self.report())
    }

    /// Returns true if a single copy of a single model stands in the middle: all options are its own.
    pub(super) fn is_alone(&self, options: &JobOptions) -> bool {
        self.models.len() == 1
            && options.of_model(0).copies == 1
            && matches!(&options.placements[..], [] | [Placement::MIDDLE])
    }

    /// [`Self::plan`] of a model alone, or of copies on plates.
    pub(super) async fn plan_as(
        &mut self,
        options: &JobOptions,
        is_alone: bool,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let mut last = std::mem::take(&mut self.plates);
        let mut timings = Timings::default();
        let layout = self.layout(options, is_alone, &mut timings, progress)?;
        // Old rays are freed before new ones are sampled.
        last.retain(|plate| self.is_wanted(options, &layout, &plate.planned));
        self.measure(options, &layout, &mut timings, progress)
            .await?;

        tell(progress, Stage::Plan, 0.0)?;
        let plates = layout.plates();
        let count = plates.len();
        for (number, on_plate) in plates.enumerate() {
            let clock = Instant::now();
            let (models, offsets) = self.standing(options, &layout, on_plate);
            let layering = layering_of(options, &layout, &models);
            let upright = models.chunk_by(|a, b| a.model == b.model);
            let upright = upright.map(|of| (of[0].model, Arc::clone(&self.prepared[of[0].model])));
            let upright = upright.collect();
            let known = last.iter_mut().chain(&mut self.plates);
            let kept = known
                .map(|it| (&it.planned, &it.offsets, &mut it.seen, it.is_held))
                .find(|(planned, ..)| planned.is_of(&models, &layering));
            let (planned, seen, is_held) = if let Some((planned, of, seen, is_held)) = kept {
                let seen = if *of == offsets { seen.take() } else { None };
                (Arc::clone(planned), seen, is_held)
            } else {
                #[cfg(not(target_arch = "wasm32"))]
                if let Some(allowed_s) = self.sampler.cpu_time_s() {
                    let bins = models[0].measured.shapes.bins();
                    work::check_plan(bins, &layering, allowed_s)?;
                }
                let mut within =
                    |fraction| progress(Stage::Plan, (number as f64 + fraction) / count as f64);
                let planned = Planned::new(models, &layering, &mut within);
                let planned = planned.map_err(|error| layout.shared.typeable(error))?;
                timings.plan += ms_since(clock);
                (Arc::new(planned), None, false)
            };
            timings.sum_up();
            let number = [number, count];
            let report = self.report_of_plate(options, &layout, number, &planned, &timings);
            self.plates.push(Plate {
                offsets,
                upright,
                planned,
                output: layout.resolved.output.clone(),
                report,
                seen,
                is_held,
            });
        }
        tell(progress, Stage::Plan, 1.0)?;
        for model in &mut self.models {
            model.load_ms = 0.0;
        }
        Ok(())
    }

    /// Resolves the options, and finds where copies stand.
    pub(super) fn layout(
        &mut self,
        options: &JobOptions,
        is_alone: bool,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Layout, Error> {
        options.check()?;
        let shared = if is_alone {
            options.alone()
        } else {
            options.options.clone()
        };
        let resolved = shared.resolve()?;
        check_own(options, &resolved)?;
        check_own_prepared(options, &resolved, self.models.len())?;
        timings.load += self.models.iter().map(|model| model.load_ms).sum::<f64>();
        if is_alone {
            self.prepare(options, &resolved, false, timings, progress)?;
            return Ok(Layout {
                resolved,
                shared,
                is_alone,
                screen: None,
                places: vec![Place {
                    item: 0,
                    copy: 0,
                    turns: 0,
                    offset: [0, 0],
                    plate: 0,
                }],
            });
        }
        if resolved.output.filament.is_some() {
            // Their slicers place copies themselves.
            return Err(OptionsError::Contradictory {
                option: resolved.output.format.name(),
                other: "models",
            }
            .into());
        }
        let screen = screen_of(&resolved.sampling)?;
        self.prepare(options, &resolved, options.may_turn(), timings, progress)?;
        let clock = Instant::now();
        let places = if options.placements.is_empty() {
            self.arranged(options, &resolved, &screen)?
        } else {
            let places = self.places(&screen, &options.placements)?;
            let problems = self.problems_of(options, &resolved, &screen, &places)?;
            if let Some(problem) = problems.into_iter().next() {
                return Err(problem.into());
            }
            places
        };
        timings.load += ms_since(clock);
        Ok(Layout {
            resolved,
            shared,
            is_alone,
            screen: Some(screen),
            places,
        })
    }

    /// The report of a plan of the plate `plate` of `plate_count`.
    fn report_of_plate(
        &self,
        options: &JobOptions,
        layout: &Layout,
        [plate, plate_count]: [usize; 2],
        planned: &Planned,
        timings: &Timings,
    ) -> Report {
        let on_plate = layout.plates().nth(plate).unwrap_or_default();
        let first = &self.models[planned.models[0].model];
        let states_unit = layout.is_alone && first.facts.unit.is_some();
        let origin = Origin {
            options: Options {
                unit: layout.shared.unit.filter(|_| !states_unit),
                ..layout.shared.as_reported()
            },
            plate,
            plate_count,
            models: self.shares(options, layout, planned),
            placements: on_plate
                .iter()
                .map(|place| placement(layout.screen.as_ref(), place))
                .collect(),
        };
        let output = &layout.resolved.output;
        report_of(planned, output, origin, timings.clone())
    }

    /// The report of the last plan.
    pub(super) fn report(&self) -> JobReport {
        let reports = self.plates.iter().map(|plate| &plate.report);
        JobReport {
            schema: SCHEMA,
            print_time_s: reports.clone().map(|report| report.print_time_s).sum(),
            resin_ml: reports.clone().map(|report| report.resin_ml).sum(),
            plates: reports.cloned().collect(),
        }
    }

    /// The models of a plate as its plan takes them, and the places of their copies.
    pub(super) fn standing(
        &self,
        options: &JobOptions,
        layout: &Layout,
        on_plate: &[Place],
    ) -> (Vec<PlannedModel>, Vec<Vec<[i32; 2]>>) {
        let of = |shape: &Shape| {
            let measured = shape.measured.as_ref()?;
            let copies = on_plate
                .iter()
                .filter(|place| place.item == shape.model && place.turns == shape.turns);
            let offsets: Vec<_> = copies.map(|place| place.offset).collect();
            let own = options.of_model(shape.model).tolerance;
            let model = PlannedModel {
                measured: Arc::clone(measured),
                model: shape.model,
                turns: shape.turns,
                tolerance: own.filter(|_| !layout.is_alone),
                copies: offsets.len(),
            };
            (!offsets.is_empty()).then_some((model, offsets))
        };
        self.shapes.iter().filter_map(of).unzip()
    }
}

/// Refuses tolerances of models' own where the plan has none to compare them with.
fn check_own(options: &JobOptions, resolved: &Resolved) -> Result<(), OptionsError> {
    let has_own = options.models.iter().any(|model| model.tolerance.is_some());
    if has_own && !matches!(resolved.layering.target, Target::Tolerance(_)) {
        let Options {
            max_layers,
            max_time_s,
            ..
        } = options.options;
        let other = match (max_layers, max_time_s) {
            (Some(_), _) => "max_layers",
            (_, Some(_)) => "max_time_s",
            _ => "metric",
        };
        return Err(OptionsError::Contradictory {
            option: "tolerance",
            other,
        });
    }
    Ok(())
}

/// Checks the voids and supports that models have of their own. Holes and contacts placed by hand for all models are
/// refused if there are several, each of which has a frame of its own.
fn check_own_prepared(
    options: &JobOptions,
    resolved: &Resolved,
    models: usize,
) -> Result<(), OptionsError> {
    for own in &options.models {
        check_prepared(own.hollow.as_ref(), own.supports.as_ref())?;
    }
    let hollow = resolved.sampling.hollow.as_ref();
    let option = match &resolved.sampling.supports {
        _ if models == 1 => return Ok(()),
        Some(supports) if supports.points.is_some() => "points",
        _ if hollow.is_some_and(|hollow| !hollow.drains.is_empty()) => "drains",
        _ => return Ok(()),
    };
    Err(OptionsError::Contradictory {
        option,
        other: "models",
    })
}

/// The layering of a plate: that of the options, with the height ranges of the models on it and of the supports below them all.
pub(super) fn layering_of(
    options: &JobOptions,
    layout: &Layout,
    models: &[PlannedModel],
) -> Layering {
    let mut layering = layout.resolved.layering.clone();
    let limits = &mut layering.limits;
    let mut ranges = limits.ranges.clone();
    for model in models.iter().filter(|_| !layout.is_alone) {
        let height_mm = model.sampled().height_mm;
        let own = options.of_model(model.model).ranges;
        // A model has no say above its top.
        let own = own.into_iter().filter(|range| range.from_mm < height_mm);
        ranges.extend(own.map(|range| HeightRange {
            to_mm: range.to_mm.min(height_mm),
            ..range
        }));
    }
    if let Some(layer_max_mm) = options.options.support_layer_mm {
        let lowest_mm = models.iter().map(|it| it.sampled().prepared.lift_mm());
        let to_mm = lowest_mm.fold(f64::INFINITY, f64::min);
        // Lower than a layer, it is left to the model's layers.
        if to_mm >= layer_max_mm {
            ranges.push(HeightRange {
                from_mm: 0.0,
                to_mm,
                layer_min_mm: limits.layer_min_mm,
                layer_max_mm,
            });
        }
    }
    if ranges.len() > limits.ranges.len() {
        limits.ranges = HeightRange::joined(&ranges);
    }
    layering
}
