//! Masks that make up for prints larger than they: eroded in x and y, and later where surfaces face down.
//!
//! A ray stays lit at a height if all rays within the radius are lit there. Rows of rays are lists of lit stretches; a row of
//! the result is the intersection of its neighbours', each shortened by the width of the disc in that row. Dilation is the
//! union of stretches made longer.

use std::ops::Range;

use super::entries::{Column, Entries, Raise};
use super::samples::SublayerOf;
use super::step::{Step, Stretch};
use super::{Change, Span, each_change};
use crate::grid::Grid;
use crate::ldi::RayRows;

/// Rows of rays that are held at once.
pub(super) const ROWS_AT_ONCE: u32 = 32;

/// Compensations in masks.
#[derive(Debug, Clone, PartialEq)]
pub struct Compensations {
    /// For each layer, the distance taken from each side of lit areas, in millimetres; negative: added.
    pub xy_mm: Vec<f64>,
    /// Compensation of surfaces that face down.
    pub raise: Raise,
    /// The least width that erosion leaves, measured along rows and columns, in millimetres; narrower features are not changed. 0 for none.
    pub least_mm: f64,
}

/// The rays around a model, a part of all, extended so that no grown area is cut off.
pub(super) fn extended(compensations: &Compensations, all: &Grid, part: &Grid) -> Grid {
    let most_mm = compensations
        .xy_mm
        .iter()
        .fold(0.0, |most: f64, mm| most.max(-mm));
    let sides = [part.pitch_mm, part.pitch_y_mm];
    all.extended(
        part,
        sides.map(|pitch_mm| (most_mm / pitch_mm).ceil() as u32),
    )
}

/// Finds the changes in a band of rows.
pub(super) struct Compensated<'a> {
    pub image: &'a RayRows<'a>,
    pub sublayer_of: &'a SublayerOf,
    pub compensations: &'a Compensations,
    /// Sublayers of a layer.
    pub parts: u32,
    /// The rays of the image, extended by the margin.
    pub rays: Grid,
    /// Columns and rows of that margin to the left and above.
    pub offset: [u32; 2],
}

impl Compensated<'_> {
    /// The step of each layer.
    pub fn steps(&self) -> Vec<Step> {
        let Compensations {
            xy_mm, least_mm, ..
        } = self.compensations;
        let steps = xy_mm.iter();
        let steps = steps.map(|&mm| Step::new(mm, *least_mm, &self.rays));
        steps.collect()
    }

    /// The rows of the extended rays that decide about some rows.
    pub fn around(&self, rows: &Range<usize>, steps: &[Step]) -> Range<i32> {
        let halo = steps.iter().map(Step::reach).max().unwrap_or(0);
        let first = (rows.start as i32 - halo).max(0);
        first..(rows.end as i32 + halo).min(self.rays.height as i32)
    }

    /// The lit ranges of rays.
    pub fn entries(&self) -> Entries<'_> {
        Entries {
            sublayer_of: self.sublayer_of,
            parts: self.parts,
            raise: &self.compensations.raise,
        }
    }

    /// Calls `emit` for every change in these rows of the extended rays, given the pixel of each ray.
    pub fn changes(
        &self,
        rows: Range<usize>,
        pixel_of: impl Fn(usize, usize) -> u32,
        mut emit: impl FnMut(Change),
    ) {
        let steps = self.steps();
        let mut source = Rows::new(self, self.around(&rows, &steps), Part::Raised);
        let mut last: Vec<Vec<Stretch>> = vec![Vec::new(); rows.len()];
        let mut last_step = None;
        let width = self.rays.width as i32;
        for sublayer in 0..source.sublayers() {
            let changed = source.advance(sublayer);
            let step = &steps[sublayer as usize / self.parts as usize];
            let is_new_step = last_step != Some(step);
            last_step = Some(step);
            for row in rows.clone() {
                let near = row as i32 - step.reach()..row as i32 + step.reach() + 1;
                if !is_new_step && !changed.iter().any(|row| near.contains(row)) {
                    continue;
                }
                let now = step.row(&source, row as i32, width);
                let before = &mut last[row - rows.start];
                for_each_difference(before, &now, |columns, is_on| {
                    for column in columns {
                        let pixel = pixel_of(row, column as usize);
                        let sign = if is_on { 1 } else { -1 };
                        each_change(sublayer, self.parts, sign, Span::of(pixel), &mut emit);
                    }
                });
                *before = now;
            }
        }
    }
}

/// Rows as read from the rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// All that stays lit where surfaces that face down are moved up.
    Raised,
    /// The same with stretches of rays of which nothing would be left, as they are.
    Whole,
}

/// The lit stretches of rows of rays, sublayer by sublayer.
pub(super) struct Rows {
    first: i32,
    /// For each row, the columns at which the light changes: an even number.
    edges: Vec<Vec<i32>>,
    stretches: Vec<Vec<Stretch>>,
    /// Flips of rays, sorted by sublayer: row and column.
    flips: Vec<(u32, i32, i32)>,
    next: usize,
    sublayers: u32,
}

impl Rows {
    pub fn new(compensated: &Compensated<'_>, rows: Range<i32>, part: Part) -> Self {
        let (image, entries) = (compensated.image, compensated.entries());
        let sublayers = compensated.compensations.xy_mm.len() as u32 * compensated.parts;
        let [left, above] = compensated.offset.map(|side| side as i32);
        let width = image.grid.width as usize;
        let mut flips = Vec::new();
        let mut ranges = Column::new();
        let within = |row: i32| (row - above).clamp(0, image.grid.height as i32) as u32;
        let ray_rows = within(rows.start)..within(rows.end);
        for first in ray_rows.clone().step_by(ROWS_AT_ONCE as usize) {
            let held = image.of(first..(first + ROWS_AT_ONCE).min(ray_rows.end));
            for (ray, hits) in held.rays().each().enumerate() {
                let row = first as i32 + (ray / width) as i32 + above;
                let column = (ray % width) as i32 + left;
                entries.each(hits, image.classes, &mut ranges, |mut on, off, unraised| {
                    if part == Part::Whole && off <= on {
                        on = unraised;
                    }
                    if on < off {
                        flips.push((on, row, column));
                        flips.push((off, row, column));
                    }
                });
            }
        }
        // Within a sublayer they are sorted as they were found: by row, then by column.
        let flips = sorted_by_sublayer(&flips, sublayers);
        Self {
            first: rows.start,
            edges: vec![Vec::new(); rows.len()],
            stretches: vec![Vec::new(); rows.len()],
            flips,
            next: 0,
            sublayers,
        }
    }

    pub fn sublayers(&self) -> u32 {
        self.sublayers
    }

    /// Moves on to the next sublayer, and returns the rows that changed.
    pub fn advance(&mut self, sublayer: u32) -> Vec<i32> {
        let mut changed = Vec::new();
        let rest = &self.flips[self.next..];
        let here = &rest[..rest.partition_point(|flip| flip.0 <= sublayer)];
        self.next += here.len();
        for flips in here.chunk_by(|a, b| a.1 == b.1) {
            let row = flips[0].1;
            let edges = &mut self.edges[(row - self.first) as usize];
            // Both sides of each ray change, unless it changes twice.
            let rays = flips.chunk_by(|a, b| a.2 == b.2);
            let rays = rays.filter(|flips| flips.len() % 2 == 1);
            let sides = rays.flat_map(|flips| [flips[0].2, flips[0].2 + 1]);
            *edges = toggled(edges, sides);
            let stretches = &mut self.stretches[(row - self.first) as usize];
            stretches.clear();
            stretches.extend(edges.chunks_exact(2).map(|pair| pair[0]..pair[1]));
            changed.push(row);
        }
        changed
    }

    pub fn row(&self, row: i32) -> &[Stretch] {
        let place: Result<usize, _> = (row - self.first).try_into();
        place
            .ok()
            .and_then(|place| self.stretches.get(place))
            .map_or(&[], Vec::as_slice)
    }
}

/// Flips of the sublayers, by a counting sort.
fn sorted_by_sublayer(flips: &[(u32, i32, i32)], sublayers: u32) -> Vec<(u32, i32, i32)> {
    // Flips above the last sublayer belong to none.
    let within = || flips.iter().filter(|flip| flip.0 < sublayers);
    let mut starts = vec![0; sublayers as usize + 1];
    for flip in within() {
        starts[flip.0 as usize + 1] += 1;
    }
    for sublayer in 1..starts.len() {
        starts[sublayer] += starts[sublayer - 1];
    }
    let mut sorted = vec![(0, 0, 0); starts[sublayers as usize]];
    for &flip in within() {
        let slot = &mut starts[flip.0 as usize];
        sorted[*slot] = flip;
        *slot += 1;
    }
    sorted
}

/// The places that are in one of two sorted lists an odd number of times in all.
fn toggled(edges: &[i32], sides: impl Iterator<Item = i32>) -> Vec<i32> {
    let mut result: Vec<i32> = Vec::with_capacity(edges.len() + 2);
    let mut toggle = |place: i32| match result.last() {
        Some(&last) if last == place => drop(result.pop()),
        _ => result.push(place),
    };
    let mut rest = edges.iter().copied().peekable();
    for side in sides {
        while let Some(edge) = rest.next_if(|&edge| edge <= side) {
            toggle(edge);
        }
        toggle(side);
    }
    rest.for_each(toggle);
    result
}

/// Calls `emit(columns, is_on)` for the columns that are lit in one list and dark in the other.
fn for_each_difference(before: &[Stretch], now: &[Stretch], mut emit: impl FnMut(Stretch, bool)) {
    let ends = |stretches: &[Stretch]| -> Vec<i32> {
        stretches.iter().flat_map(|it| [it.start, it.end]).collect()
    };
    let (a, b) = (ends(before), ends(now));
    let (mut i, mut j, mut from) = (0, 0, 0);
    while i < a.len() || j < b.len() {
        let at = match (a.get(i), b.get(j)) {
            (Some(&x), Some(&y)) => x.min(y),
            (Some(&x), None) | (None, Some(&x)) => x,
            (None, None) => break,
        };
        let (was, is) = (i % 2 == 1, j % 2 == 1);
        if was != is && from < at {
            emit(from..at, is);
        }
        i += usize::from(a.get(i) == Some(&at));
        j += usize::from(b.get(j) == Some(&at));
        from = at;
    }
}
