//! Bridges: unsupported pixels on a straight line between supported ones, with nothing dark on it.
//!
//! Lines follow rows, columns, diagonals and a knight's moves, so mirrors and quarter turns change nothing.

use std::ops::Range;

use super::rows::{ROUNDING, Rows, Span, subtract};
use crate::grid::Grid;

/// From one pixel of a line to the next: columns to the right and rows down.
const STEPS: [[i32; 2]; 8] = [
    [1, 0],
    [0, 1],
    [1, 1],
    [-1, 1],
    [2, 1],
    [-2, 1],
    [1, 2],
    [-1, 2],
];

/// Unsupported pixels of a row at the same number of steps from a supported one.
#[derive(Clone, Copy)]
struct Stretch {
    span: Span,
    steps: u32,
}

/// Stretches by rows, in the order in which lines are followed.
#[derive(Default)]
struct Stretches {
    all: Vec<Stretch>,
    /// The end of each row in `all`.
    ends: Vec<u32>,
}

impl Stretches {
    /// The places of a row's stretches; none before the first row.
    #[inline]
    fn places(&self, row: Option<usize>) -> Range<usize> {
        let Some(row) = row else { return 0..0 };
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        start as usize..self.ends[row] as usize
    }

    /// Appends to the last row, which is not ended yet and begins at `first`. A stretch joins the one before if they are as far from a support and touch.
    fn push(&mut self, first: usize, stretch: Stretch) {
        match self.all[first..].last_mut() {
            Some(last) if last.span.end == stretch.span.start && last.steps == stretch.steps => {
                last.span.end = stretch.span.end;
            }
            _ => self.all.push(stretch),
        }
    }
}

/// The lines along which bridges are looked for.
pub(super) struct Bridges {
    /// The step of each kind of line, and how many unsupported pixels a bridge may have along it.
    lines: [([i32; 2], u32); 8],
}

impl Bridges {
    pub fn new(longest_mm: f64, grid: &Grid) -> Self {
        let lines = STEPS.map(|[x, y]| {
            let (x_mm, y_mm) = (f64::from(x) * grid.pitch_mm, f64::from(y) * grid.pitch_y_mm);
            let step_mm = (x_mm * x_mm + y_mm * y_mm).sqrt();
            let most = longest_mm * (1.0 + ROUNDING) / step_mm;
            ([x, y], most as u32)
        });
        Self { lines }
    }

    /// Returns the pixels of `found` that no bridge holds. `found` is a part of the unsupported pixels.
    pub fn not_held(&self, found: &Rows, unsupported: &Rows, supported: &Rows) -> Rows {
        let mut rest = found.clone();
        for &(step, most) in &self.lines {
            let Some([first, last]) = rest.bounds() else {
                break;
            };
            if most == 0 {
                continue;
            }
            let reach = (i64::from(most) * i64::from(step[1])).min(i64::from(rest.len())) as i32;
            let layer = Layer {
                unsupported,
                supported,
                most,
                rows: [(first - reach).max(0), (last + reach).min(rest.len() - 1)],
            };
            rest = if step[1] == 0 {
                layer.not_held_by_rows(&rest)
            } else {
                layer.not_held_along(&rest, step)
            };
        }
        rest
    }
}

/// Unsupported and supported pixels of a layer, and the rows that are examined.
struct Layer<'a> {
    unsupported: &'a Rows,
    supported: &'a Rows,
    most: u32,
    rows: [i32; 2],
}

impl Layer<'_> {
    fn not_held_by_rows(&self, found: &Rows) -> Rows {
        without_each(found, &mut |row, held| {
            let supported = self.supported.row(row);
            let mut next = 0;
            for &span in self.unsupported.row(row) {
                while supported.get(next).is_some_and(|it| it.end < span.start) {
                    next += 1;
                }
                let [Some(left), Some(right)] = [supported.get(next), supported.get(next + 1)]
                else {
                    break;
                };
                let is_held = left.end == span.start && right.start == span.end;
                if is_held && span.pixels() <= u64::from(self.most) {
                    held.push(span);
                }
            }
        })
    }

    fn not_held_along(&self, found: &Rows, step: [i32; 2]) -> Rows {
        // Most are on no line between supported pixels, however long: that takes less than to count steps.
        let rest = self.not_between(found, step, 0);
        if rest == *found {
            return rest;
        }
        self.not_between(found, step, 1)
    }

    /// Pixels that are not on lines of `step` between supported ones, where each pixel of a line counts as `length` steps.
    fn not_between(&self, found: &Rows, [x, y]: [i32; 2], length: u32) -> Rows {
        let from_above = self.stretches([x, y], length);
        let from_below = self.stretches([-x, -y], length);
        without_each(found, &mut |row, held| {
            let [first, last] = self.rows;
            let above = from_above.places(Some((row - first) as usize));
            let below = from_below.places(Some((last - row) as usize));
            let (above, below) = (&from_above.all[above], &from_below.all[below]);
            let (mut i, mut j) = (0, 0);
            while let (Some(a), Some(b)) = (above.get(i), below.get(j)) {
                let span = Span {
                    start: a.span.start.max(b.span.start),
                    end: a.span.end.min(b.span.end),
                };
                if span.start < span.end && (a.steps + b.steps).saturating_sub(1) <= self.most {
                    held.push(span);
                }
                if a.span.end < b.span.end {
                    i += 1;
                } else {
                    j += 1;
                }
            }
        })
    }

    /// For each row that matters, the pixels to which a line leads from a supported one, step by step.
    fn stretches(&self, [x, y]: [i32; 2], length: u32) -> Stretches {
        let [first, last] = self.rows;
        let mut reached = Stretches::default();
        for place in 0..(last - first + 1) as usize {
            let row = if y > 0 {
                first + place as i32
            } else {
                last - place as i32
            };
            let before = place.checked_sub(y.unsigned_abs() as usize);
            self.step(&mut reached, before, row, [x, y], length);
        }
        reached
    }

    /// Appends the stretches of a row, from those of the row that the step leads from.
    fn step(
        &self,
        reached: &mut Stretches,
        before: Option<usize>,
        row: i32,
        [x, y]: [i32; 2],
        length: u32,
    ) {
        let first = reached.all.len();
        let mut lines = reached.places(before);
        let unsupported = self.unsupported.row(row);
        let supported = match unsupported {
            [] => &[],
            _ => self.supported.row(row - y),
        };
        let (mut next, mut next_supported) = (0, 0);
        while next < unsupported.len() {
            let line = (!lines.is_empty()).then(|| reached.all[lines.start]);
            let from = match (line, supported.get(next_supported)) {
                (Some(line), other) if other.is_none_or(|it| line.span.start < it.start) => {
                    lines.start += 1;
                    line
                }
                (_, Some(&span)) => {
                    next_supported += 1;
                    Stretch { span, steps: 0 }
                }
                _ => break,
            };
            if from.steps == self.most {
                continue;
            }
            let (start, end) = (from.span.start + x, from.span.end + x);
            while unsupported.get(next).is_some_and(|it| it.end <= start) {
                next += 1;
            }
            for span in &unsupported[next..] {
                if span.start >= end {
                    break;
                }
                let span = Span {
                    start: span.start.max(start),
                    end: span.end.min(end),
                };
                let steps = from.steps + length;
                reached.push(first, Stretch { span, steps });
            }
        }
        reached.ends.push(reached.all.len() as u32);
    }
}

/// Rows without the pixels that are held in each.
fn without_each(rows: &Rows, held: &mut dyn FnMut(i32, &mut Vec<Span>)) -> Rows {
    let mut rest = Rows::default();
    let (mut of_row, mut less) = (Vec::new(), Vec::new());
    for row in 0..rows.len() {
        of_row.clear();
        less.clear();
        if !rows.row(row).is_empty() {
            held(row, &mut of_row);
            subtract(rows.row(row), &of_row, 0, &mut less);
        }
        rest.push_row(&less);
    }
    rest
}
