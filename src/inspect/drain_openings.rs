//! Hollows that resin leaves too slowly: through openings that are narrower than a limit.
//!
//! A dark pixel is roomy if a disc of the limit's diameter fits into the dark around it. Roomy pixels hang together as all pixels
//! do. Those that hang together and do not reach the outside of the printed part are a hollow without a drain wide enough,
//! unless no drain is there at all: then it is a trap.

use super::collect::{Collector, Frame};
use super::components::Patch;
use super::finding::{Code, Finding};
use super::forest::{End, Forest, Joining, Step};
use super::hollows::{GapLinks, Gaps, Hollows};
use super::limits::Limits;
use super::rows::{Disc, FAR, Rest, Rows, Span, unite};

/// The first and the last pixel of each row of a layer.
#[derive(Default)]
pub(super) struct Extents {
    /// The first pixels, with as many rows without any above and below as the disc has on each side.
    starts: Vec<i32>,
    /// The ends, likewise.
    ends: Vec<i32>,
}

impl Extents {
    pub fn new(lit: &Rows, disc: &Disc) -> Self {
        let margin = disc.rows();
        let rows = (lit.len() + 2 * margin) as usize;
        let (mut starts, mut ends) = (vec![FAR; rows], vec![-FAR; rows]);
        for row in 0..lit.len() {
            if let Some(extent) = lit.extent(row) {
                starts[(row + margin) as usize] = extent.start;
                ends[(row + margin) as usize] = extent.end;
            }
        }
        Self { starts, ends }
    }

    /// From the first to the last pixel of a row that is within the disc of a lit one. Beyond the layer's rows all is outside: what
    /// has room at its edge has room from there on.
    #[inline]
    pub fn of_row(&self, row: i32, disc: &Disc) -> Option<Span> {
        let half_widths = disc.column();
        let first = usize::try_from(row).ok()?;
        let near = first..first + half_widths.len();
        let (starts, ends) = (self.starts.get(near.clone())?, self.ends.get(near)?);
        let (mut start, mut end) = (FAR, -FAR);
        for ((&half_width, &first), &last) in half_widths.iter().zip(starts).zip(ends) {
            start = start.min(first - half_width);
            end = end.max(last + half_width);
        }
        (start < end).then_some(Span { start, end })
    }
}

/// The roomy pixels of a layer, between the first and the last pixel of each row that is within a disc of a lit one.
pub(super) fn rooms(lit: &Rows, disc: &Disc, extents: &Extents) -> Gaps {
    let has_rooms = rows_with_rooms(lit, disc.rows());
    let mut rooms = Rows::default();
    let mut rest = Rest::default();
    let blocks = Blocks::new(lit);
    for (has_rooms, row) in has_rooms.into_iter().zip(0..) {
        match has_rooms.then(|| extents.of_row(row, disc)).flatten() {
            Some(whole) => rooms.push_row(blocks.beyond(whole, row, disc, &mut rest)),
            None => rooms.end_row(),
        }
    }
    Gaps::new(rooms, &|row| extents.of_row(row, disc))
}

/// Rows of a layer that are examined together.
const BLOCK_ROWS: i32 = 8;

/// A layer, and the columns that are lit in blocks of its rows. A disc that must fit spans many rows, and few of these
/// take away anything that is left by the others: blocks show which rows do.
struct Blocks<'a> {
    lit: &'a Rows,
    columns: Rows,
}

impl<'a> Blocks<'a> {
    fn new(lit: &'a Rows) -> Self {
        let mut columns = Rows::default();
        let (mut some, mut more) = (Vec::new(), Vec::new());
        for first in (0..lit.len()).step_by(BLOCK_ROWS as usize) {
            some.clear();
            for row in first..first + BLOCK_ROWS {
                more.clear();
                unite(&some, lit.row(row), &mut more);
                std::mem::swap(&mut some, &mut more);
            }
            columns.push_row(&some);
        }
        Self { lit, columns }
    }

    /// The pixels of a span in `row` that are farther from all lit ones than the disc.
    fn beyond<'b>(&self, span: Span, row: i32, disc: &Disc, rest: &'b mut Rest) -> &'b [Span] {
        rest.begin(span);
        let own = row / BLOCK_ROWS;
        let outward = (1..=disc.rows() / BLOCK_ROWS + 1).flat_map(|step| [own - step, own + step]);
        for block in std::iter::once(own).chain(outward) {
            let (first, last) = (block * BLOCK_ROWS, (block + 1) * BLOCK_ROWS - 1);
            let nearest = disc.half_width(row.clamp(first, last) - row);
            let is_near =
                nearest.is_some_and(|half_width| rest.touches(self.columns.row(block), half_width));
            if !is_near {
                continue;
            }
            for other in first..=last {
                if let Some(half_width) = disc.half_width(other - row) {
                    rest.take(self.lit.row(other), half_width);
                }
            }
            if rest.is_empty() {
                break;
            }
        }
        rest.spans()
    }
}

/// The rows that may have rooms: none if all rows so near have one span, and each overlaps the next.
fn rows_with_rooms(lit: &Rows, reach: i32) -> Vec<bool> {
    let rows = lit.len();
    let is_plain = |row: i32| {
        let ([here], [next]) = (lit.row(row), lit.row(row + 1)) else {
            return false;
        };
        here.start < next.end && next.start < here.end
    };
    let mut has_rooms = vec![false; rows as usize];
    let mut lit_rows = (0..rows).filter(|&row| !lit.row(row).is_empty());
    let Some(first) = lit_rows.next() else {
        return has_rooms;
    };
    let last = lit_rows.next_back().unwrap_or(first);
    let mut until = 0;
    for row in first..=last {
        if lit.row(row).len() > 1 || (row < last && !is_plain(row)) {
            let from = (row - reach).max(until);
            until = (row + reach + 2).min(rows);
            for it in from..until {
                has_rooms[it as usize] = true;
            }
        }
    }
    has_rooms
}

/// The rooms of the layers so far.
pub(super) struct Openings<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    forest: Forest,
    /// For each tree of rooms, the hollow that it is in.
    hollow: Vec<u32>,
    /// Rooms that do not reach the outside, and the hollows that they are in.
    found: Vec<(Finding, u32)>,
}

impl<'a> Openings<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits) -> Self {
        Self {
            frame,
            limits,
            forest: Forest::with_outside(Joining::Unites, &Patch::NOWHERE),
            hollow: vec![Forest::OUTSIDE],
            found: Vec::new(),
        }
    }

    /// `gaps` are the layer's gaps, which `hollows` know already.
    pub fn advance(
        &mut self,
        layer: usize,
        rooms: &Gaps,
        links: &GapLinks,
        gaps: &Gaps,
        hollows: &Hollows<'_>,
    ) {
        let components = &rooms.components;
        // The plate does not stay: rooms that are open to it drain.
        let on_plate = if layer == 0 {
            components.patches.len()
        } else {
            0
        };
        let on_plate: Vec<u32> = (0..on_plate as u32).collect();
        let step = Step {
            layer,
            bins: self.frame.bins(layer),
            patches: &components.patches,
            contacts: &links.contacts,
            fixed: if layer == 0 { &on_plate } else { &links.open },
            fixed_below: &links.open_below,
        };
        for (tree, end) in self.forest.advance(&step) {
            let finding = self.frame.finding(Code::NarrowDrain, &tree);
            let is_wanted = finding.volume_mm3 / 1e3 >= self.limits.trap_ml;
            if !tree.is_fixed && end == End::Closed && is_wanted {
                let limit = self.limits.drain_mm;
                let hollow = self.hollow[tree.number as usize];
                self.found.push((Finding { limit, ..finding }, hollow));
            }
        }
        if components.patches.is_empty() {
            return;
        }
        // A pixel in no gap is before the first or after the last lit pixel of its row: outside.
        let mut within = vec![Forest::OUTSIDE; components.patches.len()];
        for [gap, room] in components.contacts(&gaps.components) {
            within[room as usize] = hollows.tree(gap);
        }
        // Trees are numbered as they begin.
        let known = self.hollow.len();
        self.hollow.resize(self.forest.trees(), Forest::OUTSIDE);
        for (&tree, &hollow) in self.forest.of_components().iter().zip(&within) {
            if tree as usize >= known {
                self.hollow[tree as usize] = hollow;
            }
        }
    }

    /// To be called before `hollows` are finished.
    pub fn finish(self, hollows: &Hollows<'_>, collector: &mut Collector<'_>) {
        for (finding, hollow) in self.found {
            if !hollows.is_trap(hollow) {
                collector.add(finding);
            }
        }
    }
}
