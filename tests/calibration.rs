//! Prints that measure a printer: heights, exposures and shapes of their layers.

use std::io::{Cursor, Read};

use crate::common::quiet;
use cusp_slicer::Error;
use cusp_slicer::calibration::Calibration;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Options, Report};
use serde_json::Value;
use zip::ZipArchive;

/// Screens of 0.05 mm pixels, so that lengths are whole numbers of them.
fn options(format: Format) -> Options {
    Options {
        pixels: Some([1600, 1200]),
        pitch_mm: Some(0.05),
        format: Some(format),
        ..Options::default()
    }
}

fn write(calibration: &Calibration) -> Result<(Vec<u8>, Report), Error> {
    pollster::block_on(calibration.write(Vec::new(), &mut quiet))
}

fn layers_of(file: Vec<u8>) -> Vec<Value> {
    let mut zip = ZipArchive::new(Cursor::new(file)).unwrap();
    let mut json = String::new();
    let mut manifest = zip.by_name("manifest.json").unwrap();
    manifest.read_to_string(&mut json).unwrap();
    let manifest: Value = serde_json::from_str(&json).unwrap();
    manifest["layer_files"].as_array().unwrap().clone()
}

fn numbers(layers: &[Value], key: &str) -> Vec<f64> {
    layers
        .iter()
        .map(|layer| layer[key].as_f64().unwrap())
        .collect()
}

#[test]
fn one_tower_is_half_and_one_is_one_and_a_half_millimetres_high() {
    let calibration = Calibration::layers(&options(Format::Png)).unwrap();
    let (file, report) = write(&calibration).unwrap();
    let layers = layers_of(file);
    let expected = [[0.05; 10], [0.1; 10]].concat();
    for (found, expected) in numbers(&layers, "thickness_mm").into_iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-9);
    }
    assert_eq!(layers.len(), expected.len());
    assert!((numbers(&layers, "z_mm")[19] - 1.5).abs() < 1e-9);
    // A tower has 200 × 200 pixels.
    let lit = numbers(&layers, "lit_pixels");
    assert_eq!(lit, [[80_000.0; 10], [40_000.0; 10]].concat());
    assert_eq!(report.exposure_s[..5], [30.0, 30.0, 30.0, 30.0, 3.0]);
    assert!(report.exposure_s[10] > 3.0);
}

#[test]
fn a_printer_that_is_said_to_take_one_thickness_may_be_measured() {
    for printer in [
        "photon-mono-m5s",
        "saturn-4",
        "saturn-3-ultra",
        "ld-002h",
        "shuffle",
    ] {
        let options = Options {
            printer: Some(printer.into()),
            ..Options::default()
        };
        let calibration = Calibration::layers(&options).unwrap();
        assert!(write(&calibration).is_ok(), "{printer}");
    }
    for printer in ["sl1s", "athena-8k"] {
        let options = Options {
            printer: Some(printer.into()),
            ..Options::default()
        };
        let error = write(&Calibration::layers(&options).unwrap()).unwrap_err();
        assert_eq!(error.code(), "uniform-only", "{printer}");
        let error = Calibration::exposure(&options, &[0.05], &[2.0]).unwrap_err();
        assert_eq!(error.code(), "uniform-only", "{printer}");
    }
}

#[test]
fn each_pair_of_thickness_and_exposure_has_a_section_and_a_tower() {
    let (thickness_mm, exposure_s) = ([0.05, 0.1], [1.5, 2.5, 4.0]);
    let options = options(Format::Png);
    let calibration = Calibration::exposure(&options, &thickness_mm, &exposure_s).unwrap();
    let (file, report) = write(&calibration).unwrap();
    let layers = layers_of(file);
    let bottom = options.resin.bottom_layers;
    assert_eq!(layers.len(), bottom + 60);
    let found = numbers(&layers, "exposure_s");
    assert_eq!(found[..bottom], [30.0; 4]);
    let lit = numbers(&layers, "lit_pixels");
    let thicknesses = numbers(&layers, "thickness_mm");
    let mut place = bottom;
    for (row, layer_mm) in thickness_mm.into_iter().enumerate() {
        for (column, seconds) in exposure_s.into_iter().enumerate() {
            let section = place..place + 10;
            assert_eq!(found[section.clone()], [seconds; 10]);
            for thickness in &thicknesses[section] {
                assert!((thickness - layer_mm).abs() < 1e-9);
            }
            // Towers that are not finished are whole squares of 200 × 200 pixels.
            let towers = f64::from(6 - (row * 3 + column) as u32);
            assert_eq!(lit[place], towers * 40_000.0);
            // Ridges of 2, 4, 6 and 8 by 80 pixels on the front; on the back, all but as much of 100 rows.
            let top = 20.0 * 80.0 + (200.0 - 20.0) * 100.0;
            assert_eq!(lit[place + 9], (towers - 1.0) * 40_000.0 + top);
            place += 10;
        }
    }
    let seconds = found.iter().sum::<f64>() + report.overhead_s * layers.len() as f64;
    assert!((report.print_time_s - seconds).abs() < 1e-3);
    for (thickness_mm, exposure_s, code) in
        [([0.0], [2.0], "bad-length"), ([0.05], [-1.0], "bad-time")]
    {
        let error = Calibration::exposure(&options, &thickness_mm, &exposure_s).unwrap_err();
        assert_eq!(error.code(), code);
    }
}
