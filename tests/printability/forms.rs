//! Solids whose findings are known, in layers and on pixels of 0.05 mm.

use cusp_slicer::inspect::{Code, Limits, Printability, Severity, Verdict};
use glam::{Mat3, Vec3};

use super::solids::Triangles;
use super::{block, check, of_code, strict};
use crate::common::{assert_near, solids};

/// Four walls of a square of 10 mm, 1 mm thick.
pub fn walls(bottom: f32, top: f32) -> Triangles {
    let mut all = block([0.0, 0.0, bottom], [10.0, 1.0, top]);
    all.extend(block([0.0, 9.0, bottom], [10.0, 10.0, top]));
    all.extend(block([0.0, 1.0, bottom], [1.0, 9.0, top]));
    all.extend(block([9.0, 1.0, bottom], [10.0, 9.0, top]));
    all
}

/// A square of 10 mm.
pub fn slab(bottom: f32, top: f32) -> Triangles {
    block([0.0, 0.0, bottom], [10.0, 10.0, top])
}

/// Walls, of which one has a door of 2 mm.
pub fn walls_with_door(bottom: f32, top: f32) -> Triangles {
    let mut all = block([0.0, 0.0, bottom], [10.0, 1.0, top]);
    all.extend(block([0.0, 9.0, bottom], [10.0, 10.0, top]));
    all.extend(block([0.0, 1.0, bottom], [1.0, 9.0, top]));
    all.extend(block([9.0, 1.0, bottom], [10.0, 4.0, top]));
    all.extend(block([9.0, 6.0, bottom], [10.0, 9.0, top]));
    all
}

pub fn joined(parts: impl IntoIterator<Item = Triangles>) -> Triangles {
    parts.into_iter().flatten().collect()
}

#[track_caller]
pub fn assert_codes(found: &Printability, expected: &[Code]) {
    let codes: Vec<Code> = found.counts.iter().map(|count| count.code).collect();
    assert_eq!(codes, expected, "{:#?}", found.findings);
}

/// Limits for which bridges are no longer than this.
fn bridges(bridge_mm: f64) -> Limits {
    Limits {
        bridge_mm,
        ..strict()
    }
}

#[test]
fn a_pot_is_a_cup_up_to_its_rim() {
    let found = check(&joined([slab(0.0, 1.0), walls(1.0, 5.0)]), &strict());
    assert_codes(&found, &[Code::Cup]);
    let [cup] = of_code(&found, Code::Cup)[..] else {
        panic!("{:#?}", found.findings);
    };
    assert_eq!(cup.layers, [20, 99]);
    assert_near(cup.area_mm2, 64.0, 1e-9);
    assert_near(cup.volume_mm3, 256.0, 1e-9);
    assert_eq!(
        cup.bounds_mm[0].map(|it| (it * 1e6).round() / 1e6),
        [-4.0, -4.0, 1.0]
    );
    assert_eq!(
        cup.bounds_mm[1].map(|it| (it * 1e6).round() / 1e6),
        [4.0, 4.0, 5.0]
    );
    assert_eq!(found.verdict, Verdict::Review);
}

#[test]
fn a_sealed_box_is_a_trap() {
    let triangles = joined([slab(0.0, 1.0), walls(1.0, 5.0), slab(5.0, 6.0)]);
    let found = check(&triangles, &strict());
    assert_codes(&found, &[Code::Trap]);
    let trap = of_code(&found, Code::Trap)[0];
    assert_eq!(trap.layers, [20, 99]);
    assert_near(trap.volume_mm3, 256.0, 1e-9);
    assert_eq!(found.verdict, Verdict::Reject);
    // The roof spans 8 mm from wall to wall. Three pixels of it are supported on each side; 1 mm more may reach out.
    let found = check(&triangles, &bridges(0.0));
    assert_codes(&found, &[Code::Overhang, Code::Trap]);
    let overhang = of_code(&found, Code::Overhang)[0];
    assert_eq!(overhang.layers[0], 100);
    assert_near(overhang.area_mm2, 5.7 * 5.7, 1e-9);
}

#[test]
fn a_pot_upside_down_is_closed_by_the_plate() {
    let found = check(&joined([walls(0.0, 4.0), slab(4.0, 5.0)]), &strict());
    let trap = of_code(&found, Code::Trap)[0];
    assert_eq!(trap.layers, [0, 79]);
    assert_near(trap.volume_mm3, 256.0, 1e-9);
}

#[test]
fn a_box_with_a_hole_is_a_cup_below_the_hole() {
    let parts = [
        slab(0.0, 1.0),
        walls(1.0, 2.0),
        walls_with_door(2.0, 3.0),
        walls(3.0, 5.0),
        slab(5.0, 6.0),
    ];
    let found = check(&joined(parts), &strict());
    assert_codes(&found, &[Code::Cup]);
    let cup = of_code(&found, Code::Cup)[0];
    assert_eq!(cup.layers, [20, 39]);
    assert_near(cup.volume_mm3, 64.0, 1e-9);
}

#[test]
fn a_box_with_a_hole_at_the_plate_drains() {
    let parts = [walls_with_door(0.0, 1.0), walls(1.0, 5.0), slab(5.0, 6.0)];
    assert_codes(&check(&joined(parts), &strict()), &[]);
}

/// Two towers that are `span_mm` apart, and a beam on them.
fn bridge(span_mm: f32) -> Triangles {
    joined([
        block([0.0, 0.0, 0.0], [2.0, 2.0, 3.0]),
        block([2.0 + span_mm, 0.0, 0.0], [4.0 + span_mm, 2.0, 3.0]),
        block([0.0, 0.0, 3.0], [4.0 + span_mm, 2.0, 5.0]),
    ])
}

#[test]
fn a_bridge_hangs_over_if_it_is_long() {
    assert_codes(&check(&bridge(2.0), &bridges(0.0)), &[]);
    // Three pixels at each end are supported.
    for longest_mm in [7.7, 1e12, f64::MAX] {
        assert_codes(&check(&bridge(8.0), &bridges(longest_mm)), &[]);
        let beam = turned(&bridge(8.0), 90.0);
        assert_codes(&check(&beam, &bridges(longest_mm)), &[]);
    }
    let found = check(&bridge(8.0), &bridges(7.65));
    assert_codes(&found, &[Code::Overhang]);
    let overhang = of_code(&found, Code::Overhang)[0];
    assert_eq!(overhang.layers[0], 60);
    assert_near(overhang.area_mm2, 5.7 * 2.0, 1e-9);
    assert_near(overhang.at_mm[0], 0.0, 0.03);
    assert_near(overhang.at_mm[2], 3.025, 1e-9);
}

/// Turned about z.
fn turned(triangles: &Triangles, degrees: f32) -> Triangles {
    let turn = Mat3::from_rotation_z(degrees.to_radians());
    let corners = triangles.iter();
    corners
        .map(|facet| facet.map(|corner| turn * corner))
        .collect()
}

#[test]
fn a_bridge_holds_however_it_is_turned() {
    for degrees in 0..90 {
        let bridge = turned(&bridge(6.0), degrees as f32);
        // Lines are up to 13° askew, and so longer by up to 3 %.
        assert_codes(&check(&bridge, &bridges(6.0)), &[]);
        assert_codes(&check(&bridge, &bridges(5.4)), &[Code::Overhang]);
    }
}

#[test]
fn what_stands_on_a_bridge_is_held() {
    let tower = block([5.5, 0.5, 5.0], [6.5, 1.5, 9.0]);
    let arms = block([4.0, 0.5, 9.0], [8.0, 1.5, 10.0]);
    assert_codes(
        &check(&joined([bridge(8.0), tower.clone()]), &strict()),
        &[],
    );
    let found = check(&joined([bridge(8.0), tower, arms]), &strict());
    assert_codes(&found, &[Code::Overhang]);
    assert_eq!(of_code(&found, Code::Overhang)[0].layers[0], 180);
}

#[test]
fn a_balcony_in_a_corner_is_no_bridge() {
    let balcony = block([1.0, 1.0, 3.0], [4.0, 4.0, 4.0]);
    let corner = [
        block([0.0, 0.0, 0.0], [1.0, 9.0, 6.0]),
        block([1.0, 0.0, 0.0], [9.0, 1.0, 6.0]),
        balcony,
    ];
    let found = check(&joined(corner), &strict());
    assert_codes(&found, &[Code::Overhang]);
    // The part that no line from one wall to the other holds: such a line is at most twice as steep as the diagonal.
    let overhang = of_code(&found, Code::Overhang)[0];
    assert!(overhang.area_mm2 < 3.0 * 3.0 / 2.0, "{overhang:?}");
}

#[test]
fn a_rim_within_walls_is_a_bridge_if_they_are_near() {
    // A roof with a hole of 2 mm in its middle.
    let rim = [
        block([1.0, 1.0, 5.0], [9.0, 4.0, 6.0]),
        block([1.0, 6.0, 5.0], [9.0, 9.0, 6.0]),
        block([1.0, 4.0, 5.0], [4.0, 6.0, 6.0]),
        block([6.0, 4.0, 5.0], [9.0, 6.0, 6.0]),
    ];
    let shaft = joined([walls_with_door(0.0, 1.0), walls(1.0, 6.0), joined(rim)]);
    assert_codes(&check(&shaft, &bridges(8.0)), &[]);
    let found = check(&shaft, &bridges(4.0));
    assert_codes(&found, &[Code::Overhang]);
}

#[test]
fn a_wall_holds_nothing_across_a_gap() {
    // A bar of 19 mm beside a wall, which it joins at one end alone or all along.
    let bar = |gap_mm: f32| {
        joined([
            block([0.0, 0.0, 0.0], [2.0, 20.0, 8.0]),
            block([1.0, 0.0, 0.0], [3.0, 1.0, 8.0]),
            block([2.0 + gap_mm, 0.5, 5.0], [2.9, 20.0, 6.0]),
        ])
    };
    assert_codes(&check(&bar(0.0), &strict()), &[]);
    for gap_mm in [0.4, 0.2] {
        let found = check(&bar(gap_mm), &strict());
        let [overhang] = of_code(&found, Code::Overhang)[..] else {
            panic!("{:#?}", found.findings);
        };
        // All but a millimetre beside the end, and up to an eighth more.
        let width_mm = f64::from(0.9 - gap_mm);
        let area_mm2 = overhang.area_mm2 / width_mm;
        assert!((17.8..18.1).contains(&area_mm2), "{gap_mm}: {area_mm2}");
    }
}

#[test]
fn a_table_hangs_over_on_all_sides_as_one() {
    let leg = block([4.0, 4.0, 0.0], [6.0, 6.0, 3.0]);
    let table = joined([leg, slab(3.0, 4.0)]);
    let limits = Limits {
        contact: Some(0.05),
        peel_mm2: Some(99.0),
        peel_jump_mm2: Some(95.0),
        ..strict()
    };
    let found = check(&table, &limits);
    let expected = [
        Code::Overhang,
        Code::PeelArea,
        Code::PeelJump,
        Code::SmallContact,
    ];
    assert_codes(&found, &expected);
    assert_eq!(found.counts[0].found, 1);
    assert_eq!((found.peel.largest_layer, found.peel.jump_layer), (60, 60));
    assert_near(found.peel.jump_mm2, 96.0, 1e-9);
    assert_near(found.peel.contact, 0.04, 1e-9);
}

#[test]
fn the_film_pulls_by_area_and_perimeter() {
    // Newtons at 15 kPa: a disc of 20 mm, a square of 10 mm, and two squares as much as both.
    let newtons = |area_mm2: f64, perimeter_mm: f64| {
        0.015 * area_mm2 * (2.0 * area_mm2 / perimeter_mm / 10.0).sqrt()
    };
    let square = block([20.0, 0.0, 0.0], [30.0, 10.0, 2.0]);
    let cases = [
        (solids::cylinder(10.0, 2.0, 32), newtons(314.0, 62.8), 0.01),
        (square.clone(), newtons(100.0, 40.0), 0.03),
        (
            joined([slab(0.0, 2.0), square]),
            2.0 * newtons(100.0, 40.0),
            0.03,
        ),
    ];
    for (solid, expected, within) in cases {
        let pulls = check(&solid, &Limits::default()).peel.pull_n;
        for pull in pulls {
            assert_near(pull / expected, 1.0, within);
        }
    }
}

/// A cone that stands on its tip.
fn funnel(radius: f64, height: f64) -> Triangles {
    let flip = |corner: Vec3| Vec3::new(corner.x, corner.y, -corner.z);
    let upside_down: Triangles = solids::cone(radius, height, 32)
        .iter()
        .map(|corners| corners.map(flip))
        .collect();
    solids::inverted(&upside_down)
}

#[test]
fn a_cone_on_its_tip_hangs_over_if_it_is_flat() {
    // 45° and 22° from level support themselves; 9° do not.
    for (radius, height, hangs_over) in [(4.0, 4.0, false), (5.0, 2.0, false), (10.0, 1.6, true)] {
        let found = check(&funnel(radius, height), &strict());
        let has_some = !of_code(&found, Code::Overhang).is_empty();
        assert_eq!(has_some, hangs_over, "{height}");
    }
}

#[test]
fn what_hangs_down_is_an_island_until_it_joins() {
    let triangles = joined([
        block([0.0, 0.0, 0.0], [4.0, 4.0, 4.0]),
        block([4.0, 0.0, 3.0], [4.8, 4.0, 4.0]),
        block([4.4, 1.0, 1.0], [4.8, 2.0, 3.0]),
    ]);
    let found = check(&triangles, &strict());
    assert_codes(&found, &[Code::Island]);
    let island = of_code(&found, Code::Island)[0];
    assert_eq!((island.layers, island.joins_layer), ([20, 59], Some(60)));
    assert_near(island.volume_mm3, 0.8, 1e-9);
    assert_near(island.at_mm[2], 1.025, 1e-9);
    assert_eq!(found.bodies, 1);
}

#[test]
fn an_edge_is_no_bond() {
    let beside = joined([slab(0.0, 1.0), block([10.0, 10.0, 0.0], [12.0, 12.0, 1.0])]);
    let found = check(&beside, &strict());
    assert_codes(&found, &[Code::SeparateBody]);
    assert_near(found.findings[0].volume_mm3, 4.0, 1e-9);
    let above = joined([slab(0.0, 1.0), block([10.0, 0.0, 1.0], [12.0, 2.0, 3.0])]);
    let found = check(&above, &strict());
    assert_codes(&found, &[Code::LooseBody]);
    assert_eq!((found.bodies, found.verdict), (2, Verdict::Review));
    assert_eq!(found.findings[0].layers, [20, 59]);
}

#[test]
fn a_dust_grain_is_a_speck() {
    let grain = block([5.0, 5.0, 3.0], [5.05, 5.05, 3.4]);
    let limits = Limits {
        speck_px: 4,
        ..strict()
    };
    let found = check(&joined([slab(0.0, 1.0), grain]), &limits);
    assert_eq!(of_code(&found, Code::Speck).len(), 1);
    let flake = block([5.0, 5.0, 3.0], [8.0, 8.0, 3.05]);
    let found = check(&joined([slab(0.0, 1.0), flake]), &strict());
    assert_eq!(of_code(&found, Code::Speck)[0].layers, [60, 60]);
}

#[test]
fn walls_are_thin_below_the_limit() {
    // From 0.1 to 0.8 mm. Masks may show a wall of 0.35 mm that has 0.4.
    let wall = |i: u32| {
        let from = 2.0 * i as f32;
        block([from, 0.0, 1.0], [from + 0.1 * i as f32, 5.0, 3.0])
    };
    let base = block([0.0, 0.0, 0.0], [18.0, 5.0, 1.0]);
    let found = check(&joined((1..=8).map(wall).chain([base])), &strict());
    assert_codes(&found, &[Code::ThinWall]);
    let walls = of_code(&found, Code::ThinWall);
    let volumes: Vec<f64> = walls
        .iter()
        .map(|it| (it.volume_mm3 * 1e6).round() / 1e6)
        .collect();
    assert_eq!(volumes, [3.0, 2.0, 1.0]);
    assert_eq!(walls[0].layers, [20, 59]);
}

#[test]
fn walls_are_thin_at_any_angle() {
    for degrees in [0.0f32, 7.0, 20.0, 33.0, 45.0] {
        for (thickness, count) in [(0.25, 1), (0.4, 0), (0.5, 0)] {
            let turn = glam::Quat::from_rotation_z(degrees.to_radians());
            let wall: Triangles = block([0.0, 0.0, 0.0], [6.0, thickness, 2.0])
                .iter()
                .map(|corners| corners.map(|corner| turn * corner))
                .collect();
            let found = check(&wall, &strict());
            let walls = of_code(&found, Code::ThinWall).len();
            assert_eq!(walls, count, "{thickness} mm at {degrees}°");
        }
    }
}

#[test]
fn gaps_are_narrow_below_the_limit() {
    // A comb whose gaps are from 0.1 to 0.6 mm wide.
    let tooth = |i: u32| {
        let from = 2.0 * i as f32;
        block([from + 0.1 * i as f32, 0.0, 1.0], [from + 2.0, 5.0, 3.0])
    };
    let base = block([0.0, 0.0, 0.0], [14.0, 5.0, 1.0]);
    let found = check(&joined((0..=6).map(tooth).chain([base])), &strict());
    assert_codes(&found, &[Code::NarrowGap]);
    // Their mouths, 0.3 mm deep, are within reach of the outside.
    let gaps = of_code(&found, Code::NarrowGap);
    assert_eq!(gaps.len(), 2);
    assert!((0.2 * 4.4 * 2.0..0.2 * 5.0 * 2.0).contains(&gaps[0].volume_mm3));
    assert!((0.1 * 4.4 * 2.0..0.1 * 5.0 * 2.0).contains(&gaps[1].volume_mm3));
}

#[test]
fn holes_are_small_below_the_limit() {
    // A strip of holes from 0.2 to 0.7 mm, and a slot that is long.
    let mut strip = block([0.0, 0.0, 0.0], [14.0, 3.0, 2.0]);
    for i in 2..8 {
        let (from, size) = (1.5 * i as f32 - 2.0, 0.1 * i as f32);
        let hole = block([from, 1.0, 0.0], [from + size, 1.0 + size, 2.0]);
        strip.extend(solids::inverted(&hole));
    }
    let slot = block([10.5, 1.0, 0.0], [13.0, 1.4, 2.0]);
    strip.extend(solids::inverted(&slot));
    let limits = Limits {
        gap_mm: 0.0,
        // On the plate, each is a cup too.
        cup_mm2: 99.0,
        ..strict()
    };
    let found = check(&strip, &limits);
    assert_codes(&found, &[Code::SmallHole]);
    let volumes: Vec<f64> = found
        .findings
        .iter()
        .map(|it| (it.volume_mm3 * 1e6).round() / 1e6)
        .collect();
    assert_eq!(volumes, [0.32, 0.18, 0.08]);
}

#[test]
fn floors_are_thin_below_the_limit() {
    let slab = |i: u32| {
        let from = 4.0 * i as f32;
        block([from, 0.0, 0.0], [from + 3.0, 3.0, 0.1 * i as f32])
    };
    let found = check(&joined((1..=6).map(slab)), &Limits::default());
    assert_codes(&found, &[Code::ThinFloor]);
    assert_eq!(found.counts[0].found, 3);
}

#[test]
fn gaps_are_low_below_the_limit() {
    // Shelves in a rack, 0.1 to 0.5 mm apart.
    let heights = [0.0, 2.0, 4.1, 6.3, 8.6, 11.0];
    let shelf = |i: usize| {
        let thick = 2.0;
        block([0.0, 0.0, heights[i]], [6.0, 3.0, heights[i] + thick])
    };
    let back = block([0.0, 3.0, 0.0], [6.0, 6.0, 13.0]);
    let found = check(&joined((0..6).map(shelf).chain([back])), &Limits::default());
    assert_eq!(of_code(&found, Code::LowGap).len(), 2);
}

#[test]
fn a_peg_in_a_nut_touches_nothing_and_needs_clearance() {
    let peg = |clearance: f32| {
        let (low, high) = (1.0 + clearance, 9.0 - clearance);
        joined([walls(0.0, 4.0), block([low, low, 0.0], [high, high, 4.0])])
    };
    let found = check(&peg(0.5), &strict());
    assert_codes(&found, &[Code::SeparateBody, Code::Cup]);
    assert_eq!(found.bodies, 2);
    let found = check(&peg(0.15), &strict());
    assert_codes(&found, &[Code::SeparateBody, Code::Cup, Code::NarrowGap]);
    assert_eq!(of_code(&found, Code::NarrowGap).len(), 1);
    // Without clearance they are one.
    assert_codes(&check(&peg(0.0), &strict()), &[]);
}

#[test]
fn sharp_corners_and_tips_are_no_thin_walls() {
    assert_codes(&check(&solids::cone(4.0, 5.0, 32), &strict()), &[]);
    let lens = check(&solids::sphere(6.0, 6), &strict());
    for code in [
        Code::ThinWall,
        Code::ThinFloor,
        Code::NarrowGap,
        Code::LowGap,
    ] {
        assert!(of_code(&lens, code).is_empty(), "{code:?}");
    }
}

#[test]
fn a_brush_of_many_bristles_is_listed_in_part() {
    let bristle = |i: u32| {
        let (x, y) = (0.4 * (i % 60) as f32, 0.4 * (i / 60) as f32);
        block([x, y, 1.0], [x + 0.2, y + 0.2, 2.0])
    };
    let base = block([0.0, 0.0, 0.0], [24.0, 24.0, 1.0]);
    let found = check(&joined((0..3600).map(bristle).chain([base])), &strict());
    assert_eq!(of_code(&found, Code::ThinWall).len(), 100);
    let count = found.counts.iter().find(|it| it.code == Code::ThinWall);
    assert_eq!(count.map(|it| it.found), Some(3600));
}

#[test]
fn severities_decide_the_verdict() {
    let pot = joined([slab(0.0, 1.0), walls(1.0, 5.0)]);
    let with = |severity| {
        let mut limits = strict();
        limits.severity.cup = severity;
        check(&pot, &limits).verdict
    };
    assert_eq!(with(Severity::Ignore), Verdict::Ok);
    assert_eq!(with(Severity::Review), Verdict::Review);
    assert_eq!(with(Severity::Reject), Verdict::Reject);
    let large = Limits {
        cup_mm2: 65.0,
        ..strict()
    };
    assert_eq!(check(&pot, &large).verdict, Verdict::Ok);
}

#[test]
fn a_severity_follows_the_size() {
    let severity = |triangles: &Triangles, code, limits: &Limits| {
        let found = check(triangles, limits);
        let [finding] = of_code(&found, code)[..] else {
            panic!("{:#?}", found.findings);
        };
        (finding.severity, found.verdict)
    };
    let loose = |side: f32| {
        joined([
            slab(0.0, 1.0),
            block([0.0, 0.0, 2.0], [side, side, 2.0 + side]),
        ])
    };
    // An arm that a roof joins to the rest.
    let island = |side: f32| {
        joined([
            slab(0.0, 1.0),
            walls(1.0, 7.0),
            block([4.0, 4.0, 7.0 - side], [4.0 + side, 4.0 + side, 7.0]),
            slab(7.0, 8.0),
        ])
    };
    let cases = [
        (0.5, Severity::Note, Verdict::Ok),
        (1.5, Severity::Review, Verdict::Review),
        (2.5, Severity::Reject, Verdict::Reject),
    ];
    for (side, expected, verdict) in cases {
        let found = severity(&loose(side), Code::LooseBody, &strict());
        assert_eq!(found, (expected, verdict), "{side}");
        let found = severity(&island(side), Code::Island, &strict());
        assert_eq!(found.0, expected, "{side}");
    }
    // A shop may judge a kind less severely.
    let mut lenient = strict();
    lenient.severity.loose_body = Severity::Review;
    let found = severity(&loose(2.5), Code::LooseBody, &lenient);
    assert_eq!(found, (Severity::Review, Verdict::Review));
    // 27 and 64 mm³ of enclosed resin.
    let bubble = |side: f32| {
        let [low, high] = [1.0, 1.0 + side].map(|it| [it; 3]);
        let mut around = block([0.0; 3], [side + 2.0; 3]);
        around.extend(block(low, high).into_iter().map(|[a, b, c]| [a, c, b]));
        around
    };
    for (side, expected) in [(3.0, Severity::Note), (4.0, Severity::Reject)] {
        assert_eq!(severity(&bubble(side), Code::Trap, &strict()).0, expected);
    }
    // Floors and fins of 0.16 and of 0.64 mm², 0.2 mm thick.
    let flake = |side: f32| block([0.0; 3], [side, side, 0.2]);
    let fin = |side: f32| {
        joined([
            slab(0.0, 1.0),
            block([4.0, 4.0, 1.0], [4.2, 4.0 + side, 1.0 + side]),
        ])
    };
    for (side, expected) in [(0.4, Severity::Note), (0.8, Severity::Review)] {
        assert_eq!(
            severity(&flake(side), Code::ThinFloor, &Limits::default()).0,
            expected
        );
        assert_eq!(
            severity(&fin(side), Code::ThinWall, &Limits::default()).0,
            expected
        );
    }
}
