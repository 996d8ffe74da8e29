//! Print files of every format, by whichever program, and files that are none.

use cusp_slicer::Options;
use cusp_slicer::archive::read::{LayerFault, PrintFileError};
use cusp_slicer::format::Format;
use cusp_slicer::simulation::{Knowledge, Placement, SimulationError, simulate};
use glam::Vec3;
use std::ops::ControlFlow;

use super::{by_hand, error, measured, original, png_of, slice, uniform, unzipped, zipped};
use crate::common::assert_near;
use crate::common::solids::{Triangles, cube, cuboid, moved};

/// A block with a smaller one on its left end, and one at its back: no mirror image of it is itself.
fn steps() -> Triangles {
    [
        cuboid(Vec3::new(4.0, 3.0, 1.0)),
        moved(&cuboid(Vec3::new(1.0, 3.0, 0.5)), Vec3::Z),
        moved(&cuboid(Vec3::new(4.0, 1.0, 0.5)), Vec3::new(0.0, 2.0, 1.5)),
    ]
    .concat()
}

/// Returns true if the middle of a layer of [`steps`] is inside at a point relative to the middle of its box.
fn in_steps(x: f64, y: f64, z: f64) -> bool {
    let (x, y) = (x + 2.0, y + 1.5);
    let is_within = (0.0..4.0).contains(&x) && (0.0..3.0).contains(&y);
    is_within && (z < 1.0 || z < 1.5 && x < 1.0 || z > 1.5 && y > 2.0)
}

#[test]
fn every_format_says_where_its_pixels_are() {
    for format in [Format::Png, Format::Chitubox, Format::Uvj, Format::Sl1] {
        for (mirror, pixels) in [(false, [301, 150]), (true, [301, 150]), (true, [150, 180])] {
            let options = Options {
                format: Some(format),
                mirror: Some(mirror),
                pixels: Some(pixels),
                pitch_y_mm: Some(0.04),
                ..uniform(0.1, 0.03)
            };
            let file = slice(&steps(), &options);
            // UVJ does not say whether masks are mirrored.
            let says = format != Format::Uvj;
            let knowledge = Knowledge {
                is_mirrored: (!says).then_some(mirror),
                ..Knowledge::default()
            };
            let found = measured(&steps(), &file, &knowledge);
            assert_eq!((found.format, found.pixels), (format, pixels));
            assert_near(found.pixel_mm[0], 0.03, 1e-6);
            assert_near(found.pixel_mm[1], 0.04, 1e-6);
            let placement = match format {
                Format::Png => Placement::Stated,
                _ => Placement::Centre,
            };
            assert_eq!(found.placement, placement);
            let most = found.half_pixel_diagonal_mm + 1e-5;
            assert!(found.print_to_model.max_mm <= most, "{format:?} {mirror}");
            assert!(found.model_to_print.max_mm <= most, "{format:?} {mirror}");
            let wrong = Knowledge {
                is_mirrored: Some(!mirror),
                ..knowledge
            };
            let found = measured(&steps(), &file, &wrong);
            assert!(found.print_to_model.max_mm > 0.4, "{format:?} {mirror}");
        }
    }
}

/// An SL1 file as PrusaSlicer 2.5 writes it: what its reader needs, and the masks as its rasteriser orients them, for
/// which the plate's pixel whose corner of smallest coordinates is at `[x, y]` · 0.05 mm is lit if `is_lit` says so of its
/// middle. The plate is 8 × 6 mm.
fn by_prusa_slicer(
    is_portrait: bool,
    mirror: [bool; 2],
    is_lit: impl Fn(f64, f64, f64) -> bool,
) -> Vec<u8> {
    const PITCH: f64 = 0.05;
    // The display lies lengthwise; a portrait printer's x is along its short side.
    let (long, short) = (160, 120);
    let config = "action = print\nexpTime = 7.5\nexpTimeFirst = 35\nfileCreationTimestamp = 2022-10-01 at 12:00:00 UTC\n\
                  hollow = 0\njobDir = steps\nlayerHeight = 0.1\nmaterialName = Prusa Orange Tough\nnumFade = 10\n\
                  numFast = 17\nnumSlow = 2\nprintProfile = 0.1 Normal\nprintTime = 212.5\nprinterModel = SL1\n\
                  printerProfile = Original Prusa SL1\nprinterVariant = default\nprusaSlicerVersion = PrusaSlicer-2.5.0\n\
                  usedMaterial = 0.01\n";
    let slicer = format!(
        "absolute_correction = 0\ndisplay_height = {}\ndisplay_mirror_x = {}\ndisplay_mirror_y = {}\n\
         display_orientation = {}\ndisplay_pixels_x = {long}\ndisplay_pixels_y = {short}\ndisplay_width = {}\n\
         initial_layer_height = 0.2\nlayer_height = 0.1\nprinter_technology = SLA\n",
        f64::from(short) * PITCH,
        u8::from(mirror[0]),
        u8::from(mirror[1]),
        if is_portrait { "portrait" } else { "landscape" },
        f64::from(long) * PITCH,
    );
    let (width, height) = if is_portrait {
        (short, long)
    } else {
        (long, short)
    };
    let mut files = vec![
        ("config.ini".to_owned(), config.into()),
        ("prusaslicer.ini".to_owned(), slicer.into()),
        (
            "thumbnail/thumbnail400x400.png".to_owned(),
            png_of(4, 4, |_, _| 255),
        ),
    ];
    for layer in 0..19u32 {
        let z = match layer {
            0 => 0.1,
            later => 0.2 + (f64::from(later) - 0.5) * 0.1,
        };
        let mask = png_of(width, height, |column, row| {
            // RasterBase::Trafo: exchanged first, then mirrored; rows count from the top.
            let mirror_x = mirror[0] != is_portrait;
            let column = if mirror_x { width - 1 - column } else { column };
            let up = if mirror[1] { row } else { height - 1 - row };
            let (x, y) = if is_portrait {
                (up, column)
            } else {
                (column, up)
            };
            let (bed_x, bed_y) = if is_portrait {
                (height, width)
            } else {
                (width, height)
            };
            let middle =
                |place: u32, side: u32| (f64::from(place) + 0.5 - f64::from(side) / 2.0) * PITCH;
            u8::from(is_lit(middle(x, bed_x), middle(y, bed_y), z)) * 255
        });
        files.push((format!("steps{layer:05}.png"), mask));
    }
    zipped(&files)
}

#[test]
fn files_of_prusa_slicer_are_turned_and_mirrored_back() {
    for is_portrait in [false, true] {
        for mirror in [[false, false], [true, false], [false, true], [true, true]] {
            let file = by_prusa_slicer(is_portrait, mirror, in_steps);
            let found = measured(&steps(), &file, &Knowledge::default());
            assert_eq!((found.format, found.layers), (Format::Sl1, 19));
            assert_near(found.height_mm, 2.0, 1e-9);
            let most = found.half_pixel_diagonal_mm + 1e-5;
            assert!(
                found.print_to_model.max_mm <= most,
                "{is_portrait} {mirror:?}"
            );
            assert!(
                found.model_to_print.max_mm <= most,
                "{is_portrait} {mirror:?}"
            );
        }
    }
}

#[test]
fn a_model_beside_the_plates_centre_is_found_by_its_lit_pixels() {
    let beside = |x: f64, y: f64, z: f64| in_steps(x - 1.0, y + 0.5, z);
    let file = by_prusa_slicer(false, [true, false], beside);
    let found = measured(&steps(), &file, &Knowledge::default());
    assert_eq!(found.placement, Placement::LitPixels);
    assert_near(found.offset_mm[0], -1.0, 1e-9);
    assert_near(found.offset_mm[1], 0.5, 1e-9);
    assert!(found.print_to_model.max_mm <= found.half_pixel_diagonal_mm + 1e-5);
}

#[test]
fn one_pixel_too_many_is_found() {
    let tops: Vec<f64> = (1..=10).map(|layer| f64::from(layer) / 10.0).collect();
    let is_cube = |column, row| (5..15).contains(&column) && (5..15).contains(&row);
    for (brightness, expected) in [
        (255, 0.5 * 2f64.sqrt()),
        (128, 0.5 * 2f64.sqrt()),
        (127, 0.0),
    ] {
        let file = by_hand([20, 20], [0.1, 0.1], &tops, |layer, column, row| {
            match (layer, column, row) {
                (6, 0, 0) => brightness,
                _ => u8::from(is_cube(column, row)) * 255,
            }
        });
        let found = measured(&cube(1.0), &file, &Knowledge::default());
        assert_near(found.print_to_model.max_mm, expected, 1e-6);
        assert_near(found.model_to_print.max_mm, 0.0, 1e-6);
        if expected > 0.0 {
            let [x, y, z] = found.print_to_model.at_mm;
            assert_eq!([x, y], [-1.0, 1.0]);
            assert!((0.6..=0.7).contains(&z));
            assert!(found.print_to_model.layers[5].max_mm.unwrap() < 1e-6);
        }
    }
}

/// The fault of a mask.
fn fault(error: SimulationError) -> LayerFault {
    match error {
        SimulationError::File(PrintFileError::Layer { fault, .. }) => fault,
        error => panic!("{error}"),
    }
}

#[test]
fn bad_files_are_errors_that_say_what_is_wrong() {
    let tops = [0.5, 1.0];
    let file = by_hand([4, 4], [0.5, 0.5], &tops, |_, _, _| 255);
    let model = cube(2.0);
    assert!(matches!(
        error(&model, b"no zip"),
        SimulationError::File(PrintFileError::UnknownKind)
    ));
    let other = zipped(&[("readme.txt".to_owned(), b"hello".to_vec())]);
    assert!(matches!(
        error(&model, &other),
        SimulationError::File(PrintFileError::UnknownZip)
    ));
    let mut files = unzipped(&file);
    let last = files.pop().unwrap();
    assert!(matches!(
        fault(error(&model, &zipped(&files))),
        LayerFault::MissingMask { name } if name == "1.png"
    ));
    files.push((last.0.clone(), last.1[..40].to_vec()));
    assert!(matches!(
        fault(error(&model, &zipped(&files))),
        LayerFault::BadMask { .. }
    ));
    files.pop();
    files.push((last.0, png_of(5, 4, |_, _| 255)));
    assert!(matches!(
        fault(error(&model, &zipped(&files))),
        LayerFault::MaskSize { width: 5, .. }
    ));
    let sunken = by_hand([4, 4], [0.5, 0.5], &[0.5, 0.4], |_, _, _| 255);
    assert!(matches!(
        error(&model, &sunken),
        SimulationError::ZOrder { layer: 2, .. }
    ));
    let black = by_hand([4, 4], [0.5, 0.5], &tops, |_, _, _| 127);
    assert!(matches!(error(&model, &black), SimulationError::AllBlack));
    let empty = by_hand([4, 4], [0.5, 0.5], &[], |_, _, _| 127);
    assert!(matches!(error(&model, &empty), SimulationError::AllBlack));
    let mut stop = |_: f64| ControlFlow::Break(());
    let stopped = simulate(&[original(&model)], &file, &Knowledge::default(), &mut stop);
    assert!(matches!(stopped, Err(SimulationError::Cancelled(_))));
}
