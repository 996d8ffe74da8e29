//! Reading OBJ: every way to write a corner, polygons of any shape, and an error with its line for every invalid file.

use std::fmt::Write as _;

use cusp_slicer::model::Mesh;
use cusp_slicer::model::read::obj::ObjError;
use cusp_slicer::model::read::{ReadError, read as any};
use glam::{DVec3, Vec3};

use crate::common::{assert_near, solids};

const CUBE: &str = "# a cube\r\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.25 1\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n\
    v 0 1 1\nvt 0 0\nvn 0 0 1\no part\ng side\nusemtl red\ns off\nf 4 3 2 1\nf 5/1 6/1 7/1 8/1\nf 1//1 2//1 6//1 5//1\n\
    f 2/1/1 3/1/1 7/1/1 6/1/1\nf 3 4 8 7\nf -8 \\\n-4 -1\\\r\n -5\nl 1 2\n";

#[track_caller]
fn read(text: &str) -> Result<Vec<[Vec3; 3]>, ObjError> {
    let contents = any(text.as_bytes()).map_err(|error| match error {
        ReadError::Obj(error) => error,
        other => panic!("{other}"),
    })?;
    assert_eq!(contents.unit, None);
    Ok(contents.triangles)
}

/// An OBJ of these triangles, each with vertices of its own.
pub fn obj(triangles: &[[Vec3; 3]]) -> String {
    let mut text = String::new();
    for Vec3 { x, y, z } in triangles.iter().flatten() {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for at in (1..=3 * triangles.len()).step_by(3) {
        let _ = writeln!(text, "f {at} {} {}", at + 1, at + 2);
    }
    text
}

#[test]
fn every_way_to_write_a_corner_gives_the_same_cube() {
    let mesh = Mesh::from_triangles(&read(CUBE).unwrap()).unwrap();
    assert!(mesh.is_closed());
    assert_eq!((mesh.vertices.len(), mesh.surface_facets), (8, 12));
    assert_near(mesh.volume_mm3(), 1.0, 1e-12);
}

#[test]
fn line_ends_and_a_byte_order_mark_make_no_difference() {
    let triangles = solids::sphere(3.0, 2);
    let text = obj(&triangles);
    for text in [
        text.clone(),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.replace(' ', "\t "),
    ] {
        assert_eq!(read(&text).unwrap(), triangles);
    }
}

#[test]
fn comments_may_end_a_line() {
    let commented: Vec<String> = CUBE
        .lines()
        .map(|line| match line.split(' ').next() {
            Some("v" | "f") if !line.ends_with('\\') => format!("{line} # note 1"),
            _ => line.to_owned(),
        })
        .collect();
    assert_eq!(read(&commented.join("\n")), read(CUBE));
    assert_eq!(read(&CUBE.replace("4 3 2 1", "4 3 2 1 #note")), read(CUBE));
}

#[test]
fn warped_quadrilaterals_are_cut_from_the_first_corner_to_the_third() {
    let text = "v 0 0 0\nv 4 0 1\nv 4 4 0\nv 0 4 1\nf 1 2 3 4\nf 2 3 4 1\n";
    let [a, b, c, d] = [[0, 0, 0], [4, 0, 1], [4, 4, 0], [0, 4, 1]]
        .map(|corner: [i16; 3]| Vec3::from(corner.map(f32::from)));
    let expected = [[a, b, c], [a, c, d], [b, c, d], [b, d, a]];
    assert_eq!(read(text).unwrap(), expected);
    // If that diagonal is outside, the other one is taken.
    let arrow = "v 0 0 0\nv 4 1 0\nv 0 4 0\nv 1 1 0\nf 1 2 3 4\n";
    let cut = read(arrow).unwrap();
    let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).z;
    assert!(cut.iter().all(|&corners| area(corners) > 0.0));
    assert_eq!(cut.iter().map(|&corners| area(corners)).sum::<f32>(), 6.0);
}

#[test]
fn vertices_may_follow_the_faces_that_need_them() {
    let forward = read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap();
    assert_eq!(forward, [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
}

#[test]
fn errors_name_the_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let corner = |line, found: &str| ObjError::BadCorner {
        line,
        found: found.to_owned(),
        vertices: 3,
    };
    let vertex = |line, found: &str| ObjError::BadVertex {
        line,
        found: found.to_owned(),
    };
    // One polygon, round and round the same corners.
    let endless = format!("f{}", " 1 2 3".repeat(100_000));
    let most_facets = (1 << 16) + (start.len() + endless.len()) / 12;
    let cases = [
        ("f 1 2 4", corner(4, "4")),
        ("f 1 2 0", corner(4, "0")),
        ("\nf 1 2 -4/1", corner(5, "-4/1")),
        ("f 1 2 x", corner(4, "x")),
        (
            "f 1 2 99999999999999999999",
            corner(4, "99999999999999999999"),
        ),
        ("f 1 \\\n2 \\\n9", corner(4, "9")),
        ("f 1 2 \\\n3\nf 1 2 9", corner(6, "9")),
        (
            "f 1 2",
            ObjError::FewCorners {
                line: 4,
                corners: 2,
            },
        ),
        ("v 1 2", vertex(4, "")),
        ("v 1 2,5 3", vertex(4, "2,5")),
        ("v 1 inf 3", vertex(4, "inf")),
        ("v 1 1e40 3", vertex(4, "1e40")),
        (
            "surf 0 1 0 1 1 2 3",
            ObjError::FreeForm {
                line: 4,
                keyword: "surf".to_owned(),
            },
        ),
        (
            &endless,
            ObjError::TooMany {
                line: 4,
                most_facets,
            },
        ),
        ("", ObjError::NoFaces),
    ];
    for (text, expected) in cases {
        assert_eq!(read(&format!("{start}{text}")), Err(expected), "{text}");
    }
    assert!(read(&format!("{start}f 1 2 3 \\")).is_ok());
}

/// Twice the area vector of a closed outline, by Newell.
fn area(outline: &[DVec3]) -> DVec3 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a.cross(*b)).sum()
}

/// The triangles of one polygon.
fn cut(outline: &[DVec3]) -> Vec<[Vec3; 3]> {
    let mut text = String::new();
    for DVec3 { x, y, z } in outline {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    text.push('f');
    for corner in 1..=outline.len() {
        let _ = write!(text, " {corner}");
    }
    read(&text).unwrap()
}

/// Two triangles fewer than corners, every one turning as the outline does, so that they cover it once.
#[track_caller]
fn assert_cut_well(outline: &[DVec3]) {
    let triangles = cut(outline);
    assert_eq!(triangles.len(), outline.len() - 2);
    let whole = area(outline);
    let normal = whole.normalize();
    let mut sum = 0.0;
    for corners in triangles {
        let [a, b, c] = corners.map(glam::Vec3::as_dvec3);
        let part = (b - a).cross(c - a).dot(normal);
        assert!(
            part > -1e-5 * whole.length(),
            "a triangle is turned over: {part}"
        );
        sum += part.abs();
    }
    assert_near(sum, whole.length(), 1e-4 * whole.length());
}

#[test]
fn polygons_are_covered_once_however_they_bend_and_lie() {
    let mut random = fastrand::Rng::with_seed(20);
    for round in 0..300 {
        // A star around a centre, whose outline does not cross itself; some are so deep that few corners are ears.
        let corners = random.usize(4..40);
        let star = (0..corners).map(|corner| {
            let angle = std::f64::consts::TAU * corner as f64 / corners as f64;
            let radius = if corner % 2 == 0 {
                5.0
            } else {
                0.2 + 6.0 * random.f64()
            };
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        });
        let mut outline: Vec<DVec3> = star.collect();
        if round % 3 == 0 {
            outline.reverse();
        }
        let axis = DVec3::new(random.f64() - 0.5, random.f64() - 0.5, random.f64() - 0.5);
        let turn = glam::DQuat::from_axis_angle(axis.normalize(), 6.0 * random.f64());
        let outline: Vec<DVec3> = outline.into_iter().map(|corner| turn * corner).collect();
        assert_cut_well(&outline);
    }
}

#[test]
fn a_comb_and_a_spiral_are_cut() {
    let mut comb = vec![DVec3::new(0.0, -1.0, 0.0)];
    for tooth in (0..50).rev() {
        let x = f64::from(tooth);
        comb.push(DVec3::new(x + 0.9, -1.0, 0.0));
        comb.push(DVec3::new(x + 0.7, 4.0, 0.0));
        comb.push(DVec3::new(x + 0.3, 0.0, 0.0));
    }
    // The base line was listed from the right.
    let base = comb.remove(0);
    let mut outline = vec![base, DVec3::new(51.0, -1.0, 0.0)];
    outline.extend(comb.iter().filter(|corner| corner.y >= 0.0));
    assert_cut_well(&outline);
    let arm = |angle: f64, radius: f64| DVec3::new(radius * angle.cos(), radius * angle.sin(), 2.0);
    let turns = (0..60).map(|step| 0.3 * f64::from(step));
    let mut spiral: Vec<DVec3> = turns.clone().map(|angle| arm(angle, 2.0 + angle)).collect();
    spiral.extend(turns.rev().map(|angle| arm(angle, 1.0 + angle)));
    assert_cut_well(&spiral);
}

#[test]
fn corners_along_a_straight_edge_keep_a_mesh_closed() {
    // The front has a corner in the middle of each edge, and so have its neighbours.
    let mut text =
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n".to_owned();
    text += "v 1 0 0\nv 1 0 2\nv 0 0 1\nv 2 0 1\n";
    text +=
        "f 1 9 2 12 6 10 5 11\nf 4 3 2 9 1\nf 5 10 6 7 8\nf 3 4 8 7\nf 1 11 5 8 4\nf 2 3 7 6 12\n";
    let mesh = Mesh::from_triangles(&read(&text).unwrap()).unwrap();
    assert!(mesh.is_closed());
    assert_near(mesh.volume_mm3(), 8.0, 1e-9);
}

#[test]
fn polygons_without_area_or_with_a_bridge_are_cut_somehow() {
    let line: Vec<DVec3> = (0..7).map(|x| DVec3::new(f64::from(x), 0.0, 0.0)).collect();
    assert_eq!(cut(&line).len(), 5);
    assert_eq!(cut(&[DVec3::ONE; 5]).len(), 3);
    // A square with a square hole, joined by a bridge that is passed twice.
    let hole = [
        (0., 0.),
        (4., 0.),
        (4., 4.),
        (0., 4.),
        (0., 0.),
        (1., 1.),
        (1., 3.),
        (3., 3.),
        (3., 1.),
        (1., 1.),
    ];
    let outline: Vec<DVec3> = hole.iter().map(|&(x, y)| DVec3::new(x, y, 1.0)).collect();
    assert_cut_well(&outline);
    // More corners than ears are looked for.
    let round: Vec<DVec3> = (0..5000)
        .map(|step| {
            DVec3::new(
                (f64::from(step) / 5000.0).sqrt(),
                f64::from(step) / 5000.0,
                0.0,
            )
        })
        .collect();
    assert_eq!(cut(&round).len(), 4998);
}
