//! The search for the best orientation (section 4.3): what [`Search`] asks for is measured here.

use serde::Serialize;

use super::planned::{Planning, shapes_of};
use super::resolve::Job;
use super::slicer::Slicer;
use super::stage::{Stage, StageProgress};
use super::{Error, Options, SCHEMA};
use crate::grid::{Bins, GridError};
use crate::ldi::LdiError;
#[cfg(not(target_arch = "wasm32"))]
use crate::model::weights;
use crate::model::{Bounds, Mesh, ModelFile, Pose};
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::{self, Shard};
use crate::orientation::{
    Candidate, Exclusion, Metrics, Placement, Scale, Search, SearchOptions, SearchResult, Surface,
    Task, TaskResult,
};
use crate::parallel;
use crate::profile::section;
use crate::progress::report;

/// Tasks that a thread has at once: more than one, so that few threads wait for the last of them.
const TASKS: usize = 2;

/// What a search has found, with what it was about.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrientationReport {
    /// The version of this object: [`SCHEMA`].
    pub schema: u32,
    /// The file that the model was read from.
    pub model: ModelFile,
    /// What was searched for.
    pub search: SearchOptions,
    /// What energies are relative to.
    pub scale: Scale,
    /// The model as it stands now.
    pub now: Candidate,
    /// The best direction and up to two others that are good in another way, the best first.
    pub best: Vec<Candidate>,
    /// All directions of the first look.
    pub candidates: Vec<Candidate>,
}

/// The part of a search that one machine measured.
#[cfg(not(target_arch = "wasm32"))]
pub type OrientationPart = shard::Part<Options>;

/// What measuring a direction needs.
struct Evaluator<'a> {
    model: &'a Mesh,
    surface: &'a Surface,
    job: Job,
    /// Of facets as the surface has them.
    weights: Option<Vec<f32>>,
}

impl Slicer {
    /// Searches for the best direction to print the model in. Where the model stands now matters only if the options give
    /// a height, which is then the one as it stands now. Makes no plan, and leaves the last one.
    ///
    /// Directions that the model does not fit the printer in, or that have no plan within tolerance, are excluded; there may be
    /// no best one.
    ///
    /// # Errors
    /// [`Error::Search`], [`Error::Options`], [`Error::Mesh`], [`Error::Plan`] for options that no direction makes good;
    /// [`Error::Ldi`] if `progress` cancels.
    pub fn orient(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationReport, Error> {
        let search = self.search(options, search)?;
        self.finish_search(options, search, progress)
    }

    /// A search that has yet to be run, by [`Self::finish_search`] or task by task.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn search(&mut self, options: &Options, search: &SearchOptions) -> Result<Search, Error> {
        let directions = self.directions_of(options, search)?;
        Ok(Search::new(*search, directions)?)
    }

    /// Runs all tasks that are left of a search for the same model and options, on all threads.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn finish_search(
        &mut self,
        options: &Options,
        mut search: Search,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationReport, Error> {
        let evaluator = self.evaluator(options, progress)?;
        let mut now = evaluator.measure(evaluator.job.sampling.pose.up()?);
        let SearchResult {
            best,
            scale,
            candidates,
        } = evaluator.run(&mut search, progress)?;
        let options = *search.options();
        now.energy = options.energy(&now, &scale);
        Ok(OrientationReport {
            schema: SCHEMA,
            model: self.file.clone(),
            search: options,
            scale,
            now,
            best,
            candidates,
        })
    }

    /// The directions of a search: `count` unit vectors spread evenly, the axes, and those of the model's largest flats.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn directions(&mut self, options: &Options, count: usize) -> Result<Vec<[f64; 3]>, Error> {
        Ok(self.surface(&options.resolve()?)?.directions(count))
    }

    fn directions_of(
        &mut self,
        options: &Options,
        search: &SearchOptions,
    ) -> Result<Vec<[f64; 3]>, Error> {
        // Before there are more directions than memory.
        search.check()?;
        self.directions(options, search.directions)
    }

    /// Runs a task of a search.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn evaluate(&mut self, options: &Options, task: Task) -> Result<TaskResult, Error> {
        let mut silent = |_, _| std::ops::ControlFlow::Continue(());
        Ok(self.evaluator(options, &mut silent)?.evaluate(task))
    }

    /// Measures the directions of a shard of a search.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn measure_shard(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        shard: Shard,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationPart, Error> {
        let directions = self.directions_of(options, search)?;
        let total = directions.len();
        let mut search = Search::of_shard(*search, directions, shard)?;
        let evaluator = self.evaluator(options, progress)?;
        let mut candidates = evaluator.run(&mut search, progress)?.candidates;
        for candidate in &mut candidates {
            // Energies are relative to all directions.
            candidate.energy = None;
        }
        Ok(OrientationPart {
            places: shard.places(total).collect(),
            candidates,
            ..self.part(options, shard, total)
        })
    }

    /// The search whose directions were measured in shards. Parts of other models are left aside.
    ///
    /// # Errors
    /// [`Error::Merge`], and those of [`Self::orient`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn merge_shards(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        parts: &[OrientationPart],
    ) -> Result<Search, Error> {
        let directions = self.directions_of(options, search)?;
        // A model that no shard could measure has the same fault here, rather than no part.
        self.check_for_all_directions(&options.resolve()?)?;
        let none = Shard {
            number: 0,
            count: 0,
        };
        let whole = self.part(options, none, directions.len());
        let candidates = shard::merge(parts, &whole, &directions)?;
        Ok(Search::of_measured(*search, candidates)?)
    }

    /// A part with nothing in it.
    #[cfg(not(target_arch = "wasm32"))]
    fn part(&self, options: &Options, shard: Shard, directions: usize) -> OrientationPart {
        OrientationPart {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model: self.file.clone(),
            options: options.without_backend(),
            weights_crc32: self.painted.as_deref().map(weights::crc_of),
            shard,
            directions,
            places: Vec::new(),
            candidates: Vec::new(),
        }
    }

    fn surface(&mut self, job: &Job) -> Result<&Surface, Error> {
        // How the model stands matters only to a height.
        let pose = job.sampling.pose;
        let scaled = pose.height_mm.map(|_| pose);
        let surface = match self.surface.take().filter(|kept| kept.0 == scaled) {
            Some(kept) => kept,
            None => (scaled, Surface::new(&self.model, self.scale(scaled)?)),
        };
        Ok(&self.surface.insert(surface).1)
    }

    /// By how much the model is scaled to have its height in a pose.
    fn scale(&self, scaled: Option<Pose>) -> Result<f64, Error> {
        let Some((pose, height_mm)) = scaled.and_then(|pose| Some((pose, pose.height_mm?))) else {
            return Ok(1.0);
        };
        // Whether the height is one is for `on_plate` to say.
        self.model.on_plate(&pose)?;
        let unscaled = Pose {
            height_mm: None,
            ..pose
        };
        let size = self.model.on_plate(&unscaled)?.bounds().size();
        Ok(height_mm / size.z)
    }

    /// Finds what is wrong in every direction, which is an error, and not a reason to exclude one.
    fn check_for_all_directions(&self, job: &Job) -> Result<(), Error> {
        match job.sampling.grid(&self.model.bounds()) {
            Err(error) if exclusion(&error).is_none() => Err(error.into()),
            _ => Ok(()),
        }
    }

    fn evaluator<'a>(
        &'a mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Evaluator<'a>, Error> {
        let job = options.resolve()?;
        self.check_for_all_directions(&job)?;
        self.surface(&job)?;
        let weights = self.layering_weights(&job.layering, progress)?;
        let surface = &self.surface.as_ref().ok_or(Error::NoPlan)?.1;
        #[cfg(not(target_arch = "wasm32"))]
        parallel::keep_memory();
        Ok(Evaluator {
            model: &self.model,
            surface,
            job,
            weights: weights.map(|weights| surface.arranged(&weights)),
        })
    }
}

impl Evaluator<'_> {
    /// Runs all tasks of a search.
    fn run(
        &self,
        search: &mut Search,
        progress: &mut StageProgress<'_>,
    ) -> Result<SearchResult, Error> {
        let mut progress = |fraction| progress(Stage::Orientation, fraction);
        loop {
            if let Some(result) = search.result() {
                return Ok(result);
            }
            let tasks = search.next_tasks(TASKS * parallel::threads());
            for result in parallel::map(tasks, |task| self.evaluate(task)) {
                search.accept(result)?;
            }
            report(&mut progress, search.progress()).map_err(LdiError::from)?;
        }
    }

    /// Runs a task.
    fn evaluate(&self, task: Task) -> TaskResult {
        TaskResult {
            number: task.number,
            candidates: parallel::map(task.directions, |direction| self.measure(direction)),
        }
    }

    fn measure(&self, direction: [f64; 3]) -> Candidate {
        let fits = |bounds: &Bounds| match self.job.sampling.grid(bounds) {
            Err(error) => exclusion(&error).map_or(Ok(()), Err),
            Ok(_) => Ok(()),
        };
        let (placement, mut excluded) = self.surface.place(direction, fits);
        let mut metrics = None;
        if excluded.is_none() {
            metrics = self.metrics(&placement);
            excluded = metrics.is_none().then_some(Exclusion::NoPlan);
        }
        Candidate {
            direction,
            rotation: placement.rotation,
            size_mm: placement.size_mm,
            excluded,
            metrics,
            energy: None,
        }
    }

    /// `None` if there is no plan.
    fn metrics(&self, placement: &Placement) -> Option<Metrics> {
        let layering = &self.job.layering;
        let height_mm = placement.size_mm[2];
        let bins = Bins::of_height(height_mm, layering.bin_mm).ok()?;
        let facet_bins = self.surface.facet_bins(placement, bins);
        let areas_mm2 = || {
            let pose = Pose {
                rotation: Some(placement.rotation),
                height_mm: Some(height_mm),
            };
            let mesh = self.model.on_plate(&pose)?;
            Ok::<_, Error>(section::exact(&mesh, &[], bins))
        };
        let shapes = shapes_of(&facet_bins, areas_mm2, layering, self.weights.clone()).ok()?;
        let planning = Planning::new(height_mm, &shapes, layering);
        let plan = planning.plan().ok()?;
        let max_error = planning.max_error(&plan);
        let print_time_s = plan.print_time_s(&layering.resin);
        Some(
            self.surface
                .metrics(placement, &facet_bins, &plan, max_error, print_time_s),
        )
    }
}

/// Why a model cannot be printed as it stands, if that is what an error says.
fn exclusion(error: &GridError) -> Option<Exclusion> {
    match error {
        GridError::ModelTooLarge { .. } | GridError::BadSize { .. } => Some(Exclusion::TooLarge),
        GridError::ModelTooHigh { .. } => Some(Exclusion::TooHigh),
        _ => None,
    }
}
