//! Naive implementations that are obviously correct, to test the real ones against.

use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::model::Mesh;
use glam::DVec3;

/// The hits of a ray, found by intersecting it with every facet in double precision.
pub struct NaiveRay {
    /// Facets and heights, in ascending order of height.
    pub hits: Vec<(u32, f64)>,
    /// True if the ray passes so close to an edge that rounding decides the side.
    pub is_near_edge: bool,
}

/// Intersects the ray through a pixel centre with every facet. Closer than `near` pixels counts as near an edge.
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
        // Signed distances of the ray from the lines through the edges, positive on the facet's side.
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

/// The constraints of a plan, in bins.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Minimum and maximum thickness of the layer above each boundary.
    pub thickness: Vec<(usize, usize)>,
    /// Boundaries at which there must be a plane.
    pub planes: Vec<usize>,
    /// Every boundary is a multiple of this.
    pub step: usize,
    /// Thickness of the first layer, whatever its error; 0 if it is like all others.
    pub first_layer: usize,
}

impl Rules {
    /// The same thickness range everywhere, and no other constraint.
    pub fn plain(bins: usize, thickness: (usize, usize)) -> Self {
        Self {
            thickness: vec![thickness; bins],
            planes: Vec::new(),
            step: 1,
            first_layer: 0,
        }
    }
}

/// The smallest (cost, maximum error) of all plans, found by trying every set of planes. `error` is that of the layer
/// between two boundaries, `cost` that of a layer, counted from the plate, of a thickness.
pub fn best_plan<E: PartialOrd + Copy + Default>(
    bins: usize,
    rules: &Rules,
    tolerance: E,
    error: impl Fn(usize, usize) -> E,
    cost: impl Fn(usize, usize) -> u64,
) -> Option<(u64, E)> {
    let mut best: Option<(u64, E)> = None;
    'plans: for planes in 0..1u32 << (bins - 1) {
        let is_plane = |plane: usize| plane == bins || planes >> (plane - 1) & 1 == 1;
        if rules.planes.iter().any(|&plane| !is_plane(plane)) {
            continue;
        }
        let (mut below, mut sum, mut worst) = (0, 0, E::default());
        for (layer, plane) in (1..=bins).filter(|&plane| is_plane(plane)).enumerate() {
            let is_fixed = layer == 0 && rules.first_layer > 0;
            let (least, greatest) = match rules.first_layer {
                thickness if is_fixed => (thickness, thickness),
                _ => rules.thickness[below],
            };
            let of_layer = if is_fixed {
                E::default()
            } else {
                error(below, plane)
            };
            let is_thick = (least..=greatest).contains(&(plane - below));
            if !is_thick || plane % rules.step != 0 || of_layer > tolerance {
                continue 'plans;
            }
            sum += cost(layer, plane - below);
            if of_layer > worst {
                worst = of_layer;
            }
            below = plane;
        }
        let is_better = |best: &(u64, E)| sum < best.0 || sum == best.0 && worst < best.1;
        if best.as_ref().is_none_or(is_better) {
            best = Some((sum, worst));
        }
    }
    best
}

/// K and D by lines 1 to 7 of Procedure 1 as printed in the paper, including the sums. ∞ is `u64::MAX`; D of such a plane
/// is 0.
pub fn procedure_1(
    density: &[u64],
    thickness: (usize, usize),
    tolerance: u64,
) -> (Vec<u64>, Vec<u32>) {
    let count = density.len();
    let (mut k, mut d) = (vec![u64::MAX; count + 1], vec![0; count + 1]);
    k[0] = 0;
    for i in 1..=count {
        for l in i.saturating_sub(thickness.1)..=i.saturating_sub(thickness.0) {
            if i - l < thickness.0 || density[l..i].iter().sum::<u64>() > tolerance {
                continue;
            }
            if k[l] != u64::MAX && k[i] > k[l] + 1 {
                k[i] = k[l] + 1;
                d[i] = l as u32;
            }
        }
    }
    (k, d)
}

/// The largest |`n_z`| of the facets whose height range meets each bin, found by a loop over every facet and bin; -1 if
/// there are none.
pub fn steepest(mesh: &Mesh, bins: Bins, counts: impl Fn(usize) -> bool) -> Vec<f64> {
    (0..bins.count)
        .map(|bin| {
            (0..mesh.surface_facets)
                .filter(|&facet| counts(facet))
                .filter(|&facet| {
                    let heights = mesh.corners(facet).map(|corner| bins.of(corner.z));
                    (*heights.iter().min().unwrap()..=*heights.iter().max().unwrap()).contains(&bin)
                })
                .map(|facet| {
                    let [a, b, c] = mesh.corners(facet);
                    (b - a).cross(c - a).normalize().z.abs()
                })
                .fold(-1.0, f64::max)
        })
        .collect()
}

/// Area of the section at a height, in mm²: the segments in which facets meet the plane, summed by Green's theorem.
pub fn section_mm2(mesh: &Mesh, z_mm: f64) -> f64 {
    let mut twice = 0.0;
    for facet in 0..mesh.facets.len() {
        let corners = mesh.corners(facet);
        let is_above = corners.map(|corner| corner.z > z_mm);
        let ends: Vec<_> = (0..3)
            .filter(|&i| is_above[i] != is_above[(i + 1) % 3])
            .map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                // With counter-clockwise corners, the section leaves the facet at the edge that goes up.
                let point = a + (b - a) * ((z_mm - a.z) / (b.z - a.z));
                (is_above[i], point.truncate())
            })
            .collect();
        if let [p, q] = ends[..] {
            let (from, to) = if p.0 { (p.1, q.1) } else { (q.1, p.1) };
            twice += from.perp_dot(to);
        }
    }
    twice.abs() / 2.0
}

/// The generalised winding number, by sums of solid angles: an oracle of inside and outside.
pub fn winding(triangles: impl Iterator<Item = [DVec3; 3]>, point: DVec3) -> f64 {
    let angles = triangles.map(|corners| {
        let [a, b, c] = corners.map(|corner| corner - point);
        let [x, y, z] = [a, b, c].map(DVec3::length);
        let rest = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * a.dot(b.cross(c)).atan2(rest)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}
