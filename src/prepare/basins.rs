//! Basins of a void, which keep resin: found from the plate upward.
//!
//! A part of the void that begins by itself holds resin during and after printing, and the film pulls at it until it
//! joins an older part. So each basin needs a hole at its lowest point, unless it is too small to act as a cup when it
//! joins another.

use crate::union_find::find;

/// A basin that is smaller than this where it joins another needs no hole of its own.
const LEAST_MM2: f32 = 1.0;

/// No part.
const NONE: u32 = u32::MAX;

/// A part of the void that begins by itself.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The slice in which it begins, and the node of that slice that is deepest in the void.
    lowest: (usize, usize),
    /// Depth of that node in the void.
    depth_mm: f32,
    /// Its nodes in the last whole slice that it is in.
    nodes: usize,
    /// Its nodes in the slice that is being added, so far.
    nodes_here: usize,
}

/// The parts of the slices so far.
pub(super) struct Basins {
    width: usize,
    node_mm2: f32,
    parent: Vec<u32>,
    parts: Vec<Part>,
    /// The part of each node of the last slice.
    below: Vec<u32>,
    slices: usize,
    /// Parts that joined others and still need holes.
    found: Vec<(usize, usize)>,
}

impl Basins {
    pub fn new(width: usize, nodes: usize, spacing_mm: f32) -> Self {
        Self {
            width,
            node_mm2: spacing_mm * spacing_mm,
            parent: Vec::new(),
            parts: Vec::new(),
            below: vec![NONE; nodes],
            slices: 0,
            found: Vec::new(),
        }
    }

    /// Adds the next slice: nodes are in the void where the field is positive.
    pub fn add(&mut self, field: &[f32]) {
        let slice = self.slices;
        // Nodes that are connected in the slice form one part, whichever parts they stand on.
        let mut here = vec![NONE; field.len()];
        let mut stack = Vec::new();
        // Parts that are in the slice; some more than once.
        let mut touched = Vec::new();
        for first in 0..field.len() {
            if field[first] <= 0.0 || here[first] != NONE {
                continue;
            }
            let begun = self.parts.len() as u32;
            let mut part = Part {
                lowest: (slice, first),
                depth_mm: 0.0,
                nodes: 0,
                nodes_here: 0,
            };
            // Until it is known which part it is, it is marked as a new one.
            let mut on = NONE;
            here[first] = begun;
            stack.push(first);
            let mut nodes = Vec::new();
            while let Some(node) = stack.pop() {
                nodes.push(node);
                if field[node] > part.depth_mm {
                    (part.depth_mm, part.lowest) = (field[node], (slice, node));
                }
                let under = self.below[node];
                if under != NONE {
                    let under = find(&mut self.parent, under);
                    on = if on == NONE {
                        under
                    } else {
                        self.join(on, under)
                    };
                }
                // The border is outside, so each node has neighbours.
                for next in [node - 1, node + 1, node - self.width, node + self.width] {
                    if field[next] > 0.0 && here[next] == NONE {
                        here[next] = begun;
                        stack.push(next);
                    }
                }
            }
            part.nodes_here = nodes.len();
            if on == NONE {
                self.parent.push(begun);
                self.parts.push(part);
                touched.push(begun);
                continue;
            }
            self.parts[on as usize].nodes_here += nodes.len();
            touched.push(on);
            for node in nodes {
                here[node] = on;
            }
        }
        for part in touched {
            let part = &mut self.parts[part as usize];
            if part.nodes_here > 0 {
                (part.nodes, part.nodes_here) = (part.nodes_here, 0);
            }
        }
        self.below = here;
        self.slices += 1;
    }

    /// The slice and the node at which each basin is lowest.
    pub fn finish(self) -> Vec<(usize, usize)> {
        let roots = (0..self.parts.len()).filter(|&part| self.parent[part] == part as u32);
        let roots = roots.map(|part| self.parts[part].lowest);
        let mut all: Vec<_> = self.found.iter().copied().chain(roots).collect();
        all.sort_unstable();
        all
    }

    /// Joins two parts in the older one, and notes the younger if it is a basin.
    fn join(&mut self, a: u32, b: u32) -> u32 {
        let (old, young) = (a.min(b), a.max(b));
        if old == young {
            return old;
        }
        let part = self.parts[young as usize];
        if part.nodes as f32 * self.node_mm2 >= LEAST_MM2 {
            self.found.push(part.lowest);
        }
        self.parent[young as usize] = old;
        self.parts[old as usize].nodes_here += part.nodes_here;
        old
    }
}
