//! The vertices that may be lower than all beside them, along any direction, without a look at every facet.
//!
//! Of two edges that leave a vertex in opposite directions one falls, unless both are nearly level: along most directions they tell that
//! a vertex of a smooth surface is no minimum.

use glam::{DVec3, Vec3};

use crate::model::FacetLists;

/// Two edges at each vertex of a surface that point as far apart as any, or nearly so.
#[derive(Debug)]
pub(super) struct Minima {
    /// x, y and z of the one and of the other, a list each.
    edges_mm: [Vec<f32>; 6],
    longest_mm: f32,
}

impl Minima {
    pub fn new(vertices_mm: &[DVec3], facets: &[[u32; 3]], around: &FacetLists) -> Self {
        let mut edges_mm = [const { Vec::new() }; 6];
        let mut longest_mm = 0.0f32;
        for (vertex, &at_mm) in vertices_mm.iter().enumerate() {
            let beside = around
                .of(vertex)
                .iter()
                .flat_map(|&facet| facets[facet as usize]);
            let edges = beside
                .map(|other| (vertices_mm[other as usize] - at_mm).as_vec3())
                .filter(|edge| *edge != Vec3::ZERO);
            // The edge that points farthest away from another one.
            let opposite = |to: Vec3| {
                let farther = |best: (f32, Vec3), edge: Vec3| {
                    let cosine = edge.dot(to) / edge.length();
                    if cosine < best.0 {
                        (cosine, edge)
                    } else {
                        best
                    }
                };
                edges.clone().fold((f32::INFINITY, Vec3::ZERO), farther).1
            };
            let first = edges.clone().next().unwrap_or(Vec3::ZERO);
            let one = opposite(first);
            let other = opposite(one);
            longest_mm = longest_mm.max(one.length()).max(other.length());
            let coordinates = one.to_array().into_iter().chain(other.to_array());
            for (list, coordinate) in edges_mm.iter_mut().zip(coordinates) {
                list.push(coordinate);
            }
        }
        Self {
            edges_mm,
            longest_mm,
        }
    }

    /// All vertices that are lower than those beside them with `up` up, and some others, in ascending order. The model is of this
    /// height, and heights of vertices are single precision.
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
        let vertices = rises.iter().zip(0u32..);
        vertices
            .filter(|(rises, _)| **rises)
            .map(|(_, vertex)| vertex)
            .collect()
    }
}
