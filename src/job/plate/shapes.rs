//! The models of a plate, sampled and measured.

use std::sync::Arc;

use web_time::Instant;

use super::super::Timings;
use super::super::measured::Measured;
use super::super::memory::Memory;
use super::super::parts::{Job, Layering, Sampling};
use super::super::prepared::Prepared;
use super::super::sampled::Sampled;
use super::super::stage::{Stage, StageProgress, ms_since, report};
use super::places::kinds;
use super::{Plate, PlateOptions};
use crate::Error;
use crate::arrange::Place;
use crate::parallel;
use crate::progress::silent;

/// A model after some turns of 15°, sampled and measured. All copies that stand like this share it.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub model: usize,
    pub turns: u32,
    pub measured: Arc<Measured>,
}

/// A sampled model after some turns, what its facets weigh, and what is already measured of it.
struct Unmeasured {
    model: usize,
    turns: u32,
    sampled: Arc<Sampled>,
    weights: Option<Vec<f32>>,
    known: Option<Arc<Measured>>,
}

impl Plate {
    /// Prepares the models if they get supports, whose shadows count when they are arranged.
    pub(super) fn prepare(
        &mut self,
        options: &PlateOptions,
        job: &Job,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let kept = std::mem::take(&mut self.prepared);
        if job.sampling.supports.is_none() {
            return Ok(());
        }
        let count = self.models.len() as f64;
        for model in 0..self.models.len() {
            let mut within = |stage, fraction| progress(stage, (model as f64 + fraction) / count);
            let sampling = self.sampling_of(options, job, model, 0);
            let weights = self.models[model].layering_weights(&job.layering, &mut within)?;
            let spared = sampling.spared(weights.as_deref());
            let prepared = match kept.get(model) {
                Some(known) if known.is_of(&sampling, spared) => Arc::clone(known),
                last => {
                    let mesh = &self.models[model].model;
                    let last = last.map(AsRef::as_ref);
                    let mut within = |fraction| within(Stage::Ldi, fraction);
                    Arc::new(Prepared::new(
                        mesh,
                        &sampling,
                        spared,
                        last,
                        timings,
                        &mut within,
                    )?)
                }
            };
            self.prepared.push(prepared);
        }
        Ok(())
    }

    /// Samples and measures each model in each of its turns, or reuses results that are still valid.
    pub(super) async fn measure(
        &mut self,
        options: &PlateOptions,
        job: &Job,
        places: &[Place],
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let kinds = kinds(places);
        let wanted: Vec<(usize, u32, Sampling)> = kinds
            .into_iter()
            .map(|(model, turns)| {
                let sampling = self.sampling_of(options, job, model, turns);
                (model, turns, sampling)
            })
            .collect();
        // Old rays are freed before new ones are sampled.
        self.shapes.retain(|shape| {
            wanted.iter().any(|(model, _, sampling)| {
                shape.model == *model && shape.measured.of.sampling == *sampling
            })
        });
        let kept = std::mem::take(&mut self.shapes);
        let mut unmeasured = Vec::with_capacity(wanted.len());
        let sampled = self
            .sample(
                wanted,
                &job.layering,
                &kept,
                &mut unmeasured,
                timings,
                progress,
            )
            .await;
        // After an error, what was sampled until then is kept.
        let clock = Instant::now();
        let measured = parallel::map(unmeasured, |it: Unmeasured| {
            let layering = &job.layering;
            let measured = Measured::new(&it.sampled, layering, it.weights, it.known, &mut silent)?;
            Ok::<_, Error>(Shape {
                model: it.model,
                turns: it.turns,
                measured,
            })
        });
        self.shapes = measured.into_iter().collect::<Result<_, _>>()?;
        timings.profile += ms_since(clock);
        sampled?;
        report(progress, Stage::Profile, 1.0)?;
        Ok(())
    }

    /// Samples each model in each of its turns, in order: each uses all cores by itself.
    async fn sample(
        &mut self,
        wanted: Vec<(usize, u32, Sampling)>,
        layering: &Layering,
        kept: &[Shape],
        unmeasured: &mut Vec<Unmeasured>,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let count = wanted.len() as f64;
        if let Some(memory) = self.memory {
            let models = wanted.len().max(1);
            self.sampler.set_memory(Memory { models, ..memory });
        }
        for (number, (model, turns, sampling)) in wanted.into_iter().enumerate() {
            let mut within = |stage, fraction| progress(stage, (number as f64 + fraction) / count);
            let weights = self.models[model].layering_weights(layering, &mut within)?;
            let spared = sampling.spared(weights.as_deref());
            let same = kept.iter().filter(|shape| shape.model == model);
            let known = same
                .clone()
                .find(|shape| shape.measured.of.is_of(&sampling, spared))
                .map(|known| Arc::clone(&known.measured));
            let sampled = if let Some(known) = &known {
                Arc::clone(&known.of)
            } else {
                let mesh = &self.models[model].model;
                let prepared = match self.prepared.get(model) {
                    Some(prepared) => Some(prepared.turned(turns)?),
                    None => same
                        .map(|shape| &shape.measured.of.prepared)
                        .find(|prepared| prepared.is_of(&sampling, None))
                        .map(Arc::clone),
                };
                let sampled = self
                    .sampler
                    .sample(mesh, &sampling, spared, prepared, timings, &mut within)
                    .await;
                Arc::new(sampled?)
            };
            unmeasured.push(Unmeasured {
                model,
                turns,
                sampled,
                weights,
                known,
            });
        }
        report(progress, Stage::Profile, 0.0)?;
        Ok(())
    }

    /// The shapes on a plate, with the places of their copies.
    pub(super) fn standing(&self, on_plate: &[Place]) -> Vec<(Shape, Vec<[i32; 2]>)> {
        let of = |shape: &Shape| {
            let copies = on_plate
                .iter()
                .filter(|place| place.item == shape.model && place.turns == shape.turns);
            let offsets: Vec<_> = copies.map(|place| place.offset).collect();
            (!offsets.is_empty()).then(|| (shape.clone(), offsets))
        };
        self.shapes.iter().filter_map(of).collect()
    }
}
