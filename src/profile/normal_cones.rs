//! The normal cones of the surface where facets meet: which normals lie between those of neighbouring facets.
//!
//! A path of steepest ascent or descent over the surface runs along facets, and along the edges towards which the facets on both
//! sides fall (valleys) or rise (ridges). There it is less steep than on either facet. It ends at the vertices where the height has
//! a peak or a pit.

use glam::DVec3;

use super::steepest::{RangeMaxima, raise};
use crate::grid::Bins;
use crate::model::{Across, Mesh};

/// The normals at an edge or a vertex of a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// The facet. An edge or vertex has a cone for each facet that it belongs to.
    pub facet: u32,
    /// The first and the last bin that the edge or vertex meets.
    pub span: [u32; 2],
    /// The largest `n_z²` of the normals.
    pub n_z_squared: f32,
}

/// The cones in which normals are more upright than on the facets themselves: at a ridge or valley `n_z²` is 1 − `e_z²`, with e the
/// unit vector along the edge; at peaks, pits and saddles it is 1.
///
/// An edge of more than two facets counts as a ridge. Edges of caps are left out.
///
/// Cost: linear in facets.
pub fn cones(mesh: &Mesh, bins: Bins) -> Vec<Cone> {
    let slopes: Vec<u8> = (0..mesh.classes.surface_end())
        .map(|facet| slopes(mesh.corners(facet)))
        .collect();
    let mut cones = Vec::new();
    for facet in 0..mesh.surface_facets {
        for edge in 0..3 {
            let is_sharp = match mesh.neighbours.across(facet, edge) {
                Across::Nothing => false,
                Across::Several => true,
                Across::Facet(other) => {
                    let slope = slope_of(&slopes, facet, edge);
                    slope != LEVEL && slopes_across(mesh, &slopes, facet, other as usize, slope)
                }
            };
            if is_sharp {
                cones.push(edge_cone(mesh, bins, facet, edge));
            }
        }
    }
    let crossings = crossings(mesh);
    for (facet, corners) in mesh.facets[..mesh.surface_facets].iter().enumerate() {
        for &vertex in corners {
            if !matches!(crossings[vertex as usize], 1..=3) {
                let bin = bins.of(f64::from(mesh.vertices[vertex as usize].z)) as u32;
                cones.push(Cone {
                    facet: facet as u32,
                    span: [bin; 2],
                    n_z_squared: 1.0,
                });
            }
        }
    }
    cones
}

/// For each bin the larger of `steepest` and the largest `n_z²` of the cones of those facets that count.
pub fn maxima(steepest: &[f32], cones: &[Cone], counts: impl Fn(usize) -> bool) -> Vec<f32> {
    let longest = cones.iter().map(|cone| cone.span[1] - cone.span[0] + 1);
    let mut maxima = RangeMaxima::new(steepest.len(), longest.max().unwrap_or(1));
    for cone in cones.iter().filter(|cone| counts(cone.facet as usize)) {
        maxima.raise(cone.span[0], cone.span[1], cone.n_z_squared);
    }
    let mut maxima = maxima.into_values();
    for (value, &other) in maxima.iter_mut().zip(steepest) {
        raise(value, other);
    }
    maxima
}

/// Slope of a facet at an edge: its steepest line runs along the edge, it rises from the edge, or it falls.
const LEVEL: u8 = 0;
const RISES: u8 = 1;
const FALLS: u8 = 2;

/// The slopes of a facet at its edges, two bits each.
fn slopes(corners: [DVec3; 3]) -> u8 {
    (0..3).fold(0, |slopes, edge| {
        let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
        let (along, inward) = (to - from, corners[(edge + 2) % 3] - from);
        // The height of the third corner above the foot of its perpendicular on the edge, times the edge's length squared.
        let rise = inward.z * along.length_squared() - inward.dot(along) * along.z;
        let slope = if rise > 0.0 {
            RISES
        } else if rise < 0.0 {
            FALLS
        } else {
            LEVEL
        };
        slopes | slope << (2 * edge)
    })
}

fn slope_of(slopes: &[u8], facet: usize, edge: usize) -> u8 {
    slopes[facet] >> (2 * edge) & 3
}

/// Returns true if the facet across an edge of `facet` also has this slope there. A sliver without area only joins
/// facets: its longest edge lies on one side of it, the other two on the other.
fn slopes_across(mesh: &Mesh, slopes: &[u8], facet: usize, other: usize, slope: u8) -> bool {
    // The edges of `from` behind which `to` is.
    let edges_to = |from: usize, to: usize| {
        (0..3).filter(move |&edge| mesh.neighbours.across(from, edge) == Across::Facet(to as u32))
    };
    if other < mesh.surface_facets {
        return edges_to(other, facet).any(|edge| slope_of(slopes, other, edge) == slope);
    }
    let longest = longest_edge(mesh.corners(other));
    edges_to(other, facet).any(|near| {
        (0..3).any(|far| {
            let Across::Facet(behind) = mesh.neighbours.across(other, far) else {
                return false;
            };
            let behind = behind as usize;
            let is_opposite = (near == longest) != (far == longest);
            is_opposite
                && behind < mesh.surface_facets
                && edges_to(behind, other).any(|edge| slope_of(slopes, behind, edge) == slope)
        })
    })
}

fn longest_edge(corners: [DVec3; 3]) -> usize {
    let length = |edge: usize| corners[edge].distance_squared(corners[(edge + 1) % 3]);
    (1..3).fold(0, |longest, edge| {
        if length(longest) < length(edge) {
            edge
        } else {
            longest
        }
    })
}

/// The cone of a ridge or valley.
fn edge_cone(mesh: &Mesh, bins: Bins, facet: usize, edge: usize) -> Cone {
    let corners = mesh.corners(facet);
    let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
    let along = to - from;
    let level = along.x * along.x + along.y * along.y;
    let [a, b] = [from, to].map(|end| bins.of(end.z) as u32);
    Cone {
        facet: facet as u32,
        span: [a.min(b), a.max(b)],
        n_z_squared: (level / (level + along.z * along.z)) as f32,
    }
}

/// For each vertex, how often the facets around it pass through its height: 0 at a peak or pit, 2 on a slope, 4 or more at a saddle.
/// Of vertices at equal heights the one with the larger index counts as higher.
fn crossings(mesh: &Mesh) -> Vec<u8> {
    let mut crossings = vec![0u8; mesh.vertices.len()];
    for &[a, b, c] in &mesh.facets[..mesh.classes.surface_end()] {
        let is_below = |one: u32, other: u32| {
            let [z, other_z] = [one, other].map(|vertex| mesh.vertices[vertex as usize].z);
            z < other_z || z == other_z && one < other
        };
        let (ab, bc, ca) = (is_below(a, b), is_below(b, c), is_below(c, a));
        // The middle one is above one neighbour and below the other.
        let middle = if ab == bc {
            b
        } else if bc == ca {
            c
        } else {
            a
        };
        let crossing = &mut crossings[middle as usize];
        *crossing = crossing.saturating_add(1);
    }
    crossings
}
