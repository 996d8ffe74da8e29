//! Extent of a set of points along any axis, without visiting every point.

use std::ops::Range;

use glam::DVec3;

/// Points that have a box in common.
const BLOCK: usize = 64;

/// Points, of which those that follow one another are close together.
#[derive(Debug)]
pub(super) struct Points {
    /// In millimetres, one list per axis.
    coordinates: [Vec<f64>; 3],
    /// The centres of the boxes around blocks of points, one list per axis.
    centres_mm: [Vec<f64>; 3],
    /// Half the sizes of these boxes, one list per axis.
    halves_mm: [Vec<f64>; 3],
    /// Bound of the rounding of places along an axis.
    slack_mm: f64,
}

impl Points {
    /// Points from their coordinates, one list per axis.
    pub fn new(points: [Vec<f64>; 3]) -> Self {
        let mut centres_mm: [Vec<f64>; 3] = Default::default();
        let mut halves_mm: [Vec<f64>; 3] = Default::default();
        let mut farthest_mm = 0.0f64;
        for (axis, places_mm) in points.iter().enumerate() {
            for [low, high] in places_mm.chunks(BLOCK).map(range) {
                centres_mm[axis].push(f64::midpoint(low, high));
                halves_mm[axis].push((high - low) / 2.0);
                farthest_mm = farthest_mm.max(high.abs()).max(low.abs());
            }
        }
        Self {
            coordinates: points,
            centres_mm,
            halves_mm,
            slack_mm: farthest_mm * 1e-12,
        }
    }

    /// The number of points.
    pub fn count(&self) -> usize {
        self.coordinates[0].len()
    }

    /// The coordinates along an axis of some of the points.
    pub fn along(&self, axis: DVec3, points: Range<usize>) -> impl Iterator<Item = f64> {
        sums(&self.coordinates, axis, points)
    }

    /// The least and the greatest coordinate along an axis, which is a unit vector.
    pub fn extent_along(&self, axis: DVec3) -> [f64; 2] {
        let blocks = self.centres_mm[0].len();
        let centres = sums(&self.centres_mm, axis, 0..blocks);
        let reaches = sums(&self.halves_mm, axis.abs(), 0..blocks);
        // Interval along the axis that contains each block.
        let boxes: Vec<[f64; 2]> = centres
            .zip(reaches.map(|reach| reach + self.slack_mm))
            .map(|(centre, reach)| [centre - reach, centre + reach])
            .collect();
        let mut places = Vec::with_capacity(BLOCK);
        let mut extent_of = |block: usize| {
            let first = block * BLOCK;
            places.clear();
            places.extend(self.along(axis, first..self.count().min(first + BLOCK)));
            range(&places)
        };
        let [mut lowest, mut highest] = [0, 0];
        for (block, &[low, high]) in boxes.iter().enumerate() {
            if low < boxes[lowest][0] {
                lowest = block;
            }
            if high > boxes[highest][1] {
                highest = block;
            }
        }
        let mut found = wider(extent_of(lowest), extent_of(highest));
        for (block, &[low, high]) in boxes.iter().enumerate() {
            if low < found[0] || high > found[1] {
                found = wider(found, extent_of(block));
            }
        }
        found
    }
}

/// The products of some vectors, in one list per axis, with another one.
fn sums(lists: &[Vec<f64>; 3], with: DVec3, some: Range<usize>) -> impl Iterator<Item = f64> {
    let [x, y, z] = lists.each_ref().map(|list| &list[some.clone()]);
    let vectors = x.iter().zip(y).zip(z);
    vectors.map(move |((x, y), z)| with.x * x + with.y * y + with.z * z)
}

/// The range that contains two ranges.
fn wider(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}

/// The minimum and maximum of some numbers.
fn range(numbers: &[f64]) -> [f64; 2] {
    // By hand, because `min` and `max` are library calls in wasm; in lanes, because each comparison in a single chain would
    // wait for the one before.
    let mut least = [f64::INFINITY; 4];
    let mut greatest = [f64::NEG_INFINITY; 4];
    let lanes = numbers.chunks_exact(4);
    let rest = lanes.remainder();
    for lane in lanes.chain(std::iter::once(rest)) {
        for (i, &number) in lane.iter().enumerate() {
            if number < least[i] {
                least[i] = number;
            }
            if number > greatest[i] {
                greatest[i] = number;
            }
        }
    }
    let all = least.into_iter().zip(greatest);
    let (least, greatest) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |all, one| {
        (all.0.min(one.0), all.1.max(one.1))
    });
    [least, greatest]
}
