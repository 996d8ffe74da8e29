//! Searching for the best building direction (section 4.3).

use super::planned::{Planning, shapes_of};
use super::resolve::Job;
use super::slicer::Slicer;
use super::stage::{Stage, StageProgress};
use super::{Error, Options, SCHEMA};
use crate::grid::{Bins, GridError};
use crate::ldi::LdiError;
#[cfg(not(target_arch = "wasm32"))]
use crate::model::weights;
use crate::model::{Bounds, Mesh, Pose};
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::{MergeError, Part, Shard, merge};
use crate::orientation::{
    Candidate, Exclusion, Metrics, OrientationReport, Placement, Scale, SearchOptions, Surface,
    best, rate, refine,
};
use crate::parallel;
use crate::profile::section;

/// Directions that a thread is given at once.
const BATCH: usize = 4;

/// What finer searches take of all the time, about.
const REFINEMENT: f64 = 0.2;

/// What measuring a direction needs.
struct Evaluator<'a> {
    model: &'a Mesh,
    table: &'a Surface,
    job: Job,
    /// Of facets as the table has them.
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
    /// [`Error::Options`], [`Error::Mesh`], [`Error::Plan`] for options that no direction makes good; [`Error::Ldi`] if
    /// `progress` cancels.
    pub fn orient(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationReport, Error> {
        search.check()?;
        let directions = self.directions(options, search.directions)?;
        let candidates =
            self.measure_directions(options, &directions, &mut |stage, fraction| {
                progress(stage, fraction * (1.0 - REFINEMENT))
            })?;
        self.choose(options, search, candidates, progress)
    }

    /// The rest of a search whose directions have been measured, wherever that was: all of [`Self::directions`] in their
    /// order.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn choose(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        mut candidates: Vec<Candidate>,
        progress: &mut StageProgress<'_>,
    ) -> Result<OrientationReport, Error> {
        search.check()?;
        let rating = rate(&candidates, search);
        for (candidate, energy) in candidates.iter_mut().zip(rating.energies) {
            candidate.energy = energy;
        }
        let bench = self.bench(options, progress)?;
        let mut now = bench.measure(bench.job.sampling.pose.up()?);
        now.energy = search.energy(&now, &rating.scale);
        let mut refined = Vec::with_capacity(rating.minima.len());
        parallel::map_in_groups(
            rating.minima.iter(),
            |&index| bench.refine(search, &rating.scale, &candidates[index]),
            |found| {
                refined.push(found);
                Ok::<_, LdiError>(())
            },
            &mut |fraction| progress(Stage::Orientation, 1.0 - REFINEMENT * (1.0 - fraction)),
            [0.0, 1.0],
        )?;
        Ok(OrientationReport {
            schema: SCHEMA,
            model: self.file.clone(),
            search: *search,
            scale: rating.scale,
            now,
            best: best(&refined),
            candidates,
        })
    }

    /// The directions of a search: so many unit vectors spread evenly, the axes, and those of the model's largest flats.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn directions(&mut self, options: &Options, count: usize) -> Result<Vec<[f64; 3]>, Error> {
        Ok(self.surface(&options.resolve()?)?.directions(count))
    }

    /// Measures directions, in their order.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn measure_directions(
        &mut self,
        options: &Options,
        directions: &[[f64; 3]],
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<Candidate>, Error> {
        let bench = self.bench(options, progress)?;
        let mut candidates = Vec::with_capacity(directions.len());
        parallel::map_in_groups(
            directions.chunks(BATCH),
            |batch| {
                let measured = batch.iter().map(|&direction| bench.measure(direction));
                measured.collect::<Vec<_>>()
            },
            |batch| {
                candidates.extend(batch);
                Ok::<_, LdiError>(())
            },
            &mut |fraction| progress(Stage::Orientation, fraction),
            [0.0, 1.0],
        )?;
        Ok(candidates)
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
    ) -> Result<Part, Error> {
        search.check()?;
        let directions = self.directions(options, search.directions)?;
        let places: Vec<usize> = shard.places(directions.len()).collect();
        let ours: Vec<[f64; 3]> = places.iter().map(|&place| directions[place]).collect();
        let candidates = self.measure_directions(options, &ours, progress)?;
        Ok(Part {
            places,
            candidates,
            ..self.part(options, shard, directions.len())
        })
    }

    /// Puts together what was measured in shards, for [`Self::choose`]. Parts of other models are left aside.
    ///
    /// # Errors
    /// [`MergeError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn merge_shards(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        parts: &[Part],
    ) -> Result<Vec<Candidate>, MergeError> {
        search.check().map_err(Error::from)?;
        let directions = self.directions(options, search.directions)?;
        // A model that no shard could measure has the same fault here, rather than no part.
        self.check_for_all_directions(&options.resolve()?)?;
        let none = Shard {
            number: 0,
            count: 0,
        };
        let whole = self.part(options, none, directions.len());
        merge(parts, &whole, &directions)
    }

    /// A part with nothing in it.
    #[cfg(not(target_arch = "wasm32"))]
    fn part(&self, options: &Options, shard: Shard, directions: usize) -> Part {
        Part {
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

    /// The best direction near a rated candidate, by a finer search.
    ///
    /// # Errors
    /// Those of [`Self::orient`].
    pub fn refine_direction(
        &mut self,
        options: &Options,
        search: &SearchOptions,
        scale: &Scale,
        candidate: &Candidate,
    ) -> Result<Candidate, Error> {
        search.check()?;
        let bench = self.bench(options, &mut |_, _| std::ops::ControlFlow::Continue(()))?;
        Ok(bench.refine(search, scale, candidate))
    }

    fn surface(&mut self, job: &Job) -> Result<&Surface, Error> {
        // How the model stands matters only to a height.
        let pose = job.sampling.pose;
        let scaled = pose.height_mm.map(|_| pose);
        let table = match self.surface.take().filter(|kept| kept.0 == scaled) {
            Some(kept) => kept,
            None => (scaled, Surface::new(&self.model, self.scale(scaled)?)),
        };
        Ok(&self.surface.insert(table).1)
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

    fn bench<'a>(
        &'a mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Evaluator<'a>, Error> {
        let job = options.resolve()?;
        self.check_for_all_directions(&job)?;
        self.surface(&job)?;
        let weights = self.layering_weights(&job.layering, progress)?;
        let table = &self.surface.as_ref().ok_or(Error::NoPlan)?.1;
        #[cfg(not(target_arch = "wasm32"))]
        parallel::keep_memory();
        Ok(Evaluator {
            model: &self.model,
            table,
            job,
            weights: weights.map(|weights| table.arranged(&weights)),
        })
    }
}

impl Evaluator<'_> {
    fn measure(&self, direction: [f64; 3]) -> Candidate {
        let fits = |bounds: &Bounds| match self.job.sampling.grid(bounds) {
            Err(error) => exclusion(&error).map_or(Ok(()), Err),
            Ok(_) => Ok(()),
        };
        let (placement, mut excluded) = self.table.place(direction, fits);
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
        let facet_bins = self.table.facet_bins(placement, bins);
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
            self.table
                .metrics(placement, &facet_bins, &plan, max_error, print_time_s),
        )
    }

    fn refine(&self, search: &SearchOptions, scale: &Scale, candidate: &Candidate) -> Candidate {
        refine(candidate, search, scale, |direction| {
            self.measure(direction)
        })
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
