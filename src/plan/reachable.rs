//! The planes that plans of few layers can have, without a look at every plane.

use std::ops::RangeInclusive;

use super::segment::Segment;

/// For each number of layers, from 0 up to the least that may fill a segment, the planes at which that many may end and fewer may not:
/// those that the layers below may reach, and from which the layers above may reach the top. `is_within` tells whether the layer between two planes is
/// within tolerance; if one is, every layer within it is too.
///
/// No plan has fewer layers. One that has as many has only these planes; there need not be one. `None` if it is certain that none
/// reaches the top.
pub(super) fn by_layers(
    segment: &Segment,
    is_within: &dyn Fn(u32, u32) -> bool,
) -> Option<Vec<RangeInclusive<u32>>> {
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let (mut plane, mut highest) = (0, vec![0]);
    while plane < segment.units {
        let most = segment.units.min(plane + greatest);
        let end = first_of(plane + least..=most, &|top| !is_within(plane, top));
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
            first_of(lowest..=most, &|below| is_within(below, plane))
        });
    }
    planes.reverse();
    Some(planes)
}

/// The first number of a range that is so, if all after it are, or the one after the range.
fn first_of(range: RangeInclusive<u32>, is_so: &dyn Fn(u32) -> bool) -> u32 {
    let (mut from, mut to) = (*range.start(), *range.end() + 1);
    while from < to {
        let middle = u32::midpoint(from, to);
        if is_so(middle) {
            to = middle;
        } else {
            from = middle + 1;
        }
    }
    from
}
