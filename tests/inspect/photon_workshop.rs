//! Anycubic's binary file, from its description.

use cusp_slicer::archive::read::{FileFinding, LayerFault, PrintFileError, UnreadKind};
use cusp_slicer::format::Format;

use super::{Blank, error, inspected, only_fault, open, pixels, warnings};

/// Offsets of the tables of a file.
struct Tables {
    header: usize,
    machine: usize,
    layers: usize,
}

/// A file of 5 × 3 pixels: the thickness and the data of each layer.
fn blank(version: u32, layers: &[(f32, Vec<u8>)]) -> (Blank, Tables) {
    let place = match version {
        515 => 0,
        516 => 1,
        517 => 2,
        _ => 3,
    };
    let mut file = Blank::new([48, 52, 56, 64][place], false);
    file.text(0, "ANYCUBIC").u32(12, version);
    file.u32(16, [5, 8, 9, 11][place]);
    let length = [80, 84, 92, 96][place];
    let header = file.grow(16 + length as usize);
    file.u32(0x14, header as u32).text(header, "HEADER");
    file.u32(header + 12, length).f32(header + 0x10, 50.0);
    file.f32(header + 0x14, 0.05).f32(header + 0x18, 2.0);
    file.f32(header + 0x1C, 0.5).f32(header + 0x20, 28.0);
    file.f32(header + 0x24, 6.0).f32(header + 0x30, 3.0);
    file.f32(header + 0x34, 9.5).u32(header + 0x3C, 5);
    file.u32(header + 0x40, 3).f32(header + 0x44, 10.45);
    file.u32(header + 0x50, 1).u32(header + 0x54, 900);
    if version >= 516 {
        file.u32(header + 0x58, 8);
    }
    // Previews of 2 × 1 pixels: a red one and a blue one.
    for (slot, name) in [(0x1C, "PREVIEW"), (0x3C, "PREVIEW2")] {
        if slot == 0x1C || version == 518 {
            let at = file.grow(28 + 4);
            file.u32(slot, at as u32).text(at, name).u32(at + 12, 32);
            file.u32(at + 16, 2).u32(at + 24, 1);
            file.u16(at + 28, 0xF800).u16(at + 30, 0x001F);
        }
    }
    let machine = file.grow(if version == 518 { 224 } else { 156 });
    if version >= 516 {
        file.u32(0x2C, machine as u32).text(machine, "MACHINE");
        file.text(machine + 0x10, "Photon Something");
        file.text(machine + 0x70, "pw0Img");
        file.f32(machine + 0x88, 0.2).f32(machine + 0x8C, 0.09);
        file.f32(machine + 0x90, 200.0);
        if version == 518 {
            file.f32(machine + 0x9C, 39.0).f32(machine + 0xA0, 31.0);
        }
    }
    if version >= 517 {
        let at = file.grow(164);
        file.u32(0x18, at as u32).text(at, "Workshop");
        file.u32(at + 32, 164).text(at + 36, "3.1");
    }
    let table = file.grow(20 + 32 * layers.len());
    file.u32(0x24, table as u32).text(table, "LAYERDEF");
    file.u32(table + 12, 4 + 32 * layers.len() as u32);
    file.u32(table + 16, layers.len() as u32);
    for (layer, (thickness_mm, data)) in layers.iter().enumerate() {
        let start = file.add(data);
        let row = table + 20 + 32 * layer;
        file.u32(row, start as u32).u32(row + 4, data.len() as u32);
        file.f32(row + 8, 6.0)
            .f32(row + 12, 2.0)
            .f32(row + 16, 1.75);
        file.f32(row + 20, *thickness_mm).u32(row + 24, 15);
    }
    let tables = Tables {
        header,
        machine,
        layers: table,
    };
    (file, tables)
}

pub fn photon_workshop(version: u32, layers: &[(f32, Vec<u8>)]) -> Vec<u8> {
    blank(version, layers).0.bytes
}

/// All 15 pixels white.
pub fn white() -> Vec<u8> {
    vec![0xF0, 15]
}

#[test]
fn a_file_says_what_its_tables_say() {
    for version in 515..=518 {
        let file = photon_workshop(version, &[(0.05, white()), (0.1, white()), (0.05, white())]);
        let file = open(&file);
        let metadata = file.metadata();
        assert_eq!(metadata.format, Format::PhotonWorkshop);
        assert_eq!(metadata.version, Some(version.to_string()));
        assert_eq!(metadata.pixels, [5, 3]);
        let pixel_mm = match version {
            515 => [0.05, 0.05],
            518 => [0.039, 0.031],
            _ => [0.04, 0.03],
        };
        assert_eq!(metadata.pixel_mm, pixel_mm);
        let printer = (version > 515).then_some("Photon Something");
        assert_eq!(metadata.printer.as_deref(), printer);
        let software = (version > 516).then_some("Workshop 3.1");
        assert_eq!(metadata.software.as_deref(), software);
        assert_eq!(
            (metadata.layer_mm, metadata.exposure_s),
            (Some(0.05), Some(2.0))
        );
        assert_eq!(metadata.bottom_exposure_s, Some(28.0));
        assert_eq!(metadata.bottom_layers, Some(6));
        assert_eq!(metadata.transition_layers, (version > 515).then_some(8));
        assert_eq!(
            (metadata.volume_ml, metadata.weight_g),
            (Some(9.5), Some(10.45))
        );
        assert_eq!(metadata.print_time_s, Some(900.0));
        assert_eq!(metadata.uses_layer_values, Some(true));
        assert_eq!(metadata.is_mirrored_x, None);
        let tops: Vec<f64> = file.layers().iter().map(|layer| layer.z_mm).collect();
        assert_eq!(tops, [0.05, 0.15, 0.2]);
        let layer = file.layers()[1];
        assert_eq!((layer.thickness_mm, layer.exposure_s), (0.1, Some(1.75)));
        assert_eq!((layer.lift_mm, layer.lift_mm_min), (Some(6.0), Some(120.0)));
        assert_eq!(layer.retract_mm_min, Some(180.0));
        assert_eq!(layer.wait_before_exposure_s, Some(0.5));
        assert_eq!(layer.stated_lit_pixels, (version > 515).then_some(15));
        assert_eq!(file.previews(), if version == 518 { 2 } else { 1 });
        for place in 0..file.previews() {
            assert_eq!(file.preview(place).unwrap().rgb, [255, 0, 0, 0, 0, 255]);
        }
    }
}

#[test]
fn runs_of_four_bits_of_grey_are_decoded() {
    // Three black, two of grey 5, one of grey 14, nine white.
    let file = photon_workshop(516, &[(0.05, vec![0x00, 3, 0x52, 0xE1, 0xF0, 9])]);
    let expected = [&[0; 3][..], &[85; 2], &[238], &[255; 9]].concat();
    assert_eq!(pixels(&open(&file), 0), expected);

    let (mut long, tables) = blank(516, &[(0.05, vec![0x0A, 0xBC])]);
    long.u32(tables.header + 0x3C, 0xABC)
        .u32(tables.header + 0x40, 1);
    assert_eq!(pixels(&open(&long.bytes), 0), [0; 0xABC]);
}

#[test]
fn masks_of_the_wrong_length_are_found() {
    let files = [
        (
            vec![0xF0, 14],
            LayerFault::TooFewPixels {
                pixels: 14,
                expected: 15,
            },
        ),
        (vec![0xF0, 16], LayerFault::TooManyPixels { expected: 15 }),
        (vec![0xF0], LayerFault::BadRun { byte: 1 }),
        (
            vec![0xF0, 15, 0x51],
            LayerFault::TooManyPixels { expected: 15 },
        ),
    ];
    for (data, fault) in files {
        let file = photon_workshop(517, &[(0.05, white()), (0.05, data)]);
        assert_eq!(only_fault(&file), (2, fault));
    }
    // Very old files have a checksum after the last pixel.
    let old = photon_workshop(515, &[(0.05, vec![0xF0, 15, 0x12, 0x34])]);
    assert_eq!(warnings(&old), []);
    let file = photon_workshop(515, &[(0.05, white())]);
    let fault = LayerFault::OutsideFile {
        end_byte: file.len() as u64,
        file_bytes: file.len() as u64 - 1,
    };
    assert_eq!(only_fault(&file[..file.len() - 1]), (1, fault));
}

#[test]
fn black_layers_and_thicknesses_that_do_not_count_are_found() {
    let last = vec![0x00, 14, 0xF0, 1];
    let (mut file, tables) = blank(516, &[(0.05, vec![0x00, 15]), (0.1, last)]);
    file.u32(tables.header + 0x50, 0);
    let found = inspected(&file.bytes);
    let ignored = FileFinding::IgnoredHeights {
        thinnest_mm: 0.05,
        thickest_mm: 0.1,
        layer_mm: Some(0.05),
    };
    let black = FileFinding::BlackLayers {
        layers: 1,
        first_layer: 1,
        from_mm: 0.0,
    };
    assert_eq!(found.warnings, [ignored, black]);
    assert_eq!(found.layer_values[1].lit_pixels, Some(1));
}

#[test]
fn what_cannot_be_read_says_why() {
    let (mut file, tables) = blank(516, &[(0.05, white())]);
    let kind = UnreadKind::PlanesOfBits;
    file.text(tables.machine + 0x70, "pwsImg");
    assert_eq!(error(&file.bytes), PrintFileError::Unread { kind });
    file.u32(12, 1);
    assert_eq!(error(&file.bytes), PrintFileError::Unread { kind });
    file.u32(12, 519);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::UnknownVersion { .. }
    ));
    let (mut file, tables) = blank(516, &[(0.05, white())]);
    file.u32(tables.layers + 16, u32::MAX);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::TooManyLayers { .. }
    ));
    file.text(tables.layers, "LAYERS\0\0");
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::BadSetting { .. }
    ));
    file.u32(0x14, u32::MAX);
    assert!(matches!(
        error(&file.bytes),
        PrintFileError::Truncated { .. }
    ));
}

#[test]
fn thicknesses_and_exposures_that_are_no_numbers_are_found() {
    // Heights are sums of thicknesses, so all above are none either.
    let layers = [(0.05, white()), (f32::NAN, white()), (0.05, white())];
    let (mut file, tables) = blank(517, &layers);
    let heights = FileFinding::BadHeights {
        layers: 2,
        first_layer: 2,
    };
    assert_eq!(warnings(&file.bytes), std::slice::from_ref(&heights));
    file.f32(tables.layers + 20 + 16, f32::NAN)
        .f32(tables.header + 0x18, f32::INFINITY);
    let exposures = FileFinding::BadExposures {
        layers: 1,
        first_layer: 1,
    };
    let expected = [heights, FileFinding::BadNominalValues, exposures];
    assert_eq!(warnings(&file.bytes), expected);
}
