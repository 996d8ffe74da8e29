//! The bodies of a mesh, and which of them are inside out.
//!
//! A body that is inside out is a cavity where it lies in another, and a mistake where it does not: its overlap with
//! another body would be a void.

use glam::DVec3;

use super::mesh::{Mesh, sixfold_volume};
use crate::argsort::argsort;

/// The body of each facet, identified by the index of one of the body's vertices. Facets belong to one body if they
/// share corners, directly or through other facets.
pub(crate) fn bodies(vertices: usize, facets: &[[u32; 3]]) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..vertices as u32).collect();
    let root = |parents: &mut Vec<u32>, mut vertex: u32| {
        while parents[vertex as usize] != vertex {
            // Path halving.
            let above = parents[parents[vertex as usize] as usize];
            parents[vertex as usize] = above;
            vertex = above;
        }
        vertex
    };
    for &[a, b, c] in facets {
        let of_a = root(&mut parents, a);
        for other in [b, c] {
            let of_other = root(&mut parents, other);
            parents[of_other as usize] = of_a;
        }
    }
    facets
        .iter()
        .map(|corners| root(&mut parents, corners[0]))
        .collect()
}

/// The number of each facet's body, in the order of first facets, and the vertex that identifies each body.
pub(super) fn numbered(mesh: &Mesh) -> (Vec<u32>, Vec<u32>) {
    let body_of = bodies(mesh.vertices.len(), &mesh.facets);
    let mut roots = Vec::new();
    let mut number_of = vec![u32::MAX; mesh.vertices.len()];
    let numbers = body_of.into_iter().map(|root| {
        let number = &mut number_of[root as usize];
        if *number == u32::MAX {
            *number = roots.len() as u32;
            roots.push(root);
        }
        *number
    });
    (numbers.collect(), roots)
}

/// The bodies of a mesh.
pub(super) struct Bodies {
    /// Number of bodies.
    pub count: usize,
    /// Distance of the largest one from the lowest point of all.
    pub largest_above: f64,
    /// The facets of those that face the wrong way: bodies inside out that do not lie within another, and cavities of such bodies. `None`
    /// if there are none.
    pub wrong: Option<Vec<bool>>,
}

/// Finds the bodies of a mesh, and those that face the wrong way.
///
/// Cost: linear in facets. With bodies inside out, each facet also meets the test points of bodies in its range of x.
pub(super) fn find(mesh: &Mesh) -> Bodies {
    let (numbers, roots) = numbered(mesh);
    let found = roots.iter();
    let found = found.map(|&root| Body::new(mesh.vertices[root as usize].as_dvec3()));
    let mut found: Vec<Body> = found.collect();
    for (facet, &number) in numbers.iter().enumerate() {
        found[number as usize].add(mesh.corners(facet));
    }
    let lowest = found.iter().map(Body::lowest).fold(f64::INFINITY, f64::min);
    let larger = |a: &&Body, b: &&Body| a.sixfold_mm3.total_cmp(&b.sixfold_mm3);
    let largest = found.iter().max_by(larger);
    let mut bodies = Bodies {
        count: found.len(),
        largest_above: largest.map_or(0.0, |it| it.lowest() - lowest),
        wrong: None,
    };
    if found.iter().all(|body| body.sixfold_mm3 >= 0.0) {
        return bodies;
    }
    let windings = windings(mesh, &numbers, &found);
    let is_wrong: Vec<bool> = found
        .iter()
        .zip(windings)
        .map(|(body, around)| {
            if body.sixfold_mm3 < 0.0 {
                around.contains(&0)
            } else {
                around.iter().all(|&winding| winding < 0)
            }
        })
        .collect();
    let wrong = numbers.iter().map(|&number| is_wrong[number as usize]);
    bodies.wrong = is_wrong.contains(&true).then(|| wrong.collect());
    bodies
}

struct Body {
    first: DVec3,
    /// Six times the volume, negative if the body is inside out.
    sixfold_mm3: f64,
    /// The vertices farthest along each axis, in both directions.
    ends: [DVec3; 6],
}

/// Inset of a body's test points from its ends towards its middle, as a fraction: a body that merely touches another
/// does not contain it.
const INWARD: f64 = 1.0 / 64.0;

impl Body {
    fn new(first: DVec3) -> Self {
        Self {
            first,
            sixfold_mm3: 0.0,
            ends: [first; 6],
        }
    }

    fn add(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners.map(|corner| corner - self.first);
        self.sixfold_mm3 += sixfold_volume([a, b, c]);
        for corner in corners {
            for axis in 0..3 {
                if corner[axis] < self.ends[axis][axis] {
                    self.ends[axis] = corner;
                }
                if corner[axis] > self.ends[axis + 3][axis] {
                    self.ends[axis + 3] = corner;
                }
            }
        }
    }

    fn lowest(&self) -> f64 {
        self.ends[2].z
    }

    /// Points just within its ends.
    fn points(&self) -> [DVec3; 6] {
        let middle = self.ends.iter().sum::<DVec3>() / 6.0;
        self.ends.map(|end| end + (middle - end) * INWARD)
    }
}

/// Winding numbers of the other bodies around the test points of each body.
fn windings(mesh: &Mesh, numbers: &[u32], bodies: &[Body]) -> Vec<[i32; 6]> {
    let points: Vec<DVec3> = bodies.iter().flat_map(Body::points).collect();
    let around = windings_at(mesh, &points, |facet, point| {
        point / 6 == numbers[facet] as usize
    });
    around.as_chunks().0.to_vec()
}

/// The winding numbers of points, given the facets that a point leaves out.
pub(crate) fn windings_at(
    mesh: &Mesh,
    points: &[DVec3],
    leaves_out: impl Fn(usize, usize) -> bool,
) -> Vec<i32> {
    let order = argsort(points.iter().map(|point| point.x));
    let sorted: Vec<(DVec3, usize)> = order
        .into_iter()
        .map(|place| (points[place], place))
        .collect();
    let mut windings = vec![0; points.len()];
    if points.is_empty() {
        return windings;
    }
    for facet in 0..mesh.classes.model_end() as usize {
        let [a, b, c] = mesh.corners(facet);
        let (least, most) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let first = sorted.partition_point(|(point, _)| point.x < least);
        for &(point, place) in sorted[first..]
            .iter()
            .take_while(|(point, _)| point.x <= most)
        {
            if !leaves_out(facet, place) {
                windings[place] += passes_above([a, b, c], point);
            }
        }
    }
    windings
}

/// Change of the winding number from above a facet to below it if the facet is above the point, otherwise 0. A point
/// above or below an edge counts for one of the two facets at that edge.
pub(crate) fn passes_above([a, b, c]: [DVec3; 3], point: DVec3) -> i32 {
    let [u, v, w] = [a, b, c].map(|corner| (corner - point).truncate());
    // Crossings of the edges with the half-line from the point along +y, each from one side in x to the other.
    let crossing = |from: glam::DVec2, to: glam::DVec2| {
        if (from.x <= 0.0) == (to.x <= 0.0) {
            return 0;
        }
        // The same terms for both facets at an edge, so that exactly one of them counts.
        let (low, high) = if from.x < to.x {
            (from, to)
        } else {
            (to, from)
        };
        let is_above = low.y * (high.x - low.x) - low.x * (high.y - low.y) > 0.0;
        match is_above {
            true if from.x < to.x => -1,
            true => 1,
            false => 0,
        }
    };
    let inside: i32 = crossing(u, v) + crossing(v, w) + crossing(w, u);
    if inside == 0 {
        return 0;
    }
    let normal = (b - a).cross(c - a);
    let height = normal.dot(a - point) / normal.z;
    if height > 0.0 { inside } else { 0 }
}
