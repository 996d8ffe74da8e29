//! GOO, from its description.

use cusp_slicer::archive::read::{FileFinding, LayerFault, PrintFileError};
use cusp_slicer::format::Format;

use super::{Blank, error, inspected, only_fault, open, pixels, warnings};

/// A layer: its top and its chunks.
pub type Layer = (f32, Vec<u8>);

/// The data of chunks: 0x55, chunks, and the complement of their sum.
fn data(chunks: &[u8]) -> Vec<u8> {
    let sum = chunks.iter().map(|&byte| u32::from(byte)).sum::<u32>() as u8;
    [&[0x55], chunks, &[!sum]].concat()
}

/// A file of 6 × 4 pixels of 0.02 × 0.03 mm.
fn blank(is_big_endian: bool, layers: &[Layer]) -> Blank {
    let mut file = Blank::new(195_477, is_big_endian);
    let magic = [0x07, 0, 0, 0, 0x44, 0x4C, 0x50, 0];
    file.text(0, "V3.0").text(4, magic).text(12, "Slicer");
    file.text(44, "1.2").text(92, "Printer").text(156, "Grey");
    // The first pixel of the small preview is red, of the large one green.
    file.u16(194, 0xF800).u16(27_108, 0x07E0);
    file.text(27_106, [0x0D, 0x0A]).text(195_308, [0x0D, 0x0A]);
    file.u32(195_310, layers.len() as u32);
    file.u16(195_314, 6).u16(195_316, 4).u8(195_318, 1);
    file.f32(195_320, 0.12)
        .f32(195_324, 0.12)
        .f32(195_328, 150.0);
    file.f32(195_332, 0.05).f32(195_336, 2.5).u8(195_340, 1);
    file.f32(195_369, 30.0).u32(195_373, 1).u8(195_445, 1);
    file.u32(195_446, 3600)
        .f32(195_450, 1500.0)
        .f32(195_454, 1.65);
    file.u32(195_470, 195_477).u8(195_474, 1).u16(195_475, 5);
    for (z_mm, chunks) in layers {
        let at = file.grow(70);
        file.f32(at + 6, *z_mm).f32(at + 10, 2.75);
        file.f32(at + 18, 0.25).f32(at + 22, 0.5).f32(at + 26, 1.5);
        file.f32(at + 30, 3.0).f32(at + 34, 65.0).f32(at + 38, 4.0);
        file.f32(at + 50, 150.0).text(at + 64, [0x0D, 0x0A]);
        let data = data(chunks);
        file.u32(at + 66, data.len() as u32);
        file.add(&data);
        file.add(&[0x0D, 0x0A]);
    }
    file.add(&[0, 0, 0]);
    file.add(&magic);
    file
}

pub fn goo(layers: &[Layer]) -> Vec<u8> {
    blank(true, layers).bytes
}

/// All 24 pixels of one kind, in a chunk of two bytes.
fn all(kind: u8) -> Vec<u8> {
    vec![kind << 6 | 0x18, 1]
}

#[test]
fn a_file_says_what_its_header_says() {
    for is_big_endian in [true, false] {
        let layers = [(0.05, all(3)), (0.1, all(3)), (0.2, all(3))];
        let file = blank(is_big_endian, &layers).bytes;
        let file = open(&file);
        let metadata = file.metadata();
        assert_eq!(metadata.format, Format::Goo);
        assert_eq!(metadata.version.as_deref(), Some("V3.0"));
        assert_eq!(metadata.software.as_deref(), Some("Slicer 1.2"));
        assert_eq!(metadata.printer.as_deref(), Some("Printer"));
        assert_eq!(metadata.resin.as_deref(), Some("Grey"));
        assert_eq!((metadata.pixels, metadata.pixel_mm), ([6, 4], [0.02, 0.03]));
        assert_eq!(metadata.plate_mm, [0.12, 0.12, 150.0].map(Some));
        assert_eq!(metadata.is_mirrored_x, Some(true));
        assert_eq!(metadata.is_mirrored_y, Some(false));
        assert_eq!(metadata.layer_mm, Some(0.05));
        assert_eq!(metadata.exposure_s, Some(2.5));
        assert_eq!(metadata.bottom_exposure_s, Some(30.0));
        assert_eq!(
            (metadata.bottom_layers, metadata.transition_layers),
            (Some(1), Some(5))
        );
        assert_eq!(metadata.print_time_s, Some(3600.0));
        assert_eq!(
            (metadata.volume_ml, metadata.weight_g),
            (Some(1.5), Some(1.65))
        );
        assert_eq!(metadata.uses_layer_values, Some(true));
        let tops: Vec<f64> = file.layers().iter().map(|layer| layer.z_mm).collect();
        assert_eq!(tops, [0.05, 0.1, 0.2]);
        let layer = file.layers()[2];
        assert_eq!((layer.thickness_mm, layer.exposure_s), (0.1, Some(2.75)));
        assert_eq!(layer.wait_before_lift_s, Some(0.25));
        assert_eq!(layer.wait_after_lift_s, Some(0.5));
        assert_eq!(layer.wait_before_exposure_s, Some(1.5));
        assert_eq!((layer.lift_mm, layer.lift_mm_min), (Some(7.0), Some(65.0)));
        assert_eq!(layer.retract_mm_min, Some(150.0));
        let [large, small] = [0, 1].map(|place| file.preview(place).unwrap());
        assert_eq!((large.width, large.height, small.width), (290, 290, 116));
        assert_eq!(
            (&large.rgb[..4], &small.rgb[..4]),
            (&[0, 255, 0, 0][..], &[255, 0, 0, 0][..])
        );
    }
}

#[test]
fn the_weight_tells_the_unit_of_the_volume() {
    let mut file = blank(true, &[(0.05, all(3))]);
    file.f32(195_450, 1.5);
    assert_eq!(open(&file.bytes).metadata().volume_ml, Some(1.5));
    file.f32(195_450, 1500.0).f32(195_454, 0.0);
    assert_eq!(open(&file.bytes).metadata().volume_ml, Some(1.5));
}

#[test]
fn chunks_of_every_kind_and_length_are_decoded() {
    let chunks = [
        // Two black, three of grey 100, the length in the chunk.
        &[0x02, 0x43, 100][..],
        // Add 7 for one pixel; subtract 15 for two; add 3 for four.
        &[0x87, 0xBF, 2, 0x93, 4],
        // One white, the length with one more byte; ten white with two; one grey of 1 with three.
        &[0xD1, 0, 0xEA, 0, 0, 0x71, 1, 0, 0, 0],
    ];
    let file = goo(&[(0.05, chunks.concat())]);
    let expected = [
        &[0; 2][..],
        &[100; 3],
        &[107],
        &[92; 2],
        &[95; 4],
        &[255; 11],
        &[1],
    ];
    assert_eq!(pixels(&open(&file), 0), expected.concat());
}

#[test]
fn long_runs_take_bytes_for_their_length() {
    let mut file = blank(true, &[(0.05, vec![0x3F, 0x12, 0x34, 0x56, 0xC1])]);
    let black = 0xF + 16 * 0x12_3456;
    file.u16(195_314, 1).u16(195_316, 1);
    let too_many = LayerFault::TooManyPixels { expected: 1 };
    assert_eq!(only_fault(&file.bytes), (1, too_many));
    file.u16(195_314, 3904).u16(195_316, 4890);
    let expected = 3904 * 4890;
    let pixels = black + 1;
    assert_eq!(
        only_fault(&file.bytes),
        (1, LayerFault::TooFewPixels { pixels, expected })
    );
}

#[test]
fn greys_of_files_without_grey_scale_go_to_15() {
    let mut file = blank(
        true,
        &[(0.05, vec![0x42, 1, 0x42, 8, 0x42, 15, 0xC2, 0x10, 1])],
    );
    file.u8(195_474, 0);
    let expected = [&[17; 2][..], &[136; 2], &[255; 4], &[0; 16]];
    assert_eq!(pixels(&open(&file.bytes), 0), expected.concat());
}

#[test]
fn black_layers_and_single_pixels_are_told_apart() {
    // The last pixel of the last layer.
    let last = vec![0x17, 1, 0xC1];
    let file = goo(&[(0.05, all(0)), (0.1, all(0)), (0.15, last)]);
    let found = inspected(&file);
    let lit: Vec<_> = found
        .layer_values
        .iter()
        .map(|layer| layer.lit_pixels)
        .collect();
    assert_eq!(lit, [Some(0), Some(0), Some(1)]);
    let black = FileFinding::BlackLayers {
        layers: 2,
        first_layer: 1,
        from_mm: 0.0,
    };
    assert_eq!(found.warnings, [black]);
    let expected = [&[0; 23][..], &[255]].concat();
    assert_eq!(pixels(&open(&file), 2), expected);
    let volume_ml = 0.02 * 0.03 * 0.05 / 1000.0;
    assert!((found.lit_volume_ml - volume_ml).abs() < 1e-12);
}

#[test]
fn data_that_is_not_what_was_written_is_found() {
    let good = [(0.05, all(3)), (0.1, all(3))];
    assert_eq!(warnings(&goo(&good)), []);
    let mut changed = goo(&good);
    // The second layer's second byte of its chunk: 24 white pixels become 8.
    let layer = 195_477 + 70 + 4 + 2;
    changed[layer + 70 + 2] = 0;
    let fault = LayerFault::WrongChecksum {
        stated: !(0xD8u8.wrapping_add(1)),
        computed: !0xD8,
    };
    assert_eq!(only_fault(&changed), (2, fault));
    let missing = goo(&[(0.05, all(3)), (0.1, vec![0xC5])]);
    let fault = LayerFault::TooFewPixels {
        pixels: 5,
        expected: 24,
    };
    assert_eq!(only_fault(&missing), (2, fault));
    let excess = goo(&[(0.05, [all(3), vec![0x01]].concat())]);
    assert_eq!(
        only_fault(&excess),
        (1, LayerFault::TooManyPixels { expected: 24 })
    );
    // A length without its byte; a difference beyond white.
    let cut = goo(&[(0.05, vec![0xD8])]);
    assert_eq!(only_fault(&cut), (1, LayerFault::BadRun { byte: 1 }));
    let beyond = goo(&[(0.05, vec![0xC1, 0x81])]);
    assert_eq!(only_fault(&beyond), (1, LayerFault::BadRun { byte: 1 }));
}

#[test]
fn layers_are_closed_by_their_marks_and_the_file_by_its_end() {
    let mut file = goo(&[(0.05, all(3)), (0.1, all(3))]);
    let end = file.len() - 1;
    file[end] = 1;
    assert_eq!(warnings(&file), [FileFinding::MissingEnd]);
    file[end] = 0;
    file[195_477 + 64] = 0;
    let marks = FileFinding::MissingMarks {
        layers: 1,
        first_layer: 1,
    };
    assert_eq!(warnings(&file), [marks]);
}

#[test]
fn heights_that_do_not_rise_are_found() {
    let file = goo(&[(0.0, all(3)), (0.1, all(3)), (0.1, all(3)), (0.05, all(3))]);
    let below = FileFinding::FirstLayerBelowPlate { z_mm: 0.0 };
    let still = FileFinding::HeightsNotAscending {
        layers: 2,
        first_layer: 3,
        z_mm: 0.1,
        below_mm: 0.1,
    };
    assert_eq!(warnings(&file), [below, still]);
}

#[test]
fn thicknesses_that_do_not_count_are_found() {
    let mut file = blank(true, &[(0.05, all(3)), (0.1, all(3)), (0.2, all(3))]);
    assert_eq!(warnings(&file.bytes), []);
    file.u8(195_445, 0);
    let ignored = FileFinding::IgnoredHeights {
        thinnest_mm: 0.05,
        thickest_mm: 0.1,
        layer_mm: Some(0.05),
    };
    assert_eq!(warnings(&file.bytes), [ignored]);
    let mut uniform = blank(true, &[(0.05, all(3)), (0.1, all(3)), (0.151, all(3))]);
    uniform.u8(195_445, 0);
    assert_eq!(warnings(&uniform.bytes), []);
}

#[test]
fn what_cannot_be_read_says_why() {
    let file = goo(&[(0.05, all(3))]);
    let mut other = file.clone();
    other[1] = b'1';
    let version = "V1.0".to_owned();
    assert!(
        matches!(error(&other), PrintFileError::UnknownVersion { version: found, .. } if found == version)
    );
    let mut many = Blank {
        bytes: file.clone(),
        is_big_endian: true,
    };
    many.u32(195_310, u32::MAX);
    let error_of = |file: &Blank| error(&file.bytes);
    assert_eq!(
        error_of(&many),
        PrintFileError::TooManyLayers {
            layers: u32::MAX.into(),
            most: 1
        }
    );
    many.u32(195_310, 1).u16(195_314, 0);
    assert!(matches!(error_of(&many), PrintFileError::BadSetting { .. }));
    many.u16(195_314, 40_000);
    assert!(matches!(
        error_of(&many),
        PrintFileError::TooManyPixels { width: 40_000, .. }
    ));
    many.u16(195_314, 6).u32(195_470, 0x2_FAB7);
    assert!(matches!(error_of(&many), PrintFileError::BadSetting { .. }));
    // By its name the file is little-endian, and then says other things.
    let mut named = blank(false, &[(0.05, all(3))]);
    named.u32(195_470, 0).text(92, "ELEGOO Jupiter 2");
    assert_eq!(open(&named.bytes).metadata().pixels, [6, 4]);
}

#[test]
fn heights_and_exposures_that_are_no_numbers_are_found() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut file = blank(true, &[(0.05, all(3)), (value, all(3)), (0.15, all(3))]);
        let heights = FileFinding::BadHeights {
            layers: 1,
            first_layer: 2,
        };
        assert_eq!(warnings(&file.bytes), std::slice::from_ref(&heights));
        assert_eq!(inspected(&file.bytes).height_mm, 0.15);
        // The first layer's exposure, and a nominal value.
        file.f32(195_477 + 10, value).f32(195_369, value);
        let exposures = FileFinding::BadExposures {
            layers: 1,
            first_layer: 1,
        };
        let found = inspected(&file.bytes);
        let expected = [heights, FileFinding::BadNominalValues, exposures];
        assert_eq!(found.warnings, expected);
        assert_eq!(found.metadata.bottom_exposure_s, None);
        assert_eq!(found.exposure_range_s, Some([2.75, 2.75]));
        assert_eq!(found.thickness_range_mm, Some([0.05, 0.05]));
    }
}
