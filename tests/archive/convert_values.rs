//! Heights and exposures of converted print files: noise, values that a header says are ignored, fades, and no numbers.

use std::fmt::Write as _;

use cusp_slicer::archive::read::{FileFinding, PrintFile, inspect};
use cusp_slicer::format::Format;
use cusp_slicer::job::Report;
use cusp_slicer::progress::silent;

use super::convert::{UNIFORM, assert_contains, convert, options, refusal, to, with_files};
use super::read_back::slice;
use crate::common::{assert_near, solids};

/// The formats whose header says whether values of layers count.
const FLAGGED: [Format; 4] = [
    Format::Goo,
    Format::Ctb,
    Format::PhotonWorkshop,
    Format::AnycubicZip,
];

/// A ball in layers of 0.1 mm.
fn ball(format: Format) -> (Vec<u8>, Report) {
    let (mut files, report) = slice(&solids::sphere(1.0, 4), &options(UNIFORM), &[format]);
    (files.swap_remove(0), report)
}

/// Offsets of the settings of each layer of a GOO.
fn goo_layers(goo: &[u8]) -> Vec<usize> {
    let number = |at: usize| u32::from_be_bytes(goo[at..at + 4].try_into().unwrap()) as usize;
    let mut at = 195_477;
    let mut layers = Vec::new();
    for _ in 0..number(195_310) {
        layers.push(at);
        at += 70 + number(at + 66) + 2;
    }
    layers
}

/// Offsets of the header of a Photon Workshop file, and of the settings of each layer.
fn photon_workshop_tables(file: &[u8]) -> (usize, Vec<usize>) {
    let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let table = number(0x24);
    let layers = (0..number(table + 16)).map(|layer| table + 20 + 32 * layer);
    (number(0x14), layers.collect())
}

fn put<const N: usize>(file: &mut [u8], at: usize, bytes: [u8; N]) {
    file[at..at + N].copy_from_slice(&bytes);
}

/// Noise from −1 to 1, the same every time.
fn noise(layer: usize) -> f64 {
    ((layer * 7 + 3) % 11) as f64 / 5.0 - 1.0
}

/// Converts to every format: all have layers of `layer_mm`, and none has values by layer.
fn assert_uniform(file: &[u8], layer_mm: f64, name: &str) {
    for format in Format::MASKS {
        let (converted, _) = convert(file, &to(format)).unwrap();
        let converted = PrintFile::open(&*converted).unwrap();
        for (below, layer) in converted.layers().iter().enumerate() {
            assert_near(layer.thickness_mm, layer_mm, 2e-6);
            // ChiTuBox's zip has heights in micrometres.
            let room_mm = if format == Format::Chitubox {
                5.1e-4
            } else {
                2e-6
            };
            assert_near(layer.z_mm, layer_mm * (below + 1) as f64, room_mm);
        }
        if FLAGGED.contains(&format) {
            let counts = converted.metadata().uses_layer_values;
            assert_eq!(counts, Some(false), "{name} to {format:?}");
        }
    }
}

#[test]
fn thicknesses_that_differ_by_a_micrometre_are_one() {
    let (clean, _) = ball(Format::PhotonWorkshop);
    let (header, layers) = photon_workshop_tables(&clean);
    for counts in [0u32, 1] {
        let mut noisy = clean.clone();
        put(&mut noisy, header + 0x50, counts.to_le_bytes());
        for (layer, &at) in layers.iter().enumerate() {
            let thickness_mm = 0.1 + 0.0005 * noise(layer);
            put(&mut noisy, at + 20, (thickness_mm as f32).to_le_bytes());
            // Exposures of half a millisecond more or less.
            let exposure_s = f32::from_le_bytes(noisy[at + 16..at + 20].try_into().unwrap());
            let exposure_s = exposure_s + 0.0004 * noise(layer) as f32;
            put(&mut noisy, at + 16, exposure_s.to_le_bytes());
        }
        assert_uniform(&noisy, 0.1, "thicknesses");
    }
    // 3 µm more are another thickness.
    let mut thicker = clean.clone();
    put(&mut thicker, layers[5] + 20, 0.103f32.to_le_bytes());
    for format in [Format::Sl1, Format::Nanodlp] {
        let refused = refusal(&thicker, &to(format));
        assert_contains(&refused, &["one thickness for all layers"]);
    }
}

#[test]
fn heights_a_micrometre_off_are_those_of_one_thickness() {
    let (clean, _) = ball(Format::Goo);
    for counts in [0, 1] {
        let mut noisy = clean.clone();
        noisy[195_445] = counts;
        for (layer, at) in goo_layers(&clean).into_iter().enumerate() {
            let z_mm = 0.1 * (layer + 1) as f64 + 0.0009 * noise(layer);
            put(&mut noisy, at + 6, (z_mm as f32).to_be_bytes());
        }
        assert_uniform(&noisy, 0.1, "heights");
    }
}

#[test]
fn a_thickness_between_micrometres_is_not_rounded_away() {
    // Heights in whole micrometres, and a header that would be 6 µm lower after 20 layers.
    let (mut file, report) = ball(Format::Goo);
    file[195_445] = 1;
    put(&mut file, 195_332, 0.033f32.to_be_bytes());
    let thickness_mm = 0.0333;
    let layers = goo_layers(&file);
    for (layer, at) in layers.iter().enumerate() {
        let z_mm = (thickness_mm * (layer + 1) as f64 * 1e3).round() / 1e3;
        put(&mut file, at + 6, (z_mm as f32).to_be_bytes());
    }
    for format in [Format::Sl1, Format::Ctb] {
        let (converted, _) = convert(&file, &to(format)).unwrap();
        let converted = PrintFile::open(&*converted).unwrap();
        let top_mm = converted.layers()[report.layers - 1].z_mm;
        assert_near(top_mm, thickness_mm * report.layers as f64, 1e-3);
    }
}

/// Exposure of the bottom layers of [`faded`] in seconds.
const BOTTOM_S: f64 = 15.0;
/// Exposure of the layers above the fade in seconds.
const USUAL_S: f64 = 10.0;
/// Number of layers of the fade.
const FADED: usize = 10;

/// An SL1 file as PrusaSlicer writes it, with a fade: three numbers say all exposures.
fn faded() -> Vec<u8> {
    let (file, _) = ball(Format::Sl1);
    with_files(&file, |name, contents| {
        if name != "config.ini" {
            return contents;
        }
        let mut changed = String::new();
        for line in String::from_utf8(contents).unwrap().lines() {
            let line = match line.split(" = ").next().unwrap() {
                "expTime" => format!("expTime = {USUAL_S}"),
                "expTimeFirst" => format!("expTimeFirst = {BOTTOM_S}"),
                "numFade" => format!("numFade = {FADED}"),
                _ => line.to_owned(),
            };
            writeln!(changed, "{line}").unwrap();
        }
        changed.into_bytes()
    })
}

/// Exposure of a layer of that file in seconds: three like the first, then a fade in equal steps.
fn faded_s(layer: usize) -> f64 {
    match layer {
        0..3 => BOTTOM_S,
        3..13 => BOTTOM_S + (USUAL_S - BOTTOM_S) * (layer - 2) as f64 / (FADED + 1) as f64,
        _ => USUAL_S,
    }
}

#[test]
fn a_fade_is_carried_over() {
    let file = faded();
    for format in Format::MASKS {
        let name = format.name();
        if format == Format::Nanodlp {
            let refused = refusal(&file, &to(format));
            assert_contains(
                &refused,
                &[name, "one exposure", "choose goo", "give a resin"],
            );
            continue;
        }
        let (converted, _) = convert(&file, &to(format)).unwrap();
        let print = PrintFile::open(&*converted).unwrap();
        let metadata = print.metadata();
        if format == Format::Sl1 || FLAGGED.contains(&format) {
            assert_eq!(metadata.transition_layers, Some(FADED as u32), "{name}");
            assert_near(metadata.exposure_s.unwrap(), USUAL_S, 1e-6);
            assert_near(metadata.bottom_exposure_s.unwrap(), BOTTOM_S, 1e-6);
            assert_eq!(metadata.bottom_layers, Some(3), "{name}");
        }
        if format != Format::Sl1 {
            for (place, layer) in print.layers().iter().enumerate() {
                assert_near(layer.exposure_s.unwrap(), faded_s(place), 6e-4);
            }
        }
        if FLAGGED.contains(&format) {
            assert_eq!(metadata.uses_layer_values, Some(false), "{name}");
        }
        // And back: three numbers again, whether the header or the layers say them.
        let (back, _) = convert(&converted, &to(Format::Sl1)).unwrap();
        let back = PrintFile::open(&*back).unwrap();
        assert_eq!(
            back.metadata().transition_layers,
            Some(FADED as u32),
            "{name}"
        );
        assert_near(back.metadata().exposure_s.unwrap(), USUAL_S, 1e-3);
        assert_near(back.metadata().bottom_exposure_s.unwrap(), BOTTOM_S, 1e-3);
    }
}

#[test]
fn exposures_that_are_no_fade_are_refused_or_kept() {
    let (mut file, _) = ball(Format::Goo);
    let layers = goo_layers(&file);
    put(&mut file, layers[10] + 10, 7.0f32.to_be_bytes());
    file[195_445] = 1;
    for format in [Format::Sl1, Format::Nanodlp] {
        assert_contains(&refusal(&file, &to(format)), &["one exposure"]);
    }
    let (converted, _) = convert(&file, &to(Format::Ctb)).unwrap();
    let converted = PrintFile::open(&*converted).unwrap();
    assert_eq!(converted.metadata().uses_layer_values, Some(true));
    assert_eq!(converted.layers()[10].exposure_s, Some(7.0));
    // If the header says that they do not count, the printer takes those of the header.
    file[195_445] = 0;
    let (converted, _) = convert(&file, &to(Format::Ctb)).unwrap();
    let converted = PrintFile::open(&*converted).unwrap();
    assert_eq!(converted.metadata().uses_layer_values, Some(false));
    assert_eq!(
        converted.layers()[10].exposure_s,
        converted.layers()[9].exposure_s
    );
}

#[test]
fn what_is_no_number_is_refused() {
    let (clean, report) = ball(Format::Goo);
    let third = goo_layers(&clean)[2];
    let last = goo_layers(&clean)[report.layers - 1];
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (at, finding, words) in [
            (
                third + 6,
                FileFinding::BadHeights {
                    layers: 1,
                    first_layer: 3,
                },
                "1 layer ends at a height that is no number, first layer 3",
            ),
            (
                last + 6,
                FileFinding::BadHeights {
                    layers: 1,
                    first_layer: report.layers,
                },
                "1 layer ends at a height that is no number",
            ),
            (
                third + 10,
                FileFinding::BadExposures {
                    layers: 1,
                    first_layer: 3,
                },
                "1 layer has an exposure that is no number, first layer 3",
            ),
            (
                195_336,
                FileFinding::BadNominalValues,
                "the layer thickness or an exposure for all layers is no number",
            ),
        ] {
            let mut file = clean.clone();
            put(&mut file, at, value.to_be_bytes());
            let print = PrintFile::open(&*file).unwrap();
            let found = inspect(&print, &mut silent).unwrap();
            assert_eq!(found.warnings, [finding], "{value} at {at}");
            assert!(found.height_mm.is_finite() && found.lit_volume_ml.is_finite());
            let refused = refusal(&file, &to(Format::Ctb));
            assert_contains(&refused, &["cannot be converted", words]);
        }
    }
}

#[test]
fn text_that_is_no_number_is_refused() {
    let exposures = FileFinding::BadExposures {
        layers: 1,
        first_layer: 1,
    };
    for (format, name, from, to_text, finding) in [
        (
            Format::Sl1,
            "config.ini",
            "expTimeFirst = 30",
            "expTimeFirst = nan",
            FileFinding::BadNominalValues,
        ),
        (
            Format::Chitubox,
            "run.gcode",
            "M106 S255;\nG4 P30000;",
            "M106 S255;\nG4 Pinf;",
            exposures.clone(),
        ),
        (
            Format::AnycubicZip,
            "layers_controller.conf",
            "\"exposure_time\":30.0",
            "\"exposure_time\":\"NaN\"",
            exposures,
        ),
        (
            Format::Nanodlp,
            "profile.json",
            "\"SupportCureTime\":30.0",
            "\"SupportCureTime\":\"inf\"",
            FileFinding::BadNominalValues,
        ),
    ] {
        let file = with_files(&ball(format).0, |file, contents| {
            if file != name {
                return contents;
            }
            let text = String::from_utf8(contents).unwrap();
            assert!(text.contains(from), "{format:?}: {text}");
            text.replacen(from, to_text, 1).into_bytes()
        });
        let print = PrintFile::open(&*file).unwrap();
        let found = inspect(&print, &mut silent).unwrap().warnings;
        assert!(found.contains(&finding), "{format:?}: {found:?}");
        let refused = refusal(&file, &to(Format::Goo));
        assert_contains(&refused, &["cannot be converted", "is no number"]);
    }
}
