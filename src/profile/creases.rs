//! The creases along which bodies cross. Paths of steepest ascent and descent run along them as along the edges of a mesh: see
//! [`super::normal_cones`].

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::normal_cones::Cone;
use crate::grid::Bins;
use crate::model::Mesh;

/// The creases between facets that pass through each other.
pub(super) struct Creases {
    /// The cones of those between facets of the surface: at a crease towards which both facets fall or rise `n_z²` is 1 − `e_z²`, with e
    /// the unit vector along it; where a crease has its highest or lowest point it is 1. Each has a cone for both facets.
    pub cones: Vec<Cone>,
    /// The bins that creases meet on each facet of the surface, and those beside them: rays meet facets that are moved sideways by up to
    /// 1/512 pixel.
    pub spans: Vec<(u32, [u32; 2])>,
}

/// The creases between `pairs` of facets that pass through each other.
pub(super) fn creases(mesh: &Mesh, bins: Bins, pairs: &[[u32; 2]]) -> Creases {
    let (mut cones, mut spans) = (Vec::new(), Vec::new());
    let is_surface = |facet: u32| (facet as usize) < mesh.surface_facets;
    let mut add = |facets: [u32; 2], heights: [f64; 2], n_z_squared: f64| {
        let [a, b] = heights.map(|z| bins.of(z) as u32);
        cones.extend(facets.map(|facet| Cone {
            facet,
            span: [a.min(b), a.max(b)],
            n_z_squared: n_z_squared as f32,
        }));
    };
    // Ends of creases that only one pair has shown so far, with the heights of both ends.
    let mut ends: FxHashMap<Place, ([u32; 2], [f64; 2])> = FxHashMap::default();
    let mut order = Vec::new();
    for &facets in pairs {
        let crease = Crease::between(mesh, facets);
        let ends_mm = match &crease {
            Some(crease) => crease.ends.map(|end| end.z),
            // It is somewhere on both.
            None => common_heights(mesh, facets),
        };
        let [a, b] = ends_mm.map(|z| bins.of(z) as u32);
        let span = [a.min(b).saturating_sub(1), a.max(b) + 1];
        let on_surface = facets.into_iter().filter(|&facet| is_surface(facet));
        spans.extend(on_surface.map(|facet| (facet, span)));
        let Some(crease) = crease.filter(|_| facets.into_iter().all(is_surface)) else {
            continue;
        };
        let [from, to] = crease.ends;
        let heights = [from.z, to.z];
        if crease.is_sharp {
            add(facets, heights, crease.n_z_squared);
        }
        for (end, other) in [(from, to), (to, from)] {
            let Some((_, [_, before_z])) = ends.remove(&end.place) else {
                ends.insert(end.place, (facets, [end.z, other.z]));
                order.push(end.place);
                continue;
            };
            // The crease goes on beyond an edge, to the same side of its height or to the other.
            if (before_z > end.z) == (other.z > end.z) {
                add(facets, [end.z; 2], 1.0);
            }
        }
    }
    // If rounding hides the continuation of a crease, it may turn there.
    for place in order {
        if let Some((facets, [z, _])) = ends.remove(&place) {
            add(facets, [z; 2], 1.0);
        }
    }
    Creases { cones, spans }
}

/// The lowest and the highest height that both facets have.
fn common_heights(mesh: &Mesh, facets: [u32; 2]) -> [f64; 2] {
    let [one, other] = facets.map(|facet| {
        let [a, b, c] = mesh.corners(facet as usize).map(|corner| corner.z);
        [a.min(b).min(c), a.max(b).max(c)]
    });
    [one[0].max(other[0]), one[1].min(other[1])]
}

/// End of a crease: the edge, by its vertices in ascending order, that passes through a facet.
type Place = ([u32; 2], u32);

#[derive(Clone, Copy)]
struct End {
    place: Place,
    /// Along the crease.
    at: f64,
    z: f64,
}

/// Intersection of two facets.
struct Crease {
    ends: [End; 2],
    n_z_squared: f64,
    is_sharp: bool,
}

impl Crease {
    /// `None` if the facets are parallel or do not pass through each other.
    fn between(mesh: &Mesh, [one, other]: [u32; 2]) -> Option<Self> {
        let [normal, other_normal] = [one, other].map(|facet| {
            let [a, b, c] = mesh.corners(facet as usize);
            (b - a).cross(c - a)
        });
        let along = normal.cross(other_normal);
        let length_squared = along.length_squared();
        if length_squared <= 0.0 {
            return None;
        }
        let mine = ends(mesh, one, other, other_normal, along)?;
        let others = ends(mesh, other, one, normal, along)?;
        // The part that is on both facets.
        let from = later(mine[0], others[0]);
        let to = earlier(mine[1], others[1]);
        // On the surface is the part of each facet that is outside the other's body.
        let outward = |normal: DVec3, beyond: DVec3| {
            let across = along.cross(normal);
            if across.dot(beyond) > 0.0 {
                across.z
            } else {
                -across.z
            }
        };
        let level = along.x * along.x + along.y * along.y;
        (from.at < to.at).then(|| Self {
            ends: [from, to],
            n_z_squared: level / length_squared,
            is_sharp: outward(normal, other_normal) * outward(other_normal, normal) >= 0.0,
        })
    }
}

fn later(one: End, other: End) -> End {
    if other.at > one.at { other } else { one }
}

fn earlier(one: End, other: End) -> End {
    if other.at < one.at { other } else { one }
}

/// Points where the edges of a facet pass through the plane of another, in order along the crease.
fn ends(mesh: &Mesh, facet: u32, other: u32, normal: DVec3, along: DVec3) -> Option<[End; 2]> {
    let corners = mesh.corners(facet as usize);
    let [origin, ..] = mesh.corners(other as usize);
    let sides = corners.map(|corner| normal.dot(corner - origin));
    let vertices = mesh.facets[facet as usize];
    let mut found = (0..3).filter_map(|edge| {
        let next = (edge + 1) % 3;
        let [a, b] = [sides[edge], sides[next]];
        if (a > 0.0) == (b > 0.0) {
            return None;
        }
        let point = corners[edge] + (corners[next] - corners[edge]) * (a / (a - b));
        let [v, w] = [vertices[edge], vertices[next]];
        Some(End {
            place: ([v.min(w), v.max(w)], other),
            at: along.dot(point),
            z: point.z,
        })
    });
    let (first, second) = (found.next()?, found.next()?);
    Some(if first.at <= second.at {
        [first, second]
    } else {
        [second, first]
    })
}
