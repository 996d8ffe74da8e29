//! Surfaces that are made, before they join a mesh.

use glam::{DVec3, Vec3};

/// A closed surface. Corners are counter-clockwise as seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shell {
    /// Vertices in millimetres.
    pub vertices: Vec<Vec3>,
    /// Three vertex indices per facet.
    pub facets: Vec<[u32; 3]>,
}

impl Shell {
    /// The volume enclosed, in mm³, by the divergence theorem.
    pub fn volume_mm3(&self) -> f64 {
        let sixfold: f64 = self
            .facets
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|vertex| self.vertices[vertex as usize].as_dvec3());
                a.dot(b.cross(c))
            })
            .sum();
        sixfold / 6.0
    }

    /// A body between two outlines of equally many points, counter-clockwise as seen from the second.
    pub(super) fn drum(&mut self, first: Vec<DVec3>, second: Vec<DVec3>) {
        let sides = first.len() as u32;
        let begin = self.vertices.len() as u32;
        let points = first.into_iter().chain(second);
        self.vertices.extend(points.map(DVec3::as_vec3));
        let facets = &mut self.facets;
        for side in 0..sides {
            let next = (side + 1) % sides;
            let [a, b] = [side, next].map(|it| begin + it);
            let [c, d] = [a, b].map(|it| it + sides);
            facets.extend([[a, b, d], [a, d, c]]);
        }
        for side in 1..sides - 1 {
            let [a, b] = [side, side + 1].map(|it| begin + it);
            facets.push([begin, b, a]);
            facets.push([begin + sides, a + sides, b + sides]);
        }
    }
}
