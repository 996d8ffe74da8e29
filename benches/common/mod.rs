//! Models and clocks that several benches share.

use std::time::Instant;

use cusp_slicer::model::{Mesh, Pose, read};
use glam::Vec3;

use crate::solids;

/// The time budget of one cell of a table; its first run may exceed it.
const BUDGET_S: f64 = 1.0;

/// The minimum time of several runs in seconds, and the last result.
pub fn time<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let all = Instant::now();
    let mut least = f64::INFINITY;
    loop {
        let clock = Instant::now();
        let result = work();
        least = least.min(clock.elapsed().as_secs_f64());
        if all.elapsed().as_secs_f64() > BUDGET_S {
            return (least, result);
        }
    }
}

/// A grid of spheres, `columns` × `columns` × `layers`, each subdivided `levels` times.
pub fn balls(columns: usize, layers: usize, levels: u32) -> Mesh {
    let ball = solids::sphere(5.0, levels);
    let place = |i: usize| {
        let (x, y, z) = (i % columns, i / columns % columns, i / columns / columns);
        Vec3::new(x as f32, y as f32, z as f32) * 9.0
    };
    let triangles: Vec<_> = (0..columns * columns * layers)
        .flat_map(|i| solids::moved(&ball, place(i)))
        .collect();
    on_plate(&triangles, &Pose::default())
}

/// The models that the command line names, 60 mm high, each with its file's name.
pub fn named() -> impl Iterator<Item = (String, Mesh)> {
    let paths = std::env::args().skip(1).filter(|it| !it.starts_with('-'));
    paths.map(|path| {
        let name = std::path::Path::new(&path).file_stem().unwrap_or_default();
        let triangles = read::read(&std::fs::read(&path).expect("a file"))
            .expect("a model")
            .triangles;
        let mesh = on_plate(&triangles, &Pose::of_height(60.0));
        (name.to_string_lossy().into_owned(), mesh)
    })
}

pub fn on_plate(triangles: &solids::Triangles, pose: &Pose) -> Mesh {
    let mesh = Mesh::from_triangles(triangles).expect("a mesh");
    mesh.on_plate(pose).expect("a mesh on the plate")
}

/// The slope of the line fitted to the logarithms of the points.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let (x, y) = logs
        .iter()
        .fold((0.0, 0.0), |sum, log| (sum.0 + log.0, sum.1 + log.1));
    let (x, y) = (x / count, y / count);
    let over: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
    let under: f64 = logs.iter().map(|log| (log.0 - x).powi(2)).sum();
    over / under
}
