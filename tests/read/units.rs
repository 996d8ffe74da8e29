//! Units of files that state none, and that a model is the same whatever its format.

use std::io::Cursor;

use crate::common::Slicer;
use cusp_slicer::job::{Options, Report};
use cusp_slicer::model::{ModelUnit, Pose};
use cusp_slicer::orientation::SearchOptions;
use cusp_slicer::warning::{UnitReading, Warning};
use glam::Vec3;

use super::obj::obj;
use super::package;
use crate::common::{binary_stl, quiet, solids};

fn options() -> Options {
    Options {
        rays: 64,
        ..Options::default()
    }
}

fn in_inches() -> Options {
    Options {
        unit: Some(ModelUnit::Inch),
        ..options()
    }
}

fn scaled(triangles: &[[Vec3; 3]], by: f32) -> Vec<[Vec3; 3]> {
    let corners = triangles.iter();
    corners
        .map(|corners| corners.map(|corner| corner * by))
        .collect()
}

fn plan(bytes: &[u8], options: &Options) -> (Slicer, Report) {
    let mut slicer = Slicer::load(bytes).unwrap();
    let report = pollster::block_on(slicer.plan(options, &mut quiet))
        .unwrap()
        .clone();
    (slicer, report)
}

/// The files of a print file but for its manifest, with their names.
fn print_file(slicer: &mut Slicer) -> Vec<(String, Vec<u8>)> {
    let bytes = slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut files = Vec::new();
    for place in 0..zip.len() {
        let mut file = zip.by_index(place).unwrap();
        let mut bytes = Vec::new();
        std::io::copy(&mut file, &mut bytes).unwrap();
        files.push((file.name().unwrap().into_owned(), bytes));
    }
    files.retain(|(name, _)| name != "manifest.json");
    assert!(files.len() > 10);
    files
}

#[test]
fn the_same_model_as_stl_obj_and_3mf_gives_the_same_plan_and_masks() {
    for (name, triangles) in solids::all() {
        let (mut stl, from_stl) = plan(&binary_stl(&triangles), &options());
        let theirs = [obj(&triangles).into_bytes(), package::of(&triangles)];
        for bytes in theirs {
            let (mut slicer, mut report) = plan(&bytes, &options());
            report.models[0].file.clone_from(&from_stl.models[0].file);
            report.timings_ms = from_stl.timings_ms.clone();
            assert_eq!(report, from_stl, "{name}");
            for layer in 0..report.layers {
                assert_eq!(
                    slicer.mask(layer).unwrap(),
                    stl.mask(layer).unwrap(),
                    "{name}"
                );
            }
            // The manifest has the identity of the model.
            let (ours, other) = (print_file(&mut slicer), print_file(&mut stl));
            assert!(ours == other, "{name}");
        }
    }
}

#[test]
fn a_unit_scales_a_model_that_states_none() {
    let small = solids::sphere(0.4, 4);
    // A power of two is exact, an inch is not.
    let (_, metric) = plan(&binary_stl(&scaled(&small, 25.4)), &options());
    for bytes in [binary_stl(&small), obj(&small).into_bytes()] {
        let (slicer, report) = plan(&bytes, &in_inches());
        assert_eq!(report.layers, metric.layers);
        assert!((report.height_mm - metric.height_mm).abs() < 1e-4);
        assert_eq!(report.options.unit, Some(ModelUnit::Inch));
        let (preview, _) = slicer.preview(&in_inches()).unwrap();
        assert!((preview.size_mm[2] - metric.height_mm).abs() < 1e-4);
        let pose = Pose {
            unit: Some(ModelUnit::Inch),
            ..Pose::default()
        };
        let highest = slicer
            .positions_on_plate(&pose)
            .unwrap()
            .into_iter()
            .skip(2)
            .step_by(3)
            .fold(0.0, f32::max);
        assert!((f64::from(highest) - metric.height_mm).abs() < 1e-4);
    }
}

#[test]
fn a_height_beats_a_unit() {
    let ball = binary_stl(&solids::sphere(0.4, 4));
    let high = Options {
        height_mm: Some(12.0),
        ..options()
    };
    let (_, one) = plan(&ball, &high);
    let (_, other) = plan(
        &ball,
        &Options {
            unit: Some(ModelUnit::Inch),
            ..high
        },
    );
    assert_eq!(one.z_mm, other.z_mm);
    assert!(one.all_warnings().is_empty(), "{:?}", one.all_warnings());
}

#[test]
fn searches_know_the_unit() {
    let part = solids::cuboid(Vec3::new(0.5, 1.0, 0.25));
    let search = SearchOptions {
        directions: 20,
        ..SearchOptions::default()
    };
    let found = |triangles: &[[Vec3; 3]], options: &Options| {
        let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
        slicer.orient(options, &search, &mut quiet).unwrap()
    };
    let metric = found(&scaled(&part, 25.4), &options());
    let inches = found(&part, &in_inches());
    assert_eq!(metric.best.len(), inches.best.len());
    for (one, other) in metric.best.iter().zip(&inches.best) {
        let [one, other] = [one, other].map(|it| it.metrics.as_ref().unwrap().layers);
        assert_eq!(one, other);
    }
}

#[test]
fn a_file_that_states_its_unit_ignores_another() {
    let bytes = package::of(&solids::sphere(4.0, 3));
    let (slicer, given) = plan(&bytes, &in_inches());
    let (_, mut plain) = plan(&bytes, &options());
    assert_eq!(slicer.info().unit, Some(ModelUnit::Millimeter));
    let warning = Warning::UnitStated {
        stated: ModelUnit::Millimeter,
        given: ModelUnit::Inch,
    };
    assert_eq!(given.all_warnings(), [warning]);
    assert_eq!(plain.all_warnings(), []);
    plain.models[0]
        .warnings
        .clone_from(&given.models[0].warnings);
    plain.timings_ms = given.timings_ms.clone();
    assert_eq!(plain, given);
}

#[test]
fn odd_sizes_without_a_unit_are_asked_about() {
    let odd = |side: f32| {
        let slicer = Slicer::load(&binary_stl(&solids::cube(side))).unwrap();
        let warnings = slicer.info().warnings;
        assert!(warnings.len() < 2);
        match warnings.into_iter().next() {
            Some(Warning::OddSize { readings, .. }) => Some(readings),
            None => None,
            other => panic!("{other:?}"),
        }
    };
    let reading = |unit, size_mm| UnitReading { unit, size_mm };
    let small = [
        reading(ModelUnit::Inch, 12.7),
        reading(ModelUnit::Centimeter, 5.0),
        reading(ModelUnit::Meter, 500.0),
    ];
    assert_eq!(odd(0.5), Some(small.to_vec()));
    let tiny = [
        reading(ModelUnit::Inch, 1.27),
        reading(ModelUnit::Meter, 50.0),
    ];
    assert_eq!(odd(0.05), Some(tiny.to_vec()));
    assert_eq!(odd(30_000.0), Some(vec![reading(ModelUnit::Micron, 30.0)]));
    assert_eq!((odd(1.0), odd(100.0)), (None, None));
    assert_eq!(odd(900.0), Some(Vec::new()));
    // 3MF states its unit, so that it is meant.
    let stated = Slicer::load(&package::of(&solids::cube(0.5))).unwrap();
    assert_eq!(stated.info().warnings, []);
    // Neither is there a doubt once the unit is given.
    let mut slicer = Slicer::load(&binary_stl(&solids::cube(0.5))).unwrap();
    let warnings = |slicer: &mut Slicer, options: &Options| {
        let report = pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
        report
            .all_warnings()
            .iter()
            .any(|it| matches!(it, Warning::OddSize { .. }))
    };
    assert!(warnings(&mut slicer, &options()));
    assert!(!warnings(&mut slicer, &in_inches()));
}

#[test]
fn options_without_a_unit_are_written_as_before_there_was_one() {
    let text = serde_json::to_string(&options()).unwrap();
    assert!(!text.contains("unit"), "{text}");
    let text = serde_json::to_string(&in_inches()).unwrap();
    assert!(text.contains("\"unit\":\"inch\""), "{text}");
    assert_eq!(serde_json::from_str::<Options>(&text).unwrap(), in_inches());
}
