//! Runs the orientation search (section 4.3): measures the directions that [`Search`] hands out.

use serde::Serialize;

use super::stages::facet_shapes::{Extra, shapes_of};
use super::stages::parts::Resolved;
use super::stages::planning::Planning;
use super::stages::stage::{Stage, StageProgress};
use super::{Error, LoadedModel, Options, SCHEMA};
use crate::grid::{Bins, GridError};
use crate::ldi::LdiError;
#[cfg(not(target_arch = "wasm32"))]
use crate::model::weights;
use crate::model::{Bounds, Mesh, ModelFile, Pose};
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::{self, Shard};
use crate::orientation::{
    Candidate, Exclusion, Metrics, Placement, Search, SearchOptions, SearchResult, Surface, Task,
    TaskResult, Terms,
};
use crate::parallel;
use crate::prepare::{SupportProfile, Supporting};
use crate::progress::report;

/// Tasks per thread and round: more than one, so that few threads are idle at the end of a round.
const TASKS: usize = 2;

/// The result of an orientation search, with the model and the search options.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct OrientationReport {
    /// The version of this object: [`SCHEMA`].
    pub schema: u32,
    /// The file that the model was read from.
    pub model: ModelFile,
    /// The options of the search.
    pub search: SearchOptions,
    /// Reference values of energies.
    pub scale: Terms,
    /// The candidate for the current orientation.
    pub now: Candidate,
    /// Up to three candidates, best first and at least 20° apart.
    pub best: Vec<Candidate>,
    /// The candidates of the first pass, one per direction.
    pub candidates: Vec<Candidate>,
}

/// The part of a search that one machine measured.
#[cfg(not(target_arch = "wasm32"))]
pub type OrientationPart = shard::Part<Options>;

/// Everything that measuring a direction needs.
struct Evaluator<'a> {
    model: &'a Mesh,
    surface: &'a Surface,
    resolved: Resolved,
    /// Weights of facets, in the order of `surface`.
    weights: Option<Vec<f32>>,
}

impl LoadedModel {
    /// Searches for the best orientation of the model. The rotation in the options is the current orientation. The search
    /// does not depend on it, unless the options give a height: the model is then scaled to have that height in the current
    /// orientation. The last plan is kept.
    ///
    /// Directions in which the model does not fit the printer, or no plan keeps the tolerance, are excluded. If all are,
    /// there is no best candidate.
    ///
    /// # Errors
    /// [`Error::Search`], [`Error::Options`], [`Error::Mesh`], [`Error::Grid`] or [`Error::Plan`] if the options are invalid
    /// in every direction; [`Error::Ldi`] if `progress` cancels.
    pub fn orient(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationReport, Error> {
        let search = self.search(options, search)?;
        self.finish_search(options, search, progress)
    }

    /// Creates a search, to be run by [`Self::finish_search`] or task by task.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn search(&mut self, options: &Options, search: &SearchOptions) -> Result<Search, Error> {
        let directions = self.directions_of(options, search)?;
        Ok(Search::new(*search, directions)?)
    }

    /// Runs the remaining tasks of a search on all threads. The search must be for this model and these options.
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
        let mut now = evaluator.measure(evaluator.resolved.sampling.pose.up()?);
        let SearchResult {
            best,
            scale,
            candidates,
        } = evaluator.run(&mut search, progress)?;
        let options = *search.options();
        options.rate(&mut now, &scale);
        Ok(OrientationReport {
            schema: SCHEMA,
            model: self.facts.file.clone(),
            search: options,
            scale,
            now,
            best,
            candidates,
        })
    }

    /// The directions of a search: `count` unit vectors spread evenly, the axes, and the normals of the model's largest
    /// flats.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn directions(&mut self, options: &Options, count: usize) -> Result<Vec<[f64; 3]>, Error> {
        Ok(self.surface(&self.resolved(options)?)?.directions(count))
    }

    fn directions_of(
        &mut self,
        options: &Options,
        search: &SearchOptions,
    ) -> Result<Vec<[f64; 3]>, Error> {
        // Checked first, so that too many directions do not exhaust the memory.
        search.check()?;
        self.directions(options, search.directions)
    }

    /// Measures the directions of a task.
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
            // Energies are relative to all directions, and a shard has only some.
            candidate.energy = None;
        }
        Ok(OrientationPart {
            places: shard.places(total).collect(),
            candidates,
            ..self.part(options, shard, total)
        })
    }

    /// Merges the parts of a search into one whose directions are all measured. Ignores parts for other models or weights.
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
        // Options that are invalid in every direction made every shard fail. Report that, rather than missing parts.
        self.check_for_all_directions(&self.resolved(options)?)?;
        let none = Shard {
            number: 0,
            count: 0,
        };
        let whole = self.part(options, none, directions.len());
        let candidates = shard::merge(parts, &whole, &directions)?;
        Ok(Search::of_measured(*search, candidates)?)
    }

    /// An empty part.
    #[cfg(not(target_arch = "wasm32"))]
    fn part(&self, options: &Options, shard: Shard, directions: usize) -> OrientationPart {
        OrientationPart {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model: self.facts.file.clone(),
            options: options.as_reported(),
            weights_crc32: self.painted.as_deref().map(weights::crc_of),
            shard,
            directions,
            places: Vec::new(),
            candidates: Vec::new(),
        }
    }

    fn surface(&mut self, resolved: &Resolved) -> Result<&Surface, Error> {
        // The rotation matters only if there is a height to scale to.
        let pose = resolved.sampling.pose;
        let scaled = match (pose.height_mm, pose.unit) {
            (Some(_), _) => Some(pose),
            (None, None) => None,
            (None, unit) => Some(Pose {
                unit,
                ..Pose::default()
            }),
        };
        let surface = match self.surface.take().filter(|kept| kept.0 == scaled) {
            Some(kept) => kept,
            None => (scaled, Surface::new(&self.mesh, self.scale(scaled)?)),
        };
        Ok(&self.surface.insert(surface).1)
    }

    /// The factor that scales the model to the height of a pose, or by its unit; 1 without either.
    fn scale(&self, scaled: Option<Pose>) -> Result<f64, Error> {
        let Some(pose) = scaled else {
            return Ok(1.0);
        };
        let Some(height_mm) = pose.height_mm else {
            return Ok(pose.unit_mm());
        };
        // This call returns the error of an invalid height.
        self.mesh.on_plate(&pose)?;
        let unscaled = Pose {
            height_mm: None,
            unit: None,
            ..pose
        };
        let size = self.mesh.on_plate(&unscaled)?.bounds().size();
        Ok(height_mm / size.z)
    }

    /// Checks options that are invalid in every direction. That is an error, not a reason to exclude a direction.
    fn check_for_all_directions(&self, resolved: &Resolved) -> Result<(), Error> {
        match resolved
            .sampling
            .grid(&self.mesh.bounds(), resolved.sampling.made_lift_mm())
        {
            Err(error) if exclusion(&error).is_none() => Err(error.into()),
            _ => Ok(()),
        }
    }

    fn evaluator<'a>(
        &'a mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Evaluator<'a>, Error> {
        let resolved = self.resolved(options)?;
        self.check_for_all_directions(&resolved)?;
        self.surface(&resolved)?;
        let weights = self.layering_weights(&resolved.layering, progress)?;
        let surface = &self.surface.as_ref().ok_or(Error::NoPlan)?.1;
        #[cfg(not(target_arch = "wasm32"))]
        parallel::keep_memory();
        Ok(Evaluator {
            model: &self.mesh,
            surface,
            resolved,
            weights: weights.map(|weights| surface.arranged(&weights)),
        })
    }
}

impl Evaluator<'_> {
    /// Runs a search to its end.
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

    fn evaluate(&self, task: Task) -> TaskResult {
        TaskResult {
            number: task.number,
            candidates: parallel::map(task.directions, |direction| self.measure(direction)),
        }
    }

    fn measure(&self, direction: [f64; 3]) -> Candidate {
        let fits = |bounds: &Bounds| match self
            .resolved
            .sampling
            .grid(bounds, self.resolved.sampling.made_lift_mm())
        {
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

    /// `None` if no plan keeps the tolerance.
    fn metrics(&self, placement: &Placement) -> Option<Metrics> {
        let layering = &self.resolved.layering;
        let height_mm = placement.size_mm[2];
        let bins = Bins::of_height(height_mm, layering.bin_mm).ok()?;
        let facet_bins = self.surface.facet_bins(placement, bins);
        let extra = || {
            let pose = Pose {
                rotation: Some(placement.rotation),
                ..Pose::of_height(height_mm)
            };
            let mesh = self.model.on_plate(&pose)?;
            let mut extra = Extra::of(&mesh, layering.metric, bins);
            self.surface.renumber(&mut extra.cones);
            Ok::<_, Error>(extra)
        };
        let shapes = shapes_of(&facet_bins, extra, layering, self.weights.clone()).ok()?;
        let planning = Planning::alone(height_mm, &shapes, layering);
        let plan = planning.plan_freely().ok()?;
        let figures = [
            planning.max_error(&plan),
            plan.print_time_s(&layering.resin),
        ];
        let supporting = self.resolved.sampling.supports.as_ref();
        let profile = supporting.map_or_else(SupportProfile::default, Supporting::profile);
        let weights = self.weights.as_deref();
        let surface = self.surface;
        Some(surface.metrics(placement, &facet_bins, weights, &profile, &plan, figures))
    }
}

/// The exclusion that an error means: the model does not fit the printer in this orientation. `None` for other errors.
fn exclusion(error: &GridError) -> Option<Exclusion> {
    match error {
        GridError::ModelTooLarge { .. } | GridError::BadSize { .. } => Some(Exclusion::TooLarge),
        GridError::ModelTooHigh { .. } => Some(Exclusion::TooHigh),
        _ => None,
    }
}
