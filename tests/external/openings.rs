//! Inside and outside of open models, by libigl.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use cusp_slicer::model::Mesh;
use glam::{DVec3, Vec3};
use libtest_mimic::{Failed, Trial};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{binary_stl, solids};
use crate::{Need, python, succeeds, trial};

const LIBIGL: Need = Need::Python("igl, trimesh");
const SCRIPT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/interop/python/winding.py"
);
const POINTS: usize = 1000;
/// Most points that may be inside for one and outside for the other: a cap is made of facets.
const MOST_DIFFERING: usize = 25;

pub fn trials() -> Vec<Trial> {
    vec![trial(
        "openings::a_point_is_inside_where_libigls_winding_number_exceeds_one_half",
        &[LIBIGL],
        a_point_is_inside_where_the_winding_number_exceeds_one_half,
    )]
}

/// Open models: a ball cut by a saddle, half a pipe, and a ball with holes that overlap.
fn models() -> Vec<(&'static str, Vec<[Vec3; 3]>)> {
    let cut = |keeps: &dyn Fn(Vec3) -> bool| {
        let mut ball = solids::sphere(10.0, 5);
        ball.retain(|&[a, b, c]| keeps((a + b + c) / 3.0));
        ball
    };
    let saddle = |at: Vec3| at.z < 2.0 + (at.x * at.x - at.y * at.y) * 0.4;
    let bitten = |at: Vec3| (at - Vec3::new(9.0, 0.0, 4.0)).length() > 6.0 && at.z > -8.0;
    let mut pipe = solids::cylinder(6.0, 20.0, 16);
    pipe.retain(|corners| corners.iter().all(|corner| corner.x < 0.1));
    vec![
        ("saddle", cut(&saddle)),
        ("pipe", pipe),
        ("bitten", cut(&bitten)),
    ]
}

/// The winding number of a closed mesh, by crossings of a ray along z.
fn is_inside(mesh: &Mesh, point: DVec3) -> bool {
    let mut winding = 0;
    for facet in 0..mesh.facets.len() {
        let [a, b, c] = mesh.corners(facet).map(|corner| corner - point);
        let side = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
        let sides = [side(b, c), side(c, a), side(a, b)];
        let area: f64 = sides.iter().sum();
        let hits = sides.iter().all(|it| *it > 0.0) || sides.iter().all(|it| *it < 0.0);
        let height = (sides[0] * a.z + sides[1] * b.z + sides[2] * c.z) / area;
        if hits && height > 0.0 {
            winding += if area > 0.0 { 1 } else { -1 };
        }
    }
    winding != 0
}

fn a_point_is_inside_where_the_winding_number_exceeds_one_half() -> Result<(), Failed> {
    let folder = TempDir::new()?;
    let mut random = fastrand::Rng::with_seed(8);
    let mut inside = Vec::new();
    for (name, triangles) in models() {
        let mesh = Mesh::with_caps(&triangles, true)?;
        let bounds = mesh.bounds();
        let mut text = String::new();
        let mut own = Vec::new();
        for _ in 0..POINTS {
            let part = DVec3::from_array(std::array::from_fn(|_| random.f64()));
            let point = bounds.min + bounds.size() * part;
            let _ = writeln!(text, "{} {} {}", point.x, point.y, point.z);
            own.push(is_inside(&mesh, point));
        }
        fs::write(folder.path().join(name).with_extension("txt"), text)?;
        let stl = binary_stl(&triangles);
        fs::write(folder.path().join(name).with_extension("stl"), stl)?;
        inside.push((name, own));
    }
    let output = succeeds(Command::new(python()).arg(SCRIPT).arg(folder.path()))?;
    let numbers: Value = serde_json::from_slice(&output.stdout)?;
    for (name, own) in inside {
        let theirs = numbers[name].as_array().ok_or("no numbers")?;
        let theirs: Vec<f64> = theirs.iter().filter_map(Value::as_f64).collect();
        if theirs.len() != POINTS {
            return Err(format!("{name}: {} numbers", theirs.len()).into());
        }
        let differing = theirs
            .iter()
            .zip(own)
            .filter(|(it, own)| (**it > 0.5) != *own);
        let differing: Vec<f64> = differing.map(|(it, _)| *it).collect();
        println!("{name}: {} of {POINTS} differ", differing.len());
        if differing.len() > MOST_DIFFERING || differing.iter().any(|it| (it - 0.5).abs() > 0.1) {
            return Err(format!("{name}: {differing:?}").into());
        }
    }
    Ok(())
}
