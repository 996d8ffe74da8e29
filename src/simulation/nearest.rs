//! Distances to the facets of the model, and winding numbers: a bounding volume hierarchy over all facets.

use glam::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vec3;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use crate::model::Mesh;

/// The corners of a facet.
pub(super) type Triangle = [DVec3; 3];

/// A direction without a relation to axes, so that rays along it miss the edges of ordinary models.
const RAY: DVec3 = DVec3::new(0.528_371, 0.339_817, 0.778_043);

/// The facets of a model, caps over holes included.
pub(super) struct Facets {
    /// Corners of each facet, in the mesh's order.
    pub triangles: Vec<Triangle>,
    bvh: Bvh,
    /// Facets that [`Self::nearest`] passes over.
    is_skipped: Vec<bool>,
}

/// A facet and the square of its distance, in mm².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    /// Index of the facet.
    pub facet: u32,
    /// Square of the distance to it.
    pub squared: f64,
}

impl Facets {
    pub fn of(mesh: &Mesh) -> Self {
        let triangles: Vec<_> = (0..mesh.facets.len())
            .map(|facet| mesh.corners(facet))
            .collect();
        let boxes: Vec<_> = triangles.iter().map(around).collect();
        Self {
            bvh: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes),
            is_skipped: vec![false; triangles.len()],
            triangles,
        }
    }

    /// Passes over these facets from now on, unless that would leave none.
    pub fn skip(&mut self, is_skipped: Vec<bool>) {
        if is_skipped.contains(&false) {
            self.is_skipped = is_skipped;
        }
    }

    /// The facet nearest to a point. `hint` is any facet that counts; the nearer it is, the faster the search.
    pub fn nearest(&self, point: DVec3, hint: Option<u32>) -> Near {
        let mut near = Near {
            facet: u32::MAX,
            squared: f64::INFINITY,
        };
        if let Some(facet) = hint {
            near = self.to(point, facet);
        }
        let single = point.as_vec3();
        let single = Vec3::new(single.x, single.y, single.z);
        let limit = (near.squared as f32).min(f32::MAX);
        let found = self.bvh.find_best(
            limit,
            |node: &BvhNode, _| squared_to_box(node, single),
            |facet, _| {
                let counts = !self.is_skipped[facet as usize];
                counts.then(|| self.to(point, facet).squared as f32)
            },
        );
        if let Some((facet, _)) = found {
            let other = self.to(point, facet);
            if other.squared < near.squared {
                near = other;
            }
        }
        near
    }

    /// The distance of a point from a facet.
    pub fn to(&self, point: DVec3, facet: u32) -> Near {
        let triangle = &self.triangles[facet as usize];
        Near {
            facet,
            squared: (nearest_on(triangle, point) - point).length_squared(),
        }
    }

    /// The winding number of all facets around a point that is on none of them.
    pub fn winding(&self, point: DVec3) -> i32 {
        let origin = Vec3::new(point.x as f32, point.y as f32, point.z as f32);
        let inverse = (DVec3::ONE / RAY).as_vec3();
        let inverse = Vec3::new(inverse.x, inverse.y, inverse.z);
        let meets = |node: &BvhNode| {
            let (low, high) = (node.mins() - origin, node.maxs() - origin);
            // All components of the direction are positive.
            let (enters, leaves) = (
                (low * inverse).max_element(),
                (high * inverse).min_element(),
            );
            // Generous, because single precision rounds.
            leaves >= -1e-3 && enters <= leaves + 1e-3
        };
        let leaves = self.bvh.leaves(meets);
        leaves
            .map(|facet| crossing(&self.triangles[facet as usize], point))
            .sum()
    }

    /// The facets whose boxes come within `margin` of a facet's.
    pub fn beside(&self, facet: usize, margin: f32) -> Vec<u32> {
        let mut near = around(&self.triangles[facet]);
        near.mins -= Vec3::splat(margin);
        near.maxs += Vec3::splat(margin);
        self.bvh.intersect_aabb(&near).collect()
    }
}

fn around(triangle: &Triangle) -> Aabb {
    let [a, b, c] =
        triangle.map(|corner| Vec3::new(corner.x as f32, corner.y as f32, corner.z as f32));
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

fn squared_to_box(node: &BvhNode, point: Vec3) -> f32 {
    let outside = (node.mins() - point)
        .max(point - node.maxs())
        .max(Vec3::ZERO);
    outside.length_squared()
}

/// 1 if the ray from `origin` leaves through the front of a triangle, -1 if it enters, 0 if it misses it.
fn crossing(triangle: &Triangle, origin: DVec3) -> i32 {
    let [a, b, c] = triangle.map(|corner| corner - origin);
    // Exactly opposite for the two directions of an edge, so no ray slips through between two facets.
    let side = |p: DVec3, q: DVec3| RAY.dot(p.cross(q)) >= 0.0;
    let sides = [side(a, b), side(b, c), side(c, a)];
    if sides != [sides[0]; 3] {
        return 0;
    }
    let normal = (b - a).cross(c - a);
    let (along, ahead) = (normal.dot(RAY), normal.dot(a));
    if along == 0.0 || ahead / along <= 0.0 {
        return 0;
    }
    if along > 0.0 { 1 } else { -1 }
}

/// The point of a triangle that is nearest to `point`, by the region of the triangle's plane in which `point` lies
/// (Ericson, Real-Time Collision Detection, 5.1.5).
pub(super) fn nearest_on(&[a, b, c]: &Triangle, point: DVec3) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return b + (c - b) * along;
    }
    let sum = va + vb + vc;
    if sum > 0.0 {
        a + ab * (vb / sum) + ac * (vc / sum)
    } else {
        // A sliver: one of its corners is near enough.
        [a, b, c]
            .into_iter()
            .min_by(|p, q| {
                p.distance_squared(point)
                    .total_cmp(&q.distance_squared(point))
            })
            .unwrap_or(a)
    }
}
