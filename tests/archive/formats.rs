//! Print files of every format: masks decoded by an independent library, a reader of run.gcode as strict as any known one,
//! and plans that a format cannot express.

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, on_plate, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::archive::{self, ArchiveError};
use cusp_slicer::format::Format;
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::job::{Backend, Options, Planner, Report};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{LayerRuns, Light, Masks, Run, Samples, Side};
use cusp_slicer::plan::uniform;
use serde_json::Value;
use std::io::Cursor;
use std::ops::ControlFlow;

use super::{Zip, file, text};

fn options(format: Format) -> Options {
    Options {
        // Rows are not whole bytes, and the plate is larger than the model.
        pixels: Some([301, 150]),
        pitch_mm: Some(0.03),
        pitch_y_mm: Some(0.05),
        format: Some(format),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn slice(triangles: &solids::Triangles, options: &Options) -> Result<(Slicer, Report, Zip), Error> {
    let mut slicer = Slicer::load(&binary_stl(triangles))?;
    pollster::block_on(slicer.plan(options, &mut quiet))?;
    let (writer, report) = slicer.write_archive(Cursor::new(Vec::new()), &mut quiet)?;
    let (zip, report) = (zip::ZipArchive::new(writer).unwrap(), report.clone());
    Ok((slicer, report, zip))
}

/// Width, height, and the brightness of each pixel.
fn decode(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut decoder = png::Decoder::new(Cursor::new(png));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Grayscale, png::BitDepth::Eight)
    );
    (info.width, info.height, pixels)
}

fn mask_name(format: Format, layer: usize) -> String {
    match format {
        Format::Png => format!("layers/{layer:05}.png"),
        Format::Chitubox => format!("{}.png", layer + 1),
        Format::Uvj => format!("slice/{layer:08}.png"),
        Format::Sl1 => format!("cusp{layer:05}.png"),
        other => unreachable!("{other:?} is no zip of PNGs"),
    }
}

#[test]
fn every_format_has_every_mask_as_it_is_or_mirrored() {
    // A ball next to a small cone, so that left and right differ.
    let mut model = solids::sphere(2.0, 4);
    let cone = solids::cone(0.7, 2.0, 12);
    model.extend(solids::moved(&cone, glam::Vec3::new(3.0, 1.0, -1.0)));
    for format in [Format::Png, Format::Chitubox, Format::Uvj, Format::Sl1] {
        for mirror in [false, true] {
            let options = Options {
                mirror: Some(mirror),
                planner: Planner::Uniform { layer_mm: 0.1 },
                ..options(format)
            };
            let (mut slicer, report, mut zip) = slice(&model, &options).unwrap();
            assert_eq!(report.mask.is_mirrored, mirror);
            for layer in 0..report.layers {
                let png = file(&mut zip, &mask_name(format, layer));
                let (width, height, pixels) = decode(&png);
                assert_eq!((width, height), (301, 150));
                let mask = slicer.mask(layer).unwrap();
                for (place, &pixel) in pixels.iter().enumerate() {
                    let (row, column) = (place / 301, place % 301);
                    let column = if mirror { 300 - column } else { column };
                    let is_lit = mask[row * 38 + column / 8] >> (7 - column % 8) & 1 == 1;
                    assert_eq!(
                        pixel,
                        if is_lit { 255 } else { 0 },
                        "{format:?}, {layer}, {place}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_entry_is_dated_the_first_of_january_1980() {
    for format in [Format::Png, Format::Chitubox, Format::Uvj] {
        let (_, _, mut zip) = slice(&solids::cube(2.0), &options(format)).unwrap();
        assert!(!zip.is_empty());
        for entry in 0..zip.len() {
            let date = zip.by_index(entry).unwrap().last_modified().unwrap();
            assert_eq!(date, zip::DateTime::default(), "{format:?}");
            assert!(date.is_valid());
        }
    }
}

#[test]
fn masks_are_right_on_every_solid() {
    for (name, triangles) in solids::all() {
        for format in [Format::Png, Format::Uvj] {
            let options = Options {
                pixels: None,
                pitch_mm: None,
                pitch_y_mm: None,
                rays: 203,
                ..options(format)
            };
            let (mut slicer, report, mut zip) = slice(&triangles, &options).unwrap();
            let width = report.mask.width as usize;
            for layer in 0..report.layers {
                let (_, _, pixels) = decode(&file(&mut zip, &mask_name(format, layer)));
                let mask = slicer.mask(layer).unwrap();
                let same = pixels.iter().enumerate().all(|(place, &pixel)| {
                    let (row, column) = (place / width, place % width);
                    let bit = mask[row * width.div_ceil(8) + column / 8] >> (7 - column % 8) & 1;
                    pixel == bit * 255
                });
                assert!(same, "{name}, {format:?}, layer {layer}");
            }
        }
    }
}

#[test]
fn every_format_has_grey_masks_with_anti_aliasing() {
    let model = solids::sphere(2.0, 4);
    let mesh = on_plate(&model);
    for format in [Format::Png, Format::Chitubox, Format::Uvj, Format::Sl1] {
        let options = Options {
            antialias: 4,
            planner: Planner::Uniform { layer_mm: 0.1 },
            ..options(format)
        };
        let (mut slicer, report, mut zip) = slice(&model, &options).unwrap();
        let samples = Samples::of_level(4).unwrap();
        let grid = Grid::plate(&mesh.bounds(), [301, 150], [0.03, 0.05]).unwrap();
        let fine = grid.refined(samples.rays());
        let ldi = cpu::sample(&mesh, &fine, &mut |_| ControlFlow::Continue(())).unwrap();
        let bins = Bins::of_height(report.height_mm, report.bin_mm).unwrap();
        let plan = uniform::plan(bins, report.height_mm, 0.1, 0).unwrap();
        let masks = Masks::new(&ldi, &plan, &grid, samples, Side::Above);
        let mut cursor = masks.cursor();
        let mut greys = std::collections::BTreeSet::new();
        for layer in 0..report.layers {
            cursor.seek(&masks, layer);
            let Light::Samples(lit) = cursor.light() else {
                panic!("pixels are not grey");
            };
            let (_, _, pixels) = decode(&file(&mut zip, &mask_name(format, layer)));
            let half = slicer.mask(layer).unwrap();
            for (place, &pixel) in pixels.iter().enumerate() {
                let (row, column) = (place / 301, place % 301);
                let lit = lit[row * masks.window.row_pixels() + column];
                assert_eq!(pixel, (f32::from(lit) * 255.0 / 16.0).round() as u8);
                let is_half = half[row * 38 + column / 8] >> (7 - column % 8) & 1 == 1;
                assert_eq!(is_half, lit >= 8);
                greys.insert(pixel);
            }
        }
        assert_eq!(greys.len(), 17, "{format:?}: {greys:?}");
        assert_eq!(report.mask.antialias, 4);
    }
}

/// A layer as a reader of run.gcode sees it.
struct GcodeLayer {
    mask: String,
    z_mm: f64,
    exposure_ms: f64,
}

/// Reads run.gcode as strictly as the strictest of its readers, and returns its header and layers.
fn read_gcode(text: &str) -> (std::collections::HashMap<String, String>, Vec<GcodeLayer>) {
    let mut header = std::collections::HashMap::new();
    let mut lines = text.lines().filter(|line| !line.is_empty()).peekable();
    while let Some(line) = lines.next_if(|line| !line.starts_with(";START_GCODE")) {
        let (key, value) = line.strip_prefix(';').unwrap().split_once(':').unwrap();
        assert!(
            header.insert(key.to_owned(), value.to_owned()).is_none(),
            "{key} twice"
        );
    }
    assert_eq!(lines.next(), Some(";START_GCODE_BEGIN"));
    for command in ["G21;", "G90;", "M106 S0;", "M17;", "G28 Z0;"] {
        assert_eq!(lines.next(), Some(command));
    }
    assert_eq!(lines.next(), Some(";START_GCODE_END"));
    // Z, then F, in millimetres and millimetres per minute.
    let read_move = |line: &str| -> f64 {
        let words = line
            .strip_prefix("G0 Z")
            .unwrap()
            .strip_suffix(';')
            .unwrap();
        let (z_mm, speed) = words.split_once(" F").unwrap();
        assert!(speed.parse::<f64>().unwrap() > 0.0, "{line}");
        z_mm.parse().unwrap()
    };
    let read_wait = |line: &str| -> f64 {
        let digits = line
            .strip_prefix("G4 P")
            .unwrap()
            .strip_suffix(';')
            .unwrap();
        assert!(digits == "0" || !digits.starts_with('0'), "{line}");
        digits.parse::<u64>().unwrap() as f64
    };
    let mut layers = Vec::new();
    while let Some(line) = lines.next_if(|line| !line.starts_with(";END_GCODE")) {
        let index = layers.len();
        assert_eq!(line, format!(";LAYER_START:{index}"));
        let mask = lines.next().unwrap().strip_prefix("M6054 \"").unwrap();
        let mask = mask.strip_suffix("\";").unwrap().to_owned();
        assert_eq!(mask, format!("{}.png", index + 1));
        let lifted_mm = read_move(lines.next().unwrap());
        let z_mm = read_move(lines.next().unwrap());
        assert!(lifted_mm > z_mm, "no lift in layer {index}");
        read_wait(lines.next().unwrap());
        assert_eq!(lines.next(), Some("M106 S255;"));
        let exposure_ms = read_wait(lines.next().unwrap());
        assert_eq!(lines.next(), Some("M106 S0;"));
        assert_eq!(lines.next(), Some(";LAYER_END"));
        layers.push(GcodeLayer {
            mask,
            z_mm,
            exposure_ms,
        });
    }
    assert_eq!(lines.next(), Some(";END_GCODE_BEGIN"));
    assert_eq!(lines.next(), Some("M106 S0;"));
    assert!(lines.next().unwrap().starts_with("G1 Z"));
    assert_eq!(lines.collect::<Vec<_>>(), ["M18;", ";END_GCODE_END"]);
    (header, layers)
}

#[test]
fn run_gcode_has_a_height_and_an_exposure_for_every_layer() {
    let mut options = options(Format::Chitubox);
    options.resin.bottom_layers = 3;
    options.resin.wait_s = 0.0;
    let (_, report, mut zip) = slice(&solids::sphere(2.0, 5), &options).unwrap();
    let (header, layers) = read_gcode(&text(&mut zip, "run.gcode"));
    assert_eq!(layers.len(), report.layers);
    assert!(
        report
            .thickness_mm
            .windows(2)
            .any(|pair| pair[0] != pair[1])
    );
    let mut last_mm = 0.0;
    for (index, layer) in layers.iter().enumerate() {
        // Readers round heights to a micrometre, and refuse a height that is not above the one before.
        assert!((layer.z_mm * 1e3).round() > (last_mm * 1e3f64).round());
        last_mm = layer.z_mm;
        assert_near(layer.z_mm, report.z_mm[index + 1], 1e-9);
        assert_near(layer.exposure_ms, report.exposure_s[index] * 1e3, 0.5);
        assert!(!file(&mut zip, &layer.mask).is_empty());
    }
    assert_eq!(layers[2].exposure_ms, 30_000.0);
    let number = |key: &str| header[key].parse::<f64>().unwrap();
    assert_eq!(
        (number("resolutionX"), number("resolutionY")),
        (301.0, 150.0)
    );
    assert_eq!(number("totalLayer") as usize, report.layers);
    assert_eq!(
        (number("bottomLayerCount"), number("bottomLayCount")),
        (3.0, 3.0)
    );
    assert_eq!(
        header["bottomLayExposureTime"],
        header["bottomLayerExposureTime"]
    );
    assert_near(number("volume"), report.resin_ml, 1e-3);
    assert_near(number("estimatedPrintTime"), report.print_time_s, 1e-3);
    assert_eq!(
        (header["mirror"].as_str(), header["projectType"].as_str()),
        ("0", "Normal")
    );
    for (name, size) in [
        ("preview.png", (954, 850)),
        ("preview_cropping.png", (168, 150)),
    ] {
        let (width, height, pixels) = decode(&file(&mut zip, name));
        assert_eq!((width, height), size);
        assert!(pixels.iter().filter(|&&pixel| pixel > 60).count() > pixels.len() / 4);
    }
}

#[test]
fn uvj_has_a_height_and_an_exposure_for_every_layer() {
    let (_, report, mut zip) = slice(&solids::sphere(2.0, 5), &options(Format::Uvj)).unwrap();
    let config: Value = serde_json::from_slice(&file(&mut zip, "config.json")).unwrap();
    let size = &config["Properties"]["Size"];
    assert_eq!((&size["X"], &size["Y"]), (&301.into(), &150.into()));
    assert_near(size["Millimeter"]["X"].as_f64().unwrap(), 9.03, 1e-9);
    assert_near(size["Millimeter"]["Y"].as_f64().unwrap(), 7.5, 1e-9);
    assert_eq!(size["Layers"], report.layers);
    let layers = config["Layers"].as_array().unwrap();
    assert_eq!(layers.len(), report.layers);
    let nominal_mm = size["LayerHeight"].as_f64().unwrap();
    for (index, layer) in layers.iter().enumerate() {
        assert_near(layer["Z"].as_f64().unwrap(), report.z_mm[index + 1], 1e-9);
        let exposure_s = layer["Exposure"]["LightOnTime"].as_f64().unwrap();
        assert_near(exposure_s, report.exposure_s[index], 1e-9);
        assert!(report.thickness_mm[index] <= 1.5 * nominal_mm + 1e-9);
    }
    for name in ["preview/huge.png", "preview/tiny.png"] {
        decode(&file(&mut zip, name));
    }
}

#[test]
fn sl1_takes_uniform_layers_alone() {
    let ball = solids::sphere(2.0, 5);
    let Err(error) = slice(&ball, &options(Format::Sl1)) else {
        panic!("a variable plan was written");
    };
    assert_eq!(error.code(), "uniform-only");
    let said = error.to_string();
    assert!(
        ["chitubox", "uvj", "png", "uniform"]
            .iter()
            .all(|it| said.contains(it)),
        "{said}"
    );

    let uniform = Options {
        planner: Planner::Uniform { layer_mm: 0.05 },
        ..options(Format::Sl1)
    };
    let (_, report, mut zip) = slice(&ball, &uniform).unwrap();
    let pairs = |text: String| -> std::collections::HashMap<String, String> {
        let pairs = text.lines().map(|line| line.split_once(" = ").unwrap());
        pairs
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
            .collect()
    };
    let config = pairs(text(&mut zip, "config.ini"));
    let number = |key: &str| config[key].parse::<f64>().unwrap();
    assert_eq!(
        (number("numSlow") + number("numFast")) as usize,
        report.layers
    );
    assert_eq!(
        (
            number("layerHeight"),
            number("expTime"),
            number("expTimeFirst")
        ),
        (0.05, 3.0, 30.0)
    );
    assert_near(number("usedMaterial"), report.resin_ml, 1e-3);
    let profile = pairs(text(&mut zip, "prusaslicer.ini"));
    assert_eq!(profile["display_pixels_x"], "301");
    assert_eq!(profile["display_orientation"], "landscape");
    let masks = zip
        .file_names()
        .filter(|name| {
            name.as_ref()
                .is_ok_and(|name| name.starts_with(&config["jobDir"]))
        })
        .count();
    assert_eq!(masks, report.layers);
}

/// Layers that other workers encode, from runs that they are sent as numbers.
#[test]
fn a_file_is_the_same_wherever_its_layers_are_encoded() {
    let ball = solids::sphere(3.0, 4);
    for format in Format::MASKS {
        for antialias in [1, 2] {
            let options = Options {
                antialias,
                planner: Planner::Uniform { layer_mm: 0.05 },
                ..options(format)
            };
            let mut slicer = Slicer::load(&binary_stl(&ball)).unwrap();
            pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
            let (expected, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
            let Some(mut groups) = slicer.layer_groups().unwrap() else {
                assert!(!format.is_zip(), "{format:?}");
                continue;
            };
            assert!(groups.left() > 2, "{format:?}");
            let (canvas, named) = (groups.canvas, groups.format);
            let sent: Vec<Vec<u32>> = groups.by_ref().map(|runs| runs.to_words()).collect();
            assert_eq!((groups.left(), groups.progress()), (0, 0.9));
            // In whatever order they are encoded.
            let encode = |words: &Vec<u32>| {
                archive::encode_group(named, canvas, &LayerRuns::of_words(words).unwrap()).unwrap()
            };
            let mut encoded: Vec<Vec<u8>> = sent.iter().rev().map(encode).collect();
            encoded.reverse();
            let group_of = |group: usize| encoded[group].clone();
            let written = slicer.write_archive_of(Some(&group_of), Vec::new(), &mut quiet);
            assert!(written.unwrap().0 == expected, "{format:?} {antialias}");
            // Data as another build would send it.
            let cut = |_: usize| vec![0; 7];
            let refused = slicer.write_archive_of(Some(&cut), Vec::new(), &mut quiet);
            assert!(matches!(
                refused.err(),
                Some(Error::Archive(ArchiveError::Write { .. }))
            ));
        }
    }
}

#[test]
fn runs_that_were_cut_are_refused() {
    let run = |first| Run {
        first,
        pixels: 2,
        grey: 9,
    };
    let runs = LayerRuns::new([vec![run(1), run(5)], vec![], vec![run(7)]]);
    let words = runs.to_words();
    assert_eq!(LayerRuns::of_words(&words), Some(runs));
    for end in [0, 2, 3, 5, words.len() - 1] {
        assert_eq!(LayerRuns::of_words(&words[..end]), None, "{end}");
    }
    assert_eq!(LayerRuns::of_words(&[2, 1, 0, 4, 4, 4]), None);
}
