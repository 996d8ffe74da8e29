//! The least sum of errors for every number of layers, against brute force over all sets of planes.

use std::collections::BTreeMap;

use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::{PlanError, least_sum};

use super::cases::{self, assert_without_snap_planes};
use super::{limits, volume};

#[test]
fn no_set_of_as_many_planes_has_a_smaller_sum() {
    let mut random = fastrand::Rng::with_seed(73);
    let (mut feasible, mut infeasible, mut out_of_reach) = (0, 0, 0);
    for _ in 0..6000 {
        let case = cases::random(&mut random, 12);
        let most = random.usize(1..=13);
        let found = least_sum::plans(&case.errors, &case.limits, most);
        let text = format!("{} {most} {found:?}", case.text);
        let Ok(top) = case.top() else {
            assert!(found.is_err(), "{text}");
            continue;
        };
        let all = case.plans_to(top);
        let mut expected: BTreeMap<usize, (u64, u64)> = BTreeMap::new();
        for plan in &all {
            let best = expected.entry(plan.len() - 1).or_insert((u64::MAX, 0));
            *best = (*best).min(case.sum_and_worst(plan));
        }
        let fewest = expected.keys().next().copied();
        expected.retain(|&layers, _| layers <= most);
        match found {
            Ok(found) => {
                feasible += 1;
                assert_eq!(found.len(), expected.len(), "{text}");
                for (found, (&layers, &best)) in found.iter().zip(&expected) {
                    assert_without_snap_planes(&found.plan);
                    assert!(all.contains(&found.plan.boundaries), "{text}");
                    assert_eq!(found.plan.layers(), layers, "{text}");
                    assert_eq!(case.sum_and_worst(&found.plan.boundaries), best, "{text}");
                    assert_eq!(found.sum_steps, best.0, "{text}");
                }
            }
            Err(PlanError::Infeasible { .. }) => {
                infeasible += 1;
                assert!(all.is_empty(), "{text}");
            }
            Err(PlanError::LayersOutOfReach { least_layers, .. }) => {
                out_of_reach += 1;
                assert!(expected.is_empty(), "{text}");
                assert_eq!(Some(least_layers), fewest, "{text}");
            }
            Err(error) => panic!("{text}: {error}"),
        }
    }
    assert!(
        feasible > 1000 && infeasible > 500 && out_of_reach > 100,
        "{feasible} feasible, {infeasible} infeasible, {out_of_reach} out of reach"
    );
}

#[test]
fn a_planted_staircase_is_found_without_error() {
    // Steps of 3, 5 and 4 bins: three layers follow them, and each further one is free.
    let areas = [9.0, 9.0, 9.0, 4.0, 4.0, 4.0, 4.0, 4.0, 7.0, 7.0, 7.0, 7.0];
    let plans = least_sum::plans(&volume(&areas), &limits(1.0, 6.0, 1e6), 12).unwrap();
    let sums: Vec<(usize, f64)> = plans
        .iter()
        .map(|found| (found.plan.layers(), found.sum))
        .collect();
    // Two layers: from 0 to 6 and from 6 to 12.
    assert_eq!(sums[0], (2, 27.0));
    assert_eq!(plans[1].plan.boundaries, [0, 3, 8, 12]);
    assert!(sums[1..].iter().all(|(_, sum)| *sum == 0.0));
    assert_eq!(sums.len(), 11);
}

#[test]
fn the_sum_is_never_above_that_of_the_plan_with_the_least_maximum() {
    let mut random = fastrand::Rng::with_seed(79);
    for _ in 0..40 {
        let areas: Vec<f64> = (0..200).map(|_| f64::from(random.u32(0..=9))).collect();
        let (errors, limits) = (volume(&areas), limits(3.0, 9.0, 30.0));
        let Ok(fewest) = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers)
        else {
            continue;
        };
        let plans = least_sum::plans(&errors, &limits, fewest.layers() + 5).unwrap();
        assert_eq!(plans[0].plan.layers(), fewest.layers());
        let steps = fewest.boundaries.windows(2);
        let sum: u64 = steps.map(|two| errors.steps_between(two[0], two[1])).sum();
        assert!(plans[0].sum_steps <= sum);
    }
}
