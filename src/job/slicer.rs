//! The order of stages, and nothing else: the only module that knows it.

use std::io::Write;
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;
use web_time::Instant;

use super::planning::{PlanReport, Planning, shapes_of};
use super::report::mesh_warnings;
use super::resolve::{Job, Layering, Sampling};
use super::{
    Backend, Comparison, Error, MaskReport, MeshInfo, Options, Preview, PrintFileReport, Report,
    SCHEMA, Timings, Tradeoff,
};
use crate::archive::{self, ArchiveError, PrintJob};
use crate::grid::{Bins, Grid};
use crate::ldi::gpu::{self, Gpu};
use crate::ldi::{Ldi, LdiError, Solid, cpu};
use crate::mask::{MaskCursor, Masks, Side, black_layers};
use crate::model::read::stl;
use crate::model::{Mesh, ModelFile, Pose};
use crate::model::{saliency, weights};
use crate::orientation::Surface;
use crate::plan::Plan;
use crate::profile::facet_bins::FacetBins;
use crate::profile::shapes::Shapes;
use crate::profile::{Metric, Profile, Source, section};
use crate::progress::Progress;
use crate::warning::Warning;

/// A part of the work, for showing progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Reading the STL.
    Load,
    /// Finding what stands out.
    Saliency,
    /// Searching for the best orientation.
    Orientation,
    /// Sampling the layered depth image.
    Ldi,
    /// Making the profile.
    Profile,
    /// Planning.
    Plan,
    /// Making and writing the masks.
    Masks,
}

impl Stage {
    /// The name of the stage, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Saliency => "saliency",
            Self::Orientation => "orientation",
            Self::Ldi => "ldi",
            Self::Profile => "profile",
            Self::Plan => "plan",
            Self::Masks => "masks",
        }
    }
}

/// Called with the stage at work and the fraction of it that is done; `Break` cancels.
pub type StageProgress<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

/// A loaded model on its way through the stages. Each keeps its result, so that a change of options
/// repeats only what depends on it.
#[derive(Debug)]
pub struct Slicer {
    pub(super) model: Mesh,
    pub(super) file: ModelFile,
    /// How much each facet of the surface stands out, once that was asked for.
    saliency: Option<Vec<f32>>,
    /// How much each facet of the surface matters to the user.
    pub(super) painted: Option<Vec<f32>>,
    load_ms: f64,
    /// What the last search for a GPU found, if it is still to be used.
    gpu: Option<Result<Gpu, LdiError>>,
    /// The surface for being looked at along directions, and the pose whose height it is scaled to, if one is asked for.
    pub(super) surface: Option<(Option<Pose>, Surface)>,
    sampled: Option<Arc<Sampled>>,
    measured: Option<Measured>,
    planned: Option<Planned>,
}

/// The model on the plate and its rays. Nothing in it changes, so that whoever holds it can be given no other rays.
#[derive(Debug)]
struct Sampled {
    sampling: Sampling,
    mesh: Mesh,
    height_mm: f64,
    /// The masks' pixels; the LDI has rays only where the model is.
    grid: Grid,
    ldi: Ldi,
    solid: Solid,
    adapter: Option<String>,
    warnings: Vec<Warning>,
}

/// What was measured of a sampled model last.
#[derive(Debug)]
struct Measured {
    of: Arc<Sampled>,
    shapes: Shapes,
}

/// What a plan is made from.
#[derive(Clone, Copy)]
struct Origin<'a> {
    file: &'a ModelFile,
    options: &'a Options,
    painted: Option<&'a [f32]>,
}

/// A plan with the rays that it was made from: its masks are made from no others.
#[derive(Debug)]
struct Planned {
    of: Arc<Sampled>,
    job: Job,
    plan: Plan,
    report: Report,
    masks: Option<(Masks, MaskCursor)>,
}

impl Slicer {
    /// Reads an STL.
    ///
    /// # Errors
    /// [`Error::Stl`], [`Error::Mesh`].
    pub fn load(bytes: &[u8]) -> Result<Self, Error> {
        let clock = Instant::now();
        let model = Mesh::from_triangles(&stl::read(bytes)?)?;
        Ok(Self {
            model,
            file: ModelFile {
                bytes: bytes.len(),
                crc32: rawzip::crc32(bytes),
            },
            saliency: None,
            painted: None,
            load_ms: ms_since(clock),
            gpu: None,
            surface: None,
            sampled: None,
            measured: None,
            planned: None,
        })
    }

    /// Samples on `gpu` from now on, where the options do not ask for the CPU.
    #[must_use]
    pub fn with_gpu(mut self, gpu: Gpu) -> Self {
        self.gpu = Some(Ok(gpu));
        self
    }

    /// Searches for the GPU that the next plan with this `backend` would search for, so that the plan need not: drivers may
    /// write to stderr while they are asked, and the caller knows when. That plan says what was found.
    pub async fn open_gpu(&mut self, backend: Backend) {
        if self.gpu.is_none() {
            self.gpu = Some(search_gpu(backend).await);
        }
    }

    /// Describes the model as it stands in its file.
    pub fn info(&self) -> MeshInfo {
        MeshInfo::of(&self.model)
    }

    /// What the model's file is known by.
    pub fn model_file(&self) -> &ModelFile {
        &self.file
    }

    /// Corners of the facets of the surface, nine numbers a facet, in millimetres as they stand in the file.
    pub fn positions(&self) -> Vec<f32> {
        positions(&self.model)
    }

    /// The same as the model stands on the plate, upward from z = 0 and centred on x = y = 0.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn positions_on_plate(&self, pose: &Pose) -> Result<Vec<f32>, Error> {
        Ok(positions(&self.model.on_plate(pose)?))
    }

    /// Says how much each facet of the surface matters, from 0 to 1; all alike if that is absent. Later plans follow it.
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

    /// How much each facet of the surface stands out, from 0 to 1; the same in every pose.
    ///
    /// # Errors
    /// [`Error::Ldi`] if `progress` cancels.
    pub fn saliency(&mut self, progress: &mut StageProgress<'_>) -> Result<&[f32], Error> {
        let saliency = match self.saliency.take() {
            Some(saliency) => saliency,
            None => saliency::saliency(&self.model, &mut |fraction| {
                progress(Stage::Saliency, fraction)
            })
            .map_err(LdiError::from)?,
        };
        Ok(self.saliency.insert(saliency))
    }

    /// What each facet of the surface counts for: the product of paint and saliency (section 4.2), at least the least weight.
    /// `None` if all count alike.
    ///
    /// # Errors
    /// Those of [`Self::saliency`].
    pub fn weights(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Option<Vec<f32>>, Error> {
        self.layering_weights(&options.resolve()?.layering, progress)
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

    /// The same without computing any saliency that is not there yet.
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

    /// The plan of the model in a pose and its profile, from the facets alone: no rays, so that facets inside the solid
    /// count as well. Makes no plan, and leaves the last one.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Plan`], [`Error::Options`].
    pub fn preview(&self, options: &Options) -> Result<(Preview, Profile), Error> {
        let Job {
            sampling, layering, ..
        } = &options.resolve()?;
        let mesh = self.model.on_plate(&sampling.pose)?;
        let size = mesh.bounds().size();
        let height_mm = sampling.height_mm(size.z);
        let bins = Bins::of_height(height_mm, layering.bin_mm)?;
        let facet_bins = FacetBins::of(&mesh, bins);
        let areas_mm2 = || Ok::<_, Error>(section::exact(&mesh, &[], bins));
        let weights = self.known_weights(layering);
        let shapes = shapes_of(&facet_bins, areas_mm2, layering, weights)?;
        let planning = Planning::new(height_mm, &shapes, layering);
        let plan = planning.plan()?;
        let preview = Preview {
            layers: plan.layers(),
            size_mm: size.to_array(),
            z_mm: plan.z_mm(),
            thickness_mm: plan.thickness_mm(),
            metric: layering.metric,
            max_error: planning.max_error(&plan),
            print_time_s: plan.print_time_s(&layering.resin),
            bin_mm: bins.size_mm,
        };
        Ok((preview, shapes.profile(layering.metric, Source::Exact)))
    }

    /// Samples the model, makes its profile and plans its layers; repeats only what the options
    /// change. After an error the last plan is gone, the LDI is kept where it still holds.
    ///
    /// # Errors
    /// Any [`Error`] of these stages.
    pub async fn plan(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        self.planned = None;
        let job = options.resolve()?;
        let mut timings = Timings {
            load: self.load_ms,
            ..Timings::default()
        };
        let measured = self.measure(&job, &mut timings, progress).await?;

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let planning = measured.planning(&job.layering);
        let plan = planning.plan()?;
        let figures = planning.report(&plan)?;
        timings.plan = ms_since(clock);
        continue_or_cancel(progress(Stage::Plan, 1.0))?;

        timings.sum_up();
        let of = Arc::clone(&measured.of);
        self.load_ms = 0.0;
        let origin = Origin {
            file: &self.file,
            options,
            painted: self.painted.as_deref(),
        };
        let report = of.report(origin, &job, &plan, figures, timings);
        let planned = Planned {
            of,
            job,
            plan,
            report,
            masks: None,
        };
        Ok(&self.planned.insert(planned).report)
    }

    /// Best plans for `points` tolerances, from the tightest that can be held to the loosest that saves a layer. Makes
    /// no plan, and leaves the last one.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn tradeoff(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Tradeoff, Error> {
        let job = options.resolve()?;
        let mut timings = Timings::default();
        let measured = self.measure(&job, &mut timings, progress).await?;
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let points = measured.planning(&job.layering).tradeoff(points)?;
        continue_or_cancel(progress(Stage::Plan, 1.0))?;
        Ok(Tradeoff { points })
    }

    /// The plans of all planners side by side (table 3). Makes no plan, and leaves the last one.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn compare(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Comparison, Error> {
        let job = options.resolve()?;
        let mut timings = Timings::default();
        let measured = self.measure(&job, &mut timings, progress).await?;
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let rows = measured.planning(&job.layering).compare()?;
        continue_or_cancel(progress(Stage::Plan, 1.0))?;
        let metric = job.layering.metric;
        Ok(Comparison {
            facets: measured.of.mesh.surface_facets,
            height_mm: measured.of.height_mm,
            metric,
            unit: metric.unit().to_owned(),
            rows,
        })
    }

    /// Samples the model and measures its shape, unless what is there still holds. Leaves the last plan, which has the rays
    /// that it was made from.
    async fn measure(
        &mut self,
        job: &Job,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Measured, Error> {
        let layering = &job.layering;
        let weights = self.layering_weights(layering, progress)?;
        let kept = self.sampled.take();
        let sampled = if let Some(kept) = kept.filter(|kept| kept.sampling == job.sampling) {
            kept
        } else {
            // Rays that nobody needs any more make room for the new ones.
            self.measured = None;
            Arc::new(self.sample(&job.sampling, timings, progress).await?)
        };
        self.sampled = Some(Arc::clone(&sampled));

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Profile, 0.0))?;
        let bins = Bins::of_height(sampled.height_mm, layering.bin_mm)?;
        let kept = self.measured.take();
        let mut is_new = false;
        let mut shapes = kept
            .filter(|kept| Arc::ptr_eq(&kept.of, &sampled) && kept.shapes.exact.bins == bins)
            .map_or_else(
                || {
                    is_new = true;
                    Shapes::new(&sampled.mesh, &sampled.ldi, bins)
                },
                |kept| kept.shapes,
            );
        if layering.metric.needs_areas() {
            is_new |= shapes.add_areas(&sampled.mesh, &sampled.ldi);
        }
        let facet_bins = || FacetBins::of(&sampled.mesh, bins);
        is_new |= shapes.weigh(facet_bins, Some(&sampled.ldi), layering.metric, weights);
        if is_new {
            timings.profile = ms_since(clock);
        }
        Ok(self.measured.insert(Measured {
            of: sampled,
            shapes,
        }))
    }

    async fn sample(
        &mut self,
        sampling: &Sampling,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Sampled, Error> {
        let clock = Instant::now();
        let mesh = self.model.on_plate(&sampling.pose)?;
        let bounds = mesh.bounds();
        let grid = sampling.grid(&bounds)?;
        timings.load += ms_since(clock);

        let clock = Instant::now();
        let mut ldi_progress = |fraction| progress(Stage::Ldi, fraction);
        let mut warnings = mesh_warnings(&mesh);
        let rays = grid.refined(sampling.samples.rays()).around_model(&bounds);
        rays.check_rays()?;
        let on_gpu = self.sample_on_gpu(&mesh, &rays, sampling.backend, &mut ldi_progress);
        let (ldi, adapter) = match on_gpu.await {
            Ok((ldi, adapter)) => (ldi, Some(adapter)),
            Err(error @ LdiError::Cancelled(_)) => return Err(error.into()),
            Err(error) if sampling.backend == Backend::Gpu => return Err(error.into()),
            Err(error) => {
                warnings.extend(cpu_instead(&error));
                (cpu::sample(&mesh, &rays, &mut ldi_progress)?, None)
            }
        };
        if ldi.hits.is_empty() {
            return Err(LdiError::NoHits {
                pitch_mm: grid.pitch_mm,
            }
            .into());
        }
        let unclosed = ldi.rays_through_holes(&mesh);
        if unclosed > 0 {
            let rays = ldi.rays();
            warnings.push(Warning::UnclosedRays { unclosed, rays });
        }
        timings.ldi = ms_since(clock);
        Ok(Sampled {
            height_mm: sampling.height_mm(bounds.size().z),
            sampling: sampling.clone(),
            mesh,
            grid,
            solid: Solid::of(&ldi),
            ldi,
            adapter,
            warnings,
        })
    }

    /// The LDI by the GPU, and its name. A GPU that failed is not tried again.
    async fn sample_on_gpu(
        &mut self,
        mesh: &Mesh,
        rays: &Grid,
        backend: Backend,
        progress: &mut Progress<'_>,
    ) -> Result<(Ldi, String), LdiError> {
        let found = self.gpu.take_if(|_| backend != Backend::Cpu);
        let gpu = match found {
            Some(found) => found?,
            None => search_gpu(backend).await?,
        };
        let ldi = gpu::sample(mesh, rays, &gpu, gpu::Tiling::default(), progress).await?;
        let name = gpu.name().to_owned();
        self.gpu = Some(Ok(gpu));
        Ok((ldi, name))
    }

    /// The profile of a metric in the bins that the last plan was made from, or was tried on if there is none.
    ///
    /// # Errors
    /// [`Error::NoPlan`], also for a metric of areas if no plan has needed them.
    pub fn profile(&self, metric: Metric, source: Source) -> Result<Profile, Error> {
        let shapes = &self.measured.as_ref().ok_or(Error::NoPlan)?.shapes;
        if metric.needs_areas() && shapes.of(source).areas_mm2.is_empty() {
            return Err(Error::NoPlan);
        }
        Ok(shapes.profile(metric, source))
    }

    /// The mask of a layer of the last plan: see [`MaskCursor::whole`].
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::NoLayer`].
    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, Error> {
        let planned = self.planned.as_mut().ok_or(Error::NoPlan)?;
        let layers = planned.plan.layers();
        if layer >= layers {
            return Err(Error::NoLayer { layer, layers });
        }
        let (masks, cursor) = planned.upright_masks();
        cursor.seek(masks, layer);
        Ok(cursor.whole(masks))
    }

    /// Writes the print file of the last plan in the format that its options ask for, and returns the report with the
    /// time that this took.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Archive`].
    pub fn write_archive<W: Write>(
        &mut self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        let clock = Instant::now();
        let planned = self.planned.as_mut().ok_or(Error::NoPlan)?;
        let mut mask_progress = |fraction| progress(Stage::Masks, fraction);
        let output = planned.job.output.clone();
        let mirrored;
        let masks = if output.is_mirrored {
            mirrored = planned.masks(Side::Below);
            &mirrored
        } else {
            planned.upright_masks();
            let upright = planned.masks.as_ref().ok_or(Error::NoPlan)?;
            &upright.0
        };
        let report = &planned.report;
        let job = PrintJob {
            masks,
            is_mirrored: output.is_mirrored,
            plan: &planned.plan,
            height_mm: report.height_mm,
            exposure_s: &report.exposure_s,
            resin: &planned.job.layering.resin,
            resin_ml: report.resin_ml,
            printer: output.printer,
            mesh: &planned.of.mesh,
            ldi: &planned.of.ldi,
            manifest: &report.manifest().map_err(ArchiveError::write)?,
        };
        let writer = archive::write(output.format, &job, writer, &mut mask_progress)?;
        let report = &mut planned.report;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }
}

impl Planned {
    fn masks(&self, side: Side) -> Masks {
        let Sampled {
            ldi,
            grid,
            sampling,
            ..
        } = &*self.of;
        Masks::new(ldi, &self.plan, grid, sampling.samples, side)
    }

    /// The masks as seen from above, which are kept for the next one who looks, and where that one is.
    fn upright_masks(&mut self) -> &mut (Masks, MaskCursor) {
        let masks = self.masks.take().unwrap_or_else(|| {
            let masks = self.masks(Side::Above);
            let cursor = masks.cursor();
            (masks, cursor)
        });
        self.masks.insert(masks)
    }
}

/// Corners of the facets of the surface, nine numbers a facet.
fn positions(mesh: &Mesh) -> Vec<f32> {
    let facets = mesh.facets[..mesh.surface_facets].iter();
    let corners = facets
        .flatten()
        .map(|&vertex| mesh.vertices[vertex as usize]);
    corners.flat_map(|corner| corner.to_array()).collect()
}

/// The GPU that a backend allows.
async fn search_gpu(backend: Backend) -> Result<Gpu, LdiError> {
    match backend {
        Backend::Cpu => Err(LdiError::NoGpu {
            reason: "the CPU was asked for".to_owned(),
        }),
        Backend::Gpu => Gpu::open(gpu::Adapters::Any).await,
        Backend::Auto => Gpu::open(gpu::Adapters::Hardware).await,
    }
}

impl Measured {
    /// All that planning needs.
    fn planning<'a>(&'a self, layering: &'a Layering) -> Planning<'a> {
        Planning::new(self.of.height_mm, &self.shapes, layering)
    }
}

impl Sampled {
    fn report(
        &self,
        origin: Origin<'_>,
        job: &Job,
        plan: &Plan,
        planned: PlanReport,
        timings_ms: Timings,
    ) -> Report {
        let Job {
            sampling,
            layering,
            output,
        } = job;
        let Origin {
            file,
            options,
            painted,
        } = origin;
        let mut warnings = self.warnings.clone();
        warnings.extend(planned.warnings);
        let black = black_layers(&self.solid, plan, sampling.samples);
        if let Some(&lowest) = black.first() {
            warnings.push(Warning::BlackLayers {
                layers: black.len(),
                from_mm: plan.z_mm()[lowest],
            });
        }
        let thickness_mm = plan.thickness_mm();
        Report {
            schema: SCHEMA,
            model: file.clone(),
            options: options.without_backend(),
            weights_crc32: painted.map(weights::crc_of),
            layers: plan.layers(),
            height_mm: self.height_mm,
            z_mm: plan.z_mm(),
            exposure_s: layering.resin.exposures_s(&thickness_mm),
            overhead_s: layering.resin.overhead_s(),
            resin: layering.resin.clone(),
            thickness_mm,
            resin_ml: self.solid.volume_mm3 / 1e3,
            printer: output.printer.map(|printer| printer.name.to_owned()),
            snapped_mm: planned.snapped_mm,
            metric: layering.metric,
            unit: layering.metric.unit().to_owned(),
            source: layering.source,
            planner: layering.planner.name().to_owned(),
            tolerance: planned.tolerance,
            max_error: planned.max_error,
            sampled_error: planned.sampled_error,
            max_error_mm: planned.max_error_mm,
            print_time_s: planned.print_time_s,
            backend: if self.adapter.is_some() { "gpu" } else { "cpu" }.to_owned(),
            adapter: self.adapter.clone(),
            bins: plan.bins.count,
            bin_mm: plan.bins.size_mm,
            facets: self.mesh.surface_facets,
            hits: self.ldi.hits.len(),
            uniform: planned.uniform,
            mask: MaskReport {
                width: self.grid.width,
                height: self.grid.height,
                pitch_mm: self.grid.pitch_mm,
                pitch_y_mm: self.grid.pitch_y_mm,
                antialias: options.antialias,
                is_mirrored: output.is_mirrored,
            },
            print_file: PrintFileReport::new(output.format, output.printer),
            warnings,
            timings_ms,
        }
    }
}

/// What to tell of a GPU that was to do the work and did not; nothing if there is none.
fn cpu_instead(error: &LdiError) -> Option<Warning> {
    match *error {
        LdiError::NoGpu { .. } => None,
        LdiError::GpuTooSmall {
            needed_bytes,
            limit_bytes,
            ..
        } => Some(Warning::GpuTooSmall {
            needed_bytes,
            limit_bytes,
        }),
        _ => Some(Warning::GpuFailed {
            reason: error.to_string(),
        }),
    }
}

fn continue_or_cancel(flow: ControlFlow<()>) -> Result<(), LdiError> {
    match flow {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(LdiError::Cancelled(crate::progress::Cancelled)),
    }
}

fn ms_since(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64() * 1e3
}
