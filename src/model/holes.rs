//! The holes of a mesh, and their caps.
//!
//! The edges that facets use more often in one direction than in the other form closed loops in any mesh,
//! because the edges of each facet do. Closing every loop therefore balances every edge, and then every
//! ray enters as often as it leaves. Around a patch of flipped facets the loops run twice, and closing
//! them corrects the winding.

use glam::Vec3;
use rustc_hash::FxHashMap;

use super::edges::OpenEdge;

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
