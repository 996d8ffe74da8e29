//! Several models in one job: each is sampled and measured alone, all that stand on a plate share its plan.

use std::io::Write;
use std::sync::Arc;

use web_time::Instant;

use super::measured::Measured;
use super::parts::{Job, Layering, Raster, Sampling, Target};
use super::planned::{Part, Planned, PlannedModel, Planning};
use super::plate_report::{Sharer, layers_reaching, time_shares_s};
use super::report::{Origin, SCHEMA, report_of};
use super::sampled::{Sampled, Sampler};
use super::slicer::write_print;
use super::stage::{Stage, StageProgress, ms_since, report};
use super::{
    Error, Options, OptionsError, Placement, PlateModelReport, PlateOptions, PlateReport,
    PlatesReport, Report, Slicer, Timings,
};
use crate::archive::{Look, Standing as Seen};
use crate::arrange::{
    ArrangeError, Item, Outline, Place, Screen, Standing, TURN_DEG, TURNS, arrange, problems,
};
use crate::ldi::gpu::Gpu;
use crate::mask::{MaskCursor, PlateMasks, Side, Stamp};
use crate::model::Pose;
use crate::plan::HeightRange;
use crate::profile::{Metric, Profile, Source};

/// Models that are printed together. A change of options repeats only the stages that depend on it.
#[derive(Debug, Default)]
pub struct Plate {
    models: Vec<Slicer>,
    sampler: Sampler,
    shapes: Vec<Shape>,
    plates: Vec<Current>,
}

/// A model after some turns of 15°, sampled and measured. All copies that stand like this share it.
#[derive(Debug, Clone)]
struct Shape {
    model: usize,
    turns: u32,
    measured: Arc<Measured>,
}

/// A plate with its plan and its report.
#[derive(Debug)]
struct Current {
    planned: Arc<Planned>,
    /// For each model of the plan, where its copies stand as seen from above.
    offsets: Vec<Vec<[i32; 2]>>,
    job: Job,
    report: Report,
    /// The masks seen from above, and cursors at the last layer that was read.
    seen: Option<(PlateMasks, Vec<MaskCursor>)>,
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

    /// Where copies stand when they are arranged: for the fewest plates, then the lowest.
    ///
    /// # Errors
    /// [`Error::Arrange`], [`Error::Options`], [`Error::Mesh`].
    pub fn arrange(&self, options: &PlateOptions) -> Result<Vec<Placement>, Error> {
        let job = options.options.resolve()?;
        let screen = screen_of(&job.sampling)?;
        let places = self.arranged(options, &job, &screen)?;
        Ok(places
            .iter()
            .map(|place| placement(&screen, place))
            .collect())
    }

    fn arranged(
        &self,
        options: &PlateOptions,
        job: &Job,
        screen: &Screen,
    ) -> Result<Vec<Place>, Error> {
        if self.models.is_empty() {
            return Err(ArrangeError::Empty.into());
        }
        // The first error of a mesh; an outline cannot return it.
        let mut failed = None;
        let failed = std::cell::RefCell::new(&mut failed);
        let mut outlines: Vec<_> = (0..self.models.len())
            .map(|model| {
                let pose = pose_of(options, job, model);
                let failed = &failed;
                move |turns| {
                    let outline = self.outline(model, &pose, turns, screen);
                    outline.map_err(|error| {
                        **failed.borrow_mut() = Some(error);
                        ArrangeError::Empty
                    })
                }
            })
            .collect();
        let mut items = Vec::new();
        for (model, outline) in outlines.iter_mut().enumerate() {
            items.push(Item {
                copies: options.of_model(model).copies,
                height_mm: self.size_mm(options, job, model)?[2],
                outline,
            });
        }
        if items.iter().all(|item| item.copies == 0) {
            return Err(ArrangeError::Empty.into());
        }
        let places = arrange(screen, &options.arranging, &mut items);
        drop(items);
        drop(outlines);
        if let Some(error) = failed.into_inner().take() {
            return Err(error);
        }
        Ok(places?)
    }

    /// Extent of a model in x, y and z before turns.
    fn size_mm(&self, options: &PlateOptions, job: &Job, model: usize) -> Result<[f64; 3], Error> {
        let pose = pose_of(options, job, model);
        let size = self.models[model].model.on_plate(&pose)?.bounds().size();
        Ok([size.x, size.y, pose.height_mm.unwrap_or(size.z)])
    }

    fn outline(
        &self,
        model: usize,
        pose: &Pose,
        turns: u32,
        screen: &Screen,
    ) -> Result<Outline, Error> {
        let mesh = self.models[model].model.on_plate(&pose.turned(turns))?;
        Ok(Outline::of(&mesh, screen))
    }

    /// What is wrong with placements: copies that extend beyond their plate, and copies that overlap.
    ///
    /// # Errors
    /// [`Error::Arrange`], [`Error::Options`], [`Error::Mesh`].
    pub fn problems(
        &self,
        options: &PlateOptions,
        placements: &[Placement],
    ) -> Result<Vec<ArrangeError>, Error> {
        let job = options.options.resolve()?;
        let screen = screen_of(&job.sampling)?;
        let places = self.places(&screen, placements)?;
        self.problems_of(options, &job, &screen, &places)
    }

    fn places(
        &self,
        screen: &Screen,
        placements: &[Placement],
    ) -> Result<Vec<Place>, ArrangeError> {
        let places = placements.iter().map(|placement| {
            self.check_model(placement.model)?;
            if placement.turn_deg % TURN_DEG != 0 {
                return Err(ArrangeError::BadTurn {
                    turn_deg: placement.turn_deg,
                });
            }
            Ok(Place {
                item: placement.model,
                turns: placement.turn_deg / TURN_DEG % TURNS,
                offset: screen.offset(placement.x_mm, placement.y_mm),
                plate: placement.plate,
            })
        });
        let mut places = places.collect::<Result<Vec<_>, _>>()?;
        places.sort_by_key(|place| (place.plate, place.item));
        Ok(places)
    }

    fn problems_of(
        &self,
        options: &PlateOptions,
        job: &Job,
        screen: &Screen,
        places: &[Place],
    ) -> Result<Vec<ArrangeError>, Error> {
        let pixels = screen.by_pixels();
        let mut kinds: Vec<(usize, u32)> = places
            .iter()
            .map(|place| (place.item, place.turns))
            .collect();
        kinds.sort_unstable();
        kinds.dedup();
        let outlines = kinds.iter().map(|&(model, turns)| {
            self.outline(model, &pose_of(options, job, model), turns, &pixels)
        });
        let outlines = outlines.collect::<Result<Vec<_>, _>>()?;
        let mut found = Vec::new();
        for on_plate in places.chunk_by(|a, b| a.plate == b.plate) {
            let standing = on_plate.iter().filter_map(|place| {
                let kind = kinds.binary_search(&(place.item, place.turns)).ok()?;
                Some(Standing {
                    item: place.item,
                    outline: &outlines[kind],
                    offset: place.offset,
                })
            });
            let standing: Vec<_> = standing.collect();
            found.extend(problems(&pixels, on_plate[0].plate, &standing));
        }
        Ok(found)
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
        let is_alone = self.models.len() == 1
            && options.of_model(0).copies == 1
            && options.placements.is_empty();
        let alone = is_alone.then(|| options.alone());
        let shared = alone.as_ref().unwrap_or(&options.options);
        let job = shared.resolve()?;
        check_own(options, &job)?;
        let mut timings = Timings::default();
        let clock = Instant::now();
        let screen = screen_of(&job.sampling)?;
        let places = if options.placements.is_empty() {
            self.arranged(options, &job, &screen)?
        } else {
            let places = self.places(&screen, &options.placements)?;
            let problems = self.problems_of(options, &job, &screen, &places)?;
            if let Some(problem) = problems.into_iter().next() {
                return Err(problem.into());
            }
            places
        };
        timings.load = ms_since(clock);
        self.measure(options, &job, &places, &mut timings, progress)
            .await?;

        report(progress, Stage::Plan, 0.0)?;
        let plates: Vec<&[Place]> = places.chunk_by(|a, b| a.plate == b.plate).collect();
        for (number, on_plate) in plates.iter().enumerate() {
            let clock = Instant::now();
            let standing = self.standing(on_plate);
            let known = last.iter().chain(&self.plates);
            let models: Vec<PlannedModel> = standing
                .iter()
                .map(|(shape, copies)| PlannedModel {
                    measured: Arc::clone(&shape.measured),
                    tolerance: options
                        .of_model(shape.model)
                        .tolerance
                        .filter(|_| !is_alone),
                    copies: copies.len(),
                })
                .collect();
            let layering = layering_of(options, &job, &standing, is_alone);
            let kept = known
                .map(|it| &it.planned)
                .find(|it| it.is_of(&models, &layering));
            let planned = match kept {
                Some(kept) => Arc::clone(kept),
                None => {
                    let mut within = |fraction| {
                        progress(
                            Stage::Plan,
                            (number as f64 + fraction) / plates.len() as f64,
                        )
                    };
                    let planned = Planned::new(models, &layering, &mut within);
                    Arc::new(planned.map_err(|error| shared.typeable(error))?)
                }
            };
            timings.plan += ms_since(clock);
            timings.sum_up();
            let first = &self.models[standing[0].0.model];
            let origin = Origin {
                file: &first.file,
                options: shared,
                painted: first.painted.as_deref(),
            };
            let mut report = report_of(&planned, &job.output, origin, timings.clone());
            if !is_alone {
                let plate = self.plate_report(options, &job, &screen, on_plate, &planned)?;
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
        report(progress, Stage::Plan, 1.0)?;
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

    /// Samples and measures each model in each of its turns, or reuses results that are still valid.
    async fn measure(
        &mut self,
        options: &PlateOptions,
        job: &Job,
        places: &[Place],
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let mut kinds: Vec<(usize, u32)> = places
            .iter()
            .map(|place| (place.item, place.turns))
            .collect();
        kinds.sort_unstable();
        kinds.dedup();
        let wanted: Vec<(usize, u32, Sampling)> = kinds
            .into_iter()
            .map(|(model, turns)| {
                let sampling = Sampling {
                    pose: pose_of(options, job, model).turned(turns),
                    ..job.sampling.clone()
                };
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
        let count = wanted.len() as f64;
        for (number, (model, turns, sampling)) in wanted.into_iter().enumerate() {
            let mut within = |stage, fraction| progress(stage, (number as f64 + fraction) / count);
            let weights = self.models[model].layering_weights(&job.layering, &mut within)?;
            let known = kept
                .iter()
                .find(|shape| shape.model == model && shape.measured.of.sampling == sampling);
            let sampled = match known {
                Some(known) => Arc::clone(&known.measured.of),
                None => {
                    let mesh = &self.models[model].model;
                    let sampled = self.sampler.sample(mesh, &sampling, timings, &mut within);
                    Arc::new(sampled.await?)
                }
            };
            let clock = Instant::now();
            let known = known.map(|known| Arc::clone(&known.measured));
            let measured = Measured::new(&sampled, &job.layering, weights, known)?;
            timings.profile += ms_since(clock);
            self.shapes.push(Shape {
                model,
                turns,
                measured,
            });
        }
        report(progress, Stage::Profile, 1.0)?;
        Ok(())
    }

    /// The shapes on a plate, with the places of their copies.
    fn standing(&self, on_plate: &[Place]) -> Vec<(Shape, Vec<[i32; 2]>)> {
        let of = |shape: &Shape| {
            let copies = on_plate
                .iter()
                .filter(|place| place.item == shape.model && place.turns == shape.turns);
            let offsets: Vec<_> = copies.map(|place| place.offset).collect();
            (!offsets.is_empty()).then(|| (shape.clone(), offsets))
        };
        self.shapes.iter().filter_map(of).collect()
    }

    fn plate_report(
        &self,
        options: &PlateOptions,
        job: &Job,
        screen: &Screen,
        on_plate: &[Place],
        planned: &Planned,
    ) -> Result<PlateReport, Error> {
        let mut models = Vec::new();
        let mut sharers = Vec::new();
        for same in on_plate.chunk_by(|a, b| a.item == b.item) {
            let model = same[0].item;
            let shapes = self.shapes.iter().filter(|shape| {
                shape.model == model && same.iter().any(|place| place.turns == shape.turns)
            });
            let shapes: Vec<&Shape> = shapes.collect();
            let sampled = &shapes[0].measured.of;
            let pose = pose_of(options, job, model);
            sharers.push(Sharer {
                height_mm: sampled.height_mm,
                shadow_mm2: self.outline(model, &pose, 0, screen)?.area_mm2,
                copies: same.len(),
            });
            let parts = shapes
                .iter()
                .map(|shape| Part::alone(shape.measured.of.height_mm, &shape.measured.shapes));
            let planning = Planning::new(parts.collect(), &planned.layering);
            models.push(PlateModelReport {
                model,
                file: self.models[model].file.clone(),
                options: options.of_model(model),
                weights_crc32: self.models[model].weights_crc32(),
                copies: same.len(),
                size_mm: self.size_mm(options, job, model)?,
                layers: layers_reaching(&planned.plan, sampled.height_mm),
                resin_ml: sampled.solid.volume_mm3 / 1e3,
                print_time_s: 0.0,
                max_error: planning.max_error(&planned.plan),
                max_deviation_mm: planning.max_deviation_mm(&planned.plan),
                warnings: sampled.warnings.clone(),
            });
        }
        let shares_s = time_shares_s(&planned.plan, &planned.layering.resin, &sharers);
        for (model, share_s) in models.iter_mut().zip(shares_s) {
            model.print_time_s = share_s;
        }
        Ok(PlateReport {
            plate: 0,
            plates: 0,
            models,
            placements: on_plate
                .iter()
                .map(|place| placement(screen, place))
                .collect(),
            spacing_mm: options.arranging.spacing_mm,
        })
    }

    fn current(&mut self, plate: usize) -> Result<&mut Current, Error> {
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
        let (masks, cursors) = current.seen();
        Ok(masks.whole(cursors, layer))
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
        let mirrored = current
            .job
            .output
            .is_mirrored
            .then(|| current.masks(Side::Below));
        if mirrored.is_none() {
            current.seen();
        }
        let Current {
            planned,
            offsets,
            job,
            report,
            seen,
        } = current;
        let masks = mirrored.as_ref().or(seen.as_ref().map(|seen| &seen.0));
        let masks = masks.ok_or(Error::NoPlan)?;
        let look = || look_of(planned, offsets);
        let mut within = |fraction| progress(Stage::Masks, fraction);
        let writer = write_print(
            planned,
            &job.output,
            report,
            masks,
            &look,
            writer,
            &mut within,
        )?;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }
}

impl Current {
    fn masks(&self, side: Side) -> PlateMasks {
        let stamps = self
            .offsets
            .iter()
            .enumerate()
            .map(|(model, offsets)| Stamp {
                masks: self.planned.masks(model, side),
                offsets: match side {
                    Side::Above => offsets.clone(),
                    Side::Below => offsets
                        .iter()
                        .map(|&[right, down]| [-right, down])
                        .collect(),
                },
            });
        PlateMasks {
            grid: self.planned.first().of.grid,
            stamps: stamps.collect(),
        }
    }

    fn seen(&mut self) -> &mut (PlateMasks, Vec<MaskCursor>) {
        if self.seen.is_none() {
            let masks = self.masks(Side::Above);
            let cursors = masks
                .stamps
                .iter()
                .map(|stamp| stamp.masks.cursor())
                .collect();
            self.seen = Some((masks, cursors));
        }
        self.seen.as_mut().expect("it was just made")
    }
}

/// The plate seen from above.
fn look_of(planned: &Planned, offsets: &[Vec<[i32; 2]>]) -> Look {
    let mut copies = Vec::new();
    for (model, offsets) in planned.models.iter().zip(offsets) {
        let Sampled {
            mesh,
            ldi,
            grid,
            sampling,
            ..
        } = model.sampled();
        let rays = sampling.samples.rays();
        let first = grid.refined(rays).offset_of(&ldi.grid);
        copies.extend(offsets.iter().map(|offset| Seen {
            mesh,
            ldi,
            first_ray: [0, 1].map(|axis| {
                i64::from(first[axis]) + i64::from(offset[axis]) * i64::from(rays[axis])
            }),
        }));
    }
    Look::of_copies(&copies)
}

/// The pose of a model before turns.
fn pose_of(options: &PlateOptions, job: &Job, model: usize) -> Pose {
    let own = options.of_model(model);
    let shared = &job.sampling.pose;
    Pose {
        rotation: own.rotation.or(shared.rotation),
        height_mm: own.height_mm.or(shared.height_mm),
    }
}

/// The screen that the plate has.
fn screen_of(sampling: &Sampling) -> Result<Screen, ArrangeError> {
    match sampling.raster {
        Raster::Plate { pixels, pitch_mm } => Ok(Screen::new(pixels, pitch_mm)),
        _ => Err(ArrangeError::NoSize),
    }
}

fn placement(screen: &Screen, place: &Place) -> Placement {
    let [x_mm, y_mm] = screen.offset_mm(place.offset);
    Placement {
        model: place.item,
        plate: place.plate,
        x_mm,
        y_mm,
        turn_deg: place.turns * TURN_DEG,
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
