//! What is made of the plan of a plate: profiles, masks and print files.

use std::io::Write;
use std::sync::Arc;

use web_time::Instant;

use super::super::parts::Job;
use super::super::planned::Planned;
use super::super::print::write_print;
use super::super::stage::{Stage, StageProgress, ms_since};
use super::super::{Report, Tradeoff};
use super::Plate;
use crate::Error;
use crate::archive::{Look, MaskSource, Standing};
use crate::arrange::ArrangeError;
use crate::mask::{MaskCursor, PlateMasks, PlateRuns, Side, Stamp};
use crate::profile::{Metric, Profile, Source};

/// A plate with its plan and its report.
#[derive(Debug)]
pub(super) struct Current {
    pub planned: Arc<Planned>,
    /// For each model of the plan, where its copies stand as seen from above.
    pub offsets: Vec<Vec<[i32; 2]>>,
    pub job: Job,
    pub report: Report,
    /// The masks seen from above, and cursors at the last layer that was read.
    pub seen: Option<(PlateMasks, Vec<MaskCursor>)>,
}

impl Plate {
    pub(super) fn current(&mut self, plate: usize) -> Result<&mut Current, Error> {
        let plates = self.plates.len();
        if plates == 0 {
            return Err(Error::NoPlan);
        }
        let current = self.plates.get_mut(plate);
        Ok(current.ok_or(ArrangeError::NoPlate {
            plate_number: plate + 1,
            plates,
        })?)
    }

    /// The profile of a metric on a plate: in each bin the largest of its models.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`].
    pub fn profile(
        &mut self,
        plate: usize,
        metric: Metric,
        source: Source,
    ) -> Result<Profile, Error> {
        let planned = &self.current(plate)?.planned;
        let mut largest = Profile {
            bins: planned.plan.bins,
            density: vec![0.0; planned.plan.bins.count],
        };
        for model in &planned.models {
            let shapes = &model.measured.shapes;
            if metric.needs_areas() && !shapes.has_areas() {
                return Err(Error::NoPlan);
            }
            let density = shapes.profile(metric, source).density;
            for (most, density) in largest.density.iter_mut().zip(density) {
                *most = most.max(density);
            }
        }
        Ok(largest)
    }

    /// The mask of a layer of a plate: see [`MaskCursor::whole`].
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::NoLayer`], [`Error::Arrange`].
    pub fn mask(&mut self, plate: usize, layer: usize) -> Result<Vec<u8>, Error> {
        let current = self.current(plate)?;
        let layers = current.planned.plan.layers();
        if layer >= layers {
            return Err(Error::NoLayer { layer, layers });
        }
        let (masks, cursors) = current.seen()?;
        Ok(masks.whole(cursors, layer))
    }

    /// The best plans of a plate for `points` tolerances, as [`Slicer::tradeoff`](crate::job::Slicer::tradeoff) has them of a model. Models
    /// with a tolerance of their own are held to it in proportion.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`], [`Error::Plan`].
    pub fn tradeoff(&mut self, plate: usize, points: usize) -> Result<Tradeoff, Error> {
        let points = self.current(plate)?.planned.tradeoff(points)?;
        Ok(Tradeoff { points })
    }

    /// Writes the print file of a plate in the format of its options. Returns the writer, and the report with the time that this
    /// took.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Archive`], [`Error::Arrange`].
    pub fn write_archive<W: Write>(
        &mut self,
        plate: usize,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        let clock = Instant::now();
        let current = self.current(plate)?;
        let planned = Arc::clone(&current.planned);
        let side = current.job.output.side();
        let models = planned.models.iter();
        let all_held = models
            .clone()
            .all(|model| model.sampled().bound().is_none());
        // Masks seen from above are kept for later calls.
        let seen_above = side == Side::Above && all_held;
        let apart = if seen_above {
            current.seen()?;
            Vec::new()
        } else {
            let models = 0..planned.models.len();
            let apart = models.map(|model| planned.runs(model, side));
            apart.collect::<Result<Vec<_>, _>>()?
        };
        let Current {
            offsets,
            job,
            report,
            seen,
            ..
        } = current;
        let runs = match seen {
            Some((masks, _)) if seen_above => masks.runs(),
            _ => PlateRuns {
                grid: planned.first().of.grid,
                stamps: apart
                    .iter()
                    .zip(offsets.iter())
                    .map(|(runs, offsets)| (&**runs, seen_from(side, offsets)))
                    .collect(),
            },
        };
        let look = || look_of(&planned, offsets);
        let mut within = |fraction| progress(Stage::Masks, fraction);
        let writer = write_print(
            &planned,
            &job.output,
            report,
            MaskSource::Runs(&runs),
            &look,
            writer,
            &mut within,
        )?;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }
}

/// The places of copies as they are seen from a side.
fn seen_from(side: Side, offsets: &[[i32; 2]]) -> Vec<[i32; 2]> {
    let offsets = offsets.iter();
    match side {
        Side::Above => offsets.copied().collect(),
        Side::Below => offsets.map(|&[right, down]| [-right, down]).collect(),
    }
}

impl Current {
    /// The masks seen from above, and cursors.
    pub(super) fn seen(&mut self) -> Result<&mut (PlateMasks, Vec<MaskCursor>), Error> {
        let seen = if let Some(seen) = self.seen.take() {
            seen
        } else {
            let stamps = self.offsets.iter().enumerate().map(|(model, offsets)| {
                Ok::<_, Error>(Stamp {
                    masks: self.planned.masks(model, Side::Above)?,
                    offsets: offsets.clone(),
                })
            });
            let masks = PlateMasks {
                grid: self.planned.first().of.grid,
                stamps: stamps.collect::<Result<_, _>>()?,
            };
            let cursors = masks.stamps.iter().map(|stamp| stamp.masks.cursor());
            let cursors = cursors.collect();
            (masks, cursors)
        };
        Ok(self.seen.insert(seen))
    }
}

/// The plate seen from above.
fn look_of(planned: &Planned, offsets: &[Vec<[i32; 2]>]) -> Look {
    let mut copies = Vec::new();
    for (model, offsets) in planned.models.iter().zip(offsets) {
        let sampled = model.sampled();
        let rays = sampled.sampling.samples.rays();
        let first = sampled.grid.refined(rays).offset_of(&sampled.rays);
        copies.extend(offsets.iter().map(|offset| Standing {
            mesh: sampled.mesh(),
            image: sampled.image(),
            first_ray: [0, 1].map(|axis| {
                i64::from(first[axis]) + i64::from(offset[axis]) * i64::from(rays[axis])
            }),
        }));
    }
    Look::of_copies(&copies)
}
