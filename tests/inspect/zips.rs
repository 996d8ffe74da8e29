//! Zips: NanoDLP and Anycubic from their descriptions, and the peculiarities of zips.

use cusp_slicer::archive::read::{FileFinding, LayerFault, PrintFileError, UnreadKind};
use cusp_slicer::format::Format;
use png::{BitDepth, ColorType};
use serde_json::{Value, json};

use super::{error, inspected, only_fault, open, pixels, warnings, zipped};

type File = (String, Vec<u8>);

fn png(pixels: [u32; 2], colour: ColorType, depth: BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, pixels[0], pixels[1]);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(bytes).unwrap();
    writer.finish().unwrap();
    png
}

fn of_json(name: &str, value: &Value) -> File {
    (name.to_owned(), value.to_string().into_bytes())
}

/// A file of 4 × 2 pixels, which are 2 × 2 coloured ones.
fn nanodlp_files(masks: &[Vec<u8>]) -> Vec<File> {
    let mut files = vec![
        of_json(
            "meta.json",
            &json!({ "FormatVersion": 2, "Program": "Slicer", "Version": "7" }),
        ),
        of_json(
            "plate.json",
            &json!({ "LayersCount": masks.len(), "PrintTime": 120, "MultiThickness": "" }),
        ),
        of_json(
            "profile.json",
            &json!({
                "Title": "Grey", "Depth": 50, "SupportDepth": 100, "CureTime": 2.5, "SupportCureTime": 20,
                "SupportLayerNumber": 1, "TransitionalLayer": 0, "WaitBeforePrint": 0.5,
            }),
        ),
        of_json(
            "options.json",
            &json!({
                "PWidth": 4, "PHeight": 2, "Thickness": 50, "XPixelSize": 0.019, "YPixelSize": 0.024,
                "XRes": 19, "YRes": 24, "ImageMirror": 1,
            }),
        ),
        (
            "3d.png".to_owned(),
            png([2, 1], ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]),
        ),
    ];
    for (layer, mask) in masks.iter().enumerate() {
        files.push((format!("{}.png", layer + 1), mask.clone()));
    }
    files
}

/// Masks of that file: the colours of 2 × 2 pixels, of which the last two of each row are beyond the screen.
fn coloured(rows: [[u8; 6]; 2]) -> Vec<u8> {
    png([2, 2], ColorType::Rgb, BitDepth::Eight, &rows.concat())
}

pub fn nanodlp() -> Vec<u8> {
    let masks = [
        coloured([[255, 0, 0, 0, 9, 9], [0, 127, 128, 1, 9, 9]]),
        coloured([[0, 0, 0, 0, 255, 255], [0; 6]]),
    ];
    zipped(&nanodlp_files(&masks))
}

#[test]
fn the_colours_of_nanodlp_are_pixels() {
    let file = nanodlp();
    let found = inspected(&file);
    let file = open(&file);
    let metadata = file.metadata();
    assert_eq!(metadata.format, Format::Nanodlp);
    assert_eq!(metadata.version.as_deref(), Some("2"));
    assert_eq!(metadata.software.as_deref(), Some("Slicer 7"));
    assert_eq!(metadata.resin.as_deref(), Some("Grey"));
    assert_eq!(
        (metadata.pixels, metadata.pixel_mm),
        ([4, 2], [0.019, 0.024])
    );
    assert_eq!(
        (metadata.layer_mm, metadata.bottom_layers),
        (Some(0.05), Some(1))
    );
    assert_eq!(metadata.print_time_s, Some(120.0));
    assert_eq!(metadata.is_mirrored_x, None);
    let tops: Vec<_> = file
        .layers()
        .iter()
        .map(|layer| (layer.z_mm, layer.exposure_s))
        .collect();
    assert_eq!(tops, [(0.1, Some(20.0)), (0.15, Some(2.5))]);
    assert_eq!(file.preview(0).unwrap().rgb, [1, 2, 3, 4, 5, 6]);
    assert_eq!(pixels(&file, 0), [255, 0, 0, 0, 0, 127, 128, 1]);
    // Pixels beyond the screen do not count.
    assert_eq!(pixels(&file, 1), [0; 8]);
    let lit: Vec<_> = found
        .layer_values
        .iter()
        .map(|layer| (layer.lit_pixels, layer.grey_pixels))
        .collect();
    assert_eq!(lit, [(Some(4), Some(3)), (Some(0), Some(0))]);
    let black = FileFinding::BlackLayers {
        layers: 1,
        first_layer: 2,
        from_mm: 0.1,
    };
    assert_eq!(found.warnings, [black]);
}

#[test]
fn nanodlp_takes_pngs_without_colours_and_with_alpha() {
    let grey = png(
        [2, 2],
        ColorType::Grayscale,
        BitDepth::Eight,
        &[255, 0, 7, 255],
    );
    let bits = png([2, 2], ColorType::Grayscale, BitDepth::One, &[0x40, 0x80]);
    let rgba = [255, 1, 2, 9, 3, 0, 0, 9, 0, 0, 0, 0, 4, 0, 0, 0];
    let rgba = png([2, 2], ColorType::Rgba, BitDepth::Eight, &rgba);
    let file = zipped(&nanodlp_files(&[grey, bits, rgba]));
    let file = open(&file);
    assert_eq!(pixels(&file, 0), [255, 255, 255, 0, 7, 7, 7, 255]);
    assert_eq!(pixels(&file, 1), [0, 0, 0, 255, 255, 255, 255, 0]);
    assert_eq!(pixels(&file, 2), [255, 1, 2, 3, 0, 0, 0, 4]);
}

#[test]
fn missing_and_odd_masks_are_found() {
    let masks = [coloured([[255; 6]; 2]), coloured([[255; 6]; 2])];
    let mut files = nanodlp_files(&masks);
    let wide = png([4, 2], ColorType::Grayscale, BitDepth::Eight, &[255; 8]);
    let (name, whole) = files.pop().unwrap();
    let fault = LayerFault::MissingMask { name: name.clone() };
    // The count is more than there are masks, not more than there are files.
    assert_eq!(only_fault(&zipped(&files)), (2, fault));
    for mask in [wide, whole[..50].to_vec(), Vec::new()] {
        let is_whole = mask.len() > 50;
        files.push((name.clone(), mask));
        let (layer, fault) = only_fault(&zipped(&files));
        files.pop();
        let is_it = match &fault {
            LayerFault::MaskSize { width, columns, .. } => is_whole && (*width, *columns) == (4, 2),
            LayerFault::BadMask { .. } => !is_whole,
            _ => false,
        };
        assert!(layer == 2 && is_it, "{fault}");
    }
}

#[test]
fn a_zip_holds_no_more_layers_than_files() {
    let mut files = nanodlp_files(&[]);
    files[1] = of_json("plate.json", &json!({ "LayersCount": 4_000_000_000_u32 }));
    assert!(matches!(
        error(&zipped(&files)),
        PrintFileError::TooManyLayers {
            layers: 4_000_000_000,
            most: 5
        }
    ));
    let config = "jobDir = a\nlayerHeight = 0.05\nnumFast = 4294967295\nnumSlow = 4294967295\n";
    let slicer =
        "display_pixels_x = 4\ndisplay_pixels_y = 2\ndisplay_width = 4\ndisplay_height = 2\n";
    let sl1 = [("config.ini", config), ("prusaslicer.ini", slicer)];
    let sl1 = sl1.map(|(name, text)| (name.to_owned(), text.into()));
    assert!(matches!(
        error(&zipped(&sl1)),
        PrintFileError::TooManyLayers {
            layers: 8_589_934_590,
            most: 2
        }
    ));
}

#[test]
fn a_mask_that_unpacks_to_more_than_it_can_be_is_not_unpacked() {
    // 100 kB of zeros take a hundred bytes.
    let mut files = nanodlp_files(&[vec![0; 100_000]]);
    let bomb = zipped(&files);
    assert!(
        matches!(only_fault(&bomb), (1, LayerFault::BadMask { system, .. }) if system.contains("more than"))
    );
    // An interlaced image of a thousand million pixels, of which nothing follows.
    let mut header = vec![0x89, b'P', b'N', b'G', 13, 10, 26, 10, 0, 0, 0, 13];
    header.extend(b"IHDR");
    header.extend([0, 0, 0x80, 0, 0, 0, 0x80, 0, 16, 6, 0, 0, 1]);
    let mut checksum = flate2::Crc::new();
    checksum.update(&header[12..]);
    header.extend(checksum.sum().to_be_bytes());
    header.extend([0, 0, 0, 1]);
    header.extend(b"IDAT\x78");
    let mut checksum = flate2::Crc::new();
    checksum.update(b"IDAT\x78");
    header.extend(checksum.sum().to_be_bytes());
    files[3] = of_json(
        "options.json",
        &json!({ "PWidth": 32_768, "PHeight": 32_768, "XPixelSize": 0.01, "YPixelSize": 0.01 }),
    );
    files.pop();
    let config = json!({
        "Properties": { "Size": { "X": 32_768, "Y": 32_768, "Millimeter": { "X": 300, "Y": 300 } } },
        "Layers": [{ "Z": 0.05 }],
    });
    let uvj = zipped(&[
        of_json("config.json", &config),
        ("slice/00000000.png".to_owned(), header),
    ]);
    assert!(
        matches!(only_fault(&uvj), (1, LayerFault::BadMask { system, .. }) if system.contains("too short"))
    );
}

/// A file of 5 × 2 pixels: bottom and thickness of each layer, and its data.
fn anycubic_files(layers: &[(f64, f64, Vec<u8>)]) -> Vec<File> {
    let resin = |name: &str, time: f64| {
        json!({
            "property": { "name": name, "density": 1.1 },
            "slice_extpara": { "transition_layercount": 8 },
            "slicepara": {
                "bott_layers": 5, "bott_time": 28, "exposure_time": time, "off_time": 0.5, "zthick": 0.05,
                "zdown_speed": 6, "use_indivi_layerpara": 1,
            },
        })
    };
    let machine = json!({
        "name": "Photon Seven", "key_suffix": "pm7", "key_image_format": "pw0Img", "res_x": 5, "res_y": 2,
        "xy_pixel": 16.8, "xy_pixel_y": 24.8, "print_xsize": 223.6, "print_ysize": 126.9, "print_zsize": 230,
    });
    let entries: Vec<Value> = layers
        .iter()
        .enumerate()
        .map(|(layer, (bottom, thickness, _))| {
            json!({
                "exposure_time": 1.5, "layer_index": layer, "layer_minheight": bottom,
                "layer_thickness": thickness, "zup_height": 5, "zup_speed": 3,
            })
        })
        .collect();
    let mut files = vec![
        of_json(
            "anycubic_photon_resins.pwsp",
            &json!({
                "version": "3", "machine_type": machine,
                "machine_extern": {
                    "factory_resins": [resin("Other", 9.0), resin("Grey", 2.0)],
                    "user_resins": [], "active_resins": "Grey",
                },
            }),
        ),
        of_json(
            "layers_controller.conf",
            &json!({ "count": layers.len(), "paras": entries }),
        ),
        of_json(
            "print_info.json",
            &json!({ "print_time": 777, "volume": 3.5, "weight": 3.85 }),
        ),
    ];
    for (layer, (_, _, data)) in layers.iter().enumerate() {
        files.push((format!("layer_images/layer_{layer}.pw0Img"), data.clone()));
    }
    files
}

pub fn anycubic() -> Vec<u8> {
    let layers = [
        (0.0, 0.05, vec![0xF0, 9, 0x51]),
        (0.05, 0.1, vec![0x00, 10]),
    ];
    zipped(&anycubic_files(&layers))
}

#[test]
fn a_zip_of_anycubic_says_everything_of_each_layer() {
    let file = anycubic();
    let black = FileFinding::BlackLayers {
        layers: 1,
        first_layer: 2,
        from_mm: 0.05,
    };
    assert_eq!(warnings(&file), [black]);
    let file = open(&file);
    let metadata = file.metadata();
    assert_eq!(metadata.format, Format::AnycubicZip);
    assert_eq!(metadata.printer.as_deref(), Some("Photon Seven"));
    assert_eq!(metadata.resin.as_deref(), Some("Grey"));
    assert_eq!(metadata.pixels, [5, 2]);
    assert_eq!(metadata.pixel_mm, [16.8 / 1000.0, 24.8 / 1000.0]);
    assert_eq!(metadata.plate_mm, [223.6, 126.9, 230.0].map(Some));
    assert_eq!(
        (metadata.exposure_s, metadata.bottom_exposure_s),
        (Some(2.0), Some(28.0))
    );
    assert_eq!(
        (metadata.bottom_layers, metadata.transition_layers),
        (Some(5), Some(8))
    );
    assert_eq!(metadata.print_time_s, Some(777.0));
    assert_eq!(
        (metadata.volume_ml, metadata.weight_g),
        (Some(3.5), Some(3.85))
    );
    assert_eq!(metadata.uses_layer_values, Some(true));
    let layer = file.layers()[1];
    assert_eq!((layer.z_mm, layer.thickness_mm), (0.15, 0.1));
    assert_eq!(layer.exposure_s, Some(1.5));
    assert_eq!((layer.lift_mm, layer.lift_mm_min), (Some(5.0), Some(180.0)));
    assert_eq!(layer.retract_mm_min, Some(360.0));
    assert_eq!(
        pixels(&file, 0),
        [255, 255, 255, 255, 255, 255, 255, 255, 255, 85]
    );
}

#[test]
fn outlines_of_anycubic_are_refused() {
    let mut files = anycubic_files(&[(0.0, 0.05, Vec::new())]);
    files[3].0 = "layer_images/layer_0.pwszImg".to_owned();
    let kind = UnreadKind::Outlines;
    assert_eq!(error(&zipped(&files)), PrintFileError::Unread { kind });
}
