//! The LDI on the GPU, by one of two methods that find the facets along each ray: filling (shaders/fill.wgsl), in two passes
//! whatever the depth, or depth peeling (shaders/peel.wgsl), which needs no storage buffers while it draws. A prefix sum
//! (shaders/scan.wgsl) turns counts into offsets of compressed rows. Offsets and facets are read back once per tile.
//!
//! The same integers decide coverage as in the CPU backend, and the same function computes heights. The two
//! backends therefore return the same [`Ldi`], bit for bit, on every adapter.

mod cells;
mod cut;
mod device;
mod fill;
mod layers;
mod peel;
mod scan;
mod tiles;

pub use device::Gpu;
pub use tiles::Tiling;

use self::fill::Filler;
use self::peel::Peeler;
use self::tiles::{Intersections, Region};
use super::projection::Projection;
use super::{GpuFault, Ldi, LdiError};
use crate::grid::Grid;
use crate::model::Mesh;
use crate::progress::{Progress, report};

/// Kinds of adapters that may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adapters {
    /// Any adapter, including software emulation.
    Any,
    /// Hardware only: an emulated GPU is slower than the CPU backend.
    Hardware,
}

/// Method by which the facets that each ray hits are found. Both find the same ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Two passes whatever the depth: count, then fill. Needs storage buffers in the vertex and fragment stages.
    Fill,
    /// Depth peeling: one pass for every two facets along the deepest ray. Runs where those stages have no storage buffers.
    Peel,
}

impl Method {
    /// The name of the method, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fill => "fill",
            Self::Peel => "peel",
        }
    }
}

/// The error of a fault that the system said nothing about.
fn failed(fault: GpuFault) -> LdiError {
    LdiError::GpuFailed {
        fault,
        system: None,
    }
}

/// The facets from which on a search for a GPU can be worth its time.
const MANY_FACETS: usize = 1_000_000;

/// Returns true if a GPU can be faster than the CPU backend at this size: with many facets, and at least four for each ray.
///
/// The result is read back from the GPU, and the CPU computes heights and sorts. If rays outnumber facets, that alone
/// takes longer than all that the CPU backend does (docs/ldi.md, "When a GPU is used"; `cargo xtask bench gpu` checks
/// it).
pub fn can_be_faster(facets: usize, rays: usize) -> bool {
    facets >= MANY_FACETS && facets / 4 >= rays
}

/// Samples `mesh`, which lies inside `grid` and above z = 0.
///
/// # Errors
/// [`LdiError::GpuTooSmall`], [`LdiError::GpuFailed`], [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`],
/// [`LdiError::Cancelled`].
pub async fn sample(
    mesh: &Mesh,
    grid: &Grid,
    gpu: &Gpu,
    tiling: Tiling,
    method: Method,
    progress: &mut Progress<'_>,
) -> Result<Ldi, LdiError> {
    super::check_facets(mesh)?;
    report(progress, 0.0)?;
    let projection = Projection::new(mesh, grid);
    let found = find(&projection, grid, gpu, tiling, method, progress).await?;
    tiles::join(&projection, grid, mesh.classes, &found, progress)
}

/// A method with the mesh on the GPU.
enum Sampler<'a> {
    Fill(Filler<'a>),
    Peel(Peeler<'a>),
}

impl Sampler<'_> {
    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    async fn sample(&self, region: Region) -> Result<Option<Intersections>, LdiError> {
        match self {
            Self::Fill(filler) => filler.sample(region).await,
            Self::Peel(peeler) => peeler.sample(region).await,
        }
    }
}

/// Finds the facets that rays meet, tile by tile.
///
/// # Errors
/// [`LdiError::GpuTooSmall`], [`LdiError::GpuFailed`], [`LdiError::Cancelled`].
async fn find(
    projection: &Projection<'_>,
    grid: &Grid,
    gpu: &Gpu,
    tiling: Tiling,
    method: Method,
    progress: &mut Progress<'_>,
) -> Result<Vec<(Region, Intersections)>, LdiError> {
    let sampler = match method {
        Method::Fill => Sampler::Fill(Filler::new(gpu, projection)?),
        Method::Peel => Sampler::Peel(Peeler::new(gpu, projection)),
    };

    let most = gpu.device().limits().max_texture_dimension_2d;
    let most = match method {
        Method::Fill => most,
        Method::Peel => most.min(peel::MOST_SIDE),
    };
    let side = tiling.side.clamp(1, most);
    let mut waiting = cut::cut(grid, side);
    waiting.reverse();
    let mut sampled = Vec::new();
    while let Some(region) = waiting.pop() {
        match sampler.sample(region).await? {
            Some(rays) => sampled.push((region, rays)),
            // More rays or hits than a buffer holds: halve the tile.
            None => waiting.extend(
                region
                    .halves()
                    .ok_or_else(|| failed(GpuFault::TooManyHits))?,
            ),
        }
        let done = sampled.len() as f64;
        report(progress, 0.8 * done / (done + waiting.len() as f64))?;
    }
    Ok(sampled)
}
