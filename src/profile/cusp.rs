//! The cusp height profile: the largest |`n_z`| of the surface in each bin.

use super::Profile;
use crate::grid::Bins;
use crate::ldi::{Hit, Ldi};
use crate::mesh::Mesh;
use crate::parallel;

/// Hits that are worth a thread of their own.
const CHUNK_HITS: usize = 1 << 18;

/// The sampled profile of eq. 5: for each bin the maximum of |`n_z`| over the hits in it, 0 where
/// there are none. `mesh` is the one that `ldi` was sampled from.
///
/// Cost: linear in hits.
pub fn sampled(mesh: &Mesh, ldi: &Ldi, bins: Bins) -> Profile {
    let steepness = mesh.steepness();
    let chunks = ldi
        .hits
        .chunks(CHUNK_HITS.max(ldi.hits.len() / 16))
        .collect();
    let parts = parallel::map(chunks, |hits: &[Hit]| {
        let mut density = vec![0f32; bins.count];
        for hit in hits {
            let value = &mut density[bins.of(f64::from(hit.z_mm))];
            *value = value.max(steepness[hit.facet() as usize]);
        }
        density
    });
    let mut density = vec![0f32; bins.count];
    for part in parts {
        for (value, other) in density.iter_mut().zip(part) {
            *value = value.max(other);
        }
    }
    Profile { bins, density }
}
