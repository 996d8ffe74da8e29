//! Surfaces that would fail in the vat: shelves close together, ceilings of voids, and mouths of drain holes.

use crate::common::{assert_near, least_memory_bytes, load, quiet, solids};
use cusp_slicer::compensation::Compensation;
use cusp_slicer::inspect::{Code, Limits, Printability};
use cusp_slicer::job::Supported;
use cusp_slicer::job::{Options, Report};
use cusp_slicer::prepare::{
    AutoDrain, Drain, Hollowing, Infill, SupportPoint, SupportProfile, SupportStrength, Supporting,
};
use cusp_slicer::resin::Resin;
use glam::{DVec3, Vec3};

use super::plan;

fn cuboid(from: [f32; 3], to: [f32; 3]) -> solids::Triangles {
    let [from, to] = [from, to].map(Vec3::from_array);
    solids::moved(&solids::cuboid(to - from), from)
}

fn print(triangles: &solids::Triangles, options: &Options) -> (Report, Printability) {
    let mut slicer = load(triangles);
    let options = Options {
        pitch_mm: options.pitch_mm.or(Some(0.1)),
        ..options.clone()
    };
    let report = plan(&mut slicer, &options);
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    (report, found)
}

fn supported() -> Options {
    Options {
        supports: Some(Supporting::default()),
        ..Options::default()
    }
}

/// Two shelves of 16 by 16 mm and 1 mm thick on a wall, `gap_mm` apart.
fn shelves(gap_mm: f32) -> solids::Triangles {
    let upper_mm = 7.0 + gap_mm;
    let mut all = cuboid([-2.0, -8.0, 0.0], [0.5, 8.0, 14.0]);
    all.extend(cuboid([0.0, -8.0, 6.0], [16.0, 8.0, 7.0]));
    all.extend(cuboid([0.0, -8.0, upper_mm], [16.0, 8.0, upper_mm + 1.0]));
    all
}

/// Heights of the contacts from the model's lowest point, with their numbers.
fn levels(points_mm: &[DVec3]) -> Vec<(f64, usize)> {
    let mut levels: Vec<(f64, usize)> = Vec::new();
    for at in points_mm {
        match levels.iter_mut().find(|it| (it.0 - at.z).abs() < 0.01) {
            Some(level) => level.1 += 1,
            None => levels.push((at.z, 1)),
        }
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    levels
}

#[test]
fn a_shelf_is_held_alike_whatever_is_close_below_it() {
    let spacing_mm = SupportStrength::Medium.profile().spacing_mm;
    for gap_mm in [0.5, 1.0, 1.5, 2.0, 3.0] {
        let (report, found) = print(&shelves(gap_mm), &supported());
        let supported = report.models[0].supported.clone().unwrap();
        assert!(supported.unreached.is_empty(), "{gap_mm}");
        let points = supported.points.iter();
        let points: Vec<DVec3> = points.map(|it| it.at_mm.into()).collect();
        let levels = levels(&points);
        // The wall is lifted as well.
        let [(0.0, _), lower, upper] = levels[..] else {
            panic!("{gap_mm}: {levels:?}");
        };
        assert_eq!(lower.1, upper.1, "{gap_mm}");
        // Every point of the upper shelf is near a contact of its own or the wall.
        let middle = 7.0;
        for step in 0..32 * 32 {
            let [x, y] = [step % 32, step / 32].map(|it| f64::from(it) * 0.5 + 0.25);
            let at = DVec3::new(x - middle, y - 8.0, upper.0);
            let nearest_mm = points.iter().map(|it| it.distance(at));
            let nearest_mm = nearest_mm.fold(f64::INFINITY, f64::min);
            assert!(
                x < 1.0 || nearest_mm < spacing_mm + 0.3,
                "{gap_mm}: {at} {nearest_mm}"
            );
        }
        let overhangs = found.findings.iter().filter(|it| it.code == Code::Overhang);
        assert_eq!(overhangs.count(), 0, "{gap_mm}");
    }
}

#[test]
fn the_check_measures_reach_within_the_layer() {
    // Supports of the lower shelf alone: the upper one is as far from them as from anything.
    let shelves = shelves(1.0);
    let (report, _) = print(&shelves, &supported());
    let mut points = report.models[0].supported.clone().unwrap().points;
    points.retain(|it| it.at_mm[2] < 7.0);
    let lower = Options {
        supports: Some(Supporting {
            points: Some(points),
            ..Supporting::default()
        }),
        ..Options::default()
    };
    let (_, found) = print(&shelves, &lower);
    let overhangs = found.findings.iter().filter(|it| it.code == Code::Overhang);
    let area_mm2: f64 = overhangs.map(|it| it.area_mm2).sum();
    // All but what a contact holds by the wall, and a millimetre.
    assert!((10.9 * 16.0..14.5 * 16.0).contains(&area_mm2), "{area_mm2}");
}

fn hollow(hollowing: Hollowing) -> Options {
    Options {
        hollow: Some(hollowing),
        ..Options::default()
    }
}

#[test]
fn wide_ceilings_of_voids_stand_on_pillars() {
    let block = solids::cuboid(Vec3::new(30.0, 30.0, 20.0));
    let bare = Hollowing {
        pillars: false,
        ..Hollowing::default()
    };
    let (_, found) = print(&block, &hollow(bare.clone()));
    let ceiling = found.findings.iter().find(|it| it.code == Code::Overhang);
    let area_mm2 = ceiling.unwrap().area_mm2;
    // 26 by 26 mm, less what its rounded rim and a millimetre beside it hold.
    assert!((430.0..576.0).contains(&area_mm2), "{area_mm2}");
    let (report, found) = print(&block, &hollow(Hollowing::default()));
    assert!(!found.findings.iter().any(|it| it.code == Code::Overhang));
    assert!(!found.findings.iter().any(|it| it.code == Code::Island));
    let hollowed = report.models[0].hollowed.clone().unwrap();
    assert!((9..40).contains(&hollowed.pillars), "{}", hollowed.pillars);
    // They cost little of what hollowing saves.
    let (without, _) = print(&block, &hollow(bare));
    let void_ml = without.models[0].hollowed.clone().unwrap().void_ml;
    assert!(
        hollowed.void_ml > 0.85 * void_ml,
        "{} of {void_ml}",
        hollowed.void_ml
    );
    // A ceiling no wider than a bridge needs none, and a round one holds itself.
    for solid in [
        solids::cuboid(Vec3::new(30.0, 8.5, 20.0)),
        solids::cuboid(Vec3::new(8.5, 8.5, 30.0)),
    ] {
        let (report, _) = print(&solid, &hollow(Hollowing::default()));
        assert_eq!(report.models[0].hollowed.clone().unwrap().pillars, 0);
    }
}

#[test]
fn nothing_hangs_in_the_air_where_a_hole_cuts_struts() {
    let drained = Hollowing {
        infill: Some(Infill::default()),
        auto_drain: Some(AutoDrain::default()),
        ..Hollowing::default()
    };
    for solid in [
        solids::sphere(15.0, 5),
        solids::cuboid(Vec3::new(26.0, 22.0, 24.0)),
    ] {
        let (report, found) = print(&solid, &hollow(drained.clone()));
        let hollowed = report.models[0].hollowed.clone().unwrap();
        assert!(!hollowed.drains.is_empty());
        let islands = found.findings.iter();
        let islands: Vec<_> = islands
            .filter(|it| [Code::Island, Code::LooseBody].contains(&it.code))
            // A ball on the plate begins with its lowest point, and where a strut leaves a wall pixels come a layer early.
            .filter(|it| it.at_mm[2] > 0.5 && it.volume_mm3 > 0.02)
            .collect();
        assert!(islands.is_empty(), "{islands:?}");
    }
}

#[test]
fn contacts_stand_around_the_mouth_of_a_hole() {
    let options = Options {
        hollow: Some(Hollowing {
            auto_drain: Some(AutoDrain::default()),
            ..Hollowing::default()
        }),
        ..supported()
    };
    let (report, found) = print(&solids::sphere(12.0, 6), &options);
    let hole = report.models[0].hollowed.clone().unwrap().drains[0];
    let mouth = DVec3::from_array(hole.at_mm).truncate();
    let supported = report.models[0].supported.clone().unwrap();
    for point in &supported.points {
        let away_mm = DVec3::from_array(point.at_mm).truncate().distance(mouth);
        assert!(away_mm > hole.diameter_mm / 2.0, "{point:?}");
    }
    assert!(supported.points.len() > 3);
    let floats = |code| matches!(code, Code::Island | Code::LooseBody);
    assert!(
        !found.findings.iter().any(|it| floats(it.code)),
        "{:?}",
        found.counts
    );
}

/// Pull of a film of 15 kPa at a region.
fn pull_n(area_mm2: f64, perimeter_mm: f64) -> f64 {
    15e-3 * area_mm2 * (2.0 * area_mm2 / perimeter_mm / 10.0).sqrt()
}

/// Supports when contacts are at these places, from the middle, and wherever else islands begin.
fn held_at(triangles: &solids::Triangles, at_mm: &[[f64; 2]]) -> Supported {
    let points = at_mm.iter().map(|&[x, y]| SupportPoint {
        at_mm: [x, y, 0.0],
        contact_mm: None,
    });
    let options = Options {
        supports: Some(Supporting {
            points: Some(points.collect()),
            fill: true,
            // None for the surface itself.
            profile: Some(SupportProfile {
                spacing_mm: 50.0,
                tip_mpa: 50.0,
                ..SupportProfile::default()
            }),
            ..Supporting::default()
        }),
        ..Options::default()
    };
    print(triangles, &options).0.models[0]
        .supported
        .clone()
        .unwrap()
}

/// The largest load of springs in a plane that hold a force at the origin: equal ones, each of which bends by a quarter of a millimetre.
fn naive_load(places: &[[f64; 2]], force_n: f64) -> f64 {
    // Lift, and tilt about x and y, from the balance of forces and moments: Gauss's elimination.
    let mut rows = [[0.0; 4]; 3];
    rows[0][3] = force_n;
    for &[x, y] in places {
        let arms = [1.0, x, y];
        for (row, arm) in arms.into_iter().enumerate() {
            for (column, other) in arms.into_iter().enumerate() {
                rows[row][column] += arm * other;
            }
        }
        rows[1][1] += 0.0625;
        rows[2][2] += 0.0625;
    }
    for pivot in 0..3 {
        let by = rows[pivot];
        for row in (0..3).filter(|&row| row != pivot) {
            let part = rows[row][pivot] / by[pivot];
            for column in 0..4 {
                rows[row][column] -= part * by[column];
            }
        }
    }
    let [lift, x_tilt, y_tilt] = [0, 1, 2].map(|it: usize| rows[it][3] / rows[it][it]);
    let load = |&[x, y]: &[f64; 2]| lift + x_tilt * x + y_tilt * y;
    places.iter().map(load).fold(0.0, f64::max)
}

#[test]
fn loads_are_those_of_a_rigid_body_on_springs() {
    let slab = solids::cuboid(Vec3::new(20.0, 10.0, 3.0));
    let force_n = pull_n(200.0, 60.0);
    for places in [
        vec![[-9.8, -4.9], [9.8, -4.9], [-9.8, 4.9], [9.8, 4.9]],
        vec![[9.8, -4.9], [9.8, 4.9]],
        vec![[2.0, 3.0], [9.8, 4.9], [-3.0, 0.0]],
    ] {
        let supported = held_at(&slab, &places);
        let all = supported.points.iter().map(|it| [it.at_mm[0], it.at_mm[1]]);
        let wanted_n = naive_load(&all.collect::<Vec<_>>(), force_n);
        let load_n = supported.load.unwrap().newtons;
        assert_near(load_n, wanted_n, 0.05 * wanted_n);
    }
    // A frame pulls by its area and all of its rims.
    let bar = |x: f32, y: f32, at: [f32; 2]| {
        let middle = Vec3::new(at[0], at[1], 0.0);
        solids::moved(&solids::cuboid(Vec3::new(x, y, 3.0)), middle)
    };
    let mut frame = bar(20.0, 2.0, [0.0, 0.0]);
    frame.extend(bar(20.0, 2.0, [0.0, 18.0]));
    frame.extend(bar(2.0, 20.0, [0.0, 0.0]));
    frame.extend(bar(2.0, 20.0, [18.0, 0.0]));
    let options = Options {
        supports: Some(Supporting::default()),
        ..Options::default()
    };
    let (report, _) = print(&frame, &options);
    let supported = report.models[0].supported.clone().unwrap();
    let mean_n = pull_n(144.0, 144.0) / supported.points.len() as f64;
    let load = supported.load.unwrap();
    assert!(
        (0.95 * mean_n..1.6 * mean_n).contains(&load.newtons),
        "{load:?}"
    );
}

#[test]
fn no_tip_bears_more_than_its_limit() {
    let upside_down = |it: &[Vec3; 3]| it.map(|at| Vec3::new(at.x, -at.y, 12.0 - at.z));
    let cone = solids::cone(10.0, 12.0, 16);
    let cone = cone.iter().map(upside_down).collect();
    for (name, solid, contacts) in [
        ("ball", solids::sphere(10.0, 6), 17..27),
        ("cone", cone, 17..40),
        ("slab", solids::cuboid(Vec3::new(20.0, 20.0, 4.0)), 20..60),
    ] {
        let (report, found) = print(&solid, &supported());
        let supported = report.models[0].supported.clone().unwrap();
        let load = supported.load.unwrap();
        assert!(load.newtons <= 1.01 * load.limit_n, "{name}: {load:?}");
        let count = supported.points.len();
        assert!(contacts.contains(&count), "{name}: {count}");
        assert!(supported.unreached.is_empty(), "{name}");
        assert!(!found.findings.iter().any(|it| it.code == Code::Overhang));
    }
}

#[test]
fn a_tall_pillar_alone_is_thicker() {
    let profile = SupportProfile {
        lift_mm: 30.0,
        ..SupportProfile::default()
    };
    let options = Options {
        supports: Some(Supporting {
            profile: Some(profile),
            ..Supporting::default()
        }),
        pitch_mm: Some(0.05),
        ..Options::default()
    };
    let (report, found) = print(&solids::sphere(0.8, 4), &options);
    assert_eq!(report.models[0].supported.clone().unwrap().points.len(), 1);
    // Free over 28 mm, where 15 bear: wider by the root of that.
    let z_mm = &report.z_mm;
    let layer = z_mm.iter().position(|&it| it > 15.0).unwrap();
    let area_mm2 = found.peel.area_mm2[layer];
    let polygon_mm2 = 3.0615 * 0.25 * 28.0 / 15.0;
    assert_near(area_mm2, polygon_mm2, 0.1 * polygon_mm2);
}

#[test]
fn tips_stay_as_wide_as_asked_when_masks_shrink() {
    let slab = solids::cuboid(Vec3::new(8.0, 8.0, 3.0));
    let light = |xy_mm| Options {
        supports: Some(Supporting {
            strength: SupportStrength::Light,
            ..Supporting::default()
        }),
        resin: Resin {
            compensation: Compensation {
                xy_mm,
                ..Compensation::default()
            },
            ..Resin::default()
        },
        planner: cusp_slicer::job::Planner::Uniform { layer_mm: 0.05 },
        ..Options::default()
    };
    // A layer through the tips, a tenth of a millimetre below the slab.
    let area_mm2 = |options: &Options| print(&slab, options).1.peel.area_mm2[97];
    let [as_modelled, shrunk] = [0.0, 0.15].map(|xy_mm| area_mm2(&light(xy_mm)));
    assert!(as_modelled > 0.5);
    assert_near(shrunk, as_modelled, 0.25 * as_modelled);
}

#[test]
fn pieces_that_float_are_named_after_every_preparation() {
    // Two balls, of which points by hand hold one.
    let mut balls = solids::sphere(4.0, 4);
    balls.extend(solids::moved(
        &solids::sphere(4.0, 4),
        Vec3::new(12.0, 0.0, 3.0),
    ));
    let mut slicer = load(&balls);
    let options = Options {
        supports: Some(Supporting {
            points: Some(vec![SupportPoint {
                at_mm: [-6.0, 0.0, 0.0],
                contact_mm: None,
            }]),
            ..Supporting::default()
        }),
        pitch_mm: Some(0.1),
        ..Options::default()
    };
    plan(&mut slicer, &options);
    let floating = slicer.floating(&mut quiet).unwrap();
    assert_eq!(floating.len(), 1);
    assert_eq!(floating[0].code, Code::LooseBody);
    let ball_mm3 = 4.0 / 3.0 * std::f64::consts::PI * 64.0;
    assert_near(floating[0].volume_mm3, ball_mm3, 0.05 * ball_mm3);
    // With automatic supports nothing floats, and a model without supports is not examined.
    for options in [supported(), Options::default()] {
        let options = Options {
            pitch_mm: Some(0.1),
            ..options
        };
        plan(&mut slicer, &options);
        assert!(slicer.floating(&mut quiet).unwrap().is_empty());
    }
}

#[test]
fn a_hollow_model_is_refused_for_the_pieces_that_its_holes_cut_off_alone() {
    let block = |side: f32, at: [f32; 3]| {
        solids::moved(&solids::cuboid(Vec3::splat(side)), Vec3::from_array(at))
    };
    // A box with an arm that rises in steps from its side, and beside it a cube in the air.
    let mut model = block(20.0, [0.0; 3]);
    for step in 0..8 {
        let step = step as f32;
        model.extend(block(2.0, [19.0 + step, 9.0, 8.0 + step]));
    }
    model.extend(block(2.0, [26.0, 2.0, 10.0]));
    let hollow = |drains| Options {
        hollow: Some(Hollowing {
            wall_mm: 2.0,
            drains,
            ..Hollowing::default()
        }),
        pitch_mm: Some(0.1),
        ..Options::default()
    };
    let floating = |options: &Options| {
        let mut slicer = load(&model);
        plan(&mut slicer, options);
        let found = slicer.floating(&mut quiet).unwrap();
        let least = least_memory_bytes(&model, options);
        let mut bounded = load(&model).with_memory(least);
        plan(&mut bounded, options);
        assert!(bounded.mask(0).is_err());
        assert_eq!(bounded.floating(&mut quiet).unwrap(), found);
        found
    };
    assert_eq!(floating(&hollow(Vec::new())), []);
    // The middle of the model is at x = 14.
    let through_the_root = Drain {
        at_mm: [22.5 - 14.0, 0.0, 10.0],
        direction: [-1.0, 0.0, 0.0],
        diameter_mm: 4.0,
        depth_mm: None,
    };
    let found = floating(&hollow(vec![through_the_root]));
    assert_eq!(found.len(), 1, "{found:?}");
    // The hole removes the steps below z = 12 and leaves slivers beside its top.
    assert_near(found[0].at_mm[2], 12.0, 0.3);
    let above_mm3 = 2.0 * (4.0 * 3.0 + 2.0);
    assert!((above_mm3..above_mm3 + 1.0).contains(&found[0].volume_mm3));
}

#[test]
fn nothing_floats_where_holes_cut_struts() {
    let ball = solids::sphere(15.0, 5);
    // Holes all around, at eight heights, so that some end in nodes and some beside struts.
    let drains = (0..16).map(|hole: u32| {
        let [x, y] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][hole as usize % 4];
        let z_mm = 7.0 + f64::from(hole / 2) * 2.3;
        let radius_mm = (225.0 - (z_mm - 15.0_f64).powi(2)).sqrt();
        Drain {
            at_mm: [x * radius_mm, y * radius_mm, z_mm],
            direction: [-x, -y, 0.0],
            diameter_mm: 3.0,
            depth_mm: None,
        }
    });
    let mut options = Options {
        hollow: Some(Hollowing {
            wall_mm: 1.2,
            infill: Some(Infill::default()),
            drains: drains.collect(),
            ..Hollowing::default()
        }),
        pitch_mm: Some(0.05),
        ..Options::default()
    };
    let mut slicer = load(&ball);
    for spacing_mm in [5.0, 6.5, 8.0] {
        let infill = options.hollow.as_mut().unwrap().infill.as_mut();
        infill.unwrap().spacing_mm = spacing_mm;
        plan(&mut slicer, &options);
        assert_eq!(slicer.floating(&mut quiet).unwrap(), [], "{spacing_mm}");
    }
}

#[test]
fn a_cup_pulls_like_a_solid_until_it_is_vented() {
    let block = |[x, y, z]: [f32; 3], [dx, dy, dz]: [f32; 3]| {
        solids::moved(&solids::cuboid(Vec3::new(dx, dy, dz)), Vec3::new(x, y, z))
    };
    // A square frame around a square hole in the middle.
    let frame = |side: f32, hole: f32, z: f32, height: f32| {
        let rim = (side - hole) / 2.0;
        let (near, far) = (-side / 2.0, hole / 2.0);
        let bars = [
            block([near, near, z], [side, rim, height]),
            block([near, far, z], [side, rim, height]),
            block([near, near, z], [rim, side, height]),
            block([far, near, z], [rim, side, height]),
        ];
        bars.concat()
    };
    let places = [[-4.6, -4.6], [4.6, -4.6], [-4.6, 4.6], [4.6, 4.6]];
    let assert_pull = |floor: Vec<[Vec3; 3]>, force_n: f64| {
        let walls = [frame(20.0, 9.0, 2.0, 2.0), frame(20.0, 16.0, 4.0, 6.0)];
        let supported = held_at(&[floor, walls.concat()].concat(), &places);
        let all = supported.points.iter().map(|it| [it.at_mm[0], it.at_mm[1]]);
        let wanted_n = naive_load(&all.collect::<Vec<_>>(), force_n);
        assert_near(supported.load.unwrap().newtons, wanted_n, 0.05 * wanted_n);
    };
    // The hole in the lower walls is 9 mm wide: the film pulls at it as well while the floor closes it.
    let closed = block([-5.0, -5.0, 0.0], [10.0, 10.0, 2.0]);
    assert_pull(closed, pull_n(400.0, 80.0));
    let vented = frame(10.0, 3.0, 0.0, 2.0);
    assert_pull(vented, pull_n(400.0 - 81.0, 80.0 + 36.0));
}

#[test]
fn a_level_edge_is_held_in_its_first_layer() {
    // A keel: both of its sides rise by 9°, so that contacts beside the edge begin layers later.
    let keel = solids::profiled(&[[0.0, 0.0], [12.0, 2.0], [-12.0, 2.0]], 30.0);
    let (report, _) = print(&keel, &supported());
    let supported = report.models[0].supported.clone().unwrap();
    let points = supported.points.iter().filter(|it| it.at_mm[2] <= 0.05);
    let mut along_mm: Vec<f64> = points.map(|it| it.at_mm[1]).collect();
    along_mm.extend([-15.0, 15.0]);
    along_mm.sort_by(f64::total_cmp);
    let spacing_mm = SupportStrength::Medium.profile().spacing_mm;
    for pair in along_mm.windows(2) {
        assert!(pair[1] - pair[0] <= 2.0 * spacing_mm, "{along_mm:?}");
    }
    assert!(along_mm.len() > 6, "{along_mm:?}");
    let load = supported.load.unwrap();
    assert!(load.newtons <= 1.01 * load.limit_n, "{load:?}");
}

#[test]
fn the_film_is_the_printers_unless_sizes_state_one() {
    let slab = solids::cuboid(Vec3::new(12.0, 12.0, 3.0));
    let load_n = |printer_kpa: Option<f64>, own_kpa: Option<f64>| {
        let printer = serde_json::json!({
            "pixels": [400, 400], "pitch_um": [100, 100], "volume_mm": [40, 40, 100], "film_kpa": printer_kpa,
        });
        let profile = SupportProfile {
            film_kpa: own_kpa,
            tip_mpa: 50.0,
            ..SupportProfile::default()
        };
        let options = Options {
            printer: Some(serde_json::from_value(printer).unwrap()),
            supports: Some(Supporting {
                profile: Some(profile),
                ..Supporting::default()
            }),
            pitch_mm: None,
            ..Options::default()
        };
        let report = plan(&mut load(&slab), &options);
        report.models[0]
            .supported
            .clone()
            .unwrap()
            .load
            .unwrap()
            .newtons
    };
    let usual_n = load_n(None, None);
    for (printer_kpa, own_kpa, times) in [
        (Some(30.0), None, 2.0),
        (Some(30.0), Some(7.5), 0.5),
        (None, Some(30.0), 2.0),
    ] {
        assert_near(load_n(printer_kpa, own_kpa), times * usual_n, 1e-3);
    }
}

#[test]
fn the_check_pulls_with_the_film_of_the_supports() {
    let top_n = |film_kpa: f64| {
        let profile = SupportProfile {
            film_kpa: Some(film_kpa),
            ..SupportProfile::default()
        };
        let options = Options {
            supports: Some(Supporting {
                profile: Some(profile),
                ..Supporting::default()
            }),
            ..Options::default()
        };
        // The last layer, far above the supports, is the same for both.
        let (_, found) = print(&cuboid([0.0; 3], [6.0, 6.0, 4.0]), &options);
        *found.peel.pull_n.last().unwrap()
    };
    assert_near(top_n(30.0) / top_n(15.0), 2.0, 1e-9);
}
