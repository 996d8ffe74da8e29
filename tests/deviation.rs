//! The deviation: its definition against a naive oracle, its bound against distances that are measured, and normal cones against
//! closed forms.

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, bins, on_plate, quiet, solids};
use cusp_slicer::grid::Bins;
use cusp_slicer::job::{Backend, Options};
use cusp_slicer::plan::optimal::{Objective, fill_cheapest};
use cusp_slicer::plan::segment::Segment;
use cusp_slicer::plan::snap_cost::{SnapCosts, SnapPlanes};
use cusp_slicer::plan::{Limits, optimal};
use cusp_slicer::profile::deviation::DeviationError;
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::normal_cones::{cones, maxima};
use cusp_slicer::profile::{LayerErrors, Metric, Reach, Source, steepest};
use glam::{DVec2, Vec3};

fn errors(steepest: &[f32]) -> LayerErrors {
    LayerErrors::Deviation(DeviationError::new(steepest, bins(steepest.len())))
}

fn deviation(errors: &LayerErrors, lower: u32, upper: u32) -> f64 {
    errors.to_value(errors.steps_between(lower, upper))
}

/// The definition, written out: over every boundary below and above the middle.
fn naive(steepest: &[f32], lower: usize, upper: usize) -> f64 {
    let tangent = |bin: usize| match steepest.get(bin) {
        Some(&square) if square >= 1.0 => 1e9,
        Some(&square) if square > 0.0 => (f64::from(square) / (1.0 - f64::from(square))).sqrt(),
        _ => 0.0,
    };
    // The integral of tan θ between two heights in half bins.
    let between =
        |from: usize, to: usize| (from..to).map(|half| 0.5 * tangent(half / 2)).sum::<f64>();
    let middle = lower + upper;
    let down = (lower..=middle / 2)
        .map(|z| between(2 * z, middle).hypot((z - lower) as f64))
        .fold(f64::INFINITY, f64::min);
    let up = (middle.div_ceil(2)..=upper)
        .map(|z| between(middle, 2 * z).hypot((upper - z) as f64))
        .fold(f64::INFINITY, f64::min);
    down.max(up).min((upper - lower) as f64 / 2.0)
}

/// Random `n_z²`: gentle, steep, level, or without surface.
fn random_squares(random: &mut fastrand::Rng, count: usize) -> Vec<f32> {
    (0..count)
        .map(|_| match random.u32(0..8) {
            0 => 1.0,
            1 => 0.0,
            2 => -1.0,
            3 => 0.9 + 0.1 * random.f32(),
            _ => random.f32() * 0.6,
        })
        .collect()
}

#[test]
fn the_deviation_is_its_definition() {
    let mut random = fastrand::Rng::with_seed(71);
    for _ in 0..400 {
        let count = random.usize(1..=40);
        let squares = random_squares(&mut random, count);
        let errors = errors(&squares);
        for lower in 0..count as u32 {
            // Layers may end above the model.
            let mut layers = errors.layers_above(lower, u64::MAX - 1);
            for upper in lower + 1..=count as u32 + 3 {
                let expected = naive(&squares, lower as usize, upper as usize);
                let found = deviation(&errors, lower, upper);
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{found} {expected}: {lower} to {upper} of {squares:?}"
                );
                let Reach::Within(steps) = layers.up_to(upper) else {
                    panic!("{squares:?}: {lower} to {upper} is beyond any tolerance")
                };
                assert_eq!(steps, errors.steps_between(lower, upper), "{squares:?}");
            }
        }
    }
}

#[test]
fn a_search_ends_only_where_no_thicker_layer_is_within_tolerance() {
    let mut random = fastrand::Rng::with_seed(72);
    let mut ends = 0;
    for _ in 0..400 {
        let count = random.usize(1..=40);
        let squares = random_squares(&mut random, count);
        let errors = errors(&squares);
        let tolerance = errors.to_steps(random.f64() * 5.0);
        let lower = random.u32(0..count as u32);
        let mut layers = errors.layers_above(lower, tolerance);
        let mut has_ended = false;
        for upper in lower + 1..=count as u32 {
            let steps = errors.steps_between(lower, upper);
            match layers.up_to(upper) {
                Reach::Within(found) => {
                    assert!(!has_ended && found == steps && steps <= tolerance);
                }
                Reach::Beyond => assert!(steps > tolerance),
                Reach::BeyondFromHere => {
                    assert!(steps > tolerance);
                    has_ended = true;
                    ends += 1;
                }
            }
        }
    }
    assert!(ends > 1000, "{ends}");
}

#[test]
fn slopes_flats_and_walls_have_their_closed_forms() {
    // On an even slope it is t/2 · |n_z|.
    let slope = errors(&[0.36; 40]);
    for (lower, upper) in [(0, 10), (7, 20), (13, 14)] {
        let expected = 0.5 * f64::from(upper - lower) * 0.6;
        // The paths end at boundaries of bins, not between them.
        let found = deviation(&slope, lower, upper);
        assert!(
            (expected..expected + 0.1).contains(&(found + 1e-6)),
            "{found} {expected}"
        );
    }
    // Upright walls with a flat in bin 6: the way from the flat to the end of the layer beyond it, through the bin.
    let mut squares = [0.0; 20];
    squares[6] = 1.0;
    let flat = errors(&squares);
    for (lower, upper, expected) in [
        (0, 6, 0.0),
        (0, 7, 1.0),
        (0, 9, 3.0),
        (0, 20, 7.0),
        (7, 20, 0.0),
        (6, 20, 1.0),
        (4, 20, 3.0),
    ] {
        assert_near(deviation(&flat, lower, upper), expected, 1e-6);
    }
    // Never more than t/2.
    let level = errors(&[1.0; 20]);
    assert_near(deviation(&level, 3, 12), 4.5, 1e-6);
}

/// The distance from a point to a polyline.
fn to_polyline(point: DVec2, line: &[DVec2]) -> f64 {
    let distances = line.windows(2).map(|part| {
        let along = part[1] - part[0];
        let place = (point - part[0]).dot(along) / along.length_squared();
        point.distance(part[0] + along * place.clamp(0.0, 1.0))
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// No point of a stack is farther from the outline that it was cut from than the largest deviation of the two adjacent
/// layers. The outline goes up one bin after another, with a slope for each and level steps between.
#[test]
fn no_point_of_a_stack_is_farther_from_its_outline_than_the_deviation_says() {
    let mut random = fastrand::Rng::with_seed(73);
    let (mut closest, mut compared) = (f64::INFINITY, 0);
    for round in 0..3000 {
        let count = random.usize(4..=30);
        let is_smooth = round % 3 == 0;
        let (mut x, mut slope) = (0.0, random.f64() * 2.0 - 1.0);
        let mut outline = vec![DVec2::ZERO];
        let mut squares = vec![0f32; count];
        let mut x_at = vec![0.0];
        for (bin, square) in squares.iter_mut().enumerate() {
            slope = if is_smooth {
                (slope + (random.f64() - 0.5) * 0.4).clamp(-3.0, 3.0)
            } else {
                (random.f64() - 0.5) * [0.2, 2.0, 8.0][random.usize(0..3)]
            };
            if !is_smooth && random.u32(0..10) == 0 {
                x += (random.f64() - 0.5) * 8.0;
                outline.push(DVec2::new(x, bin as f64));
                *square = 1.0;
            }
            // Rounded up, as any bound is.
            let sine_square = slope * slope / (1.0 + slope * slope);
            *square = square.max((sine_square as f32).next_up());
            x_at.push(x + 0.5 * slope);
            x += slope;
            outline.push(DVec2::new(x, bin as f64 + 1.0));
            x_at.push(x);
        }
        let errors = errors(&squares);
        let mut planes = vec![0u32];
        while *planes.last().unwrap() < count as u32 {
            let next = planes.last().unwrap() + random.u32(1..=8);
            planes.push(next.min(count as u32));
        }
        let layers: Vec<(u32, u32, f64, f64)> = planes
            .windows(2)
            .map(|ends| {
                // Steps lie at the lower end of a bin: a middle at a boundary may be on either side of one, and is above it here.
                let middle = (ends[0] + ends[1]) as usize;
                (
                    ends[0],
                    ends[1],
                    x_at[middle],
                    deviation(&errors, ends[0], ends[1]),
                )
            })
            .collect();
        for &(lower, upper, wall, bound) in &layers {
            for end in [lower, upper] {
                let found = to_polyline(DVec2::new(wall, f64::from(end)), &outline);
                assert!(
                    found <= bound + 1e-5,
                    "{found} {bound}: {lower} to {upper} of {squares:?} {outline:?}"
                );
                if bound > 0.1 && found > 0.0 {
                    closest = closest.min(bound / found);
                    compared += 1;
                }
            }
        }
        for pair in layers.windows(2) {
            let plane = f64::from(pair[0].1);
            for part in 0..=20 {
                let x = pair[0].2 + (pair[1].2 - pair[0].2) * f64::from(part) / 20.0;
                let found = to_polyline(DVec2::new(x, plane), &outline);
                let bound = pair[0].3.max(pair[1].3);
                assert!(found <= bound + 1e-5, "{found} {bound} at {plane}");
            }
        }
    }
    assert!(
        compared > 10_000 && closest < 1.0 + 1e-4,
        "{compared} {closest}"
    );
}

/// The largest |`n_z`| over the normal cones in each of `count` bins.
fn cone_values(triangles: &[[Vec3; 3]], count: usize) -> Vec<f64> {
    let mesh = on_plate(triangles);
    let bins = Bins::of_height(
        mesh.bounds().size().z,
        mesh.bounds().size().z / count as f64,
    );
    let bins = bins.unwrap();
    let steepest = steepest::exact(&FacetBins::of(&mesh, bins), &[]);
    let squares = maxima(&steepest, &cones(&mesh, bins), |_| true);
    squares
        .iter()
        .map(|&square| f64::from(square).sqrt())
        .collect()
}

#[test]
fn a_ridge_is_as_level_as_its_edge() {
    // A gable roof of 45° over a wall: level at the ridge alone.
    let roof = solids::profiled(
        &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 4.0], [0.0, 2.0]],
        10.0,
    );
    let values = cone_values(&roof, 40);
    assert!(
        values[1..19].iter().all(|&value| value == 0.0),
        "{values:?}"
    );
    for &value in &values[21..39] {
        assert_near(value, 0.5f64.sqrt(), 1e-6);
    }
    assert_eq!((values[0], values[39]), (1.0, 1.0));

    // Tilted about x, the ridge itself slopes: 1 − e_z² with e along it.
    let (sin, cos) = (0.6, 0.8);
    let tilted: solids::Triangles = roof
        .iter()
        .map(|corners| {
            corners.map(|it| Vec3::new(it.x, it.y * cos - it.z * sin, it.y * sin + it.z * cos))
        })
        .collect();
    let mesh = on_plate(&tilted);
    let bins = Bins::of_height(mesh.bounds().size().z, 0.1).unwrap();
    let ridge = cones(&mesh, bins)
        .into_iter()
        .filter(|cone| cone.span[1] - cone.span[0] > 50)
        .map(|cone| f64::from(cone.n_z_squared))
        .fold(0.0, f64::max);
    assert_near(ridge, 1.0 - f64::from(sin * sin), 1e-6);
}

#[test]
fn peaks_pits_and_saddles_are_level_and_other_vertices_are_not() {
    // A needle: steep, and level only at its tip and its base.
    let needle = solids::cone(0.5, 20.0, 16);
    let values = cone_values(&needle, 100);
    assert_eq!((values[0], values[99]), (1.0, 1.0));
    for &value in &values[2..99] {
        assert!(value < 0.03, "{value}");
    }
    // A cylinder between its ends has no vertex and no slope.
    let cylinder = cone_values(&solids::cylinder(4.0, 10.0, 16), 100);
    assert!(cylinder[1..99].iter().all(|&value| value == 0.0));
    // A torus standing on its rim, with a saddle at the bottom and at the top of its hole.
    let values = cone_values(&standing_torus(3.0, 1.0, 24), 80);
    for (bin, &value) in values.iter().enumerate() {
        let is_saddle = bin.abs_diff(20) <= 1 || bin.abs_diff(59) <= 1;
        let is_end = bin <= 1 || bin >= 78;
        assert!((value == 1.0) <= (is_saddle || is_end), "{bin}: {value}");
    }
    assert!(values[19..=20].contains(&1.0) && values[59..=60].contains(&1.0));
}

/// A torus around the y axis, turned so that single vertices are lowest and highest.
fn standing_torus(ring: f64, tube: f64, parts: usize) -> solids::Triangles {
    let turn = std::f64::consts::TAU / parts as f64;
    let point = |u: usize, v: usize| {
        let (u, v) = (u as f64 * turn, v as f64 * turn);
        let out = ring + tube * v.cos();
        Vec3::new(
            (out * u.sin()) as f32,
            (tube * v.sin()) as f32,
            (out * u.cos()) as f32,
        )
    };
    let quads = (0..parts).flat_map(|u| (0..parts).map(move |v| (u, v)));
    quads
        .flat_map(|(u, v)| {
            let (next_u, next_v) = ((u + 1) % parts, (v + 1) % parts);
            let [a, b] = [point(u, v), point(next_u, v)];
            let [c, d] = [point(next_u, next_v), point(u, next_v)];
            [[a, c, b], [a, d, c]]
        })
        .collect()
}

/// Folds are no ridges: where a wall leans out and then in, the height passes straight through.
#[test]
fn rims_and_creases_that_paths_cross_do_not_count() {
    // An octagon's outline: walls lean by 45° out, then in.
    let rim = solids::profiled(
        &[
            [1.0, 0.0],
            [3.0, 0.0],
            [4.0, 1.0],
            [3.0, 2.0],
            [1.0, 2.0],
            [0.0, 1.0],
        ],
        8.0,
    );
    let values = cone_values(&rim, 40);
    for &value in &values[1..39] {
        assert_near(value, 0.5f64.sqrt(), 1e-6);
    }
}

#[test]
fn the_planner_finds_the_fewest_layers_though_thicker_ones_may_be_nearer() {
    let mut random = fastrand::Rng::with_seed(74);
    let (mut plans, mut returns) = (0, 0);
    for _ in 0..2000 {
        let count = random.usize(2..=13);
        let squares = random_squares(&mut random, count);
        let errors = errors(&squares);
        let least = random.usize(1..=3);
        let greatest = least + random.usize(0..=5);
        let tolerance = random.f64() * 3.0;
        let steps = errors.to_steps(tolerance);
        let rules = crate::common::oracle::Rules::plain(count, (least, greatest));
        let between = |lower: usize, upper: usize| errors.steps_between(lower as u32, upper as u32);
        let expected = crate::common::oracle::best_plan(count, &rules, steps, between, |_, _| 1);
        let segment = Segment {
            lower: 0,
            units: count as u32,
            unit: 1,
            thickness: least as u32..=greatest as u32,
        };
        let table = fill_cheapest(&errors, &segment, &SnapCosts::default(), steps, |_| 1);
        let found =
            (table.cost[count] != u64::MAX).then(|| (table.cost[count], table.worst[count]));
        assert_eq!(
            found, expected,
            "{squares:?} {least} {greatest} {tolerance}"
        );
        let limits = Limits {
            layer_min_mm: least as f64,
            layer_max_mm: greatest as f64,
            tolerance,
            ..Limits::default()
        };
        if let Some((layers, _)) = expected {
            let plan =
                optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers).unwrap();
            assert_eq!(plan.layers() as u64, layers);
            plans += 1;
        }
        returns += (0..count)
            .filter(|&lower| {
                let thicker = (lower + 1..count).map(|upper| between(lower, upper));
                thicker.is_sorted_by(|a, b| a <= b).then_some(()).is_none()
            })
            .count();
    }
    assert!(plans > 500 && returns > 0, "{plans} {returns}");
}

/// The largest |`n_z`| over the normal cones of the bins of a sliced model, which are 2 µm high.
fn sliced_values(triangles: &[[Vec3; 3]]) -> Vec<f32> {
    let options = Options {
        metric: Metric::Deviation,
        tolerance: Some(0.1),
        rays: 256,
        backend: Backend::Cpu,
        ..Options::default()
    };
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    let profile = slicer.profile(Metric::Deviation, Source::Exact);
    profile.unwrap().density
}

#[test]
fn a_valley_between_crossing_bodies_is_as_level_as_its_crease() {
    let values = sliced_values(&solids::crossing_roofs());
    // The normals (1, 0, 1) and (0, 3.9, 4) have the cross product (−3.9, −4, 3.9).
    let (level, along_z) = (3.9 * 3.9 + 4.0 * 4.0, 3.9 * 3.9);
    let expected: f64 = level / (level + along_z);
    for z_mm in [0.5, 1.0, 2.0, 3.0, 3.8] {
        let value = values[(z_mm / 0.002) as usize];
        assert_near(f64::from(value), expected.sqrt(), 1e-6);
    }
    // A roof alone is as steep as its facets there.
    let roof = solids::profiled(&[[-4.0, 0.0], [4.0, 0.0], [0.0, 4.0]], 16.0);
    let alone = sliced_values(&roof);
    assert_near(f64::from(alone[1000]), 0.5f64.sqrt(), 1e-6);
}

#[test]
fn a_crease_is_level_where_it_turns() {
    // Two cones that overlap: the crease between them is highest half-way, 3 mm from both axes.
    let mut cones = solids::cone(5.0, 10.0, 64);
    let other = solids::cone(5.0, 10.0, 50);
    cones.extend(solids::moved(&other, Vec3::new(6.0, 0.0, 0.0)));
    let values = sliced_values(&cones);
    let highest = values[1000..4800].iter().rposition(|&value| value == 1.0);
    let z_mm = (1000 + highest.unwrap()) as f64 * 0.002;
    assert_near(z_mm, 4.0, 0.05);
}
