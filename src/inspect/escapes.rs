//! Hollows that resin leaves too slowly: through openings that are narrower than a limit.
//!
//! A dark pixel is roomy if a disc of the limit's diameter fits into the dark around it. Roomy pixels hang together as all pixels
//! do. Those that hang together and do not reach the outside of the printed part are a hollow without an escape wide enough,
//! unless no escape is there at all: then it is a trap.

use super::collect::{Collector, Frame};
use super::components::Patch;
use super::finding::{Code, Finding};
use super::forest::{End, Forest, Joining, Step};
use super::hollows::{Gaps, Hollows, Meetings};
use super::limits::Limits;
use super::rows::{Beyond, Disc, Rows, Span};

/// The roomy pixels of a layer, between the first and the last pixel of each row that is within a disc of a lit one.
pub(super) fn rooms(lit: &Rows, disc: &Disc) -> Gaps {
    let has_rooms = rows_with_rooms(lit, disc.rows());
    let mut rooms = Rows::default();
    let mut beyond = Beyond::default();
    for (has_rooms, row) in has_rooms.into_iter().zip(0..) {
        let whole = has_rooms.then(|| extent(lit, row, disc)).flatten();
        match whole {
            Some(whole) => rooms.push_row(beyond.find(&[whole], lit, row, disc)),
            None => rooms.end_row(),
        }
    }
    Gaps::new(rooms, &|row| extent(lit, row, disc))
}

/// From the first to the last pixel of a row that is within a disc of a lit one. Beyond the layer's rows all is outside: what has
/// room at its edge has room from there on.
pub(super) fn extent(lit: &Rows, row: i32, disc: &Disc) -> Option<Span> {
    if !(0..lit.len()).contains(&row) {
        return None;
    }
    let near = disc.steps().filter_map(|(step, half_width)| {
        let span = lit.extent(row + step)?;
        Some(Span {
            start: span.start - half_width,
            end: span.end + half_width,
        })
    });
    near.reduce(|a, b| Span {
        start: a.start.min(b.start),
        end: a.end.max(b.end),
    })
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
pub(super) struct Escapes<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    forest: Forest,
    /// For each tree of rooms, the hollow that it is in.
    hollow: Vec<u32>,
    /// Rooms that do not reach the outside, and the hollows that they are in.
    found: Vec<(Finding, u32)>,
}

impl<'a> Escapes<'a> {
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
        meetings: &Meetings,
        gaps: &Gaps,
        hollows: &Hollows<'_>,
    ) {
        let components = &rooms.components;
        // The plate does not stay: what is open to it drains.
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
            contacts: &meetings.contacts,
            fixed: if layer == 0 {
                &on_plate
            } else {
                &meetings.open
            },
            fixed_below: &meetings.open_below,
        };
        for (tree, end) in self.forest.advance(&step) {
            let finding = self.frame.finding(Code::SmallEscape, &tree);
            let is_wanted = finding.volume_mm3 / 1e3 >= self.limits.trap_ml;
            if !tree.is_fixed && end == End::Closed && is_wanted {
                let limit = self.limits.escape_mm;
                let hollow = self.hollow[tree.number as usize];
                self.found.push((Finding { limit, ..finding }, hollow));
            }
        }
        if components.patches.is_empty() {
            return;
        }
        // What is in no gap is before the first or after the last lit pixel of its row: outside.
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
