//! Every format, read back by the readers, which share no code with the writers: heights, exposures and every pixel.

use std::sync::Arc;

use crate::common::Slicer;
use cusp_slicer::archive::read::{PrintFile, inspect};
use cusp_slicer::format::{Format, FormatThicknesses};
use cusp_slicer::job::{Backend, Options, Planner, Report};
use cusp_slicer::printer::{PRINTERS, Printer, PrinterChoice, VariableLayers};
use cusp_slicer::progress::silent;

use crate::common::{assert_near, binary_stl, quiet, solids};

/// Slices in several formats: the print files, and the report of the first.
pub fn slice(
    triangles: &solids::Triangles,
    options: &Options,
    formats: &[Format],
) -> (Vec<Vec<u8>>, Report) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let mut files = Vec::new();
    let mut reports = Vec::new();
    for &format in formats {
        let options = Options {
            format: Some(format),
            ..options.clone()
        };
        pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
        let (file, report) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
        files.push(file);
        reports.push(report.clone());
    }
    (files, reports.swap_remove(0))
}

/// The greys of a layer, each through `kept`, row by row, as runs that are as long as they can be: equal for equal pixels.
pub fn runs(file: &PrintFile<'_>, layer: usize, kept: impl Fn(u8) -> u8) -> Vec<(u8, u64)> {
    let mut runs: Vec<(u8, u64)> = Vec::new();
    file.runs(layer, &mut |grey, count| {
        let (grey, count) = (kept(grey), u64::from(count));
        match runs.last_mut() {
            Some(last) if last.0 == grey => last.1 += count,
            _ if count > 0 => runs.push((grey, count)),
            _ => {}
        }
    })
    .unwrap();
    runs
}

/// A brightness as a format keeps it.
pub fn kept(format: Format, grey: u8) -> u8 {
    match format {
        Format::PhotonWorkshop | Format::AnycubicZip => (grey >> 4) * 17,
        Format::Ctb => match grey >> 1 {
            0 => 0,
            seven => 2 * seven + 1,
        },
        _ => grey,
    }
}

fn check(bytes: &[u8], png: &PrintFile<'_>, format: Format, report: &Report, name: &str) {
    let file = PrintFile::open(bytes).unwrap();
    let metadata = file.metadata();
    assert_eq!(metadata.format, format, "{name}");
    assert_eq!(
        metadata.pixels,
        [report.mask.width, report.mask.height],
        "{name}"
    );
    assert_near(metadata.pixel_mm[0], report.mask.pitch_mm, 1e-5);
    assert_near(metadata.pixel_mm[1], report.mask.pitch_y_mm, 1e-5);
    assert_eq!(file.layers().len(), report.layers, "{name}");
    if let Some(says) = metadata.is_mirrored_x {
        assert_eq!(says, report.mask.is_mirrored, "{name}");
    }
    let mut expected_black = 0;
    for (index, layer) in file.layers().iter().enumerate() {
        assert_near(layer.z_mm, report.z_mm[index + 1], 1e-5);
        if let Some(exposure_s) = layer.exposure_s {
            assert_near(exposure_s, report.exposure_s[index], 1e-3);
        }
        let expected = runs(png, index, |grey| kept(format, grey));
        assert!(
            runs(&file, index, |grey| grey) == expected,
            "{name}, {format:?}, layer {index}"
        );
        if let Some(stated) = layer.stated_lit_pixels {
            let of_png = runs(png, index, |grey| grey);
            let lit = of_png.iter().filter(|run| run.0 > 0);
            assert_eq!(
                stated,
                lit.map(|run| run.1).sum::<u64>(),
                "{name}, {format:?}, layer {index}"
            );
        }
        expected_black += u32::from(expected.iter().all(|run| run.0 == 0));
    }
    let codes: Vec<String> = inspect(&file, &mut silent)
        .unwrap()
        .warnings
        .iter()
        .map(|finding| {
            serde_json::to_value(finding).unwrap()["code"]
                .as_str()
                .unwrap()
                .to_owned()
        })
        .collect();
    let black = if expected_black > 0 {
        vec!["black-layers"]
    } else {
        Vec::new()
    };
    assert_eq!(codes, black, "{name}, {format:?}");
}

pub fn own(format: Format, version: Option<u32>) -> PrinterChoice {
    let mut printer = Printer::clone(&PRINTERS[0]);
    "own".clone_into(&mut printer.name);
    // No whole number of bytes, nor of three pixels.
    printer.pixels = [161, 77];
    printer.pitch_um = [30.0, 50.0];
    printer.volume_mm = [4.83, 3.85, 50.0];
    printer.format = format;
    printer.file_version = version;
    printer.variable_layers = VariableLayers::Yes;
    PrinterChoice::Own(Arc::new(printer))
}

#[test]
fn every_format_has_every_height_exposure_and_pixel() {
    for (name, triangles) in solids::all() {
        for antialias in [1, 8] {
            for is_uniform in [true, false] {
                let options = Options {
                    printer: Some(own(Format::Goo, None)),
                    height_mm: Some(2.0),
                    antialias,
                    layer_min_mm: Some(0.05),
                    layer_max_mm: Some(0.2),
                    tolerance: Some(0.2),
                    backend: Backend::Cpu,
                    planner: if is_uniform {
                        Planner::Uniform { layer_mm: 0.2 }
                    } else {
                        Planner::Optimal
                    },
                    ..Options::default()
                };
                let formats: Vec<Format> = Format::MASKS
                    .into_iter()
                    .filter(|format| is_uniform || format.thicknesses() == FormatThicknesses::Any)
                    .collect();
                let (files, report) = slice(&triangles, &options, &formats);
                let png = PrintFile::open(&*files[0]).unwrap();
                for (format, file) in formats.iter().zip(&files) {
                    check(file, &png, *format, &report, name);
                }
            }
        }
    }
}

#[test]
fn a_thickness_between_micrometres_is_not_rounded() {
    // SL1 has a thickness and no heights, so a rounded one adds up over all layers.
    let options = Options {
        printer: Some(own(Format::Sl1, None)),
        height_mm: Some(2.0),
        bin_mm: Some(0.0125),
        planner: Planner::Uniform { layer_mm: 0.0375 },
        backend: Backend::Cpu,
        ..Options::default()
    };
    let ball = solids::sphere(1.0, 4);
    let (files, report) = slice(&ball, &options, &[Format::Png, Format::Sl1]);
    let png = PrintFile::open(&*files[0]).unwrap();
    check(&files[1], &png, Format::Sl1, &report, "ball");
}

#[test]
fn every_version_and_byte_order_can_be_read() {
    let ball = solids::sphere(1.0, 4);
    for version in [516, 517, 518] {
        let options = Options {
            printer: Some(own(Format::PhotonWorkshop, Some(version))),
            backend: Backend::Cpu,
            ..Options::default()
        };
        let (files, report) = slice(&ball, &options, &[Format::Png, Format::PhotonWorkshop]);
        let png = PrintFile::open(&*files[0]).unwrap();
        check(&files[1], &png, Format::PhotonWorkshop, &report, "ball");
        let file = PrintFile::open(&*files[1]).unwrap();
        assert_eq!(
            file.metadata().version.as_deref(),
            Some(version.to_string().as_str())
        );
    }
    for name in ["jupiter-2", "saturn-4-ultra-16k", "sonic-mini-8k-s"] {
        let options = Options {
            printer: Some(name.into()),
            planner: Planner::Uniform { layer_mm: 0.1 },
            backend: Backend::Cpu,
            ..Options::default()
        };
        let (files, report) = slice(&ball, &options, &[Format::Png, Format::Goo]);
        let png = PrintFile::open(&*files[0]).unwrap();
        check(&files[1], &png, Format::Goo, &report, name);
        let file = PrintFile::open(&*files[1]).unwrap();
        // The vat tilts; no lift but a token one.
        let lift_mm = if name == "saturn-4-ultra-16k" {
            0.05
        } else {
            5.0
        };
        assert_near(file.layers()[3].lift_mm.unwrap(), lift_mm, 1e-6);
        // Values of single layers are left out where all are alike.
        assert_eq!(file.metadata().uses_layer_values, Some(false));
    }
}

#[test]
fn layers_of_their_own_count_in_the_formats_that_have_a_flag() {
    let ball = solids::sphere(1.0, 4);
    let options = Options {
        printer: Some(own(Format::Goo, None)),
        backend: Backend::Cpu,
        ..Options::default()
    };
    let formats = [
        Format::Goo,
        Format::Ctb,
        Format::PhotonWorkshop,
        Format::AnycubicZip,
    ];
    let (files, _) = slice(&ball, &options, &formats);
    for file in &files {
        let file = PrintFile::open(&**file).unwrap();
        assert_eq!(
            file.metadata().uses_layer_values,
            Some(true),
            "{:?}",
            file.metadata().format
        );
    }
}
