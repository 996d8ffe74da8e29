//! The best orientations of models with a known answer.

use crate::common::{assert_near, load, quiet, solids};
use cusp_slicer::job::{Options, OrientationReport, Stage};
use cusp_slicer::orientation::{
    Candidate, Cost, Exclusion, Metrics, Quality, Search, SearchOptions, Terms, minima,
};
use glam::{DVec3, Quat, Vec3};
use std::ops::ControlFlow;

use super::{bean, degrees_between, degrees_off, few, measure, options, orient, tilt, turned};

#[test]
fn directions_are_spread_evenly() {
    let mut slicer = load(&solids::sphere(5.0, 3));
    let directions = slicer.directions(&options(), 500).unwrap();
    // The axes of the file are added; a ball has no flats.
    assert_eq!(directions.len(), 506);
    let directions: Vec<DVec3> = directions.into_iter().map(DVec3::from_array).collect();
    let even = &directions[..500];
    let usual = (4.0 * std::f64::consts::PI / 500.0).sqrt();
    for (i, &direction) in even.iter().enumerate() {
        assert_near(direction.length(), 1.0, 1e-12);
        let others = even.iter().enumerate().filter(|&(j, _)| j != i);
        let nearest = others
            .map(|(_, other)| direction.distance(*other))
            .fold(f64::INFINITY, f64::min);
        assert!((0.75 * usual..1.1 * usual).contains(&nearest), "{nearest}");
    }
    // No part of the sphere is far from all of them.
    for axis in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::ONE.normalize()] {
        let nearest = even.iter().map(|it| it.distance(axis));
        assert!(nearest.fold(f64::INFINITY, f64::min) < usual);
    }
}

#[test]
fn flats_are_looked_at_exactly() {
    let slab = turned(&solids::cuboid(Vec3::new(40.0, 30.0, 4.0)), tilt());
    let directions = load(&slab).directions(&options(), 10).unwrap();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        let up = (tilt() * axis).as_dvec3();
        for wanted in [up, -up] {
            let is_there = |it: &[f64; 3]| degrees_between(DVec3::from_array(*it), wanted) < 1e-3;
            assert!(directions[10..].iter().any(is_there), "{wanted}");
        }
    }
}

#[test]
fn a_tilted_slab_is_laid_flat_again() {
    let slab = turned(&solids::cuboid(Vec3::new(40.0, 30.0, 4.0)), tilt());
    let found = orient(&slab, &options(), &few(400));
    let first = &found.best[0];
    assert!(degrees_off(first, tilt() * Vec3::Z) < 0.01);
    assert_near(first.size_mm[2], 4.0, 1e-4);
    assert!(first.energy < found.now.energy);
}

#[test]
fn a_tilted_cylinder_is_found_again() {
    let disc = turned(&solids::cylinder(15.0, 3.0, 16), tilt());
    let found = orient(&disc, &options(), &few(400));
    assert!(degrees_off(&found.best[0], tilt() * Vec3::Z) < 2.0);
    // With the fewest layers a rod lies down, however it is rolled.
    let rod = turned(&solids::cylinder(2.0, 30.0, 16), tilt());
    let layers = SearchOptions {
        alpha: 1.0,
        ..few(400)
    };
    let found = orient(&rod, &options(), &layers);
    assert!((degrees_off(&found.best[0], tilt() * Vec3::Z) - 90.0).abs() < 2.0);
}

#[test]
fn what_has_no_flats_is_found_by_the_finer_search() {
    let mut ball = solids::sphere(1.0, 4);
    for corner in ball.iter_mut().flatten() {
        *corner *= Vec3::new(12.0, 9.0, 3.0);
    }
    let ellipsoid = turned(&ball, tilt());
    let found = orient(&ellipsoid, &options(), &few(300));
    let axis = tilt() * Vec3::Z;
    assert!(degrees_off(&found.best[0], axis) < 2.0);
    // The first pass alone is only as accurate as its spacing.
    let coarse = found
        .candidates
        .iter()
        .min_by(|a, b| a.energy.partial_cmp(&b.energy).unwrap());
    assert!(found.best[0].energy <= coarse.unwrap().energy);
    assert!(degrees_off(coarse.unwrap(), axis) > degrees_off(&found.best[0], axis));
}

#[test]
fn turning_the_model_turns_the_answer() {
    let as_it_is = orient(&bean(), &options(), &few(400));
    for rotation in [tilt(), tilt() * tilt(), Quat::from_rotation_y(0.7)] {
        let there = orient(&turned(&bean(), rotation), &options(), &few(400));
        assert_near(
            there.best[0].energy.unwrap(),
            as_it_is.best[0].energy.unwrap(),
            0.01,
        );
        let expected = rotation.as_dquat() * DVec3::from_array(as_it_is.best[0].direction);
        let any = there
            .best
            .iter()
            .map(|candidate| degrees_between(DVec3::from_array(candidate.direction), expected));
        // The minimum is flat: energies around it differ by less than one layer does.
        assert!(any.fold(f64::INFINITY, f64::min) < 3.0);
    }
}

#[test]
fn threads_make_no_difference() {
    let model = bean();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| orient(&model, &options(), &few(200)))
    };
    let alone = with(1);
    assert_eq!(alone, with(8));
    assert_eq!(alone, with(3));
    assert!(!alone.best.is_empty());
}

#[test]
fn rays_make_no_difference() {
    let coarse = Options {
        rays: 16,
        ..options()
    };
    let few = few(50);
    assert_eq!(
        orient(&bean(), &coarse, &few),
        orient(&bean(), &options(), &few)
    );
}

fn rated(found: &OrientationReport) -> impl Iterator<Item = (f64, Metrics)> {
    let candidates = found.candidates.iter();
    candidates.filter_map(|candidate| Some((candidate.energy?, candidate.metrics?)))
}

#[test]
fn alpha_and_the_terms_do_what_they_say() {
    let model = bean();
    let mut slicer = load(&model);
    let directions = slicer.directions(&options(), 200).unwrap();
    let candidates = measure(&mut slicer, &options(), &directions);
    let mut search = |alpha, cost, quality| {
        let search = SearchOptions {
            alpha,
            cost,
            quality,
            ..few(200)
        };
        let search = Search::of_measured(search, candidates.clone()).unwrap();
        slicer
            .finish_search(&options(), search, &mut quiet)
            .unwrap()
    };
    let least = |found: &OrientationReport, of: fn(&Metrics) -> f64| {
        rated(found)
            .map(|(_, metrics)| of(&metrics))
            .fold(f64::INFINITY, f64::min)
    };
    let first = |found: &OrientationReport| found.best[0].metrics.unwrap();
    let found = search(1.0, Cost::Layers, Quality::Error);
    assert!(first(&found).layers as f64 <= least(&found, |it| it.layers as f64));
    let found = search(1.0, Cost::Time, Quality::Error);
    assert!(first(&found).print_time_s <= least(&found, |it| it.print_time_s));
    for (quality, of) in [
        (Quality::Error, (|it| it.max_error) as fn(&Metrics) -> f64),
        (Quality::Roughness, |it| it.roughness_mm),
        (Quality::Overhang, |it| it.overhang_mm2),
        (Quality::Islands, |it| it.islands as f64),
        (Quality::Cups, |it| it.cups_mm2),
        (Quality::Supports, |it| it.support_ml),
        (Quality::Contacts, |it| it.contact_mm2),
    ] {
        let found = search(0.0, Cost::Layers, quality);
        assert!(of(&first(&found)) <= least(&found, of), "{quality:?}");
    }
    // Eq. 25, by hand.
    let found = search(0.3, Cost::Time, Quality::Overhang);
    let most = |of: fn(&Metrics) -> f64| rated(&found).map(|(_, it)| of(&it)).fold(0.0, f64::max);
    let (time, overhang) = (most(|it| it.print_time_s), most(|it| it.overhang_mm2));
    assert_eq!((found.scale.time, found.scale.overhang), (time, overhang));
    for (energy, metrics) in rated(&found) {
        let expected = 0.3 * metrics.print_time_s / time + 0.7 * metrics.overhang_mm2 / overhang;
        assert_near(energy, expected, 1e-12);
    }
}

#[test]
fn a_ranking_weighs_every_term_whatever_the_weights_add_up_to() {
    let mut slicer = load(&bean());
    let directions = slicer.directions(&options(), 200).unwrap();
    let candidates = measure(&mut slicer, &options(), &directions);
    let ranking = Terms {
        islands: 6.0,
        supports: 3.0,
        height: 1.0,
        ..Terms::default()
    };
    let search = SearchOptions {
        ranking: Some(ranking),
        ..few(200)
    };
    let search = Search::of_measured(search, candidates).unwrap();
    let found = slicer
        .finish_search(&options(), search, &mut quiet)
        .unwrap();
    let highest = found.candidates.iter().filter(|it| it.metrics.is_some());
    let highest = highest.map(|it| it.size_mm[2]).fold(0.0, f64::max);
    assert_eq!(found.scale.height, highest);
    for candidate in &found.candidates {
        let (Some(energy), Some(metrics)) = (candidate.energy, candidate.metrics) else {
            continue;
        };
        let of = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
        let expected = 0.6 * of(metrics.islands as f64, found.scale.islands)
            + 0.3 * of(metrics.support_ml, found.scale.supports)
            + 0.1 * candidate.size_mm[2] / highest;
        assert_near(energy, expected, 1e-12);
    }
}

#[test]
fn minima_have_no_better_neighbour() {
    let found = orient(&bean(), &options(), &few(300));
    let reach = 1.5 * (4.0 * std::f64::consts::PI / 300.0).sqrt();
    let place = |index: usize| DVec3::from_array(found.candidates[index].direction);
    let energy = |index: usize| found.candidates[index].energy.unwrap();
    let all = 0..found.candidates.len();
    let mut naive: Vec<usize> = all
        .clone()
        .filter(|&index| {
            all.clone().all(|other| {
                place(other).distance(place(index)) > reach
                    || (energy(index), index) <= (energy(other), other)
            })
        })
        .collect();
    naive.sort_by(|&a, &b| energy(a).total_cmp(&energy(b)));
    let minima = minima(&found.candidates, &few(300));
    naive.truncate(minima.len());
    assert!(naive.len() >= 2);
    assert_eq!(minima, naive);
    // The best candidates are distinct, and in order.
    for (i, first) in found.best.iter().enumerate() {
        for second in &found.best[i + 1..] {
            let [a, b] = [first, second].map(|it| DVec3::from_array(it.direction));
            assert!(degrees_between(a, b) >= 20.0);
            assert!(first.energy <= second.energy);
        }
    }
}

#[test]
fn what_does_not_fit_is_excluded_and_what_fits_askew_is_turned() {
    // Longer than the sides of the plate, but shorter than its diagonal.
    let plate = Options {
        pixels: Some([1430, 890]),
        pitch_mm: Some(0.1),
        ..options()
    };
    let mut rod = load(&solids::cuboid(Vec3::new(155.0, 4.0, 4.0)));
    let lying = &measure(&mut rod, &plate, &[DVec3::Z.to_array()])[0];
    assert_eq!(lying.excluded, None);
    assert!(lying.size_mm[0] <= 143.0 && lying.size_mm[1] <= 89.0);
    let there = Options {
        rotation: Some(lying.rotation),
        ..plate.clone()
    };
    let planned = pollster::block_on(rod.plan(&there, &mut quiet)).unwrap();
    assert_eq!(planned.layers, lying.metrics.unwrap().layers);

    let mut longer = load(&solids::cuboid(Vec3::new(175.0, 4.0, 4.0)));
    let found = measure(
        &mut longer,
        &plate,
        &[DVec3::Z, DVec3::X].map(|it| it.to_array()),
    );
    assert_eq!(found[0].excluded, Some(Exclusion::TooLarge));
    assert_eq!((found[0].metrics, found[0].energy), (None, None));
    assert_eq!(found[1].excluded, None);

    let printer = Options {
        printer: Some("saturn-3-ultra".into()),
        ..Options::default()
    };
    // Too long for the plate, for the height, and for the diagonal.
    let mut tower = load(&solids::cuboid(Vec3::new(400.0, 4.0, 4.0)));
    let found = tower.orient(&printer, &few(50), &mut quiet).unwrap();
    assert!(found.best.is_empty());
    assert_eq!(found.now.excluded, Some(Exclusion::TooLarge));
    assert_eq!(
        measure(&mut tower, &printer, &[DVec3::X.to_array()])[0].excluded,
        Some(Exclusion::TooHigh)
    );

    let tight = Options {
        tolerance: Some(0.001),
        ..options()
    };
    let found = orient(&bean(), &tight, &few(20));
    let is_no_plan = |it: &Candidate| it.excluded == Some(Exclusion::NoPlan);
    assert!(found.candidates.iter().all(is_no_plan));
}

#[test]
fn a_height_is_that_of_the_present_pose() {
    let slab = solids::cuboid(Vec3::new(40.0, 30.0, 4.0));
    let on_edge = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    let scaled = Options {
        rotation: Some(on_edge.as_dquat().to_array()),
        height_mm: Some(20.0),
        ..options()
    };
    let found = orient(&slab, &scaled, &few(100));
    for (size, expected) in found.best[0].size_mm.into_iter().zip([20.0, 15.0, 2.0]) {
        assert_near(size, expected, 1e-4);
    }
    assert_near(found.now.size_mm[2], 20.0, 1e-4);
}

#[test]
fn searches_end_when_nobody_wants_them() {
    let mut slicer = load(&bean());
    let mut calls = 0;
    let stopped = slicer.orient(&options(), &few(2000), &mut |stage, fraction| {
        assert_eq!(stage, Stage::Orientation);
        assert!((0.0..=1.0).contains(&fraction));
        calls += 1;
        if calls == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert_eq!(stopped.unwrap_err().code(), "cancelled");
    assert_eq!(calls, 3);
    let none = SearchOptions {
        directions: 0,
        ..SearchOptions::default()
    };
    let beyond = SearchOptions {
        alpha: 1.1,
        ..SearchOptions::default()
    };
    let negative = SearchOptions {
        most_cups_mm2: Some(-1.0),
        ..SearchOptions::default()
    };
    for (search, code) in [
        (none, "bad-directions"),
        (beyond, "bad-alpha"),
        (negative, "bad-search-limit"),
    ] {
        let error = slicer.orient(&options(), &search, &mut quiet).unwrap_err();
        assert_eq!(error.code(), code);
    }
    let unknown = Options {
        printer: Some("none".into()),
        ..options()
    };
    let error = slicer.orient(&unknown, &few(5), &mut quiet).unwrap_err();
    assert_eq!(error.code(), "unknown-printer");
}
