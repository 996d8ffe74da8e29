//! Guarantees of a plan: tolerances, targets and true heights, with warnings where it cannot keep them.

use crate::common::{assert_near, load, quiet, solids};
use cusp_slicer::job::{Error, Minimize, Options, Planner, Snap};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::warning::Warning;
use glam::Vec3;
use std::io::Cursor;

use super::{code, options, plan};

#[test]
fn output_that_would_be_black_is_an_error() {
    let mut thin = load(&solids::cuboid(Vec3::new(1e5, 1e-3, 1.0)));
    assert_eq!(code(plan(&mut thin, &options())), "no-hits");
    let mut low = load(&solids::cuboid(Vec3::new(1.0, 1.0, 0.4)));
    let coarse = Options {
        bin_mm: Some(1.0),
        layer_min_mm: Some(1.0),
        layer_max_mm: Some(1.0),
        tolerance: Some(10.0),
        ..options()
    };
    plan(&mut low, &coarse).unwrap();
    let result = low.write_archive(Cursor::new(Vec::new()), &mut quiet);
    assert_eq!(code(result.map(|_| ())), "all-black");
}

/// A model, its anti-aliasing level, and whether it has black layers.
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
            .all_warnings()
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
fn the_tolerance_holds_on_every_solid_under_every_metric() {
    for (name, triangles) in solids::all() {
        let mut slicer = load(&triangles);
        for metric in Metric::ALL {
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
                    assert_eq!(report.sampled_error, None, "{name}");
                    let along_rays = slicer.profile(metric, Source::Sampled);
                    assert!(matches!(along_rays, Err(Error::NoPlan)), "{name}");
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
        layer_min_mm: Some(0.1),
        bin_mm: Some(0.01),
        snap: Snap::Off,
        ..options()
    };
    let report = plan(&mut slicer, &sampled).unwrap();
    assert!(report.sampled_error.unwrap() <= 0.02 + 1e-9);
    assert!(report.max_error > 0.02);
    assert!(
        report
            .all_warnings()
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
fn sharp_changes_beside_upright_walls_get_planes_from_either_source() {
    // A block, a lying cylinder that is 16 mm high, and a block again, in one outline. Rays miss the walls of the blocks.
    let arc = (0..=64u8).map(|step| {
        let z = 10.0 + f32::from(step) / 4.0;
        [(100.0 - (z - 18.0) * (z - 18.0)).sqrt(), z]
    });
    let right: Vec<[f32; 2]> = std::iter::once([6.0, 0.0])
        .chain(arc)
        .chain([[6.0, 36.0]])
        .collect();
    let left = right.iter().rev().map(|&[x, z]| [-x, z]);
    let outline: Vec<[f32; 2]> = right.iter().copied().chain(left).collect();
    let mut slicer = load(&solids::profiled(&outline, 12.0));
    for source in [Source::Exact, Source::Sampled] {
        let options = Options {
            source,
            ..options()
        };
        let report = plan(&mut slicer, &options).unwrap();
        for z_mm in [10.0, 26.0] {
            let mut snapped = report.snapped_mm.iter();
            assert!(
                snapped.any(|snapped_mm| (snapped_mm - z_mm).abs() < 0.003),
                "{source:?}: {:?}",
                report.snapped_mm
            );
        }
    }
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

#[test]
fn the_cap_of_the_area_deviation_does_not_hide_a_shelf() {
    // 400 mm² up to 5.02 mm, a quarter of that above.
    let outline = [
        [0.0, 0.0],
        [20.0, 0.0],
        [20.0, 5.02],
        [5.0, 5.02],
        [5.0, 10.0],
        [0.0, 10.0],
    ];
    let mut slicer = load(&solids::profiled(&outline, 20.0));
    let options = |snap| Options {
        metric: Metric::Area,
        snap,
        ..options()
    };
    let hidden = plan(&mut slicer, &options(Snap::Off)).unwrap();
    assert!(hidden.max_error < 0.1, "{}", hidden.max_error);
    assert_near(hidden.true_error, 0.75, 1e-3);
    let at_shelf = plan(&mut slicer, &options(Snap::Auto)).unwrap();
    assert_near(at_shelf.true_error, 0.0, 1e-9);
}

/// A solid, the tolerance, and the fewest uniform layers: their number and their thickness in µm. Then whether they are enough.
type UniformCase = (&'static str, solids::Triangles, f64, (usize, u32), bool);

#[test]
fn savings_are_against_the_best_uniform_layers_within_tolerance() {
    let block = |height| [[-5.0, height], [-5.0, 0.0], [5.0, 0.0], [5.0, height]];
    let gable = [
        [-5.0, 10.0],
        [-5.0, 0.0],
        [5.0, 0.0],
        [5.0, 10.0],
        [0.0, 15.0],
    ];
    let roof = [[-5.0, 0.0], [5.0, 0.0], [0.0, 5.0]];
    let cases: [UniformCase; 3] = [
        // Walls keep any tolerance, the top does not: of up to 0.15 mm, 67 layers miss it by 0.07 mm or more, and 68 by so much unless
        // they are 0.149 mm thick, when they miss it by 0.012 mm.
        (
            "block",
            solids::profiled(&block(10.12), 8.0),
            0.045,
            (68, 149),
            true,
        ),
        // At 45°, the cusp height is 0.707 of the thickness: 0.0516 mm for 0.073 mm, and 0.0523 mm for 0.074 mm. The floor, in a bin of 2 µm, adds 0.6 µm.
        ("roof", solids::profiled(&roof, 8.0), 0.0525, (68, 73), true),
        // The same roof decides about the thickness of all layers: 15 mm / 0.073 mm.
        (
            "house",
            solids::profiled(&gable, 8.0),
            0.0522,
            (205, 73),
            false,
        ),
    ];
    for (name, solid, tolerance, (layers, thickness_um), is_enough) in cases {
        let mut slicer = load(&solid);
        let options = Options {
            tolerance: Some(tolerance),
            layer_min_mm: Some(0.03),
            layer_max_mm: Some(0.15),
            ..options()
        };
        let report = plan(&mut slicer, &options).unwrap();
        let fewest = report.uniform.fewest.unwrap();
        assert_eq!(fewest.layers, layers, "{name}");
        assert_near(fewest.layer_mm, f64::from(thickness_um) * 1e-3, 1e-9);
        assert_eq!(report.uniform.is_enough, is_enough, "{name}");
        // One after the other, each in bins of its own.
        let mut within = Vec::new();
        for um in 30..=150 {
            let uniform = Options {
                planner: Planner::Uniform {
                    layer_mm: f64::from(um) * 1e-3,
                },
                bin_mm: Some(0.001),
                ..options.clone()
            };
            let uniform = plan(&mut slicer, &uniform).unwrap();
            let top_mm = uniform.z_mm[uniform.layers];
            if uniform.max_error <= tolerance && (top_mm - report.height_mm).abs() <= tolerance {
                within.push((uniform.layers, uniform.print_time_s));
            }
        }
        let fewest = within.iter().map(|&(layers, _)| layers).min();
        let quickest = within.iter().map(|&(_, time_s)| time_s);
        assert_eq!(fewest, Some(layers), "{name}");
        let found_s = report.uniform.quickest.unwrap().print_time_s;
        assert_near(found_s, quickest.fold(f64::INFINITY, f64::min), 1e-6);
    }
}

#[test]
fn where_no_uniform_layers_keep_the_tolerance_there_are_none_to_save_from() {
    // No multiple of a thickness from 0.1 to 0.15 mm in whole steps of 0.01 mm is within 0.01 mm of 1.03 mm: those nearest are 9 × 0.11
    // and 8 × 0.13 mm. Layers of several thicknesses are.
    let mut slicer = load(&solids::cuboid(Vec3::new(4.0, 4.0, 1.03)));
    let options = Options {
        tolerance: Some(0.0099),
        step_mm: Some(0.01),
        layer_min_mm: Some(0.1),
        layer_max_mm: Some(0.15),
        ..options()
    };
    let report = plan(&mut slicer, &options).unwrap();
    assert_eq!(
        (report.uniform.fewest, report.uniform.quickest),
        (None, None)
    );
    assert!(!report.uniform.is_enough && report.max_error <= report.tolerance);
    let free = Options {
        step_mm: None,
        ..options
    };
    assert!(plan(&mut slicer, &free).unwrap().uniform.fewest.is_some());
}
