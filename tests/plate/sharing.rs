//! Rays, plans and time shared by copies.

use crate::common::Slicer;
use cusp_slicer::Error;
use cusp_slicer::arrange::shadow_mm2;
use cusp_slicer::job::{Job, JobOptions, ModelOptions, Options, Placement};
use cusp_slicer::plan::PlanError;
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::warning::Warning;
use glam::Vec3;

use super::{job, options, plan, plate};
use crate::common::{assert_near, load, quiet, solids};

#[test]
fn copies_cost_the_rays_of_one() {
    let ball = solids::sphere(1.5, 3);
    let mut alone = load(&ball);
    let one = pollster::block_on(alone.plan(&options(), &mut quiet)).unwrap();
    let mut many = plate(&[&ball]);
    let report = plan(&mut many, &job(options(), &[40])).unwrap();
    let [report] = &report.plates[..] else {
        panic!("one plate")
    };
    assert_eq!(report.models[0].hits, one.models[0].hits);
    assert_eq!((&report.z_mm, report.max_error), (&one.z_mm, one.max_error));
    assert_near(report.resin_ml, 40.0 * one.resin_ml, 1e-9);
    assert_eq!(report.placements.len(), 40);
}

#[test]
fn plates_of_the_same_models_have_one_plan() {
    let square = solids::cuboid(Vec3::new(8.0, 8.0, 1.0));
    let mut many = plate(&[&square]);
    let report = plan(&mut many, &job(options(), &[30])).unwrap();
    assert_eq!(report.plates.len(), 3);
    assert_eq!(report.plates[0].z_mm, report.plates[1].z_mm);
    let copies = |plate: usize| report.plates[plate].models[0].copies;
    assert_eq!([copies(0), copies(1), copies(2)], [12, 12, 6]);
    assert_near(
        report.print_time_s,
        3.0 * report.plates[0].print_time_s,
        1e-6,
    );
}

/// The largest errors of a plan on a model, by its exact profile.
fn errors(model: &mut Slicer, z_mm: &[f64], bin_mm: f64) -> f64 {
    let options = cusp_slicer::job::Options {
        bin_mm: Some(bin_mm),
        ..options()
    };
    pollster::block_on(model.plan(&options, &mut quiet)).unwrap();
    let density = model.profile(Metric::Cusp, Source::Exact).unwrap().density;
    let boundary = |z_mm: f64| ((z_mm / bin_mm).round() as usize).min(density.len());
    let layers = z_mm.windows(2).map(|pair| {
        let bins = &density[boundary(pair[0])..boundary(pair[1])];
        bins.iter().map(|&value| f64::from(value)).sum::<f64>() * bin_mm
    });
    layers.fold(0.0, f64::max)
}

#[test]
fn no_model_of_a_plate_exceeds_its_own_tolerance_and_each_alone_needs_fewer_layers() {
    let (ball, cone) = (solids::sphere(3.0, 4), solids::cone(3.0, 11.0, 16));
    for own in [None, Some(0.03), Some(0.12)] {
        let mut both = plate(&[&ball, &cone]);
        let options = JobOptions {
            models: vec![
                ModelOptions::default(),
                ModelOptions {
                    tolerance: own,
                    ..ModelOptions::default()
                },
            ],
            ..job(options(), &[])
        };
        let report = plan(&mut both, &options).unwrap();
        let report = &report.plates[0];
        let models = &report.models;
        for (model, (solid, tolerance)) in [(&ball, 0.065), (&cone, own.unwrap_or(0.065))]
            .into_iter()
            .enumerate()
        {
            let error = errors(&mut load(solid), &report.z_mm, report.bin_mm);
            assert!(error <= tolerance + 1e-6, "{model}: {error} of {tolerance}");
            assert_near(models[model].max_error, error, 1e-5);
            let mut alone = load(solid);
            let of_model = cusp_slicer::job::Options {
                tolerance: Some(tolerance),
                ..super::options()
            };
            let alone = pollster::block_on(alone.plan(&of_model, &mut quiet)).unwrap();
            assert!(alone.layers <= models[model].layers + 1);
        }
        assert!(models[0].layers < models[1].layers);
    }
}

/// The model that a failure names, its tolerance, and the one that it advises.
fn advice(error: Error) -> (Option<usize>, f64, f64) {
    match error {
        Error::Plan(
            PlanError::Infeasible {
                model_number,
                tolerance,
                least_tolerance: Some(least),
                ..
            }
            | PlanError::ThicknessesDoNotFit {
                model_number,
                tolerance,
                least_tolerance: Some(least),
                ..
            },
        ) => (model_number, tolerance, least),
        other => panic!("{other}"),
    }
}

#[test]
fn the_advice_on_a_tolerance_that_cannot_be_kept_works_in_the_figures_of_whom_it_names() {
    let (ball, cone) = (solids::sphere(3.0, 4), solids::cone(3.0, 11.0, 16));
    let of = |own: [Option<f64>; 2], tolerance: f64, thicknesses_mm: &[f64]| JobOptions {
        models: own
            .map(|tolerance| ModelOptions {
                tolerance,
                ..ModelOptions::default()
            })
            .to_vec(),
        ..job(
            Options {
                tolerance: Some(tolerance),
                thicknesses_mm: thicknesses_mm.to_vec(),
                ..options()
            },
            &[],
        )
    };
    for thicknesses_mm in [&[][..], &[0.05, 0.1]] {
        // The ball's tolerance alone, the job's alone, and both with one below its reach.
        for (own, tolerance, named) in [
            ([Some(0.01), None], 0.3, &[Some(1)][..]),
            ([Some(0.3), Some(0.001)], 0.2, &[Some(2)]),
            ([Some(0.3), None], 0.001, &[None]),
            ([Some(0.01), Some(0.001)], 0.3, &[Some(1), Some(2)]),
        ] {
            let mut own = own;
            let mut tolerance = tolerance;
            let mut both = plate(&[&ball, &cone]);
            for &expected in named {
                let options = of(own, tolerance, thicknesses_mm);
                let (model, stated, least) = advice(plan(&mut both, &options).unwrap_err());
                assert_eq!(model, expected);
                let slot = match model {
                    Some(number) => own[number - 1].as_mut().unwrap(),
                    None => &mut tolerance,
                };
                assert_eq!(stated.to_bits(), slot.to_bits());
                // A little less does not do.
                *slot = least * 0.999;
                let options = of(own, tolerance, thicknesses_mm);
                assert_eq!(advice(plan(&mut both, &options).unwrap_err()).0, model);
                let slot = match model {
                    Some(number) => own[number - 1].as_mut().unwrap(),
                    None => &mut tolerance,
                };
                *slot = least;
            }
            let report = plan(&mut both, &of(own, tolerance, thicknesses_mm)).unwrap();
            let models = &report.plates[0].models;
            for (model, own) in models.iter().zip(own) {
                assert!(model.max_error <= own.unwrap_or(tolerance) + 1e-6);
            }
        }
    }
}

#[test]
fn time_is_shared_by_the_copies_that_a_layer_reaches() {
    // Two columns of the same shadow, one twice as high, in layers of one exposure.
    let (low, high) = (
        solids::cuboid(Vec3::new(5.0, 5.0, 4.0)),
        solids::cuboid(Vec3::new(5.0, 5.0, 8.0)),
    );
    let mut options = job(options(), &[3, 1]);
    options.options.resin.bottom_layers = 0;
    let mut both = plate(&[&low, &high]);
    let report = plan(&mut both, &options).unwrap();
    let report = &report.plates[0];
    let models = &report.models;
    let layer_s = |bottom_mm: f64, top_mm: f64| {
        let layers = report.z_mm.windows(2).zip(&report.exposure_s);
        let within =
            layers.filter(|(pair, _)| pair[0] >= bottom_mm - 1e-9 && pair[1] <= top_mm + 1e-9);
        within
            .map(|(_, exposure_s)| exposure_s + report.overhead_s)
            .sum::<f64>()
    };
    let quarter_s = layer_s(0.0, 4.0) / 4.0;
    assert_near(models[0].print_time_s, quarter_s, 1e-3);
    assert_near(models[1].print_time_s, quarter_s + layer_s(4.0, 8.0), 1e-3);
    let all_s = 3.0 * models[0].print_time_s + models[1].print_time_s;
    assert_near(all_s, report.print_time_s, 1e-3);
}

#[test]
fn shares_follow_the_true_area_of_shadows() {
    // 60 and 10 mm² of shadow, of which the narrow one lies in as many cells of the plate as one of 40.
    let (wide, narrow) = (
        solids::cuboid(Vec3::new(10.0, 6.0, 5.0)),
        solids::cuboid(Vec3::new(20.0, 0.5, 5.0)),
    );
    let report = plan(&mut plate(&[&wide, &narrow]), &job(options(), &[1, 1])).unwrap();
    let models = &report.plates[0].models;
    let all_s = report.print_time_s;
    assert_near(models[0].print_time_s, all_s * 6.0 / 7.0, 1e-3);
    assert_near(models[1].print_time_s, all_s / 7.0, 1e-3);
    // Parts above others have no shadow of their own.
    let mut mushroom = solids::moved(&solids::sphere(5.0, 5), Vec3::Z * 9.0);
    mushroom.extend(solids::cuboid(Vec3::new(2.0, 2.0, 6.0)));
    let mesh = crate::common::on_plate(&mushroom);
    assert_near(shadow_mm2(&mesh), std::f64::consts::PI * 25.0, 0.1);
}

#[test]
fn the_plan_does_not_depend_on_the_number_of_copies() {
    // A peg whose top, of less than 1 mm², deserves no plane.
    let mut pegged = solids::cuboid(Vec3::new(8.0, 8.0, 3.0));
    let peg = solids::cuboid(Vec3::new(0.7, 0.7, 1.03));
    pegged.extend(solids::moved(&peg, Vec3::new(3.0, 3.0, 3.0)));
    let mut many = plate(&[&pegged]);
    let of = |many: &mut Job, copies| plan(many, &job(options(), &[copies])).unwrap();
    let one = of(&mut many, 1).plates[0].z_mm.clone();
    for copies in [2, 3, 5] {
        assert_eq!(of(&mut many, copies).plates[0].z_mm, one, "{copies}");
    }
}

#[test]
fn copies_have_the_curve_of_one_and_several_models_a_slower_one() {
    let (ball, cone) = (solids::sphere(3.0, 4), solids::cone(3.0, 5.0, 8));
    let mut alone = load(&ball);
    let curve = pollster::block_on(alone.tradeoff(&options(), 9, &mut quiet)).unwrap();
    let of = |plate: &mut Job, number, copies: &[usize]| {
        pollster::block_on(plate.tradeoff(number, &job(options(), copies), 9, &mut quiet))
    };
    let mut copies = plate(&[&ball]);
    assert_eq!(of(&mut copies, 0, &[3]).unwrap(), curve);
    assert_eq!(
        of(&mut copies, 1, &[3]).unwrap_err().code(),
        "no-such-plate"
    );
    let mut both = plate(&[&ball, &cone]);
    for point in of(&mut both, 0, &[1, 1]).unwrap().points {
        let mut limited = options();
        limited.tolerance = Some(point.tolerance);
        let report = plan(&mut both, &job(limited, &[1, 1])).unwrap();
        assert_eq!(report.plates[0].layers, point.layers);
    }
}

#[test]
fn copies_are_bounded_and_agree_with_their_places() {
    let cube = solids::cube(3.0);
    let mut many = plate(&[&cube]);
    let code = |many: &mut Job, options: &JobOptions| plan(many, options).unwrap_err().code();
    for copies in [10_001, usize::MAX] {
        assert_eq!(
            code(&mut many, &job(options(), &[copies])),
            "too-many-copies"
        );
        let arranged = many.arrange(&job(options(), &[copies]));
        assert_eq!(arranged.unwrap_err().code(), "too-many-copies");
    }
    let place = |plate, x_mm| Placement {
        model: 0,
        plate,
        x_mm,
        y_mm: 0.0,
        turn_deg: 0,
    };
    let placed = |copies, placements: &[Placement]| JobOptions {
        placements: placements.to_vec(),
        ..job(options(), &[copies])
    };
    let places = [place(0, -5.0), place(0, 5.0)];
    assert_eq!(code(&mut many, &placed(3, &places)), "plate-other-copies");
    assert!(plan(&mut many, &placed(2, &places)).is_ok());
    let gap = [place(0, 0.0), place(2, 0.0)];
    assert_eq!(code(&mut many, &placed(2, &gap)), "plate-gap");
}

#[test]
fn height_ranges_of_models_are_joined() {
    let cube = solids::cube(8.0);
    let range = |from_mm, to_mm, layer_min_mm, layer_max_mm| cusp_slicer::plan::HeightRange {
        from_mm,
        to_mm,
        layer_min_mm,
        layer_max_mm,
    };
    let own = |ranges| ModelOptions {
        ranges,
        ..ModelOptions::default()
    };
    let mut both = plate(&[&cube, &cube]);
    let mut options = JobOptions {
        models: vec![
            own(vec![range(1.0, 4.0, 0.05, 0.1)]),
            own(vec![range(3.0, 6.0, 0.08, 0.15)]),
        ],
        ..job(options(), &[])
    };
    let report = plan(&mut both, &options).unwrap();
    let layers = report.plates[0].z_mm.windows(2);
    for pair in layers {
        let thickness_mm = pair[1] - pair[0];
        let (least, greatest) = match pair[0] {
            z if !(1.0 - 1e-9..=6.0 - 1e-9).contains(&z) => (0.05, 0.15),
            z if z < 3.0 - 1e-9 => (0.05, 0.1),
            z if z < 4.0 - 1e-9 => (0.08, 0.1),
            _ => (0.08, 0.15),
        };
        assert!(
            (least - 1e-9..=greatest + 1e-9).contains(&thickness_mm),
            "{pair:?}"
        );
    }
    options.models[1].ranges = vec![range(3.0, 6.0, 0.12, 0.15)];
    let refused = plan(&mut both, &options).unwrap_err();
    assert_eq!(refused.code(), "layer-range-upside-down");
}

#[test]
fn a_model_with_a_height_of_its_own_has_no_odd_size() {
    let tiny = solids::cube(0.5);
    let mut options = job(options(), &[2]);
    let is_odd = |options: &JobOptions| {
        let report = plan(&mut plate(&[&tiny]), options).unwrap();
        let mut warnings = report.plates[0].models[0].warnings.iter();
        warnings.any(|it| matches!(it, Warning::OddSize { .. }))
    };
    assert!(is_odd(&options));
    options.models[0].height_mm = Some(5.0);
    assert!(!is_odd(&options));
}

#[test]
fn a_change_of_places_repeats_neither_rays_nor_plan() {
    let ball = solids::sphere(2.0, 3);
    let mut two = plate(&[&ball]);
    let options = job(options(), &[2]);
    let first = plan(&mut two, &options).unwrap();
    let mut placements = first.plates[0].placements.clone();
    placements[0].x_mm -= 5.0;
    let moved = JobOptions {
        placements,
        ..options
    };
    let second = plan(&mut two, &moved).unwrap();
    assert_eq!(second.plates[0].timings_ms.ldi, 0.0);
    assert_eq!(second.plates[0].z_mm, first.plates[0].z_mm);
    assert_ne!(second.plates[0].placements, first.plates[0].placements);
}
