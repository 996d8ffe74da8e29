//! Polygons to triangles, by ear cutting.
//!
//! A quadrilateral is cut from its first corner to its third where that diagonal is inside it, as other programs do.
//! Every corner stays a corner, those along a straight edge too: the neighbours of a face may meet there, and a mesh that was
//! closed stays closed. (Libraries drop such corners.)

use glam::{DVec2, DVec3, Vec3};

/// Polygons of more corners are cut as fans, so that a file cannot cost the square of its length. In a flat polygon the
/// folds of a fan cancel out.
const MOST_CORNERS: usize = 4096;

/// Cuts a polygon of at least three corners into two triangles fewer than it has corners, and passes the places of their
/// corners to `take`. They have the orientation of the polygon. A polygon that crosses itself, or has no area, is cut as well,
/// somehow.
pub fn cut(polygon: &[Vec3], mut take: impl FnMut([usize; 3])) {
    let count = polygon.len();
    let flat = if (4..=MOST_CORNERS).contains(&count) {
        flattened(polygon)
    } else {
        None
    };
    let Some(flat) = flat else {
        (1..count - 1).for_each(|corner| take([0, corner, corner + 1]));
        return;
    };
    // Other programs cut a quadrilateral from its first corner to its third, which matters where it is warped.
    if count == 4
        && [[0, 1, 2], [0, 2, 3]].iter().all(|ear| {
            let [a, b, c] = ear.map(|corner| flat[corner]);
            area(a, b, c) > 0.0
        })
    {
        take([0, 1, 2]);
        take([0, 2, 3]);
        return;
    }
    let mut left: Vec<usize> = (0..count).collect();
    let mut at = 0;
    while left.len() > 3 {
        let ear = ear_from(at, &left, &flat);
        let [before, corner, after] = around(ear, &left);
        take([before, corner, after]);
        left.remove(ear);
        // The next search begins behind the new edge, so that ears are cut all around and not from one corner.
        at = if ear < left.len() { ear + 1 } else { 0 };
    }
    take([left[0], left[1], left[2]]);
}

/// The polygon as seen along the axis to which its normal (by Newell) is nearest, so that it turns counter-clockwise; no
/// coordinate is computed. `None` if it has no area.
fn flattened(polygon: &[Vec3]) -> Option<Vec<DVec2>> {
    let origin = polygon[0].as_dvec3();
    let mut normal = DVec3::ZERO;
    for corner in 1..polygon.len() - 1 {
        let a = polygon[corner].as_dvec3() - origin;
        let b = polygon[corner + 1].as_dvec3() - origin;
        normal += a.cross(b);
    }
    let size = normal.abs();
    let most = size.max_element();
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let axis = (0..3).find(|&axis| size[axis] == most)?;
    let [mut right, mut up] = [(axis + 1) % 3, (axis + 2) % 3];
    if normal[axis] < 0.0 {
        (right, up) = (up, right);
    }
    let flat = polygon.iter().map(|corner| {
        let corner = corner.as_dvec3();
        DVec2::new(corner[right], corner[up])
    });
    Some(flat.collect())
}

/// The place in `left` of the next corner from `at` that can be cut off. If none can be, the polygon crosses itself or is
/// flat, and any will do.
fn ear_from(at: usize, left: &[usize], flat: &[DVec2]) -> usize {
    let turn = |place: usize| {
        let [a, b, c] = around(place, left).map(|corner| flat[corner]);
        area(a, b, c)
    };
    // A corner where the polygon turns left can never be the first inside an ear, so only the others are tested.
    let turns: Vec<f64> = (0..left.len()).map(turn).collect();
    let places = (at..left.len()).chain(0..at);
    let mut convex = places.filter(|&place| turns[place] > 0.0);
    let is_ear = |&place: &usize| {
        let [a, b, c] = around(place, left).map(|corner| flat[corner]);
        let mut others = left.iter().zip(&turns).filter(|(_, turn)| **turn <= 0.0);
        !others.any(|(&other, _)| {
            let point = flat[other];
            point != a && point != b && point != c && is_inside(point, [a, b, c])
        })
    };
    convex.find(is_ear).unwrap_or(at.min(left.len() - 1))
}

/// The corner at a place, between its neighbours.
fn around(place: usize, left: &[usize]) -> [usize; 3] {
    let count = left.len();
    [
        left[(place + count - 1) % count],
        left[place],
        left[(place + 1) % count],
    ]
}

/// Twice the area of a triangle: positive if it turns counter-clockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns true if a point is inside a counter-clockwise triangle or on its edge.
fn is_inside(point: DVec2, [a, b, c]: [DVec2; 3]) -> bool {
    area(a, b, point) >= 0.0 && area(b, c, point) >= 0.0 && area(c, a, point) >= 0.0
}
