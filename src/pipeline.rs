//! The order of stages, and nothing else: the only module that knows it.

use std::io::{Seek, Write};
use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use web_time::Instant;

use crate::archive::png_zip;
use crate::error::Error;
use crate::grid::{Bins, Grid};
use crate::ldi::gpu::{self, Gpu};
use crate::ldi::{Ldi, LdiError, cpu};
use crate::mask::{MaskCursor, Masks};
use crate::mesh::Mesh;
use crate::plan::{Limits, Plan, PlanError, optimal, uniform};
use crate::profile::{ErrorSum, Metric, Profile, cusp};
use crate::progress::Progress;
use crate::report::{MaskReport, MeshInfo, Report, Timings, UniformReport, Warning, mesh_warnings};
use crate::stl;

/// A part of the work, for showing progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Reading the STL.
    Load,
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
            Self::Ldi => "ldi",
            Self::Profile => "profile",
            Self::Plan => "plan",
            Self::Masks => "masks",
        }
    }
}

/// Called with the stage at work and the fraction of it that is done; `Break` cancels.
pub type StageProgress<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

/// Where the LDI is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU, unless there is none or it is emulated in software.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The CPU.
    Cpu,
}

/// How layers are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase", tag = "kind")]
pub enum Planner {
    /// The fewest layers within tolerance.
    #[default]
    Optimal,
    /// Layers of one thickness, whatever their error.
    Uniform {
        /// That thickness in millimetres.
        layer_mm: f64,
    },
}

/// What to slice and how. All lengths are in millimetres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Scale the model evenly to this height; its own height if absent.
    pub height_mm: Option<f64>,
    /// Columns and rows of the masks, with the model in the middle; needs `pitch_mm`.
    pub pixels: Option<[u32; 2]>,
    /// Side of a pixel; alone, with as many pixels as cover the model.
    pub pitch_mm: Option<f64>,
    /// Pixels along the model's longer horizontal side where neither is given.
    pub rays: u32,
    /// Least layer thickness.
    pub layer_min_mm: f64,
    /// Greatest layer thickness.
    pub layer_max_mm: f64,
    /// Greatest error of a layer.
    pub tolerance_mm: f64,
    /// Height of a bin of the profile.
    pub bin_mm: f64,
    /// What the error measures.
    pub metric: Metric,
    /// How layers are chosen.
    pub planner: Planner,
    /// Where the LDI is sampled.
    pub backend: Backend,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            height_mm: None,
            pixels: None,
            pitch_mm: None,
            rays: 2048,
            layer_min_mm: 0.05,
            layer_max_mm: 0.15,
            tolerance_mm: 0.065,
            bin_mm: 0.002,
            metric: Metric::Cusp,
            planner: Planner::Optimal,
            backend: Backend::Auto,
        }
    }
}

/// A loaded model on its way through the stages. Each keeps its result, so that a change of options
/// repeats only what depends on it.
#[derive(Debug)]
pub struct Slicer {
    model: Mesh,
    load_ms: f64,
    gpu: Option<Gpu>,
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
    adapter: Option<String>,
    warnings: Vec<Warning>,
    profile: Option<(Profile, ErrorSum)>,
}

type SamplingOptions = (Option<f64>, Option<[u32; 2]>, Option<f64>, u32, Backend);

#[derive(Debug)]
struct Planned {
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
            load_ms: ms_since(clock),
            gpu: None,
            sampled: None,
            planned: None,
        })
    }

    /// Samples on `gpu` from now on, where the options do not ask for the CPU.
    #[must_use]
    pub fn with_gpu(mut self, gpu: Gpu) -> Self {
        self.gpu = Some(gpu);
        self
    }

    /// Describes the model as it stands in its file.
    pub fn info(&self) -> MeshInfo {
        MeshInfo::of(&self.model)
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
        check_options(options)?;
        let mut timings = Timings {
            load: self.load_ms,
            ..Timings::default()
        };

        let key = sampling_options(options);
        let sampled = match self.sampled.take().filter(|sampled| sampled.options == key) {
            Some(sampled) => sampled,
            None => self.sample(options, &mut timings, progress).await?,
        };
        let sampled = self.sampled.insert(sampled);

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Profile, 0.0))?;
        let bins = Bins::of_height(sampled.height_mm, options.bin_mm)?;
        if sampled
            .profile
            .as_ref()
            .is_none_or(|(profile, _)| profile.bins != bins)
        {
            let profile = match options.metric {
                Metric::Cusp => cusp::sampled(&sampled.mesh, &sampled.ldi, bins),
            };
            let errors = profile.error_sum();
            sampled.profile = Some((profile, errors));
            timings.profile = ms_since(clock);
        }
        let Some((_, errors)) = &sampled.profile else {
            unreachable!("set above")
        };

        let clock = Instant::now();
        continue_or_cancel(progress(Stage::Plan, 0.0))?;
        let limits = limits_of(options);
        let plan = match options.planner {
            Planner::Optimal => optimal::plan(errors, &limits)?,
            Planner::Uniform { layer_mm } => uniform::plan(bins, sampled.height_mm, layer_mm)?,
        };
        let uniform = uniform_report(errors, options, sampled.height_mm)?;
        timings.plan = ms_since(clock);
        continue_or_cancel(progress(Stage::Plan, 1.0))?;

        timings.sum_up();
        self.load_ms = 0.0;
        let report = report_of(sampled, errors, options, &plan, uniform, timings);
        Ok(&self
            .planned
            .insert(Planned {
                plan,
                report,
                masks: None,
            })
            .report)
    }

    async fn sample(
        &mut self,
        options: &Options,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Sampled, Error> {
        let clock = Instant::now();
        let mesh = self.model.on_plate(options.height_mm)?;
        let bounds = mesh.bounds();
        let grid = match (options.pixels, options.pitch_mm) {
            (Some(pixels), Some(pitch_mm)) => Grid::plate(&bounds, pixels, pitch_mm)?,
            (None, Some(pitch_mm)) => Grid::of_pitch(&bounds, pitch_mm)?,
            (None, None) => Grid::around(&bounds, options.rays)?,
            (Some(_), None) => {
                let reason = "a grid of given pixels needs a pitch as well".to_owned();
                return Err(Error::Options { reason });
            }
        };
        timings.load += ms_since(clock);

        let clock = Instant::now();
        let mut ldi_progress = |fraction| progress(Stage::Ldi, fraction);
        let mut warnings = mesh_warnings(&mesh);
        let rays = grid.around_model(&bounds);
        let on_gpu = self.sample_on_gpu(&mesh, &rays, options, &mut ldi_progress);
        let (ldi, adapter) = match on_gpu.await {
            Ok((ldi, adapter)) => (ldi, Some(adapter)),
            Err(error @ LdiError::Cancelled(_)) => return Err(error.into()),
            Err(error) if options.backend == Backend::Gpu => return Err(error.into()),
            Err(error) => {
                if !matches!(error, LdiError::NoGpu { .. }) {
                    let message = format!("the CPU did the work of the GPU: {error}");
                    warnings.push(Warning::new(error.code(), message));
                }
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
            let message = format!(
                "{unclosed} of {} rays did not close, because they pass holes of the mesh; flat caps close them",
                ldi.rays()
            );
            warnings.push(Warning::new("unclosed-rays", message));
        }
        timings.ldi = ms_since(clock);
        // The height as asked for, or as the file has it but for the noise of single precision.
        let height_mm = options
            .height_mm
            .unwrap_or_else(|| (bounds.size().z * 1e6).round() / 1e6);
        let options = sampling_options(options);
        Ok(Sampled {
            options,
            mesh,
            height_mm,
            grid,
            ldi,
            adapter,
            warnings,
            profile: None,
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
        let adapters = match options.backend {
            Backend::Cpu => {
                let reason = "the CPU was asked for".to_owned();
                return Err(LdiError::NoGpu { reason });
            }
            Backend::Gpu => gpu::Adapters::Any,
            Backend::Auto => gpu::Adapters::Hardware,
        };
        let gpu = match self.gpu.take() {
            Some(gpu) => gpu,
            None => Gpu::open(adapters).await?,
        };
        let ldi = gpu::sample(mesh, rays, &gpu, gpu::Tiling::default(), progress).await?;
        let name = gpu.name().to_owned();
        self.gpu = Some(gpu);
        Ok((ldi, name))
    }

    /// The profile that the last plan was made from, or was tried on if there is none.
    ///
    /// # Errors
    /// [`Error::NoPlan`].
    pub fn profile(&self) -> Result<&Profile, Error> {
        let sampled = self.sampled.as_ref().ok_or(Error::NoPlan)?;
        Ok(&sampled.profile.as_ref().ok_or(Error::NoPlan)?.0)
    }

    /// The mask of a layer of the last plan: see [`MaskCursor::bits`].
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Options`] if there is no such layer.
    pub fn mask(&mut self, layer: usize) -> Result<&[u8], Error> {
        let (sampled, planned) = self.sampled_and_planned()?;
        let layers = planned.plan.layers();
        if layer >= layers {
            let reason = format!("there is no layer {layer}; the plan has {layers}, from 0");
            return Err(Error::Options { reason });
        }
        let (masks, cursor) = planned.masks(sampled);
        cursor.seek(masks, layer);
        Ok(cursor.bits())
    }

    /// Writes the masks of the last plan as a zip of PNGs with a manifest, and returns the report with
    /// the time that this took.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Archive`].
    pub fn write_png_zip<W: Write + Seek>(
        &mut self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        let clock = Instant::now();
        let (sampled, planned) = self.sampled_and_planned()?;
        planned.masks(sampled);
        let Planned {
            report,
            masks: Some((masks, _)),
            ..
        } = planned
        else {
            unreachable!("made above")
        };
        let mut mask_progress = |fraction| progress(Stage::Masks, fraction);
        let writer = png_zip::write(masks, report, writer, &mut mask_progress)?;
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
    fn masks(&mut self, sampled: &Sampled) -> &mut (Masks, MaskCursor) {
        self.masks.get_or_insert_with(|| {
            let masks = Masks::new(&sampled.ldi, &self.plan, &sampled.grid);
            let cursor = masks.cursor();
            (masks, cursor)
        })
    }
}

fn sampling_options(options: &Options) -> SamplingOptions {
    (
        options.height_mm,
        options.pixels,
        options.pitch_mm,
        options.rays,
        options.backend,
    )
}

fn limits_of(options: &Options) -> Limits {
    Limits {
        layer_min_mm: options.layer_min_mm,
        layer_max_mm: options.layer_max_mm,
        tolerance_mm: options.tolerance_mm,
    }
}

/// Finds what no model could make good, before any time is spent on sampling.
fn check_options(options: &Options) -> Result<(), Error> {
    let bins = Bins {
        count: 1,
        size_mm: options.bin_mm,
    };
    match options.planner {
        Planner::Optimal => {
            limits_of(options).thickness_in_bins(bins)?;
        }
        Planner::Uniform { layer_mm } => {
            uniform::thickness_in_bins(bins, layer_mm)?;
        }
    }
    Ok(())
}

/// What uniform layers at both ends of the range would give. Uniform layers may be planned with no valid range;
/// they then stand for both ends.
fn uniform_report(
    errors: &ErrorSum,
    options: &Options,
    height_mm: f64,
) -> Result<UniformReport, Error> {
    let bins = errors.bins();
    let (finest_mm, coarsest_mm) =
        match (limits_of(options).thickness_in_bins(bins), options.planner) {
            (Ok(thickness), _) => (
                bins.boundary_mm(*thickness.start()),
                bins.boundary_mm(*thickness.end()),
            ),
            (Err(_), Planner::Uniform { layer_mm }) => (layer_mm, layer_mm),
            (Err(error), Planner::Optimal) => return Err(error.into()),
        };
    let uniform = |layer_mm| match uniform::plan(bins, height_mm, layer_mm) {
        // A model lower than half a layer is one layer here, as it is for the optimal planner.
        Err(PlanError::LayerTooThick { .. }) => Ok(Plan {
            bins,
            boundaries: vec![0, bins.count as u32],
        }),
        plan => plan,
    };
    let (finest, coarsest) = (uniform(finest_mm)?, uniform(coarsest_mm)?);
    Ok(UniformReport {
        finest_layers: finest.layers(),
        finest_error_mm: finest.max_error_mm(errors),
        coarsest_layers: coarsest.layers(),
        coarsest_error_mm: coarsest.max_error_mm(errors),
    })
}

fn report_of(
    sampled: &Sampled,
    errors: &ErrorSum,
    options: &Options,
    plan: &Plan,
    uniform: UniformReport,
    timings_ms: Timings,
) -> Report {
    let mut warnings = sampled.warnings.clone();
    let max_error_mm = plan.max_error_mm(errors);
    if matches!(options.planner, Planner::Uniform { .. })
        && errors.to_steps(max_error_mm) > errors.to_steps(options.tolerance_mm)
    {
        let message = format!(
            "uniform layers exceed the tolerance: their largest error is {max_error_mm:.4} mm"
        );
        warnings.push(Warning::new("tolerance-exceeded", message));
    }
    Report {
        layers: plan.layers(),
        height_mm: sampled.height_mm,
        z_mm: plan.z_mm(),
        thickness_mm: plan.thickness_mm(),
        max_error_mm,
        tolerance_mm: options.tolerance_mm,
        metric: options.metric,
        planner: match options.planner {
            Planner::Optimal => "optimal".to_owned(),
            Planner::Uniform { .. } => "uniform".to_owned(),
        },
        backend: if sampled.adapter.is_some() {
            "gpu"
        } else {
            "cpu"
        }
        .to_owned(),
        adapter: sampled.adapter.clone(),
        bins: plan.bins.count,
        bin_mm: plan.bins.size_mm,
        facets: sampled.mesh.surface_facets,
        hits: sampled.ldi.hits.len(),
        uniform,
        mask: MaskReport {
            width: sampled.grid.width,
            height: sampled.grid.height,
            pitch_mm: sampled.grid.pitch_mm,
        },
        warnings,
        timings_ms,
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
