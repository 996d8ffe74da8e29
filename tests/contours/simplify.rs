//! Simplified contours, against those with every point.

use cusp_slicer::contour::{Lattice, Polygon};
use glam::Vec3;

use super::contours_of;
use super::oracle::{distance, segments};
use crate::common::on_plate;
use crate::common::solids::{self, Triangles};

/// Points of outlines, those between corners at most `apart` steps from each other.
fn points(polygons: &[Polygon], apart: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for [a, b] in segments(polygons) {
        let [a, b] = [a, b].map(|end| end.map(f64::from));
        let parts = ((b[0] - a[0]).hypot(b[1] - a[1]) / apart).ceil();
        let at = |part: usize, axis: usize| a[axis] + (b[axis] - a[axis]) * part as f64 / parts;
        points.extend((0..parts as usize).map(|part| [at(part, 0), at(part, 1)]));
    }
    points
}

/// The largest distance from points of outlines to other outlines, in steps.
fn farthest(from: &[Polygon], to: &[Polygon], apart: f64) -> f64 {
    let to = segments(to);
    let nearest = |point: [f64; 2]| {
        let distances = to.iter().map(|&segment| distance(point, segment));
        distances.fold(f64::INFINITY, f64::min)
    };
    points(from, apart)
        .into_iter()
        .map(nearest)
        .fold(0.0, f64::max)
}

fn count(polygons: &[Polygon]) -> usize {
    segments(polygons).len()
}

/// Simplifies some sections of a solid, checks both distances, and returns how many points there were and are.
fn simplified(triangles: &Triangles, sections: usize, tolerance_mm: f64) -> [usize; 2] {
    let mesh = on_plate(triangles);
    let step_mm = Lattice::of(&mesh.bounds()).step_mm();
    let height_mm = mesh.bounds().size().z;
    let sections: Vec<f64> = (0..sections)
        .map(|i| height_mm * (i as f64 + 0.5) / sections as f64)
        .collect();
    let exact = contours_of(&mesh, &sections, 0.0);
    // Contours are valid whatever the tolerance.
    let coarse = contours_of(&mesh, &sections, tolerance_mm);
    let tolerance = tolerance_mm / step_mm;
    for (exact, coarse) in exact.iter().zip(&coarse) {
        let shape = |polygons: &[Polygon]| {
            polygons
                .iter()
                .map(|polygon| polygon.holes.len())
                .collect::<Vec<_>>()
        };
        assert_eq!(shape(&exact.polygons), shape(&coarse.polygons));
        for (from, to) in [(exact, coarse), (coarse, exact)] {
            let length: f64 = segments(&from.polygons)
                .iter()
                .map(|&[a, b]| distance(a.map(f64::from), [b, b]))
                .sum();
            let apart = (tolerance / 2.0).max(length / 1000.0);
            let farthest = farthest(&from.polygons, &to.polygons, apart);
            assert!(farthest <= tolerance, "{farthest} of {tolerance} steps");
        }
    }
    [exact, coarse].map(|all| all.iter().map(|contours| count(&contours.polygons)).sum())
}

#[test]
fn neither_outline_is_farther_than_the_tolerance_from_the_other() {
    let ball = solids::sphere(5.0, 5);
    let mut last = usize::MAX;
    for tolerance_mm in [0.0005, 0.005, 0.05, 0.5] {
        let [before, after] = simplified(&ball, 9, tolerance_mm);
        assert!(
            after < last && after < before,
            "{after} points with {tolerance_mm} mm"
        );
        last = after;
    }
    for tolerance_mm in [0.01, 0.1, 0.4] {
        simplified(&solids::gyroid(2, 20), 5, tolerance_mm);
    }
}

/// Thin tubes, one within another, and small bodies in the corners that chords would cut off: with a tolerance that is larger than all
/// their distances, much would cross.
#[test]
fn what_is_nearer_to_each_other_than_the_tolerance_stays_apart() {
    let mut close = solids::cylinder(5.0, 2.0, 24);
    for (radius, inside_out) in [(4.95, true), (4.9, false), (4.85, true)] {
        let tube = solids::moved(&solids::cylinder(radius, 2.0, 24), Vec3::ZERO);
        close.extend(if inside_out {
            solids::inverted(&tube)
        } else {
            tube
        });
    }
    for direction in solids::circle(9) {
        let place = (direction * 5.03).extend(0.0).as_vec3();
        let grain = solids::moved(&solids::cuboid(Vec3::new(0.02, 0.02, 2.0)), place);
        close.extend(grain);
    }
    for tolerance_mm in [0.02, 0.1, 0.5, 3.0, 100.0] {
        let [before, after] = simplified(&close, 1, tolerance_mm);
        assert!(after <= before);
    }
}

#[test]
fn random_stars_stay_simple() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..40 {
        let mut triangles = Triangles::new();
        for _ in 0..random.usize(1..5) {
            // A prism over a star: corners at random distances from its middle.
            let rim: Vec<_> = solids::circle(random.u32(4..20))
                .iter()
                .map(|&way| way * (0.2 + random.f64() * 4.0))
                .collect();
            let middle = glam::DVec2::new(random.f64() * 6.0, random.f64() * 6.0);
            let at = |p: glam::DVec2, z: f64| (p + middle).extend(z).as_vec3();
            for (&p, &q) in rim.iter().zip(rim.iter().cycle().skip(1)) {
                let centre = glam::DVec2::ZERO;
                triangles.extend([
                    [at(p, 0.0), at(q, 0.0), at(q, 1.0)],
                    [at(p, 0.0), at(q, 1.0), at(p, 1.0)],
                ]);
                triangles.extend([
                    [at(centre, 0.0), at(q, 0.0), at(p, 0.0)],
                    [at(centre, 1.0), at(p, 1.0), at(q, 1.0)],
                ]);
            }
        }
        for tolerance_mm in [0.03, 0.3, 1.0, 4.0] {
            simplified(&triangles, 1, tolerance_mm);
        }
    }
}
