//! Orientations: directions, metrics, the search, and the best orientations of models with a known answer.

mod basins;
mod best;
mod metrics;
mod search;
mod shards;

use crate::common::Slicer;
use crate::common::{binary_stl, load, quiet, solids};
use cusp_slicer::job::{Options, OrientationReport};
use cusp_slicer::orientation::{Candidate, Metrics, SearchOptions, Task};
use glam::{DVec3, Quat, Vec3};

/// Coarser bins than usual, for speed.
fn options() -> Options {
    Options {
        bin_mm: Some(0.01),
        ..Options::default()
    }
}

fn few(directions: usize) -> SearchOptions {
    SearchOptions {
        directions,
        ..SearchOptions::default()
    }
}

fn orient(
    triangles: &solids::Triangles,
    options: &Options,
    search: &SearchOptions,
) -> OrientationReport {
    let mut slicer = load(triangles);
    slicer.orient(options, search, &mut quiet).unwrap()
}

fn measure(slicer: &mut Slicer, options: &Options, directions: &[[f64; 3]]) -> Vec<Candidate> {
    let task = Task {
        number: 0,
        directions: directions.to_vec(),
    };
    slicer.evaluate(options, task).unwrap().candidates
}

fn metrics(slicer: &mut Slicer, options: &Options, direction: DVec3) -> Metrics {
    measure(slicer, options, &[direction.to_array()])[0]
        .metrics
        .unwrap()
}

/// A rotation that is aligned with no axis or lattice.
fn tilt() -> Quat {
    Quat::from_xyzw(0.31, -0.44, 0.12, 0.83).normalize()
}

fn turned(triangles: &solids::Triangles, rotation: Quat) -> solids::Triangles {
    let turn = |corner: &Vec3| rotation * *corner;
    let facets = triangles.iter();
    facets.map(|corners| corners.each_ref().map(turn)).collect()
}

/// An ellipsoid with a bump on one side: smooth, and with only one symmetry.
fn bean() -> solids::Triangles {
    let mut ball = solids::sphere(1.0, 4);
    for corner in ball.iter_mut().flatten() {
        let bump = 1.0 + 0.25 * (corner.x + 0.5 * corner.z).max(0.0).powi(2);
        *corner *= bump * Vec3::new(11.0, 8.0, 4.0);
    }
    ball
}

fn degrees_between(a: DVec3, b: DVec3) -> f64 {
    a.angle_between(b).to_degrees()
}

/// The angle between a candidate's direction and an axis of either sense.
fn degrees_off(candidate: &Candidate, axis: Vec3) -> f64 {
    let angle = degrees_between(DVec3::from_array(candidate.direction), axis.as_dvec3());
    angle.min(180.0 - angle)
}
