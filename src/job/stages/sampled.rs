//! A model on the plate and its rays: the first stage.

use std::sync::Arc;

use web_time::Instant;

use super::memory::{Bound, Memory};
use super::parts::Sampling;
use super::prepared::{Prepared, Supported};
use super::stage::ms_since;
#[cfg(not(target_arch = "wasm32"))]
use super::work;
use crate::grid::Grid;
use crate::inspect::{Held, Limits};
use crate::job::{Backend, Error, GpuMethod, Timings};
use crate::ldi::gpu::{self, Gpu};
use crate::ldi::{GpuFault, Ldi, LdiError, Overlaps, RayImage, Survey, cpu, missed};
use crate::model::Mesh;
use crate::progress::{Progress, silent};
use crate::warning::Warning;

/// The model on the plate and its rays. Immutable and shared, so its rays never change.
#[derive(Debug)]
pub struct Sampled {
    /// The options with which it was sampled.
    pub sampling: Sampling,
    pub prepared: Arc<Prepared>,
    pub height_mm: f64,
    /// The pixels of the masks.
    pub grid: Grid,
    /// The rays, which are only where the model is.
    pub rays: Grid,
    hits: Hits,
    pub survey: Survey,
    /// Its supports, if it has any.
    pub supported: Option<Supported>,
    /// The GPU that was used.
    pub gpu: Option<UsedGpu>,
    pub warnings: Vec<Warning>,
}

/// The hits that are kept; all others are found again when they are needed.
#[derive(Debug)]
enum Hits {
    /// Those of the rays along which bodies overlap.
    OfOverlaps(Overlaps),
    /// Those of all rays, for several passes over them.
    All(Overlaps, Ldi),
    /// None, since they do not fit into memory.
    None(Bound),
}

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
    /// True if that GPU is one that the caller opened, which is used at every size.
    is_given: bool,
    /// The bound of memory, if there is one.
    memory: Option<Memory>,
    /// Seconds of processor time that a job may take, if that is bounded.
    #[cfg(not(target_arch = "wasm32"))]
    cpu_time_s: Option<f64>,
}

impl Sampler {
    /// Samples on `gpu` from now on, unless the backend is the CPU.
    pub fn set_gpu(&mut self, gpu: Gpu) {
        self.gpu = Some(Ok(gpu));
        self.is_given = true;
    }

    /// Keeps no hits from now on where they, and the masks made of them, would take more than `memory`.
    pub fn set_memory(&mut self, memory: Memory) {
        self.memory = Some(memory);
    }

    /// Samples nothing from now on that is certain to take more processor time than this, in seconds.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn set_cpu_time(&mut self, seconds: f64) {
        self.cpu_time_s = Some(seconds);
    }

    /// The bound set by [`Self::set_cpu_time`], which holds for the other stages of a job as well.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn cpu_time_s(&self) -> Option<f64> {
        self.cpu_time_s
    }

    /// Searches for a GPU, emulated or not, unless a search has already been made.
    pub async fn open_gpu(&mut self) {
        if self.gpu.is_none() {
            self.gpu = Some(Gpu::open(gpu::Adapters::Any).await);
        }
    }

    /// Samples a model that is prepared, and keeps the hits of all rays if `keeps_rays` is set and they fit. If the GPU fails, the CPU is
    /// used instead, unless the backend requires the GPU.
    ///
    /// # Errors
    /// [`Error::Grid`], [`Error::Ldi`], [`Error::MemoryBound`], [`Error::TimeBound`].
    pub async fn sample(
        &mut self,
        sampling: &Sampling,
        prepared: Arc<Prepared>,
        keeps_rays: bool,
        timings: &mut Timings,
        progress: &mut Progress<'_>,
    ) -> Result<Sampled, Error> {
        let clock = Instant::now();
        let grid = prepared.grid(sampling)?;
        let mesh = &prepared.mesh;
        let printed = prepared.printed;
        let mut warnings = prepared.warnings.clone();
        let rays = grid.refined(sampling.samples.rays()).around_model(&printed);
        rays.check_rays()?;
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(allowed_s) = self.cpu_time_s {
            work::check_hits(mesh, &rays, allowed_s)?;
        }
        let bound = match self.memory {
            Some(memory) => memory.bound(mesh, &rays, sampling.samples)?,
            None => None,
        };
        let mut on_gpu = None;
        if bound.is_none() && self.wants_gpu(sampling.backend, mesh.facets.len(), rays.pixels()) {
            let found = self.sample_on_gpu(mesh, &rays, sampling, progress);
            match found.await {
                Ok(found) => on_gpu = Some(found),
                Err(error @ LdiError::Cancelled(_)) => return Err(error.into()),
                Err(error) if sampling.backend == Backend::Gpu => return Err(error.into()),
                Err(error) => warnings.extend(cpu_instead(&error)),
            }
        }
        let (ldi, gpu) = match on_gpu {
            Some((ldi, gpu)) => (Some(ldi), Some(gpu)),
            None if bound.is_none() && keeps_rays => {
                (Some(cpu::sample(mesh, &rays, progress)?), None)
            }
            None => (None, None),
        };
        let scanned = RayImage::Scanned { mesh, grid: rays };
        let (survey, hits) = match (ldi, bound) {
            (None, Some(bound)) => (Survey::of(scanned, progress)?, Hits::None(bound)),
            (None, None) => {
                let (survey, overlaps) = Survey::with_overlaps(scanned, progress)?;
                (survey, Hits::OfOverlaps(overlaps))
            }
            (Some(ldi), _) => {
                let (survey, overlaps) = Survey::with_overlaps(RayImage::Kept(&ldi), &mut silent)?;
                (survey, Hits::All(overlaps, ldi))
            }
        };
        if survey.hits == 0 {
            return Err(LdiError::NoHits {
                pitch_mm: grid.pitch_mm,
            }
            .into());
        }
        let unclosed = survey.rays_through_holes;
        if unclosed > 0 {
            let rays = rays.pixels();
            warnings.push(Warning::UnclosedRays { unclosed, rays });
        }
        if let Some(missed) = missed(mesh, &rays) {
            let rounded = |mm: f64| (mm * 1e3).round() / 1e3 + 0.0;
            warnings.push(Warning::MissedBodies {
                bodies: missed.bodies,
                at_mm: missed.at_mm.to_array().map(rounded),
            });
        }
        timings.ldi += ms_since(clock);
        let supports = prepared.supports.as_ref();
        let supported = supports.map(|supports| Supported::of(supports, survey.support_mm3));
        Ok(Sampled {
            height_mm: sampling.height_mm(prepared.surface.size().z, prepared.lift_mm()),
            sampling: sampling.clone(),
            prepared,
            grid,
            rays,
            hits,
            survey,
            supported,
            gpu,
            warnings,
        })
    }

    /// Returns true if a GPU is to be tried at this size.
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

impl Sampled {
    /// The rays.
    pub fn image(&self) -> RayImage<'_> {
        match &self.hits {
            Hits::All(_, ldi) => RayImage::Kept(ldi),
            Hits::OfOverlaps(_) | Hits::None(_) => RayImage::Scanned {
                mesh: self.mesh(),
                grid: self.rays,
            },
        }
    }

    /// Returns false if the hits of all rays could be kept, and are not.
    pub fn keeps_rays(&self) -> bool {
        !matches!(self.hits, Hits::OfOverlaps(_))
    }

    /// The rays along which bodies overlap.
    ///
    /// # Errors
    /// [`Error::MemoryBound`] if their hits may not fit into memory.
    pub fn overlaps(&self) -> Result<&Overlaps, Error> {
        match &self.hits {
            Hits::OfOverlaps(overlaps) | Hits::All(overlaps, _) => Ok(overlaps),
            Hits::None(bound) => Err(bound.error()),
        }
    }

    /// Memory bound that hits and masks may not fit into; `None` if they are kept.
    pub fn bound(&self) -> Option<Bound> {
        match self.hits {
            Hits::OfOverlaps(_) | Hits::All(..) => None,
            Hits::None(bound) => Some(bound),
        }
    }

    /// The sampled mesh: on the plate, with voids and supports.
    pub fn mesh(&self) -> &Mesh {
        &self.prepared.mesh
    }

    /// Returns true if it has supports.
    pub fn is_supported(&self) -> bool {
        self.prepared.supports.is_some()
    }

    /// Returns true if it was sampled like this.
    pub fn is_of(&self, sampling: &Sampling, protected: Option<&[f32]>) -> bool {
        self.sampling == *sampling && self.prepared.is_of(sampling, protected)
    }

    /// Contacts and joints of the supports, with the reach of contacts on surfaces that these limits call too flat.
    pub fn held(&self, limits: &Limits) -> Held {
        let mut held = Held {
            ceilings_mm: self
                .prepared
                .hollowed
                .iter()
                .flat_map(|it| it.ceilings_mm.clone())
                .collect(),
            ..Held::default()
        };
        let Some(supported) = &self.supported else {
            return held;
        };
        let lifted = |[x, y, z]: [f64; 3]| [x, y, z + supported.lift_mm];
        for (at_mm, _) in &mut held.ceilings_mm {
            *at_mm = lifted(*at_mm);
        }
        let contacts = supported.points.iter().map(|point| lifted(point.at_mm));
        let supporting = self.sampling.supports.clone().unwrap_or_default();
        let profile = supporting.profile();
        Held {
            contacts_mm: contacts.collect(),
            reach_mm: profile.reach_mm(limits.self_supporting_slope),
            tip_reach_mm: 2.0 * profile.contact_mm,
            tip_mm: profile.tip_mm,
            joints_mm: supported.joints_mm.iter().copied().map(lifted).collect(),
            joint_reach_mm: 2.0 * profile.pillar_mm,
            film_kpa: profile.film_kpa,
            ..held
        }
    }
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
