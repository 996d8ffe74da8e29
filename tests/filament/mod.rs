//! Files for slicers of filament printers, read by the slicers' own rules as written down in `docs/filament.md`.

mod file;

use std::collections::HashMap;

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::filament::FilamentSlicer;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Minimize, Options, Planner, Report};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::{Error, Warning};
use file::{layers_of_prusa_slicer, profile_name, read};
use glam::Vec3;

fn options(format: Format) -> Options {
    Options {
        format: Some(format),
        rays: 64,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn slice(triangles: &solids::Triangles, options: &Options) -> Result<(Vec<u8>, Report), Error> {
    let mut slicer = Slicer::load(&binary_stl(triangles))?;
    pollster::block_on(slicer.plan(options, &mut quiet))?;
    let (bytes, report) = slicer.write_archive(Vec::new(), &mut quiet)?;
    Ok((bytes, report.clone()))
}

/// The code of the error of options.
fn code(options: &Options) -> Option<String> {
    Some(options.check().err()?.code())
}

/// Options that leave marks on layers of their own.
fn many_options(format: Format) -> Vec<Options> {
    let usual = options(format);
    let uniform = Planner::Uniform { layer_mm: 0.15 };
    vec![
        usual.clone(),
        Options {
            tolerance: Some(0.2),
            max_change_mm: Some(0.02),
            ..usual.clone()
        },
        Options {
            planner: uniform,
            ..usual.clone()
        },
        Options {
            thicknesses_mm: vec![0.1, 0.16, 0.28],
            tolerance: Some(0.2),
            ..usual.clone()
        },
        Options {
            step_mm: Some(0.04),
            tolerance: Some(0.2),
            ..usual.clone()
        },
        Options {
            bin_mm: Some(0.2 / 77.0),
            ..usual.clone()
        },
        Options {
            nozzle_mm: Some(0.6),
            ..usual.clone()
        },
        Options {
            nozzle_mm: Some(0.25),
            height_mm: Some(4.321_987),
            ..usual
        },
    ]
}

#[test]
fn a_slicer_makes_every_layer_of_the_plan_and_no_other() {
    for format in Format::FILAMENT {
        for (name, triangles) in solids::all() {
            for options in many_options(format) {
                let options = Options {
                    height_mm: options.height_mm.or(Some(7.3)),
                    ..options
                };
                let (bytes, report) = slice(&triangles, &options).unwrap();
                let file = read(&bytes, profile_name(format));
                let filament = report.print_file.filament.as_ref().unwrap();
                let slicer = FilamentSlicer::of(format).unwrap();
                let least_mm = slicer.layers(filament.nozzle_mm).least_mm;
                let made = |first_layer_mm| {
                    let height_mm = file.height_mm();
                    layers_of_prusa_slicer(&file.profile, height_mm, first_layer_mm, least_mm)
                };
                let tops = made(filament.first_layer_mm).unwrap();
                assert_eq!(tops.len(), report.layers, "{name}, {options:?}");
                for (top_mm, planned_mm) in tops.iter().zip(&report.z_mm[1..]) {
                    assert_near(*top_mm, *planned_mm, 2e-6);
                }
                // The test can fail: with another first layer, the others are elsewhere.
                let others = made(filament.first_layer_mm + 0.03).unwrap();
                assert_ne!(others[..2], tops[..2], "{name}");
            }
        }
    }
}

/// Bambu Studio and OrcaSlicer drop the whole profile unless it keeps these rules.
#[test]
fn the_stricter_rules_of_orca_slicer_hold() {
    for nozzle_mm in [0.2, 0.4, 0.6, 0.8] {
        let options = Options {
            nozzle_mm: Some(nozzle_mm),
            height_mm: Some(9.87),
            ..options(Format::Orca3mf)
        };
        let (bytes, report) = slice(&solids::sphere(4.0, 5), &options).unwrap();
        let file = read(&bytes, profile_name(Format::Orca3mf));
        assert!(
            file.application.starts_with("BambuStudio-"),
            "{}",
            file.application
        );
        // As the profiles of Bambu's printers have them.
        let (least_mm, most_mm, first_mm) = match nozzle_mm {
            0.2 => (0.04, 0.14, 0.1),
            0.4 => (0.08, 0.28, 0.2),
            0.6 => (0.12, 0.42, 0.3),
            _ => (0.16, 0.56, 0.4),
        };
        assert_eq!(file.profile[1], first_mm);
        assert_eq!(report.thickness_mm[0], first_mm);
        let heights = file.profile.iter().skip(1).step_by(2);
        for height_mm in heights {
            assert!((least_mm..=most_mm).contains(height_mm), "{height_mm}");
        }
        assert_near(file.profile[file.profile.len() - 2], file.height_mm(), 1e-3);
        let untried = |warning: &Warning| matches!(warning, Warning::UntriedSlicer { .. });
        assert!(report.all_warnings().iter().any(untried));
    }
    let (_, report) = slice(&solids::cube(5.0), &options(Format::Prusa3mf)).unwrap();
    assert_eq!(report.all_warnings(), []);
}

/// Every edge of the mesh has a partner, also where a hole had to be closed, so that no slicer has to mend it.
#[test]
fn the_mesh_is_the_model_in_its_pose_and_closed() {
    let mut open = solids::cuboid(Vec3::new(3.0, 4.0, 5.0));
    open.truncate(open.len() - 2);
    let rotated = Options {
        rotation: Some([0.3, 0.1, 0.2, 0.9]),
        height_mm: Some(8.0),
        ..options(Format::Prusa3mf)
    };
    for (triangles, options) in [
        (open, options(Format::Prusa3mf)),
        (solids::gyroid(2, 12), rotated),
    ] {
        let (bytes, _) = slice(&triangles, &options).unwrap();
        let file = read(&bytes, profile_name(Format::Prusa3mf));
        let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
        for &[a, b, c] in &file.triangles {
            assert!(a != b && b != c && c != a);
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([from, to]).or_default() += 1;
                *edges.entry([to, from]).or_default() -= 1;
            }
        }
        assert!(edges.values().all(|&uses| uses == 0));
        let slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
        let pose = cusp_slicer::model::Pose {
            rotation: options.rotation,
            height_mm: options.height_mm,
            unit: options.unit,
        };
        let positions = slicer.positions_on_plate(&pose).unwrap();
        let corners: Vec<[f32; 3]> = positions.as_chunks::<3>().0.to_vec();
        let written = file.triangles.iter().flatten();
        let written: Vec<[f32; 3]> = written.map(|&vertex| file.vertices[vertex]).collect();
        assert_eq!(written[..corners.len()], corners);
        for axis in 0..2 {
            let least = corners
                .iter()
                .map(|corner| corner[axis])
                .fold(f32::MAX, f32::min);
            assert_near(f64::from(least) + file.moved[axis], 0.0, 1e-6);
        }
    }
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    let make = || slice(&solids::gyroid(2, 16), &options(Format::Prusa3mf)).unwrap();
    assert_eq!(make().0, make().0);
}

#[test]
fn limits_follow_from_the_nozzle_unless_they_are_given() {
    let limits = |options: Options| {
        let settled = options.settled();
        assert_eq!(settled.settled(), settled);
        let Options {
            layer_min_mm,
            layer_max_mm,
            first_layer_mm,
            nozzle_mm,
            ..
        } = settled;
        [layer_min_mm, layer_max_mm, first_layer_mm, nozzle_mm].map(|it| it.unwrap_or(0.0))
    };
    let of = |format, nozzle_mm| {
        limits(Options {
            nozzle_mm,
            ..options(format)
        })
    };
    assert_eq!(limits(Options::default()), [0.05, 0.15, 0.0, 0.0]);
    assert_eq!(of(Format::Prusa3mf, None), [0.07, 0.3, 0.2, 0.4]);
    assert_eq!(of(Format::Prusa3mf, Some(0.25)), [0.07, 0.18, 0.12, 0.25]);
    assert_eq!(of(Format::Prusa3mf, Some(0.8)), [0.07, 0.6, 0.4, 0.8]);
    assert_eq!(of(Format::Orca3mf, None), [0.08, 0.28, 0.2, 0.4]);
    let given = Options {
        layer_min_mm: Some(0.1),
        first_layer_mm: Some(0.26),
        ..options(Format::Prusa3mf)
    };
    assert_eq!(limits(given), [0.1, 0.3, 0.26, 0.4]);
    // Reports for other formats do not change.
    let reported = serde_json::to_value(Options::default().settled()).unwrap();
    assert_eq!(
        (&reported["layer_min_mm"], &reported["layer_max_mm"]),
        (&0.05.into(), &0.15.into())
    );
    assert!(reported.get("nozzle_mm").is_none());
}

#[test]
fn any_solid_has_a_plan_by_every_metric_without_a_tolerance() {
    for metric in cusp_slicer::profile::Metric::ALL {
        for format in Format::FILAMENT {
            let options = Options {
                metric,
                height_mm: Some(6.0),
                ..options(format)
            };
            for (name, triangles) in solids::all() {
                let sliced = slice(&triangles, &options);
                assert!(
                    sliced.is_ok(),
                    "{name}, {metric:?}: {}",
                    sliced.unwrap_err()
                );
            }
        }
    }
}

#[test]
fn what_only_resin_printers_have_is_refused() {
    let usual = options(Format::Prusa3mf);
    let resin_printer = Options {
        printer: Some("saturn-3-ultra".into()),
        ..usual.clone()
    };
    assert_eq!(code(&resin_printer).as_deref(), Some("resin-printer"));
    let quick = Options {
        max_time_s: Some(100.0),
        ..usual.clone()
    };
    assert_eq!(code(&quick).as_deref(), Some("contradictory-options"));
    let quick = Options {
        minimize: Minimize::Time,
        ..usual.clone()
    };
    assert_eq!(code(&quick).as_deref(), Some("contradictory-options"));
    let nozzle = |nozzle_mm, format| Options {
        nozzle_mm: Some(nozzle_mm),
        ..options(format)
    };
    let unknown = nozzle(0.4, Format::Goo);
    assert_eq!(code(&unknown).as_deref(), Some("nozzle-without-filament"));
    for nozzle_mm in [0.0, -0.4, 4.0, f64::NAN] {
        let bad = nozzle(nozzle_mm, Format::Prusa3mf);
        assert_eq!(code(&bad).as_deref(), Some("bad-nozzle"));
    }
    for format in Format::FILAMENT {
        let (towers, code) = (
            cusp_slicer::calibration::Calibration::layers(&options(format)),
            "no-masks",
        );
        assert_eq!(towers.unwrap_err().code(), code);
    }
}

#[test]
fn layers_beyond_the_nozzles_limits_are_refused() {
    let usual = options(Format::Prusa3mf);
    let range = HeightRange {
        from_mm: 1.0,
        to_mm: 2.0,
        layer_min_mm: 0.05,
        layer_max_mm: 0.2,
    };
    for options in [
        Options {
            layer_min_mm: Some(0.06),
            ..usual.clone()
        },
        Options {
            layer_max_mm: Some(0.31),
            ..usual.clone()
        },
        Options {
            first_layer_mm: Some(0.32),
            ..usual.clone()
        },
        Options {
            thicknesses_mm: vec![0.05, 0.2],
            ..usual.clone()
        },
        Options {
            planner: Planner::Uniform { layer_mm: 0.35 },
            ..usual.clone()
        },
        Options {
            ranges: vec![range],
            ..usual.clone()
        },
    ] {
        assert_eq!(code(&options).as_deref(), Some("nozzle-layers"));
    }
    assert_eq!(code(&usual), None);
}

/// If the slicer printed another first layer than the plan's, every layer would be wrong.
#[test]
fn a_model_of_one_layer_or_less_is_right_or_refused() {
    let plate = |height_mm, planner| {
        let plate = solids::cuboid(Vec3::new(5.0, 5.0, height_mm));
        let options = Options {
            planner,
            ..options(Format::Prusa3mf)
        };
        slice(&plate, &options)
    };
    let mut one_layer = 0;
    for height_mm in [0.05, 0.1, 0.15, 0.19, 0.2, 0.21, 0.23, 0.25, 0.3] {
        for planner in [Planner::Optimal, Planner::Finest, Planner::Coarsest] {
            match plate(height_mm, planner) {
                Ok((bytes, report)) => {
                    let file = read(&bytes, profile_name(Format::Prusa3mf));
                    let made = layers_of_prusa_slicer(&file.profile, file.height_mm(), 0.2, 0.07);
                    assert_eq!(made.unwrap().len(), report.layers, "{height_mm}");
                    assert_near(report.thickness_mm[0], 0.2, 1e-9);
                    one_layer += usize::from(report.layers == 1);
                }
                Err(error) => assert!(
                    matches!(
                        &*error.code(),
                        "other-first-layer" | "layers-do-not-fit" | "layer-too-thick"
                    ),
                    "{height_mm}: {error}"
                ),
            }
        }
    }
    assert!(one_layer > 0);
}
