//! Masks that make up for prints larger than they: every pixel against a naive erosion, and sides of a cube in closed form.

use crate::common::{on_plate, solids};
use cusp_slicer::compensation::Compensation;
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::ldi::{Ldi, RayImage, cpu};
use cusp_slicer::mask::{Compensations, Light, Masks, Raise, RunSource, Samples, Side};
use cusp_slicer::model::Mesh;
use cusp_slicer::plan::{Plan, uniform};
use cusp_slicer::printer::{PRINTERS, Printer};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::Resin;

fn uniform_plan(height_mm: f64, layers: f64) -> Plan {
    let layer_mm = height_mm / layers;
    let bins = Bins::of_height(height_mm, layer_mm / 5.0).unwrap();
    uniform::plan(bins, height_mm, layer_mm, 0).unwrap()
}

/// The rays over a mesh, and those of the whole screen.
fn rays(mesh: &Mesh, grid: &Grid, samples: Samples) -> [Ldi; 2] {
    let fine = grid.refined(samples.rays());
    let sample = |grid: &Grid| cpu::sample(mesh, grid, &mut silent).unwrap();
    [sample(&fine.around_model(&mesh.bounds())), sample(&fine)]
}

/// Returns true if a ray is inside at a height, with every entry `z_mm` higher that is above the first layer and has a sampled height
/// between itself and the exit below. `parts` heights are sampled in each layer.
fn is_lit(ldi: &Ldi, ray: usize, height_mm: f64, z_mm: f64, middles: &[f64], parts: usize) -> bool {
    let (mut winding, mut z_in, mut z_out) = (0, 0.0, f64::NEG_INFINITY);
    let mut lit = false;
    let is_dark_between = |from: f64, to: f64| middles.iter().any(|it| (from..to).contains(it));
    for hit in ldi.ray(ray) {
        let before = winding;
        winding += hit.winding();
        let z = f64::from(hit.z_mm);
        if before == 0 {
            z_in = if z > middles[parts - 1] && is_dark_between(z_out, z) {
                f64::from((z + z_mm) as f32)
            } else {
                z
            };
        } else if winding == 0 {
            lit |= z_in <= height_mm && height_mm < z;
            z_out = z;
        }
    }
    lit
}

/// The number of lit samples of every pixel of a layer, by looking at each ray of the disc around each ray.
fn naive(
    whole: &Ldi,
    plan: &Plan,
    layer: usize,
    samples: Samples,
    compensations: &Compensations,
) -> Vec<u8> {
    let Grid {
        width,
        height,
        pitch_mm,
        pitch_y_mm,
        ..
    } = whole.grid;
    let (width, height) = (width as i32, height as i32);
    let radius_mm = compensations.xy_mm[layer];
    let grows = radius_mm < 0.0;
    let reach = (radius_mm.abs() / pitch_mm.min(pitch_y_mm)) as i32 + 1;
    let columns = whole.grid.width / samples.columns;
    let rows = whole.grid.height / samples.rows;
    let mut counts = vec![0; (columns * rows) as usize];
    let middles = plan.middles_of_parts_mm(samples.sublayers);
    let parts = samples.sublayers as usize;
    let Raise::By(z_mm) = compensations.raise else {
        unreachable!()
    };
    for middle_mm in &middles[layer * parts..(layer + 1) * parts] {
        let lit: Vec<bool> = (0..(width * height) as usize)
            .map(|ray| is_lit(whole, ray, *middle_mm, z_mm, &middles, parts))
            .collect();
        for row in 0..height {
            for column in 0..width {
                let mut near = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
                // Rays beyond the screen are dark.
                let is = |(x, y): (i32, i32)| {
                    let (column, row) = (column + x, row + y);
                    (0..width).contains(&column)
                        && (0..height).contains(&row)
                        && lit[(row * width + column) as usize]
                };
                let within = |&(x, y): &(i32, i32)| {
                    let (x, y) = (f64::from(x) * pitch_mm, f64::from(y) * pitch_y_mm);
                    x * x + y * y <= radius_mm * radius_mm * (1.0 + 2e-9)
                };
                let is_on = if grows {
                    near.any(|at| within(&at) && is(at))
                } else {
                    near.all(|at| !within(&at) || is(at))
                };
                let pixel = row as u32 / samples.rows * columns + column as u32 / samples.columns;
                counts[pixel as usize] += u8::from(is_on);
            }
        }
    }
    counts
}

/// The number of lit samples of every pixel of a layer of masks.
fn found(masks: &Masks, layer: usize) -> Vec<u8> {
    let (grid, window) = (&masks.grid, masks.window);
    let mut cursor = masks.cursor();
    cursor.seek(masks, layer);
    let mut counts = vec![0; grid.pixels()];
    for row in 0..window.rows {
        for column in 0..window.row_pixels() {
            let pixel = row * window.row_pixels() + column;
            let count = match cursor.light() {
                Light::Bits(bits) => bits[pixel / 8] >> (7 - pixel % 8) & 1,
                Light::Samples(lit) => lit[pixel],
            };
            let (row, column) = (row + window.first_row, column + window.first_byte * 8);
            if column < grid.width as usize {
                counts[row * grid.width as usize + column] = count;
            } else {
                assert_eq!(count, 0);
            }
        }
    }
    counts
}

#[test]
fn every_pixel_agrees_with_a_naive_erosion() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let size = mesh.bounds().size();
        let pitch_mm = size.x.max(size.y) / 23.0;
        // Narrow compared with the model, so that dilation meets the border of the screen.
        let grid = Grid::plate(&mesh.bounds(), [29, 33], [pitch_mm, pitch_mm * 0.9]).unwrap();
        let plan = uniform_plan(size.z, 7.0);
        for (level, xy, z) in [
            (1, 1.3, 0.0),
            (1, -2.2, 0.07),
            (2, 0.0, 0.2),
            (4, 0.8, 0.03),
            (4, -1.7, 0.0),
        ] {
            let samples = Samples::of_level(level).unwrap();
            let [ldi, whole] = rays(&mesh, &grid, samples);
            let compensation = Compensation {
                xy_mm: xy * pitch_mm,
                bottom_xy_mm: Some(2.4 * pitch_mm),
                faded_layers: 2,
                z_mm: z * size.z,
            };
            let compensations = Compensations {
                xy_mm: compensation.of_layers_mm(plan.layers(), 2),
                raise: Raise::By(compensation.z_mm),
                least_mm: 0.0,
            };
            let masks = Masks::compensated(
                RayImage::Kept(&ldi),
                &plan,
                &grid,
                samples,
                Side::Above,
                &compensations,
            );
            let runs = masks.reader().next(plan.layers());
            for layer in 0..plan.layers() {
                let expected = naive(&whole, &plan, layer, samples, &compensations);
                assert_eq!(
                    found(&masks, layer),
                    expected,
                    "{name}, level {level}, {xy}, {z}, layer {layer}"
                );
                let mut greys = vec![0; expected.len()];
                for run in runs.of_layer(layer) {
                    greys[run.first as usize..][..run.pixels as usize].fill(run.grey);
                }
                let total = samples.total();
                let expected = expected.iter();
                let expected: Vec<u8> = expected
                    .map(|&lit| ((255 * u32::from(lit) + total / 2) / total) as u8)
                    .collect();
                assert_eq!(greys, expected, "{name}, level {level}, layer {layer}");
            }
        }
    }
}

#[test]
fn without_compensation_nothing_changes() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let grid = Grid::around(&mesh.bounds(), 60).unwrap();
        let plan = uniform_plan(mesh.bounds().size().z, 9.0);
        let samples = Samples::of_level(2).unwrap();
        let [ldi, _] = rays(&mesh, &grid, samples);
        let compensations = Compensations {
            xy_mm: vec![0.0; plan.layers()],
            raise: Raise::By(0.0),
            least_mm: 0.0,
        };
        for side in [Side::Above, Side::Below] {
            let plain = Masks::new(&ldi, &plan, &grid, samples, side);
            let compensated = Masks::compensated(
                RayImage::Kept(&ldi),
                &plan,
                &grid,
                samples,
                side,
                &compensations,
            );
            let all = |masks: &Masks| masks.reader().next(plan.layers());
            assert_eq!(all(&plain), all(&compensated), "{name}");
        }
    }
}

/// 100 pixels wide, so that sides are whole numbers of pixels.
#[test]
fn sides_of_a_cube_fade_from_the_elephants_foot() {
    let mesh = on_plate(&solids::cube(10.0));
    let grid = Grid::plate(&mesh.bounds(), [200, 200], [0.1, 0.1]).unwrap();
    let plan = uniform_plan(10.0, 10.0);
    let [ldi, _] = rays(&mesh, &grid, Samples::ONE);
    let compensation = Compensation {
        xy_mm: 0.1,
        bottom_xy_mm: Some(0.5),
        faded_layers: 3,
        z_mm: 0.0,
    };
    let compensations = Compensations {
        xy_mm: compensation.of_layers_mm(plan.layers(), 2),
        raise: Raise::By(0.0),
        least_mm: 0.0,
    };
    let masks = Masks::compensated(
        RayImage::Kept(&ldi),
        &plan,
        &grid,
        Samples::ONE,
        Side::Above,
        &compensations,
    );
    let sides: Vec<u64> = (0..plan.layers())
        .map(|layer| {
            let mut cursor = masks.cursor();
            cursor.seek(&masks, layer);
            cursor.lit_pixels().isqrt()
        })
        .collect();
    // A side loses a pixel at each end for each 0.1 mm.
    assert_eq!(sides, [90, 90, 92, 94, 96, 98, 98, 98, 98, 98]);
}

/// The rule of PrusaSlicer, in whole layers: a pixel stays lit if it is lit in the n layers below as well.
#[test]
fn raised_entries_are_those_of_counted_layers() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let grid = Grid::around(&mesh.bounds(), 40).unwrap();
        // No flat of these solids is at a height where layers are sampled.
        let plan = uniform_plan(mesh.bounds().size().z, 39.0);
        let [ldi, _] = rays(&mesh, &grid, Samples::ONE);
        let plain = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
        let layers = 3;
        let compensations = Compensations {
            xy_mm: vec![0.0; plan.layers()],
            raise: Raise::By(plan.thickness_mm()[0] * layers as f64),
            least_mm: 0.0,
        };
        let raised = Masks::compensated(
            RayImage::Kept(&ldi),
            &plan,
            &grid,
            Samples::ONE,
            Side::Above,
            &compensations,
        );
        let lit: Vec<Vec<u8>> = (0..plan.layers())
            .map(|layer| found(&plain, layer))
            .collect();
        let (mut pixels, mut differing) = (0, 0);
        for layer in 0..plan.layers() {
            let below = &lit[layer.saturating_sub(layers)..=layer];
            for (pixel, now) in found(&raised, layer).into_iter().enumerate() {
                let counted = below.iter().map(|layer| layer[pixel]).min().unwrap_or(0);
                pixels += u32::from(counted);
                differing += u32::from(counted != now);
            }
        }
        // Gaps thinner than a layer are seen by rays alone, and heights may differ by rounding.
        assert!(differing * 200 <= pixels, "{name}: {differing} of {pixels}");
    }
}

#[test]
fn resins_and_printers_may_name_it_as_they_did_at_first() {
    let text = r#"{"growth": {"xy_mm": 0.05}}"#;
    let resin: Resin = serde_json::from_str(text).unwrap();
    assert_eq!(resin.compensation.xy_mm, 0.05);
    let mut printer = serde_json::to_value(&PRINTERS[0]).unwrap();
    let fields = printer.as_object_mut().unwrap();
    let none = fields.remove("compensation").unwrap();
    fields.insert("growth".to_owned(), none);
    let read: Printer = serde_json::from_value(printer).unwrap();
    assert_eq!(read, *PRINTERS[0]);
}

#[test]
fn compensation_has_bounds_and_adds_up() {
    let printer = Compensation {
        xy_mm: 0.02,
        ..Compensation::default()
    };
    let resin = Compensation {
        xy_mm: 0.03,
        bottom_xy_mm: Some(0.1),
        faded_layers: 5,
        z_mm: 0.1,
    };
    assert!(Compensation::default().is_none());
    assert_eq!(
        resin.and(printer),
        Compensation {
            xy_mm: 0.05,
            bottom_xy_mm: Some(0.1 + 0.02),
            faded_layers: 5,
            z_mm: 0.1
        }
    );
    assert!(resin.check().is_ok());
    for bad in [
        Compensation {
            xy_mm: 1.5,
            ..printer
        },
        Compensation {
            xy_mm: f64::NAN,
            ..printer
        },
        Compensation {
            z_mm: -0.1,
            ..printer
        },
        Compensation {
            bottom_xy_mm: Some(-2.0),
            ..printer
        },
    ] {
        assert!(bad.check().is_err(), "{bad:?}");
    }
}
