//! Infeasible tolerances and the changes that make them feasible, the trade-off curve, and tolerances for a goal.

use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::tradeoff::{Goal, curve, tolerance_for};
use cusp_slicer::plan::{Limits, PlanError};
use cusp_slicer::resin::Resin;

use super::{limits, plan, random_errors, resin, sum};
use crate::common::assert_near;

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
    // Of the three bins with density 1, two are always in the same layer.
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
        let holds = |limits: &Limits| {
            optimal::plan(&errors, limits, SnapPlanes::NONE, Objective::Layers).is_ok()
        };
        let Err(PlanError::Infeasible {
            least_tolerance,
            largest_layer_min_mm,
            ..
        }) = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers)
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
fn the_trade_off_curve_falls_from_the_least_tolerance_to_the_fewest_layers() {
    let mut random = fastrand::Rng::with_seed(23);
    let resin = Resin::default();
    for _ in 0..40 {
        let count = random.usize(20..=80);
        let (errors, text) = random_errors(&mut random, count);
        let limits = limits(2.0, 7.0, 0.0);
        let points = curve(
            &errors,
            &limits,
            SnapPlanes::NONE,
            Objective::Layers,
            &resin,
            30,
        )
        .unwrap();
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
            let tolerance = tolerance_for(&errors, &limits, &resin, goal).unwrap();
            assert!(
                tolerance <= point.tolerance * (1.0 + 2e-5) + 1e-6,
                "{text} {point:?} {tolerance}"
            );
            let layers = |tolerance| {
                let limits = Limits {
                    tolerance,
                    ..limits.clone()
                };
                optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers)
                    .map(|plan| plan.layers())
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
    let tolerance = tolerance_for(&errors, &limits, &resin, Goal::Time(coarsest_s + 0.01));
    assert_near(tolerance.unwrap(), 5.0, 1e-4);
    let refused = |goal| tolerance_for(&errors, &limits, &resin, goal).unwrap_err();
    let time_s = coarsest_s - 1.0;
    assert_eq!(
        refused(Goal::Time(time_s)),
        PlanError::TimeOutOfReach {
            time_s,
            least_time_s: coarsest_s.ceil()
        }
    );
    assert_eq!(
        refused(Goal::Layers(9)),
        PlanError::LayersOutOfReach {
            layers: 9,
            least_layers: 10
        }
    );
}
