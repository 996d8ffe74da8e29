//! Options: their resolution, and those that are rejected before any work is done.

use crate::common::{assert_near, load, solids};
use cusp_slicer::Error;
use cusp_slicer::job::{Minimize, Options, OptionsError, Planner};
use cusp_slicer::plan::{HeightRange, PlanError};
use std::ops::ControlFlow;

use super::{code, options, plan};

#[test]
fn options_that_no_model_could_make_good_are_refused_before_sampling() {
    let mut slicer = load(&solids::cube(2.0));
    for (options, expected) in [
        (
            Options {
                bin_mm: Some(0.0),
                ..options()
            },
            "bad-length",
        ),
        (
            Options {
                tolerance: Some(f64::NAN),
                ..options()
            },
            "bad-length",
        ),
        (
            Options {
                layer_min_mm: Some(0.2),
                ..options()
            },
            "layer-range-upside-down",
        ),
        (
            Options {
                planner: Planner::Uniform { layer_mm: 0.0501 },
                ..options()
            },
            "not-whole-bins",
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
fn a_thickness_rule_goes_with_a_tolerance_and_the_optimal_planner_alone() {
    type Setting = (&'static str, fn(&mut Options));
    let rules: [Setting; 3] = [
        ("thicknesses_mm", |it| it.thicknesses_mm = vec![0.05, 0.1]),
        ("max_thicknesses", |it| it.max_thicknesses = Some(3)),
        ("max_change_mm", |it| it.max_change_mm = Some(0.01)),
    ];
    let others: [Setting; 4] = [
        ("planner", |it| it.planner = Planner::Greedy),
        ("minimize", |it| it.minimize = Minimize::Time),
        ("max_layers", |it| it.max_layers = Some(100)),
        ("max_time_s", |it| it.max_time_s = Some(1e4)),
    ];
    for (place, (rule, set_rule)) in rules.iter().enumerate() {
        let mut options = options();
        set_rule(&mut options);
        options.check().unwrap();
        for (other, set) in others.iter().chain(&rules[place + 1..]) {
            let mut both = options.clone();
            set(&mut both);
            let Err(Error::Options(OptionsError::Contradictory {
                option,
                other: found,
            })) = both.check()
            else {
                panic!("{rule} and {other}");
            };
            assert_eq!((option, found), (*rule, *other));
        }
    }
}

/// Without `bin_mm`, bins are 2 µm, or 1 µm if a thickness needs that, or a whole fraction of the motor step.
#[test]
fn bins_follow_from_the_step_or_the_thicknesses() {
    let mut slicer = load(&solids::cube(2.0));
    let uniform = |layer_mm| Options {
        planner: Planner::Uniform { layer_mm },
        ..options()
    };
    let step = |step_mm| Options {
        step_mm: Some(step_mm),
        ..options()
    };
    for (options, expected_mm) in [
        (options(), 0.002),
        (uniform(0.05), 0.002),
        (uniform(0.051), 0.001),
        (step(0.01), 0.002),
        (step(0.005), 0.005 / 3.0),
        (step(0.001), 0.001),
        (
            Options {
                layer_min_mm: Some(0.025),
                ..options()
            },
            0.001,
        ),
        (
            Options {
                bin_mm: Some(0.01),
                ..options()
            },
            0.01,
        ),
    ] {
        let report = plan(&mut slicer, &options).unwrap();
        let bin_mm = report.bin_mm;
        assert!(
            (bin_mm - expected_mm).abs() < 1e-12,
            "{bin_mm} for {options:?}"
        );
        if let Some(step_mm) = options.step_mm {
            for z_mm in &report.z_mm {
                let steps = z_mm / step_mm;
                assert!(
                    (steps - steps.round()).abs() < 1e-6,
                    "{z_mm} is not a multiple of {step_mm}"
                );
            }
        }
    }
}

#[test]
fn a_printer_prints_neither_thinner_nor_thicker_nor_finer_than_it_can() {
    let range = |layer_min_mm, layer_max_mm| HeightRange {
        from_mm: 0.0,
        to_mm: 1.0,
        layer_min_mm,
        layer_max_mm,
    };
    let of_printer = Options {
        printer: Some("sl1s".into()),
        layer_min_mm: Some(0.05),
        layer_max_mm: Some(0.1),
        ..options()
    };
    assert_eq!(of_printer.check().map_err(|error| error.code()), Ok(()));
    let uniform = |layer_mm| Planner::Uniform { layer_mm };
    for (options, expected) in [
        (
            Options {
                layer_max_mm: Some(0.5),
                ..of_printer.clone()
            },
            "printer-layers",
        ),
        (
            Options {
                planner: uniform(0.5),
                ..of_printer.clone()
            },
            "printer-layers",
        ),
        (
            Options {
                planner: uniform(0.001),
                ..of_printer.clone()
            },
            "printer-layers",
        ),
        (
            Options {
                ranges: vec![range(0.05, 0.5)],
                ..of_printer.clone()
            },
            "printer-layers",
        ),
        (
            Options {
                step_mm: Some(0.0011),
                ..of_printer.clone()
            },
            "printer-step",
        ),
        (
            Options {
                printer: Some("nobody".into()),
                ..of_printer.clone()
            },
            "unknown-printer",
        ),
        (
            Options {
                antialias: 3,
                ..of_printer.clone()
            },
            "bad-antialias",
        ),
        (
            Options {
                weight_min: 2.0,
                ..of_printer.clone()
            },
            "bad-weight-min",
        ),
        (
            Options {
                pixels: Some([9, 9]),
                printer: None,
                ..of_printer.clone()
            },
            "pixels-without-pitch",
        ),
        (
            Options {
                tolerance: Some(0.1),
                max_layers: Some(9),
                ..of_printer.clone()
            },
            "several-targets",
        ),
    ] {
        let found = options.check().map_err(|error| error.code());
        assert_eq!(found, Err(expected.to_owned()), "{options:?}");
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
            bin_mm: Some(0.2),
            ..options()
        },
    )
    .unwrap();
    assert_eq!((report.layers, report.uniform.finest.layers), (50, 50));
}

#[test]
fn any_height_takes_layers_that_divide_it() {
    let mut slicer = load(&solids::cube(2.0));
    for twentieths in (20..6000).step_by(171) {
        let height_mm = f64::from(twentieths) / 20.0;
        let options = Options {
            height_mm: Some(height_mm),
            layer_max_mm: Some(0.05),
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

/// The minimum thickness that an error suggests can be typed, and has a plan.
#[test]
fn a_thinner_least_thickness_is_whole_micrometres_and_holds() {
    let mut slicer = load(&solids::cone(5.0, 3.0, 64));
    let mut found = 0;
    for (layer_min_mm, layer_max_mm, step_mm) in [
        (0.05, 0.15, None),
        (0.055, 0.15, None),
        (0.055, 0.155, None),
        (0.05, 0.15, Some(0.0025)),
    ] {
        let options = Options {
            layer_min_mm: Some(layer_min_mm),
            layer_max_mm: Some(layer_max_mm),
            step_mm,
            tolerance: Some(0.03),
            ..options()
        };
        let error = plan(&mut slicer, &options).unwrap_err();
        let Error::Plan(PlanError::Infeasible {
            largest_layer_min_mm: Some(offer_mm),
            ..
        }) = error
        else {
            panic!("{error:?}");
        };
        assert_near(offer_mm * 1e3, (offer_mm * 1e3).round(), 1e-6);
        let taken = Options {
            layer_min_mm: Some(offer_mm),
            ..options
        };
        plan(&mut slicer, &taken).unwrap();
        found += 1;
    }
    assert_eq!(found, 4);
}
