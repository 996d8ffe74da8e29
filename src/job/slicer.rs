//! The cache of stages: a loaded model, and the last result of each stage with what it was made from.

use std::io::Write;
use std::sync::Arc;

use glam::Vec3;
use web_time::Instant;

use super::facet_shapes::{Extra, shapes_of};
use super::groups::{ENCODED_SHARE, LayerGroups};
use super::measured::Measured;
use super::parts::{Job, Layering, Output, Sampling};
use super::planned::{Planned, PlannedModel};
use super::planning::Planning;
use super::print::{screen_of, write_print};
use super::report::{Origin, odd_size, report_of};
use super::sampled::{Sampled, Sampler};
use super::stage::{Stage, StageProgress, ms_since, report};
use super::{Error, MeshInfo, Options, Preview, Report, Timings, Tradeoff};
#[cfg(not(target_arch = "wasm32"))]
use super::{memory::Memory, work};
use crate::archive::layer_profile::{self, LayeredModel};
use crate::archive::{Look, MaskSource};
use crate::grid::Bins;
use crate::inspect::{self, Held, Printability};
use crate::ldi::LdiError;
use crate::ldi::gpu::Gpu;
use crate::mask::{MaskCursor, Masks, RunSource, Side};
use crate::model::read::{PartKind, ReadOptions};
use crate::model::{FacetClass, FileFacts, Mesh, ModelFile, Pose, read, saliency, weights};
use crate::orientation::Surface;
use crate::plan::Plan;
use crate::prepare::{Shell, plugs};
use crate::profile::facet_bins::FacetBins;
use crate::profile::{Metric, Profile, Source};
use crate::warning::Warning;

/// A loaded model with the results of the stages. A change of options repeats only the stages that depend on it.
#[derive(Debug)]
pub struct Slicer {
    pub(super) model: Mesh,
    pub(super) facts: FileFacts,
    /// Saliency of each facet of the surface, once computed.
    saliency: Option<Vec<f32>>,
    /// The user's weight of each facet of the surface, if set.
    pub(super) painted: Option<Vec<f32>>,
    load_ms: f64,
    sampler: Sampler,
    /// The surface for orientation searches, and the pose to whose height it is scaled, if it has one.
    pub(super) surface: Option<(Option<Pose>, Surface)>,
    sampled: Option<Arc<Sampled>>,
    measured: Option<Arc<Measured>>,
    current: Option<Current>,
}

/// The last plan, with its output and its report.
#[derive(Debug)]
struct Current {
    planned: Arc<Planned>,
    output: Output,
    report: Report,
    /// The masks seen from above, kept for the next call of [`Slicer::mask`], and a cursor at the last layer that was read.
    seen: Option<(Arc<Masks>, MaskCursor)>,
}

impl Slicer {
    /// Reads a model; of a project with several plates, the first.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn load(bytes: &[u8]) -> Result<Self, Error> {
        Self::load_with(bytes, &ReadOptions::default())
    }

    /// Reads a model with choices.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn load_with(bytes: &[u8], options: &ReadOptions) -> Result<Self, Error> {
        let clock = Instant::now();
        let contents = read::read_with(bytes, options)?;
        let facts = FileFacts::new(bytes, options, &contents);
        let mut slicer = Self::of_triangles(&contents.triangles, facts)?;
        slicer.model = slicer.model.without(&contents.negative)?;
        slicer.load_ms = ms_since(clock);
        Ok(slicer)
    }

    /// A model that was read elsewhere.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn of_triangles(triangles: &[[Vec3; 3]], facts: FileFacts) -> Result<Self, Error> {
        let clock = Instant::now();
        let model = Mesh::with_caps(triangles, facts.file.curved_caps)?;
        Ok(Self {
            model,
            facts,
            saliency: None,
            painted: None,
            load_ms: ms_since(clock),
            sampler: Sampler::default(),
            surface: None,
            sampled: None,
            measured: None,
            current: None,
        })
    }

    /// Samples on `gpu` from now on, unless the options ask for the CPU.
    #[must_use]
    pub fn with_gpu(mut self, gpu: Gpu) -> Self {
        self.sampler.set_gpu(gpu);
        self
    }

    /// Takes no more than about this many bytes from now on, as far as that is possible: hits and masks that do not fit are found anew
    /// when they are needed, and print files are the same. See [`Error::MemoryBound`] for what is not possible.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_memory(mut self, bytes: u64) -> Self {
        self.sampler.set_memory(Memory::of(bytes));
        self
    }

    /// Plans nothing from now on that is certain to take more processor time than this, in seconds: see [`Error::TimeBound`]. Whoever
    /// must keep to it also cancels by progress.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_cpu_time(mut self, seconds: f64) -> Self {
        self.sampler.set_cpu_time(seconds);
        self
    }

    /// Searches in advance for the GPU that the next plan on [`Backend::Gpu`](super::Backend::Gpu) would search for. Drivers may
    /// write to stderr during a search, and here a caller can silence them. The plan reports what was found.
    pub async fn open_gpu(&mut self) {
        self.sampler.open_gpu().await;
    }

    /// Describes the model in the frame of its file.
    pub fn info(&self) -> MeshInfo {
        let mut info = MeshInfo::of(&self.model);
        info.unit = self.facts.unit;
        info.warnings
            .extend(self.file_warnings(&Options::default()));
        info
    }

    /// What to know about the file, given these options.
    pub(super) fn file_warnings(&self, options: &Options) -> Vec<Warning> {
        let objects = self.facts.skipped_objects;
        let skipped = (objects > 0).then_some(Warning::SkippedObjects { objects });
        let is_open = self.facts.unit.or(options.unit).is_none() && options.height_mm.is_none();
        let odd = is_open.then(|| odd_size(&self.model)).flatten();
        let stated = self
            .facts
            .unit
            .zip(options.unit)
            .filter(|(stated, given)| stated != given);
        let ignored = stated.map(|(stated, given)| Warning::UnitStated { stated, given });
        let parts = self.facts.parts.iter().map(|part| match part.kind {
            PartKind::Negative => Warning::SubtractedPart {
                name: part.name.clone(),
            },
            kind => Warning::SkippedPart {
                name: part.name.clone(),
                kind,
            },
        });
        let plate = self.facts.file.plate.map(|plate| Warning::OtherPlates {
            plate_number: plate.plate_number,
            plates: plate.plates,
        });
        let skipped = skipped.into_iter().chain(plate).chain(parts);
        skipped.chain(odd).chain(ignored).collect()
    }

    /// Resolves options for this model. A unit that the file states beats theirs.
    pub(super) fn job(&self, options: &Options) -> Result<Job, Error> {
        let mut job = options.resolve()?;
        if self.facts.unit.is_some() {
            job.sampling.pose.unit = None;
        }
        Ok(job)
    }

    /// The identity of the model's file.
    pub fn model_file(&self) -> &ModelFile {
        &self.facts.file
    }

    /// Vertex positions of the surface facets, nine numbers per facet, in millimetres, in the file's frame.
    pub fn positions(&self) -> Vec<f32> {
        surface_positions(&self.model)
    }

    /// The mesh that the last plan was made for: on the plate, with its voids and supports.
    pub fn prepared(&self) -> Option<&Mesh> {
        let planned = &self.current.as_ref()?.planned;
        Some(planned.models.first()?.sampled().mesh())
    }

    /// Vertex positions of the last plan's facets of a class, nine numbers per facet, in millimetres from the plate.
    pub fn positions_of(&self, class: FacetClass) -> Vec<f32> {
        let mesh = self.prepared();
        mesh.map_or_else(Vec::new, |mesh| positions_of(mesh, class))
    }

    /// A plug for each drain hole of the last plan, if it has any.
    pub fn plugs(&self) -> Option<Shell> {
        let planned = &self.current.as_ref()?.planned;
        let prepared = &planned.models.first()?.sampled().prepared;
        let drains = &prepared.hollowed.as_ref()?.drains;
        (!drains.is_empty()).then(|| plugs(drains))
    }

    /// Vertex positions of [`Self::plugs`], as those of [`Self::positions_of`]; none without holes.
    pub fn plug_positions(&self) -> Vec<f32> {
        let plugs = self.plugs().unwrap_or_default();
        positions(&plugs.vertices, &plugs.facets)
    }

    /// Vertex positions of the surface facets, nine numbers per facet, in millimetres, with the model on the plate in this
    /// pose: its lowest point at z = 0, and centred on x = y = 0.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn positions_on_plate(&self, pose: &Pose) -> Result<Vec<f32>, Error> {
        let unit = pose.unit.filter(|_| self.facts.unit.is_none());
        Ok(surface_positions(
            &self.model.on_plate(&Pose { unit, ..*pose })?,
        ))
    }

    /// Sets a weight from 0 to 1 for each facet of the surface, or removes all weights. Later plans use them.
    ///
    /// # Errors
    /// [`Error::Weights`].
    pub fn set_weights(&mut self, weights: Option<Vec<f32>>) -> Result<(), Error> {
        if let Some(weights) = &weights {
            weights::check(weights, self.model.surface_facets)?;
        }
        self.painted = weights;
        Ok(())
    }

    /// The saliency of each facet of the surface, 0 to 1: how much it stands out. It is the same in every pose.
    ///
    /// # Errors
    /// [`Error::Ldi`] if `progress` cancels; [`Error::TimeBound`].
    pub fn saliency(&mut self, progress: &mut StageProgress<'_>) -> Result<&[f32], Error> {
        let saliency = if let Some(saliency) = self.saliency.take() {
            saliency
        } else {
            #[cfg(not(target_arch = "wasm32"))]
            if let Some(allowed_s) = self.sampler.cpu_time_s() {
                work::check_saliency(&self.model, allowed_s)?;
            }
            let mut within = |fraction| progress(Stage::Saliency, fraction);
            saliency::saliency(&self.model, &mut within).map_err(LdiError::from)?
        };
        Ok(self.saliency.insert(saliency))
    }

    /// The weight of each facet of the surface: the product of the user's weight and of saliency (section 4.2), as far as
    /// these are set, but at least the minimum weight. `None` if neither is set.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`], and those of [`Self::saliency`].
    pub fn weights(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Option<Vec<f32>>, Error> {
        self.layering_weights(&options.resolve()?.layering, progress)
    }

    /// CRC-32 of the user's weights, if any.
    pub(super) fn weights_crc32(&self) -> Option<u32> {
        self.painted.as_deref().map(weights::crc_of)
    }

    pub(super) fn layering_weights(
        &mut self,
        layering: &Layering,
        progress: &mut StageProgress<'_>,
    ) -> Result<Option<Vec<f32>>, Error> {
        if layering.saliency {
            self.saliency(progress)?;
        }
        Ok(self.known_weights(layering))
    }

    /// The weights from what is known. Saliency that is not computed yet is left out.
    fn known_weights(&self, layering: &Layering) -> Option<Vec<f32>> {
        let saliency = self.saliency.as_ref().filter(|_| layering.saliency);
        if saliency.is_none() && self.painted.is_none() {
            return None;
        }
        let least = layering.weight_min as f32;
        let of = |weights: Option<&Vec<f32>>, facet: usize| weights.map_or(1.0, |it| it[facet]);
        let weight = |facet| {
            let product = of(saliency, facet) * of(self.painted.as_ref(), facet);
            if product < least { least } else { product }
        };
        Some((0..self.model.surface_facets).map(weight).collect())
    }

    /// Plans the model in its pose from the facets alone, and returns the plan with the exact profile. Without rays, facets
    /// inside the solid count as well, and layers may have any thickness within the limits. The last plan is kept.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Plan`], [`Error::Options`].
    pub fn preview(&self, options: &Options) -> Result<(Preview, Profile), Error> {
        let Job {
            sampling, layering, ..
        } = &self.job(options)?;
        let mut mesh = self.model.on_plate(&sampling.pose)?;
        mesh.lift(sampling.lift_mm());
        let size = mesh.bounds().size();
        let height_mm = sampling.height_mm(size.z);
        let bins = Bins::of_height(height_mm, layering.bin_mm)?;
        let facet_bins = FacetBins::of(&mesh, bins);
        let extra = || Ok::<_, Error>(Extra::of(&mesh, layering.metric, bins));
        let weights = self.known_weights(layering);
        let shapes = shapes_of(&facet_bins, extra, layering, weights)?;
        let planning = Planning::alone(height_mm, &shapes, layering);
        let plan = planning.plan_freely()?;
        let preview = Preview {
            layers: plan.layers(),
            size_mm: size.to_array(),
            lift_mm: sampling.lift_mm(),
            z_mm: plan.z_mm(),
            thickness_mm: plan.thickness_mm(),
            metric: layering.metric,
            max_error: planning.max_error(&plan),
            print_time_s: plan.print_time_s(&layering.resin),
            bin_mm: bins.size_mm,
            layer_range_mm: layering.layer_range_mm(bins),
        };
        Ok((preview, shapes.profile(layering.metric, Source::Exact)))
    }

    /// Samples the model, makes its profile and plans its layers. Repeats only what a change of options affects. After an
    /// error there is no plan; the LDI is kept if it is still valid.
    ///
    /// # Errors
    /// Any [`Error`] of these stages.
    pub async fn plan(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        let last = self.current.take();
        let job = self.job(options)?;
        // Old rays are freed before new ones are sampled.
        let last = last.filter(|last| last.planned.first().of.sampling == job.sampling);
        let mut timings = Timings {
            load: self.load_ms,
            ..Timings::default()
        };
        let measured = self.measure(&job, &mut timings, progress).await?;

        report(progress, Stage::Plan, 0.0)?;
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(allowed_s) = self.sampler.cpu_time_s() {
            work::check_plan(measured.shapes.bins(), &job.layering, allowed_s)?;
        }
        let holds = |Current { planned, .. }: &Current| {
            Arc::ptr_eq(planned.first(), &measured) && planned.layering == job.layering
        };
        let (planned, seen) = if let Some(kept) = last.filter(holds) {
            (kept.planned, kept.seen)
        } else {
            let clock = Instant::now();
            let planned = Planned::new(
                vec![PlannedModel::alone(&measured)],
                &job.layering,
                &mut |fraction| progress(Stage::Plan, fraction),
            );
            let planned = planned.map_err(|error| options.typeable(error))?;
            timings.plan = ms_since(clock);
            (Arc::new(planned), None)
        };
        report(progress, Stage::Plan, 1.0)?;

        timings.sum_up();
        self.load_ms = 0.0;
        let origin = Origin {
            file: &self.facts.file,
            options,
            painted: self.painted.as_deref(),
            states_unit: self.facts.unit.is_some(),
            warnings: self.file_warnings(options),
        };
        let report = report_of(&planned, &job.output, origin, timings);
        let current = Current {
            planned,
            output: job.output,
            report,
            seen,
        };
        Ok(&self.current.insert(current).report)
    }

    /// The best plans for `points` tolerances, from the smallest that a plan keeps to the largest that makes a difference.
    /// The last plan is kept.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn tradeoff(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Tradeoff, Error> {
        let job = self.job(options)?;
        let mut timings = Timings::default();
        let measured = self.measure(&job, &mut timings, progress).await?;
        report(progress, Stage::Plan, 0.0)?;
        let points = Planning::of(&measured, &job.layering).tradeoff(points)?;
        report(progress, Stage::Plan, 1.0)?;
        Ok(Tradeoff { points })
    }

    /// Samples the model and measures its shape, or reuses results that are still valid. The last plan keeps the rays that
    /// it was made from.
    pub(super) async fn measure(
        &mut self,
        job: &Job,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Arc<Measured>, Error> {
        let Job {
            sampling, layering, ..
        } = job;
        let weights = self.layering_weights(layering, progress)?;
        let sampled = self.sample(sampling, weights.as_deref(), timings, progress);
        let sampled = sampled.await?;

        report(progress, Stage::Profile, 0.0)?;
        let clock = Instant::now();
        let kept = self.measured.take();
        let mut within = |fraction| progress(Stage::Profile, fraction);
        let measured = Measured::new(&sampled, layering, weights, kept.clone(), &mut within)?;
        if !kept.is_some_and(|kept| Arc::ptr_eq(&kept, &measured)) {
            timings.profile = ms_since(clock);
        }
        self.measured = Some(Arc::clone(&measured));
        Ok(measured)
    }

    async fn sample(
        &mut self,
        sampling: &Sampling,
        weights: Option<&[f32]>,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Arc<Sampled>, Error> {
        let spared = sampling.spared(weights);
        // Old rays are freed before new ones are sampled.
        let kept = match self.sampled.take() {
            Some(kept) if kept.is_of(sampling, spared) => {
                return Ok(Arc::clone(self.sampled.insert(kept)));
            }
            kept => kept.map(|kept| Arc::clone(&kept.prepared)),
        };
        self.measured = None;
        let sampled = self
            .sampler
            .sample(&self.model, sampling, spared, kept, timings, progress);
        Ok(Arc::clone(self.sampled.insert(Arc::new(sampled.await?))))
    }

    /// The profile of a metric, in the bins of the last plan, or of the last measurement if there is no plan.
    ///
    /// # Errors
    /// [`Error::NoPlan`], also for a metric of areas if no plan has measured them.
    pub fn profile(&self, metric: Metric, source: Source) -> Result<Profile, Error> {
        let planned = self.current.as_ref().map(|current| current.planned.first());
        let mut measured = planned.into_iter().chain(&self.measured);
        let has_it =
            |measured: &&Arc<Measured>| measured.shapes.has_areas() || !metric.needs_areas();
        let measured = measured.find(has_it).ok_or(Error::NoPlan)?;
        Ok(measured.shapes.profile(metric, source))
    }

    /// The model on the plate, with holes closed, and the layers of the last plan.
    ///
    /// # Errors
    /// [`Error::NoPlan`].
    pub fn planned(&self) -> Result<(&Mesh, &Plan), Error> {
        let current = self.current.as_ref().ok_or(Error::NoPlan)?;
        Ok((current.planned.first().of.mesh(), &current.planned.plan))
    }

    /// The mask of a layer of the last plan: see [`MaskCursor::whole`].
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::NoLayer`].
    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, Error> {
        let current = self.current.as_mut().ok_or(Error::NoPlan)?;
        let layers = current.planned.plan.layers();
        if layer >= layers {
            return Err(Error::NoLayer { layer, layers });
        }
        let (masks, cursor) = current.seen()?;
        cursor.seek(masks, layer);
        Ok(cursor.whole(masks))
    }

    /// What will fail when the last plan is printed, by these limits.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Limits`]; [`Error::Ldi`] if `progress` cancels.
    pub fn inspect(
        &mut self,
        limits: &inspect::Limits,
        progress: &mut StageProgress<'_>,
    ) -> Result<Printability, Error> {
        limits.check()?;
        let current = self.current.as_mut().ok_or(Error::NoPlan)?;
        let planned = Arc::clone(&current.planned);
        let (masks, _) = current.seen()?;
        let mut progress = |fraction| progress(Stage::Inspect, fraction);
        let sampled = planned.models.first().map(PlannedModel::sampled);
        let held = sampled.map_or_else(Held::default, |sampled| sampled.held(limits));
        let found = inspect::inspect(masks, &planned.plan, limits, &held, &mut progress);
        Ok(found.map_err(LdiError::from)?)
    }

    /// Gives the layers of the last plan exposures of their own, in seconds.
    pub(super) fn expose(&mut self, exposure_s: Vec<f64>) {
        if let Some(Current { report, .. }) = &mut self.current {
            report.print_time_s = report.resin.time_s(&exposure_s);
            report.exposure_s = exposure_s;
        }
    }

    /// The masks of the last plan's print file in groups, for others to encode; `None` if the file has no masks, or they have to be
    /// read slab by slab.
    ///
    /// # Errors
    /// [`Error::NoPlan`].
    pub fn layer_groups(&mut self) -> Result<Option<LayerGroups>, Error> {
        let current = self.current.as_mut().ok_or(Error::NoPlan)?;
        let is_held = current.planned.first().of.bound().is_none();
        if current.output.filament.is_some() || !is_held {
            return Ok(None);
        }
        let canvas = screen_of(&current.planned, &current.output).canvas();
        let layers = current.report.layers;
        let format = current.output.format;
        Ok(Some(LayerGroups::new(
            current.shown()?,
            layers,
            format,
            canvas,
        )))
    }

    /// Writes the print file of the last plan in the format of its options. Returns the writer, and the report with the time
    /// that this took.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Archive`].
    pub fn write_archive<W: Write>(
        &mut self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.write_archive_of(None, writer, progress)
    }

    /// [`Self::write_archive`] of layers that others have encoded, if that is how they are given: `encoded` fetches a group of
    /// [`Self::layer_groups`], counted from 0, as [`archive::encode_group`](crate::archive::encode_group) encodes it.
    ///
    /// # Errors
    /// Those of [`Self::write_archive`].
    pub fn write_archive_of<W: Write>(
        &mut self,
        encoded: Option<&dyn Fn(usize) -> Vec<u8>>,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        let clock = Instant::now();
        let current = self.current.as_mut().ok_or(Error::NoPlan)?;
        let encoded_share = encoded.map_or(0.0, |_| ENCODED_SHARE);
        let mut mask_progress = |fraction| {
            let fraction = encoded_share + (1.0 - encoded_share) * fraction;
            progress(Stage::Masks, fraction)
        };
        if let Some(filament) = current.output.filament {
            let report = &mut current.report;
            let model = LayeredModel {
                mesh: current.planned.first().of.mesh(),
                z_mm: &report.z_mm,
                first_layer_mm: filament.first_layer_mm,
            };
            let writer = layer_profile::write(filament.slicer, &model, writer, &mut mask_progress)?;
            report.timings_ms.masks = ms_since(clock);
            report.timings_ms.sum_up();
            return Ok((writer, report));
        }
        let of = Arc::clone(&current.planned);
        let runs: Box<dyn RunSource>;
        let masks = if let Some(encoded) = encoded {
            MaskSource::Encoded(encoded)
        } else {
            runs = if of.first().of.bound().is_none() {
                Box::new(current.shown()?)
            } else {
                of.runs(0, current.output.side())?
            };
            MaskSource::Runs(&*runs)
        };
        let Current {
            planned,
            output,
            report,
            ..
        } = current;
        let sampled = &planned.first().of;
        let look = || Look::new(sampled.mesh(), sampled.image());
        let writer = write_print(
            planned,
            output,
            report,
            masks,
            &look,
            writer,
            &mut mask_progress,
        )?;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }
}

impl Current {
    /// The masks seen from above, and a cursor at the last layer that was read.
    fn seen(&mut self) -> Result<&mut (Arc<Masks>, MaskCursor), Error> {
        let seen = if let Some(seen) = self.seen.take() {
            seen
        } else {
            let masks = self.planned.masks(0, Side::Above)?;
            let cursor = masks.cursor();
            (Arc::new(masks), cursor)
        };
        Ok(self.seen.insert(seen))
    }

    /// The masks as the printer shows them.
    fn shown(&mut self) -> Result<Arc<Masks>, Error> {
        Ok(match self.output.side() {
            Side::Below => Arc::new(self.planned.masks(0, Side::Below)?),
            Side::Above => Arc::clone(&self.seen()?.0),
        })
    }
}

/// Vertex positions of the surface facets.
fn surface_positions(mesh: &Mesh) -> Vec<f32> {
    positions(&mesh.vertices, &mesh.facets[..mesh.surface_facets])
}

/// Vertex positions of a mesh's facets of a class.
pub(super) fn positions_of(mesh: &Mesh, class: FacetClass) -> Vec<f32> {
    positions(&mesh.vertices, mesh.of_class(class))
}

/// Vertex positions of facets, nine numbers per facet.
fn positions(vertices: &[Vec3], facets: &[[u32; 3]]) -> Vec<f32> {
    let facets = facets.iter();
    let corners = facets.flatten().map(|&vertex| vertices[vertex as usize]);
    corners.flat_map(|corner| corner.to_array()).collect()
}
