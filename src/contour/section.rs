//! The section of a mesh at a height, as closed loops.
//!
//! A vertex at the height of the section counts as below it, so the section is that just above the plane. Masks have the same rule: a point
//! is lit from an entry, included, to an exit, excluded. Every facet then has corners on both sides or on one, and each edge that crosses
//! the plane gives one point, which is the same for both facets at the edge. As every edge is used equally often in
//! both directions (`model/holes.rs`), as many segments end at a point as begin there: following them closes every
//! loop.

use glam::{DVec2, DVec3};

use super::lattice::Lattice;
use crate::model::{FacetClass, Mesh};

/// A closed path of lattice points; the last is joined to the first.
pub(super) type Path = Vec<[i32; 2]>;

/// The facets that cross the section of each layer.
#[derive(Debug)]
pub(super) struct Crossings {
    /// The facets of layer k are those from `starts[k]` to `starts[k + 1]`.
    starts: Vec<usize>,
    facets: Vec<u32>,
}

impl Crossings {
    /// Lists the facets by ascending heights of sections.
    ///
    /// Cost: linear in facets, times the logarithm of the layers, plus crossings. Memory: 4 bytes per crossing.
    pub fn new(mesh: &Mesh, sections_mm: &[f64]) -> Self {
        let layers = |corners: &[u32; 3]| {
            let heights = corners.map(|vertex| f64::from(mesh.vertices[vertex as usize].z));
            let [low, high] = [
                heights[0].min(heights[1]).min(heights[2]),
                heights[0].max(heights[1]).max(heights[2]),
            ];
            let first = sections_mm.partition_point(|&section| section < low);
            first..first + sections_mm[first..].partition_point(|&section| section < high)
        };
        let mut starts = vec![0; sections_mm.len() + 1];
        for corners in &mesh.facets {
            for layer in layers(corners) {
                starts[layer + 1] += 1;
            }
        }
        for layer in 0..sections_mm.len() {
            starts[layer + 1] += starts[layer];
        }
        let mut next = starts.clone();
        let mut facets = vec![0; starts[sections_mm.len()]];
        for (facet, corners) in mesh.facets.iter().enumerate() {
            for layer in layers(corners) {
                facets[next[layer]] = facet as u32;
                next[layer] += 1;
            }
        }
        Self { starts, facets }
    }

    /// The facets that cross the section of a layer.
    pub fn of(&self, layer: usize) -> &[u32] {
        &self.facets[self.starts[layer]..self.starts[layer + 1]]
    }
}

/// The loops of a section, by what its facets belong to. The solid is to the left.
#[derive(Debug, Default)]
pub(super) struct Loops {
    pub model: Vec<Path>,
    pub voids: Vec<Path>,
    pub supports: Vec<Path>,
}

impl Loops {
    /// Cuts these facets, which are all that cross the section.
    pub fn of(mesh: &Mesh, facets: &[u32], section_mm: f64, lattice: Lattice) -> Self {
        let mut segments = [const { Vec::new() }; 3];
        for &facet in facets {
            let Some(segment) = cut(mesh.corners(facet as usize), section_mm) else {
                continue;
            };
            let [from, to] = segment.map(|end| key(lattice.nearest(end)));
            let kind = match mesh.classes.of(facet) {
                FacetClass::Surface | FacetClass::Cap => 0,
                FacetClass::Void => 1,
                FacetClass::Support => 2,
            };
            if from != to {
                segments[kind].push((from, to));
            }
        }
        let [model, voids, supports] = segments.map(join);
        Self {
            model,
            voids,
            supports,
        }
    }
}

/// The segment in which a facet meets the plane, with the solid to its left.
fn cut(corners: [DVec3; 3], section_mm: f64) -> Option<[DVec2; 2]> {
    let is_above = corners.map(|corner| corner.z > section_mm);
    let crossing = |goes_up: bool| {
        let edge = (0..3).find(|&i| is_above[i] != goes_up && is_above[(i + 1) % 3] == goes_up)?;
        let (start, end) = (corners[edge], corners[(edge + 1) % 3]);
        // From the lower end, so that the facets at both sides of an edge compute the same.
        let (low, high) = if goes_up { (start, end) } else { (end, start) };
        let share = (section_mm - low.z) / (high.z - low.z);
        Some((low + (high - low) * share).truncate())
    };
    // Corners are counter-clockwise seen from outside, so the section leaves the facet at the edge that goes up.
    Some([crossing(false)?, crossing(true)?])
}

/// A point as a number, to sort and compare it quickly.
fn key([x, y]: [i32; 2]) -> u64 {
    u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned())
}

fn point(key: u64) -> [i32; 2] {
    [(key >> 32) as i32, key as i32]
}

/// Joins segments to loops. As many begin at each point as end there. A loop may pass through a point several times.
fn join(mut segments: Vec<(u64, u64)>) -> Vec<Path> {
    segments.sort_unstable();
    // The number of segments from a point that are spent, at the index of the first of them.
    let mut spent = vec![0usize; segments.len()];
    let mut leave = |from: u64| {
        let first = segments.partition_point(|segment| segment.0 < from);
        let segment = segments.get(first + spent.get(first)?)?;
        (segment.0 == from).then(|| {
            spent[first] += 1;
            segment.1
        })
    };
    let mut loops = Vec::new();
    for &(start, _) in &segments {
        let mut path = Path::new();
        let mut at = start;
        while let Some(next) = leave(at) {
            path.push(point(at));
            at = next;
        }
        if path.len() > 2 {
            loops.push(path);
        }
    }
    loops
}
