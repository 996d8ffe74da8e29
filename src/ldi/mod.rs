//! The layered depth image (LDI): for every ray parallel to z, its hits with the surface in order
//! (section 3.2).
//!
//! Both backends sample the mesh that [`projection`] makes by moving every vertex sideways by at most
//! 1/512 pixel, and both return the same [`Ldi`], so nothing downstream depends on the backend.

mod assemble;
pub mod cpu;
pub mod gpu;
pub mod layout;
mod missed;
mod overlaps;
pub mod projection;
mod ranges;
mod rays;
mod solid;
mod survey;
pub mod visibility;

use serde::Serialize;

pub use missed::{Missed, missed};
pub use overlaps::{MeshRays, Overlaps, sign_of};
pub use ranges::{model_ranges, printed_crossings, printed_entries, printed_ranges};
pub use rays::{Anew, RayImage, RayRows, Rays};
pub use solid::Solid;
pub use survey::Survey;

use crate::grid::Grid;
use crate::model::{FacetClasses, Mesh};
use crate::progress::Cancelled;

/// Rays that a thread processes at a time.
const CHUNK_RAYS: usize = 1 << 16;

/// Fault of a GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum GpuFault {
    /// The system reported an error.
    Error,
    /// The device was lost: unplugged, reset or destroyed.
    DeviceLost,
    /// Hits do not fit into its buffers, even a tile at a time.
    TooManyHits,
    /// It returned offsets that do not add up.
    BadOffsets,
    /// Its results did not fit into memory.
    OutOfMemory,
}

impl GpuFault {
    /// The fault, with the system's message.
    pub(crate) fn in_words(self, system: Option<&str>) -> String {
        let fault = match self {
            Self::Error => "the system reports an error",
            Self::DeviceLost => "the device was lost",
            Self::TooManyHits => "the model has more surface points than its buffers hold",
            Self::BadOffsets => "it returned offsets that do not add up",
            Self::OutOfMemory => "there was not enough memory",
        };
        system.map_or_else(|| fault.to_owned(), |system| format!("{fault} ({system})"))
    }
}

/// Error of sampling an LDI.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum LdiError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    #[serde(rename = "cancelled")]
    Cancelled(#[from] Cancelled),
    /// The hits do not fit into memory.
    #[error(
        "the model needs {needed_bytes} bytes for {hits} surface points at this resolution, more \
         than there is; choose fewer rays"
    )]
    #[serde(rename = "out-of-memory")]
    OutOfMemory {
        /// Hits to be stored.
        hits: u64,
        /// Bytes that this takes.
        needed_bytes: u64,
    },
    /// More facets than an index can hold.
    #[error("{facets} facets are too many; at most {most} can be sliced")]
    #[serde(rename = "too-many-facets")]
    TooManyFacets {
        /// Facets of the mesh.
        facets: u64,
        /// The maximum number.
        most: u64,
    },
    /// No ray meets the model.
    #[error(
        "no pixel of {pitch_mm} mm hits the model, which is too small or too thin; choose smaller \
         pixels"
    )]
    #[serde(rename = "no-hits")]
    NoHits {
        /// Side of a pixel.
        pitch_mm: f64,
    },
    /// No GPU was found, or it could not be opened.
    #[error("no usable GPU: {system}")]
    #[serde(rename = "no-gpu")]
    NoGpu {
        /// The system's message, untranslated.
        system: String,
    },
    /// Only hardware was asked for, and the GPU is emulated.
    #[error("no usable GPU: {adapter} is emulated in software")]
    #[serde(rename = "gpu-emulated")]
    GpuEmulated {
        /// Its name.
        adapter: String,
    },
    /// The mesh does not fit into the buffers that the GPU offers.
    #[error(
        "{facets} facets need a GPU buffer of {needed_bytes} bytes, and this GPU offers {limit_bytes}; use the CPU"
    )]
    #[serde(rename = "gpu-too-small")]
    GpuTooSmall {
        /// Facets of the mesh.
        facets: u64,
        /// Bytes that they take.
        needed_bytes: u64,
        /// The largest buffer.
        limit_bytes: u64,
    },
    /// The GPU failed while it was used.
    #[error("the GPU failed: {}", fault.in_words(system.as_deref()))]
    #[serde(rename = "gpu-failed")]
    GpuFailed {
        /// The fault.
        fault: GpuFault,
        /// Untranslated message of the system, if it gave one.
        system: Option<String>,
    },
}

/// A point where a ray meets the surface.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Hit {
    /// Height above the plate in millimetres, never negative.
    pub z_mm: f32,
    /// Facet in the upper 31 bits; the lowest bit is 1 if the ray leaves the solid here.
    surface: u32,
}

impl Hit {
    /// Number of facets that an LDI can index.
    pub const MAX_FACETS: u64 = 1 << 31;

    /// A hit at height `z_mm` with `facet`, an exit if the facet faces up.
    pub fn new(z_mm: f32, facet: u32, is_exit: bool) -> Self {
        Self {
            z_mm,
            surface: facet << 1 | u32::from(is_exit),
        }
    }

    /// Index of the facet in the mesh.
    pub fn facet(self) -> u32 {
        self.surface >> 1
    }

    /// Returns true if the ray, going up, leaves the solid here (the facet faces up).
    pub fn is_exit(self) -> bool {
        self.surface & 1 == 1
    }

    /// The change of the ray's winding number here: 1 at an entry, -1 at an exit.
    pub fn winding(self) -> i32 {
        if self.is_exit() { -1 } else { 1 }
    }

    /// Sort key along the ray: height, then facet. Heights are not negative, so their bits sort as
    /// the heights do.
    #[inline]
    fn key(self) -> u64 {
        u64::from(self.z_mm.to_bits()) << 32 | u64::from(self.surface)
    }

    #[inline]
    fn of_key(key: u64) -> Self {
        Self {
            z_mm: f32::from_bits((key >> 32) as u32),
            surface: key as u32,
        }
    }
}

/// A layered depth image: the hits of all rays of a grid in compressed rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Ldi {
    /// The grid whose pixel centres the rays pass.
    pub grid: Grid,
    /// The hits of ray i, which is column i mod width of row i div width, are
    /// `hits[offsets[i]..offsets[i + 1]]`.
    pub offsets: Vec<u32>,
    /// Hits of all rays, sorted by (height, facet) within each ray.
    pub hits: Vec<Hit>,
    /// Classes of the facets of the sampled mesh.
    pub classes: FacetClasses,
}

impl Ldi {
    /// The hits of a ray, from the plate upward.
    #[inline]
    pub fn ray(&self, ray: usize) -> &[Hit] {
        &self.hits[self.offsets[ray] as usize..self.offsets[ray + 1] as usize]
    }

    /// Number of rays.
    pub fn rays(&self) -> usize {
        self.offsets.len() - 1
    }
}

fn check_facets(mesh: &Mesh) -> Result<(), LdiError> {
    let facets = mesh.facets.len() as u64;
    if facets > Hit::MAX_FACETS {
        return Err(LdiError::TooManyFacets {
            facets,
            most: Hit::MAX_FACETS,
        });
    }
    Ok(())
}
