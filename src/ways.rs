//! Shortest ways between the cells of a raster.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Steps to the eight cells around one: across its sides, then across its corners.
pub const AROUND: [[isize; 2]; 8] = [
    [1, 0],
    [0, 1],
    [-1, 0],
    [0, -1],
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
];

/// Steps two cells on and one aside, with the two steps of [`AROUND`], by index, to the cells between. Ways along these and
/// [`AROUND`] are at most 2.8 % longer than straight ones.
pub const KNIGHTS: [([isize; 2], [usize; 2]); 8] = [
    ([2, 1], [0, 4]),
    ([1, 2], [1, 4]),
    ([-1, 2], [1, 5]),
    ([-2, 1], [2, 5]),
    ([-2, -1], [2, 6]),
    ([-1, -2], [3, 6]),
    ([1, -2], [3, 7]),
    ([2, -1], [0, 7]),
];

/// Length of a step of [`AROUND`].
pub fn length([dx, dy]: [isize; 2]) -> f32 {
    if dx != 0 && dy != 0 {
        std::f32::consts::SQRT_2
    } else {
        1.0
    }
}

/// The cell at a step from another, counted row by row; none beyond the raster.
#[inline]
pub fn beside(cell: usize, [dx, dy]: [isize; 2], [width, height]: [usize; 2]) -> Option<usize> {
    let column = (cell % width).checked_add_signed(dx)?;
    let row = (cell / width).checked_add_signed(dy)?;
    (column < width && row < height).then(|| row * width + column)
}

/// Takes a node, and calls back with every node that a way leads on to, and its length.
pub type Ways<'a> = dyn FnMut(usize, &mut dyn FnMut(usize, f32)) + 'a;

/// Spreads distances from nodes to all that ways lead to, up to `most` (Dijkstra).
pub fn spread(away: &mut [f32], most: f32, from: &[(f32, usize)], ways: &mut Ways<'_>) {
    // Bits of numbers that are not negative are in the order of the numbers.
    let mut next = BinaryHeap::new();
    for &(distance, node) in from {
        if distance <= away[node].min(most) {
            away[node] = distance;
            next.push(Reverse((distance.to_bits(), node)));
        }
    }
    while let Some(Reverse((bits, node))) = next.pop() {
        let here = f32::from_bits(bits);
        if here > away[node] {
            continue;
        }
        ways(node, &mut |there, length| {
            let total = here + length;
            if total <= most && total < away[there] {
                away[there] = total;
                next.push(Reverse((total.to_bits(), there)));
            }
        });
    }
}
