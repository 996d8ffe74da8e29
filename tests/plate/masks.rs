//! Masks of plates: those of the models alone, moved.

use std::io::Cursor;

use cusp_slicer::format::Format;
use cusp_slicer::job::{JobOptions, ModelOptions, Options, Placement};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::printer::PrinterChoice;

use super::{job, options, pixels, plan, plate, supported};
use crate::common::{load, quiet, solids};
use cusp_slicer::job::{Error, OptionsError};
use cusp_slicer::model::FacetClass;
use cusp_slicer::prepare::{SupportPoint, Supporting};
use glam::Vec3;

/// The print file of a plate.
fn archive(plate: &mut cusp_slicer::job::Job, number: usize) -> Vec<u8> {
    let (writer, _) = plate
        .write_archive(number, Cursor::new(Vec::new()), &mut quiet)
        .unwrap();
    writer.into_inner()
}

#[test]
fn a_plate_of_one_is_byte_for_byte_what_the_model_alone_gives() {
    let ball = solids::sphere(4.0, 3);
    let saturn = |format| Options {
        printer: Some(PrinterChoice::Named("saturn-3-ultra".to_owned())),
        format: Some(format),
        height_mm: Some(3.0),
        ..Options::default()
    };
    let cases = [
        options(),
        Options {
            antialias: 4,
            rotation: Some([0.1, 0.2, 0.3, 0.9]),
            ..options()
        },
        saturn(Format::Goo),
        saturn(Format::Chitubox),
        // They reach farther on one side.
        Options {
            rotation: Some([0.1, 0.2, 0.3, 0.9]),
            ..supported()
        },
    ];
    for options in cases {
        let mut alone = load(&ball);
        pollster::block_on(alone.plan(&options, &mut quiet)).unwrap();
        let (expected, _) = alone
            .write_archive(Cursor::new(Vec::new()), &mut quiet)
            .unwrap();
        let mut one = plate(&[&ball]);
        let report = plan(&mut one, &job(options.clone(), &[1])).unwrap();
        assert_eq!(report.plates[0].placements, [Placement::MIDDLE]);
        assert!(archive(&mut one, 0) == expected.into_inner(), "{options:?}");
    }
}

#[test]
fn turned_copies_have_the_same_supports() {
    let bar = solids::cuboid(Vec3::new(12.0, 3.0, 2.0));
    let mut several = plate(&[&bar]);
    let at = |x_mm, turn_deg| Placement {
        model: 0,
        plate: 0,
        x_mm,
        y_mm: 0.0,
        turn_deg,
    };
    let options = JobOptions {
        placements: vec![at(-9.0, 0), at(4.0, 45), at(14.0, 90)],
        ..job(supported(), &[3])
    };
    let report = plan(&mut several, &options).unwrap().plates.remove(0);
    let on_plate = report.models[0].supported.clone().unwrap();
    let mut slicer = load(&bar);
    let alone = pollster::block_on(slicer.plan(&supported(), &mut quiet))
        .unwrap()
        .clone();
    let of_one = alone.models[0].supported.as_ref().unwrap();
    assert!((on_plate.support_ml / of_one.support_ml - 1.0).abs() < 0.02);
    assert_eq!(on_plate.lift_mm, 3.0);
    assert_eq!(report.z_mm, alone.z_mm);
    // The supports that are drawn of each copy.
    let shown = slicer.positions_of(FacetClass::Support);
    assert!(!shown.is_empty());
    assert_eq!(several.positions_of(0, FacetClass::Support).unwrap(), shown);
    assert!(several.positions_of(1, FacetClass::Support).is_err());
    // By hand they are in the frame of the model, and copies follow.
    let by_hand = |points: &[SupportPoint]| Options {
        supports: Some(Supporting {
            points: Some(points.to_vec()),
            ..supported().supports.unwrap()
        }),
        ..supported()
    };
    let few = &of_one.points[..2];
    let turned = JobOptions {
        options: by_hand(few),
        ..options
    };
    let report = plan(&mut several, &turned).unwrap().plates.remove(0);
    let at = |points: &[SupportPoint]| points.iter().map(|it| it.at_mm).collect::<Vec<_>>();
    assert_eq!(
        at(&report.models[0].supported.as_ref().unwrap().points),
        at(few)
    );
    // Of several models each has its own.
    let ball = solids::sphere(3.0, 3);
    let mut both = plate(&[&bar, &ball]);
    let refused = plan(&mut both, &job(by_hand(few), &[1, 1])).unwrap_err();
    assert_eq!(
        refused.to_string(),
        Error::from(OptionsError::Contradictory {
            option: "points",
            other: "models"
        })
        .to_string()
    );
    let mut own = job(super::options(), &[2, 1]);
    own.models[0].supports = by_hand(few).supports;
    let report = plan(&mut both, &own).unwrap().plates.remove(0);
    let [bar, ball] = &report.models[..] else {
        panic!("{report:?}");
    };
    assert_eq!(at(&bar.supported.as_ref().unwrap().points), at(few));
    assert_eq!(ball.supported, None);
    assert_eq!(
        [bar.size_mm[2], ball.size_mm[2]].map(f64::round),
        [2.0, 6.0]
    );
}

#[test]
fn what_the_only_model_says_of_itself_counts_like_an_option() {
    let cone = solids::cone(4.0, 6.0, 8);
    let range = HeightRange {
        from_mm: 1.0,
        to_mm: 2.0,
        layer_min_mm: 0.05,
        layer_max_mm: 0.05,
    };
    let of_model = JobOptions {
        options: options(),
        models: vec![ModelOptions {
            height_mm: Some(5.0),
            tolerance: Some(0.05),
            ranges: vec![range],
            ..ModelOptions::default()
        }],
        ..JobOptions::default()
    };
    let of_options = Options {
        height_mm: Some(5.0),
        tolerance: Some(0.05),
        ranges: vec![range],
        ..options()
    };
    let mut first = plate(&[&cone]);
    let mut second = plate(&[&cone]);
    plan(&mut first, &of_model).unwrap();
    plan(&mut second, &job(of_options, &[])).unwrap();
    assert!(archive(&mut first, 0) == archive(&mut second, 0));
}

#[test]
fn the_masks_of_a_plate_are_those_of_its_models_moved_to_their_places() {
    let (ball, cone) = (solids::sphere(3.0, 3), solids::cone(3.0, 9.0, 8));
    let place = |model, x_mm, y_mm| Placement {
        model,
        plate: 0,
        x_mm,
        y_mm,
        turn_deg: 0,
    };
    for antialias in [1, 2] {
        let shared = Options {
            antialias,
            ..options()
        };
        let mut both = plate(&[&ball, &cone]);
        let placements = vec![
            place(0, -15.0, -10.0),
            place(0, 3.02, 4.0),
            place(1, 12.0, -7.3),
            place(0, -8.0, -10.0),
        ];
        let options = JobOptions {
            placements: placements.clone(),
            ..job(shared.clone(), &[3, 1])
        };
        let report = plan(&mut both, &options).unwrap();
        let [report] = &report.plates[..] else {
            panic!("one plate")
        };
        // Each model alone under the same planes: layers of fixed heights.
        let fixed = Options {
            planes_mm: report.z_mm[1..report.layers].to_vec(),
            layer_max_mm: Some(1.0),
            layer_min_mm: Some(0.002),
            tolerance: Some(100.0),
            bin_mm: Some(report.bin_mm),
            snap: cusp_slicer::job::Snap::Off,
            ..shared
        };
        let mut models = [load(&ball), load(&cone)];
        let heights_mm = [6.0, 9.0];
        for (model, height_mm) in models.iter_mut().zip(heights_mm) {
            let planes_mm = fixed.planes_mm.iter().copied();
            let own = Options {
                planes_mm: planes_mm.filter(|z_mm| *z_mm < height_mm - 1e-6).collect(),
                ..fixed.clone()
            };
            pollster::block_on(model.plan(&own, &mut quiet)).unwrap();
        }
        for layer in (0..report.layers).step_by(7).chain([report.layers - 1]) {
            let middle_mm = f64::midpoint(report.z_mm[layer], report.z_mm[layer + 1]);
            let mut expected = vec![vec![false; 400]; 300];
            for place in &placements {
                if middle_mm > heights_mm[place.model] {
                    continue;
                }
                let alone = pixels(&models[place.model].mask(layer).unwrap(), 400);
                let right = (place.x_mm / 0.1).round() as i64;
                let down = -(place.y_mm / 0.1).round() as i64;
                for (row, columns) in (0i64..).zip(&alone) {
                    for (column, _) in (0i64..).zip(columns).filter(|(_, lit)| **lit) {
                        let pixel = &mut expected[(row + down) as usize][(column + right) as usize];
                        assert!(!*pixel, "copies overlap");
                        *pixel = true;
                    }
                }
            }
            let found = pixels(&both.mask(0, layer).unwrap(), 400);
            assert!(found == expected, "layer {layer} of {antialias}");
        }
    }
}

#[test]
fn the_print_file_of_a_plate_has_the_masks_that_it_shows() {
    let (ball, frame) = (solids::sphere(3.0, 3), solids::frame());
    let own = |height_mm| ModelOptions {
        copies: 3,
        height_mm: Some(height_mm),
        ..ModelOptions::default()
    };
    for mirror in [false, true] {
        let mut both = plate(&[&ball, &frame]);
        let options = JobOptions {
            models: vec![own(4.0), own(3.0)],
            ..job(
                Options {
                    mirror: Some(mirror),
                    format: Some(Format::Png),
                    ..options()
                },
                &[],
            )
        };
        let report = plan(&mut both, &options).unwrap();
        assert_eq!(report.plates.len(), 1);
        let layers = report.plates[0].layers;
        let mut zip = zip::ZipArchive::new(Cursor::new(archive(&mut both, 0))).unwrap();
        for layer in 0..layers {
            let name = zip.name_for_index(layer).unwrap().unwrap().into_owned();
            let mut bytes = Vec::new();
            std::io::copy(&mut zip.by_name(&name).unwrap(), &mut bytes).unwrap();
            let decoder = png::Decoder::new(Cursor::new(bytes));
            let mut reader = decoder.read_info().unwrap();
            let mut image = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut image).unwrap();
            let mut found = pixels(&image, 400);
            if mirror {
                for row in &mut found {
                    row.reverse();
                }
            }
            assert!(
                found == pixels(&both.mask(0, layer).unwrap(), 400),
                "{name}"
            );
        }
    }
}
