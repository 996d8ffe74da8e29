//! Numbers that users give: each is refused by its own name, with its bound and its unit.

use cusp_slicer::job::{Options, Planner};
use cusp_slicer::quantity::QuantityError;
use cusp_slicer::resin::Resin;

/// The sentence with which options are refused.
fn refusal(set: impl FnOnce(&mut Options)) -> String {
    let mut options = Options::default();
    set(&mut options);
    options.check().unwrap_err().to_string()
}

/// The sentence with which a resin is refused.
fn resin_refusal(set: impl FnOnce(&mut Resin)) -> String {
    let mut resin = Resin::default();
    set(&mut resin);
    let refusal = resin.check().unwrap_err().to_string();
    assert_eq!(refusal, self::refusal(|options| options.resin = resin));
    refusal
}

#[test]
fn numbers_of_layers_are_refused_by_name_bound_and_unit() {
    assert_eq!(
        refusal(|options| options.bin_mm = Some(0.0)),
        "the bin height must be from 0.000001 to 1000000 mm, not 0 mm"
    );
    assert_eq!(
        refusal(|options| options.layer_min_mm = Some(-0.05)),
        "the minimum layer thickness must be from 0.000001 to 1000000 mm, not -0.05 mm"
    );
    assert_eq!(
        refusal(|options| options.layer_max_mm = Some(f64::INFINITY)),
        "the maximum layer thickness must be from 0.000001 to 1000000 mm, not inf mm"
    );
    assert_eq!(
        refusal(|options| options.step_mm = Some(0.0)),
        "the motor step must be from 0.000001 to 1000000 mm, not 0 mm"
    );
    assert_eq!(
        refusal(|options| options.planner = Planner::Uniform { layer_mm: 0.0 }),
        "the layer thickness must be from 0.000001 to 1000000 mm, not 0 mm"
    );
    assert_eq!(
        refusal(|options| options.tolerance = Some(-1.0)),
        "the tolerance must be from 0 to 1000000000, not -1"
    );
}

#[test]
fn numbers_of_resins_are_refused_by_name_bound_and_unit() {
    assert_eq!(
        resin_refusal(|resin| resin.layer_mm = 0.0),
        "the resin's layer thickness must be from 0.0001 to 10 mm, not 0 mm"
    );
    assert_eq!(
        resin_refusal(|resin| resin.penetration_mm = -0.15),
        "the penetration depth must be from 0.0001 to 100 mm, not -0.15 mm"
    );
    assert_eq!(
        resin_refusal(|resin| resin.lift_mm_min = 0.0),
        "the lift speed must be from 0.1 to 1000000 mm/min, not 0 mm/min"
    );
    assert_eq!(
        resin_refusal(|resin| resin.return_mm_min = f64::NAN),
        "the return speed must be from 0.1 to 1000000 mm/min, not NaN mm/min"
    );
    assert_eq!(
        resin_refusal(|resin| resin.density_g_ml = 0.0),
        "the resin density must be from 0.001 to 1000 g/ml, not 0 g/ml"
    );
    assert_eq!(
        resin_refusal(|resin| resin.lift_mm = -5.0),
        "the lift height must be from 0 to 1000 mm, not -5 mm"
    );
    assert_eq!(
        resin_refusal(|resin| resin.exposure_s = -3.0),
        "the exposure must be from 0 to 100000 s, not -3 s"
    );
    assert_eq!(
        resin_refusal(|resin| resin.exposures = vec![[0.05, 3.0], [0.1, -4.0]]),
        "the exposure must be from 0 to 100000 s, not -4 s"
    );
    assert_eq!(
        resin_refusal(|resin| resin.bottom_exposure_s = -30.0),
        "the bottom exposure must be from 0 to 100000 s, not -30 s"
    );
    assert_eq!(
        resin_refusal(|resin| resin.wait_s = -1.0),
        "the wait between layers must be from 0 to 100000 s, not -1 s"
    );
    assert_eq!(
        resin_refusal(|resin| resin.exposures = vec![[0.1, 3.0], [0.05, 2.0]]),
        "measured exposures must be in order of thickness, each thicker than the one before, but 0.05 mm follows 0.1 mm"
    );
}

#[test]
fn what_may_be_zero_is_accepted_as_zero() {
    let resin = Resin {
        exposure_s: 0.0,
        bottom_exposure_s: 0.0,
        wait_s: 0.0,
        lift_mm: 0.0,
        exposures: vec![[0.05, 0.0]],
        ..Resin::default()
    };
    assert_eq!(resin.check(), Ok(()));
}

#[test]
fn only_times_are_bad_times() {
    for (resin, is_time) in [
        (
            Resin {
                lift_mm: -1.0,
                ..Resin::default()
            },
            false,
        ),
        (
            Resin {
                wait_s: -1.0,
                ..Resin::default()
            },
            true,
        ),
    ] {
        let error = resin.check().unwrap_err();
        assert_eq!(matches!(error, QuantityError::BadTime { .. }), is_time);
    }
}
