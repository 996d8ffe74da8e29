//! The models of a job, prepared, sampled and measured in each of their turns.

use std::sync::Arc;

use web_time::Instant;

use super::places::{Layout, kinds};
use super::stages::measured::{Measured, Shape};
use super::stages::memory::Memory;
use super::stages::parts::{Resolved, Sampling};
use super::stages::planned::Planned;
use super::stages::prepared::{PREPARING_SHARE, Prepared};
use super::stages::stage::{Stage, StageProgress, ms_since, report};
use super::{Error, Job, JobOptions, Timings};
use crate::arrange::{Outline, Screen};
use crate::model::Mesh;
use crate::parallel;
use crate::progress::{Progress, silent};

/// A model after some turns, and how it is sampled.
struct Wanted {
    model: usize,
    turns: u32,
    sampling: Sampling,
}

/// A prepared model, before turns.
pub(super) struct Upright<'a> {
    model: usize,
    mesh: &'a Mesh,
    sampling: Sampling,
    prepared: &'a Arc<Prepared>,
    /// Shapes of the job, some of which may be this model's.
    shapes: &'a [Shape],
}

impl Upright<'_> {
    /// The model after some turns. One that a shape has is not made again.
    pub fn turned(&self, turns: u32) -> Result<Arc<Prepared>, Error> {
        if turns == 0 {
            return Ok(Arc::clone(self.prepared));
        }
        let sampling = Sampling {
            pose: self.sampling.pose.turned(turns),
            ..self.sampling.clone()
        };
        let of_model = self.shapes.iter().filter(|it| it.model == self.model);
        let mut known = of_model.map(|shape| &shape.sampled.prepared);
        if let Some(known) = known.find(|it| it.is_turned(self.prepared, &sampling)) {
            return Ok(Arc::clone(known));
        }
        let made = if Prepared::takes_time(&sampling) {
            self.prepared.turned(turns)
        } else {
            // Turned once, its vertices are rounded once.
            let mut timings = Timings::default();
            Prepared::new(
                self.mesh,
                &sampling,
                true,
                None,
                None,
                &mut timings,
                &mut silent,
            )
        };
        Ok(Arc::new(made?))
    }

    /// Its shadow on a plate after some turns.
    pub fn outline(&self, turns: u32, screen: &Screen) -> Result<Arc<Outline>, Error> {
        Ok(self.turned(turns)?.outline(screen))
    }
}

impl Job {
    /// Poses the models, and adds voids and supports. Models that do not fit as they stand are refused at once, unless copies may turn.
    pub(super) fn prepare(
        &mut self,
        options: &JobOptions,
        resolved: &Resolved,
        may_turn: bool,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let mut kept = std::mem::take(&mut self.prepared).into_iter();
        let count = self.models.len() as f64;
        for model in 0..self.models.len() {
            let last = kept.next();
            let mut sampling = self.sampling_of(options, resolved, model, 0);
            if options.of_model(model).copies == 0 {
                // Nothing of it is printed.
                (sampling.hollow, sampling.supports) = (None, None);
            }
            let mut within = |stage, fraction| progress(stage, (model as f64 + fraction) / count);
            let weights = if Prepared::takes_time(&sampling) {
                self.models[model].layering_weights(&resolved.layering, &mut within)?
            } else {
                None
            };
            let protected = sampling.protected(weights.as_deref());
            let prepared = match last {
                Some(known) if known.is_of(&sampling, protected) => known,
                last => {
                    let mesh = &self.models[model].mesh;
                    let mut within = |fraction| within(Stage::Ldi, PREPARING_SHARE * fraction);
                    let last = last.as_deref();
                    let made = Prepared::new(
                        mesh,
                        &sampling,
                        may_turn,
                        protected,
                        last,
                        timings,
                        &mut within,
                    );
                    Arc::new(made?)
                }
            };
            self.prepared.push(prepared);
        }
        Ok(())
    }

    /// A prepared model, before turns.
    pub(super) fn upright(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        model: usize,
    ) -> Upright<'_> {
        Upright {
            model,
            mesh: &self.models[model].mesh,
            sampling: self.sampling_of(options, resolved, model, 0),
            prepared: &self.prepared[model],
            shapes: &self.shapes,
        }
    }

    /// The models and turns in which copies stand.
    fn wanted(&self, options: &JobOptions, layout: &Layout) -> Vec<Wanted> {
        let kinds = kinds(&layout.places).into_iter();
        let wanted = kinds.map(|(model, turns)| Wanted {
            model,
            turns,
            sampling: self.sampling_of(options, &layout.resolved, model, turns),
        });
        wanted.collect()
    }

    /// Returns true if the models of a plan are sampled with the final options.
    pub(super) fn is_wanted(
        &self,
        options: &JobOptions,
        layout: &Layout,
        planned: &Planned,
    ) -> bool {
        let wanted = self.wanted(options, layout);
        let is_wanted = |model: usize, sampling: &Sampling| {
            let mut alike = wanted.iter();
            alike.any(|it| it.model == model && it.sampling == *sampling)
        };
        let mut models = planned.models.iter();
        models.all(|it| is_wanted(it.model, &it.sampled().sampling))
    }

    /// Samples and measures each model in each of its turns, or reuses results that are still valid. After an error,
    /// the samples so far are kept.
    pub(super) async fn measure(
        &mut self,
        options: &JobOptions,
        layout: &Layout,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let layering = &layout.resolved.layering;
        let weights = self.sample(options, layout, timings, progress).await?;
        report(progress, Stage::Profile, 0.0)?;
        let clock = Instant::now();
        let known = |shape: &Shape| shape.measured.clone();
        let measure = |(shape, weights): (&Shape, _), progress: &mut Progress<'_>| {
            Measured::new(&shape.sampled, layering, weights, known(shape), progress)
        };
        let count = self.shapes.len();
        let all = self.shapes.iter().zip(weights);
        let measured: Vec<_> = if count == 1 || parallel::threads() == 1 {
            let one_by_one = all.enumerate().map(|(number, it)| {
                let done = |fraction| (number as f64 + fraction) / count as f64;
                measure(it, &mut |fraction| progress(Stage::Profile, done(fraction)))
            });
            one_by_one.collect()
        } else {
            parallel::map(all.collect(), |it| measure(it, &mut silent))
        };
        let mut is_new = false;
        for (shape, measured) in self.shapes.iter_mut().zip(measured) {
            let measured = measured?;
            let known = shape.measured.as_ref();
            is_new |= !known.is_some_and(|known| Arc::ptr_eq(known, &measured));
            shape.measured = Some(measured);
        }
        if is_new {
            timings.profile += ms_since(clock);
        }
        report(progress, Stage::Profile, 1.0)?;
        Ok(())
    }

    /// Samples each model in each of its turns, in order: each uses all cores by itself. Returns the weights of their facets.
    async fn sample(
        &mut self,
        options: &JobOptions,
        layout: &Layout,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<Option<Vec<f32>>>, Error> {
        let (resolved, wanted) = (&layout.resolved, self.wanted(options, layout));
        let turned = |it: &Wanted| self.upright(options, resolved, it.model).turned(it.turns);
        let prepared = wanted.iter().map(turned).collect::<Result<Vec<_>, _>>()?;
        // Old rays are freed before new ones are sampled.
        self.shapes.retain(|shape| {
            let mut alike = wanted.iter();
            alike.any(|it| it.model == shape.model && it.sampling == shape.sampled.sampling)
        });
        let mut kept = std::mem::take(&mut self.shapes);
        if let Some(memory) = self.memory {
            let models = wanted.len().max(1);
            self.sampler.set_memory(Memory { models, ..memory });
        }
        let count = wanted.len() as f64;
        let mut all_weights = Vec::with_capacity(wanted.len());
        for (number, (it, prepared)) in wanted.into_iter().zip(prepared).enumerate() {
            let Wanted {
                model,
                turns,
                sampling,
            } = it;
            let mut within = |stage, fraction| progress(stage, (number as f64 + fraction) / count);
            let weights = self.models[model].layering_weights(&resolved.layering, &mut within)?;
            let protected = sampling.protected(weights.as_deref());
            let keeps_rays = resolved.layering.needs_rays();
            let known = kept.iter().position(|shape| {
                shape.model == model
                    && shape.sampled.is_of(&sampling, protected)
                    && (shape.sampled.keeps_rays() || !keeps_rays)
            });
            let shape = if let Some(known) = known {
                kept.swap_remove(known)
            } else {
                let begun = if Prepared::takes_time(&sampling) {
                    PREPARING_SHARE
                } else {
                    0.0
                };
                let mut within = |fraction| within(Stage::Ldi, begun + (1.0 - begun) * fraction);
                let sampled = self
                    .sampler
                    .sample(&sampling, prepared, keeps_rays, timings, &mut within)
                    .await?;
                Shape {
                    model,
                    turns,
                    sampled: Arc::new(sampled),
                    measured: None,
                }
            };
            self.shapes.push(Shape { turns, ..shape });
            all_weights.push(weights);
        }
        Ok(all_weights)
    }
}
