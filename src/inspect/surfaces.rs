//! Surfaces that contacts of supports hold: lit pixels within reach of a contact, along lit pixels and never through
//! air.

use super::collect::Frame;
use super::held::Held;
use super::rows::{Rows, Span};
use crate::argsort::sort_by_number;
use crate::ways::{self, AROUND, KNIGHTS};

/// Least side of a cell. Gaps narrower than a cell count as closed: resin closes them as well.
pub(super) const CELL_MM: f64 = 0.1;

/// Largest ratio of a way along steps to a straight one, by which the reach is longer.
const LONGER: f64 = 1.028;

/// Length of a knight's move, in cells.
const KNIGHT: f32 = 2.236_068;

/// Cells at the rim of a square that count as unlit, so that no step leads out of it.
const RIM: usize = 2;

/// The surfaces around all contacts.
pub(super) struct Surfaces {
    /// Columns and rows of pixels in a cell.
    cell: [i32; 2],
    cells: Cells,
    /// From the lowest up.
    contacts: Vec<Contact>,
}

/// Lit cells of the last layer that contacts reach, in the box around their squares.
struct Cells {
    /// Column and row of the first cell.
    first: [i32; 2],
    columns: usize,
    rows: usize,
    is_lit: Vec<bool>,
    /// Cells that differ from those of the layer below, in ascending order.
    changed: Vec<usize>,
}

/// The cells around a contact.
#[derive(Clone)]
struct Contact {
    z_mm: f64,
    reach_mm: f64,
    /// The reach in cells, and cells from the contact's to the rim of the square.
    reach: f32,
    half: i32,
    /// Column and row of the contact's cell, from the first of all.
    middle: [i32; 2],
    /// Distance of each cell from the contact in cells, row by row; none yet.
    away: Vec<f32>,
}

impl Contact {
    /// Cells of a side of the square.
    fn side(&self) -> usize {
        2 * self.half as usize + 1
    }

    /// Column and row of the square's first cell.
    fn corner(&self) -> [usize; 2] {
        self.middle.map(|it| (it - self.half) as usize)
    }

    /// Fills `lit` with the lit cells of the square.
    fn copy_lit(&self, cells: &Cells, lit: &mut Vec<bool>) {
        let ([first_column, first_row], side) = (self.corner(), self.side());
        lit.clear();
        lit.resize(side * side, false);
        for row in RIM..side - RIM {
            let first = (first_row + row) * cells.columns + first_column;
            lit[row * side + RIM..(row + 1) * side - RIM]
                .copy_from_slice(&cells.is_lit[first + RIM..first + side - RIM]);
        }
    }

    /// Follows the lit cells from the last layer to this one. `lit` is memory for those of the square.
    fn advance(&mut self, cells: &Cells, lit: &mut Vec<bool>) {
        let [first_column, first_row] = self.corner();
        let side = self.side();
        let offset = |[dx, dy]: [isize; 2]| dy * side as isize + dx;
        let around = AROUND.map(|step| (offset(step), ways::length(step)));
        let knights = KNIGHTS.map(|(step, between)| (offset(step), between.map(|it| around[it].0)));
        let mut from = Vec::new();
        if self.away.is_empty() {
            self.copy_lit(cells, lit);
            // The tip itself is lit where pixels are fine enough.
            let middle = self.half as usize * (side + 1);
            if lit[middle] {
                from.push((0.0, middle));
            } else {
                let around = around.iter().map(|it| middle.wrapping_add_signed(it.0));
                from.extend(around.filter(|&it| lit[it]).map(|it| (0.0, it)));
            }
            if from.is_empty() {
                return;
            }
            self.away = vec![f32::INFINITY; side * side];
        } else {
            let local = |&cell: &usize| {
                let column = (cell % cells.columns).checked_sub(first_column)?;
                (column < side).then(|| (cell / cells.columns - first_row) * side + column)
            };
            let first = first_row * cells.columns;
            let begin = cells.changed.partition_point(|&it| it < first);
            let end = (first_row + side) * cells.columns;
            let changed = cells.changed[begin..].iter().take_while(|&&it| it < end);
            let changed: Vec<usize> = changed.filter_map(local).collect();
            if changed.is_empty() {
                return;
            }
            self.copy_lit(cells, lit);
            for &cell in &changed {
                self.away[cell] = f32::INFINITY;
            }
            for &cell in changed.iter().filter(|&&it| lit[it]) {
                let steps = around.iter().map(|it| it.0);
                for step in steps.chain(knights.iter().map(|it| it.0)) {
                    let near = cell.wrapping_add_signed(step);
                    if self.away[near] < self.reach {
                        from.push((self.away[near], near));
                    }
                }
            }
        }
        ways::spread(&mut self.away, self.reach, &from, &mut |cell, reach| {
            for (step, length) in around {
                let there = cell.wrapping_add_signed(step);
                if lit[there] {
                    reach(there, length);
                }
            }
            for (step, between) in knights {
                let there = cell.wrapping_add_signed(step);
                let mut between = between.iter();
                if lit[there] && between.all(|&it| lit[cell.wrapping_add_signed(it)]) {
                    reach(there, KNIGHT);
                }
            }
        });
    }
}

impl Surfaces {
    pub fn new(held: &Held, frame: &Frame<'_>) -> Self {
        let pixels = |pitch_mm: f64| (CELL_MM / pitch_mm).ceil().max(1.0);
        // Cells are square where pixels are.
        let cell = [frame.grid.pitch_mm, frame.grid.pitch_y_mm].map(pixels);
        let cell_mm = (cell[0] * frame.grid.pitch_mm).max(cell[1] * frame.grid.pitch_y_mm);
        let cell = cell.map(|pixels| pixels as i32);
        let contacts = held.contacts_mm.iter().map(|&at_mm| (at_mm, held.reach_mm));
        let contacts = contacts.chain(held.ceilings_mm.iter().copied());
        let contacts = contacts.map(|([x_mm, y_mm, z_mm], reach_mm)| {
            let [column, row] = frame.pixel(x_mm, y_mm);
            // A contact is anywhere in its cell, and so is a pixel.
            let reach = reach_mm * LONGER / cell_mm + 1.0;
            Contact {
                z_mm,
                reach_mm,
                reach: reach as f32,
                half: reach as i32 + 1 + RIM as i32,
                middle: [column.div_euclid(cell[0]), row.div_euclid(cell[1])],
                away: Vec::new(),
            }
        });
        let mut contacts: Vec<Contact> = contacts.collect();
        sort_by_number(&mut contacts, |it| it.z_mm);
        let [columns, rows] = [0, 1].map(|axis| {
            let ends = contacts
                .iter()
                .map(|it| (it.middle[axis] - it.half, it.middle[axis] + it.half));
            ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
                .unwrap_or_default()
        });
        for contact in &mut contacts {
            contact.middle = [contact.middle[0] - columns.0, contact.middle[1] - rows.0];
        }
        let cells = Cells {
            first: [columns.0, rows.0],
            columns: (columns.1 - columns.0 + 1) as usize,
            rows: (rows.1 - rows.0 + 1) as usize,
            is_lit: Vec::new(),
            changed: Vec::new(),
        };
        Self {
            cell,
            cells,
            contacts,
        }
    }

    /// Removes the pixels that contacts hold from those of a layer.
    pub fn take_from(&mut self, rows: &mut Rows, lit: &Rows, layer: usize, frame: &Frame<'_>) {
        let [bottom_mm, top_mm] = [layer, layer + 1].map(|boundary| frame.z_mm[boundary]);
        self.contacts.retain(|it| it.z_mm + it.reach_mm > bottom_mm);
        let count = self.contacts.partition_point(|it| it.z_mm < top_mm);
        if count == 0 {
            return;
        }
        self.cells.advance(self.cell, lit);
        let mut spans: Vec<(i32, Span)> = Vec::new();
        let mut lit_cells = Vec::new();
        for place in 0..count {
            self.contacts[place].advance(&self.cells, &mut lit_cells);
            let contact = &self.contacts[place];
            if !contact.away.is_empty() && self.is_near(contact, rows) {
                self.held_by(contact, &mut spans);
            }
        }
        if spans.is_empty() {
            return;
        }
        spans.sort_unstable_by_key(|&(row, span)| (row, span.start));
        let mut theirs = Rows::default();
        let mut next = spans.iter().peekable();
        for row in 0..rows.len() {
            while next.peek().is_some_and(|it| it.0 < row) {
                next.next();
            }
            while let Some((_, span)) = next.next_if(|it| it.0 == row) {
                theirs.push(*span);
            }
            theirs.end_row();
        }
        *rows = rows.without(&theirs);
    }

    /// The first pixel of a cell, by its column or row from the first of all.
    fn pixel(&self, axis: usize, cell: usize) -> i32 {
        (self.cells.first[axis] + cell as i32) * self.cell[axis]
    }

    /// Returns true if some of these pixels are around a contact.
    fn is_near(&self, contact: &Contact, rows: &Rows) -> bool {
        let [columns, of_rows] = [0, 1].map(|axis| {
            let first = contact.corner()[axis];
            self.pixel(axis, first)..self.pixel(axis, first + contact.side())
        });
        of_rows.into_iter().any(|row| {
            let mut spans = rows.row(row).iter();
            spans.any(|span| span.start < columns.end && columns.start < span.end)
        })
    }

    /// Appends the pixels of the cells within reach of a contact, by rows.
    fn held_by(&self, contact: &Contact, spans: &mut Vec<(i32, Span)>) {
        let is_held = |away: &f32| *away <= contact.reach;
        let [first_column, first_row] = contact.corner();
        for (row, cells) in contact.away.chunks_exact(contact.side()).enumerate() {
            let mut column = first_column;
            for run in cells.chunk_by(|a, b| is_held(a) == is_held(b)) {
                let end = column + run.len();
                if is_held(&run[0]) {
                    let [start, end] = [column, end].map(|it| self.pixel(0, it));
                    let [top, bottom] = [0, 1].map(|it| self.pixel(1, first_row + row + it));
                    spans.extend((top..bottom).map(|row| (row, Span { start, end })));
                }
                column = end;
            }
        }
    }
}

impl Cells {
    /// Takes the lit cells of the next layer that contacts reach.
    fn advance(&mut self, cell: [i32; 2], lit: &Rows) {
        let mut is_lit = vec![false; self.columns * self.rows];
        let left = self.first[0] * cell[0];
        for (row, cells) in is_lit.chunks_exact_mut(self.columns).enumerate() {
            let top = (self.first[1] + row as i32) * cell[1];
            for span in (top..top + cell[1]).flat_map(|row| lit.row(row)) {
                let first = (span.start - left).div_euclid(cell[0]).max(0) as usize;
                let last = (span.end - 1 - left).div_euclid(cell[0]);
                if last >= 0 && first < self.columns {
                    cells[first..=(last as usize).min(self.columns - 1)].fill(true);
                }
            }
        }
        let before = std::mem::replace(&mut self.is_lit, is_lit);
        let pairs = before.iter().zip(&self.is_lit).enumerate();
        let changed = pairs.filter(|(_, (before, now))| before != now);
        self.changed = changed.map(|(cell, _)| cell).collect();
    }
}
