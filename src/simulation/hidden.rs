//! Facets that are not on the surface of the solid: inside it, between bodies that overlap, say, or outside, as folds
//! of a surface that enclose nothing. No print shows them.
//!
//! A facet that no other facet meets is hidden or on the surface as a whole, so one point decides. A facet that another
//! one cuts or touches is asked at every point that matters.

use glam::DVec3;

use super::nearest::{Facets, Triangle};
use crate::model::Mesh;
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// Visibility of a facet: on the surface of the solid, or inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Visibility {
    /// All of it is.
    Surface,
    /// Nothing of it is.
    Hidden,
    /// Other facets meet it; parts of it may be hidden.
    Mixed,
}

/// Distance of the points on both sides of a facet that decide if it is hidden, in millimetres. Ten times the error of
/// single precision at 100 mm.
const OFFSET_MM: f64 = 1e-4;
/// Facets closer than this meet, in millimetres.
const TOUCH_MM: f64 = 1e-5;
/// Number of facets that one thread examines.
const RUN: usize = 1024;

/// The visibility of every facet of `mesh`.
pub(super) fn classify(
    mesh: &Mesh,
    facets: &Facets,
    progress: &mut Progress<'_>,
    share: [f64; 2],
) -> Result<Vec<Visibility>, Cancelled> {
    let count = facets.triangles.len();
    let mut all = Vec::with_capacity(count);
    let runs = (0..count)
        .step_by(RUN)
        .map(|first| first..(first + RUN).min(count));
    parallel::map_in_groups(
        runs.collect::<Vec<_>>().into_iter(),
        |run| run.map(|facet| visibility(mesh, facets, facet)).collect(),
        |run: Vec<_>| {
            all.extend(run);
            Ok::<_, Cancelled>(())
        },
        progress,
        share,
    )?;
    Ok(all)
}

fn visibility(mesh: &Mesh, facets: &Facets, facet: usize) -> Visibility {
    let [a, b, c] = facets.triangles[facet];
    if !meeting(mesh, facets, facet as u32).is_empty() {
        Visibility::Mixed
    } else if is_hidden(facets, facet as u32, (a + b + c) / 3.0) {
        Visibility::Hidden
    } else {
        Visibility::Surface
    }
}

/// A facet that meets another one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    facet: u32,
    /// Beyond this distance, in millimetres, it does not meet a part of the other. Neighbours touch where they join, so for
    /// them it is negative.
    limit: f64,
}

impl Meeting {
    /// Returns true if it meets a part of the other facet.
    pub fn meets(&self, facets: &Facets, part: &Triangle) -> bool {
        !are_apart(part, &facets.triangles[self.facet as usize], self.limit)
    }
}

/// The facets that meet a facet. Where none meets a part of it, all of that part is hidden, or none.
pub(super) fn meeting(mesh: &Mesh, facets: &Facets, facet: u32) -> Vec<Meeting> {
    let corners = mesh.facets[facet as usize];
    let beside = facets.beside(facet as usize, TOUCH_MM as f32).into_iter();
    let beside = beside.filter(|&other| other != facet).map(|other| {
        let other_corners = mesh.facets[other as usize];
        let share = other_corners.iter().any(|corner| corners.contains(corner));
        Meeting {
            facet: other,
            limit: if share { -TOUCH_MM } else { TOUCH_MM },
        }
    });
    let triangle = &facets.triangles[facet as usize];
    beside.filter(|it| it.meets(facets, triangle)).collect()
}

/// Returns true if both sides of a facet are inside the solid at one of its points, or both outside. Inside is a winding number other
/// than zero.
pub(super) fn is_hidden(facets: &Facets, facet: u32, point: DVec3) -> bool {
    let [a, b, c] = facets.triangles[facet as usize];
    let Some(normal) = (b - a).cross(c - a).try_normalize() else {
        return false;
    };
    let is_inside = |side: f64| facets.winding(point + normal * (side * OFFSET_MM)) != 0;
    is_inside(1.0) == is_inside(-1.0)
}

/// Returns true if two triangles are more than `limit` apart along some axis on which convex bodies that do not meet have a gap.
/// A negative limit allows that much overlap.
fn are_apart(one: &Triangle, two: &Triangle, limit: f64) -> bool {
    let edges = |[a, b, c]: &Triangle| [b - a, c - b, a - c];
    let (first, second) = (edges(one), edges(two));
    let normals = [first[0].cross(first[1]), second[0].cross(second[1])];
    let has_gap = |axis: DVec3| {
        let length = axis.length();
        if length < 1e-12 {
            return false;
        }
        let span = |triangle: &Triangle| {
            let along = triangle.map(|corner| corner.dot(axis));
            (
                along[0].min(along[1]).min(along[2]),
                along[0].max(along[1]).max(along[2]),
            )
        };
        let ((low, high), (other_low, other_high)) = (span(one), span(two));
        (other_low - high).max(low - other_high) > limit * length
    };
    normals.into_iter().any(has_gap)
        || first
            .iter()
            .flat_map(|&p| second.iter().map(move |&q| p.cross(q)))
            .any(has_gap)
        || first.iter().any(|&edge| has_gap(normals[0].cross(edge)))
        || second.iter().any(|&edge| has_gap(normals[1].cross(edge)))
}
