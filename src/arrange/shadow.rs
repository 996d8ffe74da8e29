//! The area of the shadow of a model on the plate.

use glam::{DVec2, DVec3};

use crate::argsort::sort_by_number;
use crate::model::Mesh;

/// Lines across a shadow. Along a line its length is exact; the area of a disc is right to a millionth.
const LINES: usize = 2048;

/// The area that a mesh and its supports cover as seen from above, in mm².
///
/// Cost: linear in facets and in the lines that they cross.
pub fn shadow_mm2(mesh: &Mesh) -> f64 {
    let bounds = mesh.printed_bounds();
    let (low, width) = (bounds.min.y, bounds.size().y / LINES as f64);
    // The line at y = low + (line + 1/2) · width.
    let first_from = |y: f64| ((y - low) / width - 0.5).ceil().clamp(0.0, LINES as f64) as usize;
    let mut spans: Vec<Vec<[f64; 2]>> = vec![Vec::new(); LINES];
    for facet in 0..mesh.facets.len() {
        let corners = mesh.corners(facet).map(DVec3::truncate);
        // The mesh is closed: facets that face downward are in the shadow of those that face upward.
        if (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) <= 0.0 {
            continue;
        }
        let [from, to] = [DVec2::min, DVec2::max]
            .map(|most| corners[1..].iter().fold(corners[0], |a, b| most(a, *b)).y);
        let lines = first_from(from)..first_from(to);
        let start = lines.start;
        for (line, spans) in spans[lines].iter_mut().enumerate() {
            let y = low + ((start + line) as f64 + 0.5) * width;
            spans.push(crossed(corners, y));
        }
    }
    let length = |mut spans: Vec<[f64; 2]>| {
        sort_by_number(&mut spans, |span| span[0]);
        let (mut sum, mut covered_to) = (0.0, f64::NEG_INFINITY);
        for [from, to] in spans {
            sum += (to - from.max(covered_to)).max(0.0);
            covered_to = covered_to.max(to);
        }
        sum
    };
    spans.into_iter().map(length).sum::<f64>() * width
}

/// The part of a line along x that is within a triangle, which it crosses.
fn crossed(corners: [DVec2; 3], y: f64) -> [f64; 2] {
    let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    for edge in 0..3 {
        let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
        if (from.y < y) != (to.y < y) {
            let x = from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y));
            (left, right) = (left.min(x), right.max(x));
        }
    }
    [left, right.max(left)]
}
