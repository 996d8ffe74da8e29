//! Facets that pass through each other.

use glam::{DVec3, IVec3};
use rustc_hash::FxHashMap;

use super::Mesh;

/// Cells along each axis that a facet may meet to be listed in them; larger facets are held against all others.
const MOST_CELLS: i32 = 16;

/// For each of `facets`, true if another facet of the model passes through it, or it through the other. Touching is no crossing.
///
/// Cost: linear in facets where they are of similar sizes.
pub fn crossed(mesh: &Mesh, facets: &[u32]) -> Vec<bool> {
    if facets.is_empty() {
        return Vec::new();
    }
    let cells = Cells::around(mesh, facets);
    let mut seen = Vec::new();
    facets
        .iter()
        .map(|&facet| {
            cells.near(mesh, facet, &mut seen);
            seen.iter().any(|&other| cross(mesh, facet, other))
        })
        .collect()
}

/// The pairs of `facets`, which ascend, and other facets of the model that count, if they pass through each other. Each is there
/// once.
///
/// Cost: linear in facets where they are of similar sizes.
pub fn pairs(mesh: &Mesh, facets: &[u32], counts: impl Fn(u32) -> bool) -> Vec<[u32; 2]> {
    if facets.is_empty() {
        return Vec::new();
    }
    let cells = Cells::around(mesh, facets);
    let (mut seen, mut pairs) = (Vec::new(), Vec::new());
    for &facet in facets {
        cells.near(mesh, facet, &mut seen);
        // A pair of which both are listed belongs to the first.
        let is_new = |other: &u32| *other > facet || facets.binary_search(other).is_err();
        seen.retain(|other| is_new(other) && counts(*other));
        seen.sort_unstable();
        seen.dedup();
        let crossing = seen.iter().filter(|&&other| cross(mesh, facet, other));
        pairs.extend(crossing.map(|&other| [facet, other]));
    }
    pairs
}

/// Facets by the cells that their boxes meet, where some facets are.
struct Cells {
    size_mm: f64,
    /// The cells of these facets.
    listed: FxHashMap<IVec3, Vec<u32>>,
    large: Vec<u32>,
}

impl Cells {
    fn around(mesh: &Mesh, facets: &[u32]) -> Self {
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
        let mut around = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for &facet in facets {
            let [low, high] = bounds(&mesh.corners(facet as usize));
            around = [around[0].min(low), around[1].max(high)];
            let listed = &mut cells.listed;
            each_cell(size_mm, [low, high], &mut |place| {
                listed.entry(place).or_default();
            });
        }
        for facet in 0..end {
            let [low, high] = bounds(&mesh.corners(facet as usize));
            if low.cmpgt(around[1]).any() || around[0].cmpgt(high).any() {
                continue;
            }
            let listed = &mut cells.listed;
            let is_small = each_cell(size_mm, [low, high], &mut |place| {
                if let Some(listed) = listed.get_mut(&place) {
                    listed.push(facet);
                }
            });
            if !is_small {
                cells.large.push(facet);
            }
        }
        cells
    }

    /// Replaces `found` by the facets whose boxes may meet that of a facet, some of them several times.
    fn near(&self, mesh: &Mesh, facet: u32, found: &mut Vec<u32>) {
        found.clear();
        let box_mm = bounds(&mesh.corners(facet as usize));
        let is_small = each_cell(self.size_mm, box_mm, &mut |place| {
            found.extend(self.listed.get(&place).into_iter().flatten());
        });
        if is_small {
            found.extend(&self.large);
        } else {
            found.extend(0..mesh.classes.model_end());
        }
    }
}

/// Calls `visit` with the cells that a box meets. Returns false if they are too many.
fn each_cell(size_mm: f64, bounds_mm: [DVec3; 2], visit: &mut dyn FnMut(IVec3)) -> bool {
    let [low, high] = bounds_mm.map(|it| (it / size_mm).floor().as_ivec3());
    if (high - low).max_element() >= MOST_CELLS {
        return false;
    }
    for x in low.x..=high.x {
        for y in low.y..=high.y {
            for z in low.z..=high.z {
                visit(IVec3::new(x, y, z));
            }
        }
    }
    true
}

#[inline]
fn bounds(corners: &[DVec3; 3]) -> [DVec3; 2] {
    let [a, b, c] = *corners;
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Returns true if two facets without a common vertex pass through each other: an edge of one passes through the other.
fn cross(mesh: &Mesh, facet: u32, other: u32) -> bool {
    let [one, two] = [facet, other].map(|facet| mesh.corners(facet as usize));
    let [[low, high], [other_low, other_high]] = [bounds(&one), bounds(&two)];
    let is_apart = low.cmpgt(other_high).any() || other_low.cmpgt(high).any();
    let shares = || {
        let mut vertices = mesh.facets[facet as usize].iter();
        vertices.any(|vertex| mesh.facets[other as usize].contains(vertex))
    };
    !is_apart && !shares() && (passes_through(&one, &two) || passes_through(&two, &one))
}

/// Returns true if an edge of `one` passes through the inside of `other`.
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
