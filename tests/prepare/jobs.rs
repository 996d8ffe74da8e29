//! Hollow models in jobs.

use std::ops::ControlFlow;

use crate::common::Slicer;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Error, Job, JobOptions, Options, OptionsError, Stage};
use cusp_slicer::ldi::LdiError;
use cusp_slicer::prepare::{AutoDrain, Drain, Hollowing, Infill, SupportStrength, Supporting};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::warning::Warning;
use glam::Vec3;

use super::{hollowed, plan};
use crate::common::{assert_near, load, quiet, solids};

#[test]
fn a_hollow_model_has_the_planes_of_the_solid_one() {
    let mut ball = load(&solids::sphere(12.0, 5));
    for metric in [
        Metric::Cusp,
        Metric::Deviation,
        Metric::Roughness,
        Metric::Area,
        Metric::Volume,
    ] {
        for source in [Source::Exact, Source::Sampled] {
            let hollow = Options {
                metric,
                source,
                ..hollowed(Hollowing::default())
            };
            let solid = Options {
                hollow: None,
                ..hollow.clone()
            };
            let [hollow, solid] = [hollow, solid].map(|options| plan(&mut ball, &options));
            assert_eq!(hollow.z_mm, solid.z_mm, "{metric:?} {source:?}");
            assert_eq!(hollow.max_error, solid.max_error, "{metric:?} {source:?}");
            assert_eq!(hollow.snapped_mm, solid.snapped_mm, "{metric:?} {source:?}");
            let void_ml = hollow.models[0].hollowed.clone().unwrap().void_ml;
            assert_near(solid.resin_ml - hollow.resin_ml, void_ml, 1e-3 * void_ml);
        }
    }
}

#[test]
fn a_solid_model_is_as_it_was_before_it_was_hollowed() {
    let mut cube = load(&solids::cube(15.0));
    let solid = Options {
        hollow: None,
        ..hollowed(Hollowing::default())
    };
    let file = |slicer: &mut crate::common::Slicer| {
        slicer.write_archive(Vec::new(), &mut quiet).unwrap().0
    };
    plan(&mut cube, &solid);
    let before = file(&mut cube);
    plan(&mut cube, &hollowed(Hollowing::default()));
    assert!(file(&mut cube) != before);
    plan(&mut cube, &solid);
    assert!(file(&mut cube) == before);
}

/// Counts the reports of progress while hollowing: a change of supports repeats none of them.
#[test]
fn a_change_of_supports_hollows_nothing_again() {
    let triangles = solids::sphere(12.0, 5);
    let of = |supports: Option<SupportStrength>| Options {
        supports: supports.map(|strength| Supporting {
            strength,
            ..Supporting::default()
        }),
        ..hollowed(Hollowing::default())
    };
    let print = |slicer: &mut Slicer, options: &Options| {
        let mut reports = 0;
        let mut count = |stage, _| {
            reports += usize::from(stage == Stage::Ldi);
            ControlFlow::Continue(())
        };
        pollster::block_on(slicer.plan(options, &mut count)).unwrap();
        let file = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
        (reports, file)
    };
    let mut changed = load(&triangles);
    print(&mut changed, &of(None));
    for strength in [SupportStrength::Light, SupportStrength::Heavy] {
        let options = of(Some(strength));
        let (again, file) = print(&mut changed, &options);
        let (anew, same) = print(&mut load(&triangles), &options);
        assert!(again < anew, "{again} of {anew}");
        assert!(file == same, "{strength:?}");
    }
}

#[test]
fn a_model_that_is_too_thin_stays_solid_with_a_warning() {
    let mut plate = load(&solids::cuboid(Vec3::new(20.0, 20.0, 3.0)));
    let report = plan(&mut plate, &hollowed(Hollowing::default()));
    assert_eq!(report.models[0].hollowed, None);
    let (wall_mm, cavity_mm) = (2.0, 2.0);
    let warning = Warning::NothingHollowed { wall_mm, cavity_mm };
    assert_eq!(report.all_warnings(), [warning]);
}

#[test]
fn lengths_that_nothing_can_be_made_of_are_refused() {
    let drain = |diameter_mm| Drain {
        at_mm: [0.0; 3],
        direction: [1.0, 0.0, 0.0],
        diameter_mm,
        depth_mm: None,
    };
    let usual = Hollowing::default;
    let infill = |spacing_mm, strut_mm| Hollowing {
        infill: Some(Infill {
            spacing_mm,
            strut_mm,
        }),
        ..usual()
    };
    let cases = [
        (
            "hollow.wall_mm",
            Hollowing {
                wall_mm: 0.3,
                ..usual()
            },
        ),
        (
            "hollow.wall_mm",
            Hollowing {
                wall_mm: f64::NAN,
                ..usual()
            },
        ),
        (
            "hollow.wall_mm",
            Hollowing {
                wall_mm: f64::INFINITY,
                ..usual()
            },
        ),
        (
            "hollow.cavity_mm",
            Hollowing {
                cavity_mm: -1.0,
                ..usual()
            },
        ),
        ("hollow.infill.strut_mm", infill(8.0, 0.1)),
        ("hollow.infill.spacing_mm", infill(1.5, 1.0)),
        (
            "hollow.drains.diameter_mm",
            Hollowing {
                drains: vec![drain(0.1)],
                ..usual()
            },
        ),
        (
            "hollow.auto_drain.diameter_mm",
            Hollowing {
                auto_drain: Some(AutoDrain {
                    diameter_mm: 0.0,
                    ..AutoDrain::default()
                }),
                ..usual()
            },
        ),
    ];
    for (name, hollow) in cases {
        let error = hollowed(hollow).check().unwrap_err();
        let Error::Options(OptionsError::BadLength { option, .. }) = error else {
            panic!("{error}");
        };
        assert_eq!(option, name);
    }
    // Whatever is large leaves a model solid.
    let mut cube = load(&solids::cube(10.0));
    for large in [100.0, 500.0] {
        for hollow in [
            Hollowing {
                wall_mm: large,
                ..usual()
            },
            Hollowing {
                cavity_mm: large,
                ..usual()
            },
            Hollowing {
                infill: Some(Infill {
                    spacing_mm: 2.0 * large,
                    strut_mm: large,
                }),
                ..usual()
            },
        ] {
            plan(&mut cube, &hollowed(hollow));
        }
    }
}

#[test]
fn slicers_of_filament_printers_hollow_by_themselves() {
    let options = Options {
        format: Some(Format::Prusa3mf),
        ..hollowed(Hollowing::default())
    };
    let Err(Error::Options(OptionsError::Contradictory { option, other })) = options.check() else {
        panic!("no error");
    };
    assert_eq!((option, other), ("prusa-3mf", "hollow"));
}

#[test]
fn holes_by_hand_are_for_a_model_alone() {
    let cubes = [10.0, 12.0].map(|side_mm| load(&solids::cube(side_mm)).into_model());
    let drain = Drain {
        at_mm: [5.0, 0.0, 5.0],
        direction: [-1.0, 0.0, 0.0],
        diameter_mm: 2.0,
        depth_mm: None,
    };
    let on_plate = |drains| JobOptions {
        options: Options {
            pixels: Some([400, 400]),
            ..hollowed(Hollowing {
                drains,
                auto_drain: Some(AutoDrain {
                    diameter_mm: 2.0,
                    ..AutoDrain::default()
                }),
                ..Hollowing::default()
            })
        },
        ..JobOptions::default()
    };
    let mut plate = Job::new(cubes.into());
    let error = pollster::block_on(plate.plan(&on_plate(vec![drain]), &mut quiet)).unwrap_err();
    assert!(matches!(
        error,
        Error::Options(OptionsError::Contradictory {
            option: "drains",
            ..
        })
    ));
    let report = pollster::block_on(plate.plan(&on_plate(Vec::new()), &mut quiet)).unwrap();
    // Each model has its own.
    for model in &report.plates[0].models {
        let void = model.hollowed.as_ref().unwrap();
        assert!(void.void_ml > 0.1 && void.drains.len() == 1);
    }
}

#[test]
fn what_is_larger_than_any_plate_is_refused_without_a_panic() {
    let mut cube = load(&solids::cube(10.0));
    for height_mm in [1e7, 1e12, 1e19] {
        let options = Options {
            height_mm: Some(height_mm),
            pitch_mm: None,
            rays: 64,
            ..hollowed(Hollowing {
                wall_mm: height_mm / 10.0,
                cavity_mm: height_mm / 10.0,
                auto_drain: Some(AutoDrain::default()),
                ..Hollowing::default()
            })
        };
        assert!(pollster::block_on(cube.plan(&options, &mut quiet)).is_err());
    }
    // A sheet with more columns than memory holds.
    let mut sheet = load(&solids::cuboid(Vec3::new(3000.0, 3000.0, 1.5)));
    let options = Options {
        pitch_mm: None,
        rays: 64,
        ..hollowed(Hollowing {
            wall_mm: 0.4,
            cavity_mm: 0.0,
            ..Hollowing::default()
        })
    };
    let error = pollster::block_on(sheet.plan(&options, &mut quiet)).unwrap_err();
    assert!(
        matches!(error, Error::Ldi(LdiError::OutOfMemory { .. })),
        "{error}"
    );
}
