//! Vertices that may be lower than all their neighbours, along any direction, without visiting every facet.
//!
//! Of two edges that leave a vertex in opposite directions one falls, unless both are nearly level: along most
//! directions they show that a vertex of a smooth surface is no minimum. Two more edges, across these, show it for
//! nearly all other vertices.

use glam::{DVec3, Vec3};

use crate::model::FacetLists;

/// Vertices that are examined together.
const BLOCK: usize = 16;

/// Edges at each vertex of a surface, which the others lie between.
#[derive(Debug)]
pub(super) struct Minima {
    /// x, y and z of two edges that point as far apart as any, or nearly so, a list each.
    edges_mm: [Vec<f32>; 6],
    /// The edge most across these two, and the one that points farthest away from it, in millimetres.
    across: Vec<[Vec3; 2]>,
    longest_mm: f32,
}

impl Minima {
    pub fn new(vertices_mm: &[DVec3], facets: &[[u32; 3]], around: &FacetLists) -> Self {
        let mut edges_mm = [const { Vec::new() }; 6];
        let mut acrosses = Vec::with_capacity(vertices_mm.len());
        let mut longest_mm = 0.0f32;
        for (vertex, &at_mm) in vertices_mm.iter().enumerate() {
            let beside = around
                .of(vertex)
                .iter()
                .flat_map(|&facet| facets[facet as usize]);
            let edges = beside
                .map(|other| (vertices_mm[other as usize] - at_mm).as_vec3())
                .filter(|edge| *edge != Vec3::ZERO);
            // The edge of the least worth per length.
            let least = |worth_of: &dyn Fn(Vec3) -> f32| {
                let smaller = |best: (f32, Vec3), edge: Vec3| {
                    let worth = worth_of(edge) / edge.length();
                    if worth < best.0 { (worth, edge) } else { best }
                };
                edges.clone().fold((f32::INFINITY, Vec3::ZERO), smaller).1
            };
            let opposite = |to: Vec3| least(&|edge| edge.dot(to));
            let first = edges.clone().next().unwrap_or(Vec3::ZERO);
            let one = opposite(first);
            let other = opposite(one);
            let along = one - other;
            let across = least(&|edge| edge.dot(along).abs());
            let pairs = [one, other, across, opposite(across)];
            for edge in pairs {
                longest_mm = longest_mm.max(edge.length());
            }
            let coordinates = one.to_array().into_iter().chain(other.to_array());
            for (list, coordinate) in edges_mm.iter_mut().zip(coordinates) {
                list.push(coordinate);
            }
            acrosses.push([pairs[2], pairs[3]]);
        }
        Self {
            edges_mm,
            across: acrosses,
            longest_mm,
        }
    }

    /// All vertices that are lower than their neighbours when `up` points up, and some others, in ascending order. The
    /// model is `height_mm` high, and heights of vertices are single precision.
    pub fn candidates(&self, up: DVec3, height_mm: f32) -> Vec<u32> {
        // More than heights and edges are rounded by.
        let slack_mm = -(height_mm / (1 << 22) as f32 + self.longest_mm / (1 << 20) as f32);
        let up = up.as_vec3();
        let [ax, ay, az, bx, by, bz] = &self.edges_mm;
        let one = ax.iter().zip(ay).zip(az);
        let other = bx.iter().zip(by).zip(bz);
        // Apart from the next, so that the compiler can vectorise.
        let rises: Vec<bool> = one
            .zip(other)
            .map(|(((ax, ay), az), ((bx, by), bz))| {
                let a = ax * up.x + ay * up.y + az * up.z;
                let b = bx * up.x + by * up.y + bz * up.z;
                let lower = if b < a { b } else { a };
                lower >= slack_mm
            })
            .collect();
        let mut candidates = Vec::new();
        for (rises, first) in rises.chunks(BLOCK).zip((0u32..).step_by(BLOCK)) {
            // Few rise: most blocks are passed over as a whole.
            if !rises.iter().fold(false, |any, it| any | it) {
                continue;
            }
            for (&rises, vertex) in rises.iter().zip(first..) {
                let across = self.across[vertex as usize];
                let rise = |edge: Vec3| edge.x * up.x + edge.y * up.y + edge.z * up.z;
                if rises && across.into_iter().all(|edge| rise(edge) >= slack_mm) {
                    candidates.push(vertex);
                }
            }
        }
        candidates
    }
}
