//! Print-through: depths in closed form, doses against a naive sum, masks measured as pixels, and prints measured by simulation.

use cusp_slicer::archive::read::PrintFile;
use cusp_slicer::cure::{Bridge, Cure, Light, fit};
use cusp_slicer::format::Format;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{Backend, Calibration, Options, Planner, Report, Snap};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::{PrintThrough, Resin};
use cusp_slicer::simulation::{Knowledge, Original, Simulation, simulate};
use cusp_slicer::warning::Warning;
use glam::Vec3;

use crate::common::{Slicer, assert_near, binary_stl, quiet, solids};

fn resin(overcure_mm: f64, retained: f64) -> Resin {
    Resin {
        print_through: Some(PrintThrough {
            overcure_mm,
            retained,
        }),
        ..Resin::default()
    }
}

/// The doses of layers of these thicknesses, exposed by the resin's law.
fn cure(resin: &Resin, thickness_mm: &[f64]) -> Cure {
    let mut boundaries_mm = vec![0.0];
    for &thickness in thickness_mm {
        boundaries_mm.push(boundaries_mm[boundaries_mm.len() - 1] + thickness);
    }
    let exposures_s: Vec<f64> = thickness_mm
        .iter()
        .map(|&it| resin.exposure_s(it))
        .collect();
    let print_through = resin.print_through.unwrap();
    Cure::new(&print_through, resin, boundaries_mm, &exposures_s)
}

#[test]
fn depths_of_equal_layers_are_those_of_a_geometric_sum() {
    for (thickness_mm, known_mm) in [(0.05, 0.189), (0.1, 0.108), (0.15, 0.069)] {
        let layers = vec![thickness_mm; 200];
        let fade = (-thickness_mm / 0.15_f64).exp();
        for (overcure_mm, retained) in [(0.0, 1.0), (0.03, 1.0), (0.03, 0.4), (0.03, 0.0)] {
            let cure = cure(&resin(overcure_mm, retained), &layers);
            let depth = |sum: f64| overcure_mm + 0.15 * (1.0 + retained * (sum - 1.0)).ln();
            let many_mm = depth(1.0 / (1.0 - fade));
            assert_near(cure.depth_mm(3), many_mm, 2e-4);
            for count in [1, 2, 7, 40] {
                let few_mm = depth((1.0 - fade.powi(count as i32)) / (1.0 - fade));
                let bottom_mm = cure.bottom_mm(9, 9 + count, None);
                assert_near(9.0 * thickness_mm - bottom_mm, few_mm, 2e-4);
            }
            if (overcure_mm, retained) == (0.0, 1.0) {
                assert_near(many_mm, known_mm, 5e-4);
            }
        }
    }
}

#[test]
fn doses_are_those_of_a_sum_over_all_lit_layers() {
    let mut rng = fastrand::Rng::with_seed(11);
    for _ in 0..300 {
        let resin = Resin {
            penetration_mm: 0.08 + 0.2 * rng.f64(),
            ..resin(0.05 * rng.f64(), if rng.bool() { 1.0 } else { rng.f64() })
        };
        let print_through = resin.print_through.unwrap();
        let layers = 30 + rng.usize(..60);
        let mut boundaries_mm = vec![0.0];
        for layer in 0..layers {
            boundaries_mm.push(boundaries_mm[layer] + 0.02 + 0.13 * rng.f64());
        }
        // Any exposures, with long ones among them.
        let exposures_s: Vec<f64> = (0..layers)
            .map(|_| rng.f64() * if rng.u8(..8) == 0 { 30.0 } else { 6.0 } + 1.0)
            .collect();
        let cure = Cure::new(&print_through, &resin, boundaries_mm.clone(), &exposures_s);
        // Two lit ranges of a column.
        let low = 2 + rng.usize(..6);
        let low_end = low + 1 + rng.usize(..6);
        let high = low_end + 1 + rng.usize(..4);
        let high_end = (high + 1 + rng.usize(..12)).min(layers);
        let dose = |layer: usize, z_mm: f64| {
            let depth_mm = boundaries_mm[layer + 1] - z_mm;
            let reference_mm = resin.layer_mm + print_through.overcure_mm;
            exposures_s[layer] / 3.0 * ((reference_mm - depth_mm) / resin.penetration_mm).exp()
        };
        // On a fine grid, from the bottom of a range down to where resin stays liquid.
        let solid_to_mm = |first: usize, earlier: &[usize]| {
            let mut z_mm = boundaries_mm[first] + 0.3;
            let counts = |z_mm: f64| {
                let sum: f64 = earlier.iter().map(|&it| dose(it, z_mm)).sum();
                dose(first, z_mm) + print_through.retained * sum
            };
            while counts(z_mm) >= 1.0 {
                z_mm -= 1e-4;
            }
            z_mm
        };
        let above: Vec<usize> = (high + 1..high_end).collect();
        assert_near(
            cure.bottom_mm(high, high_end, None),
            solid_to_mm(high, &above),
            2e-4,
        );
        let light: Light = cure.light_below(high, high_end, None);
        let all: Vec<usize> = (low + 1..low_end).chain(high..high_end).collect();
        let bottom_mm = cure.bottom_mm(low, low_end, Some(light));
        assert_near(bottom_mm, solid_to_mm(low, &all), 2e-4);
    }
}

/// Boxes from one corner to the other.
fn boxes(corners: &[[[f32; 3]; 2]]) -> solids::Triangles {
    let boxes = corners.iter().flat_map(|&[from, to]| {
        let [from, to] = [from, to].map(Vec3::from);
        solids::moved(&solids::cuboid(to - from), from)
    });
    boxes.collect()
}

fn options(resin: Resin) -> Options {
    Options {
        pitch_mm: Some(0.05),
        format: Some(Format::Png),
        backend: Backend::Cpu,
        planner: Planner::Uniform { layer_mm: 0.05 },
        snap: Snap::Off,
        resin,
        ..Options::default()
    }
}

/// The report of a print, and its print file.
fn sliced(triangles: &solids::Triangles, options: &Options) -> (Report, Vec<u8>) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let report = pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
    let report = report.clone();
    let (bytes, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
    (report, bytes)
}

/// The print as it cures, measured against the model.
fn cured(triangles: &solids::Triangles, print_file: &[u8], resin: &Resin) -> Simulation {
    let contents = cusp_slicer::model::read::read(&binary_stl(triangles)).unwrap();
    let knowledge = Knowledge {
        cure: Some(resin.clone()),
        ..Knowledge::default()
    };
    simulate(
        &[Original::of(&contents).unwrap()],
        print_file,
        &knowledge,
        &mut silent,
    )
    .unwrap()
}

#[test]
fn a_table_prints_at_its_height_and_without_compensation_too_low() {
    // The top, 3 mm thick, on one leg.
    let table = boxes(&[
        [[0.0, 0.0, 0.0], [3.0, 3.0, 4.0]],
        [[0.0, 0.0, 3.0], [12.0, 3.0, 6.0]],
    ]);
    let resin = resin(0.0, 1.0);
    let (report, bytes) = sliced(&table, &options(resin.clone()));
    let found = report.print_through.unwrap();
    assert_near(found.before.largest_mm, 0.189, 1e-3);
    // 0.2 mm higher cures 0.011 mm too high.
    assert_near(found.after.largest_mm, 0.011, 1e-3);
    assert_eq!((found.thin_roofs_mm2, found.closed_gaps_mm2), (0.0, 0.0));
    let off = Options {
        resin: Resin {
            print_through: None,
            ..resin.clone()
        },
        ..options(resin.clone())
    };
    let (plain_report, plain) = sliced(&table, &off);
    assert!(plain_report.print_through.is_none());
    for (bytes, wanted_mm) in [(&bytes, 0.011), (&plain, 0.189)] {
        let simulation = cured(&table, bytes, &resin);
        let most_mm = simulation
            .print_to_model
            .max_mm
            .max(simulation.model_to_print.max_mm);
        // To a step of simulation, and half a pixel at walls.
        let slack_mm = simulation.half_pixel_diagonal_mm;
        assert!(most_mm <= wanted_mm + 0.003_f64.max(slack_mm), "{most_mm}");
        assert!(most_mm >= wanted_mm - 0.003, "{most_mm}");
    }
}

#[test]
fn thin_roofs_and_gaps_that_close_are_named() {
    // Roofs of one, two and twelve layers, on posts; and a gap of 0.05 mm, which light closes.
    for (roof_mm, thin_mm2) in [(0.05, 27.0), (0.1, 27.0), (0.6, 0.0)] {
        let roof = boxes(&[
            [[0.0, 0.0, 0.0], [3.0, 3.0, 3.0]],
            [[0.0, 0.0, 3.0], [12.0, 3.0, 3.0 + roof_mm]],
        ]);
        // Its own layer cures 0.12 mm below itself, so even the last one of two is too deep.
        let (report, _) = sliced(&roof, &options(resin(0.12, 1.0)));
        let found = report.print_through.unwrap();
        assert_near(found.thin_roofs_mm2, thin_mm2, 0.5);
        let is_named = |warning: &Warning| matches!(warning, Warning::ThinRoofs { .. });
        assert_eq!(report.all_warnings().iter().any(is_named), thin_mm2 > 0.0);
    }
    let gap = boxes(&[
        [[0.0, 0.0, 0.0], [12.0, 3.0, 3.0]],
        [[0.0, 0.0, 0.0], [3.0, 3.0, 3.15]],
        [[0.0, 0.0, 3.05], [12.0, 3.0, 3.15]],
    ]);
    let (report, _) = sliced(&gap, &options(resin(0.12, 1.0)));
    assert_near(report.print_through.unwrap().closed_gaps_mm2, 27.0, 0.5);
    let is_named = |warning: &Warning| matches!(warning, Warning::ClosedGaps { .. });
    assert!(report.all_warnings().iter().any(is_named));
}

#[test]
fn measured_bridges_give_the_resin_back() {
    let planted = Resin {
        penetration_mm: 0.12,
        ..resin(0.03, 0.7)
    };
    // Exposures are those of the resin that the piece was printed with, whose penetration was a guess.
    let printed_with = Resin::default();
    let bridges = |noise_mm: f64| {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut all = Vec::new();
        for layer_mm in [0.05, 0.1] {
            for layers in Calibration::BRIDGES {
                let exposures_s = vec![printed_with.exposure_s(layer_mm); usize::from(layers) + 1];
                let boundaries_mm = (0..=exposures_s.len()).map(|it| it as f64 * layer_mm);
                let print_through = planted.print_through.unwrap();
                let cure = Cure::new(
                    &print_through,
                    &planted,
                    boundaries_mm.collect(),
                    &exposures_s,
                );
                let top = exposures_s.len();
                all.push(Bridge {
                    layer_mm,
                    layers: u32::from(layers),
                    measured_mm: top as f64 * layer_mm - cure.bottom_mm(1, top, None)
                        + noise_mm * (rng.f64() - 0.5),
                });
            }
        }
        all
    };
    let found = fit(&bridges(0.0), &printed_with).unwrap();
    assert_near(found.penetration_mm, 0.12, 2e-3);
    assert_near(found.print_through.overcure_mm, 0.03, 2e-3);
    assert_near(found.print_through.retained, 0.7, 0.03);
    assert!(found.residual_mm < 1e-3, "{}", found.residual_mm);
    // With a caliper's hundredth, the interval holds what was planted.
    let found = fit(&bridges(0.02), &printed_with).unwrap();
    for (name, value, [low, high]) in [
        ("penetration", 0.12, found.penetration_within_mm),
        ("overcure", 0.03, found.overcure_within_mm),
        ("retained", 0.7, found.retained_within),
    ] {
        assert!((low..=high).contains(&value), "{name}: {low} to {high}");
    }
    assert!(found.residual_mm < 0.01, "{}", found.residual_mm);
    assert!(fit(&bridges(0.0)[..3], &printed_with).is_none());
}

#[test]
fn the_piece_is_one_body_whose_bridges_have_their_layers() {
    let options = Options {
        resin: resin(0.02, 1.0),
        ..Options::default()
    };
    let piece = Calibration::cure(&options, [0.05, 0.1]).unwrap();
    let mut bytes = Vec::new();
    let report = pollster::block_on(piece.write(&mut bytes, &mut quiet))
        .unwrap()
        .1;
    // It measures what compensation would hide.
    assert!(report.print_through.is_none());
    let stl = piece.stl();
    let mut slicer = Slicer::load(&stl).unwrap();
    pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    assert_eq!(found.bodies, 1);
    let sections = piece.sections();
    assert_eq!(sections[1].layers, 8);
    // Between two posts in front and behind, each bridge is as thick as its layers.
    let file = PrintFile::open(&bytes[..]).unwrap();
    for (row, layer_mm) in [(0, 0.05), (1, 0.1)] {
        for (place, layers) in Calibration::BRIDGES.into_iter().enumerate() {
            let [x_mm, y_mm] = [11.0 * place as f64 + 7.0, 12.0 * f64::from(row) + 7.5];
            let lit_mm: f64 = file
                .layers()
                .iter()
                .enumerate()
                .filter(|(_, layer)| layer.z_mm > 2.0)
                .filter(|&(layer, _)| {
                    let pitch = file.metadata().pixel_mm_from_above();
                    let [width, height] = file.metadata().pixels_from_above();
                    let column = f64::from(width) / 2.0 + (x_mm - 34.5) / pitch[0];
                    let line = f64::from(height) / 2.0 - (y_mm - 12.0) / pitch[1];
                    let mask = file.mask(layer, file.metadata().flips()).unwrap();
                    mask.is_lit(column as i32, line as i32)
                })
                .map(|(_, layer)| layer.thickness_mm)
                .sum();
            assert_near(lit_mm, layer_mm * f64::from(layers), 1e-6);
        }
    }
}
