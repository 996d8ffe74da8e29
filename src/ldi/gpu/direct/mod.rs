//! The GPU itself, by wgpu. In the browser this is a module of its own (gpu/), behind the feature `gpu`.

mod cells;
mod cut;
mod device;
mod fill;
mod layers;
mod peel;
mod scan;

pub use device::Gpu;

use self::fill::Filler;
use self::peel::Peeler;
use super::tiles::{Meetings, Region};
use super::{Method, Tiling, failed};
use crate::grid::Grid;
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};
use crate::progress::{Progress, report};

/// A method with the mesh on the GPU.
enum Sampler<'a> {
    Fill(Filler<'a>),
    Peel(Peeler<'a>),
}

impl Sampler<'_> {
    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    async fn sample(&self, region: Region) -> Result<Option<Meetings>, LdiError> {
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
pub async fn find(
    projection: &Projection<'_>,
    grid: &Grid,
    gpu: &Gpu,
    tiling: Tiling,
    method: Method,
    progress: &mut Progress<'_>,
) -> Result<Vec<(Region, Meetings)>, LdiError> {
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
