//! The order of stages, and nothing else: the only module that knows it.

mod orientation;

use std::io::Write;
use std::ops::ControlFlow;

use serde::Serialize;
use web_time::Instant;

use crate::archive::{self, Job};
use crate::direction::Turntable;
use crate::error::Error;
use crate::grid::{Bins, Grid, GridError};
use crate::ldi::gpu::{self, Gpu};
use crate::ldi::{Ldi, LdiError, Solid, cpu};
use crate::mask::{MaskCursor, Masks, Side, black_layers};
use crate::mesh::{Bounds, Mesh, Pose};
use crate::options::{Backend, Options};
use crate::plan::Plan;
use crate::planning::{PlanReport, Planning, Shapes};
use crate::profile::relief::Relief;
use crate::profile::{Metric, Profile, Source, section};
use crate::progress::Progress;
use crate::report::{
    Comparison, Glance, MaskReport, MeshInfo, PrintFileReport, Report, SCHEMA, StlReport, Timings,
    Tradeoff, mesh_warnings,
};
use crate::warning::Warning;
use crate::{saliency, stl, weights};

/// A part of the work, for showing progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Reading the STL.
    Load,
    /// Finding what stands out.
    Saliency,
    /// Searching for the best building direction.
    Directions,
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
            Self::Directions => "directions",
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
    model: Mesh,
    stl: StlReport,
    /// How much each facet of the surface stands out, once that was asked for.
    saliency: Option<Vec<f32>>,
    /// How much each facet of the surface matters to the user.
    paint: Option<Vec<f32>>,
    load_ms: f64,
    /// What the last search for a GPU found, if it is still to be used.
    gpu: Option<Result<Gpu, LdiError>>,
    /// The surface for being looked at along directions, and the pose whose height it is scaled to, if one is asked for.
    turntable: Option<(Option<Pose>, Turntable)>,
    sampled: Option<Sampled>,
    planned: Option<Planned>,
}

/// The model on the plate and its LDI, with the options that they depend on.
#[derive(Debug)]
struct Sampled {
    options: SamplingOptions,
    mesh: Mesh,
    height_mm: f64,
    /// The masks' pixels; the LDI has rays only where the model is.
    grid: Grid,
    ldi: Ldi,
    solid: Solid,
    adapter: Option<String>,
    warnings: Vec<Warning>,
    shapes: Option<Shapes>,
}

type SamplingOptions = (
    Pose,
    Option<String>,
    Option<[u32; 2]>,
    [Option<f64>; 2],
    u32,
    u32,
    Backend,
);

/// What a plan is made from beside its options.
#[derive(Clone, Copy)]
struct Origin<'a> {
    stl: &'a StlReport,
    paint: Option<&'a [f32]>,
}

#[derive(Debug)]
struct Planned {
    options: Options,
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
            stl: StlReport {
                bytes: bytes.len(),
                crc32: rawzip::crc32(bytes),
            },
            saliency: None,
            paint: None,
            load_ms: ms_since(clock),
            gpu: None,
            turntable: None,
            sampled: None,
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
    pub fn stl(&self) -> &StlReport {
        &self.stl
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
    pub fn paint(&mut self, weights: Option<Vec<f32>>) -> Result<(), Error> {
        if let Some(weights) = &weights {
            weights::check(weights, self.model.surface_facets)?;
        }
        self.paint = weights;
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
        if options.saliency {
            self.saliency(progress)?;
        }
        Ok(self.known_weights(options))
    }

    /// The same without computing any saliency that is not there yet.
    fn known_weights(&self, options: &Options) -> Option<Vec<f32>> {
        let saliency = self.saliency.as_ref().filter(|_| options.saliency);
        if saliency.is_none() && self.paint.is_none() {
            return None;
        }
        let least = options.weight_min as f32;
        let of = |weights: Option<&Vec<f32>>, facet: usize| weights.map_or(1.0, |it| it[facet]);
        let weight = |facet| {
            let product = of(saliency, facet) * of(self.paint.as_ref(), facet);
            if product < least { least } else { product }
        };
        Some((0..self.model.surface_facets).map(weight).collect())
    }

    /// The plan of the model in a pose and its profile, from the facets alone: no rays, so that facets inside the solid
    /// count as well. Makes no plan, and leaves the last one.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Plan`], [`Error::Options`].
    pub fn glance(&self, options: &Options) -> Result<(Glance, Profile), Error> {
        options.check()?;
        let mesh = self.model.on_plate(&options.pose())?;
        let size = mesh.bounds().size();
        let height_mm = height_mm(size.z, options);
        let bins = Bins::of_height(height_mm, options.bin_mm)?;
        let relief = Relief::of(&mesh, bins);
        let areas_mm2 = || Ok::<_, Error>(section::exact(&mesh, &[], bins));
        let weights = self.known_weights(options);
        let shapes = shapes_of(&relief, areas_mm2, options, weights)?;
        let planning = Planning::new(height_mm, &shapes, options);
        let plan = planning.plan(options)?;
        let glance = Glance {
            layers: plan.layers(),
            size_mm: size.to_array(),
            z_mm: plan.z_mm(),
            thickness_mm: plan.thickness_mm(),
            metric: options.metric,
            max_error: planning.max_error(&plan),
            print_time_s: plan.print_time_s(&options.resin),
            bin_mm: bins.size_mm,
        };
        Ok((glance, shapes.profile(options.metric, Source::Exact)))
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
        options.check()?;
        let mut timings = Timings {
            load: self.load_ms,
            ..Timings::default()
        };
        self.measure(options, &mut timings, progress).await?;
        let sampled = self.sampled.as_mut().ok_or(Error::NoPlan)?;

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let planning = sampled.planning(options)?;
        let plan = planning.plan(options)?;
        let report = planning.report(options, &plan)?;
        timings.plan = ms_since(clock);
        continue_or_cancel(progress(Stage::Plan, 1.0))?;

        timings.sum_up();
        self.load_ms = 0.0;
        let origin = Origin {
            stl: &self.stl,
            paint: self.paint.as_deref(),
        };
        let report = sampled.report(origin, options, &plan, report, timings)?;
        Ok(&self
            .planned
            .insert(Planned {
                options: options.clone(),
                plan,
                report,
                masks: None,
            })
            .report)
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
        options.check()?;
        self.measure(options, &mut Timings::default(), progress)
            .await?;
        let sampled = self.sampled.as_mut().ok_or(Error::NoPlan)?;
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let points = sampled.planning(options)?.tradeoff(options, points)?;
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
        options.check()?;
        self.measure(options, &mut Timings::default(), progress)
            .await?;
        let sampled = self.sampled.as_mut().ok_or(Error::NoPlan)?;
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let rows = sampled.planning(options)?.compare(options)?;
        continue_or_cancel(progress(Stage::Plan, 1.0))?;
        Ok(Comparison {
            facets: sampled.mesh.surface_facets,
            height_mm: sampled.height_mm,
            metric: options.metric,
            unit: options.metric.unit().to_owned(),
            rows,
        })
    }

    /// Samples the model and measures its shape, unless what is there still holds.
    async fn measure(
        &mut self,
        options: &Options,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<(), Error> {
        let weights = self.weights(options, progress)?;
        let key = sampling_options(options);
        let sampled = match self.sampled.take().filter(|sampled| sampled.options == key) {
            Some(sampled) => sampled,
            None => self.sample(options, timings, progress).await?,
        };
        let sampled = self.sampled.insert(sampled);

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Profile, 0.0))?;
        let bins = Bins::of_height(sampled.height_mm, options.bin_mm)?;
        let kept = sampled.shapes.take();
        let mut is_new = false;
        let mut shapes = kept
            .filter(|shapes| shapes.exact.bins == bins)
            .unwrap_or_else(|| {
                is_new = true;
                Shapes::new(&sampled.mesh, &sampled.ldi, bins)
            });
        if options.metric.needs_areas() {
            is_new |= shapes.add_areas(&sampled.mesh, &sampled.ldi);
        }
        let relief = || Relief::of(&sampled.mesh, bins);
        is_new |= shapes.weigh(relief, Some(&sampled.ldi), options.metric, weights);
        sampled.shapes = Some(shapes);
        if is_new {
            timings.profile = ms_since(clock);
        }
        Ok(())
    }

    async fn sample(
        &mut self,
        options: &Options,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Sampled, Error> {
        let clock = Instant::now();
        let mesh = self.model.on_plate(&options.pose())?;
        let bounds = mesh.bounds();
        let grid = grid(&bounds, options)?;
        timings.load += ms_since(clock);

        let clock = Instant::now();
        let mut ldi_progress = |fraction| progress(Stage::Ldi, fraction);
        let mut warnings = mesh_warnings(&mesh);
        let rays = grid
            .refined(options.samples()?.rays())
            .around_model(&bounds);
        rays.check_rays()?;
        let on_gpu = self.sample_on_gpu(&mesh, &rays, options, &mut ldi_progress);
        let (ldi, adapter) = match on_gpu.await {
            Ok((ldi, adapter)) => (ldi, Some(adapter)),
            Err(error @ LdiError::Cancelled(_)) => return Err(error.into()),
            Err(error) if options.backend == Backend::Gpu => return Err(error.into()),
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
        let height_mm = height_mm(bounds.size().z, options);
        let options = sampling_options(options);
        Ok(Sampled {
            options,
            mesh,
            height_mm,
            grid,
            solid: Solid::of(&ldi),
            ldi,
            adapter,
            warnings,
            shapes: None,
        })
    }

    /// The LDI by the GPU, and its name. A GPU that failed is not tried again.
    async fn sample_on_gpu(
        &mut self,
        mesh: &Mesh,
        rays: &Grid,
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<(Ldi, String), LdiError> {
        let found = self.gpu.take_if(|_| options.backend != Backend::Cpu);
        let gpu = match found {
            Some(found) => found?,
            None => search_gpu(options.backend).await?,
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
        let sampled = self.sampled.as_ref().ok_or(Error::NoPlan)?;
        let shapes = sampled.shapes.as_ref().ok_or(Error::NoPlan)?;
        if metric.needs_areas() && shapes.of(source).areas_mm2.is_empty() {
            return Err(Error::NoPlan);
        }
        Ok(shapes.profile(metric, source))
    }

    /// The mask of a layer of the last plan: see [`MaskCursor::whole`].
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Options`] if there is no such layer.
    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, Error> {
        let (sampled, planned) = self.sampled_and_planned()?;
        let layers = planned.plan.layers();
        if layer >= layers {
            let reason = format!("there is no layer {layer}; the plan has {layers}, from 0");
            return Err(Error::Options { reason });
        }
        let (masks, cursor) = planned.upright_masks(sampled)?;
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
        let (sampled, planned) = self.sampled_and_planned()?;
        let mut mask_progress = |fraction| progress(Stage::Masks, fraction);
        let mirrored;
        let masks = if planned.options.is_mirrored()? {
            mirrored = sampled.masks(&planned.plan, &planned.options, Side::Below)?;
            &mirrored
        } else {
            planned.upright_masks(sampled)?;
            let upright = planned.masks.as_ref().ok_or(Error::NoPlan)?;
            &upright.0
        };
        let options = &planned.options;
        let job = Job {
            masks,
            report: &planned.report,
            printer: options.printer()?,
            resin: &options.resin,
            mesh: &sampled.mesh,
            ldi: &sampled.ldi,
        };
        let written = archive::write(options.format()?, &job, writer, &mut mask_progress);
        let writer = written?;
        let report = &mut planned.report;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }

    fn sampled_and_planned(&mut self) -> Result<(&Sampled, &mut Planned), Error> {
        match (&self.sampled, &mut self.planned) {
            (Some(sampled), Some(planned)) => Ok((sampled, planned)),
            _ => Err(Error::NoPlan),
        }
    }
}

impl Planned {
    /// The masks as seen from above, which are kept for the next one who looks, and where that one is.
    fn upright_masks(&mut self, sampled: &Sampled) -> Result<&mut (Masks, MaskCursor), Error> {
        let masks = if let Some(masks) = self.masks.take() {
            masks
        } else {
            let masks = sampled.masks(&self.plan, &self.options, Side::Above)?;
            let cursor = masks.cursor();
            (masks, cursor)
        };
        Ok(self.masks.insert(masks))
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

/// The masks' pixels around a model of these bounds.
///
/// # Errors
/// [`Error::Options`], [`Error::Grid`]; among these that the model does not fit the printer.
fn grid(bounds: &Bounds, options: &Options) -> Result<Grid, Error> {
    let grid = match (options.plate_pixels()?, options.plate_pitch_mm()?) {
        (Some(pixels), Some(pitch_mm)) => Grid::plate(bounds, pixels, pitch_mm)?,
        (None, Some(pitch_mm)) if pitch_mm[0] == pitch_mm[1] => {
            Grid::of_pitch(bounds, pitch_mm[0])?
        }
        (None, None) => Grid::around(bounds, options.rays)?,
        (Some(_), None) | (None, Some(_)) => {
            let reason = "pixels and their pitch in x and y belong together".to_owned();
            return Err(Error::Options { reason });
        }
    };
    if let Some(printer) = options.printer()?
        && bounds.size().z > printer.volume_mm[2]
    {
        return Err(GridError::ModelTooHigh {
            model_mm_z: bounds.size().z,
            printer_mm_z: printer.volume_mm[2],
            fitting_scale: (printer.volume_mm[2] / bounds.size().z * 1e4).floor() / 1e4,
        }
        .into());
    }
    Ok(grid)
}

/// The shape of a relief under the metric and weights; for metrics that are made of them it asks for the areas of sections.
fn shapes_of<E>(
    relief: &Relief,
    areas_mm2: impl FnOnce() -> Result<Vec<f64>, E>,
    options: &Options,
    weights: Option<Vec<f32>>,
) -> Result<Shapes, E> {
    let areas_mm2 = if options.metric.needs_areas() {
        areas_mm2()?
    } else {
        Vec::new()
    };
    let mut shapes = Shapes::of_relief(relief, areas_mm2);
    shapes.weigh(|| relief, None, options.metric, weights);
    Ok(shapes)
}

/// The height as asked for, or as the file has it but for the noise of single precision.
fn height_mm(size_mm: f64, options: &Options) -> f64 {
    options
        .height_mm
        .unwrap_or_else(|| (size_mm * 1e6).round() / 1e6)
}

fn sampling_options(options: &Options) -> SamplingOptions {
    (
        options.pose(),
        options.printer.clone(),
        options.pixels,
        [options.pitch_mm, options.pitch_y_mm],
        options.rays,
        options.antialias,
        options.backend,
    )
}

impl Sampled {
    /// All that planning needs.
    fn planning(&self, options: &Options) -> Result<Planning<'_>, Error> {
        let shapes = self.shapes.as_ref().ok_or(Error::NoPlan)?;
        Ok(Planning::new(self.height_mm, shapes, options))
    }

    fn masks(&self, plan: &Plan, options: &Options, side: Side) -> Result<Masks, Error> {
        let samples = options.samples()?;
        Ok(Masks::new(&self.ldi, plan, &self.grid, samples, side))
    }

    fn report(
        &self,
        origin: Origin<'_>,
        options: &Options,
        plan: &Plan,
        planned: PlanReport,
        timings_ms: Timings,
    ) -> Result<Report, Error> {
        let mut warnings = self.warnings.clone();
        warnings.extend(planned.warnings);
        let black = black_layers(&self.solid, plan, options.samples()?);
        if let Some(&lowest) = black.first() {
            warnings.push(Warning::BlackLayers {
                layers: black.len(),
                from_mm: plan.z_mm()[lowest],
            });
        }
        let thickness_mm = plan.thickness_mm();
        Ok(Report {
            schema: SCHEMA,
            stl: origin.stl.clone(),
            options: options.anywhere(),
            weights_crc32: origin.paint.map(weights::crc_of),
            layers: plan.layers(),
            height_mm: self.height_mm,
            z_mm: plan.z_mm(),
            exposure_s: options.resin.exposures_s(&thickness_mm),
            overhead_s: options.resin.overhead_s(),
            resin: options.resin.clone(),
            thickness_mm,
            resin_ml: self.solid.volume_mm3 / 1e3,
            printer: options.printer.clone(),
            snapped_mm: planned.snapped_mm,
            metric: options.metric,
            unit: options.metric.unit().to_owned(),
            source: options.source,
            planner: options.planner.name().to_owned(),
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
                is_mirrored: options.is_mirrored()?,
            },
            print_file: PrintFileReport::new(options.format()?, options.printer()?),
            warnings,
            timings_ms,
        })
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
