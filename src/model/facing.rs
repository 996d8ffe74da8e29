//! Facets that face the wrong way.
//!
//! Two facets at an edge face the same way if they use it in opposite directions. Facets that share an edge with one other, or a part of
//! it where no vertices were placed to match (a T-junction), form patches. Within a patch the facing is carried from facet to facet; which
//! of its two sides is the outside is decided for the patch as a whole, and by [`super::bodies`] for parts inside other
//! bodies.

use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use super::edges::{Across, Edges, Neighbours};
use super::mesh::sixfold_volume;

/// Facets to turn over, and edges at which no choice is right.
pub(super) struct Facing {
    /// True if each facet is to be turned over.
    pub turned: Vec<bool>,
    /// Edges whose adjacent facets cannot face the same way, as on a Möbius strip.
    pub contradictions: usize,
}

/// Fraction of the disagreeing facets of a patch that suffices to decide for the patch. If fewer agree, its outside is
/// where its volume is positive.
const MAJORITY: f64 = 0.75;

/// Carries the facing of facets across edges. `None` if all facets of each patch agree.
///
/// `rounding` is the distance within which vertices lie on an edge. Cost: linear in facets.
pub(super) fn facing(
    vertices: &[Vec3],
    facets: &[[u32; 3]],
    edges: &Edges,
    rounding: f64,
) -> Option<Facing> {
    let &Edges {
        ref neighbours,
        ref open,
        is_even,
        ..
    } = edges;
    // A patch without a boundary has no T-junctions, and one that agrees along its edges has nothing to carry.
    if is_even && open.is_empty() {
        return None;
    }
    let boundary = boundary(facets, neighbours);
    let joints = joints(&boundary, vertices, rounding);
    if is_even && joints.is_empty() {
        return None;
    }
    let mut carried = carry(facets, neighbours, &joints);
    let mut patches = vec![Patch::default(); carried.patches];
    for (facet, &patch) in carried.patch_of.iter().enumerate() {
        let patch = &mut patches[patch as usize];
        patch.count[usize::from(carried.turned[facet])] += 1;
    }
    if patches.iter().all(|patch| patch.count[1] == 0) && carried.contradictions == 0 {
        return None;
    }
    // Volumes about the middle of the boundary, as if each patch were closed by a cone.
    for edge in &boundary {
        let patch = &mut patches[carried.patch_of[edge.facet as usize] as usize];
        patch.middle += vertices[edge.from as usize].as_dvec3();
        patch.edges += 1;
    }
    for patch in &mut patches {
        patch.middle /= f64::from(patch.edges.max(1));
    }
    for (facet, corners) in facets.iter().enumerate() {
        let patch = &mut patches[carried.patch_of[facet] as usize];
        let corners = corners.map(|vertex| vertices[vertex as usize].as_dvec3() - patch.middle);
        let sixfold = sixfold_volume(corners);
        patch.sixfold_mm3 += if carried.turned[facet] {
            -sixfold
        } else {
            sixfold
        };
    }
    let is_opposite: Vec<bool> = patches.iter().map(Patch::is_opposite).collect();
    for (turned, &patch) in carried.turned.iter_mut().zip(&carried.patch_of) {
        *turned ^= is_opposite[patch as usize];
    }
    Some(Facing {
        turned: carried.turned,
        contradictions: carried.contradictions,
    })
}

#[derive(Clone, Default)]
struct Patch {
    /// Facets that are as in the file, and that are turned.
    count: [usize; 2],
    /// The middle of its boundary; the origin if it has none.
    middle: DVec3,
    edges: u32,
    sixfold_mm3: f64,
}

impl Patch {
    /// Returns true if the facets that were kept are the ones to turn.
    fn is_opposite(&self) -> bool {
        let [kept, turned] = self.count.map(|count| count as f64);
        let enough = MAJORITY * (kept + turned);
        if kept.max(turned) >= enough {
            turned > kept
        } else {
            self.sixfold_mm3 < 0.0
        }
    }
}

/// An edge that only one facet has.
struct BoundaryEdge {
    facet: u32,
    from: u32,
    to: u32,
}

/// Facets whose edges lie on each other: the two facets, and whether they use the shared part in the same direction.
type Joint = (u32, u32, bool);

/// The edges that only one facet has.
fn boundary(facets: &[[u32; 3]], neighbours: &Neighbours) -> Vec<BoundaryEdge> {
    let mut edges = Vec::new();
    for (facet, corners) in facets.iter().enumerate() {
        for edge in 0..3 {
            let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
            if from != to && neighbours.across(facet, edge) == Across::Nothing {
                edges.push(BoundaryEdge {
                    facet: facet as u32,
                    from,
                    to,
                });
            }
        }
    }
    edges
}

/// The pairs of edges that share a part of more than rounding.
fn joints(boundary: &[BoundaryEdge], vertices: &[Vec3], rounding: f64) -> Vec<Joint> {
    let at = |vertex: u32| vertices[vertex as usize].as_dvec3();
    let lengths = boundary
        .iter()
        .map(|edge| at(edge.from).distance(at(edge.to)));
    let total: f64 = lengths.sum();
    // Edges then pass a few cells on average.
    let cell = (total / boundary.len() as f64).max(4.0 * rounding);
    let mut ends: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    let cell_of = |point: DVec3| (point / cell).floor().to_array().map(|it| it as i64);
    let mut leaving: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for (index, edge) in boundary.iter().enumerate() {
        for vertex in [edge.from, edge.to] {
            let edges = leaving.entry(vertex).or_default();
            if edges.is_empty() {
                ends.entry(cell_of(at(vertex))).or_default().push(vertex);
            }
            edges.push(index as u32);
        }
    }
    let mut joints = Vec::new();
    for (index, edge) in boundary.iter().enumerate() {
        let (from, to) = (at(edge.from), at(edge.to));
        let along = to - from;
        let length = along.length();
        let along = along / length;
        // Position of a point along the edge, if the point lies on the edge's line.
        let place = |vertex: u32| {
            let offset = at(vertex) - from;
            let place = offset.dot(along);
            ((offset - along * place).length() <= rounding).then_some(place)
        };
        for_cells(from, to, cell, rounding, |key| {
            for &vertex in ends.get(&key).into_iter().flatten() {
                if vertex == edge.from || vertex == edge.to {
                    continue;
                }
                let within = rounding..length - rounding;
                if !place(vertex).is_some_and(|place| within.contains(&place)) {
                    continue;
                }
                for &other in leaving.get(&vertex).into_iter().flatten() {
                    let other_edge = &boundary[other as usize];
                    let ends = [place(other_edge.from), place(other_edge.to)];
                    if let ([Some(start), Some(end)], true) = (ends, other as usize != index) {
                        let (one, other) = (edge.facet, other_edge.facet);
                        joints.push((one.min(other), one.max(other), end > start));
                    }
                }
            }
        });
    }
    joints.sort_unstable();
    joints.dedup();
    joints
}

/// Calls `visit` with the cells of a lattice that a segment passes, widened by `margin`.
fn for_cells(from: DVec3, to: DVec3, cell: f64, margin: f64, mut visit: impl FnMut([i64; 3])) {
    let along = to - from;
    let axis = (0..3).fold(0, |longest, axis| {
        if along[axis].abs() > along[longest].abs() {
            axis
        } else {
            longest
        }
    });
    let floor = |mm: f64| (mm / cell).floor() as i64;
    let [low, high] = [
        from[axis].min(to[axis]) - margin,
        from[axis].max(to[axis]) + margin,
    ];
    for slab in floor(low)..=floor(high) {
        // The part of the segment within the slab.
        let at = |mm: f64| {
            let part = (mm - from[axis]) / along[axis];
            from + along * part.clamp(0.0, 1.0)
        };
        let ends = [
            at(slab as f64 * cell - margin),
            at((slab + 1) as f64 * cell + margin),
        ];
        let range = |axis: usize| {
            let [a, b] = ends.map(|end| end[axis]);
            floor(a.min(b) - margin)..=floor(a.max(b) + margin)
        };
        let [second, third] = [(axis + 1) % 3, (axis + 2) % 3];
        for i in range(second) {
            for j in range(third) {
                let mut key = [0; 3];
                (key[axis], key[second], key[third]) = (slab, i, j);
                visit(key);
            }
        }
    }
}

struct Carried {
    patch_of: Vec<u32>,
    patches: usize,
    /// True if each facet must be turned for all of its patch to agree with the first.
    turned: Vec<bool>,
    contradictions: usize,
}

fn carry(facets: &[[u32; 3]], neighbours: &Neighbours, joints: &[Joint]) -> Carried {
    const NONE: u32 = u32::MAX;
    let mut joined: FxHashMap<u32, Vec<(u32, bool)>> = FxHashMap::default();
    for &(one, other, is_same) in joints {
        joined.entry(one).or_default().push((other, is_same));
        joined.entry(other).or_default().push((one, is_same));
    }
    let mut patch_of = vec![NONE; facets.len()];
    let mut turned = vec![false; facets.len()];
    let (mut patches, mut contradicted) = (0, 0);
    let mut stack = Vec::new();
    for first in 0..facets.len() {
        if patch_of[first] != NONE {
            continue;
        }
        patch_of[first] = patches;
        stack.push(first as u32);
        while let Some(facet) = stack.pop() {
            let index = facet as usize;
            let corners = facets[index];
            let mut reach = |other: u32, is_same: bool| {
                let turn = turned[index] ^ is_same;
                let other_index = other as usize;
                if patch_of[other_index] == NONE {
                    patch_of[other_index] = patches;
                    turned[other_index] = turn;
                    stack.push(other);
                } else if turned[other_index] != turn {
                    contradicted += 1;
                }
            };
            for edge in 0..3 {
                let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
                if let Across::Facet(other) = neighbours.across(index, edge) {
                    let [a, b, c] = facets[other as usize];
                    let is_same = [(a, b), (b, c), (c, a)].contains(&(from, to));
                    reach(other, is_same);
                }
            }
            for &(other, is_same) in joined.get(&facet).into_iter().flatten() {
                reach(other, is_same);
            }
        }
        patches += 1;
    }
    Carried {
        patch_of,
        patches: patches as usize,
        turned,
        // Seen from both sides.
        contradictions: contradicted / 2,
    }
}
