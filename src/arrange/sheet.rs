//! A plate that is being filled.

use rustc_hash::FxHashMap;

use super::outline::Cells;
use super::{Screen, Shape};

/// A copy on a plate.
pub(super) struct Copy {
    pub item: usize,
    /// The place of its shape among those of the item.
    pub shape: usize,
    /// Cells to the right and downward from the middle of the plate.
    pub cells: [i64; 2],
}

/// A plate with the cells that are covered or kept free.
pub(super) struct Sheet {
    taken: Cells,
    pub copies: Vec<Copy>,
    /// Place from which the search continues for each item and shape: no place before it is free, as cells are only
    /// ever taken.
    next: FxHashMap<(usize, usize), Option<[i64; 2]>>,
}

impl Sheet {
    pub fn new([columns, rows]: [usize; 2]) -> Self {
        Self {
            taken: Cells::new(columns, rows),
            copies: Vec::new(),
            next: FxHashMap::default(),
        }
    }

    /// Places a copy in the shape that ends farthest back, and returns true if there was room. `ranges` are the places that
    /// each shape may have.
    pub fn place(
        &mut self,
        item: usize,
        shapes: &[Shape],
        ranges: &[Option<[[i64; 2]; 2]>],
    ) -> bool {
        let mut best: Option<([i64; 2], Copy)> = None;
        for (number, (shape, range)) in shapes.iter().zip(ranges).enumerate() {
            let Some([first, last]) = *range else {
                continue;
            };
            let from = *self.next.entry((item, number)).or_insert(Some(first));
            let found = from.and_then(|from| self.first_free(shape, from, first, last));
            self.next.insert((item, number), found);
            let Some(cells) = found else {
                continue;
            };
            let outline = &shape.outline;
            let end = [
                cells[1] + outline.first[1] + outline.cells.rows as i64,
                cells[0] + outline.first[0] + outline.cells.columns as i64,
            ];
            if best.as_ref().is_none_or(|(best, _)| end < *best) {
                let copy = Copy {
                    item,
                    shape: number,
                    cells,
                };
                best = Some((end, copy));
            }
        }
        let Some((_, copy)) = best else {
            return false;
        };
        self.take(&shapes[copy.shape], copy.cells);
        self.copies.push(copy);
        true
    }

    /// The first free place from `from` on, row by row.
    fn first_free(
        &self,
        shape: &Shape,
        from: [i64; 2],
        first: [i64; 2],
        last: [i64; 2],
    ) -> Option<[i64; 2]> {
        let mut column = from[0];
        let mut blocked = 0;
        for row in from[1]..=last[1] {
            while column <= last[0] {
                match self.first_blocked(shape, [column, row], blocked) {
                    None => return Some([column, row]),
                    Some((within, columns)) => {
                        blocked = within;
                        column += columns;
                    }
                }
            }
            column = first[0];
        }
        None
    }

    /// A row of the shape that meets taken cells, and the least number of columns to the right after which it may be
    /// free again. `likely` is tried first: the row that blocks one place usually blocks the next.
    fn first_blocked(&self, shape: &Shape, at: [i64; 2], likely: usize) -> Option<(usize, i64)> {
        let outline = &shape.outline;
        let [column, row] = [0, 1].map(|axis| at[axis] + outline.first[axis]);
        let blocked = |within: usize| {
            let row = row + within as i64;
            // Cells beyond the screen hold no pixels.
            if row < 0 || row >= self.taken.rows as i64 {
                return None;
            }
            let taken = self.taken.row(row as usize);
            let cells = outline.cells.row(within);
            let words = cells.iter().enumerate().filter(|(_, word)| **word != 0);
            let mut met = words.filter_map(|(place, word)| {
                let met = word & bits_at(taken, column + place as i64 * 64);
                met.checked_ilog2().map(|bit| place * 64 + bit as usize)
            });
            // Until the shape has passed the cell that it meets, some cell between is in its place.
            met.next()
                .map(|cell| (within, run_up_to(cells, cell) as i64))
        };
        blocked(likely).or_else(|| (0..outline.cells.rows).find_map(blocked))
    }

    fn take(&mut self, shape: &Shape, at: [i64; 2]) {
        let kept = &shape.kept_free;
        let [column, row] =
            [0, 1].map(|axis| at[axis] + shape.outline.first[axis] - shape.margin[axis] as i64);
        let (columns, rows) = (self.taken.columns as i64, self.taken.rows as i64);
        for within in 0..kept.rows {
            let onto = row + within as i64;
            if !(0..rows).contains(&onto) {
                continue;
            }
            for cell in (0..kept.columns).filter(|&cell| kept.has(cell, within)) {
                let onto_column = column + cell as i64;
                if (0..columns).contains(&onto_column) {
                    let start = onto_column as usize;
                    self.taken.fill(onto as usize, start..start + 1);
                }
            }
        }
    }

    /// Pixels by which to move all copies so that they are centred on the plate. A copy alone stays at the middle, where it would
    /// be without a plate.
    pub fn to_middle(&self, screen: &Screen, shapes: &[Vec<Shape>]) -> [i64; 2] {
        let ends = self.copies.iter().map(|copy| {
            let pixels = shapes[copy.item][copy.shape].outline.pixels;
            pixels.map(|end| {
                [0, 1].map(|axis| end[axis] + copy.cells[axis] * i64::from(screen.cell[axis]))
            })
        });
        let all = ends.reduce(|[first, last], [start, end]| {
            [
                [0, 1].map(|axis| first[axis].min(start[axis])),
                [0, 1].map(|axis| last[axis].max(end[axis])),
            ]
        });
        let Some([first, last]) = all else {
            return [0; 2];
        };
        if let [copy] = &self.copies[..] {
            return [0, 1].map(|axis| -copy.cells[axis] * i64::from(screen.cell[axis]));
        }
        [0, 1].map(|axis| (i64::from(screen.pixels[axis]) - first[axis] - last[axis]).div_euclid(2))
    }
}

/// Number of cells side by side in a row up to a cell, which is one of them.
fn run_up_to(row: &[u64], cell: usize) -> usize {
    let (mut place, bit) = (cell / 64, cell % 64);
    let mut run = (row[place] << (63 - bit)).leading_ones() as usize;
    if run == bit + 1 {
        while place > 0 {
            place -= 1;
            let more = row[place].leading_ones() as usize;
            run += more;
            if more < 64 {
                break;
            }
        }
    }
    run
}

/// 64 cells of a row from a column on; those beyond the row are free.
pub(super) fn bits_at(row: &[u64], column: i64) -> u64 {
    let word = |index: i64| {
        usize::try_from(index)
            .ok()
            .and_then(|index| row.get(index))
            .copied()
    };
    let (index, shift) = (column.div_euclid(64), column.rem_euclid(64) as u32);
    let low = word(index).unwrap_or(0) >> shift;
    match shift {
        0 => low,
        _ => low | word(index + 1).unwrap_or(0) << (64 - shift),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::arrange::Outline;

    /// A shape with the given cells, whose first is at the middle of the plate.
    fn shape(cells: Cells) -> Shape {
        let outline = Outline {
            first: [0, 0],
            pixels: [[0, 0], [cells.columns as i64, cells.rows as i64]],
            area_mm2: 0.0,
            cells,
        };
        Shape::new(0, Arc::new(outline), &[0])
    }

    #[test]
    fn the_first_free_place_is_that_of_a_search_cell_by_cell() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..200 {
            let mut cells = |columns: usize, rows: usize, share: f64| {
                let mut cells = Cells::new(columns, rows);
                for cell in 0..columns * rows {
                    if random.f64() < share {
                        let column = cell % columns;
                        cells.fill(cell / columns, column..column + 1);
                    }
                }
                cells
            };
            let mut sheet = Sheet::new([200, 12]);
            sheet.taken = cells(200, 12, 0.03);
            let shape = shape(cells(70, 2, 0.7));
            let is_free = |&[column, row]: &[i64; 2]| {
                (0..140).all(|cell| {
                    let (right, down) = (cell % 70, cell / 70);
                    let onto = [column + right as i64, row + down as i64];
                    let is_on = onto[0] < 200 && onto[1] < 12;
                    let is_taken = is_on && sheet.taken.has(onto[0] as usize, onto[1] as usize);
                    !(shape.outline.cells.has(right, down) && is_taken)
                })
            };
            let mut all = (0..=11).flat_map(|row| (0..=190).map(move |column| [column, row]));
            let found = sheet.first_free(&shape, [0, 0], [0, 0], [190, 11]);
            assert_eq!(found, all.find(is_free));
        }
    }
}
