//! Numbers from outside: far out they are refused or computed with, and nothing wraps.

use cusp_slicer::job::{Options, Planner, Report};
use cusp_slicer::profile::Metric;
use glam::Vec3;

use super::{code, options, plan};
use crate::common::{load, solids};

/// A pyramid of 20 mm on a square of this side.
fn pyramid(side_mm: f32) -> solids::Triangles {
    let half = side_mm / 2.0;
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, 0.0);
    let base = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    let top = Vec3::new(0.0, 0.0, 20.0);
    let mut triangles = vec![[base[0], base[2], base[1]], [base[0], base[3], base[2]]];
    triangles.extend((0..4).map(|place| [base[place], base[(place + 1) % 4], top]));
    triangles
}

fn volumes(side_mm: f32, weight: Option<f32>) -> Report {
    let options = Options {
        rays: 64,
        metric: Metric::Volume,
        bin_mm: Some(0.05),
        planner: Planner::Uniform { layer_mm: 0.5 },
        weight_min: 0.0,
        ..options()
    };
    let mut slicer = load(&pyramid(side_mm));
    slicer
        .set_weights(weight.map(|weight| vec![weight; 6]))
        .unwrap();
    plan(&mut slicer, &options).unwrap()
}

#[test]
fn volumes_of_a_model_of_a_kilometre_are_those_of_a_small_one() {
    for weight in [None, Some(1.0), Some(0.5)] {
        // Powers of two scale exactly.
        let small = volumes(800.0, weight).max_error;
        let large = volumes(800.0 * 1024.0, weight).max_error;
        let ratio = large / small / (1024.0 * 1024.0);
        assert!((ratio - 1.0).abs() < 1e-6, "{weight:?}: {ratio}");
    }
}

#[test]
fn a_larger_model_is_refused() {
    let result = plan(&mut load(&pyramid(1.1e6)), &options());
    assert_eq!(code(result), "mesh-overflow");
}

#[test]
fn steps_and_thicknesses_that_would_overflow_are_refused_or_planned() {
    let mut slicer = load(&solids::cube(20.0));
    let hostile: [(Options, &str); 4] = [
        (
            Options {
                planner: Planner::Coarsest,
                step_mm: Some(429.476),
                layer_max_mm: Some(1e3),
                ..options()
            },
            "",
        ),
        (
            Options {
                planner: Planner::Greedy,
                bin_mm: Some(1e-5),
                step_mm: Some(0.02),
                layer_min_mm: Some(0.02),
                layer_max_mm: Some(1e3),
                tolerance: Some(1e9),
                ..options()
            },
            "",
        ),
        (
            Options {
                step_mm: Some(1000.0),
                layer_min_mm: Some(900.0),
                layer_max_mm: Some(1e3),
                ..options()
            },
            "layers-do-not-fit",
        ),
        (
            Options {
                bin_mm: Some(1e-314),
                ..options()
            },
            "bad-length",
        ),
    ];
    for (options, expected) in hostile {
        let result = plan(&mut slicer, &options);
        let found = result.map_or_else(|error| error.code(), |_| String::new());
        assert_eq!(found, expected, "{options:?}");
    }
}
