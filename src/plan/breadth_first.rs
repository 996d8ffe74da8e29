//! The fewest layers without snap planes, breadth-first by layers: only planes that a plan of the fewest layers can
//! have are examined.

use std::ops::RangeInclusive;

use super::queue::{Candidate, Queue};
use super::segment::Segment;
use crate::profile::ErrorSum;

/// The planes that the layers of a number may end at.
type Ends = RangeInclusive<u32>;

/// The maximum error up to a plane that no plan reaches: ∞.
const NO_PLAN: u64 = u64::MAX;

/// The planes of the plan of the fewest layers within tolerance, and among those of the smallest maximum error, in ascending order without
/// plane 0. It is the plan that [`fill_fewest`](super::optimal::fill_fewest) finds. `None` if it takes more layers than the heights that
/// they reach suggest.
pub(super) fn fewest(errors: &ErrorSum, segment: &Segment, tolerance: u64) -> Option<Vec<u32>> {
    let is_within = |lower, upper| {
        let [lower, upper] = [lower, upper].map(|plane| segment.boundary(plane));
        errors.steps_between(lower, upper) <= tolerance
    };
    let ends = ends_of_layers(segment, is_within)?;
    let count_of = |ends: &Ends| (ends.end() - ends.start()) as usize + 1;
    // For each plane of each number of layers but 0, the plane below in the best plan.
    let mut below = Vec::with_capacity(ends[1..].iter().map(count_of).sum());
    let widest = ends.iter().map(count_of).max().unwrap_or(1);
    let (mut worst, mut worst_on_top) = (Vec::with_capacity(widest), Vec::with_capacity(widest));
    worst.push(0);
    let mut queue = Queue::new();
    for pair in ends.windows(2) {
        let layer = Layer {
            errors,
            segment,
            starts: &pair[0],
            worst: &worst,
            tolerance,
        };
        worst_on_top.clear();
        queue.clear();
        queue = layer.extend(&pair[1], queue, |worst, start| {
            worst_on_top.push(worst);
            below.push(start);
        });
        std::mem::swap(&mut worst, &mut worst_on_top);
    }
    if worst.last() == Some(&NO_PLAN) {
        return None;
    }
    let mut planes = Vec::with_capacity(ends.len() - 1);
    let mut plane = segment.units;
    for ends in ends[1..].iter().rev() {
        planes.push(plane);
        let first = below.len() - count_of(ends);
        plane = below[first + (plane - ends.start()) as usize];
        below.truncate(first);
    }
    planes.reverse();
    Some(planes)
}

/// A layer, by its number.
struct Layer<'a> {
    errors: &'a ErrorSum,
    segment: &'a Segment,
    /// Planes at which it may begin.
    starts: &'a Ends,
    /// For each of these planes, the smallest maximum error of the layers below, in steps.
    worst: &'a [u64],
    /// In steps.
    tolerance: u64,
}

impl Layer<'_> {
    /// Tells, for each plane at which the layer may end, the smallest maximum error of the plans up to it, and where the layer begins in
    /// the best one. Takes an empty queue and returns it, not by reference, so that its places stay in registers. All its planes have
    /// as many layers below.
    fn extend(
        &self,
        ends: &Ends,
        mut queue: Queue<(), u64>,
        mut tell: impl FnMut(u64, u32),
    ) -> Queue<(), u64> {
        let (least, greatest) = (
            *self.segment.thickness.start(),
            *self.segment.thickness.end(),
        );
        let sum = |plane| self.errors.steps_below(self.segment.boundary(plane));
        let mut starts = self.starts.clone().zip(self.worst).peekable();
        for plane in ends.clone() {
            while let Some((start, &worst)) = starts.next_if(|&(start, _)| start + least <= plane) {
                if worst != NO_PLAN {
                    queue.push(Candidate {
                        plane: start,
                        cost: (),
                        worst,
                        mark: sum(start),
                    });
                }
            }
            let top = sum(plane);
            let error_from = |start: &Candidate<_, _>| top - start.mark;
            let is_passed = |start: &Candidate<_, _>| {
                plane - start.plane > greatest || error_from(start) > self.tolerance
            };
            match queue.best(is_passed, error_from) {
                Some(((), start, worst)) => tell(worst, start),
                None => tell(NO_PLAN, 0),
            }
        }
        queue
    }
}

/// For each number of layers, from 0 up to the least that may fill a segment, the planes at which that many may end and fewer may not:
/// those that the layers below may reach, and from which the layers above may reach the top. `is_within` returns true
/// if the layer between two planes is within tolerance; if one is, every layer within it is too.
///
/// No plan has fewer layers. One that has as many has only these planes; there need not be one. `None` if it is certain that none
/// reaches the top.
fn ends_of_layers(segment: &Segment, is_within: impl Fn(u32, u32) -> bool) -> Option<Vec<Ends>> {
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let (mut plane, mut highest) = (0, vec![0]);
    while plane < segment.units {
        let most = segment.units.min(plane + greatest);
        let end = first_of(plane + least..=most, |top| !is_within(plane, top));
        if most < plane + least {
            // A layer that begins lower may end at the top.
            plane = segment.units;
        } else if end == plane + least {
            return None;
        } else {
            plane = end - 1;
        }
        highest.push(plane);
    }
    let mut planes = Vec::with_capacity(highest.len());
    for layers in (0..highest.len()).rev() {
        let beyond_fewer = layers.checked_sub(1).map_or(0, |fewer| highest[fewer] + 1);
        planes.push(plane.max(beyond_fewer)..=highest[layers]);
        let lowest = plane.saturating_sub(greatest);
        plane = plane.checked_sub(least).map_or(0, |most| {
            first_of(lowest..=most, |below| is_within(below, plane))
        });
    }
    planes.reverse();
    Some(planes)
}

/// The first number of a range that is so, if all after it are, or the one after the range.
#[inline]
fn first_of(range: RangeInclusive<u32>, is_so: impl Fn(u32) -> bool) -> u32 {
    // It is one of `count` numbers from `first` on, or the one after them. Whatever is so, as many are left, and nothing has to be
    // predicted.
    let mut first = *range.start();
    let mut count = (*range.end() + 1).saturating_sub(first);
    while count > 0 {
        let half = count.div_ceil(2);
        first = if is_so(first + half - 1) {
            first
        } else {
            first + half
        };
        count -= half;
    }
    first
}
