//! Facets that pass through each other.

use glam::{DVec3, IVec3};
use rustc_hash::FxHashMap;

use crate::model::Mesh;

/// Cells along each axis that a facet may meet to be listed in them; larger facets are held against all others.
const MOST_CELLS: i32 = 16;

/// For each of `facets`, whether another facet of the model passes through it, or it through the other. Touching is no crossing.
///
/// Cost: linear in facets where they are of similar sizes.
pub(super) fn crossed(mesh: &Mesh, facets: &[u32]) -> Vec<bool> {
    if facets.is_empty() {
        return Vec::new();
    }
    let cells = Cells::new(mesh);
    let mut seen = Vec::new();
    facets
        .iter()
        .map(|&facet| {
            seen.clear();
            cells.near(mesh, facet, &mut seen);
            let corners = mesh.corners(facet as usize);
            seen.iter().any(|&other| {
                let shares = mesh.facets[facet as usize]
                    .iter()
                    .any(|vertex| mesh.facets[other as usize].contains(vertex));
                !shares && cross(&corners, &mesh.corners(other as usize))
            })
        })
        .collect()
}

/// Facets by the cells that their boxes meet.
struct Cells {
    size_mm: f64,
    listed: FxHashMap<IVec3, Vec<u32>>,
    large: Vec<u32>,
}

impl Cells {
    fn new(mesh: &Mesh) -> Self {
        let end = mesh.classes.model_end();
        let extents = (0..end).map(|facet| {
            let [low, high] = bounds(&mesh.corners(facet as usize));
            (high - low).max_element()
        });
        // A few facets a cell.
        let size_mm = 2.0 * extents.sum::<f64>() / f64::from(end.max(1));
        let mut cells = Self {
            size_mm,
            listed: FxHashMap::default(),
            large: Vec::new(),
        };
        for facet in 0..end {
            match cells.of(&mesh.corners(facet as usize)) {
                Some(places) => {
                    for place in places {
                        cells.listed.entry(place).or_default().push(facet);
                    }
                }
                None => cells.large.push(facet),
            }
        }
        cells
    }

    /// The cells that the box of a facet meets; `None` if they are too many.
    fn of(&self, corners: &[DVec3; 3]) -> Option<impl Iterator<Item = IVec3> + use<>> {
        let [low, high] = bounds(corners).map(|it| (it / self.size_mm).floor().as_ivec3());
        ((high - low).max_element() < MOST_CELLS).then(|| {
            (low.x..=high.x).flat_map(move |x| {
                (low.y..=high.y)
                    .flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
            })
        })
    }

    /// The facets whose boxes may meet that of a facet, some of them several times.
    fn near(&self, mesh: &Mesh, facet: u32, found: &mut Vec<u32>) {
        match self.of(&mesh.corners(facet as usize)) {
            Some(places) => {
                let listed = places.filter_map(|place| self.listed.get(&place));
                found.extend(listed.flatten());
                found.extend(&self.large);
            }
            None => found.extend(0..mesh.classes.model_end()),
        }
    }
}

fn bounds(corners: &[DVec3; 3]) -> [DVec3; 2] {
    let [a, b, c] = *corners;
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Whether an edge of one of two facets passes through the other.
fn cross(one: &[DVec3; 3], other: &[DVec3; 3]) -> bool {
    let [[low, high], [other_low, other_high]] = [bounds(one), bounds(other)];
    let is_apart = low.cmpgt(other_high).any() || other_low.cmpgt(high).any();
    !is_apart && (passes_through(one, other) || passes_through(other, one))
}

/// Whether an edge of `one` passes through the inside of `other`.
fn passes_through(one: &[DVec3; 3], other: &[DVec3; 3]) -> bool {
    let [a, b, c] = *other;
    let side = |point: DVec3| (b - a).cross(c - a).dot(point - a);
    (0..3).any(|edge| {
        let (from, to) = (one[edge], one[(edge + 1) % 3]);
        let (start, end) = (side(from), side(to));
        if start * end >= 0.0 {
            return false;
        }
        // The line winds around all three edges of the facet in the same sense.
        let around = |p: DVec3, q: DVec3| (p - from).cross(q - from).dot(to - from);
        let [u, v, w] = [around(a, b), around(b, c), around(c, a)];
        (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)
    })
}
