//! The planners for comparison: greedy and uniform.

use cusp_slicer::grid::Bins;
use cusp_slicer::plan::greedy::{self, Sight};
use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::{PlanError, uniform};

use super::{FIGURE_3, limits, random_errors, sum};
use crate::common::assert_near;

#[test]
fn greedy_planners_fill_every_segment_and_may_exceed_the_tolerance() {
    // As in the text of section 3.3: after a first layer of three bins, an error of 0.7 is unavoidable.
    let errors = sum(&FIGURE_3);
    let greedy = greedy::plan(&errors, &limits(2.0, 3.0, 0.6), &[], Sight::Profile).unwrap();
    assert_eq!(greedy.boundaries[..3], [0, 3, 5]);
    assert_near(greedy.max_error(&errors), 0.7, 1e-6);

    let mut random = fastrand::Rng::with_seed(17);
    for _ in 0..500 {
        let count = random.usize(10..=80);
        let (errors, text) = random_errors(&mut random, count);
        let limits = limits(3.0, 5.0, random.f64() * 4.0 + 0.1);
        let best = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers);
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
fn uniform_layers_end_within_half_a_layer_of_the_top() {
    for (height_mm, layers) in [(10.0, 5), (10.9, 5), (11.1, 6), (1.2, 1)] {
        let bins = Bins::of_height(height_mm, 0.1).unwrap();
        let plan = uniform::plan(bins, height_mm, 2.0, 0).unwrap();
        assert_eq!(plan.layers(), layers, "{height_mm} mm");
        let thickness_mm = plan.thickness_mm();
        assert!(
            thickness_mm
                .iter()
                .all(|thickness_mm| (thickness_mm - 2.0).abs() < 1e-12)
        );
    }
    let too_thick = uniform::plan(Bins::of_height(0.4, 0.1).unwrap(), 0.4, 2.0, 0);
    assert!(matches!(too_thick, Err(PlanError::LayerTooThick { .. })));
    let bins = Bins::of_height(10.0, 0.1).unwrap();
    for layer_mm in [0.25, 0.05] {
        let result = uniform::plan(bins, 10.0, layer_mm, 0);
        assert!(matches!(result, Err(PlanError::NotWholeBins { .. })));
    }
}

#[test]
fn a_fixed_first_layer_is_below_uniform_ones() {
    // Of 10 mm, 3 are the first layer; the middle of the last one, at 9.5 mm, is still within.
    let bins = Bins::of_height(10.0, 0.5).unwrap();
    let plan = uniform::plan(bins, 10.0, 2.0, 6).unwrap();
    assert_eq!(plan.z_mm(), [0.0, 3.0, 5.0, 7.0, 9.0]);
    assert_eq!(plan.exempt_layers, 1);
    let higher = uniform::plan(bins, 10.0, 1.0, 3).unwrap();
    assert_eq!(higher.z_mm()[..3], [0.0, 1.5, 2.5]);
    assert_eq!(higher.z_mm()[9..], [9.5]);
}
