//! Heights at which a plane is worth having: flats, so that they print at their true height, and sharp changes of the
//! profile (section 3.3).

use crate::grid::Bins;
use crate::mesh::Mesh;

/// Difference of the cusp height densities of neighbouring bins from which on a change is sharp.
pub const SHARP: f32 = 0.5;

/// A facet is horizontal if `n_z²` of its normal is at least this: within 0.06°.
const HORIZONTAL: f32 = 1.0 - 1e-6;

/// Boundaries of bins where a plane is wished for, the most important first: horizontal facets that together have at
/// least `flat_area_mm2` at one height, by area; then changes of `cusp_density` by more than [`SHARP`], by size.
pub fn wishes(
    mesh: &Mesh,
    hidden: &[bool],
    cusp_density: &[f32],
    bins: Bins,
    flat_area_mm2: f64,
) -> Vec<u32> {
    let mut flats = flats(mesh, hidden, bins);
    flats.retain(|&(_, area_mm2)| area_mm2 >= flat_area_mm2);
    flats.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let changes = cusp_density.windows(2).zip(1u32..);
    let mut sharp: Vec<(u32, f32)> = changes
        .map(|(pair, boundary)| (boundary, (pair[1] - pair[0]).abs()))
        .filter(|&(_, change)| change > SHARP)
        .collect();
    sharp.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let flats = flats.into_iter().map(|(boundary, _)| boundary);
    flats
        .chain(sharp.into_iter().map(|(boundary, _)| boundary))
        .collect()
}

/// The boundaries nearest to horizontal facets, upward, and the area of these in mm².
fn flats(mesh: &Mesh, hidden: &[bool], bins: Bins) -> Vec<(u32, f64)> {
    let mut facets: Vec<(u32, f64)> = (0..mesh.surface_facets)
        .filter(|&facet| hidden.get(facet) != Some(&true) && mesh.n_z_squared(facet) >= HORIZONTAL)
        .map(|facet| {
            let [a, b, c] = mesh.corners(facet);
            let area_mm2 = (b - a).cross(c - a).z.abs() * 0.5;
            let z_mm = (a.z + b.z + c.z) / 3.0;
            (bins.nearest_boundary(z_mm), area_mm2)
        })
        .collect();
    facets.sort_by_key(|&(boundary, _)| boundary);
    facets
        .chunk_by(|a, b| a.0 == b.0)
        .map(|level| {
            (
                level[0].0,
                level.iter().map(|&(_, area_mm2)| area_mm2).sum(),
            )
        })
        .filter(|&(boundary, _)| boundary > 0 && (boundary as usize) < bins.count)
        .collect()
}
