//! The stages together: cancellation, progress, and the stages that a change of options repeats.

mod bounded;
mod numbers;
mod promises;
mod resolve;

use crate::common::Slicer;
use crate::common::{binary_stl, load, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Report, Stage};
use cusp_slicer::profile::Metric;
use std::io::Cursor;
use std::ops::ControlFlow;

fn options() -> Options {
    Options {
        rays: 120,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn plan(slicer: &mut Slicer, options: &Options) -> Result<Report, Error> {
    pollster::block_on(slicer.plan(options, &mut quiet)).cloned()
}

fn code<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
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
    let result = slicer.write_archive(Cursor::new(Vec::new()), &mut stop);
    assert_eq!(code(result.map(|_| ())), "cancelled");
    assert!(
        slicer
            .write_archive(Cursor::new(Vec::new()), &mut quiet)
            .is_ok()
    );
}

#[test]
fn progress_grows_within_a_stage() {
    // Each metric makes passes of its own over the rays, and weights another.
    for (metric, saliency) in [
        (Metric::Cusp, false),
        (Metric::Area, false),
        (Metric::Volume, true),
    ] {
        let mut seen: Vec<(Stage, f64)> = Vec::new();
        let mut slicer = load(&solids::sphere(3.0, 4));
        let many = Options {
            rays: 3000,
            metric,
            saliency,
            ..options()
        };
        let mut watch = |stage, fraction| {
            seen.push((stage, fraction));
            ControlFlow::Continue(())
        };
        pollster::block_on(slicer.plan(&many, &mut watch)).unwrap();
        slicer
            .write_archive(Cursor::new(Vec::new()), &mut watch)
            .unwrap();
        assert!(seen.len() > 10);
        for pair in seen.windows(2) {
            assert!(pair[0].0 != pair[1].0 || pair[0].1 <= pair[1].1, "{pair:?}");
            assert!((0.0..=1.0).contains(&pair[1].1), "{pair:?}");
        }
    }
}

#[test]
fn looking_at_other_plans_leaves_the_plan_and_its_masks_alone() {
    let stl = binary_stl(&solids::sphere(3.0, 4));
    let planned = Options {
        antialias: 4,
        format: Some(Format::Png),
        ..options()
    };
    let looks: [(&str, Options); 3] = [
        ("other samples", options()),
        (
            "other rays",
            Options {
                rays: 77,
                ..options()
            },
        ),
        (
            "another pose",
            Options {
                height_mm: Some(4.0),
                ..options()
            },
        ),
    ];
    for (name, look) in looks {
        let mut slicer = Slicer::load(&stl).unwrap();
        plan(&mut slicer, &planned).unwrap();
        let expected = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
        let mask = slicer.mask(20).unwrap();

        pollster::block_on(slicer.tradeoff(&look, 3, &mut quiet)).unwrap();
        assert_eq!(slicer.mask(20).unwrap(), mask, "{name}");
        pollster::block_on(slicer.compare(&look, &mut quiet)).unwrap();
        let found = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
        assert!(found == expected, "{name}");

        // A plan whose masks were not requested yet.
        plan(&mut slicer, &planned).unwrap();
        pollster::block_on(slicer.tradeoff(&look, 3, &mut quiet)).unwrap();
        let found = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
        assert!(found == expected, "{name}, masks made afterwards");
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
    assert_eq!(
        (auto.z_mm, auto.models[0].hits),
        (on_cpu.z_mm, on_cpu.models[0].hits)
    );
}

/// A stage whose part of the options is the same keeps its result: another print file needs neither rays nor a plan.
#[test]
fn a_change_of_options_repeats_only_what_depends_on_it() {
    let mut slicer = load(&solids::sphere(5.0, 4));
    let first = plan(&mut slicer, &options()).unwrap();
    let again = |slicer: &mut Slicer, options: &Options| {
        let report = plan(slicer, options).unwrap();
        let times = report.timings_ms.clone();
        let ran = [times.ldi, times.profile, times.plan].map(|ms| ms > 0.0);
        (ran, report)
    };
    let mirrored = Options {
        format: Some(Format::Uvj),
        mirror: Some(true),
        ..options()
    };
    let (ran, report) = again(&mut slicer, &mirrored);
    assert_eq!((ran, &report.z_mm), ([false; 3], &first.z_mm));
    assert_eq!(report.print_file.format, Format::Uvj);
    let looser = Options {
        tolerance: Some(0.1),
        ..options()
    };
    assert_eq!(again(&mut slicer, &looser).0, [false, false, true]);
    let by_area = Options {
        metric: Metric::Area,
        ..options()
    };
    assert_eq!(again(&mut slicer, &by_area).0, [false, true, true]);
    let finer = Options {
        rays: 300,
        ..options()
    };
    assert_eq!(again(&mut slicer, &finer).0, [true; 3]);
}
