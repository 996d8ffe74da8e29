//! Supports against closed forms, naive distances and the checks.

use crate::common::Slicer;
use cusp_slicer::inspect::{Code, Limits, Printability};
use cusp_slicer::job::{Error, Options, OptionsError, Planner, Report};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::prepare::{
    Hollowing, SupportPoint, SupportProfile, SupportStrength, Supporting, Supports, support,
};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::progress::silent;
use cusp_slicer::warning::Warning;
use glam::{DVec3, Vec3};

use super::plan;
use crate::common::{assert_near, load, on_plate, quiet, solids};

fn supported(supporting: Supporting) -> Options {
    Options {
        supports: Some(supporting),
        pitch_mm: Some(0.1),
        ..Options::default()
    }
}

fn of(profile: SupportProfile) -> Supporting {
    Supporting {
        profile: Some(profile),
        ..Supporting::default()
    }
}

fn supports_of(mesh: &Mesh, supporting: &Supporting) -> Supports {
    support(mesh, supporting, None, 0.0, &mut silent).unwrap()
}

fn point(at_mm: [f64; 3]) -> SupportPoint {
    SupportPoint {
        at_mm,
        contact_mm: None,
    }
}

fn checked(slicer: &mut Slicer, options: &Options) -> (Report, Printability) {
    let report = plan(slicer, options);
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    (report, found)
}

/// The largest area and number of layers of an island, in pixels.
fn largest_island(found: &Printability, pixel_mm2: f64) -> (f64, usize) {
    let islands = found.findings.iter().filter(|it| it.code == Code::Island);
    islands.fold((0.0, 0), |(pixels, layers), island| {
        let joins = island.joins_layer.unwrap_or(usize::MAX);
        (
            f64::max(pixels, island.area_mm2 / pixel_mm2),
            layers.max(joins - island.layers[0]),
        )
    })
}

/// The models that supports are tried on.
fn models() -> Vec<(&'static str, solids::Triangles)> {
    let torture = solids::torture().into_iter();
    // A needle and a knife edge have nothing for pixels of a tenth of a millimetre.
    let torture = torture.filter(|it| !it.0.starts_with("needle") && !it.0.starts_with("knife"));
    let torture = torture.map(|(name, triangles, _)| (name, triangles));
    solids::all().into_iter().chain(torture).collect()
}

#[test]
fn a_supported_model_hangs_together_and_its_islands_are_gone() {
    for (name, triangles) in models() {
        let mut model = load(&triangles);
        let (report, found) = checked(&mut model, &supported(Supporting::default()));
        let (pixels, layers) = largest_island(&found, 0.01);
        // Pixels that a layer begins with a layer early.
        let supported = report.models[0].supported.clone().unwrap();
        // The gyroid has sheets and ridges thinner than pixels: masks show parts of them a layer or two early.
        let most = if name == "gyroid" {
            (25.5, 2)
        } else {
            (0.0, 0)
        };
        assert!(
            pixels <= most.0 && layers <= most.1,
            "{name}: {pixels} {layers}"
        );
        let loose = found.findings.iter().filter(|it| match it.code {
            Code::LooseBody => true,
            // Such parts of a sheet hang on nothing within their layer.
            Code::Overhang => it.area_mm2 > most.0 * 0.01,
            _ => false,
        });
        let is_reached = supported.unreached.is_empty();
        assert!(
            !is_reached || loose.count() == 0,
            "{name}: {:?}",
            found.counts
        );
        // Ten slabs a tenth of a millimetre apart leave no room, and points between them are named.
        assert_eq!(is_reached, name != "a hundred surfaces on a ray", "{name}");
        assert!(!supported.points.is_empty(), "{name}");
    }
}

#[test]
fn contacts_keep_the_load_rule() {
    // The bottom of a disc is level; that of a ball is held up to its slope.
    let disc = on_plate(&solids::cylinder(15.0, 3.0, 24));
    let profile = SupportStrength::Medium.profile();
    let supports = supports_of(&disc, &Supporting::default());
    let points = supports.points.iter();
    let points: Vec<DVec3> = points.map(|it| DVec3::from_array(it.at_mm)).collect();
    assert!(points.iter().all(|at| at.z == 0.0));
    let nearest_mm = |from: DVec3| {
        let others = points.iter().filter(|&&it| it != from);
        others
            .map(|it| it.distance(from))
            .fold(f64::INFINITY, f64::min)
    };
    for &at in &points {
        // To a thousandth, to which points are rounded.
        assert!(nearest_mm(at) > 0.97 * profile.spacing_mm);
    }
    let mut rng = fastrand::Rng::with_seed(7);
    for _ in 0..2000 {
        let at = DVec3::new(rng.f64() * 30.0 - 15.0, rng.f64() * 30.0 - 15.0, 0.0);
        if at.length() < 14.8 {
            assert!(nearest_mm(at) < profile.spacing_mm + 0.3, "{at}");
        }
    }

    let ball = on_plate(&solids::sphere(12.0, 6));
    // Steeper ones hold loads alone.
    let without_film = SupportProfile {
        film_kpa: Some(0.0),
        ..profile
    };
    let supports = supports_of(&ball, &of(without_film));
    let steepest = supports.points.iter().map(|it| {
        let [x, y, z] = it.at_mm;
        x.hypot(y) / (12.0 - z)
    });
    let steepest = steepest.fold(0.0, f64::max);
    // The slope of a ball is its radius across over that down.
    assert!(
        steepest < profile.self_supporting_slope + 0.02,
        "{steepest}"
    );
    assert!(steepest > 0.3, "{steepest}");
}

#[test]
fn tips_touch_what_they_should() {
    let mut slab = load(&solids::cuboid(Vec3::new(12.0, 9.0, 3.0)));
    for strength in [
        SupportStrength::Light,
        SupportStrength::Medium,
        SupportStrength::Heavy,
    ] {
        let options = Options {
            pitch_mm: Some(0.02),
            bin_mm: Some(0.01),
            planner: cusp_slicer::job::Planner::Uniform { layer_mm: 0.05 },
            ..supported(Supporting {
                strength,
                ..Supporting::default()
            })
        };
        let (report, found) = checked(&mut slab, &options);
        let profile = strength.profile();
        let contacts = report.models[0].supported.as_ref().unwrap().points.len();
        // Lit just below the slab, plus the growth of a cone half a layer down.
        let layer = (profile.lift_mm / 0.05) as usize - 1;
        let lit_mm2 = found.peel.area_mm2[layer];
        let slope = (profile.pillar_mm - profile.contact_mm) / 2.0 / profile.tip_mm;
        let radius_mm = profile.contact_mm / 2.0 + 0.025 * slope;
        let polygon = 3.0615;
        let wanted_mm2 = contacts as f64 * polygon * radius_mm * radius_mm;
        assert_near(lit_mm2, wanted_mm2, 0.03 * wanted_mm2);
    }
}

#[test]
fn pillars_keep_clear_of_the_model() {
    let profile = SupportStrength::Medium.profile();
    for (name, triangles) in [
        ("frame", solids::frame()),
        ("ball", solids::sphere(10.0, 5)),
        ("roofs", solids::crossing_roofs()),
        ("gyroid", solids::gyroid(2, 16)),
    ] {
        let mesh = Mesh::from_triangles(&triangles).unwrap();
        let mesh = mesh.on_plate(&Pose::of_height(30.0)).unwrap();
        let supports = supports_of(&mesh, &Supporting::default());
        let contacts = supports.points.iter().chain(&supports.unreached);
        let contacts: Vec<DVec3> = contacts.map(|it| DVec3::from_array(it.at_mm)).collect();
        let mut nearest_mm = f64::INFINITY;
        for &vertex in supports.shell.vertices.iter().step_by(7) {
            let vertex = vertex.as_dvec3();
            let is_tip = |at: &DVec3| at.distance(vertex) < profile.tip_mm + profile.pillar_mm;
            if !contacts.iter().any(is_tip) {
                nearest_mm = nearest_mm.min(naive_distance_mm(&mesh, vertex));
            }
        }
        let foot_mm = if supports.on_model > 0 { 0.0 } else { 1.0 };
        let least_mm = foot_mm * (profile.clearance_mm - 0.2);
        assert!(nearest_mm >= least_mm, "{name}: {nearest_mm}");
    }
}

fn naive_distance_mm(mesh: &Mesh, point: DVec3) -> f64 {
    let facets = (0..mesh.surface_facets).map(|facet| {
        let [a, b, c] = mesh.corners(facet);
        let normal = (b - a).cross(c - a);
        let is_over = |p: DVec3, q: DVec3| normal.cross(q - p).dot(point - p) >= 0.0;
        if is_over(a, b) && is_over(b, c) && is_over(c, a) {
            return (normal.dot(point - a) / normal.length()).abs();
        }
        let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            let part = ((q - p).dot(point - p) / (q - p).length_squared()).clamp(0.0, 1.0);
            (p + (q - p) * part).distance(point)
        });
        edges.into_iter().fold(f64::INFINITY, f64::min)
    });
    facets.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_supported_model_has_the_planes_of_the_lifted_one() {
    let mut ball = load(&solids::sphere(8.0, 5));
    let metrics = [
        Metric::Cusp,
        Metric::Deviation,
        Metric::Roughness,
        Metric::Area,
        Metric::Volume,
    ];
    for metric in metrics {
        for source in [Source::Exact, Source::Sampled] {
            let with = Options {
                metric,
                source,
                ..supported(Supporting::default())
            };
            let without = Options {
                supports: Some(Supporting {
                    points: Some(Vec::new()),
                    ..Supporting::default()
                }),
                ..with.clone()
            };
            let [with, without] = [with, without].map(|options| plan(&mut ball, &options));
            assert_eq!(with.z_mm, without.z_mm, "{metric:?} {source:?}");
            assert_eq!(with.max_error, without.max_error, "{metric:?} {source:?}");
            let supported = with.models[0].supported.clone().unwrap();
            let more_ml = with.resin_ml - without.resin_ml;
            assert_near(more_ml, supported.support_ml, 1e-3 * more_ml);
        }
    }
    // On the plate, the planes are those of the model alone.
    let on_plate = SupportProfile {
        lift_mm: 0.0,
        ..SupportProfile::default()
    };
    let bare = Options {
        supports: None,
        ..supported(Supporting::default())
    };
    let mut ball = load(&solids::sphere(12.0, 5));
    let [bare, held] = [bare, supported(of(on_plate))].map(|options| plan(&mut ball, &options));
    assert_eq!(bare.z_mm, held.z_mm);
    assert!(held.resin_ml > bare.resin_ml);
}

#[test]
fn without_supports_a_model_is_as_it_was() {
    let mut ball = load(&solids::sphere(6.0, 4));
    let bare = Options {
        supports: None,
        ..supported(Supporting::default())
    };
    let file = |slicer: &mut Slicer| slicer.write_archive(Vec::new(), &mut quiet).unwrap().0;
    plan(&mut ball, &bare);
    let before = file(&mut ball);
    plan(&mut ball, &supported(Supporting::default()));
    assert!(file(&mut ball) != before);
    plan(&mut ball, &bare);
    assert!(file(&mut ball) == before);
}

#[test]
fn points_of_a_report_can_be_given_again() {
    for triangles in [
        solids::frame(),
        solids::sphere(9.0, 5),
        solids::gyroid(2, 12),
    ] {
        let mesh = Mesh::from_triangles(&triangles).unwrap();
        let mesh = mesh.on_plate(&Pose::of_height(25.0)).unwrap();
        let automatic = supports_of(&mesh, &Supporting::default());
        let given = Supporting {
            points: Some(automatic.points.clone()),
            ..Supporting::default()
        };
        let again = supports_of(&mesh, &given);
        assert_eq!(again.points, automatic.points);
        assert!(again.shell == automatic.shell);
    }
}

#[test]
fn points_by_hand_are_held_or_named() {
    let ball = on_plate(&solids::sphere(10.0, 5));
    let thick = SupportPoint {
        contact_mm: Some(0.9),
        ..point([0.0, 0.0, 0.0])
    };
    let given = Supporting {
        points: Some(vec![thick, point([30.0, 0.0, 0.0]), point([0.0, 7.1, 2.9])]),
        ..Supporting::default()
    };
    let supports = supports_of(&ball, &given);
    assert_eq!(supports.astray, [1]);
    assert_eq!(supports.points.len(), 2);
    assert_eq!(supports.points[1].contact_mm, Some(0.9));
    let mut ball = load(&solids::sphere(10.0, 5));
    let report = plan(&mut ball, &supported(given));
    let astray = Warning::SupportAstray { point_number: 2 };
    assert_eq!(report.all_warnings(), [astray]);

    // Inside a closed shell nothing leads to the plate, but its floor is there; in a narrow slot there is no room.
    let mut shell = solids::sphere(15.0, 5);
    shell.extend(solids::inverted(&solids::sphere(13.0, 5)));
    let supports = supports_of(
        &on_plate(&shell),
        &Supporting {
            points: Some(vec![point([0.0, 0.0, 28.0])]),
            ..Supporting::default()
        },
    );
    assert_eq!((supports.points.len(), supports.on_model), (1, 1));
    let mut slot = solids::cuboid(Vec3::new(10.0, 10.0, 5.0));
    slot.extend(solids::moved(
        &solids::cuboid(Vec3::new(10.0, 10.0, 5.0)),
        Vec3::new(0.0, 0.0, 5.1),
    ));
    let given = Supporting {
        points: Some(vec![point([0.0, 0.0, 5.1])]),
        ..Supporting::default()
    };
    let supports = supports_of(&on_plate(&slot), &given);
    assert_eq!((supports.points.len(), supports.unreached.len()), (0, 1));
    let report = plan(&mut load(&slot), &supported(given));
    assert!(
        report
            .all_warnings()
            .contains(&Warning::Unsupported { points: 1 })
    );
}

#[test]
fn points_by_hand_are_kept_and_filled_up() {
    let disc = on_plate(&solids::cylinder(15.0, 3.0, 24));
    let by_hand = SupportPoint {
        contact_mm: Some(0.8),
        ..point([4.0, 1.0, 0.0])
    };
    let kept = Supporting {
        points: Some(vec![by_hand]),
        fill: true,
        ..Supporting::default()
    };
    let supports = supports_of(&disc, &kept);
    assert!(supports.points.contains(&by_hand));
    // The load rule holds, with the contact by hand as one of all.
    let profile = SupportStrength::Medium.profile();
    let away_mm = |it: &SupportPoint| DVec3::from_array(it.at_mm).distance(by_hand.at_mm.into());
    let others = supports.points.iter().filter(|&it| *it != by_hand);
    let nearest_mm = others.map(away_mm).fold(f64::INFINITY, f64::min);
    assert!((profile.spacing_mm - 0.002..2.0 * profile.spacing_mm).contains(&nearest_mm));
    // If everything is held already, nothing is added.
    let all = Supporting {
        points: Some(supports.points.clone()),
        ..kept.clone()
    };
    assert_eq!(supports_of(&disc, &all).points, supports.points);
    // Without points to keep, the contacts are those placed automatically.
    let none = Supporting {
        points: Some(Vec::new()),
        ..kept
    };
    assert_eq!(
        supports_of(&disc, &none),
        supports_of(&disc, &Supporting::default())
    );
}

#[test]
fn contacts_keep_off_what_weighs_more_than_a_half() {
    // A board whose halves are of their own facets.
    let half = solids::cuboid(Vec3::new(10.0, 20.0, 2.0));
    let mut board = half.clone();
    board.extend(solids::moved(&half, Vec3::new(10.0, 0.0, 0.0)));
    let mut board = load(&board);
    let facets = board.positions().len() / 9;
    let weights = (0..facets).map(|facet| if facet < facets / 2 { 0.5 } else { 0.51 });
    board.set_weights(Some(weights.collect())).unwrap();
    let options = |protect| {
        supported(Supporting {
            protect,
            profile: Some(SupportProfile {
                film_kpa: Some(0.0),
                ..SupportProfile::default()
            }),
            ..Supporting::default()
        })
    };
    let is_light = |it: &SupportPoint| it.at_mm[0] <= 0.0;
    let reach_mm = SupportStrength::Medium.profile().spacing_mm;
    let report = plan(&mut board, &options(true));
    let protected = report.models[0].supported.clone().unwrap();
    assert!(protected.points.len() > 5 && protected.points.iter().all(is_light));
    // Exactly the points that contacts on the other half do not hold are named.
    assert!(protected.unreached.len() > 5);
    for missed in &protected.unreached {
        assert!(!is_light(missed));
        let at = DVec3::from_array(missed.at_mm);
        let held = protected
            .points
            .iter()
            .map(|it| at.distance(it.at_mm.into()));
        assert!(held.fold(f64::INFINITY, f64::min) >= 0.97 * reach_mm);
    }
    let points = protected.unreached.len();
    assert!(
        report
            .all_warnings()
            .contains(&Warning::Unsupported { points })
    );
    // Weights alone say nothing about contacts; once they do, a change of them is heard.
    let anywhere = plan(&mut board, &options(false)).models[0]
        .supported
        .clone()
        .unwrap();
    assert!(!anywhere.points.iter().all(is_light) && anywhere.unreached.is_empty());
    board.set_weights(Some(vec![0.5; facets])).unwrap();
    let light = plan(&mut board, &options(true)).models[0]
        .supported
        .clone()
        .unwrap();
    assert_eq!(light.points, anywhere.points);
}

#[test]
fn pixels_and_quality_do_not_prepare_again() {
    let mut frame = load(&solids::frame());
    let options = Options {
        hollow: Some(Hollowing::default()),
        ..supported(Supporting::default())
    };
    plan(&mut frame, &options);
    let before = std::ptr::from_ref(frame.prepared().unwrap());
    for changed in [
        Options {
            pitch_mm: Some(0.15),
            ..options.clone()
        },
        Options {
            tolerance: Some(0.01),
            metric: Metric::Area,
            ..options.clone()
        },
    ] {
        plan(&mut frame, &changed);
        assert!(std::ptr::eq(before, frame.prepared().unwrap()));
    }
    let heavy = Supporting {
        strength: SupportStrength::Heavy,
        ..Supporting::default()
    };
    let report = plan(
        &mut frame,
        &Options {
            supports: Some(heavy),
            ..options
        },
    );
    assert_eq!(
        report.options.supports.unwrap().strength,
        SupportStrength::Heavy
    );
    assert!(report.models[0].supported.clone().unwrap().points != Vec::new());
}

/// The lit area of the layer at a height.
fn area_mm2((report, found): &(Report, Printability), z_mm: f64) -> f64 {
    let layer = report.z_mm.partition_point(|&it| it < z_mm) - 1;
    found.peel.area_mm2[layer]
}

#[test]
fn feet_stand_on_a_raft_if_asked() {
    let mut ball = load(&solids::sphere(10.0, 5));
    let closed = SupportProfile {
        raft: true,
        raft_hole_mm: 0.0,
        ..SupportProfile::default()
    };
    let mut sliced = |profile: SupportProfile| checked(&mut ball, &supported(of(profile)));
    let without = sliced(SupportProfile::default());
    let with = sliced(closed);
    assert_eq!(with.1.bodies, 1);
    let [low, high] = [0.1, 0.9].map(|z_mm| area_mm2(&with, z_mm));
    assert!(low > 1.5 * area_mm2(&without, 0.1), "{low}");
    // Its side slopes by 45°, up to its thickness. No convex outline is shorter than a circle's.
    let perimeter_mm = (4.0 * std::f64::consts::PI * low).sqrt();
    assert!(high - low > 0.6 * perimeter_mm, "{low} {high}");
    assert!(area_mm2(&with, 1.1) < 0.5 * low);
    let thick = sliced(SupportProfile {
        raft_thickness_mm: 2.0,
        raft_slope: 50.0,
        ..closed
    });
    assert_near(area_mm2(&thick, 1.9), area_mm2(&thick, 0.1), 0.02 * low);
    assert!(area_mm2(&thick, 2.1) < 0.5 * low);
    // A margin of 3 mm more adds at least that along a circle of the same area.
    let wide = sliced(SupportProfile {
        raft_margin_mm: 5.0,
        ..closed
    });
    assert!(area_mm2(&wide, 0.1) - low > 3.0 * perimeter_mm);
    // Resin leaves it through holes between feet that are apart, and it hangs together.
    let mut apart = solids::sphere(3.0, 4);
    apart.extend(solids::moved(&apart, Vec3::new(40.0, 20.0, 0.0)));
    let mut apart = load(&apart);
    let mut sliced = |raft_hole_mm: f64| {
        let profile = SupportProfile {
            raft_hole_mm,
            raft_slope: 50.0,
            ..closed
        };
        checked(&mut apart, &supported(of(profile)))
    };
    let (with, open) = (sliced(0.0), sliced(4.0));
    let [closed_mm2, open_mm2] = [&with, &open].map(|it| area_mm2(it, 0.1));
    assert!(open_mm2 < 0.9 * closed_mm2, "{open_mm2} of {closed_mm2}");
    assert_eq!(open.1.bodies, 1);
    let cups = |(_, found): &(Report, Printability)| {
        let counts = found.counts.iter();
        let of = |code| counts.clone().filter(move |it| it.code == code).count();
        [of(Code::Cup), of(Code::Trap), of(Code::LooseBody)]
    };
    assert_eq!(cups(&open), [0; 3]);
    assert_eq!(cups(&with), [0; 3]);
    let low_lift = of(SupportProfile {
        lift_mm: 1.5,
        ..closed
    });
    let error = supported(low_lift).check().unwrap_err();
    assert!(error.to_string().contains("lift_mm"), "{error}");
}

#[test]
fn layers_are_thicker_below_the_model_if_asked() {
    let mut ball = load(&solids::sphere(8.0, 5));
    let fine = Options {
        layer_max_mm: Some(0.1),
        ..supported(Supporting::default())
    };
    let thick = Options {
        support_layer_mm: Some(0.2),
        ..fine.clone()
    };
    let report = plan(&mut ball, &thick);
    assert!(report.z_mm.contains(&5.0));
    for (layer, &thickness_mm) in report.thickness_mm.iter().enumerate() {
        let most_mm = if report.z_mm[layer] < 5.0 { 0.2 } else { 0.1 };
        assert!(thickness_mm <= most_mm + 1e-9, "{layer}: {thickness_mm}");
    }
    let below = report.z_mm.partition_point(|&it| it < 5.0);
    assert_eq!(below, 25);
    assert!(report.max_error <= report.tolerance);
    // Above the plate of the model all is as it would be with a plane there.
    let plane = Options {
        planes_mm: vec![5.0],
        ..fine
    };
    let usual = plan(&mut ball, &plane);
    let above = |report: &Report| {
        let from = report.z_mm.partition_point(|&it| it < 5.0);
        report.z_mm[from..].to_vec()
    };
    assert_eq!(above(&report), above(&usual));
    let uniform = Options {
        planner: Planner::Uniform { layer_mm: 0.05 },
        ..thick
    };
    let error = uniform.check().unwrap_err();
    let Error::Options(OptionsError::Contradictory { option, .. }) = error else {
        panic!("{error}");
    };
    assert_eq!(option, "support_layer_mm");
}

#[test]
fn sizes_that_are_absent_are_those_of_the_strength() {
    let read = |text: &str| serde_json::from_str::<Supporting>(text);
    let heavy = SupportStrength::Heavy.profile();
    let asked = read(r#"{ "strength": "heavy", "profile": { "raft": true, "lift_mm": 7 } }"#);
    let expected = SupportProfile {
        raft: true,
        lift_mm: 7.0,
        ..heavy
    };
    assert_eq!(asked.unwrap().profile(), expected);
    assert_eq!(read(r#"{ "strength": "heavy" }"#).unwrap().profile, None);
    let error = read(r#"{ "profile": { "spacing": 2 } }"#).unwrap_err();
    assert!(error.to_string().contains("`spacing`"), "{error}");
}

#[test]
fn sizes_that_nothing_can_be_made_of_are_refused() {
    let usual = SupportProfile::default();
    let cases = [
        (
            "supports.profile.lift_mm",
            SupportProfile {
                lift_mm: -1.0,
                ..usual
            },
        ),
        (
            "supports.profile.contact_mm",
            SupportProfile {
                contact_mm: 0.0,
                ..usual
            },
        ),
        (
            "supports.profile.spacing_mm",
            SupportProfile {
                spacing_mm: f64::NAN,
                ..usual
            },
        ),
        (
            "supports.profile.pillar_mm",
            SupportProfile {
                pillar_mm: f64::INFINITY,
                ..usual
            },
        ),
        (
            "supports.profile.foot_mm",
            SupportProfile {
                foot_mm: 0.5,
                ..usual
            },
        ),
        (
            "supports.profile.tip_mm",
            SupportProfile {
                tip_mm: 1e9,
                ..usual
            },
        ),
    ];
    for (name, profile) in cases {
        let error = supported(of(profile)).check().unwrap_err();
        let Error::Options(OptionsError::BadLength { option, .. }) = error else {
            panic!("{error}");
        };
        assert_eq!(option, name);
    }
    // The largest and the smallest of all sizes still end.
    let mut cube = load(&solids::cube(10.0));
    for mm in [50.0, 20.0] {
        let large = SupportProfile {
            contact_mm: mm,
            pillar_mm: mm,
            foot_mm: mm,
            tip_mm: mm,
            clearance_mm: mm,
            spacing_mm: mm,
            ..usual
        };
        plan(&mut cube, &supported(of(large)));
    }
}

#[test]
fn the_result_does_not_depend_on_the_order_of_facets() {
    let triangles = solids::gyroid(2, 12);
    let mesh = |triangles: &solids::Triangles| {
        let mesh = Mesh::from_triangles(triangles).unwrap();
        mesh.on_plate(&Pose::of_height(20.0)).unwrap()
    };
    let one = supports_of(&mesh(&triangles), &Supporting::default());
    let other = supports_of(&mesh(&solids::shuffled(&triangles)), &Supporting::default());
    let points = |supports: &Supports| {
        let mut points: Vec<[u64; 3]> = supports
            .points
            .iter()
            .map(|it| it.at_mm.map(f64::to_bits))
            .collect();
        points.sort_unstable();
        points
    };
    assert_eq!(points(&one), points(&other));
}
