//! Areas and perimeters in closed form.

use std::f64::consts::PI;

use glam::{DVec2, Vec3};

use super::section;
use crate::common::solids::{self, Triangles};
use crate::common::{assert_near, on_plate, oracle::section_mm2};

/// Perimeter of the polygon of [`solids::circle`].
fn circle_length(quarter: u32) -> f64 {
    let points = solids::circle(quarter);
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(p, q)| p.distance(*q)).sum()
}

/// A closed outline of radius and height, turned about the z axis.
fn turned_about_z(outline: &[DVec2], quarter: u32) -> Triangles {
    let rim = solids::circle(quarter);
    let mut triangles = Triangles::new();
    for (&p, &q) in rim.iter().zip(rim.iter().cycle().skip(1)) {
        for (&a, &b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let at = |way: DVec2, corner: DVec2| (way * corner.x).extend(corner.y).as_vec3();
            triangles.push([at(p, a), at(q, a), at(q, b)]);
            triangles.push([at(p, a), at(q, b), at(p, b)]);
        }
    }
    triangles
}

#[test]
fn a_cube_has_the_same_square_at_each_height() {
    for z in [0.001, 2.5, 5.0, 9.999] {
        let (area, length, polygons) = section(&solids::cube(10.0), z);
        assert_eq!((area, length), (100.0, 40.0));
        assert_eq!(polygons.len(), 1);
        // The diagonals of its facets leave no points.
        assert_eq!(polygons[0].outer.points.len(), 4);
        assert!(polygons[0].holes.is_empty());
    }
}

#[test]
fn a_cylinder_and_a_cone_have_scaled_circles() {
    for quarter in [1, 8, 40] {
        let (unit_area, unit_length) = (solids::circle_area(quarter), circle_length(quarter));
        for z in [0.5, 3.0, 8.7] {
            let (area, length, _) = section(&solids::cylinder(6.0, 9.0, quarter), z);
            assert_near(area, unit_area * 36.0, 1e-3);
            assert_near(length, unit_length * 6.0, 1e-3);
            let radius = 4.0 * (1.0 - z / 9.0);
            let (area, length, _) = section(&solids::cone(4.0, 9.0, quarter), z);
            assert_near(area, unit_area * radius * radius, 1e-3);
            assert_near(length, unit_length * radius, 1e-3);
        }
    }
}

#[test]
fn a_sphere_has_the_area_of_its_facets() {
    let ball = solids::sphere(5.0, 5);
    let mesh = on_plate(&ball);
    for tenth in 1..100 {
        let z = f64::from(tenth) / 10.0;
        let (area, length, polygons) = section(&ball, z);
        assert_near(area, section_mm2(&mesh, z), 1e-3);
        let radius = (25.0 - (z - 5.0) * (z - 5.0)).sqrt();
        // Facets are inside the sphere; near its poles they cut off a larger share of the circle.
        let share = area / (PI * radius * radius);
        assert!(
            (0.97..1.0001).contains(&share),
            "{share} of the circle at {z}"
        );
        assert!((0.98..1.0001).contains(&(length / (2.0 * PI * radius))));
        assert_eq!(polygons.len(), 1);
    }
}

#[test]
fn a_torus_has_a_ring_with_a_hole() {
    let (quarter, middle, thick) = (12, 6.0, 2.0);
    let profile: Vec<DVec2> = solids::circle(5)
        .iter()
        .map(|&p| p * thick + DVec2::new(middle, 0.0))
        .collect();
    let torus = turned_about_z(&profile, quarter);
    for z in [0.3, 1.1, 2.0, 3.3] {
        // Points at which the profile crosses the height, relative to its middle.
        let height = z - thick;
        let mut radii: Vec<f64> = profile
            .iter()
            .zip(profile.iter().cycle().skip(1))
            .filter(|(a, b)| (a.y > height) != (b.y > height))
            .map(|(a, b)| a.x + (b.x - a.x) * (height - a.y) / (b.y - a.y))
            .collect();
        radii.sort_by(f64::total_cmp);
        let [inner, outer] = radii[..] else {
            panic!("{radii:?}")
        };
        let (area, length, polygons) = section(&torus, z);
        assert_near(
            area,
            solids::circle_area(quarter) * (outer * outer - inner * inner),
            1e-3,
        );
        assert_near(length, circle_length(quarter) * (outer + inner), 1e-3);
        assert_eq!((polygons.len(), polygons[0].holes.len()), (1, 1));
    }
}

#[test]
fn overlapping_cubes_are_a_union() {
    let mut cubes = solids::cube(10.0);
    cubes.extend(solids::moved(&solids::cube(10.0), Vec3::new(4.0, 6.0, 0.0)));
    let (area, length, polygons) = section(&cubes, 3.0);
    assert_near(area, 200.0 - 6.0 * 4.0, 1e-9);
    assert_near(length, 80.0 - 2.0 * (6.0 + 4.0), 1e-9);
    assert_eq!((polygons.len(), polygons[0].outer.points.len()), (1, 8));
    // Side by side, with a face in common.
    let mut cubes = solids::cube(10.0);
    cubes.extend(solids::moved(
        &solids::cube(10.0),
        Vec3::new(10.0, 0.0, 0.0),
    ));
    let (area, length, polygons) = section(&cubes, 3.0);
    assert_eq!((area, length, polygons.len()), (200.0, 60.0, 1));
    // The same cube twice.
    let twice = [solids::cube(10.0), solids::cube(10.0)].concat();
    assert_eq!(section(&twice, 3.0).0, 100.0);
}

#[test]
fn cavities_are_holes_and_bodies_inside_out_are_not() {
    let mut hollow = solids::cube(10.0);
    let inner = solids::moved(&solids::cube(4.0), Vec3::splat(3.0));
    hollow.extend(solids::inverted(&inner));
    let (area, length, polygons) = section(&hollow, 5.0);
    assert_eq!((area, length), (84.0, 56.0));
    assert_eq!((polygons.len(), polygons[0].holes.len()), (1, 1));
    assert_eq!(section(&hollow, 8.0).0, 100.0);
    // Something in the cavity.
    hollow.extend(solids::moved(&solids::cube(2.0), Vec3::splat(4.0)));
    let (area, _, polygons) = section(&hollow, 5.0);
    assert_eq!((area, polygons.len()), (88.0, 2));
    // Inside out as a whole, and one body of two.
    assert_eq!(
        section(&solids::inverted(&solids::cube(10.0)), 5.0).0,
        100.0
    );
    let mut bodies = solids::cube(10.0);
    bodies.extend(solids::inverted(&solids::moved(
        &solids::cube(6.0),
        Vec3::new(8.0, 2.0, 0.0),
    )));
    assert_near(section(&bodies, 5.0).0, 100.0 + 36.0 - 12.0, 1e-9);
}

#[test]
fn a_section_through_vertices_and_flats_is_that_just_above() {
    // At the seam of two boxes, the upper one counts; at the top of all, nothing does.
    let mut tower = solids::cuboid(Vec3::new(10.0, 10.0, 4.0));
    let upper = solids::cuboid(Vec3::new(6.0, 6.0, 4.0));
    tower.extend(solids::moved(&upper, Vec3::new(2.0, 2.0, 4.0)));
    for (z, area) in [
        (0.0, 100.0),
        (3.999, 100.0),
        (4.0, 36.0),
        (7.999, 36.0),
        (8.0, 0.0),
    ] {
        assert_eq!(section(&tower, z).0, area, "at {z}");
    }
    // Through the vertices of a ball.
    let ball = solids::sphere(5.0, 4);
    let mesh = on_plate(&ball);
    for vertex in mesh.vertices.iter().step_by(7) {
        let z = f64::from(vertex.z);
        assert_near(section(&ball, z).0, section_mm2(&mesh, z), 1e-3);
    }
}

#[test]
fn holes_of_the_mesh_are_closed() {
    let mut open = solids::cube(10.0);
    // Without one half of a side.
    open.remove(4);
    assert_near(section(&open, 5.0).0, 100.0, 1e-9);
}
