//! The union of many bodies, against a raster of their boxes.

use glam::Vec3;

use super::{contours_of, oracle};
use crate::common::on_plate;
use crate::common::solids::{self, Triangles};
use cusp_slicer::contour::{Lattice, Polygon, Ring};

const SIDE: usize = 12;

/// Boxes with whole coordinates, as [from, to] along each axis.
fn boxes(random: &mut fastrand::Rng, count: usize) -> Vec<[[usize; 2]; 3]> {
    let mut span = || {
        let from = random.usize(0..SIDE - 1);
        [from, random.usize(from + 1..SIDE)]
    };
    (0..count).map(|_| [span(), span(), span()]).collect()
}

#[test]
fn random_boxes_are_their_raster() {
    let mut random = fastrand::Rng::with_seed(11);
    for round in 0..150 {
        let count = random.usize(1..12);
        let boxes = boxes(&mut random, count);
        let mut triangles = Triangles::new();
        for [x, y, z] in &boxes {
            let size = Vec3::new(
                (x[1] - x[0]) as f32,
                (y[1] - y[0]) as f32,
                (z[1] - z[0]) as f32,
            );
            let corner = Vec3::new(x[0] as f32, y[0] as f32, z[0] as f32);
            triangles.extend(solids::moved(&solids::cuboid(size), corner));
        }
        let ends = |axis: usize| {
            let least = boxes.iter().map(|of| of[axis][0]).min().unwrap();
            let most = boxes.iter().map(|of| of[axis][1]).max().unwrap();
            (least, most)
        };
        let ((left, right), (front, back), (foot, top)) = (ends(0), ends(1), ends(2));
        let mesh = on_plate(&triangles);
        let steps = (1.0 / Lattice::of(&mesh.bounds()).step_mm()).round() as i64;
        // At the planes of the boxes as well, where the side above counts.
        let sections: Vec<f64> = (0..2 * (top - foot))
            .map(|half| half as f64 / 2.0)
            .collect();
        for contours in contours_of(&mesh, &sections, 0.0) {
            let z = contours.heights.section_mm + foot as f64;
            let is_in = |x: isize, y: isize| {
                boxes.iter().any(|[xs, ys, zs]| {
                    let within = |at: isize, [from, to]: [usize; 2]| {
                        (from as isize..to as isize).contains(&at)
                    };
                    within(x, *xs) && within(y, *ys) && within(z.floor() as isize, *zs)
                })
            };
            let (mut cells, mut edges) = (0, 0);
            for x in -1..SIDE as isize {
                for y in -1..SIDE as isize {
                    edges += i32::from(is_in(x, y) != is_in(x + 1, y))
                        + i32::from(is_in(x, y) != is_in(x, y + 1));
                    cells += i32::from(is_in(x, y));
                    // Four times the centre of the cell, relative to the middle of all.
                    let middle = [
                        2 * x + 1 - (left + right) as isize,
                        2 * y + 1 - (front + back) as isize,
                    ];
                    let half_steps = middle.map(|of| of as i64 * steps);
                    let found = oracle::contains(&contours.polygons, half_steps);
                    assert_eq!(found, Some(is_in(x, y)), "round {round}, {x}, {y} at {z}");
                }
            }
            let rings = || contours.polygons.iter().flat_map(Polygon::rings);
            let (area, length): (f64, f64) = (
                rings().map(Ring::area).sum(),
                rings().map(Ring::length).sum(),
            );
            let steps = steps as f64;
            assert_eq!(
                (area / steps / steps, length / steps),
                (f64::from(cells), f64::from(edges)),
                "round {round} at {z}"
            );
        }
    }
}

#[test]
fn bodies_askew_are_valid_and_have_the_area_of_their_raster() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..20 {
        let mut triangles = Triangles::new();
        let mut turned = Vec::new();
        for _ in 0..9 {
            let mut number = || random.f32() * 2.0 - 1.0;
            let turn = glam::Quat::from_xyzw(number(), number(), number(), number()).normalize();
            let middle = Vec3::new(number(), number(), number()) * 5.0;
            let size = Vec3::new(number() + 1.5, number() + 1.5, number() + 1.5) * 3.0;
            let body = solids::moved(&solids::cuboid(size), -size / 2.0);
            triangles.extend(
                body.iter()
                    .map(|corners| corners.map(|corner| turn * corner + middle)),
            );
            turned.push((turn, middle, size));
        }
        let mesh = on_plate(&triangles);
        // The foot of the model's middle before it was placed.
        let corners = triangles.iter().flatten();
        let (least, most) = corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), &c| {
            (a.min(c), b.max(c))
        });
        let foot = least.midpoint(most).with_z(least.z);
        let lattice = Lattice::of(&mesh.bounds());
        let sections: Vec<f64> = (1..8)
            .map(|eighth| mesh.bounds().size().z * f64::from(eighth) / 8.0)
            .collect();
        for contours in contours_of(&mesh, &sections, 0.0) {
            let segments = oracle::segments(&contours.polygons);
            for _ in 0..400 {
                let at = [random.i32(-80_000..80_000), random.i32(-80_000..80_000)];
                let point = (lattice.to_mm(at))
                    .extend(contours.heights.section_mm)
                    .as_vec3()
                    + foot;
                let is_in = turned.iter().any(|(turn, middle, size)| {
                    let local = turn.conjugate() * (point - *middle);
                    local.abs().cmple(*size / 2.0).all()
                });
                // Within a micrometre of an outline, rounding to single precision decides.
                if segments
                    .iter()
                    .all(|&segment| oracle::distance(at.map(f64::from), segment) > 100.0)
                {
                    let half_steps = at.map(|of| 2 * i64::from(of));
                    assert_eq!(
                        oracle::contains(&contours.polygons, half_steps),
                        Some(is_in)
                    );
                }
            }
        }
    }
}
