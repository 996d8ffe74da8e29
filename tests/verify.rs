//! Submitted plans are verified by planning again: an honest one passes, and any false value is found. Also previews and
//! rotations.

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::job::{
    Backend, Claim, Job, JobOptions, LoadedModel, ModelOptions, Options, Placement, Planner,
    Report, VerifyError,
};
use cusp_slicer::prepare::Supporting;
use cusp_slicer::profile::Metric;
use glam::Vec3;
use serde_json::{Value, json};

fn options() -> Options {
    Options {
        rays: 203,
        rotation: Some([0.1, -0.2, 0.05, 1.0]),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn planned(triangles: &solids::Triangles, options: &Options) -> (Slicer, Report) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let report = pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
    let report = report.clone();
    (slicer, report)
}

/// Plans again with the submitted options, and compares.
fn verify(sent: &Value, triangles: &solids::Triangles) -> Result<(), VerifyError> {
    let mut job = Job::new(vec![LoadedModel::read(&binary_stl(triangles)).unwrap()]);
    let file = job.models()[0].model_file().clone();
    let claims = Claim::read(&sent.to_string(), &[&file])?;
    let made = pollster::block_on(claims[0].plan_again(&mut job, &mut quiet)).unwrap();
    claims[0].check(made)
}

#[test]
fn an_honest_plan_passes_and_a_lie_anywhere_is_found() {
    let model = solids::sphere(3.0, 4);
    let (_, report) = planned(&model, &options());
    let honest = serde_json::to_value(&report).unwrap();
    assert_eq!(verify(&honest, &model), Ok(()));

    // As a browser prints it: whole numbers without a decimal point, no absent options, other timings.
    let text = honest.to_string().replace(".0,", ",").replace(".0]", "]");
    let mut browsers: Value = serde_json::from_str(&text).unwrap();
    browsers["timings_ms"]["ldi"] = json!(123.0);
    browsers["backend"] = json!("gpu");
    browsers["warnings"] = json!([]);
    let options = browsers["options"].as_object_mut().unwrap();
    options.retain(|_, value| !value.is_null());
    assert_eq!(verify(&browsers, &model), Ok(()));

    let differs = |change: &dyn Fn(&mut Value)| {
        let mut sent = honest.clone();
        change(&mut sent);
        match verify(&sent, &model) {
            Err(VerifyError::Differs { key, .. } | VerifyError::Contradicts { key }) => key,
            other => panic!("{other:?}"),
        }
    };
    let key = differs(&|sent| sent["z_mm"][5] = json!(sent["z_mm"][5].as_f64().unwrap() + 1e-12));
    assert_eq!(key, "z_mm[5]");
    assert_eq!(
        differs(&|sent| sent["print_time_s"] = json!(1.0)),
        "print_time_s"
    );
    assert_eq!(differs(&|sent| sent["resin_ml"] = json!(0.01)), "resin_ml");
    assert_eq!(
        differs(&|sent| sent["mask"]["width"] = json!(7)),
        "mask.width"
    );
    let key = differs(&|sent| _ = sent.as_object_mut().unwrap().remove("exposure_s"));
    assert_eq!(key, "exposure_s");
    // Other options give another plan.
    let key = differs(&|sent| sent["options"]["layer_max_mm"] = json!(0.1));
    assert!(!key.is_empty());
}

#[test]
fn what_is_no_plan_of_this_model_is_refused() {
    let model = solids::sphere(3.0, 4);
    let (_, report) = planned(&model, &options());
    let honest = serde_json::to_value(&report).unwrap();
    assert!(matches!(
        verify(&json!({"layers": 3}), &model),
        Err(VerifyError::NotAPlan { .. })
    ));
    let mut later = honest.clone();
    later["schema"] = json!(7);
    assert_eq!(
        verify(&later, &model),
        Err(VerifyError::OtherSchema { found: 7 })
    );
    let other = verify(&honest, &solids::sphere(3.1, 4));
    assert!(
        matches!(other, Err(VerifyError::OtherModel { .. })),
        "{other:?}"
    );
    let mut slack = honest;
    slack["options"]["no_such_option"] = json!(1);
    assert!(matches!(
        verify(&slack, &model),
        Err(VerifyError::NotAPlan { .. })
    ));
}

#[test]
fn a_plate_is_verified_without_the_models_of_others() {
    // By its own height, which the other plate does not state, the bar fits the printer.
    let bar = solids::cuboid(Vec3::new(40.0, 40.0, 300.0));
    let files = [bar, solids::sphere(3.0, 3)].map(|it| binary_stl(&it));
    let models = || {
        Job::new(
            files
                .each_ref()
                .map(|it| LoadedModel::read(it).unwrap())
                .into(),
        )
    };
    let printer = json!({
        "pixels": [400, 300], "pitch_um": [100, 100], "volume_mm": [40, 30, 50], "step_mm": 0.01
    });
    let options = JobOptions {
        options: Options {
            printer: Some(serde_json::from_value(printer).unwrap()),
            supports: Some(Supporting::default()),
            ..Options::default()
        },
        models: [Some(10.0), None]
            .map(|height_mm| ModelOptions {
                height_mm,
                ..ModelOptions::default()
            })
            .into(),
        placements: [0, 1]
            .map(|model| Placement {
                model,
                plate: model,
                ..Placement::MIDDLE
            })
            .into(),
        ..JobOptions::default()
    };
    let mut job = models();
    let report = pollster::block_on(job.plan(&options, &mut quiet)).unwrap();
    let identities = job.models().iter().map(LoadedModel::model_file);
    let text = serde_json::to_string(&report).unwrap();
    for claim in Claim::read(&text, &identities.collect::<Vec<_>>()).unwrap() {
        let mut again = models();
        let made = pollster::block_on(claim.plan_again(&mut again, &mut quiet)).unwrap();
        assert_eq!(claim.check(made), Ok(()));
    }
}

#[test]
fn a_plan_that_breaks_its_tolerance_does_not_pass() {
    let model = solids::sphere(3.0, 4);
    let coarse = Options {
        planner: Planner::Uniform { layer_mm: 0.15 },
        tolerance: Some(0.06),
        rotation: None,
        ..options()
    };
    let (_, report) = planned(&model, &coarse);
    let sent = serde_json::to_value(&report).unwrap();
    let verdict = verify(&sent, &model);
    assert!(
        matches!(verdict, Err(VerifyError::ToleranceExceeded { .. })),
        "{verdict:?}"
    );
}

#[test]
fn a_preview_is_the_plan_where_no_facet_is_hidden() {
    let single = ["cube", "sphere", "cylinder", "cone", "inverted sphere"];
    for (name, triangles) in solids::all() {
        let (mut slicer, _) = planned(&triangles, &options());
        let hides_facets = !single.contains(&name);
        for metric in Metric::ALL {
            for rotation in [None, options().rotation] {
                let options = Options {
                    metric,
                    rotation,
                    ..options()
                };
                let (preview, profile) = slicer.preview(&options).unwrap();
                let report = pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
                assert_eq!(preview.z_mm.len(), preview.layers + 1);
                assert_near(preview.size_mm[2], report.height_mm, 1e-6);
                if !hides_facets {
                    assert_eq!(
                        preview.z_mm, report.z_mm,
                        "{name}, {metric:?}, {rotation:?}"
                    );
                    assert_eq!(preview.max_error, report.max_error);
                    assert_eq!(preview.print_time_s, report.print_time_s);
                    let source = report.source;
                    assert_eq!(profile, slicer.profile(metric, source).unwrap());
                }
            }
        }
    }
}

#[test]
fn a_rotation_turns_the_model() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let brick = solids::cuboid(glam::Vec3::new(3.0, 4.0, 5.0));
    // 90° about x by a quaternion of length 3, 90° about y, and 180° about y.
    for (rotation, size_mm) in [
        ([3.0 * half, 0.0, 0.0, 3.0 * half], [3.0, 5.0, 4.0]),
        ([0.0, half, 0.0, half], [5.0, 4.0, 3.0]),
        ([0.0, 1.0, 0.0, 0.0], [3.0, 4.0, 5.0]),
    ] {
        let options = Options {
            rotation: Some(rotation),
            ..options()
        };
        let (slicer, report) = planned(&brick, &options);
        let (preview, _) = slicer.preview(&options).unwrap();
        for (found, expected) in preview.size_mm.into_iter().zip(size_mm) {
            assert_near(found, expected, 1e-6);
        }
        assert_near(report.resin_ml, 0.06, 1e-3);
    }
    // An upside-down cone has the layers of an upright one in reverse.
    let cone = solids::cone(3.0, 6.0, 30);
    let upright = Options {
        rotation: None,
        ..options()
    };
    let on_its_head = Options {
        rotation: Some([1.0, 0.0, 0.0, 0.0]),
        ..options()
    };
    let (_, first) = planned(&cone, &upright);
    let (_, second) = planned(&cone, &on_its_head);
    assert_eq!(first.layers, second.layers);
    assert_eq!(first.max_error, second.max_error);
    for bad in [[0.0; 4], [f64::NAN, 0.0, 0.0, 1.0]] {
        let options = Options {
            rotation: Some(bad),
            ..options()
        };
        let slicer = Slicer::load(&binary_stl(&cone)).unwrap();
        let error = slicer.preview(&options).unwrap_err();
        assert_eq!(error.code(), "bad-rotation");
    }
}
