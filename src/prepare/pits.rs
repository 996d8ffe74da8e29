//! Pits: hollows of a void's floor that are too shallow to need a hole of their own, and would keep resin even though
//! the void drains.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::shell::Shell;

/// No pit.
const NONE: u32 = u32::MAX;

/// Raises the floor of each pit to where resin runs out of it, if that is no more than `most_mm` higher: walls become thicker, and nothing
/// stays. `outlets` are the vertices where resin leaves the void.
///
/// Cost: n log n in vertices.
pub(super) fn fill(shell: &mut Shell, most_mm: f32, outlets: &[bool]) {
    let beside = Beside::of(shell);
    let floors = faces_down(shell);
    let vertices = &mut shell.vertices;
    // The height that resin at a vertex must reach to run out, and the vertex that keeps it, if that is another: its pit.
    let mut level_mm = vec![f32::INFINITY; vertices.len()];
    let mut pit = vec![NONE; vertices.len()];
    let mut depth_mm = vec![0.0f32; vertices.len()];
    // Heights above the plate are not negative, so their bits sort like the numbers.
    let place = |z_mm: f32, vertex: u32| Reverse((z_mm.max(0.0).to_bits(), vertex));
    let mut next = BinaryHeap::new();
    for (vertex, at) in vertices.iter().enumerate() {
        if outlets[vertex] {
            level_mm[vertex] = at.z;
            next.push(place(at.z, vertex as u32));
        }
    }
    while let Some(Reverse((_, from))) = next.pop() {
        let kept_mm = level_mm[from as usize];
        for &to in beside.of_vertex(from) {
            let place_of_it = to as usize;
            if level_mm[place_of_it] < f32::INFINITY {
                continue;
            }
            let z_mm = vertices[place_of_it].z;
            level_mm[place_of_it] = z_mm.max(kept_mm);
            if z_mm < kept_mm {
                let of = pit[from as usize];
                let of = if of == NONE { from } else { of };
                pit[place_of_it] = of;
                depth_mm[of as usize] = depth_mm[of as usize].max(kept_mm - z_mm);
            }
            next.push(place(level_mm[place_of_it], to));
        }
    }
    for (vertex, at) in vertices.iter_mut().enumerate() {
        let is_shallow = pit[vertex] != NONE && depth_mm[pit[vertex] as usize] <= most_mm;
        // Surfaces that hang from a ceiling keep no resin.
        if is_shallow && floors[vertex] {
            at.z = level_mm[vertex];
        }
    }
}

/// For each vertex, true if the void is above it.
fn faces_down(shell: &Shell) -> Vec<bool> {
    let mut rises = vec![0.0f32; shell.vertices.len()];
    for facet in &shell.facets {
        let [a, b, c] = facet.map(|vertex| shell.vertices[vertex as usize]);
        let rise = (b - a).cross(c - a).z;
        for &vertex in facet {
            rises[vertex as usize] += rise;
        }
    }
    rises.into_iter().map(|rise| rise < 0.0).collect()
}

/// Adjacency of vertices.
struct Beside {
    /// Neighbours of vertex i are from `starts[i]` to `starts[i + 1]`.
    starts: Vec<u32>,
    vertices: Vec<u32>,
}

impl Beside {
    /// In a closed surface each edge is once in either direction.
    fn of(shell: &Shell) -> Self {
        let mut starts = vec![0; shell.vertices.len() + 1];
        for &vertex in shell.facets.iter().flatten() {
            starts[vertex as usize + 1] += 1;
        }
        for vertex in 0..shell.vertices.len() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut vertices = vec![0; 3 * shell.facets.len()];
        let mut ends = starts.clone();
        for &[a, b, c] in &shell.facets {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let end = &mut ends[from as usize];
                vertices[*end as usize] = to;
                *end += 1;
            }
        }
        Self { starts, vertices }
    }

    fn of_vertex(&self, vertex: u32) -> &[u32] {
        let [from, to] = [vertex, vertex + 1].map(|it| self.starts[it as usize] as usize);
        &self.vertices[from..to]
    }
}
