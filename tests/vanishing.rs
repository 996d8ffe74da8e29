//! Nothing vanishes without a warning: parts that compensation erases, bodies that no ray meets, and cavities without a
//! way out.

use crate::common::Slicer;
use cusp_slicer::compensation::Compensation;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::job::{Backend, Job, JobOptions, ModelOptions, Options, Report};
use cusp_slicer::prepare::{AutoDrain, Drain, Hollowing, Infill};
use cusp_slicer::resin::Resin;
use cusp_slicer::warning::Warning;
use glam::Vec3;

use crate::common::{assert_near, load, quiet, solids};

/// Boxes from one corner to the other.
fn boxes(corners: &[[[f32; 3]; 2]]) -> solids::Triangles {
    let boxes = corners.iter().flat_map(|&[from, to]| {
        let [from, to] = [from, to].map(Vec3::from);
        solids::moved(&solids::cuboid(to - from), from)
    });
    boxes.collect()
}

/// A wall of 0.3 mm, 10 mm long, next to one of 1 mm.
fn walls() -> solids::Triangles {
    boxes(&[
        [[0.0, 0.0, 0.0], [10.0, 0.3, 4.0]],
        [[0.0, 3.0, 0.0], [10.0, 4.0, 4.0]],
    ])
}

/// Layers and pixels of 0.1 mm.
fn options(compensation: Compensation) -> Options {
    Options {
        pitch_mm: Some(0.1),
        layer_min_mm: Some(0.1),
        layer_max_mm: Some(0.1),
        tolerance: Some(0.5),
        backend: Backend::Cpu,
        resin: Resin {
            bottom_layers: 4,
            compensation,
            ..Resin::default()
        },
        ..Options::default()
    }
}

/// An elephant's foot of 0.2 mm, which fades over ten layers.
fn foot() -> Compensation {
    Compensation {
        bottom_xy_mm: Some(0.2),
        faded_layers: 10,
        ..Compensation::default()
    }
}

fn plan(slicer: &mut Slicer, options: &Options) -> Report {
    pollster::block_on(slicer.plan(options, &mut quiet))
        .unwrap()
        .clone()
}

/// Parts that compensation erases: layers, bottom of the lowest, and the largest area.
fn erased(report: &Report) -> Option<(usize, f64, f64)> {
    report
        .all_warnings()
        .iter()
        .find_map(|warning| match *warning {
            Warning::ErasedParts {
                layers,
                from_mm,
                area_mm2,
            } => Some((layers, from_mm, area_mm2)),
            _ => None,
        })
}

/// Number of lit pixels of a layer.
fn lit(slicer: &mut Slicer, layer: usize) -> u32 {
    let mask = slicer.mask(layer).unwrap();
    mask.iter().map(|byte| byte.count_ones()).sum()
}

#[test]
fn a_wall_that_an_elephants_foot_erases_is_warned_of() {
    let mut model = load(&walls());
    let solid = plan(&mut model, &options(Compensation::default()));
    assert_eq!(erased(&solid), None);
    let plain: Vec<u32> = (0..solid.layers)
        .map(|layer| lit(&mut model, layer))
        .collect();
    let report = plan(&mut model, &options(foot()));
    // Of the thick wall something is left; the thin one is dark where two pixels are taken away.
    let (layers, from_mm, area_mm2) = erased(&report).unwrap();
    let shrunk: Vec<u32> = (0..report.layers)
        .map(|layer| lit(&mut model, layer))
        .collect();
    let dark = (0..report.layers).take_while(|&layer| shrunk[layer] < plain[layer] / 2);
    assert_eq!(layers, dark.count());
    assert!(layers >= 4 && from_mm == 0.0, "{layers} from {from_mm}");
    assert_near(area_mm2, 3.0, 0.2);
    // A wall of a millimetre loses its sides alone.
    let mut thick = load(&boxes(&[[[0.0; 3], [10.0, 1.0, 4.0]]]));
    assert_eq!(erased(&plan(&mut thick, &options(foot()))), None);
}

#[test]
fn what_is_erased_is_the_same_with_grey_pixels_and_other_bands() {
    let mut tall = walls();
    tall.extend(boxes(&[[[0.0, 40.0, 0.0], [10.0, 40.3, 4.0]]]));
    let mut model = load(&tall);
    for antialias in [1, 4] {
        let report = plan(
            &mut model,
            &Options {
                antialias,
                ..options(foot())
            },
        );
        let (_, from_mm, area_mm2) = erased(&report).unwrap();
        assert_eq!(from_mm, 0.0);
        assert_near(area_mm2, 6.0, 0.4);
    }
}

#[test]
fn a_sheet_that_is_thinner_than_the_print_through_is_warned_of() {
    let sheet = boxes(&[
        [[0.0, 0.0, 0.0], [3.0, 16.0, 10.0]],
        [[0.0, 0.0, 9.7], [18.0, 16.0, 10.0]],
    ]);
    let through = |z_mm| Compensation {
        z_mm,
        ..Compensation::default()
    };
    let mut model = load(&sheet);
    let report = plan(&mut model, &options(through(0.3)));
    let (layers, from_mm, area_mm2) = erased(&report).unwrap();
    assert_eq!(layers, 3);
    assert_near(from_mm, 9.7, 0.01);
    // Except within three times the print-through of the block.
    assert_near(area_mm2, 14.1 * 16.0, 3.0);
    assert_eq!(erased(&plan(&mut model, &options(through(0.1)))), None);
}

#[test]
fn balls_and_cylinders_lose_nothing_worth_a_word() {
    let compensation = Compensation {
        xy_mm: 0.1,
        z_mm: 0.1,
        ..Compensation::default()
    };
    for (name, triangles) in [
        ("ball", solids::sphere(8.0, 5)),
        ("cylinder", solids::cylinder(5.0, 10.0, 16)),
        ("frame", solids::frame()),
    ] {
        let report = plan(&mut load(&triangles), &options(compensation));
        assert_eq!(erased(&report), None, "{name}");
    }
}

#[test]
fn a_plate_sums_up_what_is_erased_of_its_copies() {
    let mut plate = Job::new(vec![load(&walls()).into_model()]);
    let options = JobOptions {
        options: Options {
            pixels: Some([400, 300]),
            ..options(foot())
        },
        models: vec![ModelOptions {
            copies: 3,
            ..ModelOptions::default()
        }],
        ..JobOptions::default()
    };
    let report = pollster::block_on(plate.plan(&options, &mut quiet)).unwrap();
    let (_, _, area_mm2) = erased(&report.plates[0]).unwrap();
    assert_near(area_mm2, 9.0, 0.6);
}

#[test]
fn a_least_width_is_left_by_compensation() {
    // Along x and along y, in layers that lose 0.2 mm on each side.
    for is_turned in [false, true] {
        let wall = |width: f32| {
            let size = if is_turned {
                [width, 10.0, 1.0]
            } else {
                [10.0, width, 1.0]
            };
            load(&boxes(&[[[0.0; 3], size]]))
        };
        let least = |min_feature_mm| Options {
            min_feature_mm,
            ..options(foot())
        };
        let pixels = |width: f32, min_feature_mm| {
            let mut model = wall(width);
            let report = plan(&mut model, &least(min_feature_mm));
            (lit(&mut model, 0), erased(&report))
        };
        // Narrower than the least width: nothing is taken away.
        let (all, none) = pixels(0.3, Some(0.4));
        assert_eq!((all, none), (300, None));
        // Wider, but by less than the compensation takes away: the least width is left.
        let (some, none) = pixels(0.6, Some(0.4));
        assert_eq!((some, none), (400, None));
        // Wide enough: as without a least width.
        assert_eq!(pixels(2.0, Some(0.4)), pixels(2.0, None));
    }
}

#[test]
fn a_least_width_is_a_length() {
    let mut model = load(&walls());
    let options = Options {
        min_feature_mm: Some(-0.1),
        ..options(foot())
    };
    let error = pollster::block_on(model.plan(&options, &mut quiet)).unwrap_err();
    assert_eq!(error.code(), "bad-size");
}

/// A cube of 30 mm with a cavity, closed all around.
fn with_cavity(from: [f32; 3], to: [f32; 3]) -> solids::Triangles {
    let mut model = boxes(&[[[0.0; 3], [30.0; 3]]]);
    model.extend(solids::inverted(&boxes(&[[from, to]])));
    model
}

fn closed(report: &Report) -> Option<(usize, f64, [f64; 3])> {
    report
        .all_warnings()
        .iter()
        .find_map(|warning| match *warning {
            Warning::ClosedCavities {
                cavities,
                volume_mm3,
                at_mm,
            } => Some((cavities, volume_mm3, at_mm)),
            _ => None,
        })
}

fn hollowed(hollowing: Hollowing) -> Options {
    Options {
        hollow: Some(hollowing),
        pitch_mm: Some(0.2),
        ..options(Compensation::default())
    }
}

/// Findings of loose bodies and traps.
fn shut(slicer: &mut Slicer) -> usize {
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    let shut = [Code::LooseBody, Code::Trap];
    let counts = found.counts.iter().filter(|it| shut.contains(&it.code));
    counts.map(|it| it.found).sum()
}

#[test]
fn a_closed_cavity_is_joined_to_the_void() {
    let automatic = || Hollowing {
        auto_drain: Some(AutoDrain::default()),
        // They would not stand where the cavity is.
        pillars: false,
        ..Hollowing::default()
    };
    let mut cube = load(&boxes(&[[[0.0; 3], [30.0; 3]]]));
    let whole = plan(&mut cube, &hollowed(automatic()));
    let mut model = load(&with_cavity([11.0; 3], [19.0; 3]));
    let report = plan(&mut model, &hollowed(automatic()));
    assert_eq!(report.all_warnings(), []);
    assert_near(report.resin_ml, whole.resin_ml, 1e-2);
    assert_eq!(shut(&mut model), 0);
    // Nearer to the outside than the walls are thick, too, where the void reaches it.
    let mut near = load(&with_cavity([1.0, 11.0, 11.0], [19.0, 19.0, 19.0]));
    let report = plan(&mut near, &hollowed(automatic()));
    assert_eq!(closed(&report), None);
    assert_eq!(shut(&mut near), 0);
}

#[test]
fn cavities_that_stay_closed_are_warned_of() {
    // Within the wall.
    let mut model = load(&with_cavity([0.5, 10.0, 10.0], [2.5, 20.0, 20.0]));
    let report = plan(&mut model, &hollowed(Hollowing::default()));
    let (cavities, volume_mm3, [x, y, z]) = closed(&report).unwrap();
    assert_eq!(cavities, 1);
    assert_near(volume_mm3, 200.0, 20.0);
    assert!((-14.5..=-12.5).contains(&x) && y.abs() <= 5.0 && (10.0..=20.0).contains(&z));
    // A cavity whose shell is held by struts.
    let mut model = load(&with_cavity([11.0; 3], [19.0; 3]));
    let report = plan(
        &mut model,
        &hollowed(Hollowing {
            infill: Some(Infill::default()),
            ..Hollowing::default()
        }),
    );
    assert_near(closed(&report).unwrap().1, 512.0, 30.0);
}

#[test]
fn holes_lead_into_a_cavity_without_a_void() {
    let mut model = load(&with_cavity([5.0; 3], [25.0; 3]));
    let of = |drains: Vec<Drain>, auto_drain| {
        hollowed(Hollowing {
            wall_mm: 0.0,
            drains,
            auto_drain,
            ..Hollowing::default()
        })
    };
    let solid = plan(&mut model, &hollowed(Hollowing::default()));
    let solid_ml = 30f64.powi(3) / 1e3 - 8.0;
    assert!(solid.resin_ml < solid_ml);
    let hole = Drain {
        at_mm: [15.0, 0.0, 6.0],
        direction: [-1.0, 0.0, 0.0],
        diameter_mm: 3.0,
        depth_mm: None,
    };
    for options in [
        of(vec![hole], None),
        of(Vec::new(), Some(AutoDrain::default())),
    ] {
        let report = plan(&mut model, &options);
        assert_eq!(report.all_warnings(), []);
        let void = report.models[0].hollowed.as_ref().unwrap();
        assert_eq!(void.drains.len(), 1);
        // The walls lose the hole alone.
        let hole_mm3 = 16.0 * 1.5f64.powi(2) * (std::f64::consts::TAU / 32.0).sin() * 5.0;
        assert_near(solid_ml - report.resin_ml, hole_mm3 / 1e3, 6e-3);
        assert_eq!(shut(&mut model), 0);
    }
    // There is nothing to drain in a model without a cavity.
    let mut cube = load(&boxes(&[[[0.0; 3], [30.0; 3]]]));
    let report = plan(&mut cube, &of(vec![hole], None));
    assert_eq!(report.all_warnings(), [Warning::NothingToDrain]);
}

#[test]
fn a_body_that_no_ray_meets_is_warned_of() {
    let sheet = |x: f32, width: f32| [[x, 0.0, 0.0], [x + width, 10.0, 4.0]];
    let missed = |corners: &[[[f32; 3]; 2]]| {
        let report = plan(
            &mut load(&boxes(corners)),
            &options(Compensation::default()),
        );
        report
            .all_warnings()
            .iter()
            .find_map(|warning| match *warning {
                Warning::MissedBodies { bodies, at_mm } => Some((bodies, at_mm)),
                _ => None,
            })
    };
    let block = [[0.0; 3], [10.0, 10.0, 4.0]];
    // Pixels of 0.1 mm have their centres 0.05 mm from whole tenths.
    let (bodies, [x, y, z]) = missed(&[block, sheet(12.07, 0.05), sheet(13.0, 1.0)]).unwrap();
    assert_eq!(bodies, 1);
    assert_near(x, 12.095 - 7.0, 2e-3);
    assert_near(y, 0.0, 2e-3);
    assert_near(z, 2.0, 2e-3);
    assert_eq!(missed(&[block, sheet(12.0, 0.12), sheet(13.0, 1.0)]), None);
    // Within another body nothing is missed.
    assert_eq!(missed(&[block, [[5.07, 2.0, 1.0], [5.12, 8.0, 3.0]]]), None);
    assert_eq!(missed(&[block]), None);
}
