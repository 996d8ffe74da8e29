//! The search for the best direction: planted answers, symmetries, metrics against other ways to them, shards.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::ops::ControlFlow;

use common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::job::{Options, OrientationPart, OrientationReport, Slicer, Snap, Stage};
use cusp_slicer::model::Pose;
use cusp_slicer::orientation::shard::{MergeError, Shard};
use cusp_slicer::orientation::{
    Candidate, Cost, Exclusion, Metrics, Quality, Search, SearchOptions, Task, minima,
};
use cusp_slicer::profile::Metric;
use glam::{DQuat, DVec3, Quat, Vec3};

const METRICS: [Metric; 4] = [
    Metric::Cusp,
    Metric::Roughness,
    Metric::Area,
    Metric::Volume,
];

/// Coarser bins than usual, for speed.
fn options() -> Options {
    Options {
        bin_mm: Some(0.01),
        ..Options::default()
    }
}

fn few(directions: usize) -> SearchOptions {
    SearchOptions {
        directions,
        ..SearchOptions::default()
    }
}

fn slicer(triangles: &solids::Triangles) -> Slicer {
    Slicer::load(&binary_stl(triangles)).unwrap()
}

fn orient(
    triangles: &solids::Triangles,
    options: &Options,
    search: &SearchOptions,
) -> OrientationReport {
    let mut slicer = slicer(triangles);
    slicer.orient(options, search, &mut quiet).unwrap()
}

fn measure(slicer: &mut Slicer, options: &Options, directions: &[[f64; 3]]) -> Vec<Candidate> {
    let task = Task {
        number: 0,
        directions: directions.to_vec(),
    };
    slicer.evaluate(options, task).unwrap().candidates
}

fn metrics(slicer: &mut Slicer, options: &Options, direction: DVec3) -> Metrics {
    measure(slicer, options, &[direction.to_array()])[0]
        .metrics
        .unwrap()
}

/// Some rotation that has nothing to do with any axis or lattice.
fn tilt() -> Quat {
    Quat::from_xyzw(0.31, -0.44, 0.12, 0.83).normalize()
}

fn turned(triangles: &solids::Triangles, rotation: Quat) -> solids::Triangles {
    let turn = |corner: &Vec3| rotation * *corner;
    let facets = triangles.iter();
    facets.map(|corners| corners.each_ref().map(turn)).collect()
}

/// An ellipsoid with a bump on one side: smooth, and without any symmetry but one.
fn bean() -> solids::Triangles {
    let mut ball = solids::sphere(1.0, 4);
    for corner in ball.iter_mut().flatten() {
        let bump = 1.0 + 0.25 * (corner.x + 0.5 * corner.z).max(0.0).powi(2);
        *corner *= bump * Vec3::new(11.0, 8.0, 4.0);
    }
    ball
}

fn degrees_between(a: DVec3, b: DVec3) -> f64 {
    a.angle_between(b).to_degrees()
}

/// The angle between a candidate's direction and an axis, whichever way this points.
fn degrees_off(candidate: &Candidate, axis: Vec3) -> f64 {
    let angle = degrees_between(DVec3::from_array(candidate.direction), axis.as_dvec3());
    angle.min(180.0 - angle)
}

#[test]
fn directions_are_spread_evenly() {
    let mut slicer = slicer(&solids::sphere(5.0, 3));
    let directions = slicer.directions(&options(), 500).unwrap();
    // The axes of the file come on top; a ball has no flats.
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
    // No direction anywhere is far from all of them.
    for axis in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::ONE.normalize()] {
        let nearest = even.iter().map(|it| it.distance(axis));
        assert!(nearest.fold(f64::INFINITY, f64::min) < usual);
    }
}

#[test]
fn flats_are_looked_at_exactly() {
    let slab = turned(&solids::cuboid(Vec3::new(40.0, 30.0, 4.0)), tilt());
    let directions = slicer(&slab).directions(&options(), 10).unwrap();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        let up = (tilt() * axis).as_dvec3();
        for wanted in [up, -up] {
            let is_there = |it: &[f64; 3]| degrees_between(DVec3::from_array(*it), wanted) < 1e-3;
            assert!(directions[10..].iter().any(is_there), "{wanted}");
        }
    }
}

#[test]
fn candidates_are_what_a_glance_in_their_pose_shows() {
    let model = bean();
    let mut slicer = slicer(&model);
    let directions = slicer.directions(&options(), 12).unwrap();
    for metric in METRICS {
        let options = Options {
            metric,
            height_mm: Some(9.0),
            tolerance: (metric == Metric::Volume).then_some(3.0),
            ..options()
        };
        let found = measure(&mut slicer, &options, &directions);
        for candidate in found {
            let there = Options {
                rotation: Some(candidate.rotation),
                height_mm: Some(candidate.size_mm[2]),
                ..options.clone()
            };
            let (preview, _) = slicer.preview(&there).unwrap();
            let metrics = candidate.metrics.unwrap();
            assert!(metrics.layers.abs_diff(preview.layers) <= 1);
            assert_near(
                metrics.max_error,
                preview.max_error,
                0.02 * preview.max_error,
            );
            for (ours, theirs) in candidate.size_mm.into_iter().zip(preview.size_mm) {
                assert_near(ours, theirs, 1e-5);
            }
            // The rotation turns the direction upright.
            let up = DQuat::from_array(candidate.rotation) * DVec3::from_array(candidate.direction);
            assert_near(up.z, 1.0, 1e-12);
        }
    }
}

#[test]
fn weights_count_facet_by_facet() {
    let model = bean();
    let mut slicer = slicer(&model);
    let weights = model
        .iter()
        .map(|corners| if corners[0].x > 0.0 { 1.0 } else { 0.3 });
    slicer.set_weights(Some(weights.collect())).unwrap();
    let directions = slicer.directions(&options(), 20).unwrap();
    let found = measure(&mut slicer, &options(), &directions);
    slicer.set_weights(None).unwrap();
    let plain = measure(&mut slicer, &options(), &directions);
    slicer.set_weights(Some(vec![1.0; model.len()])).unwrap();
    let mut fewer = 0;
    for (candidate, plain) in found.iter().zip(&plain) {
        let layers = candidate.metrics.unwrap().layers;
        assert!(layers <= plain.metrics.unwrap().layers);
        fewer += usize::from(layers < plain.metrics.unwrap().layers);
    }
    assert!(fewer > 5, "{fewer}");
    let weights = model
        .iter()
        .map(|corners| if corners[0].x > 0.0 { 1.0 } else { 0.3 });
    slicer.set_weights(Some(weights.collect())).unwrap();
    for candidate in found {
        let options = Options {
            rotation: Some(candidate.rotation),
            ..options()
        };
        let (preview, _) = slicer.preview(&options).unwrap();
        assert!(candidate.metrics.unwrap().layers.abs_diff(preview.layers) <= 1);
    }
}

#[test]
fn overhangs_have_closed_forms() {
    let (side, height) = (10.0, 12.0);
    let mut tower = slicer(&solids::cuboid(Vec3::new(side, side, height)));
    let at = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        DVec3::new(0.0, -sine, cosine)
    };
    let [side, height] = [f64::from(side), f64::from(height)];
    for (degrees, expected) in [
        // On its base, on a side, and on its top.
        (0.0, 0.0),
        (90.0, 0.0),
        (180.0, 0.0),
        // The base, less than 45° from level, is in the air; then the side is.
        (30.0, side * side),
        (60.0, side * height),
    ] {
        let found = metrics(&mut tower, &options(), at(degrees));
        assert_near(found.overhang_mm2, expected, 1e-3);
    }
    // A cone of 60° to level on its tip needs none for its side, but for its base when it lies.
    let mut cone = slicer(&solids::cone(5.0, 5.0 * 3f64.sqrt(), 16));
    assert_near(
        metrics(&mut cone, &options(), -DVec3::Z).overhang_mm2,
        0.0,
        1e-9,
    );
    assert_near(
        metrics(&mut cone, &options(), DVec3::Z).overhang_mm2,
        0.0,
        1e-9,
    );
    let mut flat = slicer(&solids::cone(8.0, 4.0, 16));
    assert!(metrics(&mut flat, &options(), -DVec3::Z).overhang_mm2 > 200.0);
}

/// The mean roughness of a surface by going over every facet, and along its height in small steps.
fn naive_roughness(corners: &[f32], z_mm: &[f64]) -> f64 {
    let (mut sum, mut surface) = (0.0, 0.0);
    for facet in corners.chunks_exact(9) {
        let corner = |i: usize| Vec3::from_slice(&facet[3 * i..]).as_dvec3();
        let [a, b, c] = [corner(0), corner(1), corner(2)];
        let normal = (b - a).cross(c - a);
        let area = normal.length() / 2.0;
        let sine = (1.0 - (normal.z / normal.length()).powi(2)).max(0.0).sqrt();
        let rough = if sine < 0.5 { 2.0 } else { 1.0 / sine };
        let (low, high) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
        let steps = 200;
        let thickness: f64 = (0..steps)
            .map(|step| {
                let z = low + (high - low) * (f64::from(step) + 0.5) / f64::from(steps);
                let above = z_mm.partition_point(|&plane| plane <= z);
                let above = above.clamp(1, z_mm.len() - 1);
                z_mm[above] - z_mm[above - 1]
            })
            .sum();
        sum += area * rough * thickness / f64::from(steps);
        surface += area;
    }
    sum / surface
}

#[test]
fn roughness_is_that_of_every_facet_in_its_layers() {
    let model = bean();
    let mut slicer = slicer(&model);
    for direction in [
        DVec3::Z,
        DVec3::X,
        DVec3::new(0.6, 0.0, -0.8),
        DVec3::ONE.normalize(),
    ] {
        let candidate = &measure(&mut slicer, &options(), &[direction.to_array()])[0];
        let rotation = Some(candidate.rotation);
        let there = Options {
            rotation,
            ..options()
        };
        let (preview, _) = slicer.preview(&there).unwrap();
        let pose = Pose {
            rotation,
            height_mm: None,
        };
        let corners = slicer.positions_on_plate(&pose).unwrap();
        let naive = naive_roughness(&corners, &preview.z_mm);
        let found = candidate.metrics.unwrap().roughness_mm;
        assert_near(found, naive, 0.01 * naive);
    }
}

#[test]
fn a_ball_is_the_same_from_everywhere() {
    let levels = 5;
    let found = orient(&solids::sphere(10.0, levels), &options(), &few(300));
    let layers: Vec<usize> = found
        .candidates
        .iter()
        .map(|candidate| candidate.metrics.unwrap().layers)
        .collect();
    let (least, most) = (layers.iter().min().unwrap(), layers.iter().max().unwrap());
    // Facets stand for the surface within their own angle, here up to 90° / 2^levels, and so do slopes and the layers
    // that these allow, which are about the height over the tolerance near the poles.
    let angle = 90f64.to_radians() / f64::from(1 << levels);
    let discretisation = 2.0 * 10.0 * angle / 0.065;
    assert!(
        ((most - least) as f64) < discretisation / 2.0,
        "{least} to {most}"
    );
    assert!((most - least) * 20 < *least, "{least} to {most}");
    assert!(found.candidates.iter().all(|it| it.excluded.is_none()));
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
    // For the fewest layers a rod lies, whichever way it is rolled.
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
    // The first look alone is as coarse as its spacing.
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
        // The valley is flat: energies in it differ by less than the finest step of layers.
        assert!(any.fold(f64::INFINITY, f64::min) < 3.0);
    }
}

#[test]
fn upside_down_a_model_has_as_many_layers() {
    let mut slicer = slicer(&bean());
    let directions = slicer.directions(&options(), 60).unwrap();
    for metric in [Metric::Cusp, Metric::Roughness, Metric::Area] {
        let options = Options {
            metric,
            tolerance: Some(if metric == Metric::Cusp { 0.065 } else { 0.2 }),
            snap: Snap::Off,
            ..options()
        };
        for &direction in &directions {
            let direction = DVec3::from_array(direction);
            let [up, down] =
                [direction, -direction].map(|direction| metrics(&mut slicer, &options, direction));
            // Bins are counted from the plate, so that the same surface lies otherwise in them.
            assert!(
                up.layers.abs_diff(down.layers) <= 2,
                "{metric:?} {direction}: {} and {}",
                up.layers,
                down.layers
            );
        }
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
    let mut slicer = slicer(&model);
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
    ] {
        let found = search(0.0, Cost::Layers, quality);
        assert!(of(&first(&found)) <= least(&found, of), "{quality:?}");
    }
    // Eq. 25, by hand.
    let found = search(0.3, Cost::Time, Quality::Overhang);
    let most = |of: fn(&Metrics) -> f64| rated(&found).map(|(_, it)| of(&it)).fold(0.0, f64::max);
    let (time, overhang) = (most(|it| it.print_time_s), most(|it| it.overhang_mm2));
    assert_eq!((found.scale.cost, found.scale.quality), (time, overhang));
    for (energy, metrics) in rated(&found) {
        let expected = 0.3 * metrics.print_time_s / time + 0.7 * metrics.overhang_mm2 / overhang;
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
    // The best are apart, and in order.
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
    // As long as the plate's diagonal allows, and longer than its sides.
    let plate = Options {
        pixels: Some([1430, 890]),
        pitch_mm: Some(0.1),
        ..options()
    };
    let mut rod = slicer(&solids::cuboid(Vec3::new(155.0, 4.0, 4.0)));
    let lying = &measure(&mut rod, &plate, &[DVec3::Z.to_array()])[0];
    assert_eq!(lying.excluded, None);
    assert!(lying.size_mm[0] <= 143.0 && lying.size_mm[1] <= 89.0);
    let there = Options {
        rotation: Some(lying.rotation),
        ..plate.clone()
    };
    let planned = pollster::block_on(rod.plan(&there, &mut quiet)).unwrap();
    assert_eq!(planned.layers, lying.metrics.unwrap().layers);

    let mut longer = slicer(&solids::cuboid(Vec3::new(175.0, 4.0, 4.0)));
    let found = measure(
        &mut longer,
        &plate,
        &[DVec3::Z, DVec3::X].map(|it| it.to_array()),
    );
    assert_eq!(found[0].excluded, Some(Exclusion::TooLarge));
    assert_eq!((found[0].metrics, found[0].energy), (None, None));
    assert_eq!(found[1].excluded, None);

    let printer = Options {
        printer: Some("saturn-3-ultra".to_owned()),
        ..Options::default()
    };
    // Too long for the plate, too long for the height, and too long for both together.
    let mut tower = slicer(&solids::cuboid(Vec3::new(400.0, 4.0, 4.0)));
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
    let mut slicer = slicer(&bean());
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
    for (search, code) in [(none, "bad-directions"), (beyond, "bad-alpha")] {
        let error = slicer.orient(&options(), &search, &mut quiet).unwrap_err();
        assert_eq!(error.code(), code);
    }
    let unknown = Options {
        printer: Some("none".to_owned()),
        ..options()
    };
    let error = slicer.orient(&unknown, &few(5), &mut quiet).unwrap_err();
    assert_eq!(error.code(), "unknown-printer");
}

fn parts(model: &solids::Triangles, count: usize) -> Vec<OrientationPart> {
    (1..=count)
        .map(|number| {
            let mut slicer = slicer(model);
            let shard = Shard { number, count };
            let part = slicer.measure_shard(&options(), &few(50), shard, &mut quiet);
            // As other machines send it.
            let json = serde_json::to_string(&part.unwrap()).unwrap();
            serde_json::from_str(&json).unwrap()
        })
        .collect()
}

fn merge(parts: &[OrientationPart], options: &Options) -> Result<OrientationReport, Error> {
    let mut slicer = slicer(&bean());
    let search = slicer.merge_shards(options, &few(50), parts)?;
    slicer.finish_search(options, search, &mut quiet)
}

fn merge_error(parts: &[OrientationPart], options: &Options) -> MergeError {
    match merge(parts, options) {
        Err(Error::Merge(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn shards_make_the_same_whole_in_any_order() {
    let whole = orient(&bean(), &options(), &few(50));
    for count in [1, 3, 100] {
        let mut parts = parts(&bean(), count);
        parts.reverse();
        // Parts of another model are left aside.
        parts.extend(self::parts(&solids::cube(3.0), 2));
        assert_eq!(merge(&parts, &options()).unwrap(), whole);
    }
}

#[test]
fn shards_that_do_not_make_a_whole_are_refused() {
    let all = parts(&bean(), 3);
    let missing = merge_error(&all[..2], &options());
    assert!(
        matches!(
            missing,
            MergeError::Gap {
                first: 2,
                missing: 18,
                total: 56
            }
        ),
        "{missing}"
    );
    let twice = [&all[..], &all[..1]].concat();
    let twice = merge_error(&twice, &options());
    assert!(
        matches!(twice, MergeError::Duplicate { place: 0, .. }),
        "{twice}"
    );
    // Parts of another division overlap.
    let mixed = [&all[..1], &parts(&bean(), 2)[..]].concat();
    let mixed = merge_error(&mixed, &options());
    assert!(matches!(mixed, MergeError::Duplicate { .. }), "{mixed}");
    let other = Options {
        tolerance: Some(0.1),
        ..options()
    };
    let other = merge_error(&all, &other);
    assert!(matches!(other, MergeError::OtherOptions { .. }), "{other}");
    let mut old = all.clone();
    old[1].version = "0.0.1".to_owned();
    let old = merge_error(&old, &options());
    assert!(matches!(old, MergeError::OtherVersion { .. }), "{old}");
    let mut damaged = all.clone();
    damaged[1].candidates.swap(0, 1);
    let damaged = merge_error(&damaged, &options());
    assert!(matches!(damaged, MergeError::Damaged { .. }), "{damaged}");
    let none = merge_error(&parts(&solids::cube(3.0), 1), &options());
    assert!(matches!(none, MergeError::None), "{none}");
}
