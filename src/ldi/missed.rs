//! Bodies that no ray meets, so that no mask shows them.

use glam::DVec3;

use super::projection::Projection;
use crate::grid::Grid;
use crate::model::{Mesh, bodies, windings_at};

/// Bodies of a model that no ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missed {
    /// Number of such bodies.
    pub bodies: usize,
    /// The middle of the largest, in millimetres.
    pub at_mm: DVec3,
}

/// No number.
const NONE: u32 = u32::MAX;

/// The bodies of a model that no ray of a grid meets; those within others leave nothing out and do not count.
///
/// Cost: nothing for one body; otherwise linear in facets, and for each body missed, in the facets above and below it.
pub fn missed(mesh: &Mesh, grid: &Grid) -> Option<Missed> {
    if mesh.bodies < 2 {
        return None;
    }
    let facets = &mesh.facets[..mesh.classes.model_end() as usize];
    let body_of = bodies(mesh.vertices.len(), facets);
    let projection = Projection::of(&mesh.vertices, facets, grid);
    let mut is_met = vec![false; mesh.vertices.len()];
    for (facet, &body) in body_of.iter().enumerate() {
        let is_met = &mut is_met[body as usize];
        *is_met = *is_met || covers_any(&projection, facet);
    }
    let mut number_of = vec![NONE; mesh.vertices.len()];
    let mut ends: Vec<[DVec3; 2]> = Vec::new();
    let mut numbers = vec![NONE; facets.len()];
    for (facet, &body) in body_of.iter().enumerate() {
        if is_met[body as usize] {
            continue;
        }
        let number = &mut number_of[body as usize];
        if *number == NONE {
            *number = ends.len() as u32;
            ends.push([DVec3::INFINITY, DVec3::NEG_INFINITY]);
        }
        numbers[facet] = *number;
        let [low, high] = &mut ends[*number as usize];
        for corner in mesh.corners(facet) {
            (*low, *high) = (low.min(corner), high.max(corner));
        }
    }
    let middle = |[low, high]: [DVec3; 2]| low + (high - low) * 0.5;
    let points: Vec<DVec3> = ends.iter().map(|&ends| middle(ends)).collect();
    let around = windings_at(mesh, &points, |facet, point| numbers[facet] == point as u32);
    let outside = ends.iter().zip(around);
    let outside = outside.filter(|(_, winding)| *winding == 0);
    let outside: Vec<[DVec3; 2]> = outside.map(|it| *it.0).collect();
    let size = |[low, high]: [DVec3; 2]| (high - low).length_squared();
    let largest = outside
        .iter()
        .copied()
        .reduce(|a, b| if size(b) > size(a) { b } else { a })?;
    Some(Missed {
        bodies: outside.len(),
        at_mm: middle(largest),
    })
}

/// Returns true if a facet covers the centre of any pixel.
fn covers_any(projection: &Projection<'_>, facet: usize) -> bool {
    let (rows, columns) = (projection.rows(facet), projection.columns(facet));
    if rows.is_empty() || columns.is_empty() {
        return false;
    }
    let Some(outline) = projection.outline(facet) else {
        return false;
    };
    rows.into_iter().any(|row| {
        let mut is_covered = false;
        outline.for_each_span(row..row + 1, |_, _| is_covered = true);
        is_covered
    })
}
