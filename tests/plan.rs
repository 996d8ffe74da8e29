//! Planners: the paper's example, brute force on small profiles, planted optima, typed failures.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use common::{assert_near, oracle};
use cusp_slicer::grid::Bins;
use cusp_slicer::plan::{Limits, Plan, PlanError, optimal, uniform};
use cusp_slicer::profile::Profile;

/// A profile with bins of 1 mm.
fn profile(density: &[f32]) -> Profile {
    let bins = Bins {
        count: density.len(),
        size_mm: 1.0,
    };
    Profile {
        bins,
        density: density.to_vec(),
    }
}

fn limits(layer_min_mm: f64, layer_max_mm: f64, tolerance_mm: f64) -> Limits {
    Limits {
        layer_min_mm,
        layer_max_mm,
        tolerance_mm,
    }
}

fn plan(density: &[f32], limits: &Limits) -> Result<Plan, PlanError> {
    optimal::plan(&profile(density).error_sum(), limits)
}

const FIGURE_3: [f32; 8] = [0.2, 0.2, 0.2, 0.3, 0.4, 0.1, 0.2, 0.2];

#[test]
fn figure_3_has_its_k_d_and_s() {
    let errors = profile(&FIGURE_3).error_sum();
    let table = optimal::fill_table(&errors, 2..=3, errors.to_steps(0.6));
    let (k, d) = (table.layers, table.below);
    let none = None;
    assert_eq!(
        k,
        [
            Some(0),
            none,
            Some(1),
            Some(1),
            Some(2),
            none,
            Some(3),
            none,
            Some(4)
        ]
    );
    assert_eq!(
        d,
        [
            none,
            none,
            Some(0),
            Some(0),
            Some(2),
            none,
            Some(4),
            none,
            Some(6)
        ]
    );
    let plan = plan(&FIGURE_3, &limits(2.0, 3.0, 0.6)).unwrap();
    assert_eq!(plan.boundaries, [0, 2, 4, 6, 8]);
    assert_eq!(plan.z_mm(), [0.0, 2.0, 4.0, 6.0, 8.0]);
    assert_eq!(plan.thickness_mm(), [2.0; 4]);
    assert_eq!(plan.middle_mm(), [1.0, 3.0, 5.0, 7.0]);
    assert_near(plan.max_error_mm(&errors), 0.5, 1e-6);
}

#[test]
fn no_set_of_planes_has_fewer_layers() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut feasible = 0;
    for _ in 0..3000 {
        let count = random.usize(1..=11);
        // Tenths make sums that hit the tolerance exactly; others do not.
        let step = if random.bool() { 10.0 } else { 1000.0 };
        let density: Vec<f32> = (0..count)
            .map(|_| (random.f32() * step).round() / step)
            .collect();
        let least = random.usize(1..=3);
        let greatest = least + random.usize(0..=3);
        let tolerance = f64::from(random.u32(1..=30)) / 10.0;
        let limits = limits(least as f64, greatest as f64, tolerance);
        let expected = oracle::fewest_layers(&density, (least, greatest), tolerance);
        let found = plan(&density, &limits);
        assert_eq!(
            found.as_ref().ok().map(Plan::layers),
            expected,
            "{density:?} {limits:?}: {found:?}"
        );
        if let Ok(plan) = found {
            feasible += 1;
            assert_eq!(
                (plan.boundaries[0], plan.boundaries[plan.layers()]),
                (0, count as u32)
            );
            for layer in plan.boundaries.windows(2) {
                let bins = (layer[1] - layer[0]) as usize;
                let error: f32 = density[layer[0] as usize..layer[1] as usize].iter().sum();
                assert!((least..=greatest).contains(&bins));
                assert!(f64::from(error) <= tolerance + 1e-5);
            }
        }
    }
    assert!(
        (1000..2500).contains(&feasible),
        "{feasible} of 3000 are feasible"
    );
}

#[test]
fn the_linear_planner_equals_procedure_1_written_literally() {
    let mut random = fastrand::Rng::with_seed(41);
    for _ in 0..3000 {
        let count = random.usize(1..=80);
        let is_flat = random.bool();
        let density: Vec<u64> = (0..count)
            .map(|_| {
                if is_flat && random.bool() {
                    0
                } else {
                    random.u64(0..=10)
                }
            })
            .collect();
        let least = random.usize(1..=6);
        let greatest = least + random.usize(0..=20);
        let tolerance = random.u64(0..=60);
        let in_bins: Vec<f32> = density.iter().map(|&tenths| tenths as f32 / 10.0).collect();
        let errors = profile(&in_bins).error_sum();
        let steps = errors.to_steps(tolerance as f64 / 10.0);
        let table = optimal::fill_table(&errors, least as u32..=greatest as u32, steps);
        let expected = oracle::procedure_1(&density, (least, greatest), tolerance);
        assert_eq!(
            (table.layers, table.below),
            expected,
            "{density:?} {least} {greatest} {tolerance}"
        );
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
fn an_infeasible_profile_names_the_height() {
    let mut density = [0.1; 30];
    density[17..20].fill(1.0);
    let limits = limits(2.0, 5.0, 0.8);
    let Err(PlanError::Infeasible { height_mm, .. }) = plan(&density, &limits) else {
        panic!("an infeasible profile was planned");
    };
    assert_eq!(height_mm, 17.0);
}

#[test]
fn heights_that_layers_do_not_add_up_to_are_told_apart() {
    let result = plan(&[0.1; 11], &limits(5.0, 5.0, 1.0));
    let Err(PlanError::Remainder {
        height_mm, rest_mm, ..
    }) = result
    else {
        panic!("{result:?}");
    };
    assert_eq!((height_mm, rest_mm), (10.0, 1.0));
}

#[test]
fn a_tolerance_that_fails_near_the_top_is_no_remainder() {
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
        matches!(thick, Err(PlanError::Remainder { .. })),
        "{thick:?}"
    );
    let bins = Bins {
        count: 10,
        size_mm: 1.0,
    };
    let too_thick = uniform::plan(bins, 10.0, 1e9);
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
    assert!(matches!(
        plan(&density, &limits(0.0, 5.0, 1.0)),
        Err(PlanError::Grid(_))
    ));
    assert!(matches!(
        plan(&density, &limits(1.0, f64::NAN, 1.0)),
        Err(PlanError::Grid(_))
    ));
    assert!(matches!(
        plan(&density, &limits(1.0, 5.0, -1.0)),
        Err(PlanError::Grid(_))
    ));
    assert!(matches!(
        plan(&density, &limits(5.0, 4.0, 1.0)),
        Err(PlanError::EmptyRange { .. })
    ));
    assert!(matches!(
        plan(&density, &limits(1.2, 1.8, 1.0)),
        Err(PlanError::EmptyRange { .. })
    ));
}

#[test]
fn uniform_layers_end_within_half_a_layer_of_the_top() {
    for (height_mm, layers) in [(10.0, 5), (10.9, 5), (11.1, 6), (1.2, 1)] {
        let bins = Bins::of_height(height_mm, 0.1).unwrap();
        let plan = uniform::plan(bins, height_mm, 2.0).unwrap();
        assert_eq!(plan.layers(), layers, "{height_mm} mm");
        assert!(
            plan.thickness_mm()
                .iter()
                .all(|thickness| (thickness - 2.0).abs() < 1e-12)
        );
    }
    let too_thick = uniform::plan(Bins::of_height(0.4, 0.1).unwrap(), 0.4, 2.0);
    assert!(matches!(too_thick, Err(PlanError::LayerTooThick { .. })));
    let bins = Bins::of_height(10.0, 0.1).unwrap();
    assert!(matches!(
        uniform::plan(bins, 10.0, 0.25),
        Err(PlanError::NotWholeBins { .. })
    ));
    assert!(matches!(
        uniform::plan(bins, 10.0, 0.05),
        Err(PlanError::NotWholeBins { .. })
    ));
}
