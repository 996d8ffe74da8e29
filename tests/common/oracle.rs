//! Naive implementations that are obviously right, to hold the real ones against.

use cusp_slicer::grid::Grid;
use cusp_slicer::mesh::Mesh;

/// What a ray meets, found by looking at every facet in double precision.
pub struct NaiveRay {
    /// Facets and heights, upward.
    pub hits: Vec<(u32, f64)>,
    /// Whether the ray passes so close to an edge that rounding decides on which side.
    pub is_near_edge: bool,
}

/// Meets the ray through a pixel centre with every facet; `near` is in pixels.
pub fn cast(mesh: &Mesh, grid: &Grid, column: u32, row: u32, near: f64) -> NaiveRay {
    let centre = grid.centre_mm(column, row);
    let mut ray = NaiveRay {
        hits: Vec::new(),
        is_near_edge: false,
    };
    for facet in 0..mesh.facets.len() {
        let corners = mesh.corners(facet);
        let flat = corners.map(|corner| corner.truncate() - centre);
        let area = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]);
        // Distances of the ray from the edges' lines, positive on the facet's side.
        let distance = |i: usize| {
            let (from, to) = (flat[i], flat[(i + 1) % 3]);
            let length = (to - from).length();
            if length == 0.0 {
                0.0
            } else {
                from.perp_dot(to) / length * area.signum()
            }
        };
        let nearest = distance(0).min(distance(1)).min(distance(2));
        ray.is_near_edge |= nearest.abs() < near * grid.pitch_mm;
        if area != 0.0 && nearest > 0.0 {
            let weight = |i: usize| flat[(i + 1) % 3].perp_dot(flat[(i + 2) % 3]) / area;
            let z = (0..3).map(|i| weight(i) * corners[i].z).sum();
            ray.hits.push((facet as u32, z));
        }
    }
    ray.hits.sort_by(|a, b| a.1.total_cmp(&b.1));
    ray
}

/// The least number of layers and whether there is a plan, by trying every set of planes.
pub fn fewest_layers(density: &[f32], thickness: (usize, usize), tolerance: f64) -> Option<usize> {
    let count = density.len();
    (0..1u32 << (count - 1))
        .filter_map(|planes| {
            let mut below = 0;
            let mut layers = 0;
            for plane in 1..=count {
                if plane == count || planes >> (plane - 1) & 1 == 1 {
                    let error: f64 = density[below..plane].iter().map(|&d| f64::from(d)).sum();
                    let bins = plane - below;
                    if bins < thickness.0 || bins > thickness.1 || error > tolerance + 1e-6 {
                        return None;
                    }
                    layers += 1;
                    below = plane;
                }
            }
            Some(layers)
        })
        .min()
}

/// Lines 1 to 7 of Procedure 1 as the paper has them, sums and all.
pub fn procedure_1(
    density: &[u64],
    thickness: (usize, usize),
    tolerance: u64,
) -> (Vec<Option<u32>>, Vec<Option<u32>>) {
    let count = density.len();
    let (mut k, mut d) = (vec![None; count + 1], vec![None; count + 1]);
    k[0] = Some(0u32);
    for i in 1..=count {
        for l in i.saturating_sub(thickness.1)..=i.saturating_sub(thickness.0) {
            if i - l < thickness.0 || density[l..i].iter().sum::<u64>() > tolerance {
                continue;
            }
            if let Some(layers) = k[l]
                && k[i].is_none_or(|best| best > layers + 1)
            {
                k[i] = Some(layers + 1);
                d[i] = Some(l as u32);
            }
        }
    }
    (k, d)
}
