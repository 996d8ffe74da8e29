//! Masks: areas and volumes of solids in closed form, and every pixel against a naive walk along its
//! ray.

use std::io::{Cursor, Read};

use crate::common::Slicer;
use crate::common::{binary_stl, on_plate, quiet, sample, solids};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::job::{Backend, Options};
use cusp_slicer::ldi::{Hit, RayImage, Survey, cpu};
use cusp_slicer::mask::{LEVELS, Light, MaskCursor, Masks, Samples, Side};
use cusp_slicer::plan::{Plan, uniform};
use cusp_slicer::progress::silent;
use glam::Vec3;

/// Area of a solid's section at a height.
type Area = Box<dyn Fn(f64) -> f64>;

/// Uniform layers of `layer_mm`, each of five bins.
fn plan(height_mm: f64, layer_mm: f64) -> Plan {
    let bins = Bins::of_height(height_mm, layer_mm / 5.0).unwrap();
    uniform::plan(bins, height_mm, layer_mm, 0).unwrap()
}

fn bits(cursor: &MaskCursor) -> &[u8] {
    match cursor.light() {
        Light::Bits(bits) => bits,
        Light::Samples(_) => panic!("pixels are grey"),
    }
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
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Samples::ONE, Side::Above);
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
            continue; // the volume of their mesh is not that of the union
        }
        let (mesh, ldi) = sample(&triangles, 600);
        let plan = plan(mesh.bounds().size().z, 0.1);
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Samples::ONE, Side::Above);
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
    let masks = Masks::new(&ldi, &plan, &ldi.grid, Samples::ONE, Side::Above);
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
    // An L: a long arm along +x at the smallest y, and a short one from its left end along +y.
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
        "end of the short arm: smallest x, largest y"
    );
    assert!(!is_lit(top, right), "beside the short arm: nothing");
    assert!(is_lit(bottom, left), "corner of the L: smallest x and y");
    assert!(
        is_lit(bottom, right),
        "end of the long arm: largest x, smallest y"
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
        let masks = Masks::new(&ldi, &plan, &ldi.grid, Samples::ONE, Side::Above);
        let middles = plan.middle_mm();
        let mut cursor = masks.cursor();
        // Downward, then in random order, since a cursor moves in both directions.
        let mut layers: Vec<usize> = (0..masks.layers()).rev().chain(0..masks.layers()).collect();
        fastrand::Rng::with_seed(5).shuffle(&mut layers[masks.layers()..]);
        for layer in layers {
            cursor.seek(&masks, layer);
            let mut lit_pixels = 0;
            for ray in 0..ldi.rays() {
                let (column, row) = (ray % 61, ray / 61);
                let bit =
                    bits(&cursor)[row * masks.window.row_bytes + column / 8] >> (7 - column % 8);
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
        Masks::new(&ldi, &plan, &ldi.grid, Samples::ONE, Side::Above)
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
        let differing: u32 = bits(&expected_cursor)
            .iter()
            .zip(bits(&found_cursor))
            .map(|(expected, found)| (expected ^ found).count_ones())
            .sum();
        // A facet of the sphere is 20 pixels wide, and its cap is off by at most a tenth of a pixel.
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
            Samples::ONE,
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
        let masks = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
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

/// Grey by its definition: each ray of a pixel, sampled at the middle of each part of a layer.
#[test]
fn grey_is_the_part_of_samples_inside() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let size = mesh.bounds().size();
        let pitch_mm = size.x.max(size.y) / 23.0;
        // Off centre by a fraction of a pixel, so that pixels at both ends have only some of their rays over the model.
        let grid = Grid::plate(&mesh.bounds(), [45, 38], [pitch_mm, pitch_mm * 0.9]).unwrap();
        let plan = plan(size.z, size.z / 7.0);
        for level in LEVELS {
            let samples = Samples::of_level(level).unwrap();
            let fine = grid.refined(samples.rays());
            let ldi = cpu::sample(&mesh, &fine.around_model(&mesh.bounds()), &mut silent).unwrap();
            let whole = cpu::sample(&mesh, &fine, &mut silent).unwrap();
            let expected = |layer: usize, row: u32, column: u32| {
                let [bottom, top] = [0, 1].map(|end| f64::from(plan.boundaries[layer + end]));
                let mut lit = 0;
                for part in 0..samples.sublayers {
                    let height = (f64::from(part) + 0.5) / f64::from(samples.sublayers);
                    let middle_mm = (bottom + (top - bottom) * height) * plan.bins.size_mm;
                    for y in 0..samples.rows {
                        for x in 0..samples.columns {
                            let (row, column) =
                                (row * samples.rows + y, column * samples.columns + x);
                            let hits = whole.ray((row * fine.width + column) as usize);
                            let below = hits.iter().filter(|hit| f64::from(hit.z_mm) <= middle_mm);
                            lit += u8::from(below.map(|hit| hit.winding()).sum::<i32>() != 0);
                        }
                    }
                }
                lit
            };
            let (_, overlaps) = Survey::with_overlaps(RayImage::Kept(&ldi), &mut silent).unwrap();
            let made = [Side::Above, Side::Below].map(|side| {
                let grids = [&ldi.grid, &grid];
                let of_facets = Masks::of_facets(&mesh, grids, &overlaps, &plan, samples, side);
                [
                    (side, Masks::new(&ldi, &plan, &grid, samples, side)),
                    (side, of_facets),
                ]
            });
            for (side, masks) in made.into_iter().flatten() {
                let window = masks.window;
                let mut cursor = masks.cursor();
                let mut any = 0;
                for layer in (0..masks.layers()).rev().chain(0..masks.layers()) {
                    cursor.seek(&masks, layer);
                    let mut lit_pixels = 0;
                    for row in 0..grid.height {
                        for column in 0..grid.width {
                            let expected = expected(layer, row, column);
                            let seen = match side {
                                Side::Above => column,
                                Side::Below => grid.width - 1 - column,
                            };
                            let in_window = (row as usize)
                                .checked_sub(window.first_row)
                                .filter(|&row| row < window.rows)
                                .zip((seen as usize).checked_sub(window.first_byte * 8))
                                .filter(|&(_, column)| column < window.row_pixels());
                            let found = in_window.map_or(0, |(row, column)| {
                                let pixel = row * window.row_pixels() + column;
                                match cursor.light() {
                                    Light::Bits(bits) => bits[pixel / 8] >> (7 - pixel % 8) & 1,
                                    Light::Samples(lit) => lit[pixel],
                                }
                            });
                            assert_eq!(
                                found, expected,
                                "{name}, level {level}, {side:?}, layer {layer}, {column} {row}"
                            );
                            lit_pixels += u64::from(expected > 0);
                            any += u32::from(expected);
                        }
                    }
                    assert_eq!(cursor.lit_pixels(), lit_pixels);
                }
                assert!(any > 0, "{name} has no light");
            }
        }
    }
}

/// Lit pixels add up to the volume of the mesh: within a thousandth at 2048 pixels, and with grey at far fewer.
#[test]
fn light_adds_up_to_the_volume_of_closed_models() {
    let cases = [
        ("sphere", solids::sphere(9.7, 6)),
        ("cone", solids::cone(7.3, 11.0, 90)),
        ("cylinder", solids::cylinder(4.3, 7.0, 40)),
        ("gyroid", solids::gyroid(2, 40)),
    ];
    for (name, triangles) in cases {
        for (pixels, level) in [(2048, 1), (256, 8)] {
            let mesh = on_plate(&triangles);
            let grid = Grid::around(&mesh.bounds(), pixels).unwrap();
            let samples = Samples::of_level(level).unwrap();
            let fine = grid.refined(samples.rays());
            let ldi = cpu::sample(&mesh, &fine, &mut silent).unwrap();
            let plan = plan(mesh.bounds().size().z, 0.05);
            let masks = Masks::new(&ldi, &plan, &grid, samples, Side::Above);
            let mut cursor = masks.cursor();
            let mut volume_mm3 = 0.0;
            for (layer, thickness_mm) in plan.thickness_mm().into_iter().enumerate() {
                cursor.seek(&masks, layer);
                let lit = match cursor.light() {
                    Light::Bits(_) => cursor.lit_pixels() as f64,
                    Light::Samples(lit) => {
                        let lit: u64 = lit.iter().map(|&lit| u64::from(lit)).sum();
                        lit as f64 / f64::from(samples.total())
                    }
                };
                volume_mm3 += lit * grid.pixel_mm2() * thickness_mm;
            }
            let expected = mesh.volume_mm3();
            assert!(
                (volume_mm3 / expected - 1.0).abs() <= 1e-3,
                "{name} at {pixels}: {volume_mm3} mm³, not {expected}"
            );
        }
    }
}
