//! Gradual thicknesses, against brute force over all sets of planes.

use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::{PlanError, gradual};

use super::cases::{self, assert_without_snap_planes, thicknesses};
use super::{limits, sum};

fn greatest_change(boundaries: &[u32]) -> u32 {
    let thicknesses = thicknesses(boundaries);
    let changes = thicknesses.windows(2).map(|two| two[0].abs_diff(two[1]));
    changes.max().unwrap_or(0)
}

#[test]
fn no_set_of_planes_with_gradual_thicknesses_is_better() {
    let mut random = fastrand::Rng::with_seed(71);
    let (mut feasible, mut abrupt, mut infeasible) = (0, 0, 0);
    for _ in 0..8000 {
        let case = cases::random(&mut random, 12);
        let change = random.u32(0..=3);
        let found = gradual::plan(&case.errors, &case.limits, f64::from(change));
        let text = format!("{} {change} {found:?}", case.text);
        let Ok(top) = case.top() else {
            assert!(found.is_err(), "{text}");
            continue;
        };
        let all = case.plans_to(top);
        let gradual = all.iter().filter(|plan| {
            let units = change / case.rules.step as u32 * case.rules.step as u32;
            greatest_change(case.covered(plan)) <= units
        });
        let expected = gradual.map(|plan| case.layers_and_worst(plan)).min();
        match (found, expected) {
            (Ok(plan), Some(expected)) => {
                feasible += 1;
                assert_without_snap_planes(&plan);
                assert!(all.contains(&plan.boundaries), "{text}");
                let covered = case.covered(&plan.boundaries);
                assert!(greatest_change(covered) <= change, "{text}");
                assert_eq!(case.layers_and_worst(&plan.boundaries), expected, "{text}");
            }
            (
                Err(PlanError::NotGradual {
                    least_change_mm, ..
                }),
                None,
            ) => {
                abrupt += 1;
                let changes = all.iter().map(|plan| greatest_change(case.covered(plan)));
                let least = changes.min();
                assert_eq!(Some(least_change_mm), least.map(f64::from), "{text}");
            }
            (Err(PlanError::Infeasible { .. }), None) => {
                infeasible += 1;
                assert!(all.is_empty(), "{text}");
            }
            (_, expected) => panic!("{text}: {expected:?}"),
        }
    }
    assert!(
        feasible > 1000 && abrupt > 50 && infeasible > 500,
        "{feasible} feasible, {abrupt} too abrupt, {infeasible} infeasible"
    );
}

#[test]
fn any_change_gives_the_optimal_plan() {
    let density: Vec<f32> = (0..300).map(|bin| (bin % 40) as f32 / 40.0).collect();
    let (errors, limits) = (sum(&density), limits(3.0, 9.0, 4.0));
    let free = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers).unwrap();
    let any = gradual::plan(&errors, &limits, f64::INFINITY).unwrap();
    assert_eq!(any.layers(), free.layers());
    assert_eq!(any.max_error_steps(&errors), free.max_error_steps(&errors));
    let gradual = gradual::plan(&errors, &limits, 1.0).unwrap();
    assert!(greatest_change(&gradual.boundaries) == 1 && gradual.layers() >= free.layers());
}

#[test]
fn a_change_that_is_no_length_is_told() {
    let errors = sum(&[0.1; 10]);
    for change_mm in [-1.0, f64::NAN] {
        let found = gradual::plan(&errors, &limits(2.0, 3.0, 1.0), change_mm);
        let Err(PlanError::NotGradual {
            least_change_mm, ..
        }) = found
        else {
            panic!("{found:?}");
        };
        assert_eq!(least_change_mm, 0.0, "five layers of 2 mm");
    }
}
