//! Hollows whose ways out are known, in layers and on pixels of 0.05 mm.

use cusp_slicer::inspect::{Code, Limits, Severity};

use super::forms::{assert_codes, joined, slab, walls, walls_with_door};
use super::solids::Triangles;
use super::{block, check, of_code, strict};

/// A box of 10 mm that is hollow, with a hole of this width through its wall at mid-height, and open nowhere else.
fn bottle(hole_mm: f32) -> Triangles {
    let edge = 5.0 + hole_mm;
    let mut hole = block([9.0, 5.0, 1.0], [10.0, edge, 3.0]);
    hole.extend(block([9.0, 5.0, 3.0 + hole_mm], [10.0, edge, 7.0]));
    joined([
        slab(0.0, 1.0),
        block([0.0, 0.0, 1.0], [10.0, 1.0, 7.0]),
        block([0.0, 9.0, 1.0], [10.0, 10.0, 7.0]),
        block([0.0, 1.0, 1.0], [1.0, 9.0, 7.0]),
        block([9.0, 1.0, 1.0], [10.0, 5.0, 7.0]),
        block([9.0, edge, 1.0], [10.0, 9.0, 7.0]),
        hole,
        slab(7.0, 8.0),
    ])
}

#[test]
fn a_hollow_with_a_narrow_hole_hardly_drains() {
    let found = check(&bottle(1.5), &strict());
    assert_codes(&found, &[Code::Cup, Code::NarrowDrain]);
    let drain = of_code(&found, Code::NarrowDrain)[0];
    assert_eq!(drain.layers, [20, 139]);
    // Room for the middle of a disc of 1.95 mm: all but 0.95 mm at each wall, and a little more near the hole.
    let room_mm3 = 6.1 * 6.1 * 6.0;
    assert!((room_mm3..room_mm3 + 0.5).contains(&drain.volume_mm3));
    let narrower = Limits {
        drain_mm: 1.5,
        ..strict()
    };
    assert_codes(&check(&bottle(1.5), &narrower), &[Code::Cup]);
    assert_codes(&check(&bottle(2.0), &strict()), &[Code::Cup]);
    // Without a hole it is a trap, and nothing else.
    let codes = [Code::Trap];
    assert_codes(&check(&bottle(0.0), &strict()), &codes);
}

#[test]
fn what_is_open_to_the_plate_or_above_drains() {
    let vented = [walls_with_door(0.0, 0.2), walls(0.2, 5.0), slab(5.0, 6.0)];
    let wide = Limits {
        drain_mm: 3.0,
        ..strict()
    };
    assert_codes(&check(&joined(vented), &wide), &[]);
    let pot = joined([slab(0.0, 1.0), walls(1.0, 5.0)]);
    assert_codes(&check(&pot, &wide), &[Code::Cup]);
}

#[test]
fn limits_may_name_drains_as_they_did_at_first() {
    let text = r#"{"escape_mm": 3.0, "severity": {"small-escape": "note"}}"#;
    let limits: Limits = serde_json::from_str(text).unwrap();
    assert_eq!(limits.drain_mm, 3.0);
    assert_eq!(limits.severity.narrow_drain, Severity::Note);
}
