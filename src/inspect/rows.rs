//! Layers as spans of pixels in rows, and how spans of rows are combined.

use crate::grid::Grid;
use crate::mask::{LayerRuns, Window};

/// A column beyond all others: rows of dark pixels go on to here.
pub(super) const FAR: i32 = i32::MAX / 4;

/// The brightness from which a pixel is solid: half of its samples are lit.
const SOLID_GREY: u8 = 128;

/// Consecutive pixels of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    /// The first column.
    pub start: i32,
    /// The column after the last.
    pub end: i32,
}

impl Span {
    pub fn pixels(self) -> u64 {
        (self.end - self.start) as u64
    }
}

/// The part of the screen that is examined.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub rows: i32,
    pub columns: i32,
    /// Its first row on the screen.
    pub first_row: i32,
    /// Its first column on the screen.
    pub first_column: i32,
    /// Columns of the screen.
    width: u32,
}

impl Area {
    pub fn new(window: &Window, grid: &Grid) -> Self {
        Self {
            rows: window.rows as i32,
            columns: window.row_pixels() as i32,
            first_row: window.first_row as i32,
            first_column: window.first_byte as i32 * 8,
            width: grid.width,
        }
    }
}

/// Spans by rows, from the top row down. No two spans of a row touch.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Rows {
    spans: Vec<Span>,
    /// The end of each row in `spans`.
    ends: Vec<u32>,
}

impl Rows {
    /// The solid pixels of a layer.
    pub fn of_layer(runs: &LayerRuns, layer: usize, area: &Area) -> Self {
        let mut rows = Self {
            spans: Vec::new(),
            ends: Vec::with_capacity(area.rows as usize),
        };
        let mut row = 0;
        let mut row_first = area.first_row as u32 * area.width;
        for run in runs.of_layer(layer) {
            if run.grey < SOLID_GREY {
                continue;
            }
            while run.first >= row_first + area.width {
                rows.end_row();
                row_first += area.width;
                row += 1;
            }
            let start = (run.first - row_first) as i32 - area.first_column;
            rows.push(Span {
                start,
                end: start + run.pixels as i32,
            });
        }
        for _ in row..area.rows {
            rows.end_row();
        }
        rows
    }

    /// Appends a span to the last row, which is not ended yet. It joins the span before if they touch.
    #[inline]
    pub fn push(&mut self, span: Span) {
        let row_start = self.ends.last().map_or(0, |&end| end as usize);
        match self.spans[row_start..].last_mut() {
            Some(last) if span.start <= last.end => last.end = last.end.max(span.end),
            _ => self.spans.push(span),
        }
    }

    #[inline]
    pub fn push_row(&mut self, spans: &[Span]) {
        // Most rows of findings have none, and copying nothing takes time in WebAssembly.
        if !spans.is_empty() {
            self.spans.extend_from_slice(spans);
        }
        self.end_row();
    }

    #[inline]
    pub fn end_row(&mut self) {
        self.ends.push(self.spans.len() as u32);
    }

    /// Number of rows.
    pub fn len(&self) -> i32 {
        self.ends.len() as i32
    }

    /// Returns true if no row has a span.
    pub fn is_blank(&self) -> bool {
        self.spans.is_empty()
    }

    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// The places of a row's spans among all spans.
    #[inline]
    pub fn places(&self, row: i32) -> std::ops::Range<usize> {
        let row = row as usize;
        let start = row.checked_sub(1).map_or(0, |above| self.ends[above]);
        start as usize..self.ends[row] as usize
    }

    /// The spans of a row; none outside the rows.
    #[inline]
    pub fn row(&self, row: i32) -> &[Span] {
        if row < 0 || row >= self.len() {
            return &[];
        }
        &self.spans[self.places(row)]
    }

    /// From the first to the last pixel of a row.
    pub fn extent(&self, row: i32) -> Option<Span> {
        let spans = self.row(row);
        Some(Span {
            start: spans.first()?.start,
            end: spans.last()?.end,
        })
    }

    /// The first and the last row with a pixel.
    pub fn bounds(&self) -> Option<[i32; 2]> {
        let mut filled = (0..self.len()).filter(|&row| !self.row(row).is_empty());
        let first = filled.next()?;
        Some([first, filled.next_back().unwrap_or(first)])
    }

    /// The dark pixels between lit ones of the same row.
    pub fn gaps(&self) -> Self {
        let mut gaps = Self {
            spans: Vec::new(),
            ends: Vec::with_capacity(self.ends.len()),
        };
        for row in 0..self.len() {
            for pair in self.row(row).windows(2) {
                gaps.spans.push(Span {
                    start: pair[0].end,
                    end: pair[1].start,
                });
            }
            gaps.end_row();
        }
        gaps
    }

    /// All dark pixels, with `margin` dark rows above and below, and out to [`FAR`] on both sides.
    pub fn inverted(&self, margin: i32) -> Self {
        let mut dark = Self {
            spans: Vec::with_capacity(self.spans.len() + self.ends.len()),
            ends: Vec::with_capacity(self.ends.len()),
        };
        for row in -margin..self.len() + margin {
            let mut start = -FAR;
            for span in self.row(row) {
                dark.spans.push(Span {
                    start,
                    end: span.start,
                });
                start = span.end;
            }
            dark.spans.push(Span { start, end: FAR });
            dark.end_row();
        }
        dark
    }

    /// The pixels of these rows that are not in the others.
    pub fn without(&self, others: &Self) -> Self {
        self.without_at(others, 0, 0..self.len())
    }

    /// The same where the others begin `margin` rows further down, and no rows but `wanted` are needed: the rest are blank.
    pub fn without_at(&self, others: &Self, margin: i32, wanted: std::ops::Range<i32>) -> Self {
        let mut rest = Self::default();
        for row in 0..self.len() {
            if wanted.contains(&row) {
                subtract(self.row(row), others.row(row - margin), 0, &mut rest.spans);
            }
            rest.end_row();
        }
        rest
    }
}

/// Appends the pixels of `spans` that are not in `others`, each of which is longer by `half_width` on both sides.
pub(super) fn subtract(spans: &[Span], others: &[Span], half_width: i32, rest: &mut Vec<Span>) {
    let mut next = 0;
    for &Span { mut start, end } in spans {
        while others
            .get(next)
            .is_some_and(|it| it.end + half_width <= start)
        {
            next += 1;
        }
        for other in &others[next..] {
            if other.start - half_width >= end {
                break;
            }
            if start < other.start - half_width {
                rest.push(Span {
                    start,
                    end: other.start - half_width,
                });
            }
            start = start.max(other.end + half_width);
            if start >= end {
                break;
            }
        }
        if start < end {
            rest.push(Span { start, end });
        }
    }
}

/// Appends the pixels that are in both lists, when each span of `others` is shorter by `half_width` on both sides.
pub(super) fn intersect(spans: &[Span], others: &[Span], half_width: i32, both: &mut Vec<Span>) {
    let mut next = 0;
    for other in others {
        let (start, end) = (other.start + half_width, other.end - half_width);
        if start >= end {
            continue;
        }
        while spans.get(next).is_some_and(|it| it.end <= start) {
            next += 1;
        }
        for span in &spans[next..] {
            if span.start >= end {
                break;
            }
            both.push(Span {
                start: span.start.max(start),
                end: span.end.min(end),
            });
        }
    }
}

/// Appends the pixels that are in either list.
pub(super) fn unite(spans: &[Span], others: &[Span], either: &mut Vec<Span>) {
    let (mut i, mut j) = (0, 0);
    loop {
        let span = match (spans.get(i), others.get(j)) {
            (Some(&a), b) if b.is_none_or(|b| a.start <= b.start) => {
                i += 1;
                a
            }
            (_, Some(&b)) => {
                j += 1;
                b
            }
            _ => return,
        };
        match either.last_mut() {
            Some(last) if span.start <= last.end => last.end = last.end.max(span.end),
            _ => either.push(span),
        }
    }
}

/// The pixels around a pixel whose centres are within a radius of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Disc {
    /// For each row from the middle, the number of columns on each side.
    half_widths: Vec<i32>,
    /// The rows of the disc from its middle outward, and the half width of each.
    steps: Vec<(i32, i32)>,
    /// The half widths from the first row to the last.
    column: Vec<i32>,
}

/// A length this close to a limit or to a whole number of pixels, as a fraction of it, counts as equal.
pub(super) const ROUNDING: f64 = 1e-9;

impl Disc {
    pub fn new(radius_mm: f64, grid: &Grid) -> Self {
        let radius_mm = radius_mm.max(0.0) * (1.0 + ROUNDING);
        let rows = (radius_mm / grid.pitch_y_mm) as i32;
        let half_width = |row| {
            let y_mm = f64::from(row) * grid.pitch_y_mm;
            let x_mm = (radius_mm * radius_mm - y_mm * y_mm).max(0.0).sqrt();
            (x_mm / grid.pitch_mm) as i32
        };
        let half_widths: Vec<i32> = (0..=rows).map(half_width).collect();
        let steps = half_widths.iter().zip(0..);
        let steps = steps.flat_map(|(&half_width, step)| {
            let other = (step > 0).then_some((-step, half_width));
            std::iter::once((step, half_width)).chain(other)
        });
        let above = half_widths.iter().skip(1).rev();
        Self {
            steps: steps.collect(),
            column: above.chain(&half_widths).copied().collect(),
            half_widths,
        }
    }

    /// The disc of a diameter that must fit, less a pixel, since masks may show what holds it that much narrower than it is. `None` if
    /// every pixel holds it.
    pub fn to_fit(diameter_mm: f64, grid: &Grid) -> Option<Self> {
        let pitch_mm = grid.pitch_mm.max(grid.pitch_y_mm);
        let disc = Self::new((diameter_mm - pitch_mm) / 2.0, grid);
        (disc.half_widths != [0]).then_some(disc)
    }

    /// Rows on each side of the middle.
    pub fn rows(&self) -> i32 {
        self.half_widths.len() as i32 - 1
    }

    /// Columns on each side in the row at this distance from the middle; `None` outside the disc.
    pub fn half_width(&self, row: i32) -> Option<i32> {
        self.half_widths.get(row.unsigned_abs() as usize).copied()
    }

    /// The rows of the disc from its middle outward, and the half width of each.
    pub fn steps(&self) -> &[(i32, i32)] {
        &self.steps
    }

    /// The half widths of its rows, from the first to the last.
    pub fn column(&self) -> &[i32] {
        &self.column
    }
}

/// The pixels of a row that are left when others are taken away, one row of them after another.
#[derive(Default)]
pub(super) struct Rest {
    rest: Vec<Span>,
    less: Vec<Span>,
}

impl Rest {
    /// Begins with the pixels of a span.
    pub fn begin(&mut self, span: Span) {
        self.rest.clear();
        self.rest.push(span);
    }

    /// Takes the pixels of others away, each of which is longer by `half_width` on both sides.
    #[inline]
    pub fn take(&mut self, others: &[Span], half_width: i32) {
        if self.rest.is_empty() || others.is_empty() {
            return;
        }
        self.less.clear();
        subtract(&self.rest, others, half_width, &mut self.less);
        std::mem::swap(&mut self.rest, &mut self.less);
    }

    /// Returns true if [`Self::take`] would take anything away.
    pub fn touches(&self, others: &[Span], half_width: i32) -> bool {
        let mut next = 0;
        self.rest.iter().any(|span| {
            while others
                .get(next)
                .is_some_and(|it| it.end + half_width <= span.start)
            {
                next += 1;
            }
            others
                .get(next)
                .is_some_and(|it| it.start - half_width < span.end)
        })
    }

    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The remaining spans.
    pub fn spans(&self) -> &[Span] {
        &self.rest
    }

    /// The pixels of `spans` that are in none of `others`, each of which is extended by its half width on both sides.
    /// Stops once nothing is left.
    pub fn of<'a>(
        &mut self,
        spans: &[Span],
        others: impl IntoIterator<Item = (&'a [Span], i32)>,
    ) -> &[Span] {
        let mut others = others.into_iter().filter(|(spans, _)| !spans.is_empty());
        self.rest.clear();
        // The first one needs no copy.
        match others.next() {
            Some((first, half_width)) => subtract(spans, first, half_width, &mut self.rest),
            None => self.rest.extend_from_slice(spans),
        }
        for (spans, half_width) in others {
            if self.rest.is_empty() {
                break;
            }
            self.take(spans, half_width);
        }
        &self.rest
    }

    /// The pixels of `spans` farther from all `others` than the disc, where `spans` are in row `row` of the others.
    ///
    /// Most rows need no row but the one at their own place: it is asked first.
    pub fn beyond(&mut self, spans: &[Span], others: &Rows, row: i32, disc: &Disc) -> &[Span] {
        if spans.is_empty() {
            return &[];
        }
        let steps = disc.steps().iter();
        self.of(
            spans,
            steps.map(|&(step, half_width)| (others.row(row + step), half_width)),
        )
    }

    /// The same for all rows, where the others begin `margin` rows further down.
    pub fn beyond_all(&mut self, rows: &Rows, others: &Rows, margin: i32, disc: &Disc) -> Rows {
        let mut found = Rows::default();
        for row in 0..rows.len() {
            found.push_row(self.beyond(rows.row(row), others, row + margin, disc));
        }
        found
    }
}
