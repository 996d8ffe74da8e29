//! Leaves out points of contours, within a tolerance.
//!
//! Each ring is simplified by itself (Ramer, Douglas, Peucker): a chain of points is replaced by a segment from its
//! first to its last point if none is farther than the tolerance from it. Then the whole chain is near the segment, as
//! the points near a segment are a convex set; and the segment is near the chain, as the chain projects onto all of it.
//! So the bound holds in both directions.
//!
//! Rings could now touch, cross or change sides. Segments that touch others get their chains back, and rings whose
//! sides others would change are restored, until nothing is wrong: at the latest when every point is back.

use super::{Polygon, Ring};

type Point = [i32; 2];

/// Simplifies the polygons of a section. No point of the result is farther than `tolerance`, in steps, from the outline before, and none of
/// the outline before is farther than that from the result. Rings stay simple, and inside the same rings as before.
pub(super) fn simplify(polygons: Vec<Polygon>, tolerance: f64) -> Vec<Polygon> {
    // 0, or none at all.
    if !matches!(
        tolerance.partial_cmp(&0.0),
        Some(std::cmp::Ordering::Greater)
    ) {
        return polygons;
    }
    let rings: Vec<&[Point]> = polygons
        .iter()
        .flat_map(Polygon::rings)
        .map(|ring| &*ring.points)
        .collect();
    // Less by more than rounding.
    let within = tolerance * (1.0 - 1e-9);
    let mut outlines: Vec<Outline> = rings
        .into_iter()
        .map(|ring| Outline::simplified(ring, within))
        .collect();
    if outlines.iter().any(Outline::is_simplified) {
        while restore_touching(&mut outlines) || restore_changed(&mut outlines) {}
    }
    let mut rings = outlines.iter().map(Outline::ring);
    let mut next = || rings.next().unwrap_or_default();
    let counts: Vec<usize> = polygons.iter().map(|polygon| polygon.holes.len()).collect();
    counts
        .into_iter()
        .map(|holes| Polygon {
            outer: next(),
            holes: (0..holes).map(|_| next()).collect(),
        })
        .collect()
}

/// A ring, and which of its points are kept.
struct Outline<'a> {
    ring: &'a [Point],
    /// Indices of the points that are kept, argsort.
    kept: Vec<usize>,
}

impl<'a> Outline<'a> {
    fn simplified(ring: &'a [Point], tolerance: f64) -> Self {
        let mut is_kept = vec![false; ring.len()];
        // A point of the convex hull, and the farthest from it, are worth keeping.
        let first = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or_default();
        let distance = |i: usize| length_squared(ring[first], ring[i]);
        let last = (0..ring.len())
            .max_by(|&i, &j| distance(i).total_cmp(&distance(j)))
            .unwrap_or_default();
        let count = ring.len();
        let mut chains = vec![(first, last), (last, first)];
        while let Some((from, to)) = chains.pop() {
            is_kept[from] = true;
            let inner = (to + count - from) % count;
            let inner = (1..inner).map(|step| (from + step) % count);
            let from_chord = |i: usize| distance_squared(ring[i], ring[from], ring[to]);
            let farthest = inner
                .map(|i| (from_chord(i), i))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((squared, i)) = farthest
                && squared > tolerance * tolerance
            {
                chains.extend([(from, i), (i, to)]);
            }
        }
        let kept = (0..count).filter(|&i| is_kept[i]).collect();
        Self { ring, kept }
    }

    fn is_simplified(&self) -> bool {
        self.kept.len() < self.ring.len()
    }

    fn restore(&mut self) {
        self.kept = (0..self.ring.len()).collect();
    }

    /// Keeps all points of these chains, each named by the place of its first point among those kept.
    fn restore_chains(&mut self, mut starts: Vec<usize>) {
        starts.sort_unstable();
        starts.dedup();
        let (count, kept) = (self.ring.len(), self.kept.len());
        for chain in starts {
            let (from, to) = (self.kept[chain], self.kept[(chain + 1) % kept]);
            let between = 1..(to + count - from - 1) % count + 1;
            self.kept.extend(between.map(|step| (from + step) % count));
        }
        self.kept.sort_unstable();
    }

    fn ring(&self) -> Ring {
        Ring {
            points: self.kept.iter().map(|&i| self.ring[i]).collect(),
        }
    }
}

/// A segment of a simplified ring.
#[derive(Clone, Copy)]
struct Segment {
    ends: [Point; 2],
    outline: usize,
    /// Its place among the segments of the ring, and their number.
    place: usize,
    count: usize,
    /// True if it replaces several segments.
    is_chord: bool,
}

impl Segment {
    fn range(&self, axis: usize) -> [i32; 2] {
        let [a, b] = self.ends.map(|end| end[axis]);
        [a.min(b), a.max(b)]
    }

    /// Returns true if it touches another one where it should not.
    fn touches(&self, other: &Self) -> bool {
        if self.outline == other.outline {
            if (self.place + 1) % self.count == other.place && folds_back(self, other) {
                return true;
            }
            if (other.place + 1) % self.count == self.place && folds_back(other, self) {
                return true;
            }
            let apart = (self.place + self.count - other.place) % self.count;
            if apart == 1 || apart == self.count - 1 {
                return false;
            }
        }
        let ([a, b], [c, d]) = (self.ends, other.ends);
        let sides = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
        if sides.contains(&0) {
            let on = |p: Point, [q, r]: [Point; 2], side: i128| {
                side == 0
                    && (0..2).all(|axis| {
                        (q[axis].min(r[axis])..=q[axis].max(r[axis])).contains(&p[axis])
                    })
            };
            return on(c, self.ends, sides[0])
                || on(d, self.ends, sides[1])
                || on(a, other.ends, sides[2])
                || on(b, other.ends, sides[3]);
        }
        (sides[0] > 0) != (sides[1] > 0) && (sides[2] > 0) != (sides[3] > 0)
    }
}

/// Returns true if a segment lies on the one before it.
fn folds_back(before: &Segment, after: &Segment) -> bool {
    let ([p, q], [_, r]) = (before.ends, after.ends);
    let along = |axis: usize| {
        (i128::from(p[axis]) - i128::from(q[axis])) * (i128::from(r[axis]) - i128::from(q[axis]))
    };
    turn(p, q, r) == 0 && along(0) + along(1) > 0
}

/// Restores chains whose segments touch others. Returns true if there were any.
fn restore_touching(outlines: &mut [Outline<'_>]) -> bool {
    let mut segments: Vec<Segment> = outlines
        .iter()
        .enumerate()
        .flat_map(|(number, outline)| segments(number, outline))
        .collect();
    segments.sort_unstable_by_key(|segment| segment.range(0)[0]);
    let mut touching = vec![Vec::new(); outlines.len()];
    for (place, one) in segments.iter().enumerate() {
        let [[_, right], [low, high]] = [one.range(0), one.range(1)];
        for other in segments[place + 1..]
            .iter()
            .take_while(|other| other.range(0)[0] <= right)
        {
            let [other_low, other_high] = other.range(1);
            let is_near = other_low <= high && low <= other_high;
            if is_near && (one.is_chord || other.is_chord) && one.touches(other) {
                for segment in [one, other].into_iter().filter(|segment| segment.is_chord) {
                    touching[segment.outline].push(segment.place);
                }
            }
        }
    }
    let is_any = touching.iter().any(|starts| !starts.is_empty());
    for (outline, starts) in outlines.iter_mut().zip(touching) {
        outline.restore_chains(starts);
    }
    is_any
}

fn segments<'a>(number: usize, outline: &'a Outline<'_>) -> impl Iterator<Item = Segment> + 'a {
    let count = outline.kept.len();
    (0..count).map(move |place| {
        let (from, to) = (outline.kept[place], outline.kept[(place + 1) % count]);
        Segment {
            ends: [outline.ring[from], outline.ring[to]],
            outline: number,
            place,
            count,
            is_chord: (from + 1) % outline.ring.len() != to,
        }
    })
}

/// Restores rings that are turned over, or have another side towards another ring. Returns true if there were any.
fn restore_changed(outlines: &mut [Outline<'_>]) -> bool {
    let seats: Vec<Point> = outlines
        .iter()
        .map(|outline| outline.ring[outline.kept[0]])
        .collect();
    let mut is_any = false;
    for (number, outline) in outlines.iter_mut().enumerate() {
        if !outline.is_simplified() {
            continue;
        }
        let (before, after) = (outline.ring, outline.ring().points);
        let [least, most] =
            before
                .iter()
                .fold([[i32::MAX; 2], [i32::MIN; 2]], |[least, most], point| {
                    [
                        [least[0].min(point[0]), least[1].min(point[1])],
                        [most[0].max(point[0]), most[1].max(point[1])],
                    ]
                });
        let is_within =
            |seat: &Point| (0..2).all(|axis| (least[axis]..=most[axis]).contains(&seat[axis]));
        let is_changed = |seat: Point| {
            let side = side(before, seat);
            side == Side::On || side != self::side(&after, seat)
        };
        let others = seats
            .iter()
            .enumerate()
            .filter(|&(other, seat)| other != number && is_within(seat));
        let is_turned = twice_area(before).signum() != twice_area(&after).signum();
        if is_turned || others.into_iter().any(|(_, &seat)| is_changed(seat)) {
            outline.restore();
            is_any = true;
        }
    }
    is_any
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    In,
    On,
    Out,
}

/// Side of a ring on which a point lies.
fn side(ring: &[Point], point: Point) -> Side {
    let mut is_in = false;
    for (place, &a) in ring.iter().enumerate() {
        let b = ring[(place + 1) % ring.len()];
        let turn = turn(a, b, point);
        let is_beside =
            |axis: usize| (a[axis].min(b[axis])..=a[axis].max(b[axis])).contains(&point[axis]);
        if turn == 0 && is_beside(0) && is_beside(1) {
            return Side::On;
        }
        if (a[1] > point[1]) != (b[1] > point[1]) && (turn > 0) == (b[1] > a[1]) {
            is_in = !is_in;
        }
    }
    if is_in { Side::In } else { Side::Out }
}

/// Twice the area of the triangle a b c, positive if it is counter-clockwise.
fn turn(a: Point, b: Point, c: Point) -> i128 {
    let [ab, ac] = [b, c].map(|end| [0, 1].map(|axis| i128::from(end[axis]) - i128::from(a[axis])));
    ab[0] * ac[1] - ab[1] * ac[0]
}

/// Twice the area of a ring, positive if it is counter-clockwise.
pub(super) fn twice_area(ring: &[Point]) -> i128 {
    let next = ring.iter().cycle().skip(1);
    let cross = |(a, b): (&Point, &Point)| {
        i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
    };
    ring.iter().zip(next).map(cross).sum()
}

fn length_squared(a: Point, b: Point) -> f64 {
    let [x, y] = [0, 1].map(|axis| f64::from(b[axis]) - f64::from(a[axis]));
    x * x + y * y
}

/// The squared distance of a point from the segment a b.
fn distance_squared(point: Point, a: Point, b: Point) -> f64 {
    let [along, to] =
        [b, point].map(|end| [0, 1].map(|axis| f64::from(end[axis]) - f64::from(a[axis])));
    let squared = along[0] * along[0] + along[1] * along[1];
    let dot = along[0] * to[0] + along[1] * to[1];
    if dot <= 0.0 {
        length_squared(a, point)
    } else if dot >= squared {
        length_squared(b, point)
    } else {
        let cross = along[0] * to[1] - along[1] * to[0];
        cross * cross / squared
    }
}
