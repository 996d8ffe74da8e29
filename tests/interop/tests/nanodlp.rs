//! NanoDLP files, read by mslicer's crate: every setting, area and pixel.

mod common;

use std::io::Cursor;

use common::{
    Runs, Screen, assert_same, held, load, of_png, on_screen, png_masks, print_file, resin, scene,
    several, solids, uniform,
};
use cusp_slicer::Error;
use cusp_slicer::archive::ArchiveError;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Options, Planner, Report};
use cusp_slicer::printer::PRINTERS;
use glam::Vec3;
use msla_format::nanodlp::{File, LayerDecoder};

/// Subpixels of an image's pixel, each a pixel of the screen.
const THIRDS: u64 = 3;

#[track_caller]
fn assert_near(actual: f32, expected: f64) {
    let error = (f64::from(actual) - expected).abs();
    assert!(
        error <= 1e-6 + 1e-6 * expected.abs(),
        "{actual}, {expected}"
    );
}

/// Slices the model and compares the crate's result with the report and with the masks of the format `png`. Returns
/// that result.
fn check(triangles: &solids::Triangles, options: &Options) -> (File, Report) {
    let options = &Options {
        format: Some(Format::Nanodlp),
        ..options.clone()
    };
    let mut slicer = load(triangles);
    let (bytes, report) = print_file(&mut slicer, options).unwrap();
    let masks = png_masks(&mut slicer, options, THIRDS);
    let file = File::deserialize(Cursor::new(bytes)).unwrap();

    assert_eq!(file.layers.len(), report.layers);
    assert_eq!(file.layer_info.len(), report.layers);
    let mask = &report.mask;
    let mm2 = mask.pitch_mm * mask.pitch_y_mm;
    for (index, (png, expected)) in file.layers.iter().zip(&masks).enumerate() {
        let runs = of_png(png, 1);
        assert_same(&runs, expected, &format!("layer {index}"));
        // The crate's own decoder is not optimised here.
        if index == 0 || mask.width < 1000 {
            let decoder = LayerDecoder::new(png);
            let own: Runs = decoder.runs().map(|run| (run.value, run.length)).collect();
            assert_same(&own, expected, &format!("layer {index}"));
            let size = decoder.into_inner().dimensions();
            assert_eq!(size, (mask.width.div_ceil(3), mask.height));
        }
        let info = &file.layer_info[index];
        assert_near(info.total_solid_area.raw(), runs.lit() as f64 * mm2);
        let is_black = runs.lit() == 0;
        assert_eq!(info.area_count == 0, is_black, "layer {index}");
        assert!(info.smallest_area.raw() <= info.largest_area.raw());
        assert!(info.largest_area.raw() <= info.total_solid_area.raw());
        if !is_black {
            let lit_box = lit_box(&runs, u64::from(mask.width).next_multiple_of(THIRDS));
            let stated = [info.min_x, info.min_y, info.max_x, info.max_y];
            assert_eq!(stated.map(u64::from), lit_box, "layer {index}");
        }
    }

    check_settings(&file, options, &report);
    (file, report)
}

/// First and last column and row that are lit.
fn lit_box(runs: &Runs, columns: u64) -> [u64; 4] {
    let mut found = [u64::MAX, u64::MAX, 0, 0];
    let mut place = 0;
    for &(grey, pixels) in &runs.0 {
        if grey > 0 {
            let (first, last) = (place, place + pixels - 1);
            let rows = [first / columns, last / columns];
            let columns = if rows[0] == rows[1] {
                [first % columns, last % columns]
            } else {
                [0, columns - 1]
            };
            found = [
                found[0].min(columns[0]),
                found[1].min(rows[0]),
                found[2].max(columns[1]),
                found[3].max(rows[1]),
            ];
        }
        place += pixels;
    }
    found
}

fn check_settings(file: &File, options: &Options, report: &Report) {
    let (mask, resin) = (&report.mask, &options.resin);
    let layer_mm = report.thickness_mm[0];
    let um = layer_mm * 1e3;
    let bottom_layers = resin.bottom_layers as u32;

    let profile = &file.profile;
    assert_eq!(profile.title, resin.name);
    assert_near(profile.depth.raw(), um);
    assert_near(profile.support_depth.raw(), um);
    assert_near(profile.cure_time.raw(), resin.exposure_s(layer_mm));
    assert_near(profile.support_cure_time.raw(), resin.bottom_exposure_s);
    assert_eq!(profile.support_layer_number, bottom_layers);
    // The crate takes whole waits and lifts only; those of NanoDLP itself are floating-point numbers.
    assert_eq!(f64::from(profile.wait_height), resin.lift_mm);
    assert_eq!(f64::from(profile.support_wait_height), resin.lift_mm);
    assert_eq!(f64::from(profile.wait_before_print), resin.wait_s);
    assert_eq!(f64::from(profile.support_wait_before_print), resin.wait_s);

    let plate = &file.plate;
    assert_eq!(plate.layers_count as usize, report.layers);
    assert!(plate.processed);
    assert_eq!(f64::from(plate.print_time), report.print_time_s.round());
    assert_near(plate.total_solid_area.raw(), report.resin_ml);
    assert_near(plate.z_min.raw(), 0.0);
    assert_near(plate.z_max.raw(), report.z_mm[report.layers]);
    let lit = file.layer_info.iter().filter(|info| info.area_count > 0);
    let from_middle = |pixel: u32, side: u32, pitch_mm: f64| {
        (f64::from(pixel) - f64::from(side) / 2.0) * pitch_mm
    };
    let x_mm = |column| from_middle(column, mask.width, mask.pitch_mm);
    let y_mm = |row| from_middle(row, mask.height, mask.pitch_y_mm);
    assert_near(
        plate.x_min.raw(),
        x_mm(lit.clone().map(|it| it.min_x).min().unwrap()),
    );
    assert_near(
        plate.x_max.raw(),
        x_mm(lit.clone().map(|it| it.max_x + 1).max().unwrap()),
    );
    assert_near(
        plate.y_min.raw(),
        y_mm(lit.clone().map(|it| it.min_y).min().unwrap()),
    );
    assert_near(
        plate.y_max.raw(),
        y_mm(lit.map(|it| it.max_y + 1).max().unwrap()),
    );

    let settings = &file.options;
    assert_eq!(
        [settings.p_width, settings.p_height],
        [mask.width, mask.height]
    );
    assert_eq!(
        [settings.x_offset, settings.y_offset],
        [mask.width / 2, mask.height / 2]
    );
    assert_near(settings.thickness.raw(), um);
    assert_near(settings.x_pixel_size.raw(), mask.pitch_mm);
    assert_near(settings.y_pixel_size.raw(), mask.pitch_y_mm);
    assert_near(settings.x_res.raw(), mask.pitch_mm * 1e3);
    assert_near(settings.y_res.raw(), mask.pitch_y_mm * 1e3);
    assert_eq!(settings.support_layer_number, bottom_layers);
    assert_eq!(settings.layer_count as usize, report.layers);
    assert_eq!(settings.display_controller, 1);
    assert_eq!(settings.image_mirror, u32::from(mask.is_mirrored));

    let preview = file.preview.to_luma8();
    let lit = preview.pixels().filter(|pixel| pixel.0[0] > 0).count();
    assert!(lit > preview.len() / 8, "{lit} of {}", preview.len());
}

#[test]
fn hollow_and_supported_models_are_read() {
    let (ball, options) = held();
    let planner = Planner::Uniform { layer_mm: 0.1 };
    let (_, report) = check(&ball, &Options { planner, ..options });
    assert_eq!(report.all_warnings(), []);
    assert_eq!(report.models[0].hollowed.clone().unwrap().drains.len(), 1);
    assert!(report.models[0].supported.clone().unwrap().support_ml > 0.0);
}

#[test]
fn both_athenas_are_read() {
    let printers: Vec<_> = PRINTERS
        .iter()
        .filter(|printer| printer.format == Format::Nanodlp)
        .collect();
    assert_eq!(printers.len(), 2);
    for printer in printers {
        let screen = Screen {
            pixels: printer.pixels,
            pitch_mm: printer.pitch_um.map(|um| um / 1e3),
        };
        let options = Options {
            printer: Some(printer.name.as_str().into()),
            ..uniform()
        };
        let (file, report) = check(&scene(screen), &options);
        assert_eq!(report.layers, 14);
        // The block within the cone, then next to it and alone; nothing; the needle.
        let areas: Vec<u32> = file.layer_info.iter().map(|info| info.area_count).collect();
        assert_eq!(areas, [1, 1, 2, 2, 2, 2, 1, 0, 0, 1, 1, 1, 1, 1]);
    }
}

#[test]
fn columns_that_fill_up_a_pixel_of_three_are_black() {
    for width in [300, 301, 302] {
        let screen = Screen {
            pixels: [width, 150],
            pitch_mm: [0.01, 0.02],
        };
        for (antialias, mirror) in [(1, false), (1, true), (4, false), (4, true)] {
            let options = Options {
                antialias,
                mirror: Some(mirror),
                ..on_screen(screen, uniform())
            };
            check(&scene(screen), &options);
            // As wide as the screen.
            let size = Vec3::new(width as f32 * 0.01, 1.0, 0.2);
            let mut slab = solids::cuboid(size * Vec3::new(0.9999, 1.0, 1.0));
            slab.extend(solids::cuboid(Vec3::new(0.5, 1.0, 0.4)));
            check(&slab, &options);
        }
    }
}

#[test]
fn separate_areas_are_counted_and_measured() {
    let screen = Screen {
        pixels: [200, 100],
        pitch_mm: [0.05, 0.04],
    };
    let mut bodies = solids::cuboid(Vec3::new(2.0, 2.0, 0.2));
    let small = solids::cuboid(Vec3::new(1.0, 0.4, 0.1));
    bodies.extend(solids::moved(&small, Vec3::new(3.0, 0.8, 0.0)));
    let (file, _) = check(&bodies, &on_screen(screen, uniform()));
    let areas: Vec<[f32; 3]> = file
        .layer_info
        .iter()
        .map(|info| {
            let areas = [
                &info.total_solid_area,
                &info.largest_area,
                &info.smallest_area,
            ];
            areas.map(|area| (area.raw() * 1e3).round() / 1e3)
        })
        .collect();
    assert_eq!(
        areas,
        [[4.4, 4.0, 0.4], [4.4, 4.0, 0.4], [4.0; 3], [4.0; 3]]
    );
}

#[test]
fn layers_of_several_thicknesses_are_refused_with_the_best_uniform_ones() {
    for printer in ["athena-8k", "athena-12k"] {
        let options = Options {
            printer: Some(printer.into()),
            ..several()
        };
        let error = print_file(&mut load(&solids::cube(0.7)), &options).unwrap_err();
        assert_eq!(error.code(), "uniform-only");
        let Error::Archive(ArchiveError::UniformOnly { format, best, .. }) = error else {
            panic!("{error}");
        };
        assert_eq!(format, Format::Nanodlp);
        assert!(best.is_some());
    }
}

#[test]
fn every_thickness_and_exposure_is_read() {
    let screen = Screen {
        pixels: [60, 60],
        pitch_mm: [0.02, 0.02],
    };
    for layer_mm in [0.02, 0.03, 0.07, 0.1, 0.12] {
        let mut options = Options {
            planner: Planner::Uniform { layer_mm },
            ..on_screen(screen, uniform())
        };
        options.resin = cusp_slicer::resin::Resin {
            exposures: Vec::new(),
            bottom_layers: 3,
            ..resin()
        };
        check(&solids::cube(0.84), &options);
    }
}
