//! Parts of a layer that hang together, and which of them meet from layer to layer.
//!
//! Pixels hang together across their four sides. An edge or a corner alone is no bond, and no passage either.

use super::rows::{Rows, Span};
use crate::union_find::{find, unite};

/// Not yet known.
pub(super) const NONE: u32 = u32::MAX;

/// Pixels of a layer, measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Patch {
    pub pixels: u64,
    /// The first of its longest spans: row, first column, length.
    longest: (i32, Span),
    /// The first and the last column.
    pub columns: [i32; 2],
    /// The first and the last row.
    pub rows: [i32; 2],
}

impl Patch {
    /// No pixels.
    pub const NOWHERE: Self = Self {
        pixels: 0,
        longest: (0, Span { start: 0, end: 0 }),
        columns: [0; 2],
        rows: [0; 2],
    };

    fn new(row: i32, span: Span) -> Self {
        Self {
            pixels: span.pixels(),
            longest: (row, span),
            columns: [span.start, span.end - 1],
            rows: [row; 2],
        }
    }

    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        if other.longest.1.pixels() > self.longest.1.pixels() {
            self.longest = other.longest;
        }
        self.extend(other);
    }

    /// Extends the box around the patch to another.
    pub fn extend(&mut self, other: &Self) {
        let around = |a: [i32; 2], b: [i32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.columns = around(self.columns, other.columns);
        self.rows = around(self.rows, other.rows);
    }

    /// The row and twice the column of the middle of its longest span: a place on the patch itself.
    pub fn middle(&self) -> (i32, i32) {
        let (row, span) = self.longest;
        (row, span.start + span.end - 1)
    }
}

/// Rows with the component of each span.
#[derive(Debug, Clone, Default)]
pub(super) struct Components {
    pub rows: Rows,
    of_span: Vec<u32>,
    /// The components, in the order of their first spans.
    pub patches: Vec<Patch>,
}

impl Components {
    /// Cost: linear in rows and spans.
    pub fn new(rows: Rows) -> Self {
        let mut parent: Vec<u32> = Vec::new();
        let mut of_span = vec![NONE; rows.spans().len()];
        for row in 0..rows.len() {
            let here = rows.places(row);
            if row > 0 {
                each_overlap(&rows, row - 1, &rows, row, |above, span| {
                    let above = find(&mut parent, of_span[above]);
                    match of_span[span] {
                        NONE => of_span[span] = above,
                        known => {
                            unite(&mut parent, known, above);
                        }
                    }
                });
            }
            for label in &mut of_span[here] {
                if *label == NONE {
                    *label = parent.len() as u32;
                    parent.push(*label);
                }
            }
        }
        let mut patches: Vec<Patch> = Vec::new();
        let mut place = vec![NONE; parent.len()];
        for row in 0..rows.len() {
            for span in rows.places(row) {
                let root = find(&mut parent, of_span[span]) as usize;
                let patch = Patch::new(row, rows.spans()[span]);
                if place[root] == NONE {
                    place[root] = patches.len() as u32;
                    patches.push(patch);
                } else {
                    patches[place[root] as usize].add(&patch);
                }
                of_span[span] = place[root];
            }
        }
        Self {
            rows,
            of_span,
            patches,
        }
    }

    /// The components of a row's spans, with the spans.
    pub fn of_row(&self, row: i32) -> impl Iterator<Item = (Span, u32)> {
        let spans = self.rows.row(row).iter().copied();
        let places = self.rows.places(row);
        spans.zip(self.of_span[places].iter().copied())
    }

    /// The component with a pixel.
    pub fn at(&self, [column, row]: [i32; 2]) -> Option<u32> {
        let mut spans = self.of_row(row);
        let found = spans.find(|(span, _)| (span.start..span.end).contains(&column));
        found.map(|(_, component)| component)
    }

    /// Pairs of a component and one of the layer below that share a column of pixels. A pair may be there more than once.
    pub fn contacts(&self, below: &Self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        let mut last = vec![NONE; self.patches.len()];
        if below.rows.is_blank() || self.rows.is_blank() {
            return pairs;
        }
        for row in 0..self.rows.len() {
            each_overlap(&below.rows, row, &self.rows, row, |under, span| {
                let (under, over) = (below.of_span[under], self.of_span[span]);
                if last[over as usize] != under {
                    last[over as usize] = under;
                    pairs.push([under, over]);
                }
            });
        }
        pairs
    }

    /// The components with pixels outside the extents of rows. `step` is the distance of these rows from the components' own.
    pub fn open_to(&self, extent: Extent<'_>, step: i32, is_open: &mut [bool]) {
        for row in 0..self.rows.len() {
            let (Some(first), Some(last)) = (self.rows.row(row).first(), self.rows.row(row).last())
            else {
                continue;
            };
            let inside = extent(row + step);
            if inside.is_some_and(|it| it.start <= first.start && last.end <= it.end) {
                continue;
            }
            for (span, component) in self.of_row(row) {
                if inside.is_none_or(|it| span.start < it.start || span.end > it.end) {
                    is_open[component as usize] = true;
                }
            }
        }
    }
}

/// Tells from which to which pixel each row of a layer goes.
pub(super) type Extent<'a> = &'a dyn Fn(i32) -> Option<Span>;

/// Calls `found` with the places of every two spans of two rows that share a column.
fn each_overlap(a: &Rows, a_row: i32, b: &Rows, b_row: i32, mut found: impl FnMut(usize, usize)) {
    let (mut i, mut j) = (a.places(a_row), b.places(b_row));
    let (spans_a, spans_b) = (a.spans(), b.spans());
    while i.start < i.end && j.start < j.end {
        let (one, other) = (spans_a[i.start], spans_b[j.start]);
        if one.start < other.end && other.start < one.end {
            found(i.start, j.start);
        }
        if one.end < other.end {
            i.start += 1;
        } else {
            j.start += 1;
        }
    }
}
