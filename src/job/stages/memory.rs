//! Memory of a job, and the choice between hits that are kept and hits that each pass finds again.

use crate::grid::Grid;
use crate::job::Error;
use crate::ldi::{Anew, Hit};
use crate::mask::{Masks, Samples};
use crate::model::Mesh;

/// Bound of a job's memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Memory {
    /// Bytes in all.
    pub bytes: u64,
    /// Models that share them equally.
    pub models: usize,
    /// Permission to find hits again if they do not fit.
    pub leave: Anew,
}

/// A bound that an LDI with its masks would exceed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bound {
    /// Bytes that the job would take with them.
    needed_bytes: u64,
    pub allowed: Memory,
    /// Bytes that masks may take at a time without them.
    pub slab_bytes: u64,
}

/// Bytes per facet of reading, measuring and planning, which hold the mesh several times over.
const FACET_BYTES: u64 = 145;
/// Bytes per facet that remain of that when masks are made.
const KEPT_FACET_BYTES: u64 = 80;
/// Bytes of the program and of data that depends on the height alone.
const PROGRAM_BYTES: u64 = 16 << 20;
/// Bytes of an offset.
const OFFSET_BYTES: u64 = 4;
/// Bytes that masks of a slab take at least.
const LEAST_SLAB_BYTES: u64 = 1 << 20;

/// Estimate of the number of hits: the projected area of all facets, in pixels.
pub(in crate::job) fn hits_of(mesh: &Mesh, rays: &Grid) -> f64 {
    let seen_mm2 = (0..mesh.facets.len()).map(|facet| mesh.projected_mm2(facet));
    seen_mm2.sum::<f64>() / rays.pixel_mm2()
}

impl Memory {
    /// A bound of these bytes for one model.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn of(bytes: u64) -> Self {
        Self {
            bytes,
            models: 1,
            leave: Anew,
        }
    }

    /// `None` if the LDI of a mesh and its masks fit; otherwise what to do without them.
    ///
    /// # Errors
    /// [`Error::MemoryBound`] if that does not fit either.
    pub fn bound(self, mesh: &Mesh, rays: &Grid, samples: Samples) -> Result<Option<Bound>, Error> {
        let hits = hits_of(mesh, rays);
        let pixels = rays.pixels() as u64;
        let facets = mesh.facets.len() as u64;
        let read_bytes = PROGRAM_BYTES + FACET_BYTES * facets;
        let hit_bytes = size_of::<Hit>() as u64 + Masks::bytes_per_hit(samples);
        let needed_bytes = read_bytes + OFFSET_BYTES * pixels + hits as u64 * hit_bytes;
        let models = self.models as u64;
        let share_bytes = self.bytes / models;
        if needed_bytes <= share_bytes {
            return Ok(None);
        }
        // A winding number per ray for each kind of body, and the light of each pixel with the edges of runs.
        let kinds = if mesh.classes.is_model_alone() { 1 } else { 3 };
        let fixed_bytes = PROGRAM_BYTES + KEPT_FACET_BYTES * facets + (kinds + 1) * pixels;
        let least_bytes = read_bytes.max(fixed_bytes + 2 * LEAST_SLAB_BYTES);
        if share_bytes < least_bytes {
            return Err(Error::MemoryBound {
                needed_bytes: models * least_bytes,
                allowed_bytes: self.bytes,
            });
        }
        // Changes are sorted while others are collected.
        let slab_bytes = (share_bytes - fixed_bytes) / 2;
        Ok(Some(Bound {
            needed_bytes: models * needed_bytes,
            allowed: self,
            slab_bytes,
        }))
    }
}

impl Bound {
    pub fn error(self) -> Error {
        Error::MemoryBound {
            needed_bytes: self.needed_bytes,
            allowed_bytes: self.allowed.bytes,
        }
    }
}
