//! The fast search against one that looks at every face and every facet.

use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::simulation::Knowledge;
use fastrand::Rng;
use glam::{DVec3, Quat, Vec3};

use super::{by_hand, measured};
use crate::common::assert_near;
use crate::common::solids::{Triangles, cuboid, sphere};

/// The faces of a stack: corners in order around each.
struct Faces {
    walls: Vec<[DVec3; 4]>,
    shelves: Vec<[DVec3; 4]>,
}

fn faces(masks: &[Vec<Vec<bool>>], pitch: [f64; 2], tops: &[f64]) -> Faces {
    let (rows, columns) = (masks[0].len() as i32, masks[0][0].len() as i32);
    let is_lit = |layer: i32, row: i32, column: i32| {
        let mask = usize::try_from(layer)
            .ok()
            .and_then(|layer| masks.get(layer));
        let row = usize::try_from(row).ok().and_then(|row| mask?.get(row));
        usize::try_from(column)
            .is_ok_and(|column| row.is_some_and(|row| row.get(column) == Some(&true)))
    };
    let z = |plane: i32| {
        if plane == 0 {
            0.0
        } else {
            tops[plane as usize - 1]
        }
    };
    let at = |column: i32, row: i32, plane: i32| {
        DVec3::new(
            (f64::from(column) - f64::from(columns) / 2.0) * pitch[0],
            (f64::from(rows) / 2.0 - f64::from(row)) * pitch[1],
            z(plane),
        )
    };
    let mut faces = Faces {
        walls: Vec::new(),
        shelves: Vec::new(),
    };
    for layer in 0..=masks.len() as i32 {
        for row in 0..=rows {
            for column in 0..=columns {
                let here = is_lit(layer, row, column);
                let (c, r, l) = (column, row, layer);
                if here != is_lit(l, r, c - 1) {
                    faces.walls.push([
                        at(c, r, l),
                        at(c, r + 1, l),
                        at(c, r + 1, l + 1),
                        at(c, r, l + 1),
                    ]);
                }
                if here != is_lit(l, r - 1, c) {
                    faces.walls.push([
                        at(c, r, l),
                        at(c + 1, r, l),
                        at(c + 1, r, l + 1),
                        at(c, r, l + 1),
                    ]);
                }
                if here != is_lit(l - 1, r, c) {
                    faces.shelves.push([
                        at(c, r, l),
                        at(c + 1, r, l),
                        at(c + 1, r + 1, l),
                        at(c, r + 1, l),
                    ]);
                }
            }
        }
    }
    faces
}

/// Distance from a point to a segment.
fn to_segment(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = (b - a).length_squared();
    let t = if along > 0.0 {
        (point - a).dot(b - a) / along
    } else {
        0.0
    };
    point.distance(a + (b - a) * t.clamp(0.0, 1.0))
}

/// Distance from a point to a convex flat polygon: to its plane if the foot is inside, else to its nearest edge.
fn to_polygon(point: DVec3, corners: &[DVec3]) -> f64 {
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize();
    let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let foot = point - normal * (point - corners[0]).dot(normal);
    if edges().all(|(a, b)| (b - a).cross(foot - a).dot(normal) >= 0.0) {
        return (point - corners[0]).dot(normal).abs();
    }
    edges()
        .map(|(a, b)| to_segment(point, a, b))
        .fold(f64::INFINITY, f64::min)
}

fn nearest<const N: usize>(point: DVec3, polygons: &[[DVec3; N]]) -> f64 {
    let distances = polygons.iter().map(|polygon| to_polygon(point, polygon));
    distances.fold(f64::INFINITY, f64::min)
}

/// Steps along the sides of a facet in which the model is asked.
const STEPS: i32 = 24;

fn check(model: &Triangles, seed: u64) {
    let mut random = Rng::with_seed(seed);
    let pitch = [0.5 + random.f64() * 0.3, 0.5 + random.f64() * 0.3];
    let tops: Vec<f64> = (0..4)
        .scan(0.0, |z, _| {
            *z += 0.2 + random.f64();
            Some(*z)
        })
        .collect();
    let density = 0.2 + 0.6 * random.f64();
    let mut pixel = || random.f64() < density;
    let masks: Vec<Vec<Vec<bool>>> = (0..4)
        .map(|_| (0..6).map(|_| (0..7).map(|_| pixel()).collect()).collect())
        .collect();
    let file = by_hand([7, 6], pitch, &tops, |layer, column, row| {
        u8::from(masks[layer][row as usize][column as usize]) * 255
    });
    let found = measured(model, &file, &Knowledge::default());

    let mesh = Mesh::from_triangles(model).unwrap();
    let mesh = mesh.on_plate(&Pose::default()).unwrap();
    let facets: Vec<[DVec3; 3]> = (0..mesh.facets.len())
        .map(|facet| mesh.corners(facet))
        .collect();
    let faces = faces(&masks, pitch, &tops);

    // From the print: corners and middles of all faces, and for the mean the samples of the documentation.
    let (mut most, mut sum, mut area): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let mut count = |corners: &[DVec3; 4], samples: &[(DVec3, f64)]| {
        let size = (corners[1] - corners[0]).length() * (corners[3] - corners[0]).length();
        for &corner in corners {
            most = most.max(nearest(corner, &facets));
        }
        for &(sample, part) in samples {
            let distance = nearest(sample, &facets);
            most = most.max(distance);
            sum += distance * size * part;
        }
        area += size;
    };
    for wall in &faces.walls {
        let [foot, head] = [(wall[0] + wall[1]) * 0.5, (wall[2] + wall[3]) * 0.5];
        count(
            wall,
            &[(foot, 0.25), ((foot + head) * 0.5, 0.5), (head, 0.25)],
        );
    }
    for shelf in &faces.shelves {
        count(shelf, &[((shelf[0] + shelf[2]) * 0.5, 1.0)]);
    }
    let print = &found.print_to_model;
    assert!(
        print.max_mm >= most - 1e-5,
        "{seed}: {} < {most}",
        print.max_mm
    );
    assert_near(
        print.max_mm,
        nearest(DVec3::from_array(print.at_mm), &facets),
        1e-5,
    );
    assert_near(print.mean_mm, sum / area, 1e-5);

    // From the model: a fine lattice on every facet.
    let all = [faces.walls, faces.shelves].concat();
    let mut most: f64 = 0.0;
    for [a, b, c] in facets {
        for i in 0..=STEPS {
            for j in 0..=STEPS - i {
                let [u, v] = [i, j].map(|step| f64::from(step) / f64::from(STEPS));
                most = most.max(nearest(a + (b - a) * u + (c - a) * v, &all));
            }
        }
    }
    let model = &found.model_to_print;
    let least = most - found.precision_mm;
    assert!(model.max_mm >= least, "{seed}: {} < {least}", model.max_mm);
    assert_near(
        model.max_mm,
        nearest(DVec3::from_array(model.at_mm), &all),
        1e-5,
    );
}

#[test]
fn the_search_finds_what_a_look_at_everything_finds() {
    let turn = Quat::from_xyzw(0.3, -0.4, 0.1, 0.8).normalize();
    let slab = cuboid(Vec3::new(3.0, 2.0, 1.5));
    let slab: Triangles = slab
        .iter()
        .map(|facet| facet.map(|corner| turn * corner))
        .collect();
    for seed in 0..6 {
        check(&slab, seed);
        check(&sphere(1.2, 1), 100 + seed);
    }
}
