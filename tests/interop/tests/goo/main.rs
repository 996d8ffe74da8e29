//! GOO files, read by two crates: every field, height, exposure, checksum and pixel.

#[path = "../common/mod.rs"]
mod common;
mod planted;
mod readers;

use std::sync::Arc;

use common::{
    BLACK, EXPOSURES_S, Screen, TOPS_MM, assert_same, held, load, on_screen, png_masks, print_file,
    scene, several, solids, uniform,
};
use cusp_slicer::format::Format;
use cusp_slicer::job::{Options, Report};
use cusp_slicer::printer::{self, PRINTERS, Printer, PrinterChoice, VariableLayers};
use glam::Vec3;
use readers::{Head, LayerHead, Print, READERS};

/// Full power of the light.
const FULL_LIGHT: u16 = 255;
const NO_MOVE: [f32; 2] = [0.0; 2];

/// Length and speed of lift and return.
fn moves(printer: Option<&Printer>, options: &Options) -> [[f32; 2]; 2] {
    if printer.is_some_and(|printer| printer.has_tilting_vat) {
        return [[0.05; 2]; 2];
    }
    let resin = &options.resin;
    [resin.lift_mm_min, resin.return_mm_min]
        .map(|speed_mm_min| [resin.lift_mm as f32, speed_mm_min as f32])
}

fn expected_head(printer: Option<&Printer>, options: &Options, report: &Report) -> Head {
    let resin = &options.resin;
    let mask = &report.mask;
    let wait_s = resin.wait_s as f32;
    let [lift, back] = moves(printer, options);
    let usual_mm = report.thickness_mm[report.layers / 2];
    let plate_mm = printer.map_or_else(
        || {
            [
                f64::from(mask.width) * mask.pitch_mm,
                f64::from(mask.height) * mask.pitch_y_mm,
                report.height_mm.ceil(),
            ]
        },
        |printer| printer.volume_mm,
    );
    let name = printer.map_or("", Printer::machine);
    Head {
        texts: ["Cusp", name, &resin.name, "$"].map(str::to_owned).to_vec(),
        antialias: options.antialias as u16,
        layers: report.layers as u32,
        pixels: [mask.width as u16, mask.height as u16],
        is_mirrored: [mask.is_mirrored, false],
        volume_mm: plate_mm.map(|side_mm| side_mm as f32),
        layer_mm: usual_mm as f32,
        exposure_s: resin.exposure_s(usual_mm) as f32,
        bottom_exposure_s: resin.bottom_exposure_s as f32,
        bottom_layers: resin.bottom_layers as u32,
        has_waits: true,
        waits_s: [0.0, 0.0, 0.0, wait_s, 0.0, 0.0, wait_s],
        moves: [lift, lift, back, back, NO_MOVE, NO_MOVE, NO_MOVE, NO_MOVE],
        light: [FULL_LIGHT; 2],
        has_layer_settings: report.thickness_mm.iter().any(|&it| it != usual_mm),
        time_s: report.print_time_s as u32,
        volume_mm3: (report.resin_ml * 1e3) as f32,
        weight_g: (report.resin_ml * resin.density_g_ml) as f32,
        has_8_bit_greys: true,
        transition_layers: 0,
    }
}

fn expected_layer(printer: Option<&Printer>, options: &Options, z_mm: f64, s: f64) -> LayerHead {
    let [lift, back] = moves(printer, options);
    LayerHead {
        pause: false,
        z_mm: z_mm as f32,
        exposure_s: s as f32,
        waits_s: [0.0, 0.0, 0.0, options.resin.wait_s as f32],
        moves: [lift, back, NO_MOVE, NO_MOVE],
        light: FULL_LIGHT,
    }
}

/// Slices the model and compares what both crates read with the report and with the masks of the format `png`. Returns what
/// one of them read, the same as the other.
fn check(triangles: &solids::Triangles, options: &Options) -> (Print, Report) {
    let printer = match &options.printer {
        None => None,
        Some(PrinterChoice::Named(name)) => printer::named(name),
        Some(PrinterChoice::Own(printer)) => Some(Arc::clone(printer)),
    };
    let printer = printer.as_deref();
    let mut slicer = load(triangles);
    let options = &Options {
        format: Some(Format::Goo),
        ..options.clone()
    };
    let (bytes, report) = print_file(&mut slicer, options).unwrap();
    let masks = png_masks(&mut slicer, options, 1);
    let area = u64::from(report.mask.width) * u64::from(report.mask.height);
    let [print, other] = READERS.map(|(reader, read)| {
        let print = read(&bytes);
        assert_eq!(
            print.head,
            expected_head(printer, options, &report),
            "{reader}"
        );
        assert_eq!(print.layers.len(), report.layers, "{reader}");
        for (index, (layer, runs)) in print.layers.iter().enumerate() {
            let [z_mm, exposure_s] = [report.z_mm[index + 1], report.exposure_s[index]];
            let expected = expected_layer(printer, options, z_mm, exposure_s);
            assert_eq!(layer, &expected, "{reader}, layer {index}");
            assert_eq!(runs.area(), area, "{reader}, layer {index}");
            assert_same(runs, &masks[index], &format!("{reader}, layer {index}"));
        }
        let [small, large] = &print.previews;
        assert_eq!((small.len(), large.len()), (116 * 116, 290 * 290));
        print
    });
    assert_eq!(print.previews, other.previews);
    for preview in &print.previews {
        let lit = preview.iter().filter(|&&pixel| pixel > 0).count();
        assert!(lit > preview.len() / 8, "{lit} of {}", preview.len());
    }
    (print, report)
}

/// Checks the layers of [`several`] on this printer, with the scene in the middle of its screen.
fn check_several(printer: &Printer) {
    let screen = Screen {
        pixels: printer.pixels,
        pitch_mm: printer.pitch_um.map(|um| um / 1e3),
    };
    let options = Options {
        printer: Some(PrinterChoice::Own(Arc::new(printer.clone()))),
        ..several()
    };
    let (print, _) = check(&scene(screen), &options);
    assert!(print.head.has_layer_settings);
    for (index, (layer, runs)) in print.layers.iter().enumerate() {
        assert_eq!(layer.z_mm, TOPS_MM[index] as f32, "layer {index}");
        assert_eq!(layer.exposure_s, EXPOSURES_S[index] as f32, "layer {index}");
        let needle = screen.needle(printer.is_mirrored);
        match index {
            BLACK => assert_eq!(runs.0, [(0, screen.area())]),
            _ if index > BLACK => assert_eq!(
                runs.0,
                [(0, needle), (255, 1), (0, screen.area() - needle - 1)]
            ),
            _ => assert!(runs.lit() > 10),
        }
    }
}

fn goo_printers() -> impl Iterator<Item = &'static Printer> {
    let printers = PRINTERS.iter().map(|printer| &**printer);
    printers.filter(|printer| printer.format == Format::Goo)
}

fn big_endian_printers() -> impl Iterator<Item = &'static Printer> {
    goo_printers().filter(|printer| !printer.is_little_endian)
}

#[test]
fn hollow_and_supported_models_are_read() {
    let (ball, options) = held();
    let (_, report) = check(&ball, &options);
    assert_eq!(report.all_warnings(), []);
    assert_eq!(report.models[0].hollowed.clone().unwrap().drains.len(), 1);
    assert!(report.models[0].supported.clone().unwrap().support_ml > 0.0);
}

#[test]
fn layers_of_several_thicknesses_are_read_for_every_printer() {
    for printer in big_endian_printers() {
        // The printer's ability to print them is another question.
        check_several(&Printer {
            variable_layers: VariableLayers::Yes,
            ..printer.clone()
        });
    }
}

#[test]
fn layers_of_one_thickness_are_read_for_every_printer() {
    for printer in big_endian_printers() {
        let pitch_mm = printer.pitch_um.map(|um| um / 1e3);
        let screen = Screen {
            pixels: printer.pixels,
            pitch_mm,
        };
        let options = Options {
            printer: Some(printer.name.as_str().into()),
            ..uniform()
        };
        let (print, report) = check(&scene(screen), &options);
        assert!(!print.head.has_layer_settings);
        assert_eq!(report.layers, 14);
        for (index, (layer, _)) in print.layers.iter().enumerate() {
            assert_eq!(layer.z_mm, (0.05 * (index + 1) as f64) as f32);
            assert_eq!(layer.exposure_s, if index < 2 { 25.0 } else { 2.0 });
        }
    }
}

#[test]
fn printers_that_take_one_thickness_are_refused_several() {
    let refusing = big_endian_printers().filter(|it| it.variable_layers == VariableLayers::No);
    let mut count = 0;
    for printer in refusing {
        let options = Options {
            printer: Some(printer.name.as_str().into()),
            ..several()
        };
        let error = print_file(&mut load(&solids::cube(0.7)), &options).unwrap_err();
        assert_eq!(error.code(), "printer-uniform-only", "{}", printer.name);
        count += 1;
    }
    assert!(count > 0);
}

#[test]
fn a_screen_of_16k_is_read_mirrored_or_not() {
    for is_mirrored in [false, true] {
        check_several(&Printer {
            name: "16k".to_owned(),
            pixels: [16_384, 12_288],
            pitch_um: [14.0, 18.0],
            volume_mm: [229.376, 221.184, 300.0],
            is_mirrored,
            variable_layers: VariableLayers::Yes,
            machine: None,
            ..(*printer::named("mars-5").unwrap()).clone()
        });
    }
}

#[test]
fn every_grey_is_read_at_every_level_of_anti_aliasing() {
    let screen = Screen {
        pixels: [201, 134],
        pitch_mm: [0.021, 0.03],
    };
    let ball = solids::sphere(0.35, 4);
    for antialias in [1, 2, 4, 8] {
        for mirror in [false, true] {
            let options = Options {
                antialias,
                mirror: Some(mirror),
                ..on_screen(screen, several())
            };
            let (print, _) = check(&ball, &options);
            let runs = print.layers.iter().flat_map(|(_, runs)| &runs.0);
            let greys: std::collections::BTreeSet<u8> = runs.map(|&(grey, _)| grey).collect();
            let samples = antialias as usize * antialias as usize;
            assert!(greys.len() <= samples + 1, "{greys:?}");
            assert!(greys.len() > samples / 2, "{greys:?}");
            assert!(greys.contains(&0) && greys.contains(&255));
        }
    }
}

#[test]
fn greys_are_read_on_a_whole_screen() {
    let printer = printer::named("mars-5").unwrap();
    let screen = Screen {
        pixels: printer.pixels,
        pitch_mm: printer.pitch_um.map(|um| um / 1e3),
    };
    let options = Options {
        antialias: 4,
        printer: Some(PrinterChoice::Own(printer)),
        ..several()
    };
    check(&scene(screen), &options);
}

/// Walls along both sides of the screen: the last pixel of a row and the first of the next are lit.
#[test]
fn runs_go_on_across_the_ends_of_rows() {
    let screen = Screen {
        pixels: [61, 40],
        pitch_mm: [0.03125, 0.0625],
    };
    let [width_mm, depth_mm] = [61.0 * 0.03125, 40.0 * 0.0625];
    let slab = solids::cuboid(Vec3::new(width_mm, depth_mm, 0.34));
    let wall = |x_mm, height_mm| {
        let wall = solids::cuboid(Vec3::new(0.03125, depth_mm, height_mm));
        solids::moved(&wall, Vec3::new(x_mm, 0.0, 0.0))
    };
    let mut model = slab;
    model.extend(wall(0.0, 0.7));
    model.extend(wall(width_mm - 0.03125, 0.7));
    let (print, _) = check(&model, &on_screen(screen, several()));
    let area = screen.area();
    for (index, (_, runs)) in print.layers.iter().enumerate() {
        if index < BLACK {
            assert_eq!(runs.0, [(255, area)]);
        } else {
            let rows = std::iter::repeat_n([(0, 59), (255, 2)], 40);
            let expected: common::Runs = std::iter::once((255, 1)).chain(rows.flatten()).collect();
            let mut expected = expected.0;
            expected.last_mut().unwrap().1 = 1;
            assert_eq!(runs.0, expected);
        }
    }
}

/// Its numbers begin with the lowest byte, which neither crate knows of; tests/archive/ turns them round and compares.
#[test]
fn neither_crate_reads_the_little_endian_files_of_the_jupiter_2() {
    let little = goo_printers().filter(|printer| printer.is_little_endian);
    let names: Vec<&str> = little.map(|printer| printer.name.as_str()).collect();
    assert_eq!(names, ["jupiter-2"]);
    let options = Options {
        printer: Some("jupiter-2".into()),
        ..uniform()
    };
    let (bytes, _) = print_file(&mut load(&solids::cube(0.7)), &options).unwrap();
    assert!(goo::GooFile::deserialize(&bytes).is_err());
    let mut deserializer = msla_format::serde::SliceDeserializer::new(&bytes);
    assert!(msla_format::goo::File::deserialize(&mut deserializer).is_err());
}
