//! Several models in one job: each is sampled and measured alone, all that stand on a plate share its plan.

mod claimed;
mod inspect;
mod options;
mod outputs;
mod places;
mod report;
mod shapes;

use std::sync::Arc;

use web_time::Instant;

pub(super) use claimed::ClaimedPlate;
pub use inspect::{ModelPrintability, PlatePrintability};
pub use options::{ModelOptions, Placement, PlateOptions};
pub use report::{PlateModelReport, PlateReport, PlatesReport};

use super::memory::Memory;
use super::parts::{Job, Layering, Target};
use super::planned::{Planned, PlannedModel};
use super::prepared::Prepared;
use super::report::{Origin, SCHEMA, report_of};
use super::sampled::Sampler;
use super::slicer::positions_of;
use super::stage::{Stage, StageProgress, ms_since, report as tell};
#[cfg(not(target_arch = "wasm32"))]
use super::work;
use super::{Error, Options, OptionsError, Slicer, Timings};
use crate::arrange::{ArrangeError, Place};
use crate::ldi::gpu::Gpu;
use crate::model::FacetClass;
use crate::plan::HeightRange;
use outputs::Current;
use places::screen_of;
use shapes::Shape;

/// Models that are printed together. A change of options repeats only the stages that depend on it.
#[derive(Debug, Default)]
pub struct Plate {
    models: Vec<Slicer>,
    sampler: Sampler,
    /// What may be taken, if that is bounded.
    memory: Option<Memory>,
    /// The models with their supports, if they have some: before turns, in the order of models.
    prepared: Vec<Arc<Prepared>>,
    shapes: Vec<Shape>,
    plates: Vec<Current>,
}

impl Plate {
    /// A plate of these models.
    pub fn new(models: Vec<Slicer>) -> Self {
        Self {
            models,
            ..Self::default()
        }
    }

    /// Samples on `gpu` from now on, unless the options ask for the CPU.
    #[must_use]
    pub fn with_gpu(mut self, gpu: Gpu) -> Self {
        self.sampler.set_gpu(gpu);
        self
    }

    /// Takes no more than about this many bytes from now on: see [`Slicer::with_memory`]. Models share them equally.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_memory(mut self, bytes: u64) -> Self {
        self.memory = Some(Memory::of(bytes));
        self
    }

    /// Plans nothing from now on that is certain to take more processor time than this for a plate: see [`Slicer::with_cpu_time`].
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_cpu_time(mut self, seconds: f64) -> Self {
        self.sampler.set_cpu_time(seconds);
        let models = std::mem::take(&mut self.models).into_iter();
        self.models = models.map(|it| it.with_cpu_time(seconds)).collect();
        self
    }

    /// Searches in advance for a GPU: see [`Slicer::open_gpu`].
    pub async fn open_gpu(&mut self) {
        self.sampler.open_gpu().await;
    }

    /// The models, in the order of their indices.
    pub fn models(&self) -> &[Slicer] {
        &self.models
    }

    /// A model by its index.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn model(&self, model: usize) -> Result<&Slicer, Error> {
        self.check_model(model)?;
        Ok(&self.models[model])
    }

    /// The same, to set its weights.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn model_mut(&mut self, model: usize) -> Result<&mut Slicer, Error> {
        self.check_model(model)?;
        Ok(&mut self.models[model])
    }

    /// Vertex positions of a model's supports in the last plan, nine numbers per facet, in millimetres, as
    /// [`Slicer::positions_of`]: for the copy that is not turned, around x = y = 0. None without supports.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn supports(&self, model: usize) -> Result<Vec<f32>, Error> {
        self.check_model(model)?;
        let prepared = self.prepared.get(model);
        Ok(prepared.map_or_else(Vec::new, |it| positions_of(&it.mesh, FacetClass::Support)))
    }

    /// Adds a model and returns its index.
    pub fn add(&mut self, model: Slicer) -> usize {
        self.models.push(model);
        self.models.len() - 1
    }

    /// Removes a model. Those after it move up.
    ///
    /// # Errors
    /// [`Error::Arrange`].
    pub fn remove(&mut self, model: usize) -> Result<Slicer, Error> {
        self.check_model(model)?;
        self.plates.clear();
        if model < self.prepared.len() {
            self.prepared.remove(model);
        }
        self.shapes.retain(|shape| shape.model != model);
        for shape in &mut self.shapes {
            shape.model -= usize::from(shape.model > model);
        }
        Ok(self.models.remove(model))
    }

    fn check_model(&self, model: usize) -> Result<(), ArrangeError> {
        let models = self.models.len();
        if model < models {
            Ok(())
        } else {
            Err(ArrangeError::NoModel {
                model_number: model + 1,
                models,
            })
        }
    }

    /// Arranges the copies, unless placements are given, and plans the layers of each plate. The error of a layer is the largest over
    /// the models that it reaches. After an error there is no plan; what was sampled is kept.
    ///
    /// # Errors
    /// Any [`Error`] of these stages; [`Error::Arrange`].
    pub async fn plan(
        &mut self,
        options: &PlateOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<PlatesReport, Error> {
        let last = std::mem::take(&mut self.plates);
        options.check()?;
        let is_alone = self.models.len() == 1
            && options.of_model(0).copies == 1
            && options.placements.is_empty();
        let alone = is_alone.then(|| options.alone());
        let shared = alone.as_ref().unwrap_or(&options.options);
        let job = shared.resolve()?;
        check_own(options, &job)?;
        check_prepared(&job, is_alone)?;
        let mut timings = Timings::default();
        let clock = Instant::now();
        let screen = screen_of(&job.sampling)?;
        timings.load = ms_since(clock);
        self.prepare(options, &job, &mut timings, progress)?;
        let clock = Instant::now();
        let extents = self.extents(options, &job, &screen)?;
        let places = if options.placements.is_empty() {
            self.arranged(options, &job, &screen, &extents)?
        } else {
            let places = self.places(&screen, &options.placements)?;
            let problems = self.problems_of(options, &job, &screen, &places)?;
            if let Some(problem) = problems.into_iter().next() {
                return Err(problem.into());
            }
            places
        };
        timings.load += ms_since(clock);
        self.measure(options, &job, &places, &mut timings, progress)
            .await?;

        tell(progress, Stage::Plan, 0.0)?;
        let plates: Vec<&[Place]> = places.chunk_by(|a, b| a.plate == b.plate).collect();
        for (number, on_plate) in plates.iter().enumerate() {
            let clock = Instant::now();
            let standing = self.standing(on_plate);
            let known = last.iter().chain(&self.plates);
            let models = models_of(options, &standing, is_alone);
            let layering = layering_of(options, &job, &standing, is_alone);
            let kept = known
                .map(|it| &it.planned)
                .find(|it| it.is_of(&models, &layering));
            let planned = if let Some(kept) = kept {
                Arc::clone(kept)
            } else {
                #[cfg(not(target_arch = "wasm32"))]
                if let Some(allowed_s) = self.sampler.cpu_time_s() {
                    let bins = standing[0].0.measured.shapes.bins();
                    work::check_plan(bins, &layering, allowed_s)?;
                }
                let mut within = |fraction| {
                    progress(
                        Stage::Plan,
                        (number as f64 + fraction) / plates.len() as f64,
                    )
                };
                let planned = Planned::new(models, &layering, &mut within);
                Arc::new(planned.map_err(|error| shared.typeable(error))?)
            };
            timings.plan += ms_since(clock);
            timings.sum_up();
            let first = &self.models[standing[0].0.model];
            let origin = Origin {
                file: &first.facts.file,
                options: shared,
                painted: first.painted.as_deref(),
                states_unit: is_alone && first.facts.unit.is_some(),
                warnings: standing
                    .iter()
                    .flat_map(|(shape, _)| self.models[shape.model].file_warnings(shared))
                    .collect(),
            };
            let mut report = report_of(&planned, &job.output, origin, timings.clone());
            if !is_alone {
                let plate = self.plate_report(options, &screen, &extents, on_plate, &planned);
                report.plate = Some(PlateReport {
                    plate: number,
                    plates: plates.len(),
                    ..plate
                });
            }
            let offsets = standing.iter().map(|(_, copies)| copies.clone());
            let current = Current {
                offsets: offsets.collect(),
                planned,
                job: job.clone(),
                report,
                seen: None,
            };
            self.plates.push(current);
        }
        tell(progress, Stage::Plan, 1.0)?;
        Ok(self.report())
    }

    /// What is planned.
    fn report(&self) -> PlatesReport {
        let reports = self.plates.iter().map(|plate| &plate.report);
        PlatesReport {
            schema: SCHEMA,
            print_time_s: reports.clone().map(|report| report.print_time_s).sum(),
            resin_ml: reports.clone().map(|report| report.resin_ml).sum(),
            plates: reports.cloned().collect(),
        }
    }
}

/// Refuses tolerances of models' own where the plan has none to compare them with.
fn check_own(options: &PlateOptions, job: &Job) -> Result<(), OptionsError> {
    let has_own = options.models.iter().any(|model| model.tolerance.is_some());
    if has_own && !matches!(job.layering.target, Target::Tolerance(_)) {
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

/// Refuses what is placed by hand where there are several models or copies, each of which has a frame of its own.
fn check_prepared(job: &Job, is_alone: bool) -> Result<(), OptionsError> {
    let hollow = job.sampling.hollow.as_ref();
    let option = match &job.sampling.supports {
        _ if is_alone => return Ok(()),
        Some(supports) if supports.points.is_some() => "points",
        _ if hollow.is_some_and(|hollow| !hollow.drains.is_empty()) => "drains",
        _ => return Ok(()),
    };
    Err(OptionsError::Contradictory {
        option,
        other: "models",
    })
}

/// The models of a plate as its plan takes them.
fn models_of(
    options: &PlateOptions,
    standing: &[(Shape, Vec<[i32; 2]>)],
    is_alone: bool,
) -> Vec<PlannedModel> {
    let own = |model| options.of_model(model).tolerance.filter(|_| !is_alone);
    let planned = standing.iter().map(|(shape, copies)| PlannedModel {
        measured: Arc::clone(&shape.measured),
        model: shape.model,
        turns: shape.turns,
        tolerance: own(shape.model),
        copies: copies.len(),
    });
    planned.collect()
}

/// The layering of a plate: that of the options, with the height ranges of the models on it.
fn layering_of(
    options: &PlateOptions,
    job: &Job,
    standing: &[(Shape, Vec<[i32; 2]>)],
    is_alone: bool,
) -> Layering {
    let mut layering = job.layering.clone();
    if is_alone {
        return layering;
    }
    let mut ranges = layering.limits.ranges.clone();
    for (shape, _) in standing {
        let height_mm = shape.measured.of.height_mm;
        let own = options.of_model(shape.model).ranges;
        // A model has no say above its top.
        let own = own.into_iter().filter(|range| range.from_mm < height_mm);
        ranges.extend(own.map(|range| HeightRange {
            to_mm: range.to_mm.min(height_mm),
            ..range
        }));
    }
    if ranges.len() > layering.limits.ranges.len() {
        layering.limits.ranges = HeightRange::joined(&ranges);
    }
    layering
}
