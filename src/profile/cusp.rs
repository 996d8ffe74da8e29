//! The cusp height profile: the largest |`n_z`| of the surface in each bin.

use super::Profile;
use crate::grid::Bins;
use crate::ldi::Ldi;
use crate::mesh::Mesh;

/// The sampled profile of eq. 5: for each bin the maximum of |`n_z`| over the hits in it, 0 where
/// there are none. `mesh` is the one that `ldi` was sampled from.
///
/// Cost: linear in hits.
pub fn sampled(mesh: &Mesh, ldi: &Ldi, bins: Bins) -> Profile {
    let steepness = mesh.steepness();
    let mut density = vec![0f32; bins.count];
    for hit in &ldi.hits {
        let value = &mut density[bins.of(f64::from(hit.z_mm))];
        *value = value.max(steepness[hit.facet() as usize]);
    }
    Profile { bins, density }
}
