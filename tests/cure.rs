//! Print-through: depths in closed form, doses against a naive sum, masks measured as pixels, and prints measured by simulation.

use cusp_slicer::archive::read::PrintFile;
use cusp_slicer::calibration::Calibration;
use cusp_slicer::compensation::Compensation;
use cusp_slicer::cure::{Bridge, Cure, LitRange, fit};
use cusp_slicer::format::Format;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::job::{
    Backend, Job, JobOptions, ModelOptions, Options, Placement, Planner, Report, Snap,
};
use cusp_slicer::prepare::{Hollowing, SupportProfile, Supporting};
use cusp_slicer::profile::Metric;
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
                let bottom_mm = cure.bottom_mm(LitRange::white(9, 9 + count), None);
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
            cure.bottom_mm(LitRange::white(high, high_end), None),
            solid_to_mm(high, &above),
            2e-4,
        );
        let light = cure.light_below(LitRange::white(high, high_end), None, low_end);
        let all: Vec<usize> = (low + 1..low_end).chain(high..high_end).collect();
        let bottom_mm = cure.bottom_mm(LitRange::white(low, low_end), light);
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
    let table = table();
    let resin = resin(0.0, 1.0);
    let (report, bytes) = sliced(&table, &options(resin.clone()));
    let found = report.print_through.clone().unwrap();
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

/// Checks that the only finding of a kind is the 9 by 3 mm beside the post, between these heights.
#[track_caller]
fn assert_found(triangles: &solids::Triangles, code: Code, wanted_mm: Option<[f64; 2]>) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let options = options(resin(0.12, 1.0));
    pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    let checked = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    let found = checked.findings.iter().filter(|it| it.code == code);
    let found: Vec<_> = found.collect();
    assert_eq!(found.len(), usize::from(wanted_mm.is_some()), "{found:?}");
    for (finding, [from_mm, to_mm]) in found.into_iter().zip(wanted_mm) {
        assert_near(finding.area_mm2, 27.0, 0.5);
        let [low, high] = finding.bounds_mm;
        let wanted = [(low, [-3.0, -1.5, from_mm]), (high, [6.0, 1.5, to_mm])];
        for (corner, wanted) in wanted {
            for (at_mm, wanted_mm) in corner.into_iter().zip(wanted) {
                assert_near(at_mm, wanted_mm, 0.05 + 1e-9);
            }
        }
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
        let found = report.print_through.clone().unwrap();
        assert_near(found.thin_roofs_mm2, thin_mm2, 0.5);
        let off_mm = [[3.0, 3.05]];
        assert_eq!(found.off_mm, &off_mm[..usize::from(thin_mm2 > 0.0)]);
        let is_named = |warning: &Warning| matches!(warning, Warning::ThinRoofs { .. });
        assert_eq!(report.all_warnings().iter().any(is_named), thin_mm2 > 0.0);
        let last_mm = f64::from(roof_mm) + 3.0;
        let wanted = (thin_mm2 > 0.0).then_some([last_mm - 0.05, last_mm]);
        assert_found(&roof, Code::ThinRoof, wanted);
    }
    let gap = boxes(&[
        [[0.0, 0.0, 0.0], [12.0, 3.0, 3.0]],
        [[0.0, 0.0, 0.0], [3.0, 3.0, 3.15]],
        [[0.0, 0.0, 3.05], [12.0, 3.0, 3.15]],
    ]);
    let (report, _) = sliced(&gap, &options(resin(0.12, 1.0)));
    assert_near(
        report.print_through.clone().unwrap().closed_gaps_mm2,
        27.0,
        0.5,
    );
    let is_named = |warning: &Warning| matches!(warning, Warning::ClosedGaps { .. });
    assert!(report.all_warnings().iter().any(is_named));
    assert_found(&gap, Code::ClosedGap, Some([3.0, 3.05]));
    // A gap within a layer of several heights: what is below it and above it are the same samples, which are lit once.
    let thin = boxes(&[
        [[0.0, 0.0, 0.0], [12.0, 3.0, 3.01]],
        [[0.0, 0.0, 0.0], [3.0, 3.0, 3.4]],
        [[0.0, 0.0, 3.03], [12.0, 3.0, 3.4]],
    ]);
    let fine = Options {
        antialias: 8,
        ..options(resin(0.0, 1.0))
    };
    let (_, bytes) = sliced(&thin, &fine);
    let lit = lit_mm(&bytes, [3.0, 0.0]);
    assert!(lit[0][1] > 2.95 && lit[lit.len() - 1][1] > 3.35, "{lit:?}");
}

/// Heights between which pixels at this place are lit by half or more.
fn lit_mm(print_file: &[u8], [x_mm, y_mm]: [f64; 2]) -> Vec<[f64; 2]> {
    let file = PrintFile::open(print_file).unwrap();
    let pitch_mm = file.metadata().pixel_mm_from_above();
    let [width, height] = file.metadata().pixels_from_above();
    let column = f64::from(width) / 2.0 + x_mm / pitch_mm[0];
    let row = f64::from(height) / 2.0 - y_mm / pitch_mm[1];
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    for (number, layer) in file.layers().iter().enumerate() {
        let mask = file.mask(number, file.metadata().flips()).unwrap();
        if !mask.is_lit(column as i32, row as i32) {
            continue;
        }
        let bottom_mm = layer.z_mm - layer.thickness_mm;
        match ranges.last_mut() {
            Some(last) if (last[1] - bottom_mm).abs() < 1e-6 => last[1] = layer.z_mm,
            _ => ranges.push([bottom_mm, layer.z_mm]),
        }
    }
    ranges
}

/// A plate 3 mm thick on a leg at one end, whose free part begins 9 mm from the middle of the other.
fn table() -> solids::Triangles {
    boxes(&[
        [[0.0, 0.0, 0.0], [3.0, 6.0, 4.0]],
        [[0.0, 0.0, 3.0], [12.0, 6.0, 6.0]],
    ])
}

#[test]
fn bottoms_rise_whatever_else_the_masks_do() {
    let plain = options(resin(0.0, 1.0));
    let narrower = Compensation {
        xy_mm: 0.1,
        ..Compensation::default()
    };
    let variants = [
        ("alone", plain.clone()),
        (
            "anti-aliased",
            Options {
                antialias: 4,
                ..plain.clone()
            },
        ),
        (
            "narrower",
            Options {
                resin: Resin {
                    compensation: narrower,
                    ..plain.resin.clone()
                },
                ..plain.clone()
            },
        ),
        (
            "narrower and anti-aliased",
            Options {
                antialias: 4,
                resin: Resin {
                    compensation: narrower,
                    ..plain.resin.clone()
                },
                ..plain.clone()
            },
        ),
    ];
    let at_mm = [3.0, 0.0];
    for (name, options) in variants {
        let off = Options {
            resin: Resin {
                print_through: None,
                ..options.resin.clone()
            },
            ..options.clone()
        };
        // Four layers of 0.05 mm, as a table of many layers cures 0.189 mm deeper.
        for (options, bottom_mm) in [(&options, 3.2), (&off, 3.0)] {
            let (_, bytes) = sliced(&table(), options);
            let lit = lit_mm(&bytes, at_mm);
            assert_eq!(lit.len(), 1, "{name}: {lit:?}");
            assert_near(lit[0][0], bottom_mm, 1e-6);
            assert_near(lit[0][1], 6.0, 1e-6);
        }
    }
}

#[test]
fn ceilings_of_voids_rise_and_supports_reach_what_they_hold() {
    // A void of 6 mm in a block of 10 mm: its ceiling is at 8 mm.
    let block = boxes(&[[[0.0, 0.0, 0.0], [10.0, 10.0, 10.0]]]);
    let hollow = Options {
        hollow: Some(Hollowing {
            pillars: false,
            ..Hollowing::default()
        }),
        ..options(resin(0.0, 1.0))
    };
    let (report, bytes) = sliced(&block, &hollow);
    let lit = lit_mm(&bytes, [0.0, 0.0]);
    assert_eq!(lit.len(), 2, "{lit:?}");
    let resolution_mm = report.models[0].hollowed.as_ref().unwrap().resolution_mm;
    assert_near(lit[0][1], 2.0, resolution_mm + 0.03);
    assert_near(lit[1][0], 8.2, resolution_mm + 0.03);
    // A table that is held: pixels of its contacts are lit without a gap, as tips end within the table.
    let supported = Options {
        pixels: Some([400, 400]),
        supports: Some(Supporting {
            profile: Some(SupportProfile {
                lift_mm: 0.0,
                ..SupportProfile::default()
            }),
            ..Supporting::default()
        }),
        ..options(resin(0.0, 1.0))
    };
    let mut slicer = Slicer::load(&binary_stl(&table())).unwrap();
    pollster::block_on(slicer.plan(&supported, &mut quiet)).unwrap();
    let (bytes, report) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
    let supports = report.models[0].supported.as_ref().unwrap();
    let free: Vec<_> = supports
        .points
        .iter()
        .filter(|it| (it.at_mm[2] - 3.0).abs() < 0.01)
        .collect();
    assert!(free.len() > 2);
    for point in free {
        let [x_mm, y_mm, _] = point.at_mm;
        let lit = lit_mm(&bytes, [x_mm, y_mm]);
        assert!(lit[0][0] < 2.95, "{lit:?}");
        let [.., [_, top_mm]] = lit[..] else {
            unreachable!()
        };
        assert_near(top_mm, 6.0, 0.03);
        let tips = lit.windows(2).map(|pair| pair[1][0] - pair[0][1]);
        assert!(tips.fold(0.0, f64::max) < 0.01, "{lit:?}");
    }
}

#[test]
fn copies_on_a_plate_rise_like_a_single_model() {
    let mut job = Job::new(vec![
        Slicer::load(&binary_stl(&table())).unwrap().into_model(),
    ]);
    let options = JobOptions {
        options: Options {
            pixels: Some([600, 400]),
            ..options(resin(0.0, 1.0))
        },
        models: vec![ModelOptions {
            copies: 2,
            ..ModelOptions::default()
        }],
        placements: [-7.5, 7.5]
            .map(|x_mm| Placement {
                model: 0,
                plate: 0,
                x_mm,
                y_mm: 0.0,
                turn_deg: 0,
            })
            .to_vec(),
        ..JobOptions::default()
    };
    let report = pollster::block_on(job.plan(&options, &mut quiet)).unwrap();
    let found = report.plates[0].print_through.clone().unwrap();
    assert_near(found.after.largest_mm, 0.011, 1e-3);
    let bytes = job.write_archive(0, Vec::new(), &mut quiet).unwrap().0;
    for x_mm in [-4.5, 10.5] {
        assert_eq!(lit_mm(&bytes, [x_mm, 0.0]).len(), 1);
        assert_near(lit_mm(&bytes, [x_mm, 0.0])[0][0], 3.2, 1e-6);
    }
}

/// Solids with surfaces that face down in every way, well above the bottom layers.
fn undersides() -> [(&'static str, solids::Triangles); 4] {
    let hole = solids::profiled(
        &std::array::from_fn::<_, 96, _>(|place| {
            let angle = std::f32::consts::TAU * place as f32 / 96.0;
            [2.5 * angle.cos(), 2.5 * angle.sin()]
        }),
        6.0,
    );
    let mut block = boxes(&[[[-4.0, 0.0, 0.0], [4.0, 10.0, 10.0]]]);
    block.extend(solids::inverted(&solids::moved(
        &hole,
        Vec3::new(0.0, 2.0, 5.0),
    )));
    let mut arch = boxes(&[
        [[-5.0, 0.0, 0.0], [-4.0, 4.0, 7.0]],
        [[4.0, 0.0, 0.0], [5.0, 4.0, 7.0]],
    ]);
    let at = |place: u32| {
        let angle = std::f32::consts::PI * (1.0 - place as f32 / 60.0);
        [4.0 * angle.cos(), 2.0 + 4.0 * angle.sin()]
    };
    for place in 0..60 {
        let ([x, z], [next_x, next_z]) = (at(place), at(place + 1));
        arch.extend(solids::profiled(
            &[[x, z], [next_x, next_z], [next_x, 7.0], [x, 7.0]],
            4.0,
        ));
    }
    // Ceilings at heights that no layer begins at.
    let mut stairs = boxes(&[[[0.0, 0.0, 0.0], [2.0, 4.0, 8.0]]]);
    for step in 0..6 {
        let (x, z) = (2.0 + step as f32, 3.0 + 0.413 * step as f32);
        stairs.extend(boxes(&[[[x - 0.5, 0.0, z], [x + 1.0, 4.0, 8.0]]]));
    }
    let mut ball = solids::moved(&solids::sphere(3.0, 6), Vec3::new(0.0, 0.0, 5.0));
    ball.extend(boxes(&[[[-0.5, -0.5, 0.0], [0.5, 0.5, 4.0]]]));
    [
        ("hole", block),
        ("arch", arch),
        ("stairs", stairs),
        ("ball", ball),
    ]
}

#[test]
fn undersides_print_within_half_a_step() {
    let resin = resin(0.02, 1.0);
    for (name, solid) in undersides() {
        let (report, bytes) = sliced(&solid, &options(resin.clone()));
        let found = report.print_through.clone().unwrap();
        // Half of a layer, and the slope across half of a pixel, which columns cannot follow.
        let measured = cured(&solid, &bytes, &resin);
        let slack_mm = measured.half_pixel_diagonal_mm + 0.005;
        let largest_mm = |it: &Simulation| it.print_to_model.max_mm.max(it.model_to_print.max_mm);
        assert!(
            largest_mm(&measured) <= 0.025 + slack_mm,
            "{name}: {measured:?}"
        );
        assert!(found.after.mean_mm < 0.016, "{name}: {found:?}");
        assert!(found.before.mean_mm > 0.15, "{name}: {found:?}");
    }
}

/// A printer whose greys cure in proportion.
fn with_greys(options: Options) -> Options {
    let printer = serde_json::json!({
        "pixels": [400, 400], "pitch_um": [50, 50], "volume_mm": [20, 20, 100], "step_mm": 0.01,
        "proportional_greys": true, "format": "png",
    });
    Options {
        printer: Some(serde_json::from_value(printer).unwrap()),
        antialias: 8,
        pitch_mm: None,
        format: None,
        ..options
    }
}

#[test]
fn the_grey_of_a_bottom_is_the_nearest() {
    let mut rng = fastrand::Rng::with_seed(3);
    for _ in 0..400 {
        let resin = Resin {
            penetration_mm: 0.08 + 0.2 * rng.f64(),
            ..resin(0.05 * rng.f64(), if rng.bool() { 1.0 } else { rng.f64() })
        };
        let thickness_mm: Vec<f64> = (0..40).map(|_| 0.02 + 0.13 * rng.f64()).collect();
        let cure = cure(&resin, &thickness_mm);
        let all = LitRange::white(5 + rng.usize(..20), 39);
        let z_mm = cure.bottom_mm(all, None) + 0.3 * rng.f64();
        let error_mm = |range| (cure.bottom_mm(range, None) - z_mm).abs();
        for greys in [2, 4, 8] {
            let found = cure.raised(all.first..all.end, None, z_mm, greys);
            let every = (all.first..all.end).flat_map(|first| {
                let steps = (1..=greys).map(move |step| f64::from(step) / f64::from(greys));
                steps.map(move |brightness| LitRange {
                    first,
                    brightness,
                    end: all.end,
                })
            });
            let least_mm = every.map(error_mm).fold(f64::INFINITY, f64::min);
            // Where doses of layers do not simply add up, others may be nearer.
            let is_sum = resin.print_through.unwrap().retained == 1.0;
            let wanted_mm = if is_sum {
                least_mm + 1e-9
            } else {
                error_mm(cure.raised(all.first..all.end, None, z_mm, 1))
            };
            assert!(
                error_mm(found) <= wanted_mm,
                "{found:?}: {} for {wanted_mm}",
                error_mm(found)
            );
        }
    }
}

#[test]
fn greys_put_bottoms_between_those_of_layers() {
    let resin = resin(0.02, 1.0);
    let thick = Options {
        planner: Planner::Uniform { layer_mm: 0.1 },
        ..options(resin.clone())
    };
    let printer = with_greys(thick);
    for (name, solid) in undersides() {
        let [grey, white] = [8, 1].map(|antialias| {
            let options = Options {
                antialias,
                ..printer.clone()
            };
            let (report, bytes) = sliced(&solid, &options);
            let measured = cured(&solid, &bytes, &resin);
            (
                report.print_through.clone().unwrap().after,
                measured.print_to_model,
            )
        });
        // Eighths of a layer: without, half of one.
        assert!(grey.0.mean_mm < 0.006, "{name}: {grey:?}");
        assert!(white.0.mean_mm > 0.02, "{name}: {white:?}");
        assert!(grey.1.mean_mm < white.1.mean_mm, "{name}: {grey:?}");
    }
}

#[test]
fn greys_save_layers_at_the_same_distance() {
    let resin = resin(0.02, 1.0);
    let adaptive = Options {
        planner: Planner::Optimal,
        metric: Metric::Deviation,
        ..options(resin.clone())
    };
    let printer = with_greys(adaptive);
    // Facets that look up are upright, so that those that look down decide.
    let cone = solids::cone(4.0, 6.0, 24).into_iter();
    let cone = cone.map(|corners| corners.map(|it| Vec3::new(it.x, it.y, 9.0 - it.z)));
    let mut cup = solids::inverted(&cone.collect::<Vec<_>>());
    cup.extend(boxes(&[[[-0.5, -0.5, 0.0], [0.5, 0.5, 8.0]]]));
    let [grey, white] = [8, 1].map(|antialias| {
        let options = Options {
            antialias,
            ..printer.clone()
        };
        let (report, bytes) = sliced(&cup, &options);
        let measured = cured(&cup, &bytes, &resin);
        (report.layers, measured.print_to_model.max_mm)
    });
    assert!(grey.0 * 10 < white.0 * 9, "{grey:?}, {white:?}");
    assert!(grey.1 < white.1 + 0.005, "{grey:?}, {white:?}");
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
                    measured_mm: top as f64 * layer_mm
                        - cure.bottom_mm(LitRange::white(1, top), None)
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
