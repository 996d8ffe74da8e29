//! The stages together: what holds for any options, cancellation in every stage, and useless output.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::io::Cursor;
use std::ops::ControlFlow;

use common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Minimize, Options, Planner, Report, Slicer, Snap, Stage};
use cusp_slicer::plan::{HeightRange, PlanError};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::warning::Warning;
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
        .write_archive(Cursor::new(Vec::new()), &mut watch)
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
                layer_min_mm: 0.025,
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
        printer: Some("sl1s".to_owned()),
        layer_min_mm: 0.05,
        layer_max_mm: 0.1,
        ..options()
    };
    assert_eq!(of_printer.check().map_err(|error| error.code()), Ok(()));
    let uniform = |layer_mm| Planner::Uniform { layer_mm };
    for (options, expected) in [
        (
            Options {
                layer_max_mm: 0.5,
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
                printer: Some("nobody".to_owned()),
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
        bin_mm: Some(1.0),
        layer_min_mm: 1.0,
        layer_max_mm: 1.0,
        tolerance: Some(10.0),
        ..options()
    };
    plan(&mut low, &coarse).unwrap();
    let result = low.write_archive(Cursor::new(Vec::new()), &mut quiet);
    assert_eq!(code(result.map(|_| ())), "all-black");
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

/// A model, the level of anti-aliasing, and whether there are black layers.
type BlackCase = (&'static str, solids::Triangles, u32, bool);

#[test]
fn the_plan_warns_of_exactly_the_layers_whose_masks_are_black() {
    let floating = || {
        let mut plate = solids::cuboid(Vec3::new(6.0, 6.0, 1.0));
        let ball = solids::sphere(2.0, 4);
        plate.extend(solids::moved(&ball, Vec3::new(3.0, 3.0, 6.0)));
        plate
    };
    let cases: [BlackCase; 4] = [
        // The tip is thinner than a pixel.
        ("tip", solids::cone(3.0, 4.0, 16), 1, true),
        ("floating", floating(), 1, true),
        ("floating, grey", floating(), 4, true),
        ("cube", solids::cube(3.0), 1, false),
    ];
    for (name, model, antialias, has_black) in cases {
        let mut slicer = load(&model);
        let options = Options {
            rays: 8,
            antialias,
            ..options()
        };
        let report = plan(&mut slicer, &options).unwrap();
        let warned: Vec<_> = report
            .warnings
            .iter()
            .filter_map(|warning| match *warning {
                Warning::BlackLayers { layers, from_mm } => Some((layers, from_mm)),
                _ => None,
            })
            .collect();
        // The masks themselves.
        let written = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
        let mut zip = zip::ZipArchive::new(Cursor::new(written)).unwrap();
        let manifest = zip.by_name("manifest.json").unwrap();
        let manifest: serde_json::Value = serde_json::from_reader(manifest).unwrap();
        let black: Vec<usize> = manifest["layer_files"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
            .filter(|(_, layer)| layer["lit_pixels"] == 0)
            .map(|(layer, _)| layer)
            .collect();
        let expected: Vec<_> = black
            .first()
            .map(|&lowest| (black.len(), report.z_mm[lowest]))
            .into_iter()
            .collect();
        assert_eq!(warned, expected, "{name}");
        assert_eq!(!black.is_empty(), has_black, "{name}");
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

#[test]
fn the_tolerance_holds_on_every_solid_under_every_metric() {
    for (name, triangles) in solids::all() {
        let mut slicer = load(&triangles);
        for metric in [
            Metric::Cusp,
            Metric::Roughness,
            Metric::Area,
            Metric::Volume,
        ] {
            for minimize in [Minimize::Layers, Minimize::Time] {
                let options = Options {
                    metric,
                    minimize,
                    ..options()
                };
                let report = match plan(&mut slicer, &options) {
                    Ok(report) => report,
                    Err(error) => panic!("{name}, {metric:?}: {error}"),
                };
                let room = 1.0 + 1e-6;
                assert!(
                    report.max_error <= report.tolerance * room,
                    "{name}, {metric:?}"
                );
                if metric == Metric::Cusp {
                    assert_eq!(report.max_error, report.max_error_mm);
                    assert!(report.sampled_error <= report.max_error * room, "{name}");
                }
                assert!(
                    report.layers <= report.uniform.finest.layers,
                    "{name}, {metric:?}"
                );
                assert!(
                    report.layers >= report.uniform.coarsest.layers,
                    "{name}, {metric:?}"
                );
            }
        }
    }
}

#[test]
fn a_sampled_plan_that_fails_on_the_mesh_says_so() {
    // A tiny cone between the rays, on top of a cube: no ray sees its slope.
    let mut triangles = solids::cube(10.0);
    let spike = solids::cone(0.02, 0.03, 8);
    triangles.extend(solids::moved(&spike, Vec3::new(5.04, 5.04, 10.0)));
    triangles.extend(solids::moved(
        &solids::cuboid(Vec3::new(1.0, 1.0, 3.0)),
        Vec3::new(1.0, 1.0, 10.0),
    ));
    let mut slicer = load(&triangles);
    let sampled = Options {
        source: Source::Sampled,
        tolerance: Some(0.02),
        layer_min_mm: 0.1,
        bin_mm: Some(0.01),
        snap: Snap::Off,
        ..options()
    };
    let report = plan(&mut slicer, &sampled).unwrap();
    assert!(report.sampled_error <= 0.02 + 1e-9);
    assert!(report.max_error > 0.02);
    assert!(
        report
            .warnings
            .iter()
            .any(|warning| matches!(warning, Warning::ToleranceExceededOnMesh { .. }))
    );
}

#[test]
fn flats_print_at_their_true_height() {
    // A step at a height where the fewest layers would have no plane.
    let mut stairs = solids::cuboid(Vec3::new(10.0, 10.0, 3.334));
    stairs.extend(solids::moved(
        &solids::cuboid(Vec3::new(4.0, 4.0, 6.0)),
        Vec3::new(3.0, 3.0, 0.0),
    ));
    let mut slicer = load(&stairs);
    let snapped = plan(&mut slicer, &options()).unwrap();
    assert_eq!(snapped.snapped_mm, [3.334]);
    assert!(snapped.z_mm.contains(&3.334));
    let off = Options {
        snap: Snap::Off,
        ..options()
    };
    assert_eq!(plan(&mut slicer, &off).unwrap().snapped_mm, [0.0; 0]);
    let large = Options {
        flat_area_mm2: 90.0,
        ..options()
    };
    // The flat is 84 mm², but the profile still changes sharply there.
    assert_eq!(plan(&mut slicer, &large).unwrap().snapped_mm.len(), 1);
}

#[test]
fn a_goal_is_met_with_the_least_tolerance() {
    let mut slicer = load(&solids::sphere(3.0, 5));
    let usual = plan(&mut slicer, &options()).unwrap();
    let few = Options {
        max_layers: Some(usual.layers - 5),
        ..options()
    };
    let report = plan(&mut slicer, &few).unwrap();
    assert!(report.layers <= usual.layers - 5 && report.tolerance > 0.065);
    let quick = Options {
        max_time_s: Some(usual.print_time_s * 0.9),
        ..options()
    };
    let report = plan(&mut slicer, &quick).unwrap();
    assert!(report.print_time_s <= usual.print_time_s * 0.9);
    let both = Options {
        tolerance: Some(0.1),
        ..few
    };
    assert_eq!(code(plan(&mut slicer, &both)), "several-targets");
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

/// What an error offers can be typed, and works.
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
            layer_min_mm,
            layer_max_mm,
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
            layer_min_mm: offer_mm,
            ..options
        };
        plan(&mut slicer, &taken).unwrap();
        found += 1;
    }
    assert_eq!(found, 4);
}
