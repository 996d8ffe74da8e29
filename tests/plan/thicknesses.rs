//! Plans with few thicknesses, against brute force over all sets of thicknesses and of planes.

use std::ops::ControlFlow;

use cusp_slicer::plan::thicknesses::{DEFAULT_STEPS, FewThicknesses};
use cusp_slicer::plan::{Limits, PlanError, thicknesses};
use cusp_slicer::profile::LayerErrors;
use cusp_slicer::progress::silent;

use super::cases::{self, Case, assert_without_snap_planes};
use super::{limits, sum, volume};

/// Every plan of a case up to the heights near the top of the model, by height.
struct All {
    plans: Vec<(u32, Vec<Vec<u32>>)>,
}

impl All {
    fn of(case: &Case) -> Self {
        // No layer of a case is thicker than 6 bins.
        let highest_plane = case.rules.planes.iter().max().copied().unwrap_or(0);
        let lowest_end = highest_plane.max(case.rules.first_layer) + 1;
        let lowest = case.count.saturating_sub(3).max(lowest_end) as u32;
        let tops = lowest..=case.count as u32 + 3;
        Self {
            plans: tops.map(|top| (top, case.plans_to(top))).collect(),
        }
    }

    /// Layers and largest error of the best plan with thicknesses of a set, at the nearest height that they reach.
    fn best(&self, case: &Case, set: &[u32]) -> Option<(usize, u64)> {
        let (thinnest, thickest) = *case.rules.thickness.last()?;
        let step = case.rules.step;
        let thinnest = thinnest.next_multiple_of(step) as u32;
        let least =
            (*set.iter().min()?).clamp(thinnest, thinnest.max((thickest / step * step) as u32));
        let count = case.count as u32;
        let mut tops: Vec<_> = self
            .plans
            .iter()
            .filter(|(top, _)| {
                let twice = 2 * top.abs_diff(count);
                twice < least || twice == least && *top < count
            })
            .collect();
        tops.sort_by_key(|(top, _)| (top.abs_diff(count), *top));
        tops.into_iter().find_map(|(_, plans)| {
            let of_set = |plan: &&Vec<u32>| {
                let mut thicknesses = cases::thicknesses(case.covered(plan)).into_iter();
                thicknesses.all(|thickness| set.contains(&thickness))
            };
            let found = plans.iter().filter(of_set);
            found.map(|plan| case.layers_and_worst(plan)).min()
        })
    }
}

fn at_most(
    errors: &LayerErrors,
    limits: &Limits,
    count: usize,
    steps: u64,
) -> Result<FewThicknesses, PlanError> {
    thicknesses::at_most(errors, limits, count, steps, &mut silent).unwrap()
}

fn in_mm(set: &[u32]) -> Vec<f64> {
    set.iter().copied().map(f64::from).collect()
}

#[test]
fn no_set_of_planes_with_given_thicknesses_is_better() {
    let mut random = fastrand::Rng::with_seed(83);
    let (mut feasible, mut infeasible) = (0, 0);
    for _ in 0..3000 {
        let case = cases::random(&mut random, 10);
        let step = case.rules.step as u32;
        let mut set: Vec<u32> = (1..=6).filter(|_| random.bool()).collect();
        set.retain(|thickness| thickness.is_multiple_of(step));
        let found = thicknesses::of(&case.errors, &case.limits, &in_mm(&set));
        let text = format!("{} {set:?} {found:?}", case.text);
        if case.top().is_err() {
            assert!(found.is_err(), "{text}");
            continue;
        }
        match (found, All::of(&case).best(&case, &set)) {
            (Ok(plan), Some(expected)) => {
                feasible += 1;
                assert_without_snap_planes(&plan);
                assert_eq!(case.layers_and_worst(&plan.boundaries), expected, "{text}");
            }
            (
                Err(PlanError::ThicknessesDoNotFit {
                    least_tolerance, ..
                }),
                None,
            ) => {
                infeasible += 1;
                let Some(tolerance) = least_tolerance else {
                    continue;
                };
                let mut raised = case.limits.clone();
                raised.tolerance = tolerance;
                let found = thicknesses::of(&case.errors, &raised, &in_mm(&set));
                assert!(found.is_ok(), "{text} {found:?}");
            }
            (_, expected) => panic!("{text}: {expected:?}"),
        }
    }
    assert!(
        feasible > 500 && infeasible > 500,
        "{feasible} feasible, {infeasible} not"
    );
}

#[test]
fn no_other_set_of_thicknesses_has_fewer_layers() {
    let mut random = fastrand::Rng::with_seed(89);
    let (mut feasible, mut too_few, mut infeasible) = (0, 0, 0);
    for _ in 0..3000 {
        let case = cases::random(&mut random, 10);
        let most = random.usize(0..=4);
        let found = at_most(&case.errors, &case.limits, most, DEFAULT_STEPS);
        let text = format!("{} {most} {found:?}", case.text);
        if case.top().is_err() {
            assert!(found.is_err(), "{text}");
            continue;
        }
        let all = All::of(&case);
        let sets = (1u32..1 << 6).filter(|set| set.count_ones() as usize <= most);
        let best = sets.filter_map(|set| {
            let set: Vec<u32> = (1..=6)
                .filter(|place| set >> (place - 1) & 1 == 1)
                .collect();
            // A set with thicknesses that no layer has may move the top farther than its layers allow.
            let is_allowed = set.iter().all(|&thickness| allows(&case, thickness));
            is_allowed.then(|| all.best(&case, &set)).flatten()
        });
        match (found, best.map(|(layers, _)| layers).min()) {
            (Ok(found), Some(layers)) => {
                feasible += 1;
                assert_without_snap_planes(&found.plan);
                assert_eq!(found.plan.layers(), layers, "{text}");
                assert_eq!(found.least_layers, layers, "{text}");
                let early = at_most(&case.errors, &case.limits, most, 0).unwrap();
                let bounds = early.least_layers..=early.plan.layers();
                assert!(bounds.contains(&layers), "{text} {early:?}");
                let mut used = cases::thicknesses(case.covered(&found.plan.boundaries));
                used.sort_unstable();
                used.dedup();
                assert_eq!(found.thicknesses_mm, in_mm(&used), "{text}");
                assert!(used.len() <= most, "{text}");
                let top = *found.plan.boundaries.last().unwrap();
                assert!(
                    case.plans_to(top).contains(&found.plan.boundaries),
                    "{text}"
                );
            }
            (Err(PlanError::TooFewThicknesses { enough, .. }), None) => {
                too_few += 1;
                let found = at_most(&case.errors, &case.limits, enough, DEFAULT_STEPS);
                assert!(found.is_ok(), "{text} {found:?}");
            }
            (Err(PlanError::Infeasible { .. }), None) => infeasible += 1,
            (_, expected) => panic!("{text}: {expected:?}"),
        }
    }
    assert!(
        feasible > 500 && too_few > 100 && infeasible > 300,
        "{feasible} feasible, {too_few} with too few thicknesses, {infeasible} infeasible"
    );
}

/// Returns true if layers of a thickness are allowed anywhere.
fn allows(case: &Case, thickness: u32) -> bool {
    let thickness = thickness as usize;
    let mut ranges = case.rules.thickness.iter();
    thickness.is_multiple_of(case.rules.step)
        && ranges.any(|&(least, greatest)| (least..=greatest).contains(&thickness))
}

#[test]
fn planted_thicknesses_are_found() {
    // Steps of 12, 20 and 33 bins: only layers of these follow them without error.
    let mut random = fastrand::Rng::with_seed(97);
    let mut areas = Vec::new();
    for step in 0..60 {
        let thickness = [12, 20, 33][random.usize(0..3)];
        areas.extend(vec![f64::from(step % 7 + 1); thickness]);
    }
    let (errors, limits) = (volume(&areas), limits(12.0, 40.0, 0.0));
    let found = at_most(&errors, &limits, 3, DEFAULT_STEPS).unwrap();
    assert_eq!(found.thicknesses_mm, [12.0, 20.0, 33.0]);
    assert_eq!(found.plan.layers(), 60);
    let given = thicknesses::of(&errors, &limits, &[33.0, 12.0, 20.0]).unwrap();
    assert_eq!(given, found.plan);
    let few = at_most(&errors, &limits, 2, DEFAULT_STEPS);
    assert!(
        matches!(few, Err(PlanError::TooFewThicknesses { .. })),
        "{few:?}"
    );
}

#[test]
fn a_search_for_thicknesses_tells_its_progress_and_can_be_cancelled() {
    let errors = volume(
        &(0..400)
            .map(|bin| f64::from(bin * bin % 97))
            .collect::<Vec<_>>(),
    );
    let limits = limits(5.0, 25.0, 500.0);
    let mut told = Vec::new();
    let whole = thicknesses::at_most(&errors, &limits, 3, 1 << 22, &mut |fraction| {
        told.push(fraction);
        ControlFlow::Continue(())
    });
    assert!(whole.is_ok());
    assert!(told.len() > 5 && told.is_sorted(), "{told:?}");
    assert!(told.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
    let mut calls = 0;
    let cancelled = thicknesses::at_most(&errors, &limits, 3, 1 << 22, &mut |_| {
        calls += 1;
        if calls < 3 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    assert!(cancelled.is_err());
    assert_eq!(calls, 3);
}

#[test]
fn thicknesses_that_are_no_whole_steps_are_told() {
    let mut limits = limits(1.0, 6.0, 10.0);
    let errors = sum(&[0.1; 20]);
    for (step_mm, set) in [(None, vec![2.5]), (Some(2.0), vec![2.0, 3.0])] {
        limits.step_mm = step_mm;
        let found = thicknesses::of(&errors, &limits, &set);
        let is_told = match found {
            Err(PlanError::NotWholeBins { .. }) => step_mm.is_none(),
            Err(PlanError::NotWholeSteps { length_mm, .. }) => length_mm == 3.0,
            _ => false,
        };
        assert!(is_told, "{found:?}");
    }
    let found = thicknesses::of(&errors, &limits, &[f64::NAN]);
    assert!(matches!(found, Err(PlanError::Quantity(_))), "{found:?}");
}
