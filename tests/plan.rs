//! Planners: the paper's example and its procedure, brute force over all sets of planes for every metric, constraint
//! and objective, planted optima, typed failures.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use common::{assert_near, oracle, oracle::Rules};
use cusp_slicer::grid::Bins;
use cusp_slicer::plan::greedy::Sight;
use cusp_slicer::plan::optimal::{Objective, Table, fill_cheapest, fill_fewest};
use cusp_slicer::plan::segment::{Segment, Segments};
use cusp_slicer::plan::tradeoff::{Goal, curve, tolerance_for};
use cusp_slicer::plan::{HeightRange, Limits, Plan, PlanError, greedy, optimal, uniform};
use cusp_slicer::profile::volume::VolumeError;
use cusp_slicer::profile::{ErrorSum, LayerErrors, Profile};
use cusp_slicer::resin::Resin;

/// Bins of 1 mm.
fn bins(count: usize) -> Bins {
    Bins {
        count,
        size_mm: 1.0,
    }
}

fn error_sum(density: &[f32]) -> ErrorSum {
    Profile {
        bins: bins(density.len()),
        density: density.to_vec(),
    }
    .error_sum()
}

fn sum(density: &[f32]) -> LayerErrors {
    LayerErrors::Sum(error_sum(density))
}

fn volume(areas_mm2: &[f64]) -> LayerErrors {
    LayerErrors::Volume(VolumeError::new(areas_mm2, bins(areas_mm2.len())))
}

fn limits(layer_min_mm: f64, layer_max_mm: f64, tolerance: f64) -> Limits {
    Limits {
        layer_min_mm,
        layer_max_mm,
        tolerance,
        ..Limits::default()
    }
}

/// A resin without bottom layers, and with `overhead_s` between layers.
fn resin(layer_mm: f64, exposure_s: f64, penetration_mm: f64, overhead_s: f64) -> Resin {
    Resin {
        layer_mm,
        exposure_s,
        penetration_mm,
        wait_s: overhead_s,
        lift_mm: 0.0,
        bottom_layers: 0,
        ..Resin::default()
    }
}

fn segment(units: usize, thickness: (u32, u32)) -> Segment {
    Segment {
        lower: 0,
        units: units as u32,
        unit: 1,
        thickness: thickness.0..=thickness.1,
    }
}

fn plan(density: &[f32], limits: &Limits) -> Result<Plan, PlanError> {
    optimal::plan(&sum(density), limits, &[], Objective::Layers)
}

const FIGURE_3: [f32; 8] = [0.2, 0.2, 0.2, 0.3, 0.4, 0.1, 0.2, 0.2];

#[test]
fn figure_3_has_its_k_d_and_s() {
    let errors = sum(&FIGURE_3);
    let table = fill_fewest(
        &error_sum(&FIGURE_3),
        &segment(8, (2, 3)),
        errors.to_steps(0.6),
    );
    let none = Table::NO_PLAN;
    assert_eq!(table.cost, [0, none, 1, 1, 2, none, 3, none, 4]);
    assert_eq!(table.below, [0, 0, 0, 0, 2, 0, 4, 0, 6]);
    let plan = plan(&FIGURE_3, &limits(2.0, 3.0, 0.6)).unwrap();
    assert_eq!(plan.boundaries, [0, 2, 4, 6, 8]);
    assert_eq!(plan.z_mm(), [0.0, 2.0, 4.0, 6.0, 8.0]);
    assert_eq!(plan.thickness_mm(), [2.0; 4]);
    assert_eq!(plan.middle_mm(), [1.0, 3.0, 5.0, 7.0]);
    assert_near(plan.max_error(&errors), 0.5, 1e-6);
}

/// Tenths, so that sums often hit the tolerance exactly.
fn random_tenths(random: &mut fastrand::Rng, count: usize) -> Vec<u64> {
    let is_flat = random.bool();
    (0..count)
        .map(|_| {
            if is_flat && random.bool() {
                0
            } else {
                random.u64(0..=10)
            }
        })
        .collect()
}

fn in_tenths(tenths: &[u64]) -> Vec<f32> {
    tenths.iter().map(|&tenths| tenths as f32 / 10.0).collect()
}

#[test]
fn the_linear_planner_has_the_k_of_procedure_1_written_literally() {
    let mut random = fastrand::Rng::with_seed(41);
    for _ in 0..3000 {
        let count = random.usize(1..=80);
        let tenths = random_tenths(&mut random, count);
        let least = random.usize(1..=6);
        let greatest = least + random.usize(0..=20);
        let tolerance = random.u64(0..=60);
        let errors = error_sum(&in_tenths(&tenths));
        let steps = LayerErrors::Sum(errors.clone()).to_steps(tolerance as f64 / 10.0);
        let segment = segment(count, (least as u32, greatest as u32));
        let table = fill_fewest(&errors, &segment, steps);
        let (k, _) = oracle::procedure_1(&tenths, (least, greatest), tolerance);
        assert_eq!(table.cost, k, "{tenths:?} {least} {greatest} {tolerance}");
    }
}

#[test]
fn the_linear_planner_has_the_least_largest_error_of_all_plans_as_short() {
    let mut random = fastrand::Rng::with_seed(43);
    for round in 0..3000 {
        let count = random.usize(1..=120);
        let density = if round % 2 == 0 {
            in_tenths(&random_tenths(&mut random, count))
        } else {
            (0..count).map(|_| random.f32()).collect()
        };
        let least = random.u32(1..=6);
        let segment = segment(count, (least, least + random.u32(0..=20)));
        let errors = error_sum(&density);
        let all = LayerErrors::Sum(errors.clone());
        let tolerance = all.to_steps(random.f64() * 8.0);
        let found = fill_fewest(&errors, &segment, tolerance);
        let expected = fill_cheapest(&all, &segment, tolerance, |_| 1);
        assert_eq!(
            found.cost, expected.cost,
            "{density:?} {segment:?} {tolerance}"
        );
        for plane in 0..=count {
            if found.cost[plane] != Table::NO_PLAN {
                assert_eq!(
                    found.worst[plane], expected.worst[plane],
                    "plane {plane}: {density:?} {segment:?} {tolerance}"
                );
            }
        }
    }
}

/// Every metric's errors of a random model.
fn random_errors(random: &mut fastrand::Rng, count: usize) -> (LayerErrors, String) {
    if random.bool() {
        let tenths = random_tenths(random, count);
        (sum(&in_tenths(&tenths)), format!("{tenths:?}"))
    } else {
        let areas: Vec<f64> = (0..count).map(|_| f64::from(random.u32(0..=9))).collect();
        (volume(&areas), format!("{areas:?}"))
    }
}

#[test]
fn no_set_of_planes_is_better() {
    let resin = resin(1.0, 1.0, 2.0, 3.0);
    let mut random = fastrand::Rng::with_seed(3);
    let (mut feasible, mut infeasible) = (0, 0);
    for _ in 0..6000 {
        let count = random.usize(1..=12);
        let (errors, text) = random_errors(&mut random, count);
        let least = random.usize(1..=3);
        let greatest = least + random.usize(0..=3);
        let tolerance = f64::from(random.u32(1..=30)) / 10.0;
        let mut limits = limits(least as f64, greatest as f64, tolerance);
        let mut rules = Rules::plain(count, (least, greatest));
        if random.u8(0..4) == 0 && count.is_multiple_of(2) {
            limits.step_mm = Some(2.0);
            rules.step = 2;
        }
        if random.u8(0..4) == 0 && count > 2 {
            let plane = random.usize(1..count) / rules.step * rules.step;
            if plane > 0 {
                limits.planes_mm = vec![plane as f64];
                rules.planes = vec![plane];
            }
        }
        if random.u8(0..4) == 0 && count > 4 {
            let (from, to) = (2, 4);
            let (least, greatest) = (random.usize(1..=2), random.usize(2..=3));
            limits.ranges = vec![HeightRange {
                from_mm: from as f64,
                to_mm: to as f64,
                layer_min_mm: least as f64,
                layer_max_mm: greatest as f64,
            }];
            rules.planes.extend([from, to]);
            rules.thickness[from..to].fill((least, greatest));
        }
        let is_time = random.bool();
        let objective = if is_time {
            Objective::Time(&resin)
        } else {
            Objective::Layers
        };
        let expected = oracle::best_plan(
            count,
            &rules,
            errors.to_steps(tolerance),
            |lower, upper| errors.steps_between(lower as u32, upper as u32),
            |thickness| {
                if is_time {
                    resin.layer_us(thickness as f64)
                } else {
                    1
                }
            },
        );
        let found = optimal::plan(&errors, &limits, &[], objective);
        match (&found, expected) {
            (Ok(plan), Some((cost, worst))) => {
                feasible += 1;
                let found_cost = match objective {
                    Objective::Layers => plan.layers() as u64,
                    Objective::Time(resin) => (plan.print_time_s(resin) * 1e6).round() as u64,
                };
                assert_eq!(
                    (found_cost, plan.max_error_steps(&errors)),
                    (cost, worst),
                    "{text} {limits:?} {plan:?}"
                );
            }
            // Where no layers add up to the top, the top is moved: the oracle does not know that.
            (Ok(plan), None) => assert_ne!(
                plan.boundaries[plan.layers()] as usize,
                count,
                "{text} {limits:?} {plan:?}"
            ),
            (Err(_), None) => infeasible += 1,
            (Err(error), Some(_)) => panic!("{text} {limits:?}: {error:?}"),
        }
    }
    assert!(
        feasible > 2000 && infeasible > 500,
        "{feasible} feasible, {infeasible} not"
    );
}

#[test]
fn the_volume_of_a_layer_is_measured_from_its_lowest_bin() {
    // Literally eq. 20, for every pair of planes.
    let areas = [4.0, 4.5, 3.0, 0.0, 7.0, 7.0];
    let errors = volume(&areas);
    for l in 0..areas.len() {
        for i in l..=areas.len() {
            let expected: f64 = (l + 1..=i).map(|j| (areas[j - 1] - areas[l]).abs()).sum();
            let steps = errors.steps_between(l as u32, i as u32);
            assert_near(errors.to_value(steps), expected, 1e-9);
        }
    }
}

#[test]
fn a_planted_plan_is_found_again() {
    // Each layer's bins add up to just the tolerance, so that no plane can move.
    let mut random = fastrand::Rng::with_seed(11);
    let mut density = Vec::new();
    let mut planted = vec![0u32];
    for _ in 0..200 {
        let bins = [5, 8, 10][random.usize(0..3)];
        density.extend((0..bins).map(|_| 1.0 / bins as f32));
        planted.push(planted.last().unwrap() + bins);
    }
    let plan = plan(&density, &limits(4.0, 15.0, 1.0)).unwrap();
    assert_eq!(plan.boundaries, planted);
}

#[test]
fn of_plans_as_short_the_one_with_the_least_error_is_taken() {
    // Two layers are needed; procedure 1 puts the plane at 2, where the upper layer has error 6.
    let plan = plan(&[1.0; 8], &limits(1.0, 6.0, 6.0)).unwrap();
    assert_eq!(plan.boundaries, [0, 4, 8]);
}

#[test]
fn an_infeasible_profile_names_the_heights_and_what_would_do() {
    let mut density = [0.1; 30];
    density[17..20].fill(1.0);
    let limits = limits(2.0, 5.0, 0.8);
    let Err(PlanError::Infeasible {
        from_mm,
        to_mm,
        least_tolerance: Some(least_tolerance),
        largest_layer_min_mm: None,
        ..
    }) = plan(&density, &limits)
    else {
        panic!("{:?}", plan(&density, &limits));
    };
    assert_eq!((from_mm, to_mm), (17.0, 19.0));
    // Of three bins in a row, two are in one layer of two.
    assert_near(least_tolerance, 2.0, 0.0);
    let with = |tolerance| Limits {
        tolerance,
        ..limits.clone()
    };
    assert!(plan(&density, &with(least_tolerance)).is_ok());
    assert!(plan(&density, &with(least_tolerance - 1e-5)).is_err());
}

#[test]
fn what_an_infeasible_plan_is_offered_is_the_least_change() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut offered = [0, 0];
    for _ in 0..400 {
        let count = random.usize(20..=60);
        let (errors, text) = random_errors(&mut random, count);
        let limits = limits(f64::from(random.u32(2..=5)), 9.0, random.f64() * 3.0 + 0.2);
        let holds =
            |limits: &Limits| optimal::plan(&errors, limits, &[], Objective::Layers).is_ok();
        let Err(PlanError::Infeasible {
            least_tolerance,
            largest_layer_min_mm,
            ..
        }) = optimal::plan(&errors, &limits, &[], Objective::Layers)
        else {
            continue;
        };
        let tolerance = least_tolerance.unwrap();
        offered[0] += 1;
        assert!(
            holds(&Limits {
                tolerance,
                ..limits.clone()
            }),
            "{text} {limits:?} {tolerance}"
        );
        let less = tolerance * (1.0 - 2e-5) - 1e-6;
        assert!(
            !holds(&Limits {
                tolerance: less,
                ..limits.clone()
            }),
            "{text} {limits:?} {tolerance}"
        );
        let Some(layer_min_mm) = largest_layer_min_mm else {
            assert!(
                !holds(&Limits {
                    layer_min_mm: 1.0,
                    ..limits.clone()
                }),
                "{text} {limits:?}"
            );
            continue;
        };
        offered[1] += 1;
        assert!(layer_min_mm < limits.layer_min_mm);
        assert!(
            holds(&Limits {
                layer_min_mm,
                ..limits.clone()
            }),
            "{text} {limits:?} {layer_min_mm}"
        );
        let more = layer_min_mm + 1.0;
        assert!(
            !holds(&Limits {
                layer_min_mm: more,
                ..limits.clone()
            }),
            "{text} {limits:?} {layer_min_mm}"
        );
    }
    assert!(offered[0] > 100 && offered[1] > 20, "{offered:?}");
}

#[test]
fn planes_and_ranges_are_kept() {
    let limits = Limits {
        ranges: vec![
            HeightRange {
                from_mm: 0.0,
                to_mm: 12.0,
                layer_min_mm: 4.0,
                layer_max_mm: 4.0,
            },
            HeightRange {
                from_mm: 40.0,
                to_mm: 99.0,
                layer_min_mm: 1.0,
                layer_max_mm: 2.0,
            },
        ],
        planes_mm: vec![21.0, 33.3],
        ..limits(2.0, 8.0, 100.0)
    };
    let plan = plan(&[0.5; 50], &limits).unwrap();
    assert_eq!(plan.boundaries[..4], [0, 4, 8, 12]);
    for plane in [21, 33, 40, 50] {
        assert!(plan.boundaries.contains(&plane), "{plane}: {plan:?}");
    }
    let layers = plan.boundaries.windows(2);
    let mut above_40 = layers.filter(|layer| layer[0] >= 40);
    assert!(above_40.all(|layer| layer[1] - layer[0] <= 2));
}

#[test]
fn heights_are_multiples_of_the_motor_step() {
    // 11 bins of 0.004 mm are 0.044 mm: no whole number of steps of 0.01 mm.
    let density = vec![0.3f32; 1111];
    let profile = Profile {
        bins: Bins::of_height(4.444, 0.004).unwrap(),
        density,
    };
    let errors = LayerErrors::Sum(profile.error_sum());
    let limits = Limits {
        step_mm: Some(0.02),
        planes_mm: vec![1.234],
        ..limits(0.05, 0.15, 0.04)
    };
    let plan = optimal::plan(&errors, &limits, &[600], Objective::Layers).unwrap();
    assert!(plan.boundaries.iter().all(|boundary| boundary % 5 == 0));
    assert!(
        plan.boundaries.contains(&310),
        "1.24 mm is nearest to the plane asked for"
    );
    assert_eq!(plan.snap_planes, [600]);
    assert_eq!(plan.z_mm().last(), Some(&4.44));
    let uneven = Limits {
        step_mm: Some(0.01),
        ..limits
    };
    let result = optimal::plan(&errors, &uneven, &[], Objective::Layers);
    assert!(
        matches!(result, Err(PlanError::NotWholeBins { .. })),
        "{result:?}"
    );
}

#[test]
fn wishes_are_granted_in_order_and_give_way() {
    let plain = limits(3.0, 6.0, 100.0);
    let segments = Segments::new(bins(30), &plain, &[10, 12, 25, 2, 29]).unwrap();
    // 12 is too near to 10, 2 to the plate and 29 to the top.
    assert_eq!(segments.snap_planes, [10, 25]);
    assert_eq!(segments.segments.len(), 3);

    // The layers from 0 to 10 would be 3 to 4 bins: too much where the profile is 1.
    let mut density = [0.1; 30];
    density[..10].fill(1.0);
    let tight = limits(3.0, 6.0, 3.0);
    assert!(optimal::plan(&sum(&density), &tight, &[], Objective::Layers).is_ok());
    let plan = optimal::plan(&sum(&density), &tight, &[10, 20], Objective::Layers).unwrap();
    assert_eq!(plan.snap_planes, [20]);
}

#[test]
fn a_top_that_layers_do_not_add_up_to_is_moved_by_at_most_half_a_layer() {
    for (height, expected) in [(11, 10), (12, 10), (13, 15), (14, 15), (15, 15), (3, 5)] {
        let plan = plan(&vec![0.1; height], &limits(5.0, 5.0, 1.0)).unwrap();
        assert_eq!(plan.boundaries[plan.layers()], expected, "{height}");
    }
    let result = plan(&[0.1; 2], &limits(5.0, 5.0, 1.0));
    assert!(
        matches!(result, Err(PlanError::LayersDoNotFit { .. })),
        "{result:?}"
    );
}

#[test]
fn planes_between_which_no_layers_fit_are_told() {
    let crowded = Limits {
        planes_mm: vec![10.0, 12.0],
        ..limits(3.0, 6.0, 100.0)
    };
    let result = plan(&[0.1; 30], &crowded);
    let Err(PlanError::LayersDoNotFit { from_mm, to_mm, .. }) = result else {
        panic!("{result:?}");
    };
    assert_eq!((from_mm, to_mm), (10.0, 12.0));
    for z_mm in [-1.0, 0.2, 31.0, f64::NAN] {
        let outside = Limits {
            planes_mm: vec![z_mm],
            ..limits(3.0, 6.0, 100.0)
        };
        let result = plan(&[0.1; 30], &outside);
        assert!(
            matches!(result, Err(PlanError::BadPlane { .. })),
            "{z_mm}: {result:?}"
        );
    }
    let range = |from_mm, to_mm| HeightRange {
        from_mm,
        to_mm,
        layer_min_mm: 3.0,
        layer_max_mm: 6.0,
    };
    for ranges in [
        vec![range(5.0, 5.0)],
        vec![range(9.0, 5.0)],
        vec![range(0.0, 10.0), range(9.0, 20.0)],
        vec![range(-3.0, 6.0)],
        vec![range(f64::NAN, 6.0)],
    ] {
        let wrong = Limits {
            ranges: ranges.clone(),
            ..limits(3.0, 6.0, 100.0)
        };
        let result = plan(&[0.1; 30], &wrong);
        assert!(
            matches!(result, Err(PlanError::BadRange { .. })),
            "{ranges:?}: {result:?}"
        );
    }
}

#[test]
fn a_tolerance_that_fails_near_the_top_is_infeasible() {
    let mut density = [0.1; 30];
    density[29] = 1.0;
    let result = plan(&density, &limits(2.0, 5.0, 0.8));
    assert!(
        matches!(result, Err(PlanError::Infeasible { .. })),
        "{result:?}"
    );
}

#[test]
fn limits_far_beyond_the_model_are_no_trouble() {
    let wide = limits(1.0, 1e12, 1e12);
    assert_eq!(plan(&[0.1; 10], &wide).unwrap().boundaries, [0, 10]);
    let thick = plan(&[0.1; 10], &limits(1e9, 1e12, 1e12));
    assert!(
        matches!(thick, Err(PlanError::LayersDoNotFit { .. })),
        "{thick:?}"
    );
    let too_thick = uniform::plan(bins(10), 10.0, 1e9);
    assert!(
        matches!(too_thick, Err(PlanError::LayerTooThick { .. })),
        "{too_thick:?}"
    );
}

#[test]
fn a_million_bins_and_thicknesses_of_any_number_of_them_take_one_pass() {
    // Procedure 1 written literally would look at 10^12 pairs of planes.
    let density = vec![1e-4; 1_000_000];
    let plan = plan(&density, &limits(1.0, 1e6, 10.0)).unwrap();
    assert_eq!(plan.layers(), 10);
}

#[test]
fn limits_are_checked() {
    let density = [0.1; 10];
    for wrong in [
        limits(0.0, 5.0, 1.0),
        limits(1.0, f64::NAN, 1.0),
        limits(1.0, 5.0, -1.0),
    ] {
        let result = plan(&density, &wrong);
        assert!(
            matches!(result, Err(PlanError::Grid(_))),
            "{wrong:?}: {result:?}"
        );
    }
    for empty in [limits(5.0, 4.0, 1.0), limits(1.2, 1.8, 1.0)] {
        let result = plan(&density, &empty);
        assert!(
            matches!(result, Err(PlanError::EmptyRange { .. })),
            "{empty:?}: {result:?}"
        );
    }
}

#[test]
fn greedy_planners_fill_every_segment_and_may_exceed_the_tolerance() {
    // The text of section 3.3: three bins first, and then 0.7 cannot be avoided.
    let errors = sum(&FIGURE_3);
    let greedy = greedy::plan(&errors, &limits(2.0, 3.0, 0.6), &[], Sight::Profile).unwrap();
    assert_eq!(greedy.boundaries[..3], [0, 3, 5]);
    assert_near(greedy.max_error(&errors), 0.7, 1e-6);

    let mut random = fastrand::Rng::with_seed(17);
    for _ in 0..500 {
        let count = random.usize(10..=80);
        let (errors, text) = random_errors(&mut random, count);
        let limits = limits(3.0, 5.0, random.f64() * 4.0 + 0.1);
        let best = optimal::plan(&errors, &limits, &[], Objective::Layers);
        for sight in [Sight::Profile, Sight::Plane] {
            let plan = greedy::plan(&errors, &limits, &[40], sight).unwrap();
            let mut layers = plan.boundaries.windows(2);
            assert!(
                layers.all(|layer| (3..=5).contains(&(layer[1] - layer[0]))),
                "{text} {plan:?}"
            );
            assert_eq!(plan.boundaries[plan.layers()], count as u32);
            let is_within = plan.max_error_steps(&errors) <= errors.to_steps(limits.tolerance);
            if let (true, Ok(best)) = (is_within, &best) {
                assert!(best.layers() <= plan.layers(), "{text} {limits:?}");
            }
        }
    }
}

#[test]
fn a_greedy_planner_that_sees_the_plane_alone_takes_its_slope_for_all() {
    let mut density = vec![0.1; 20];
    density[5..].fill(1.0);
    let errors = sum(&density);
    let plan = greedy::plan(&errors, &limits(1.0, 8.0, 0.8), &[], Sight::Plane).unwrap();
    // At the plate 0.1 suggests eight bins, three of which have density 1.
    assert_eq!(plan.boundaries[..3], [0, 8, 9]);
    assert_near(plan.max_error(&errors), 3.5, 1e-6);
}

#[test]
fn the_trade_off_curve_falls_from_the_least_tolerance_to_the_fewest_layers() {
    let mut random = fastrand::Rng::with_seed(23);
    let resin = Resin::default();
    for _ in 0..40 {
        let count = random.usize(20..=80);
        let (errors, text) = random_errors(&mut random, count);
        let limits = limits(2.0, 7.0, 0.0);
        let points = curve(&errors, &limits, &[], Objective::Layers, &resin, 30).unwrap();
        assert_eq!(points.len(), 30, "{text}");
        for pair in points.windows(2) {
            assert!(pair[0].tolerance <= pair[1].tolerance);
            assert!(pair[0].layers >= pair[1].layers);
        }
        assert!(
            points
                .iter()
                .all(|point| point.max_error <= point.tolerance)
        );
        assert_eq!(points[29].layers, count.div_ceil(7));

        for point in [&points[0], &points[13], &points[29]] {
            let goal = Goal::Layers(point.layers);
            let tolerance = tolerance_for(&errors, &limits, &[], &resin, goal).unwrap();
            assert!(
                tolerance <= point.tolerance * (1.0 + 2e-5) + 1e-6,
                "{text} {point:?} {tolerance}"
            );
            let layers = |tolerance| {
                let limits = Limits {
                    tolerance,
                    ..limits.clone()
                };
                optimal::plan(&errors, &limits, &[], Objective::Layers).map(|plan| plan.layers())
            };
            if tolerance > 0.0 {
                assert!(layers(tolerance).unwrap() <= point.layers);
                assert!(
                    layers(tolerance * (1.0 - 2e-5) - 1e-6)
                        .is_ok_and(|layers| layers > point.layers)
                        || layers(tolerance * (1.0 - 2e-5) - 1e-6).is_err()
                );
            }
        }
    }
}

#[test]
fn the_least_tolerance_for_a_time_is_found_or_out_of_reach() {
    let errors = sum(&[0.5; 100]);
    let resin = resin(1.0, 2.0, 10.0, 8.0);
    let limits = limits(1.0, 10.0, 0.0);
    let coarsest_s = 10.0 * (8.0 + resin.exposure_s(10.0));
    let tolerance = tolerance_for(&errors, &limits, &[], &resin, Goal::Time(coarsest_s + 0.01));
    assert_near(tolerance.unwrap(), 5.0, 1e-4);
    for goal in [Goal::Time(coarsest_s - 1.0), Goal::Layers(9)] {
        let result = tolerance_for(&errors, &limits, &[], &resin, goal);
        let Err(error @ PlanError::OutOfReach { .. }) = result else {
            panic!("{result:?}");
        };
        assert!(
            error.to_string().contains("at the least it takes"),
            "{error}"
        );
    }
}

#[test]
fn the_shortest_time_is_not_the_fewest_layers_where_exposures_grow_fast() {
    let errors = sum(&[0.1; 60]);
    let resin = resin(1.0, 1.0, 1.5, 2.0);
    let all = limits(1.0, 6.0, 100.0);
    let fewest = optimal::plan(&errors, &all, &[], Objective::Layers).unwrap();
    let quickest = optimal::plan(&errors, &all, &[], Objective::Time(&resin)).unwrap();
    assert!(quickest.layers() > fewest.layers());
    assert!(quickest.print_time_s(&resin) < fewest.print_time_s(&resin));
}

#[test]
fn uniform_layers_end_within_half_a_layer_of_the_top() {
    for (height_mm, layers) in [(10.0, 5), (10.9, 5), (11.1, 6), (1.2, 1)] {
        let bins = Bins::of_height(height_mm, 0.1).unwrap();
        let plan = uniform::plan(bins, height_mm, 2.0).unwrap();
        assert_eq!(plan.layers(), layers, "{height_mm} mm");
        let thickness_mm = plan.thickness_mm();
        assert!(
            thickness_mm
                .iter()
                .all(|thickness_mm| (thickness_mm - 2.0).abs() < 1e-12)
        );
    }
    let too_thick = uniform::plan(Bins::of_height(0.4, 0.1).unwrap(), 0.4, 2.0);
    assert!(matches!(too_thick, Err(PlanError::LayerTooThick { .. })));
    let bins = Bins::of_height(10.0, 0.1).unwrap();
    for layer_mm in [0.25, 0.05] {
        let result = uniform::plan(bins, 10.0, layer_mm);
        assert!(matches!(result, Err(PlanError::NotWholeBins { .. })));
    }
}
