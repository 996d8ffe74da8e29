//! Finds the holes of a mesh and closes them.
//!
//! The edges that facets use more often in one direction than in the other form closed loops in any mesh,
//! because the edges of each facet do. Closing every loop therefore balances every edge, and then every
//! ray enters as often as it leaves. Around a patch of flipped facets the loops run twice, and closing
//! them corrects the winding.

use glam::Vec3;
use rustc_hash::FxHashMap;

/// An edge that facets leave open, in the direction in which a cap must use it.
type OpenEdge = (u32, u32);

/// Every edge that is used more often in one direction than in the other, repeated by the difference, in
/// order of its lower vertex.
///
/// A counting sort puts edges into buckets by their lower vertex: linear, and without hashing.
pub(super) fn open_edges(vertex_count: usize, facets: &[[u32; 3]]) -> Vec<OpenEdge> {
    let edges = || {
        facets
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .filter(|(start, end)| start != end)
    };
    // Counts are stored one slot ahead: filling then advances each start to where it belongs.
    let mut starts = vec![0usize; vertex_count + 2];
    for (start, end) in edges() {
        starts[start.min(end) as usize + 2] += 1;
    }
    for vertex in 2..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    // The higher vertex, and whether the edge goes up to it, in one number: all keys are sorted by the same code.
    let mut uses = vec![0u64; starts[vertex_count + 1]];
    for (start, end) in edges() {
        let slot = &mut starts[start.min(end) as usize + 1];
        uses[*slot] = u64::from(start.max(end)) << 1 | u64::from(start < end);
        *slot += 1;
    }
    let mut open = Vec::new();
    for low in 0..vertex_count {
        let bucket = &mut uses[starts[low]..starts[low + 1]];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|left, right| left >> 1 == right >> 1) {
            let upward = edge.iter().filter(|&one| one & 1 == 1).count();
            let downward = edge.len() - upward;
            let (low, high) = (low as u32, (edge[0] >> 1) as u32);
            let missing = if upward > downward {
                (high, low)
            } else {
                (low, high)
            };
            open.extend(std::iter::repeat_n(missing, upward.abs_diff(downward)));
        }
    }
    open
}

/// The loops that open edges form. No loop passes through a vertex twice.
pub(super) fn loops(open: &[OpenEdge]) -> Vec<Vec<u32>> {
    let keys = open.iter();
    let mut keys: Vec<u64> = keys
        .map(|&(start, end)| u64::from(start) << 32 | u64::from(end))
        .collect();
    keys.sort_unstable();
    let open: Vec<OpenEdge> = keys
        .into_iter()
        .map(|key| ((key >> 32) as u32, key as u32))
        .collect();
    let leaving = |vertex: u32| open.partition_point(|edge| edge.0 < vertex);
    // The number of edges leaving a vertex that are already in a loop or the path, at the index of the first of them.
    let mut spent = vec![0usize; open.len()];
    let mut loops = Vec::new();
    let mut path: Vec<u32> = Vec::new();
    let mut place_on_path = FxHashMap::default();
    for &(first, _) in &open {
        let mut vertex = first;
        loop {
            let leaving = leaving(vertex);
            let Some(&(_, next)) = open
                .get(leaving..)
                .and_then(|edges| edges.get(*spent.get(leaving)?))
                .filter(|(start, _)| *start == vertex)
            else {
                break;
            };
            spent[leaving] += 1;
            place_on_path.insert(vertex, path.len());
            path.push(vertex);
            vertex = next;
            if let Some(&start) = place_on_path.get(&vertex) {
                let hole = path.split_off(start);
                for passed in &hole {
                    place_on_path.remove(passed);
                }
                loops.push(hole);
            }
        }
    }
    loops
}

/// Closes a loop by a fan around its centroid, which is added to `vertices`. A triangle needs no centroid.
pub(super) fn cap(hole: &[u32], vertices: &mut Vec<Vec3>, facets: &mut Vec<[u32; 3]>) {
    if let &[a, b, c] = hole {
        facets.push([a, b, c]);
        return;
    }
    if hole.len() < 3 {
        return;
    }
    let sum: glam::DVec3 = hole
        .iter()
        .map(|&vertex| vertices[vertex as usize].as_dvec3())
        .sum();
    let centre = vertices.len() as u32;
    vertices.push((sum / hole.len() as f64).as_vec3());
    let next = hole.iter().cycle().skip(1);
    facets.extend(hole.iter().zip(next).map(|(&a, &b)| [a, b, centre]));
}
