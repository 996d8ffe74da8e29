//! Voids.

use cusp_slicer::model::Mesh;
use cusp_slicer::prepare::{Hollowing, Infill, Void, hollow};
use cusp_slicer::progress::silent;
use glam::DVec3;

use crate::common::{on_plate, solids};

const HOLLOWING: Hollowing = Hollowing {
    pillars: false,
    wall_mm: 2.0,
    cavity_mm: 2.0,
    infill: None,
    drains: Vec::new(),
    auto_drain: None,
};

fn void_of(mesh: &Mesh, hollowing: &Hollowing) -> Option<Void> {
    hollow(mesh, hollowing, None, &mut silent).unwrap()
}

/// The distance of a point from a facet.
fn facet_mm(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let is_within = [[a, b], [b, c], [c, a]]
        .iter()
        .all(|&[from, to]| normal.cross(to - from).dot(point - from) >= 0.0);
    if is_within && normal.length() > 0.0 {
        return (point - a).dot(normal.normalize()).abs();
    }
    let edge_mm = |from: DVec3, to: DVec3| {
        let along = (point - from).dot(to - from) / (to - from).length_squared();
        point.distance(from + (to - from) * along.clamp(0.0, 1.0))
    };
    edge_mm(a, b).min(edge_mm(b, c)).min(edge_mm(c, a))
}

/// The distance of a point from the surface, facet by facet.
fn surface_mm(mesh: &Mesh, point: DVec3) -> f64 {
    (0..mesh.facets.len())
        .map(|facet| facet_mm(point, mesh.corners(facet)))
        .fold(f64::INFINITY, f64::min)
}

/// The solid angle of a closed surface around a point, as a fraction of all: 1 inside, 0 outside.
fn winding(void: &Void, point: DVec3) -> f64 {
    let of_facet = |corners: &[u32; 3]| {
        let [a, b, c] =
            corners.map(|vertex| void.shell.vertices[vertex as usize].as_dvec3() - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    let angle: f64 = void.shell.facets.iter().map(of_facet).sum();
    angle / (4.0 * std::f64::consts::PI)
}

#[test]
fn every_edge_of_a_void_is_used_both_ways() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let scale = 40.0 / mesh.bounds().size().z as f32;
        let large: Vec<_> = triangles
            .iter()
            .map(|corners| corners.map(|corner| corner * scale))
            .collect();
        let Some(void) = void_of(&on_plate(&large), &HOLLOWING) else {
            continue;
        };
        let mut edges: Vec<[u32; 2]> = void
            .shell
            .facets
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        let mut back: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [b, a]).collect();
        edges.sort_unstable();
        back.sort_unstable();
        assert!(edges == back, "{name}");
        assert!(void.shell.volume_mm3() > 0.0, "{name}");
    }
}

#[test]
fn a_ball_keeps_a_wall_all_around() {
    let radius = 15.0;
    let mesh = on_plate(&solids::sphere(radius, 6));
    for wall_mm in [1.0, 2.0, 4.0] {
        let hollowing = Hollowing {
            wall_mm,
            ..HOLLOWING
        };
        let void = void_of(&mesh, &hollowing).unwrap();
        let centre = DVec3::new(0.0, 0.0, radius);
        let walls_mm = void
            .shell
            .vertices
            .iter()
            .map(|vertex| radius - vertex.as_dvec3().distance(centre));
        let least_mm = walls_mm.clone().fold(f64::INFINITY, f64::min);
        let most_mm = walls_mm.fold(0.0, f64::max);
        println!(
            "{wall_mm}: {least_mm:.3} to {most_mm:.3}, resolution {}",
            void.resolution_mm
        );
        assert!(least_mm >= wall_mm - void.resolution_mm, "{least_mm}");
        assert!(most_mm <= wall_mm + 2.0 * void.resolution_mm, "{most_mm}");
        let expected = 4.0 / 3.0 * std::f64::consts::PI * (radius - wall_mm).powi(3);
        let found = void.shell.volume_mm3();
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{found} for {expected}"
        );
    }
}

/// A torus that lies flat: `ring` from its middle to that of its tube.
fn torus(ring: f64, tube: f64) -> solids::Triangles {
    let metadata = solids::circle(48);
    let across = solids::circle(24);
    let point = |i: usize, j: usize| {
        let (metadata, across) = (metadata[i % metadata.len()], across[j % across.len()]);
        let away = ring + tube * across.x;
        DVec3::new(metadata.x * away, metadata.y * away, tube * across.y).as_vec3()
    };
    let squares = (0..metadata.len()).flat_map(|i| (0..across.len()).map(move |j| (i, j)));
    squares
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

#[test]
fn the_void_of_a_torus_is_a_thinner_torus() {
    let (ring, tube) = (20.0, 8.0);
    let mesh = on_plate(&torus(ring, tube));
    for wall_mm in [1.0, 2.0, 4.0] {
        let hollowing = Hollowing {
            wall_mm,
            ..HOLLOWING
        };
        let void = void_of(&mesh, &hollowing).unwrap();
        let walls_mm = void.shell.vertices.iter().map(|vertex| {
            let vertex = vertex.as_dvec3();
            let away = vertex.truncate().length() - ring;
            tube - away.hypot(vertex.z - tube)
        });
        let least_mm = walls_mm.clone().fold(f64::INFINITY, f64::min);
        let most_mm = walls_mm.fold(0.0, f64::max);
        assert!(least_mm >= wall_mm - void.resolution_mm, "{least_mm}");
        assert!(most_mm <= wall_mm + 2.0 * void.resolution_mm, "{most_mm}");
        let expected = 2.0 * std::f64::consts::PI.powi(2) * ring * (tube - wall_mm).powi(2);
        let area_mm2 = 2.0 * expected / (tube - wall_mm);
        let found = void.shell.volume_mm3();
        assert!(
            (found - expected).abs() < area_mm2 * void.resolution_mm,
            "{wall_mm}: {found} for {expected}"
        );
    }
}

#[test]
fn a_cube_keeps_its_walls_and_rounds_what_no_cavity_reaches() {
    let (side, wall, radius) = (24.0, HOLLOWING.wall_mm, HOLLOWING.cavity_mm / 2.0);
    let mesh = on_plate(&solids::cube(side as f32));
    let void = void_of(&mesh, &HOLLOWING).unwrap();
    for vertex in &void.shell.vertices {
        let at = vertex.as_dvec3() - DVec3::new(0.0, 0.0, side / 2.0);
        let wall_mm = side / 2.0 - at.abs().max_element();
        assert!(wall_mm >= wall - void.resolution_mm, "{wall_mm}");
    }
    // A cube with rounded edges: its core, six slabs, twelve quarters of cylinders and a ball.
    let core = side - 2.0 * (wall + radius);
    let pi = std::f64::consts::PI;
    let expected = core.powi(3)
        + 6.0 * core.powi(2) * radius
        + 3.0 * core * pi * radius.powi(2)
        + 4.0 / 3.0 * pi * radius.powi(3);
    let found = void.shell.volume_mm3();
    assert!(
        (found / expected - 1.0).abs() < 0.03,
        "{found} for {expected}"
    );
}

#[test]
fn points_are_void_exactly_where_naive_distances_say_so() {
    let mut rng = fastrand::Rng::with_seed(22);
    let mut checked = [0, 0];
    for (name, triangles) in solids::all() {
        let size = on_plate(&triangles).bounds().size().max_element() as f32;
        let large: Vec<_> = triangles
            .iter()
            .map(|corners| corners.map(|corner| corner * (30.0 / size)))
            .collect();
        let mesh = on_plate(&large);
        // Facets within a body are none of its surface, which the naive distance does not know.
        if mesh.facets.len() > 2000 || ["crossing roofs", "frame", "stacked cubes"].contains(&name)
        {
            continue;
        }
        let void = void_of(&mesh, &HOLLOWING);
        let (low, size) = (mesh.bounds().min, mesh.bounds().size());
        for _ in 0..1500 {
            let at = low + size * DVec3::new(rng.f64(), rng.f64(), rng.f64());
            let depth_mm = surface_mm(&mesh, at);
            let is_void = void.as_ref().is_some_and(|void| winding(void, at) > 0.5);
            let resolution_mm = void.as_ref().map_or(0.25, |void| void.resolution_mm);
            if is_void {
                checked[0] += 1;
                assert!(
                    depth_mm > HOLLOWING.wall_mm - resolution_mm,
                    "{name} at {at}: {depth_mm}"
                );
            } else if is_inside(&mesh, at) {
                checked[1] += 1;
                let deep_mm = HOLLOWING.wall_mm + HOLLOWING.cavity_mm / 2.0 + 2.0 * resolution_mm;
                assert!(depth_mm < deep_mm, "{name} at {at}: {depth_mm}");
            }
        }
    }
    println!("{checked:?}");
    assert!(checked.iter().all(|&it| it > 500));
}

/// Returns true if a point is inside, by the facets above it.
fn is_inside(mesh: &Mesh, at: DVec3) -> bool {
    let of_facet = |facet: usize| {
        let [a, b, c] = mesh.corners(facet);
        let side = |from: DVec3, to: DVec3| (to - from).truncate().perp_dot((at - from).truncate());
        let sides = [side(a, b), side(b, c), side(c, a)];
        let up = (b - a).cross(c - a);
        let is_met = sides.iter().all(|&it| it > 0.0) || sides.iter().all(|&it| it < 0.0);
        let is_above = (a - at).dot(up) * up.z > 0.0;
        if is_met && is_above {
            up.z.signum() as i32
        } else {
            0
        }
    };
    (0..mesh.facets.len()).map(of_facet).sum::<i32>() != 0
}

#[test]
fn bodies_that_overlap_or_touch_have_one_void() {
    let cube = solids::cube(16.0);
    let beside = |x: f32| solids::moved(&cube, glam::Vec3::new(x, 0.0, 0.0));
    let whole = void_of(
        &on_plate(&solids::cuboid(glam::Vec3::new(32.0, 16.0, 16.0))),
        &HOLLOWING,
    );
    for x in [16.0, 15.5] {
        let pair: Vec<_> = cube.iter().copied().chain(beside(x)).collect();
        let void = void_of(&on_plate(&pair), &HOLLOWING).unwrap();
        let volumes = [&void, whole.as_ref().unwrap()].map(|void| void.shell.volume_mm3());
        assert!((volumes[0] / volumes[1] - 1.0).abs() < 0.05, "{volumes:?}");
    }
}

#[test]
fn what_is_too_thin_stays_solid() {
    let plate = on_plate(&solids::cuboid(glam::Vec3::new(30.0, 30.0, 5.0)));
    assert_eq!(void_of(&plate, &HOLLOWING), None);
    // A cavity of 2 mm between walls of 2 mm.
    let thicker = on_plate(&solids::cuboid(glam::Vec3::new(30.0, 30.0, 6.6)));
    assert!(void_of(&thicker, &HOLLOWING).is_some());
}

/// The part of space that is in struts, by random points and all lines near them.
fn strut_fraction(infill: &Infill) -> f64 {
    let mut rng = fastrand::Rng::with_seed(7);
    let diagonals = [
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, -1.0],
    ];
    let diagonals = diagonals.map(|it| DVec3::from_array(it).normalize());
    let points = 20_000;
    let is_in_strut = |_: &i32| {
        let at = DVec3::new(rng.f64(), rng.f64(), rng.f64());
        (0..64).any(|node| {
            let node = DVec3::new(
                f64::from(node % 4),
                f64::from(node / 4 % 4),
                f64::from(node / 16),
            );
            let from = (at + 1.0 - node) * infill.spacing_mm;
            let away = |along: DVec3| (from - along * from.dot(along)).length();
            diagonals
                .iter()
                .any(|&along| away(along) < infill.strut_mm / 2.0)
        })
    };
    (0..points).filter(is_in_strut).count() as f64 / f64::from(points)
}

#[test]
fn a_lattice_stands_in_the_void() {
    // A void of five cells a side.
    let mesh = on_plate(&solids::cube(44.0));
    let without = void_of(&mesh, &HOLLOWING).unwrap().shell.volume_mm3();
    let infill = Infill {
        spacing_mm: 8.0,
        strut_mm: 1.2,
    };
    let with = void_of(
        &mesh,
        &Hollowing {
            infill: Some(infill),
            ..HOLLOWING
        },
    )
    .unwrap();
    let left = 1.0 - with.shell.volume_mm3() / without;
    let struts = strut_fraction(&infill);
    println!("{left:.4} for {struts:.4}");
    // The surface runs along chords of the struts, which are a twentieth thinner for it.
    assert!(
        (0.88..1.0).contains(&(left / struts)),
        "{left} for {struts}"
    );
    let at_strut = DVec3::new(2.0, 2.0, 18.0);
    assert!(winding(&with, at_strut) < 0.5);
}

#[test]
fn one_thread_hollows_as_eight_do() {
    let mesh = on_plate(&solids::sphere(15.0, 4));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| void_of(&mesh, &HOLLOWING))
    };
    assert!(on(1) == on(8));
}
