//! Circles as polygons, the same on every machine.

use glam::DVec3;

/// Unit vectors around a circle, of which the first is along x: four, and twice as many for each doubling.
///
/// Square roots alone are the same on every machine; sines are not.
pub(super) fn circle(doublings: u32) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    for _ in 0..doublings {
        let next = points.iter().cycle().skip(1);
        let pairs = points.iter().zip(next).flat_map(|(&a, &b)| {
            let middle = [a[0] + b[0], a[1] + b[1]];
            let length = (middle[0] * middle[0] + middle[1] * middle[1]).sqrt();
            [a, [middle[0] / length, middle[1] / length]]
        });
        points = pairs.collect();
    }
    points
}

/// The points of a circle across a direction, a unit vector, from its middle: counter-clockwise as seen from where that leads to.
pub(super) fn rim(along: DVec3, radius_mm: f64, doublings: u32) -> Vec<DVec3> {
    // Beside the axis that it is farthest from.
    let size = along.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let across = axis.cross(along);
    let across = across / across.length();
    let other = along.cross(across);
    let points = circle(doublings).into_iter();
    let points = points.map(|[x, y]| (across * x + other * y) * radius_mm);
    points.collect()
}
