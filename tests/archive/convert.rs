//! Print files made from print files: every format from every other, pixel by pixel, and those that are refused.

use std::io::{Cursor, Write as _};
use std::sync::Arc;

use cusp_slicer::archive::read::{FileFinding, Preview, PrintFile, inspect};
use cusp_slicer::convert::{Conversion, ConvertError, Loss, Target};
use cusp_slicer::format::{Format, FormatThicknesses};
use cusp_slicer::job::{Backend, Options, Planner};
use cusp_slicer::printer::{PRINTERS, Printer, PrinterChoice, format_of, named};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::Resin;
use glam::Vec3;

use super::read_back::{kept, own, runs, slice};
use crate::common::{assert_near, solids};

pub fn to(format: Format) -> Target {
    Target {
        format: Some(format),
        ..Target::default()
    }
}

/// Converts a file. Returns the new one, and its losses.
pub fn convert(bytes: &[u8], target: &Target) -> Result<(Vec<u8>, Vec<Loss>), ConvertError> {
    let file = PrintFile::open(bytes).unwrap();
    let inspection = inspect(&file, &mut silent).unwrap();
    let conversion = Conversion::new(&file, &inspection, target)?;
    let written = conversion.write(Vec::new(), &mut silent)?;
    Ok((written, conversion.losses().to_vec()))
}

pub fn options(planner: Planner) -> Options {
    Options {
        printer: Some(own(Format::Goo, None)),
        height_mm: Some(2.0),
        layer_min_mm: Some(0.05),
        layer_max_mm: Some(0.2),
        tolerance: Some(0.06),
        planner,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// An L, which is no mirror image of itself.
fn ell() -> solids::Triangles {
    let mut ell = solids::cuboid(Vec3::new(2.0, 0.6, 1.0));
    ell.extend(solids::cuboid(Vec3::new(0.6, 1.5, 1.0)));
    ell
}

pub const UNIFORM: Planner = Planner::Uniform { layer_mm: 0.1 };

#[test]
fn every_format_becomes_every_other() {
    for (antialias, planner) in [(1, UNIFORM), (8, UNIFORM), (4, Planner::Optimal)] {
        let options = Options {
            antialias,
            ..options(planner)
        };
        let formats: Vec<Format> = Format::MASKS
            .into_iter()
            .filter(|format| planner == UNIFORM || format.thicknesses() == FormatThicknesses::Any)
            .collect();
        let (files, report) = slice(&solids::sphere(1.0, 6), &options, &formats);
        let png = PrintFile::open(&*files[0]).unwrap();
        for (from, bytes) in formats.iter().zip(&files) {
            for &format in &formats {
                let name = format!("{from:?} to {format:?}, {antialias}");
                let (converted, losses) = convert(bytes, &to(format)).unwrap();
                let file = PrintFile::open(&*converted).unwrap();
                assert_eq!(file.metadata().format, format, "{name}");
                assert_eq!(file.layers().len(), report.layers, "{name}");
                for (index, layer) in file.layers().iter().enumerate() {
                    assert_near(layer.z_mm, report.z_mm[index + 1], 1e-5);
                    if let Some(exposure_s) = layer.exposure_s {
                        // Printers that read SL1 have three bottom layers, not the four of the resin.
                        let fewer = usize::from(*from == Format::Sl1 && index == 3);
                        let expected_s = report.exposure_s[index + fewer];
                        assert!(
                            (exposure_s - expected_s).abs() < 1e-3,
                            "{name}: {exposure_s} s"
                        );
                    }
                    let expected = runs(&png, index, |grey| kept(format, kept(*from, grey)));
                    let found = runs(&file, index, |grey| grey);
                    assert!(found == expected, "{name}, layer {index}");
                }
                let found = inspect(&file, &mut silent).unwrap().warnings;
                let is_known =
                    |finding: &FileFinding| matches!(finding, FileFinding::BlackLayers { .. });
                assert!(found.iter().all(is_known), "{name}: {found:?}");
                // A printer of one's own is not known by the name in its files.
                let says = PrintFile::open(&**bytes)
                    .unwrap()
                    .metadata()
                    .is_mirrored_x
                    .is_some();
                assert_eq!(losses.contains(&Loss::Mirroring), !says, "{name}");
                let levels = losses.iter().find_map(|loss| match loss {
                    Loss::Greys { levels } => Some(*levels),
                    _ => None,
                });
                let expected = match (antialias, *from, format) {
                    (1, ..) | (_, Format::PhotonWorkshop | Format::AnycubicZip, _) => None,
                    (_, _, Format::PhotonWorkshop | Format::AnycubicZip) => Some(16),
                    (_, Format::Ctb, _) => None,
                    (_, _, Format::Ctb) => Some(128),
                    _ => None,
                };
                assert_eq!(levels, expected, "{name}");
            }
        }
    }
}

#[test]
fn a_file_becomes_itself() {
    // Of the same resin and printer, so that nothing but the preview can differ.
    for name in ["mars-4-ultra", "saturn-4-ultra-12k"] {
        let options = Options {
            printer: Some(name.into()),
            height_mm: Some(12.0),
            ..options(UNIFORM)
        };
        let (files, report) = slice(
            &solids::sphere(1.0, 4),
            &options,
            &[Format::Png, Format::Goo],
        );
        let (converted, losses) = convert(&files[1], &Target::default()).unwrap();
        assert_eq!(losses, []);
        let (old, new) = (
            PrintFile::open(&*files[1]).unwrap(),
            PrintFile::open(&*converted).unwrap(),
        );
        assert_eq!(old.layers(), new.layers());
        let metadata = |file: &PrintFile<'_>| {
            let mut metadata = file.metadata().clone();
            metadata.print_time_s = metadata.print_time_s.map(f64::round);
            metadata
        };
        assert_eq!(metadata(&old), metadata(&new));
        // By its zip of masks, too, which states no moves: those of the default resin.
        let (from_zip, losses) = convert(&files[0], &Target::default()).unwrap();
        assert_eq!(losses, []);
        let from_zip = PrintFile::open(&*from_zip).unwrap();
        assert_eq!(from_zip.metadata().format, Format::Goo);
        assert_eq!(from_zip.layers(), old.layers());
        assert_near(
            from_zip.metadata().print_time_s.unwrap(),
            report.print_time_s,
            1.0,
        );
        // The preview is drawn from the masks: a disk, brighter in the middle, where the ball is higher.
        let preview = from_zip.preview(0).unwrap();
        let grey = |column: u32, row: u32| preview.rgb[3 * (row * preview.width + column) as usize];
        let middle = (preview.width / 2, preview.height / 2);
        assert_eq!(grey(0, 0), 0);
        assert!(grey(middle.0, middle.1) > 230);
        let edge = (0..middle.0)
            .map(|column| grey(column, middle.1))
            .find(|&grey| grey > 0);
        assert!((60..200).contains(&edge.unwrap()), "{edge:?}");
        // Pixels of the screen need not be square; the ball is round.
        for file in [&old, &from_zip] {
            let [width, height] = extent(&file.preview(0).unwrap());
            assert!(width.abs_diff(height) <= 4, "{name}: {width} × {height}");
        }
    }
}

/// Columns and rows with something in them.
fn extent(preview: &Preview) -> [usize; 2] {
    let pixels: Vec<bool> = preview.rgb.chunks(3).map(|rgb| rgb[0] > 0).collect();
    let rows: Vec<&[bool]> = pixels.chunks(preview.width as usize).collect();
    let lit = rows.iter().filter(|row| row.contains(&true)).count();
    let columns = (0..rows[0].len()).filter(|&column| rows.iter().any(|row| row[column]));
    [columns.count(), lit]
}

#[test]
fn masks_are_mirrored_on_request_and_stay_the_same_from_above() {
    let (files, report) = slice(&ell(), &options(UNIFORM), &[Format::Png]);
    let old = PrintFile::open(&*files[0]).unwrap();
    let target = Target {
        mirror: Some(false),
        ..to(Format::Goo)
    };
    let (converted, _) = convert(&files[0], &target).unwrap();
    let new = PrintFile::open(&*converted).unwrap();
    assert_eq!(new.metadata().is_mirrored_x, Some(false));
    let mut are_different = false;
    for layer in 0..report.layers {
        let seen = |file: &PrintFile<'_>| file.mask(layer, file.metadata().flips()).unwrap();
        assert_eq!(seen(&old), seen(&new), "layer {layer}");
        let stored = |file: &PrintFile<'_>| runs(file, layer, |grey| grey);
        are_different |= stored(&old) != stored(&new);
    }
    assert!(are_different);
}

/// A zip with some of its files replaced.
pub fn with_files(bytes: &[u8], replace: impl Fn(&str, Vec<u8>) -> Vec<u8>) -> Vec<u8> {
    let mut old = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut new = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..old.len() {
        let mut file = old.by_index(index).unwrap();
        let mut contents = Vec::new();
        std::io::Read::read_to_end(&mut file, &mut contents).unwrap();
        let name = file.name().unwrap().into_owned();
        new.start_file(&*name, zip::write::SimpleFileOptions::default())
            .unwrap();
        new.write_all(&replace(&name, contents)).unwrap();
    }
    new.finish().unwrap().into_inner()
}

#[test]
fn masks_on_their_side_are_set_upright() {
    let mut options = Options {
        height_mm: Some(1.5),
        ..options(UNIFORM)
    };
    let PrinterChoice::Own(printer) = own(Format::Sl1, None) else {
        unreachable!()
    };
    // In portrait, as PrusaSlicer writes for the SL1, only that ours stand upright and theirs lie.
    options.printer = Some(PrinterChoice::Own(Arc::new(Printer {
        pixels: [77, 161],
        pitch_um: [50.0, 30.0],
        ..Printer::clone(&printer)
    })));
    let (files, _) = slice(&ell(), &options, &[Format::Sl1]);
    let theirs = with_files(&files[0], |name, contents| match name {
        "config.ini" => String::from_utf8(contents)
            .unwrap()
            .replace("Cusp-", "PrusaSlicer-")
            .into_bytes(),
        _ => contents,
    });
    let old = PrintFile::open(&*theirs).unwrap();
    assert!(old.metadata().is_turned);
    let (converted, _) = convert(&theirs, &to(Format::Goo)).unwrap();
    let new = PrintFile::open(&*converted).unwrap();
    assert_eq!(new.metadata().pixels, [161, 77]);
    assert_near(new.metadata().pixel_mm[0], old.metadata().pixel_mm[1], 1e-6);
    for layer in 0..old.layers().len() {
        let seen = |file: &PrintFile<'_>| file.mask(layer, file.metadata().flips()).unwrap();
        assert_eq!(seen(&old), seen(&new), "layer {layer}");
    }
}

pub fn refusal(bytes: &[u8], target: &Target) -> String {
    convert(bytes, target).map(|_| ()).unwrap_err().to_string()
}

pub fn assert_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn what_the_target_cannot_hold_is_refused() {
    let (files, _) = slice(
        &solids::sphere(1.0, 4),
        &options(Planner::Optimal),
        &[Format::Goo],
    );
    let file = &*files[0];
    for format in [Format::Sl1, Format::Nanodlp] {
        // Exposures come first, since thicknesses have different ones; with one exposure, the thicknesses are left.
        assert_contains(
            &refusal(file, &to(format)),
            &[format.name(), "one exposure above the bottom layers"],
        );
        let resin = Resin {
            exposures: vec![[0.05, 2.0]],
            bottom_layers: 0,
            ..Resin::default()
        };
        let target = Target {
            resin: Some(resin),
            ..to(format)
        };
        assert_contains(&refusal(file, &target), &["one thickness for all layers"]);
    }
    let printer = |change: &dyn Fn(&mut Printer)| {
        let PrinterChoice::Own(mut printer) = own(Format::Goo, None) else {
            unreachable!()
        };
        change(Arc::make_mut(&mut printer));
        Target {
            printer: Some(PrinterChoice::Own(printer)),
            ..Target::default()
        }
    };
    let model = &*PRINTERS[0].model;
    convert(file, &printer(&|_| {})).unwrap();
    assert_contains(
        &refusal(file, &printer(&|printer| printer.pixels = [160, 77])),
        &[
            "161 × 77 pixels of 0.0300 × 0.0500 mm",
            "160 × 77",
            "slice the model",
            model,
        ],
    );
    assert_contains(
        &refusal(file, &printer(&|printer| printer.pitch_um = [30.0, 52.0])),
        &["0.0300 × 0.0520 mm"],
    );
    assert_contains(
        &refusal(file, &printer(&|printer| printer.volume_mm[2] = 1.0)),
        &["2.000 mm high", "up to 1 mm", model],
    );
    assert_contains(
        &refusal(file, &printer(&|printer| printer.layer_mm = [0.05, 0.1])),
        &["layer 8 ", "0.120 mm", "0.05 to 0.1 mm", model],
    );
    assert_contains(
        &refusal(
            file,
            &printer(&|printer| printer.variable_layers = cusp_slicer::printer::VariableLayers::No),
        ),
        &["one thickness for all layers", model],
    );
    let unknown = Target {
        printer: Some("no-such-printer".into()),
        ..Target::default()
    };
    assert_contains(&refusal(file, &unknown), &["no-such-printer"]);
    // Its printer is one's own, and not known by name.
    assert_contains(
        &refusal(file, &Target::default()),
        &["name a format or a printer"],
    );
    let bad = Target {
        resin: Some(Resin {
            lift_mm_min: 0.0,
            ..Resin::default()
        }),
        ..to(Format::Goo)
    };
    assert!(matches!(convert(file, &bad), Err(ConvertError::Resin(_))));
}

#[test]
fn a_damaged_file_is_refused() {
    let (files, _) = slice(&solids::sphere(1.0, 4), &options(UNIFORM), &[Format::Png]);
    let missing = with_files(&files[0], |name, contents| match name {
        "layers/00003.png" => contents[..contents.len() / 2].to_vec(),
        _ => contents,
    });
    assert_contains(
        &refusal(&missing, &to(Format::Goo)),
        &["cannot be converted", "layer 4", "damaged"],
    );
    let with_layers = |change: fn(&mut serde_json::Value)| {
        with_files(&files[0], |name, contents| {
            if name != "manifest.json" {
                return contents;
            }
            let mut manifest: serde_json::Value = serde_json::from_slice(&contents).unwrap();
            let layers = manifest["layer_files"].as_array_mut().unwrap();
            layers.iter_mut().for_each(change);
            serde_json::to_vec(&manifest).unwrap()
        })
    };
    let flat = with_layers(|layer| layer["z_mm"] = 0.1.into());
    assert_contains(
        &refusal(&flat, &to(Format::Goo)),
        &["cannot be converted", "layer 2"],
    );
    let silent = with_layers(|layer| layer["exposure_s"] = serde_json::Value::Null);
    assert_contains(
        &refusal(&silent, &to(Format::Goo)),
        &["how long", "give a resin"],
    );
    let target = Target {
        resin: Some(Resin::default()),
        ..to(Format::Goo)
    };
    let (converted, _) = convert(&silent, &target).unwrap();
    let converted = PrintFile::open(&*converted).unwrap();
    let exposures: Vec<f64> = converted
        .layers()
        .iter()
        .filter_map(|layer| layer.exposure_s)
        .collect();
    assert_eq!(
        exposures[..5],
        [30.0, 30.0, 30.0, 30.0, Resin::default().exposure_s(0.1)]
    );
}

#[test]
fn what_differs_between_layers_is_said() {
    // GOO has moves and rests for each layer. A head of 195,477 bytes, then for each layer 66 bytes, data, and two bytes.
    let (files, _) = slice(
        &solids::sphere(1.0, 4),
        &options(Planner::Optimal),
        &[Format::Goo],
    );
    let mut bytes = files[0].clone();
    let first = 195_477;
    let float = |place: usize| {
        f32::from_be_bytes(bytes[first + place..first + place + 4].try_into().unwrap())
    };
    assert_near(f64::from(float(10)), 30.0, 1e-6);
    let lift = 30;
    assert_near(f64::from(float(lift)), 5.0, 1e-6);
    bytes[first + lift..first + lift + 4].copy_from_slice(&7.0f32.to_be_bytes());
    let after_lift = 22;
    bytes[first + after_lift..first + after_lift + 4].copy_from_slice(&0.5f32.to_be_bytes());
    let (_, losses) = convert(&bytes, &to(Format::Goo)).unwrap();
    let layers = PrintFile::open(&*bytes).unwrap().layers().len();
    let expected = [
        Loss::Moves {
            layer: layers / 2 + 1,
        },
        Loss::Rests { wait_s: 1.0 },
    ];
    assert_eq!(losses, expected);
    // With a resin, those of the file are not wanted.
    let target = Target {
        resin: Some(Resin::default()),
        ..to(Format::Goo)
    };
    assert_eq!(convert(&bytes, &target).unwrap().1, []);
}

#[test]
fn an_extension_names_the_format_that_printers_read_by_it() {
    for (extension, format) in [
        ("goo", Some(Format::Goo)),
        ("PRZ", Some(Format::Goo)),
        ("pm3", Some(Format::PhotonWorkshop)),
        ("pwmx", Some(Format::PhotonWorkshop)),
        ("pwsz", Some(Format::AnycubicZip)),
        ("zip", Some(Format::Png)),
        ("sl1s", Some(Format::Sl1)),
        ("stl", None),
        ("", None),
    ] {
        assert_eq!(format_of(extension), format, "{extension}");
    }
    // Every printer's own extension leads to its format; only ChiTuBox's zip has that of another.
    for printer in PRINTERS.iter().filter(|printer| printer.reads_format) {
        let extension = &printer.reads[0];
        if extension != "zip" {
            assert_eq!(
                format_of(extension),
                Some(printer.format),
                "{}",
                printer.name
            );
        }
    }
    assert!(named("mars-4-ultra").is_some());
}
