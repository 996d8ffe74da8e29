//! Masks: areas and volumes of solids in closed form, and every pixel against a naive look along its
//! ray.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use std::io::{Cursor, Read};

use common::{binary_stl, on_plate, quiet, sample, solids};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::ldi::{Hit, cpu};
use cusp_slicer::mask::{Masks, Side};
use cusp_slicer::options::{Backend, Options};
use cusp_slicer::pipeline::Slicer;
use cusp_slicer::plan::{Plan, uniform};
use cusp_slicer::progress::silent;
use glam::Vec3;

/// Area of a solid's section at a height.
type Area = Box<dyn Fn(f64) -> f64>;

/// Uniform layers of `layer_mm` over bins a fifth of that.
fn plan(height_mm: f64, layer_mm: f64) -> Plan {
    let bins = Bins::of_height(height_mm, layer_mm / 5.0).unwrap();
    uniform::plan(bins, height_mm, layer_mm).unwrap()
}

#[test]
fn areas_have_their_closed_forms() {
    let area = solids::circle_area(64);
    let radius_at = |z: f64| (100.0 - (z - 10.0) * (z - 10.0)).sqrt();
    let cases: [(&str, solids::Triangles, Area); 4] = [
        ("cube", solids::cube(10.0), Box::new(|_| 100.0)),
        (
            "cylinder",
            solids::cylinder(8.0, 12.0, 64),
            Box::new(move |_| area * 64.0),
        ),
        (
            "cone",
            solids::cone(9.0, 14.0, 64),
            Box::new(move |z| area * 81.0 * (1.0 - z / 14.0) * (1.0 - z / 14.0)),
        ),
        (
            "sphere",
            solids::sphere(10.0, 7),
            Box::new(move |z| std::f64::consts::PI * radius_at(z) * radius_at(z)),
        ),
    ];
    for (name, triangles, area_at) in cases {
        let (mesh, ldi) = sample(&triangles, 800);
        let plan = plan(mesh.bounds().size().z, 0.5);
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Side::Above);
        let mut cursor = masks.cursor();
        let full = area_at(plan.middle_mm()[plan.layers() / 2]);
        for (layer, middle_mm) in plan.middle_mm().into_iter().enumerate() {
            cursor.seek(&masks, layer);
            let area = cursor.lit_pixels() as f64 * ldi.grid.pitch_mm.powi(2);
            assert!(
                (area - area_at(middle_mm)).abs() <= 2e-3 * full,
                "{name}, layer {layer}: {area} against {}",
                area_at(middle_mm)
            );
        }
    }
}

#[test]
fn the_volume_of_all_masks_is_that_of_the_mesh() {
    for (name, triangles) in solids::all() {
        if name == "overlapping spheres" || name == "doubled sphere" || name == "inverted sphere" {
            continue; // their mesh volume is not that of the union
        }
        let (mesh, ldi) = sample(&triangles, 600);
        let plan = plan(mesh.bounds().size().z, 0.1);
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Side::Above);
        let mut cursor = masks.cursor();
        let pixel_mm2 = ldi.grid.pitch_mm.powi(2);
        let volume: f64 = (0..masks.layers())
            .map(|layer| {
                cursor.seek(&masks, layer);
                cursor.lit_pixels() as f64 * pixel_mm2 * 0.1
            })
            .sum();
        let expected = mesh.volume_mm3();
        assert!(
            (volume / expected - 1.0).abs() < 1e-3,
            "{name}: {volume} against {expected}"
        );
    }
}

#[test]
fn overlapping_spheres_have_the_volume_of_their_union() {
    let (r, s) = (6.0f64, 5.0f64);
    let offset = Vec3::new(4.0, 1.0, 2.0);
    let mut triangles = solids::sphere(r, 6);
    triangles.extend(solids::moved(&solids::sphere(s, 6), offset));
    let (mesh, ldi) = sample(&triangles, 500);
    let plan = plan(mesh.bounds().size().z, 0.1);
    let masks = Masks::new(&ldi, &plan, &ldi.grid, Side::Above);
    let mut cursor = masks.cursor();
    let volume: f64 = plan
        .thickness_mm()
        .into_iter()
        .enumerate()
        .map(|(layer, thickness_mm)| {
            cursor.seek(&masks, layer);
            cursor.lit_pixels() as f64 * ldi.grid.pitch_mm.powi(2) * thickness_mm
        })
        .sum();
    let d = f64::from(offset.length());
    let lens = std::f64::consts::PI
        * (r + s - d).powi(2)
        * (d * d + 2.0 * d * (r + s) + 6.0 * r * s - 3.0 * (r * r + s * s))
        / (12.0 * d);
    let ball = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let expected = ball(r) + ball(s) - lens;
    assert!(
        (volume / expected - 1.0).abs() < 5e-3,
        "{volume} against {expected}"
    );
}

#[test]
fn a_png_shows_the_plate_from_above_with_y_upward() {
    // An L: a long arm along +x at the least y, a short one from its left end along +y.
    let mut triangles = solids::cuboid(Vec3::new(10.0, 3.0, 1.0));
    triangles.extend(solids::moved(
        &solids::cuboid(Vec3::new(3.0, 5.0, 1.0)),
        Vec3::new(0.0, 3.0, 0.0),
    ));
    let options = Options {
        pitch_mm: Some(0.25),
        backend: Backend::Cpu,
        ..Options::default()
    };
    let mut slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
    pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    let (writer, _) = slicer
        .write_archive(Cursor::new(Vec::new()), &mut quiet)
        .unwrap();
    let mut archive = zip::ZipArchive::new(writer).unwrap();
    let mut file = Vec::new();
    let mut entry = archive.by_name("layers/00000.png").unwrap();
    entry.read_to_end(&mut file).unwrap();

    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (40, 32));
    let is_lit = |row: usize, column: usize| pixels[row * 40 + column] == 255;
    let (top, bottom, left, right) = (0, 31, 0, 39);
    assert!(
        is_lit(top, left),
        "end of the short arm: least x, largest y"
    );
    assert!(!is_lit(top, right), "beside the short arm: nothing");
    assert!(is_lit(bottom, left), "corner of the L: least x, least y");
    assert!(
        is_lit(bottom, right),
        "end of the long arm: largest x, least y"
    );
    for row in 0..32 {
        for column in 0..40 {
            // Rows 20 to 31 are the long arm, columns 0 to 11 the short one.
            let expected = row >= 20 || column < 12;
            assert_eq!(is_lit(row, column), expected, "row {row}, column {column}");
        }
    }
}

#[test]
fn every_pixel_agrees_with_a_look_along_its_ray() {
    for (name, triangles) in solids::all() {
        let (mesh, ldi) = sample(&triangles, 61);
        let plan = plan(mesh.bounds().size().z, 0.37);
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Side::Above);
        let middles = plan.middle_mm();
        let mut cursor = masks.cursor();
        // Down, up and across, since a cursor moves both ways.
        let mut layers: Vec<usize> = (0..masks.layers()).rev().chain(0..masks.layers()).collect();
        fastrand::Rng::with_seed(5).shuffle(&mut layers[masks.layers()..]);
        for layer in layers {
            cursor.seek(&masks, layer);
            let mut lit_pixels = 0;
            for ray in 0..ldi.rays() {
                let (column, row) = (ray % 61, ray / 61);
                let bit =
                    cursor.bits()[row * masks.window.row_bytes + column / 8] >> (7 - column % 8);
                let below = |hit: &&Hit| f64::from(hit.z_mm) <= middles[layer];
                let winding: i32 = ldi.ray(ray).iter().filter(below).map(|h| h.winding()).sum();
                let is_inside = winding != 0;
                lit_pixels += u64::from(is_inside);
                assert_eq!(bit & 1 == 1, is_inside, "{name}, layer {layer}, ray {ray}");
            }
            assert_eq!(cursor.lit_pixels(), lit_pixels);
        }
    }
}

#[test]
fn holes_leave_no_streaks() {
    let whole = solids::sphere(6.0, 4);
    let masks_of = |triangles: &solids::Triangles| {
        let (mesh, ldi) = sample(triangles, 300);
        let plan = plan(mesh.bounds().size().z, 0.25);
        Masks::new(&ldi, &plan, &ldi.grid, Side::Above)
    };
    let expected = masks_of(&whole);
    let mut random = fastrand::Rng::with_seed(29);
    let mut holed = whole;
    holed.retain(|_| random.f32() > 0.02);
    let found = masks_of(&holed);
    let (mut expected_cursor, mut found_cursor) = (expected.cursor(), found.cursor());
    for layer in 0..expected.layers() {
        expected_cursor.seek(&expected, layer);
        found_cursor.seek(&found, layer);
        let differing: u32 = expected_cursor
            .bits()
            .iter()
            .zip(found_cursor.bits())
            .map(|(expected, found)| (expected ^ found).count_ones())
            .sum();
        // A facet of the sphere is 20 pixels wide and its cap lies at most a tenth of a pixel off.
        assert!(differing <= 60, "layer {layer}: {differing} pixels");
    }
}

#[test]
fn inside_out_and_doubled_bodies_look_like_the_plain_one() {
    let plain = solids::sphere(6.0, 4);
    let mut doubled = plain.clone();
    doubled.extend(plain.clone());
    let masks_of = |triangles: &solids::Triangles| {
        let (mesh, ldi) = sample(triangles, 100);
        Masks::new(
            &ldi,
            &plan(mesh.bounds().size().z, 0.25),
            &ldi.grid,
            Side::Above,
        )
    };
    let expected = masks_of(&plain);
    assert_eq!(masks_of(&doubled), expected);
    assert_eq!(masks_of(&solids::inverted(&plain)), expected);
}

#[test]
fn rays_around_the_model_give_the_masks_of_the_whole_plate() {
    let mesh = on_plate(&solids::sphere(5.0, 4));
    let grid = Grid::plate(&mesh.bounds(), [133, 97], [0.125; 2]).unwrap();
    let part = grid.around_model(&mesh.bounds());
    assert!(part.width < 84 && part.height < 84, "{part:?}");
    let plan = plan(mesh.bounds().size().z, 0.25);
    let masks = |rays: &Grid| {
        let ldi = cpu::sample(&mesh, rays, &mut silent).unwrap();
        let masks = Masks::new(&ldi, &plan, &grid, Side::Above);
        let mut cursor = masks.cursor();
        let mut bits = Vec::new();
        for layer in 0..masks.layers() {
            cursor.seek(&masks, layer);
            bits.push(cursor.whole(&masks));
        }
        bits
    };
    assert!(masks(&grid) == masks(&part));
}
