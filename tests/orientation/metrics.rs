//! The metrics of one orientation, against closed forms and naive oracles.

use crate::common::{assert_near, load, quiet, solids};
use cusp_slicer::job::{Options, Snap};
use cusp_slicer::model::Pose;
use cusp_slicer::prepare::{SupportProfile, SupportStrength, Supporting};
use cusp_slicer::profile::Metric;
use glam::{DQuat, DVec3, Vec3};

use super::{bean, few, measure, metrics, options, orient};

#[test]
fn candidates_are_what_a_preview_in_their_pose_shows() {
    let model = bean();
    let mut slicer = load(&model);
    let directions = slicer.directions(&options(), 12).unwrap();
    for metric in Metric::ALL {
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
    let mut slicer = load(&model);
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
    let mut tower = load(&solids::cuboid(Vec3::new(side, side, height)));
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
        // The base is an overhang, at less than 45° from level; then a side is.
        (30.0, side * side),
        (60.0, side * height),
    ] {
        let found = metrics(&mut tower, &options(), at(degrees));
        assert_near(found.overhang_mm2, expected, 1e-3);
    }
    // A cone whose side is at 60° to level needs no support, neither on its tip nor on its base.
    let mut cone = load(&solids::cone(5.0, 5.0 * 3f64.sqrt(), 16));
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
    let mut flat = load(&solids::cone(8.0, 4.0, 16));
    assert!(metrics(&mut flat, &options(), -DVec3::Z).overhang_mm2 > 200.0);
}

#[test]
fn supports_are_estimated_by_their_closed_form() {
    let [side, height] = [12.0, 6.0];
    let mut board = load(&solids::cuboid(Vec3::new(side, side, height)));
    let [side, height] = [f64::from(side), f64::from(height)];
    let circle = |diameter: f64| std::f64::consts::PI / 4.0 * diameter * diameter;
    for strength in [
        SupportStrength::Light,
        SupportStrength::Medium,
        SupportStrength::Heavy,
    ] {
        let options = Options {
            supports: Some(Supporting {
                strength,
                ..Supporting::default()
            }),
            ..options()
        };
        let profile = strength.profile();
        // On its base and on a side, which is as level.
        for (up, area) in [(DVec3::Z, side * side), (DVec3::X, side * height)] {
            let found = metrics(&mut board, &options, up);
            let contacts = 0.95 * area / profile.spacing_mm.powi(2) + 1.0;
            assert_near(
                found.contact_mm2,
                contacts * circle(profile.contact_mm),
                1e-3,
            );
            let pillar = 0.4 * circle(profile.pillar_mm) * profile.lift_mm;
            let foot = circle(profile.foot_mm) * profile.foot_thickness_mm;
            assert_near(found.support_ml, contacts * (foot + pillar) / 1e3, 1e-4);
        }
        // On its edge, its surfaces are too steep to need support: only its lowest line is held.
        let steep = metrics(&mut board, &options, DVec3::new(1.0, 0.0, 1.0).normalize());
        assert_near(steep.contact_mm2, circle(profile.contact_mm), 1e-9);
    }
    // Contacts count with the weight of the surface that they touch.
    let plain = metrics(&mut board, &options(), DVec3::Z);
    board.set_weights(Some(vec![0.25; 12])).unwrap();
    let light = metrics(&mut board, &options(), DVec3::Z);
    assert_near(light.contact_mm2, 0.25 * plain.contact_mm2, 1e-6);
    assert_near(light.support_ml, plain.support_ml, 1e-12);
}

#[test]
fn estimates_of_supports_order_directions_as_what_is_built_does() {
    // As large as scans are printed. Sharp edges take more contacts than is estimated.
    let bean = bean();
    let large: Vec<_> = bean
        .iter()
        .map(|it| it.map(|corner| 4.0 * corner))
        .collect();
    let mut model = load(&large);
    let options = Options {
        supports: Some(Supporting {
            // Estimates leave out contacts for the pull of the film alone.
            profile: Some(SupportProfile {
                film_kpa: Some(0.0),
                ..SupportProfile::default()
            }),
            ..Supporting::default()
        }),
        pitch_mm: Some(0.2),
        ..options()
    };
    let directions = model.directions(&options, 6).unwrap();
    let found = measure(&mut model, &options, &directions);
    let pairs: Vec<[f64; 2]> = found
        .iter()
        .map(|candidate| {
            let posed = Options {
                rotation: Some(candidate.rotation),
                ..options.clone()
            };
            let report = pollster::block_on(model.plan(&posed, &mut quiet)).unwrap();
            let built_ml = report.models[0].supported.as_ref().unwrap().support_ml;
            [candidate.metrics.unwrap().support_ml, built_ml]
        })
        .collect();
    let mut compared = 0;
    for [estimated, built] in &pairs {
        for [other, more] in &pairs {
            // Of two directions of which one takes 60 % more, the estimate says which.
            if *more > 1.6 * built {
                assert!(other > estimated, "{pairs:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 10, "{pairs:?}");
}

/// The mean roughness of a surface, facet by facet and in small steps along its height.
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
    let mut slicer = load(&model);
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
            ..Pose::default()
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
    // Facets approximate the slope of the surface to within their own angle, here up to 90° / 2^levels. The number of
    // layers, about the height over the tolerance near the poles, varies accordingly.
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
fn upside_down_a_model_has_as_many_layers() {
    let mut slicer = load(&bean());
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
            // Bins are counted from the plate, so the inverted surface lies in them differently.
            assert!(
                up.layers.abs_diff(down.layers) <= 2,
                "{metric:?} {direction}: {} and {}",
                up.layers,
                down.layers
            );
        }
    }
}
