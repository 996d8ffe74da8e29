//! CTB, from its description.

use cusp_slicer::archive::read::{FileFinding, LayerFault, PrintFileError, UnreadKind};
use cusp_slicer::format::Format;

use super::{Blank, error, inspected, only_fault, open, pixels, warnings};

/// A file of 5 × 3 pixels of 0.04 mm: the top and the data of each layer, scrambled if `key` is not 0.
fn blank(version: u32, key: u32, layers: &[(f32, Vec<u8>)]) -> Blank {
    let mut file = Blank::new(112, false);
    let magic = if version < 4 {
        0x12FD_0086
    } else {
        0x12FD_0106
    };
    file.u32(0, magic).u32(4, version);
    file.f32(8, 0.2).f32(12, 0.12).f32(16, 160.0);
    file.f32(0x20, 0.05).f32(0x24, 2.5).f32(0x28, 25.0);
    file.u32(0x30, 2).u32(0x34, 5).u32(0x38, 3);
    file.u32(0x44, layers.len() as u32)
        .u32(0x4C, 600)
        .u32(0x50, 1);
    file.u32(0x64, key);
    for (record, pixel) in [(0x3C, 0xF81F), (0x48, 0x001F)] {
        let at = file.grow(32);
        // Three pixels of one colour as a run, and a green one: 2 × 2.
        let words: [u16; 3] = [pixel | 0x20, 0x3002, 0x07C0];
        let data: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let start = file.add(&data);
        file.u32(at, 2).u32(at + 4, 2).u32(at + 8, start as u32);
        file.u32(at + 12, data.len() as u32).u32(record, at as u32);
    }
    let parameters = file.grow(60);
    file.u32(0x54, parameters as u32).u32(0x58, 60);
    file.f32(parameters + 0x14, 12.5)
        .f32(parameters + 0x18, 13.75);
    let slicer = file.grow(76);
    file.u32(0x68, slicer as u32).u32(0x6C, 76);
    let name = file.add(b"Some Printer");
    file.u32(slicer + 0x1C, name as u32).u32(slicer + 0x20, 12);
    file.u8(slicer + 0x27, 16 * version as u8)
        .u32(slicer + 0x3C, 6);
    if version >= 5 {
        let parameters = file.grow(464);
        file.u32(slicer + 0x40, parameters as u32);
        let resin = file.grow(40);
        file.u32(parameters + 0x50, resin as u32);
        let (kind, name) = (file.add(b"ABS"), file.add(b"Grey"));
        file.u32(resin + 0xC, 3).u32(resin + 0x10, kind as u32);
        file.u32(resin + 0x14, 4).u32(resin + 0x18, name as u32);
    }
    let table = file.grow(36 * layers.len());
    file.u32(0x40, table as u32);
    for (layer, (z_mm, data)) in layers.iter().enumerate() {
        let row = table + 36 * layer;
        let before = if version >= 3 { 84 } else { 0 };
        let at = file.grow(before);
        let start = file.add(&scrambled(key, layer as u32, data)) as u32;
        file.f32(row, *z_mm).f32(row + 4, 2.25).f32(row + 8, 0.75);
        file.u32(row + 12, start).u32(row + 16, data.len() as u32);
        file.u32(row + 24, if before > 0 { 84 } else { 36 });
        if before > 0 {
            file.f32(at + 0x28, 5.0).f32(at + 0x2C, 60.0);
            file.f32(at + 0x30, 2.0).f32(at + 0x38, 180.0);
            file.f32(at + 0x44, 0.25)
                .f32(at + 0x48, 0.5)
                .f32(at + 0x4C, 1.25);
        }
    }
    file
}

pub fn ctb(version: u32, key: u32, layers: &[(f32, Vec<u8>)]) -> Vec<u8> {
    blank(version, key, layers).bytes
}

/// Data as a file with this key has it, byte by byte.
fn scrambled(key: u32, layer: u32, data: &[u8]) -> Vec<u8> {
    if key == 0 {
        return data.to_vec();
    }
    let a = key.wrapping_mul(0x2D83_CDAC).wrapping_add(0xD8A8_3423);
    let first = layer.wrapping_mul(0x1E15_30CD).wrapping_add(0xEC3D_47CD);
    let first = first.wrapping_mul(a);
    let mask = |byte: usize| {
        let word = first.wrapping_add(a.wrapping_mul((byte / 4) as u32));
        (word >> (8 * (byte % 4))) as u8
    };
    data.iter()
        .enumerate()
        .map(|(place, byte)| byte ^ mask(place))
        .collect()
}

/// All 15 pixels white.
pub fn white() -> Vec<u8> {
    vec![0xFF, 15]
}

#[test]
fn a_file_says_what_its_tables_say() {
    for version in 2..=5 {
        let file = ctb(version, 0, &[(0.05, white()), (0.15, white())]);
        let file = open(&file);
        let metadata = file.metadata();
        assert_eq!(metadata.format, Format::Ctb);
        assert_eq!(metadata.version, Some(version.to_string()));
        assert_eq!(metadata.printer.as_deref(), Some("Some Printer"));
        let resin = (version == 5).then_some("ABS Grey");
        assert_eq!(metadata.resin.as_deref(), resin);
        assert_eq!((metadata.pixels, metadata.pixel_mm), ([5, 3], [0.04, 0.04]));
        assert_eq!(metadata.plate_mm, [0.2, 0.12, 160.0].map(Some));
        assert_eq!(metadata.is_mirrored_x, Some(true));
        assert_eq!(
            (metadata.layer_mm, metadata.exposure_s),
            (Some(0.05), Some(2.5))
        );
        assert_eq!(metadata.bottom_exposure_s, Some(25.0));
        assert_eq!(
            (metadata.bottom_layers, metadata.transition_layers),
            (Some(2), Some(6))
        );
        assert_eq!(metadata.print_time_s, Some(600.0));
        assert_eq!(
            (metadata.volume_ml, metadata.weight_g),
            (Some(12.5), Some(13.75))
        );
        assert_eq!(metadata.uses_layer_values, Some(true));
        let layer = file.layers()[1];
        assert_eq!((layer.z_mm, layer.thickness_mm), (0.15, 0.1));
        assert_eq!(layer.exposure_s, Some(2.25));
        if version == 2 {
            assert_eq!(layer.wait_before_exposure_s, Some(0.75));
            assert_eq!(layer.lift_mm, None);
        } else {
            assert_eq!(layer.wait_before_exposure_s, Some(1.25));
            assert_eq!(layer.wait_before_lift_s, Some(0.25));
            assert_eq!(layer.wait_after_lift_s, Some(0.5));
            // From version 4 on the first number is the sum.
            let lift_mm = if version == 3 { 7.0 } else { 5.0 };
            assert_eq!(layer.lift_mm, Some(lift_mm));
            assert_eq!(layer.lift_mm_min, Some(60.0));
            assert_eq!(layer.retract_mm_min, Some(180.0));
        }
        let [large, small] = [0, 1].map(|place| file.preview(place).unwrap());
        assert_eq!([large.width, large.height], [2, 2]);
        assert_eq!(
            large.rgb,
            [255, 0, 255, 255, 0, 255, 255, 0, 255, 0, 255, 0]
        );
        assert_eq!(small.rgb[..3], [0, 0, 255]);
    }
}

#[test]
fn runs_of_every_length_are_decoded() {
    // One black, one of the darkest grey, three of grey 64, a white run with a length of two bytes.
    let data = vec![0x00, 0x01, 0xC0, 3, 0xFF, 0x80, 10];
    let file = ctb(3, 0, &[(0.05, data)]);
    let expected = [&[0, 3][..], &[129; 3], &[255; 10]].concat();
    assert_eq!(pixels(&open(&file), 0), expected);

    let lengths: [(&[u8], u32); 4] = [
        (&[0x7F], 127),
        (&[0xBF, 0xFF], 16_383),
        (&[0xDF, 0xFF, 0xFF], 2_097_151),
        (&[0xE1, 0x02, 0x03, 0x04], 0x0102_0304),
    ];
    for (length, count) in lengths {
        let mut file = blank(3, 0, &[(0.05, [&[0x80], length].concat())]);
        file.u32(0x34, 32_768).u32(0x38, 1024);
        let fault = LayerFault::TooFewPixels {
            pixels: count.into(),
            expected: 1 << 25,
        };
        assert_eq!(only_fault(&file.bytes), (1, fault));
    }
    let beyond = ctb(3, 0, &[(0.05, vec![0x80, 0xF0, 0, 0, 0, 0])]);
    assert_eq!(only_fault(&beyond), (1, LayerFault::BadRun { byte: 1 }));
    let cut = ctb(3, 0, &[(0.05, vec![0x80, 0xBF])]);
    assert_eq!(only_fault(&cut), (1, LayerFault::BadRun { byte: 2 }));
}

#[test]
fn scrambled_layers_are_restored() {
    for key in [1, 0x1234_5678, u32::MAX] {
        // Longer than a word, so that the key moves on; and the same in each layer, so that it depends on the layer.
        let data: Vec<u8> = (0..15).map(|pixel| 8 * pixel + 1).collect();
        let expected: Vec<u8> = data.iter().map(|grey| 2 * grey + 1).collect();
        let file = ctb(
            3,
            key,
            &[(0.05, data.clone()), (0.1, data.clone()), (0.15, data)],
        );
        assert_eq!(warnings(&file), []);
        for layer in 0..3 {
            assert_eq!(pixels(&open(&file), layer), expected);
        }
    }
}

#[test]
fn a_black_layer_and_one_without_data_are_told_apart() {
    let last = [&[0x80, 14][..], &[0x7F]].concat();
    let file = ctb(3, 7, &[(0.05, vec![0x80, 15]), (0.1, vec![]), (0.15, last)]);
    let found = inspected(&file);
    let lit: Vec<_> = found
        .layer_values
        .iter()
        .map(|layer| layer.lit_pixels)
        .collect();
    assert_eq!(lit, [Some(0), None, Some(1)]);
    let black = FileFinding::BlackLayers {
        layers: 1,
        first_layer: 1,
        from_mm: 0.0,
    };
    let fault = LayerFault::TooFewPixels {
        pixels: 0,
        expected: 15,
    };
    let bad = FileFinding::BadLayers {
        layers: 1,
        first_layer: 2,
        fault,
    };
    assert_eq!(found.warnings, [black, bad]);
}

#[test]
fn layers_beyond_the_end_are_found() {
    let file = ctb(3, 0, &[(0.05, white()), (0.1, white())]);
    let length = file.len() as u64;
    let fault = LayerFault::OutsideFile {
        end_byte: length,
        file_bytes: length - 1,
    };
    assert_eq!(only_fault(&file[..file.len() - 1]), (2, fault));
    // In another page of 4 GiB.
    let mut paged = blank(3, 0, &[(0.05, white())]);
    let table = u32::from_le_bytes(paged.bytes[0x40..0x44].try_into().unwrap());
    paged.u32(table as usize + 20, 1);
    assert!(matches!(
        only_fault(&paged.bytes),
        (
            1,
            LayerFault::OutsideFile {
                end_byte: 0x1_0000_0000..,
                ..
            }
        )
    ));
}

#[test]
fn files_of_other_kinds_say_what_they_are() {
    let mut file = blank(3, 0, &[(0.05, white())]);
    file.u32(0, 0x12FD_0107);
    assert_eq!(error(&file.bytes), PrintFileError::EncryptedCtb);
    file.u32(0, 0x12FD_0019);
    let kind = UnreadKind::Cbddlp;
    assert_eq!(error(&file.bytes), PrintFileError::Unread { kind });
    file.u32(0, 0x12FD_0086).u32(4, 6);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::UnknownVersion { .. }
    ));
    file.u32(4, 3).u32(0x44, u32::MAX);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::TooManyLayers { .. }
    ));
    file.u32(0x44, 1).u32(0x40, u32::MAX);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::Truncated { .. }
    ));
}

#[test]
fn exposures_that_are_no_numbers_are_found() {
    let mut file = blank(3, 0, &[(0.05, white()), (0.1, white())]);
    let table = u32::from_le_bytes(file.bytes[0x40..0x44].try_into().unwrap()) as usize;
    file.f32(table + 36 + 4, f32::INFINITY);
    let exposures = FileFinding::BadExposures {
        layers: 1,
        first_layer: 2,
    };
    assert_eq!(warnings(&file.bytes), std::slice::from_ref(&exposures));
    file.f32(0x20, f32::NAN);
    let expected = [FileFinding::BadNominalValues, exposures];
    assert_eq!(warnings(&file.bytes), expected);
}
