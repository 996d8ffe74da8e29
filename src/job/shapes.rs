//! The models of a job, prepared, sampled and measured in each of their turns.

use std::sync::Arc;

use web_time::Instant;

use super::places::{Layout, kinds};
use super::stages::measured::{Measured, Shape};
use super::stages::memory::Memory;
use super::stages::parts::{Layering, Resolved, Sampling};
use super::stages::planned::Planned;
use super::stages::prepared::{PREPARING_SHARE, Prepared};
use super::stages::stage::{Stage, StageProgress, ms_since, report};
use super::{Error, Job, JobOptions, Timings};
use crate::parallel;
use crate::progress::{Progress, silent};

/// A model after some turns, and how it is sampled.
struct Wanted {
    model: usize,
    turns: u32,
    sampling: Sampling,
}

impl Job {
    /// Prepares the models that get voids or supports.
    pub(super) fn prepare(
        &mut self,
        options: &JobOptions,
        resolved: &Resolved,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let kept = std::mem::take(&mut self.prepared);
        let count = self.models.len() as f64;
        for model in 0..self.models.len() {
            let sampling = self.sampling_of(options, resolved, model, 0);
            if !Prepared::takes_time(&sampling) {
                self.prepared.push(None);
                continue;
            }
            let mut within = |stage, fraction| progress(stage, (model as f64 + fraction) / count);
            let weights = self.models[model].layering_weights(&resolved.layering, &mut within)?;
            let protected = sampling.protected(weights.as_deref());
            let prepared = match kept.get(model).and_then(Option::as_ref) {
                Some(known) if known.is_of(&sampling, protected) => Arc::clone(known),
                last => {
                    let mesh = &self.models[model].mesh;
                    let last = last.map(AsRef::as_ref);
                    let mut within = |fraction| within(Stage::Ldi, PREPARING_SHARE * fraction);
                    let made =
                        Prepared::new(mesh, &sampling, protected, last, timings, &mut within);
                    Arc::new(made?)
                }
            };
            self.prepared.push(Some(prepared));
        }
        Ok(())
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
        let wanted = self.wanted(options, layout);
        let weights = self.sample(wanted, layering, timings, progress).await?;
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
        wanted: Vec<Wanted>,
        layering: &Layering,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<Option<Vec<f32>>>, Error> {
        let posed: Vec<(usize, Arc<Prepared>)> = self
            .shapes
            .iter()
            .map(|shape| (shape.model, Arc::clone(&shape.sampled.prepared)))
            .collect();
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
        for (number, it) in wanted.into_iter().enumerate() {
            let Wanted {
                model,
                turns,
                sampling,
            } = it;
            let mut within = |stage, fraction| progress(stage, (number as f64 + fraction) / count);
            let weights = self.models[model].layering_weights(layering, &mut within)?;
            let protected = sampling.protected(weights.as_deref());
            let known = kept.iter().position(|shape| {
                shape.model == model && shape.sampled.is_of(&sampling, protected)
            });
            let shape = if let Some(known) = known {
                kept.swap_remove(known)
            } else {
                let mut begun = 0.0;
                let mut alike = posed.iter().filter(|it| it.0 == model);
                let alike = alike.find(|(_, posed)| posed.is_of(&sampling, protected));
                let prepared = if let Some(prepared) = &self.prepared[model] {
                    begun = PREPARING_SHARE;
                    prepared.turned(turns)?
                } else if let Some((_, posed)) = alike {
                    Arc::clone(posed)
                } else {
                    let mesh = &self.models[model].mesh;
                    let last = None;
                    let posed =
                        Prepared::new(mesh, &sampling, protected, last, timings, &mut silent);
                    Arc::new(posed?)
                };
                let mut within = |fraction| within(Stage::Ldi, begun + (1.0 - begun) * fraction);
                let sampled = self
                    .sampler
                    .sample(&sampling, prepared, timings, &mut within)
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
