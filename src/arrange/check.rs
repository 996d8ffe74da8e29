//! Checks that copies stay on their plate and apart from each other.

use super::outline::Outline;
use super::sheet::bits_at;
use super::{ArrangeError, Screen};
use crate::argsort::sort_by_number;

/// A copy to be checked. Its outline is in cells of one pixel: see [`Screen::by_pixels`].
#[derive(Debug, Clone, Copy)]
pub struct PlacedOutline<'a> {
    /// The model, by its index.
    pub item: usize,
    /// The copy of that model, by its index.
    pub copy: usize,
    /// Its shadow at the middle of the plate.
    pub outline: &'a Outline,
    /// Columns to the right and rows downward from there.
    pub offset: [i32; 2],
}

impl PlacedOutline<'_> {
    /// First column and row of the pixels that are covered, and those after the last.
    fn pixels(&self) -> [[i64; 2]; 2] {
        let end = |end: [i64; 2]| [0, 1].map(|axis| end[axis] + i64::from(self.offset[axis]));
        self.outline.pixels.map(end)
    }

    fn overlaps(&self, other: &Self) -> bool {
        let ([first, last], [start, end]) = (self.pixels(), other.pixels());
        let apart = |axis: usize| last[axis] <= start[axis] || end[axis] <= first[axis];
        if apart(0) || apart(1) {
            return false;
        }
        let corner = |standing: &Self| {
            let offset = standing.offset.map(i64::from);
            [0, 1].map(|axis| standing.outline.first[axis] + offset[axis])
        };
        let (a, b) = (corner(self), corner(other));
        let (cells, others) = (&self.outline.cells, &other.outline.cells);
        (0..cells.rows as i64).any(|row| {
            let Ok(within) = usize::try_from(row + a[1] - b[1]) else {
                return false;
            };
            if within >= others.rows {
                return false;
            }
            let taken = others.row(within);
            let words = cells.row(row as usize).iter().zip(0i64..);
            let mut words = words.filter(|(word, _)| **word != 0);
            words.any(|(&word, place)| word & bits_at(taken, a[0] - b[0] + place * 64) != 0)
        })
    }
}

/// Problems of the copies on one plate: those that extend beyond it, then those that overlap. Each copy that overlaps
/// another is named at least once, and there are no more overlaps than copies.
///
/// Cost: the pairs of copies that share columns of pixels, and the pixels of those whose boxes overlap.
pub fn problems(screen: &Screen, plate: usize, copies: &[PlacedOutline<'_>]) -> Vec<ArrangeError> {
    let plate_number = plate + 1;
    let outside = copies.iter().filter(|copy| !copy.is_on(screen));
    let mut problems: Vec<_> = outside
        .map(|copy| ArrangeError::Outside {
            model_number: copy.item + 1,
            copy_number: copy.copy + 1,
            plate_number,
        })
        .collect();
    let mut by_left: Vec<&PlacedOutline<'_>> = copies.iter().collect();
    sort_by_number(&mut by_left, |copy| copy.pixels()[0][0] as f64);
    let mut named = vec![false; by_left.len()];
    for (place, copy) in by_left.iter().enumerate() {
        let right = copy.pixels()[1][0];
        for other in place + 1..by_left.len() {
            let beside = by_left[other];
            if beside.pixels()[0][0] >= right {
                break;
            }
            if (named[place] && named[other]) || !copy.overlaps(beside) {
                continue;
            }
            [named[place], named[other]] = [true; 2];
            let mut both = [copy, &beside].map(|it| [it.item + 1, it.copy + 1]);
            both.sort_unstable();
            problems.push(ArrangeError::Collision {
                model_numbers: both.map(|[model, _]| model),
                copy_numbers: both.map(|[_, copy]| copy),
                plate_number,
            });
        }
    }
    problems
}

impl PlacedOutline<'_> {
    fn is_on(&self, screen: &Screen) -> bool {
        let [first, last] = self.pixels();
        // A model that just fits may touch the pixel beyond, by rounding; it lights none there.
        let alone = self.offset == [0; 2];
        let slack = i64::from(alone);
        (0..2).all(|axis| {
            first[axis] >= -slack && last[axis] <= i64::from(screen.pixels[axis]) + slack
        })
    }
}
