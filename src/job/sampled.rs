//! A model on the plate and its rays: the first stage.

use serde::Serialize;
use web_time::Instant;

use super::parts::Sampling;
use super::stage::{Stage, StageProgress, ms_since};
use super::{Backend, Error, GpuMethod, Timings};
use crate::grid::Grid;
use crate::inspect::{Held, Limits};
use crate::job::report::mesh_warnings;
use crate::ldi::gpu::{self, Gpu};
use crate::ldi::{GpuFault, Ldi, LdiError, Solid, cpu};
use crate::model::{FacetClass, Mesh};
use crate::prepare::{self, Drain, Hollowing, SupportPoint, Supports, Void};
use crate::progress::Progress;
use crate::warning::Warning;

/// The model on the plate and its rays. Immutable and shared, so its rays never change.
#[derive(Debug)]
pub struct Sampled {
    /// What it was sampled with.
    pub sampling: Sampling,
    pub mesh: Mesh,
    pub height_mm: f64,
    /// The pixels of the masks. The LDI has rays only where the model is.
    pub grid: Grid,
    pub ldi: Ldi,
    pub solid: Solid,
    /// What was left out of it, if anything.
    pub hollowed: Option<Hollowed>,
    /// What holds it, if it is supported.
    pub supported: Option<Supported>,
    /// The GPU that was used.
    pub gpu: Option<UsedGpu>,
    pub warnings: Vec<Warning>,
}

/// The void of a hollowed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Hollowed {
    /// Volume of the void, without what its struts take.
    pub void_ml: f64,
    /// The drain holes that meet it, each with its depth: those asked for, then those placed automatically. None of
    /// plates with several models, each of which has a frame of its own.
    pub drains: Vec<Drain>,
    /// Walls may be thinner than asked by this.
    pub resolution_mm: f64,
}

/// What holds a supported model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Supported {
    /// Volume of the supports outside the model.
    pub support_ml: f64,
    /// How far the model is lifted above the plate.
    pub lift_mm: f64,
    /// The points that are supported, from the highest down.
    pub points: Vec<SupportPoint>,
    /// The points that no support reaches.
    pub unreached: Vec<SupportPoint>,
    /// Supports that stand on the model, where they leave a mark.
    pub on_model: usize,
    /// Where pillars, branches and braces join, from the model's lowest point.
    #[serde(skip)]
    pub joints_mm: Vec<[f64; 3]>,
}

/// The fraction of the stage of rays that hollowing and supports take, if there are any.
const PREPARING_SHARE: f64 = 0.5;

/// A GPU that sampled a model.
#[derive(Debug, Clone)]
pub struct UsedGpu {
    pub name: String,
    pub method: gpu::Method,
}

/// Samples models, and keeps the GPU open between them.
#[derive(Debug, Default)]
pub struct Sampler {
    /// The GPU to use next, or why the last search found none. `None` before a search and after a failure.
    gpu: Option<Result<Gpu, LdiError>>,
    /// Whether that GPU is one that the caller opened, which is used at every size.
    is_given: bool,
}

impl Sampler {
    /// Samples on `gpu` from now on, unless the backend is the CPU.
    pub fn set_gpu(&mut self, gpu: Gpu) {
        self.gpu = Some(Ok(gpu));
        self.is_given = true;
    }

    /// Searches for a GPU, emulated or not, unless a search has already been made.
    pub async fn open_gpu(&mut self) {
        if self.gpu.is_none() {
            self.gpu = Some(Gpu::open(gpu::Adapters::Any).await);
        }
    }

    /// Poses and samples the model. If the GPU fails, the CPU is used instead, unless `backend` requires the GPU.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Ldi`].
    pub async fn sample(
        &mut self,
        model: &Mesh,
        sampling: &Sampling,
        timings: &mut Timings,
        progress: &mut StageProgress<'_>,
    ) -> Result<Sampled, Error> {
        let clock = Instant::now();
        let mut mesh = model.on_plate(&sampling.pose)?;
        // Of the model, and of all that is printed.
        let mut bounds = mesh.bounds();
        let mut printed = bounds;
        let mut grid = sampling.grid(&bounds)?;
        timings.load += ms_since(clock);

        let clock = Instant::now();
        let mut warnings = mesh_warnings(&mesh);
        let mut hollowed = None;
        let is_prepared = sampling.hollow.is_some() || sampling.supports.is_some();
        let begun = if is_prepared { PREPARING_SHARE } else { 0.0 };
        let between = match &sampling.supports {
            Some(_) if sampling.hollow.is_some() => 0.5 * PREPARING_SHARE,
            Some(_) => 0.0,
            None => PREPARING_SHARE,
        };
        if let Some(hollowing) = &sampling.hollow {
            let mut within = |fraction| progress(Stage::Ldi, between * fraction);
            hollowed = hollow(&mut mesh, hollowing, &mut warnings, &mut within)?;
        }
        let mut supports = None;
        if let Some(supporting) = &sampling.supports {
            let mut within =
                |fraction| progress(Stage::Ldi, between + (PREPARING_SHARE - between) * fraction);
            let made = prepare::support(&mesh, supporting, &mut within)?;
            mesh.add(
                &made.shell.vertices,
                &made.shell.facets,
                FacetClass::Support,
            );
            mesh.lift(made.lift_mm);
            warnings.extend(support_warnings(&made));
            supports = Some(made);
            (bounds, printed) = (mesh.bounds(), mesh.printed_bounds());
            grid = sampling.grid_around(grid, &printed)?;
        }
        let mut ldi_progress = |fraction| progress(Stage::Ldi, begun + (1.0 - begun) * fraction);
        let rays = grid.refined(sampling.samples.rays()).around_model(&printed);
        rays.check_rays()?;
        let mut on_gpu = None;
        if self.wants_gpu(sampling.backend, mesh.facets.len(), rays.pixels()) {
            let found = self.sample_on_gpu(&mesh, &rays, sampling, &mut ldi_progress);
            match found.await {
                Ok(found) => on_gpu = Some(found),
                Err(error @ LdiError::Cancelled(_)) => return Err(error.into()),
                Err(error) if sampling.backend == Backend::Gpu => return Err(error.into()),
                Err(error) => warnings.extend(cpu_instead(&error)),
            }
        }
        let (ldi, gpu) = match on_gpu {
            Some((ldi, gpu)) => (ldi, Some(gpu)),
            None => (cpu::sample(&mesh, &rays, &mut ldi_progress)?, None),
        };
        if ldi.hits.is_empty() {
            return Err(LdiError::NoHits {
                pitch_mm: grid.pitch_mm,
            }
            .into());
        }
        let unclosed = ldi.rays_through_holes();
        if unclosed > 0 {
            let rays = ldi.rays();
            warnings.push(Warning::UnclosedRays { unclosed, rays });
        }
        timings.ldi += ms_since(clock);
        let supported = supports.map(|supports| Supported::of(supports, &ldi));
        Ok(Sampled {
            height_mm: sampling.height_mm(bounds.size().z),
            sampling: sampling.clone(),
            mesh,
            grid,
            solid: Solid::of(&ldi),
            ldi,
            hollowed,
            supported,
            gpu,
            warnings,
        })
    }

    /// Whether to try a GPU at this size.
    fn wants_gpu(&self, backend: Backend, facets: usize, rays: usize) -> bool {
        match backend {
            Backend::Auto if self.is_given => true,
            Backend::Auto => {
                let is_emulated = matches!(&self.gpu, Some(Ok(gpu)) if gpu.is_emulated());
                !is_emulated && gpu::can_be_faster(facets, rays)
            }
            Backend::Gpu => true,
            Backend::Cpu => false,
        }
    }

    /// Samples on the GPU, and returns the LDI and what sampled it. A GPU that fails is closed.
    async fn sample_on_gpu(
        &mut self,
        mesh: &Mesh,
        rays: &Grid,
        sampling: &Sampling,
        progress: &mut Progress<'_>,
    ) -> Result<(Ldi, UsedGpu), LdiError> {
        let adapters = match sampling.backend {
            Backend::Gpu => gpu::Adapters::Any,
            Backend::Auto | Backend::Cpu => gpu::Adapters::Hardware,
        };
        let is_given = std::mem::take(&mut self.is_given);
        let gpu = match self.gpu.take() {
            Some(found) => found?,
            None => Gpu::open(adapters).await?,
        };
        let method = match sampling.gpu_method {
            GpuMethod::Auto => gpu.method(),
            GpuMethod::Fill => gpu::Method::Fill,
            GpuMethod::Peel => gpu::Method::Peel,
        };
        let ldi = gpu::sample(mesh, rays, &gpu, gpu::Tiling::default(), method, progress).await;
        let name = gpu.name().to_owned();
        if matches!(ldi, Ok(_) | Err(LdiError::Cancelled(_))) {
            self.gpu = Some(Ok(gpu));
            self.is_given = is_given;
        }
        Ok((ldi?, UsedGpu { name, method }))
    }
}

/// Hollows a mesh; what was left out of it, if anything.
fn hollow(
    mesh: &mut Mesh,
    hollowing: &Hollowing,
    warnings: &mut Vec<Warning>,
    progress: &mut Progress<'_>,
) -> Result<Option<Hollowed>, LdiError> {
    let Some(void) = prepare::hollow(mesh, hollowing, progress)? else {
        warnings.push(Warning::NothingHollowed {
            wall_mm: hollowing.wall_mm,
            cavity_mm: hollowing.cavity_mm,
        });
        return Ok(None);
    };
    let drains = void.drains.iter().map(|drain| &drain.1);
    for shell in std::iter::once(&void.shell).chain(drains) {
        mesh.add(&shell.vertices, &shell.facets, FacetClass::Void);
    }
    warnings.extend(drain_warnings(&void));
    Ok(Some(Hollowed {
        void_ml: void.shell.volume_mm3() / 1e3,
        drains: void.drains.into_iter().map(|drain| drain.0).collect(),
        resolution_mm: void.resolution_mm,
    }))
}

impl Supported {
    fn of(supports: Supports, ldi: &Ldi) -> Self {
        Self {
            support_ml: ldi.support_mm3() / 1e3,
            lift_mm: supports.lift_mm,
            points: supports.points,
            unreached: supports.unreached,
            on_model: supports.on_model,
            joints_mm: supports.joints_mm,
        }
    }
}

impl Sampled {
    /// What supports hold of surfaces that these limits call too flat.
    pub fn held(&self, limits: &Limits) -> Held {
        let (Some(supported), Some(supporting)) = (&self.supported, &self.sampling.supports) else {
            return Held::default();
        };
        let lifted = |[x, y, z]: [f64; 3]| [x, y, z + supported.lift_mm];
        let contacts = supported.points.iter().map(|point| lifted(point.at_mm));
        let profile = supporting.profile();
        Held {
            contacts_mm: contacts.collect(),
            reach_mm: profile.reach_mm(limits.self_supporting_slope),
            tip_reach_mm: 2.0 * profile.contact_mm,
            tip_mm: profile.tip_mm,
            joints_mm: supported.joints_mm.iter().copied().map(lifted).collect(),
            joint_reach_mm: 2.0 * profile.pillar_mm,
        }
    }
}

/// The warnings about holes that drain nothing, and about what stays full.
fn drain_warnings(void: &Void) -> Vec<Warning> {
    let astray = void.astray.iter();
    let mut warnings: Vec<Warning> = astray
        .map(|place| Warning::DrainAstray {
            drain_number: place + 1,
        })
        .collect();
    if void.undrained > 0 {
        warnings.push(Warning::Undrained {
            basins: void.undrained,
        });
    }
    warnings
}

/// The warnings about points that no support reaches, and about those that are not on the surface.
fn support_warnings(supports: &Supports) -> Vec<Warning> {
    let astray = supports.astray.iter();
    let mut warnings: Vec<Warning> = astray
        .map(|place| Warning::SupportAstray {
            point_number: place + 1,
        })
        .collect();
    if !supports.unreached.is_empty() {
        warnings.push(Warning::Unsupported {
            points: supports.unreached.len(),
        });
    }
    warnings
}

/// The warning about a GPU that was found but failed; `None` if none was found.
fn cpu_instead(error: &LdiError) -> Option<Warning> {
    let failed = |fault, system| Some(Warning::GpuFailed { fault, system });
    match *error {
        LdiError::GpuTooSmall {
            needed_bytes,
            limit_bytes,
            ..
        } => Some(Warning::GpuTooSmall {
            needed_bytes,
            limit_bytes,
        }),
        LdiError::GpuFailed { fault, ref system } => failed(fault, system.clone()),
        LdiError::OutOfMemory { .. } => failed(GpuFault::OutOfMemory, None),
        _ => None,
    }
}
