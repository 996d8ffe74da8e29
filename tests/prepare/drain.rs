//! Drain holes.

use crate::common::Slicer;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::job::Report;
use cusp_slicer::model::Mesh;
use cusp_slicer::prepare::{AutoDrain, Drain, Hollowing, plugs};
use cusp_slicer::warning::Warning;
use glam::Vec3;

use super::{hollowed, plan};
use crate::common::{assert_near, load, quiet, solids};

/// A hole of 3 mm into the side of a cube of 20 mm.
const SIDE: Drain = Drain {
    at_mm: [10.0, 0.0, 10.0],
    direction: [-1.0, 0.0, 0.0],
    diameter_mm: 3.0,
    depth_mm: None,
};

fn drained(drains: Vec<Drain>) -> Hollowing {
    Hollowing {
        drains,
        ..Hollowing::default()
    }
}

fn automatic() -> Hollowing {
    Hollowing {
        auto_drain: Some(AutoDrain::default()),
        ..Hollowing::default()
    }
}

#[test]
fn a_hole_by_hand_goes_through_the_wall_and_no_further() {
    let mut cube = load(&solids::cube(20.0));
    let solid = plan(&mut cube, &hollowed(Hollowing::default()));
    let report = plan(&mut cube, &hollowed(drained(vec![SIDE])));
    let void = report.models[0].hollowed.clone().unwrap();
    let [drain] = void.drains[..] else {
        panic!("{void:?}");
    };
    let depth_mm = drain.depth_mm.unwrap();
    assert!((depth_mm - 2.0).abs() <= void.resolution_mm, "{depth_mm}");
    // A prism of 32 sides.
    let area_mm2 = 16.0 * 1.5f64.powi(2) * (std::f64::consts::TAU / 32.0).sin();
    assert_near(
        solid.resin_ml - report.resin_ml,
        area_mm2 * depth_mm / 1e3,
        2e-4,
    );
    assert_eq!(report.all_warnings(), []);
}

#[test]
fn a_slanted_hole_is_deep_enough_for_its_whole_rim() {
    let slanted = Drain {
        direction: [-1.0, 0.0, 1.0],
        ..SIDE
    };
    let mut cube = load(&solids::cube(20.0));
    let void = plan(&mut cube, &hollowed(drained(vec![slanted])));
    let void = void.models[0].hollowed.clone().unwrap();
    // The middle crosses a wall of 2 mm at 45°, and the farthest point of the rim enters it a radius later.
    let depth_mm = void.drains[0].depth_mm.unwrap();
    let expected_mm = 2.0 * 2f64.sqrt() + 1.5;
    assert!(
        (depth_mm - expected_mm).abs() <= 2.0 * void.resolution_mm,
        "{depth_mm}"
    );
}

#[test]
fn a_slanted_hole_is_where_it_was_asked_for_at_the_side_of_the_box() {
    let mut cube = load(&solids::cube(20.0));
    let solid = plan(&mut cube, &hollowed(Hollowing::default()));
    for direction in [[-1.0, 0.0, 1.0], [-1.0, 0.5, -1.0], [-1.0, 1.0, 0.0]] {
        let slanted = Drain { direction, ..SIDE };
        let report = plan(&mut cube, &hollowed(drained(vec![slanted])));
        // It removes a slanted cylinder from a wall of 2 mm.
        let [x, y, z] = direction;
        let longer = (x * x + y * y + z * z).sqrt();
        let wall_mm = 2.0 + 0.5 * report.models[0].hollowed.clone().unwrap().resolution_mm;
        let expected_mm3 = 7.02 * wall_mm * longer;
        let taken_mm3 = (solid.resin_ml - report.resin_ml) * 1e3;
        println!("{direction:?}: {taken_mm3:.2} of {expected_mm3:.2}");
        assert!((taken_mm3 / expected_mm3 - 1.0).abs() < 0.1);
        // In the middle of its height it is on the face where it was placed.
        let middle = report.z_mm.iter().position(|&z_mm| z_mm > 10.0).unwrap();
        let mask = cube.mask(middle).unwrap();
        let width = report.mask.width as usize;
        let row_bytes = width.div_ceil(8);
        let row = (f64::from(report.mask.height) / 2.0) as usize;
        let last = width - 2;
        assert_eq!(mask[row * row_bytes + last / 8] & 0x80 >> (last % 8), 0);
    }
}

#[test]
fn a_hole_that_meets_no_void_is_left_out_and_named() {
    let outward = Drain {
        direction: [1.0, 0.0, 0.0],
        ..SIDE
    };
    let mut cube = load(&solids::cube(20.0));
    let report = plan(&mut cube, &hollowed(drained(vec![SIDE, outward])));
    assert_eq!(report.models[0].hollowed.clone().unwrap().drains.len(), 1);
    assert_eq!(
        report.all_warnings(),
        [Warning::DrainAstray { drain_number: 2 }]
    );
}

/// Upright cuboids from a corner to the opposite one.
fn blocks(all: &[[[f32; 3]; 2]]) -> solids::Triangles {
    let block = |&[from, to]: &[[f32; 3]; 2]| {
        let (from, to) = (Vec3::from_array(from), Vec3::from_array(to));
        solids::moved(&solids::cuboid(to - from), from)
    };
    all.iter().flat_map(block).collect()
}

#[test]
fn automatic_holes_leave_no_trap_and_no_cup() {
    let two_feet = blocks(&[
        [[0.0, 0.0, 0.0], [12.0, 20.0, 30.0]],
        [[28.0, 0.0, 0.0], [40.0, 20.0, 30.0]],
        [[0.0, 0.0, 18.0], [40.0, 20.0, 30.0]],
    ]);
    let table = blocks(&[
        [[14.0, 14.0, 0.0], [26.0, 26.0, 30.0]],
        [[0.0, 0.0, 20.0], [40.0, 40.0, 32.0]],
    ]);
    let all = [
        ("ball", solids::sphere(15.0, 5), 1),
        ("cube", solids::cube(20.0), 1),
        ("cylinder", solids::cylinder(12.0, 30.0, 16), 1),
        ("two feet", two_feet, 2),
        ("table", table, 2),
    ];
    for (name, triangles, holes) in all {
        let mut model = load(&triangles);
        let codes = |slicer: &mut crate::common::Slicer| {
            let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
            let of_hollows = [Code::Trap, Code::Cup, Code::NarrowDrain];
            let counts = found.counts.into_iter().map(|count| count.code);
            counts
                .filter(|code| of_hollows.contains(code))
                .collect::<Vec<_>>()
        };
        plan(&mut model, &hollowed(Hollowing::default()));
        assert!(codes(&mut model).contains(&Code::Trap), "{name}");
        let report = plan(&mut model, &hollowed(automatic()));
        assert_eq!(codes(&mut model), [], "{name}");
        let void = report.models[0].hollowed.clone().unwrap();
        println!("{name}: {:?}", void.drains);
        // The table's top has a floor around its leg, at one height all the way.
        assert!(void.drains.len() <= holes, "{name}: {:?}", void.drains);
        assert_eq!(report.all_warnings(), [], "{name}");
    }
}

#[test]
fn holes_of_a_report_can_be_given_again() {
    let mut ball = load(&solids::sphere(15.0, 4));
    let report = plan(&mut ball, &hollowed(automatic()));
    let mask = ball.mask(30).unwrap();
    let drains = report.models[0].hollowed.clone().unwrap().drains;
    let again = plan(&mut ball, &hollowed(drained(drains)));
    assert_eq!(again.models[0].hollowed, report.models[0].hollowed);
    assert_eq!(again.resin_ml, report.resin_ml);
    assert!(ball.mask(30).unwrap() == mask);
}

#[test]
fn a_hole_through_the_plate_ends_there() {
    let below = Drain {
        at_mm: [0.0, 0.0, 0.0],
        direction: [0.0, 0.0, 1.0],
        ..SIDE
    };
    let slanted = Drain {
        direction: [0.3, 0.1, 1.0],
        ..below
    };
    let level = Drain {
        at_mm: [10.0, 0.0, 0.5],
        depth_mm: Some(5.0),
        ..SIDE
    };
    let mut cube = load(&solids::cube(20.0));
    let solid = plan(&mut cube, &hollowed(Hollowing::default()));
    for (drain, volume_mm3) in [
        (below, 14.05),
        (slanted, 14.05 * 1.1f64.sqrt()),
        // Of a circle of 3 mm, the part more than 0.5 mm below its middle is missing.
        (level, 5.0 * (7.07 - 2.065)),
    ] {
        let report = plan(&mut cube, &hollowed(drained(vec![drain])));
        let taken_mm3 = (solid.resin_ml - report.resin_ml) * 1e3;
        println!("{taken_mm3} of {volume_mm3}");
        assert!(
            (taken_mm3 / volume_mm3 - 1.0).abs() < 0.1,
            "{taken_mm3} for {volume_mm3}"
        );
    }
}

#[test]
fn holes_that_no_plate_holds_are_left_out() {
    let mut cube = load(&solids::cube(20.0));
    for drain in [
        Drain {
            at_mm: [1e300, 0.0, 0.0],
            depth_mm: Some(1.0),
            ..SIDE
        },
        Drain {
            at_mm: [500.0, 0.0, 5.0],
            depth_mm: Some(1.0),
            ..SIDE
        },
        Drain {
            direction: [0.0; 3],
            ..SIDE
        },
        Drain {
            direction: [f64::NAN, 0.0, 0.0],
            ..SIDE
        },
        Drain {
            depth_mm: Some(-3.0),
            ..SIDE
        },
        Drain {
            depth_mm: Some(1e30),
            ..SIDE
        },
    ] {
        let report = plan(&mut cube, &hollowed(drained(vec![drain])));
        assert_eq!(
            report.all_warnings(),
            [Warning::DrainAstray { drain_number: 1 }],
            "{drain:?}"
        );
    }
}

#[test]
fn a_direction_has_any_length() {
    let mut cube = load(&solids::cube(20.0));
    let usual = plan(&mut cube, &hollowed(drained(vec![SIDE])));
    for length in [1e-200, 1e200] {
        let drain = Drain {
            direction: [-length, 0.0, 0.0],
            ..SIDE
        };
        let report = plan(&mut cube, &hollowed(drained(vec![drain])));
        assert_eq!(report.resin_ml, usual.resin_ml);
    }
}

#[test]
fn holes_as_wide_as_the_model_are_not_made() {
    let mut cube = load(&solids::cube(20.0));
    for diameter_mm in [25.0, 1e3] {
        let hollow = Hollowing {
            auto_drain: Some(AutoDrain {
                diameter_mm,
                ..AutoDrain::default()
            }),
            ..Hollowing::default()
        };
        let report = plan(&mut cube, &hollowed(hollow));
        assert_eq!(report.all_warnings(), [Warning::Undrained { basins: 1 }]);
    }
}

#[test]
fn pits_beside_a_hole_are_filled() {
    // A groove below makes a ridge in the floor of the void, lower than its lattice resolves.
    for groove_mm in [0.1, 0.2, 0.3, 0.4] {
        let model = blocks(&[
            [[0.0, 0.0, groove_mm], [40.0, 20.0, 20.0]],
            [[0.0, 0.0, 0.0], [17.0, 20.0, 1.0]],
            [[23.0, 0.0, 0.0], [40.0, 20.0, 1.0]],
        ]);
        let mut model = load(&model);
        let report = plan(&mut model, &hollowed(automatic()));
        assert_eq!(report.all_warnings(), []);
        let limits = Limits {
            cup_mm2: 0.05,
            trap_ml: 0.0,
            ..Limits::default()
        };
        let found = model.inspect(&limits, &mut quiet).unwrap();
        let kept = [Code::Cup, Code::Trap];
        let kept = found.counts.iter().find(|it| kept.contains(&it.code));
        assert_eq!(kept, None, "{groove_mm} mm");
        // Walls grow by no more than the pit was deep.
        let unfilled = plan(&mut model, &hollowed(Hollowing::default()));
        let void_ml = |report: &Report| report.models[0].hollowed.as_ref().unwrap().void_ml;
        let most_ml = f64::from(groove_mm) * 36.0 * 16.0 / 1e3;
        let filled_ml = void_ml(&unfilled) - void_ml(&report);
        assert!((0.0..most_ml).contains(&filled_ml), "{filled_ml}");
    }
}

#[test]
fn automatic_holes_keep_off_what_weighs_more_where_they_can() {
    let triangles = solids::cube(20.0);
    let mut cube = load(&triangles);
    let hole = |cube: &mut Slicer, protect| {
        let auto_drain = AutoDrain {
            protect,
            ..AutoDrain::default()
        };
        let options = hollowed(Hollowing {
            auto_drain: Some(auto_drain),
            ..Hollowing::default()
        });
        let report = plan(cube, &options);
        assert_eq!(report.all_warnings(), []);
        let [drain] = report.models[0].hollowed.clone().unwrap().drains[..] else {
            panic!("one basin has one hole");
        };
        drain
    };
    let shortest = hole(&mut cube, true);
    // Weights are those of the facets of the file.
    let weigh = |cube: &mut Slicer, is_heavy: &dyn Fn(Vec3) -> bool| {
        let weight = |corners: &[Vec3; 3]| {
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            if is_heavy(middle - Vec3::splat(10.0)) {
                1.0
            } else {
                0.0
            }
        };
        cube.set_weights(Some(triangles.iter().map(weight).collect()))
            .unwrap();
    };
    // The face that the shortest hole is in.
    let side = Vec3::from_array(shortest.direction.map(|it| -it as f32));
    weigh(&mut cube, &|middle| middle.dot(side) > 9.0);
    assert_eq!(hole(&mut cube, false), shortest);
    let beside = hole(&mut cube, true);
    let at = Vec3::from_array(beside.at_mm.map(|mm| mm as f32)) - Vec3::Z * 10.0;
    assert!(at.dot(side) < 9.0, "{beside:?}");
    // If all facets have more weight, a hole that shows is better than resin that stays.
    weigh(&mut cube, &|_| true);
    assert_eq!(hole(&mut cube, true), shortest);
}

#[test]
fn plugs_fill_their_holes_but_for_the_play() {
    let drains = [3.0, 5.0].map(|diameter_mm| Drain {
        diameter_mm,
        depth_mm: Some(3.0 + 0.25 * diameter_mm),
        ..SIDE
    });
    let plugs = plugs(&drains);
    let corners = |facet: &[u32; 3]| facet.map(|it| plugs.vertices[it as usize]);
    let mesh = Mesh::from_triangles(&plugs.facets.iter().map(corners).collect::<Vec<_>>()).unwrap();
    assert_eq!(mesh.open_edges, 0);
    // Frustums of 32 sides, 3 mm high, 0.2 mm narrower at their tops.
    let sector = 16.0 * (std::f64::consts::TAU / 32.0).sin();
    let volume_mm3 = |diameter_mm: f64| {
        let (a, b) = (diameter_mm / 2.0, diameter_mm / 2.0 - 0.1);
        sector * (a * a + a * b + b * b)
    };
    assert_near(plugs.volume_mm3(), volume_mm3(3.0) + volume_mm3(5.0), 1e-4);
    // They stand in a row, 2 mm apart.
    let bounds = mesh.bounds();
    assert_near(bounds.size().x, 3.0 + 2.0 + 5.0, 1e-5);
    assert_near(bounds.size().z, 3.0, 1e-5);
}
