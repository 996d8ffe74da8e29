//! The stages together: what holds whatever the options, cancelling in every stage, and output that would be
//! useless.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::io::Cursor;
use std::ops::ControlFlow;

use common::{binary_stl, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::pipeline::{Backend, Options, Planner, Slicer, Stage};
use cusp_slicer::report::Report;
use glam::Vec3;

fn options() -> Options {
    Options {
        rays: 120,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn load(triangles: &solids::Triangles) -> Slicer {
    Slicer::load(&binary_stl(triangles)).unwrap()
}

fn plan(slicer: &mut Slicer, options: &Options) -> Result<Report, Error> {
    pollster::block_on(slicer.plan(options, &mut quiet)).cloned()
}

fn code<T: std::fmt::Debug>(result: Result<T, Error>) -> &'static str {
    result.unwrap_err().code()
}

#[test]
fn every_stage_can_be_cancelled_and_the_model_planned_again() {
    let mut slicer = load(&solids::sphere(3.0, 4));
    for wanted in [Stage::Ldi, Stage::Profile, Stage::Plan] {
        let mut stop = |stage, _| {
            if stage == wanted {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let result = pollster::block_on(slicer.plan(&options(), &mut stop));
        assert_eq!(code(result), "cancelled", "{wanted:?}");
    }
    plan(&mut slicer, &options()).unwrap();
    let mut stop = |_, _| ControlFlow::Break(());
    let result = slicer.write_png_zip(Cursor::new(Vec::new()), &mut stop);
    assert_eq!(code(result.map(|_| ())), "cancelled");
    assert!(
        slicer
            .write_png_zip(Cursor::new(Vec::new()), &mut quiet)
            .is_ok()
    );
}

#[test]
fn progress_grows_within_a_stage() {
    let mut seen: Vec<(Stage, f64)> = Vec::new();
    let mut slicer = load(&solids::sphere(3.0, 4));
    let many = Options {
        rays: 1500,
        ..options()
    };
    let mut watch = |stage, fraction| {
        seen.push((stage, fraction));
        ControlFlow::Continue(())
    };
    pollster::block_on(slicer.plan(&many, &mut watch)).unwrap();
    slicer
        .write_png_zip(Cursor::new(Vec::new()), &mut watch)
        .unwrap();
    assert!(seen.len() > 10);
    for pair in seen.windows(2) {
        assert!(pair[0].0 != pair[1].0 || pair[0].1 <= pair[1].1, "{pair:?}");
        assert!((0.0..=1.0).contains(&pair[1].1), "{pair:?}");
    }
}

#[test]
fn options_that_no_model_could_make_good_are_refused_before_sampling() {
    let mut slicer = load(&solids::cube(2.0));
    for (options, expected) in [
        (
            Options {
                bin_mm: 0.0,
                ..options()
            },
            "bad-length",
        ),
        (
            Options {
                tolerance_mm: f64::NAN,
                ..options()
            },
            "bad-length",
        ),
        (
            Options {
                layer_min_mm: 0.2,
                ..options()
            },
            "layer-range-empty",
        ),
        (
            Options {
                planner: Planner::Uniform { layer_mm: 0.0501 },
                ..options()
            },
            "layer-not-whole-bins",
        ),
    ] {
        let mut calls = 0;
        let mut count = |_, _| {
            calls += 1;
            ControlFlow::Continue(())
        };
        let result = pollster::block_on(slicer.plan(&options, &mut count));
        assert_eq!(code(result), expected);
        assert_eq!(calls, 0);
    }
}

#[test]
fn uniform_layers_need_no_range() {
    let mut slicer = load(&solids::cube(10.0));
    let planner = Planner::Uniform { layer_mm: 0.2 };
    let report = plan(
        &mut slicer,
        &Options {
            planner,
            bin_mm: 0.2,
            ..options()
        },
    )
    .unwrap();
    assert_eq!((report.layers, report.uniform.finest_layers), (50, 50));
}

#[test]
fn any_height_takes_layers_that_divide_it() {
    let mut slicer = load(&solids::cube(2.0));
    for twentieths in (20..6000).step_by(171) {
        let height_mm = f64::from(twentieths) / 20.0;
        let options = Options {
            height_mm: Some(height_mm),
            layer_max_mm: 0.05,
            rays: 4,
            ..options()
        };
        let report = plan(&mut slicer, &options).unwrap();
        assert_eq!(
            (report.layers, report.height_mm),
            (twentieths as usize, height_mm)
        );
    }
}

#[test]
fn output_that_would_be_black_is_an_error() {
    let mut thin = load(&solids::cuboid(Vec3::new(1e5, 1e-3, 1.0)));
    assert_eq!(code(plan(&mut thin, &options())), "no-hits");
    let mut low = load(&solids::cuboid(Vec3::new(1.0, 1.0, 0.4)));
    let coarse = Options {
        bin_mm: 1.0,
        layer_min_mm: 1.0,
        layer_max_mm: 1.0,
        tolerance_mm: 10.0,
        ..options()
    };
    plan(&mut low, &coarse).unwrap();
    let result = low.write_png_zip(Cursor::new(Vec::new()), &mut quiet);
    assert_eq!(code(result.map(|_| ())), "all-black");
}

#[test]
fn black_layers_are_warned_of_once_however_often_the_plan_is_written() {
    // A cone on its base: the tip is thinner than a pixel.
    let mut slicer = load(&solids::cone(3.0, 4.0, 16));
    plan(
        &mut slicer,
        &Options {
            rays: 8,
            ..options()
        },
    )
    .unwrap();
    for _ in 0..2 {
        let (_, report) = slicer
            .write_png_zip(Cursor::new(Vec::new()), &mut quiet)
            .unwrap();
        let black = report
            .warnings
            .iter()
            .filter(|warning| warning.code == "black-layers");
        assert_eq!(black.count(), 1);
    }
}

#[test]
fn auto_does_its_work_whatever_the_machine_has() {
    let mut slicer = load(&solids::cone(3.0, 4.0, 16));
    let on_cpu = plan(&mut slicer, &options()).unwrap();
    let auto = plan(
        &mut slicer,
        &Options {
            backend: Backend::Auto,
            ..options()
        },
    )
    .unwrap();
    assert_eq!((auto.z_mm, auto.hits), (on_cpu.z_mm, on_cpu.hits));
}
