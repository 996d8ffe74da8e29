//! The LDI on the GPU, by one of two methods that find the facets along each ray: filling (shaders/fill.wgsl), in two passes
//! whatever the depth, or depth peeling (shaders/peel.wgsl), which needs no storage buffers while it draws. A prefix sum
//! (shaders/scan.wgsl) turns counts into offsets of compressed rows. Offsets and facets are read back once per tile.
//!
//! The same integers decide coverage as in the CPU backend, and the same function computes heights. The two
//! backends therefore return the same [`Ldi`], bit for bit, on every adapter.
//!
//! In the browser the GPU is a module of its own, which the page fetches when a plan wants a GPU: see `remote.rs`.

#[cfg(any(feature = "gpu", not(target_arch = "wasm32")))]
mod direct;
#[cfg(all(target_arch = "wasm32", not(feature = "gpu")))]
mod remote;
mod tiles;

#[cfg(any(feature = "gpu", not(target_arch = "wasm32")))]
pub use direct::{Gpu, find};
#[cfg(all(target_arch = "wasm32", not(feature = "gpu")))]
pub use remote::{Gpu, find, open_by};
pub use tiles::{Meetings, Region, Tiling};

use super::projection::Projection;
use super::{GpuFault, Ldi, LdiError};
use crate::grid::Grid;
use crate::model::Mesh;
use crate::progress::{Progress, report};

/// Which adapters may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adapters {
    /// Any adapter, including software emulation.
    Any,
    /// Hardware only: an emulated GPU is slower than the CPU backend.
    Hardware,
}

/// How the facets that each ray hits are found. Both methods find the same.
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

/// Whether a GPU can be faster than the CPU backend at this size: with many facets, and at least four for each ray.
///
/// What a GPU finds is read back, and the CPU computes heights and sorts. Where rays outnumber facets, that alone takes longer than
/// all that the CPU backend does (docs/ldi.md, "When a GPU is used"; `cargo xtask bench gpu` checks it).
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
