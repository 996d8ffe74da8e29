//! Plans for several models: brute force over all sets of planes, with tolerances of models' own.

use cusp_slicer::plan::optimal::{self, Objective, fill_cheapest, fill_fewest};
use cusp_slicer::plan::snap_cost::{SnapCosts, SnapPlanes};
use cusp_slicer::profile::LayerErrors;
use cusp_slicer::profile::largest::{LargestError, Strictness};

use super::{in_tenths, limits, random_tenths, segment, sum, volume};
use crate::common::oracle::{self, Rules};

/// Models of random heights, at least one of them of `bins` bins.
fn random_models(random: &mut fastrand::Rng, bins: usize) -> Vec<Vec<u64>> {
    let count = random.usize(1..=4);
    let tallest = random.usize(0..count);
    (0..count)
        .map(|model| {
            let height = if model == tallest {
                bins
            } else {
                random.usize(1..=bins)
            };
            random_tenths(random, height)
        })
        .collect()
}

/// The error of a layer on a model, in tenths.
fn tenths(model: &[u64], lower: usize, upper: usize) -> u64 {
    let within = model.iter().take(upper).skip(lower);
    within.sum()
}

#[test]
fn a_plan_for_several_models_has_the_fewest_layers_within_every_tolerance() {
    let mut random = fastrand::Rng::with_seed(67);
    let mut planned = 0;
    for _ in 0..1000 {
        let bins = random.usize(1..=12);
        let models = random_models(&mut random, bins);
        let own: Vec<u64> = models.iter().map(|_| random.u64(5..=40)).collect();
        let of = random.u64(5..=40);
        let least = random.usize(1..=3);
        let greatest = least + random.usize(0..=4);
        let errors = models.iter().zip(&own).map(|(model, &own)| {
            let errors = sum(&in_tenths(model));
            let steps = |tenths: u64| errors.to_steps(tenths as f64 / 10.0);
            let strictness = Strictness::new(steps(own), steps(of));
            (errors, strictness)
        });
        let errors = LayerErrors::Largest(LargestError::new(errors.collect()));
        assert_eq!(errors.bins().count, bins);
        let limits = limits(least as f64, greatest as f64, of as f64 / 10.0);
        let found = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers);
        let exceeds = |lower, upper| {
            let models = models.iter().zip(&own);
            u64::from(
                models
                    .into_iter()
                    .any(|(model, &own)| tenths(model, lower, upper) > own),
            )
        };
        let rules = Rules::plain(bins, (least, greatest));
        let expected = oracle::best_plan(bins, &rules, 0, exceeds, |_, _| 1);
        if let (Ok(plan), Some((layers, _))) = (&found, expected)
            && plan.boundaries.last() == Some(&(bins as u32))
        {
            planned += 1;
            assert_eq!(plan.layers() as u64, layers, "{models:?} {own:?} {of}");
            for pair in plan.boundaries.windows(2) {
                assert_eq!(exceeds(pair[0] as usize, pair[1] as usize), 0);
            }
        }
        // Layers may not add up to the height, so that the top moves; no plan then reaches it exactly.
        if expected.is_some() {
            assert!(found.is_ok(), "{models:?} {own:?} {of} {least} {greatest}");
        }
    }
    assert!(planned > 100, "{planned}");
}

#[test]
fn sums_of_several_models_are_planned_in_linear_time_as_well() {
    let mut random = fastrand::Rng::with_seed(71);
    for _ in 0..500 {
        let bins = random.usize(1..=90);
        let errors = random_models(&mut random, bins).into_iter().map(|model| {
            let strictness = Strictness::new(random.u64(1..=9), random.u64(1..=9));
            (sum(&in_tenths(&model)), strictness)
        });
        let errors = LayerErrors::Largest(LargestError::new(errors.collect()));
        assert!(errors.is_monotone());
        let least = random.u32(1..=6);
        let segment = segment(bins, (least, least + random.u32(0..=20)));
        let tolerance = errors.to_steps(random.f64() * 8.0);
        let between = |lower, upper| errors.steps_between(lower, upper);
        let found = fill_fewest(between, &segment, &SnapCosts::default(), tolerance);
        let expected = fill_cheapest(&errors, &segment, &SnapCosts::default(), tolerance, |_| 1);
        assert_eq!(found.cost, expected.cost);
        assert_eq!(found.worst, expected.worst);
    }
}

#[test]
fn the_error_of_a_layer_is_the_largest_over_the_models_that_reach_it() {
    let low = sum(&[0.5, 0.5]);
    let high = sum(&[0.1, 0.1, 0.1, 0.3]);
    let section = volume(&[4.0, 2.0, 1.0]);
    let both = |strictness| {
        let models = vec![(low.clone(), Strictness::NONE), (high.clone(), strictness)];
        LayerErrors::Largest(LargestError::new(models))
    };
    let error =
        |errors: &LayerErrors, lower, upper| errors.to_value(errors.steps_between(lower, upper));
    let plain = both(Strictness::NONE);
    assert!((error(&plain, 0, 2) - 1.0).abs() < 1e-6);
    assert!((error(&plain, 1, 3) - 0.5).abs() < 1e-6);
    assert!((error(&plain, 2, 4) - 0.4).abs() < 1e-6);
    assert!(error(&plain, 4, 9) == 0.0);
    // Half the tolerance: errors count twice.
    let strict = both(Strictness::new(100, 200));
    assert!((error(&strict, 2, 4) - 0.8).abs() < 1e-6);
    assert!((error(&strict, 0, 2) - 1.0).abs() < 1e-6);
    // The volume deviation is not monotone.
    let mixed = LargestError::new(vec![(section.clone(), Strictness::NONE)]);
    let mixed = LayerErrors::Largest(mixed);
    assert!(!mixed.is_monotone());
    assert_eq!(mixed.steps_between(0, 3), section.steps_between(0, 3));
}

#[test]
fn a_tolerance_of_zero_is_kept_beside_others() {
    let errors = |own: u64, of: u64| {
        let models = vec![
            (sum(&[0.0, 0.0, 0.2, 0.2]), Strictness::new(own, of)),
            (sum(&[0.1; 4]), Strictness::NONE),
        ];
        LayerErrors::Largest(LargestError::new(models))
    };
    // The first model allows nothing, so layers of its upper half are impossible, and its lower half is free.
    let none = errors(0, 1000);
    assert_eq!(none.steps_between(2, 3), u64::MAX);
    assert!(none.steps_between(0, 2) < u64::MAX);
    // The plan allows nothing, the first model its own tolerance.
    let loose = errors(none.to_steps(0.5), 0);
    assert_eq!(loose.steps_between(2, 4), loose.steps_between(0, 2));
}
