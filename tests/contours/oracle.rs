//! Invariants of valid polygons, checked pair by pair in whole numbers.

use cusp_slicer::contour::Polygon;

type Point = [i32; 2];

/// Place of a point relative to a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    In,
    On,
    Out,
}

/// Direction in which a → b → c turns: left (1), right (-1) or not (0).
fn turn(a: Point, b: Point, c: Point) -> i128 {
    let [ax, ay, bx, by, cx, cy] = [a[0], a[1], b[0], b[1], c[0], c[1]].map(i128::from);
    ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).signum()
}

fn is_between(p: Point, [a, b]: [Point; 2]) -> bool {
    turn(a, b, p) == 0 && (0..2).all(|i| (a[i].min(b[i])..=a[i].max(b[i])).contains(&p[i]))
}

/// Returns true if two segments cross in their insides, or have more than a point in common.
fn cross_or_overlap(one: [Point; 2], other: [Point; 2]) -> bool {
    let ([a, b], [c, d]) = (one, other);
    let [abc, abd, cda, cdb] = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
    if abc == 0 && abd == 0 {
        let mut common: Vec<Point> = [a, b]
            .into_iter()
            .filter(|&end| is_between(end, other))
            .collect();
        common.extend([c, d].into_iter().filter(|&end| is_between(end, one)));
        common.sort_unstable();
        common.dedup();
        return common.len() > 1;
    }
    abc * abd < 0 && cda * cdb < 0
}

/// The place of a point, in half steps, with regard to a ring.
pub fn place(ring: &[Point], half_steps: [i64; 2]) -> Place {
    let mut winding = 0;
    for (i, a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(|x| 2 * i128::from(x));
        let [px, py] = half_steps.map(i128::from);
        let side = (bx - ax) * (py - ay) - (by - ay) * (px - ax);
        let is_beside =
            (ax.min(bx)..=ax.max(bx)).contains(&px) && (ay.min(by)..=ay.max(by)).contains(&py);
        if side == 0 && is_beside {
            return Place::On;
        }
        if ay <= py && py < by && side > 0 {
            winding += 1;
        }
        if by <= py && py < ay && side < 0 {
            winding -= 1;
        }
    }
    if winding == 0 { Place::Out } else { Place::In }
}

/// Place of a ring relative to another that it neither crosses nor overlaps.
fn place_of_ring(ring: &[Point], within: &[Point]) -> Place {
    let middles = ring.iter().enumerate().map(|(i, a)| {
        let b = ring[(i + 1) % ring.len()];
        [0, 1].map(|axis| i64::from(a[axis]) + i64::from(b[axis]))
    });
    let mut places = middles.map(|middle| place(within, middle));
    places
        .find(|&place| place != Place::On)
        .unwrap_or(Place::On)
}

/// Asserts that rings are simple and oriented, that none of them crosses another or has an edge in common with it, and
/// that holes are inside their outer rings, apart from each other, with no other polygon over the solid.
#[track_caller]
pub fn assert_valid(polygons: &[Polygon]) {
    let rings: Vec<&[Point]> = polygons
        .iter()
        .flat_map(Polygon::rings)
        .map(|ring| &*ring.points)
        .collect();
    let segments: Vec<[Point; 2]> = rings
        .iter()
        .flat_map(|ring| {
            ring.iter()
                .enumerate()
                .map(|(i, &a)| [a, ring[(i + 1) % ring.len()]])
        })
        .collect();
    for (i, &one) in segments.iter().enumerate() {
        assert_ne!(one[0], one[1], "a point twice");
        for &other in &segments[i + 1..] {
            assert!(!cross_or_overlap(one, other), "{one:?} and {other:?}");
        }
    }
    for polygon in polygons {
        assert!(polygon.outer.area() > 0.0, "an outer ring is clockwise");
        assert!(
            polygon.rings().all(|ring| ring.points.len() > 2),
            "a ring of two points"
        );
        for (i, hole) in polygon.holes.iter().enumerate() {
            assert!(hole.area() < 0.0, "a hole is counter-clockwise");
            assert_eq!(
                place_of_ring(&hole.points, &polygon.outer.points),
                Place::In,
                "a hole is outside"
            );
            for other in &polygon.holes[..i] {
                assert_eq!(
                    place_of_ring(&hole.points, &other.points),
                    Place::Out,
                    "a hole in a hole"
                );
                assert_eq!(
                    place_of_ring(&other.points, &hole.points),
                    Place::Out,
                    "a hole in a hole"
                );
            }
        }
        for other in polygons.iter().filter(|other| *other != polygon) {
            let outer = &other.outer.points;
            let is_in = |ring: &[Point]| place_of_ring(outer, ring) == Place::In;
            let in_hole = polygon.holes.iter().any(|hole| is_in(&hole.points));
            assert!(
                !is_in(&polygon.outer.points) || in_hole,
                "a polygon on another"
            );
        }
    }
}

/// Returns true if polygons contain a point, in half steps; `None` on an outline.
pub fn contains(polygons: &[Polygon], half_steps: [i64; 2]) -> Option<bool> {
    let places = polygons
        .iter()
        .flat_map(Polygon::rings)
        .map(|ring| place(&ring.points, half_steps));
    let places: Vec<Place> = places.collect();
    (!places.contains(&Place::On))
        .then(|| places.iter().filter(|&&place| place == Place::In).count() % 2 == 1)
}

/// The distance of a point from a segment, which may be a point.
pub fn distance(point: [f64; 2], [a, b]: [Point; 2]) -> f64 {
    let [a, b] = [a, b].map(|end| end.map(f64::from));
    let [along, to] = [b, point].map(|end| [end[0] - a[0], end[1] - a[1]]);
    let squared = along[0] * along[0] + along[1] * along[1];
    let share = match (along[0] * to[0] + along[1] * to[1]) / squared {
        share if share.is_nan() => 0.0,
        share => share.clamp(0.0, 1.0),
    };
    (to[0] - share * along[0]).hypot(to[1] - share * along[1])
}

/// The segments of all rings.
pub fn segments(polygons: &[Polygon]) -> Vec<[Point; 2]> {
    let rings = polygons.iter().flat_map(Polygon::rings);
    rings
        .flat_map(|ring| {
            let next = ring.points.iter().cycle().skip(1);
            ring.points.iter().zip(next).map(|(&a, &b)| [a, b])
        })
        .collect()
}

mod tests {
    use super::*;
    use cusp_slicer::contour::Ring;

    fn ring(points: &[Point]) -> Ring {
        Ring {
            points: points.to_vec(),
        }
    }

    fn is_valid(outer: &[Point], holes: &[&[Point]]) -> bool {
        let polygon = Polygon {
            outer: ring(outer),
            holes: holes.iter().map(|hole| ring(hole)).collect(),
        };
        std::panic::catch_unwind(|| assert_valid(&[polygon])).is_ok()
    }

    #[test]
    fn the_oracle_sees_what_is_wrong() {
        let square = [[0, 0], [8, 0], [8, 8], [0, 8]];
        let hole: &[Point] = &[[2, 2], [2, 4], [4, 4], [4, 2]];
        assert!(is_valid(&square, &[hole]));
        let mut clockwise = square;
        clockwise.reverse();
        assert!(!is_valid(&clockwise, &[]));
        assert!(
            !is_valid(&[[0, 0], [8, 8], [8, 0], [0, 8]], &[]),
            "a bow tie"
        );
        assert!(
            !is_valid(&square, &[&[[2, 2], [4, 2], [4, 4], [2, 4]]]),
            "a hole turned over"
        );
        assert!(
            !is_valid(&square, &[&[[12, 2], [12, 4], [14, 4], [14, 2]]]),
            "a hole outside"
        );
        assert!(
            !is_valid(&square, &[&[[0, 2], [0, 4], [4, 4], [4, 2]]]),
            "a common edge"
        );
        assert!(
            !is_valid(&square, &[hole, &[[2, 2], [3, 3], [3, 2]]]),
            "a hole in a hole"
        );
        assert!(!is_valid(&[[0, 0], [8, 0], [8, 8], [8, 0]], &[]), "a spike");
    }
}
