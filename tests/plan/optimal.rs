//! The optimal planner: the paper's example and its procedure, brute force over all sets of planes for every metric,
//! constraint and objective, and planted optima.

use cusp_slicer::plan::PlanError;
use cusp_slicer::plan::optimal::{self, Objective, Table, fill_cheapest, fill_fewest};
use cusp_slicer::plan::snap_cost::{SnapCosts, SnapPlanes};
use cusp_slicer::profile::{ErrorSum, LayerErrors};
use cusp_slicer::resin::Resin;

use super::cases::{self, Case};
use super::{
    FIGURE_3, error_sum, in_tenths, limits, plan, random_tenths, resin, segment, sum, volume,
};
use crate::common::{assert_near, oracle};

/// The error of the layer between two boundaries.
fn between(errors: &ErrorSum) -> impl Fn(u32, u32) -> u64 {
    |lower, upper| errors.steps_between(lower, upper)
}

#[test]
fn figure_3_has_its_k_d_and_s() {
    let errors = sum(&FIGURE_3);
    let table = fill_fewest(
        |lower, upper| errors.steps_between(lower, upper),
        &segment(8, (2, 3)),
        &SnapCosts::default(),
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
        let table = fill_fewest(between(&errors), &segment, &SnapCosts::default(), steps);
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
        let found = fill_fewest(between(&errors), &segment, &SnapCosts::default(), tolerance);
        let expected = fill_cheapest(&all, &segment, &SnapCosts::default(), tolerance, |_| 1);
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

#[test]
fn a_plan_from_few_planes_is_that_from_all_of_them() {
    let mut random = fastrand::Rng::with_seed(44);
    let (mut planned, mut stuck) = (0, 0);
    for round in 0..4000 {
        let count = random.usize(1..=300);
        let mut density = random.f32();
        let density: Vec<f32> = (0..count)
            .map(|_| {
                // Like a surface, which changes little by little and now and then at once.
                density = match random.u8(0..20) {
                    0 => random.f32(),
                    _ => (density + 0.1 * (random.f32() - 0.5)).clamp(0.0, 1.0),
                };
                if round % 3 == 0 {
                    density.round()
                } else {
                    density
                }
            })
            .collect();
        let least = random.u32(1..=12);
        let greatest = least + random.u32(0..=25);
        let errors = error_sum(&density);
        let all = LayerErrors::Sum(errors.clone());
        let limits = limits(f64::from(least), f64::from(greatest), random.f64() * 12.0);
        let tolerance = all.to_steps(limits.tolerance);
        let found = optimal::within(
            &all,
            &limits,
            SnapPlanes::NONE,
            Objective::Layers,
            tolerance,
        );
        // Without a multiple of the thicknesses nearby, there is nothing to compare.
        let Ok(found) = found else {
            continue;
        };
        // The top may move by less than half a layer.
        let segment = match &found {
            Ok(plan) => segment(plan.boundaries[plan.layers()] as usize, (least, greatest)),
            Err(blocked) => blocked.segment.clone(),
        };
        let table = fill_fewest(between(&errors), &segment, &SnapCosts::default(), tolerance);
        match found {
            Ok(plan) => {
                let mut boundaries = vec![segment.units];
                while let Some(&plane @ 1..) = boundaries.last() {
                    boundaries.push(table.below[plane as usize]);
                }
                boundaries.reverse();
                assert_eq!(plan.boundaries, boundaries, "{density:?} {limits:?}");
                planned += 1;
            }
            Err(blocked) => {
                assert_eq!(
                    table.cost.last(),
                    Some(&Table::NO_PLAN),
                    "{density:?} {limits:?}"
                );
                let reached = table.cost.iter().rposition(|&cost| cost != Table::NO_PLAN);
                assert_eq!(blocked.reached, reached.unwrap_or(0) as u32);
                stuck += 1;
            }
        }
    }
    assert!(planned > 500 && stuck > 500, "{planned} {stuck}");
}

#[test]
fn no_set_of_planes_is_better() {
    let without_bottom = resin(1.0, 1.0, 2.0, 3.0);
    let mut random = fastrand::Rng::with_seed(3);
    let (mut feasible, mut infeasible) = (0, 0);
    for _ in 0..6000 {
        let Case {
            count,
            errors,
            limits,
            rules,
            text,
        } = cases::random(&mut random, 12);
        let is_time = random.bool();
        // Bottom layers may take longer than others, or less time, and end within any segment.
        let resin = Resin {
            bottom_layers: random.usize(0..=5),
            bottom_exposure_s: f64::from(random.u8(0..12)),
            ..without_bottom.clone()
        };
        let objective = if is_time {
            Objective::Time(&resin)
        } else {
            Objective::Layers
        };
        let expected = oracle::best_plan(
            count,
            &rules,
            errors.to_steps(limits.tolerance),
            |lower, upper| errors.steps_between(lower as u32, upper as u32),
            |layer, thickness| match is_time {
                true if layer < resin.bottom_layers => resin.bottom_layer_us(),
                true => resin.layer_us(thickness as f64),
                false => 1,
            },
        );
        let found = optimal::plan(&errors, &limits, SnapPlanes::NONE, objective);
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
                    "{text} {plan:?}"
                );
            }
            // If no layers add up to the top, the planner moves it, but the oracle does not.
            (Ok(plan), None) => assert_ne!(
                plan.boundaries[plan.layers()] as usize,
                count,
                "{text} {plan:?}"
            ),
            (Err(_), None) => infeasible += 1,
            (Err(error), Some(_)) => panic!("{text}: {error:?}"),
        }
    }
    assert!(
        feasible > 2000 && infeasible > 500,
        "{feasible} feasible, {infeasible} not"
    );
}

#[test]
fn the_volume_of_a_layer_is_measured_from_its_lowest_bin() {
    // Eq. 20 as printed, for every pair of planes.
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
    // The errors of each layer's bins add up to exactly the tolerance, so no plane can move.
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
    // Two layers are needed. Procedure 1 puts the plane at 2, which gives the upper layer an error of 6.
    let plan = plan(&[1.0; 8], &limits(1.0, 6.0, 6.0)).unwrap();
    assert_eq!(plan.boundaries, [0, 4, 8]);
}

#[test]
fn the_shortest_time_is_not_the_fewest_layers_where_exposures_grow_fast() {
    let errors = sum(&[0.1; 60]);
    let resin = resin(1.0, 1.0, 1.5, 2.0);
    let all = limits(1.0, 6.0, 100.0);
    let fewest = optimal::plan(&errors, &all, SnapPlanes::NONE, Objective::Layers).unwrap();
    let quickest = optimal::plan(&errors, &all, SnapPlanes::NONE, Objective::Time(&resin)).unwrap();
    assert!(quickest.layers() > fewest.layers());
    assert!(quickest.print_time_s(&resin) < fewest.print_time_s(&resin));
}

#[test]
fn bottom_layers_are_thick_where_their_exposure_is_the_same() {
    // As bottom layers cost the same whatever their thickness, the shortest print begins with thick ones.
    let errors = sum(&[0.01; 60]);
    let resin = Resin {
        bottom_layers: 2,
        bottom_exposure_s: 30.0,
        ..resin(1.0, 1.0, 0.4, 0.5)
    };
    let all = limits(1.0, 6.0, 100.0);
    let plan = optimal::plan(&errors, &all, SnapPlanes::NONE, Objective::Time(&resin)).unwrap();
    assert_eq!(plan.boundaries[..3], [0, 6, 12]);
    assert_eq!(plan.boundaries[3], 13);
}

#[test]
fn a_plan_without_any_error_is_within_a_tolerance_of_0() {
    let errors = sum(&[0.0; 30]);
    let plan = optimal::plan(
        &errors,
        &limits(1.0, 6.0, 0.0),
        SnapPlanes::NONE,
        Objective::Layers,
    )
    .unwrap();
    assert_eq!(plan.layers(), 5);
    let blocked = optimal::plan(
        &sum(&[0.1; 30]),
        &limits(1.0, 6.0, 0.0),
        SnapPlanes::NONE,
        Objective::Layers,
    );
    assert!(matches!(blocked, Err(PlanError::Infeasible { .. })));
}

#[test]
fn a_million_bins_and_thicknesses_of_any_number_of_them_take_one_pass() {
    // The literal Procedure 1 would look at 10^12 pairs of planes.
    let density = vec![1e-4; 1_000_000];
    let plan = plan(&density, &limits(1.0, 1e6, 10.0)).unwrap();
    assert_eq!(plan.layers(), 10);
}
