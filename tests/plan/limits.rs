//! Limits: mandatory planes, height ranges, the motor step, snap planes, and limits that contradict each other.

use cusp_slicer::grid::Bins;
use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::segment::Segments;
use cusp_slicer::plan::snap_cost::{Price, SnapPlanes};
use cusp_slicer::plan::{HeightRange, Limits, Plan, PlanError, uniform};
use cusp_slicer::profile::{LayerErrors, Profile};
use cusp_slicer::quantity::Quantity;

use super::{limits, plan, sum};
use crate::common::{assert_near, bins};

#[test]
fn steps_and_thicknesses_of_any_size_are_answered() {
    // A motor step of 2 m and layers of a kilometre, in bins of a thousandth.
    for (step_mm, layer_min_mm) in [(2000.0, 1e5), (429.476, 500.0), (0.02, 0.02)] {
        let limits = Limits {
            layer_min_mm,
            layer_max_mm: 1e6,
            tolerance: 1e9,
            step_mm: Some(step_mm),
            ..Limits::default()
        };
        let profile = Profile {
            bins: Bins {
                count: 20_000,
                size_mm: 0.001,
            },
            density: vec![0.5; 20_000],
        };
        let errors = LayerErrors::Sum(profile.error_sum());
        let found = optimal::plan(&errors, &limits, SnapPlanes::NONE, Objective::Layers);
        let is_planned = layer_min_mm < 1.0;
        assert_eq!(found.is_ok(), is_planned, "{step_mm}: {found:?}");
        if let Err(error) = found {
            assert!(
                matches!(error, PlanError::LayersDoNotFit { .. }),
                "{error:?}"
            );
        }
    }
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
fn where_ranges_meet_the_limits_of_all_hold() {
    let mut random = fastrand::Rng::with_seed(24);
    for round in 0..300 {
        // Small numbers, so that many ends and limits are equal; some ranges are empty or upside down.
        let ranges: Vec<HeightRange> = (0..random.usize(..12))
            .map(|_| HeightRange {
                from_mm: f64::from(random.u32(..10)),
                to_mm: f64::from(random.u32(..12)),
                layer_min_mm: f64::from(random.u32(1..5)) / 100.0,
                layer_max_mm: f64::from(random.u32(1..9)) / 100.0,
            })
            .collect();
        let joined = HeightRange::joined(&ranges);
        assert!(joined.windows(2).all(|two| two[0].to_mm <= two[1].from_mm));
        for half in (1..24).step_by(2) {
            let z_mm = f64::from(half) / 2.0;
            let is_in = |range: &&HeightRange| range.from_mm < z_mm && z_mm < range.to_mm;
            let limits = |found: &[HeightRange]| {
                let of_all = found.iter().filter(is_in);
                of_all.fold((0.0, f64::INFINITY), |(least, greatest): (f64, f64), it| {
                    (least.max(it.layer_min_mm), greatest.min(it.layer_max_mm))
                })
            };
            assert_eq!(
                limits(&joined),
                limits(&ranges),
                "round {round}, {z_mm} mm: {ranges:?}"
            );
        }
    }
}

#[test]
fn many_ranges_that_all_meet_are_joined() {
    // Each comparison of two would be one of 10 billion.
    let count = 100_000;
    let ranges: Vec<HeightRange> = (0..count)
        .map(|place| HeightRange {
            from_mm: f64::from(place),
            to_mm: f64::from(2 * count - place),
            layer_min_mm: 1.0 + f64::from(place),
            layer_max_mm: 1e6 - f64::from(place),
        })
        .collect();
    let joined = HeightRange::joined(&ranges);
    assert_eq!(joined.len(), 2 * count as usize - 1);
    let innermost = joined[count as usize - 1];
    assert_eq!(innermost.layer_min_mm, f64::from(count));
    assert_eq!(joined[0].layer_max_mm, 1e6);
}

#[test]
fn heights_are_multiples_of_the_motor_step() {
    // 1.234 mm is not a multiple of the step, and a step of 0.01 mm is not a whole number of bins of 0.004 mm.
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
    let only_600 = SnapPlanes {
        planes: &[600],
        price: Price::Layer,
    };
    let plan = optimal::plan(&errors, &limits, only_600, Objective::Layers).unwrap();
    assert!(plan.boundaries.iter().all(|boundary| boundary % 5 == 0));
    assert!(
        plan.boundaries.contains(&310),
        "1.24 mm is the step nearest to 1.234 mm"
    );
    assert_eq!(plan.snap_planes, [600]);
    assert_eq!(plan.z_mm().last(), Some(&4.44));
    let uneven = Limits {
        step_mm: Some(0.01),
        ..limits
    };
    let result = optimal::plan(&errors, &uneven, SnapPlanes::NONE, Objective::Layers);
    assert!(
        matches!(result, Err(PlanError::NotWholeBins { .. })),
        "{result:?}"
    );
}

#[test]
fn snap_planes_are_taken_in_order_and_give_way() {
    let plain = limits(3.0, 6.0, 100.0);
    let segments = Segments::new(bins(30), &plain, &[10, 12, 25, 2, 29]).unwrap();
    // 12 is too near to 10, 2 to the plate and 29 to the top.
    assert_eq!(segments.snap_planes, [10, 25]);
    assert_eq!(segments.segments.len(), 3);

    // From 0 to 10, some layer would take 4 bins: too much where the density is 1.
    let mut density = [0.1; 30];
    density[..10].fill(1.0);
    let tight = limits(3.0, 6.0, 3.0);
    assert!(optimal::plan(&sum(&density), &tight, SnapPlanes::NONE, Objective::Layers).is_ok());
    let snap_planes = SnapPlanes {
        planes: &[10, 20],
        price: Price::Layer,
    };
    let plan = optimal::plan(&sum(&density), &tight, snap_planes, Objective::Layers).unwrap();
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
fn limits_far_beyond_the_model_are_no_trouble() {
    let wide = limits(1.0, 1e6, 1e9);
    assert_eq!(plan(&[0.1; 10], &wide).unwrap().boundaries, [0, 10]);
    let thick = plan(&[0.1; 10], &limits(1e5, 1e6, 1e9));
    assert!(
        matches!(thick, Err(PlanError::LayersDoNotFit { .. })),
        "{thick:?}"
    );
    let too_thick = uniform::plan(bins(10), 10.0, 1e6, 0);
    assert!(
        matches!(too_thick, Err(PlanError::LayerTooThick { .. })),
        "{too_thick:?}"
    );
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
            matches!(result, Err(PlanError::Quantity(_))),
            "{wrong:?}: {result:?}"
        );
    }
    let upside_down = plan(&density, &limits(5.0, 4.0, 1.0));
    assert!(matches!(
        upside_down,
        Err(PlanError::UpsideDownRange { .. })
    ));
    let empty = plan(&density, &limits(1.2, 1.8, 1.0));
    assert!(matches!(empty, Err(PlanError::EmptyRange { .. })));
}

#[test]
fn the_first_layer_may_be_fixed_whatever_its_error() {
    // The lowest bins alone exceed the tolerance many times.
    let mut density = vec![0.1; 40];
    density[..6].fill(50.0);
    let fixed = Limits {
        first_layer_mm: Some(8.0),
        ..limits(2.0, 5.0, 0.5)
    };
    assert!(plan(&density, &limits(2.0, 5.0, 0.5)).is_err());
    let found = plan(&density, &fixed).unwrap();
    assert_eq!(found.boundaries[..2], [0, 8]);
    assert_eq!((found.layers(), found.exempt_layers), (8, 1));
    let errors = sum(&density);
    assert_near(found.max_error(&errors), 0.5, 1e-6);
    let whole = Plan {
        exempt_layers: 0,
        ..found.clone()
    };
    assert!(whole.max_error(&errors) > 300.0);
}

#[test]
fn a_first_layer_that_cannot_be_is_told() {
    let first = |first_layer_mm: f64, planes_mm: Vec<f64>, step_mm: Option<f64>| {
        let limits = Limits {
            first_layer_mm: Some(first_layer_mm),
            planes_mm,
            step_mm,
            ..limits(2.0, 5.0, 100.0)
        };
        plan(&[0.1; 20], &limits).unwrap_err()
    };
    let quantity = Quantity::FirstLayer;
    assert!(
        matches!(first(1.5, vec![], None), PlanError::NotWholeBins { quantity: it, .. } if it == quantity)
    );
    assert!(matches!(
        first(3.0, vec![], Some(2.0)),
        PlanError::NotWholeSteps { .. }
    ));
    for too_thick in [20.0, 21.0, 1e6] {
        let error = first(too_thick, vec![], None);
        assert!(matches!(error, PlanError::LayerTooThick { .. }), "{error}");
    }
    assert!(matches!(
        first(f64::NAN, vec![], None),
        PlanError::Quantity(_)
    ));
    let within = first(6.0, vec![4.0], None);
    assert_eq!(
        within.to_string(),
        "layers of 6 to 6 mm do not add up to the height from 0 to 4 mm; widen the range of thicknesses or move the planes"
    );
}
