//! Masks that make up for the growth of the print: shrunk in x and y, and later where surfaces face down.
//!
//! A ray stays lit at a height if all rays within the radius are lit there. Rows of rays are lists of lit stretches; a row of
//! the result is the intersection of its neighbours', each shortened by the width of the disc in that row. Growing is the
//! union of stretches made longer.

use std::ops::Range;

use super::samples::SublayerOf;
use super::{Change, each_change};
use crate::grid::Grid;
use crate::ldi::{Ldi, printed_ranges};

/// What masks make up for.
#[derive(Debug, Clone, PartialEq)]
pub struct Shrinking {
    /// For each layer, by how much lit areas shrink on each side, in millimetres; negative: grow.
    pub xy_mm: Vec<f64>,
    /// By how much surfaces that face down move up, in millimetres.
    pub z_mm: f64,
}

/// A lit stretch of a row of rays.
type Stretch = Range<i32>;

/// A radius this close to a whole number of pixels, as a fraction of it, counts as whole.
const ROUNDING: f64 = 1e-9;

/// The rays of a disc: for each row from its middle, the number of columns on each side.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Disc {
    half_widths: Vec<i32>,
}

impl Disc {
    fn new(radius_mm: f64, grid: &Grid) -> Self {
        let radius_mm = radius_mm.abs() * (1.0 + ROUNDING);
        let rows = (radius_mm / grid.pitch_y_mm) as i32;
        let half_widths = (0..=rows).map(|row| {
            let y_mm = f64::from(row) * grid.pitch_y_mm;
            let x_mm = (radius_mm * radius_mm - y_mm * y_mm).max(0.0).sqrt();
            (x_mm / grid.pitch_mm) as i32
        });
        Self {
            half_widths: half_widths.collect(),
        }
    }

    fn rows(&self) -> i32 {
        self.half_widths.len() as i32 - 1
    }
}

/// Columns and rows by which rays around the model must be extended so that no grown area is cut off.
pub(super) fn margin(shrinking: &Shrinking, grid: &Grid) -> [u32; 2] {
    let most_mm = shrinking
        .xy_mm
        .iter()
        .fold(0.0, |most: f64, mm| most.max(-mm));
    [grid.pitch_mm, grid.pitch_y_mm].map(|pitch_mm| (most_mm / pitch_mm).ceil() as u32)
}

/// Finds the changes in a band of rows.
pub(super) struct Shrink<'a> {
    pub ldi: &'a Ldi,
    pub sublayer_of: &'a SublayerOf,
    pub shrinking: &'a Shrinking,
    /// Sublayers of a layer.
    pub parts: u32,
    /// The rays of the LDI, extended by the margin.
    pub rays: Grid,
    /// Columns and rows of that margin to the left and above.
    pub offset: [u32; 2],
}

impl Shrink<'_> {
    /// The first sublayer of an entry, moved up unless it is in the first layer, as nothing cures below the plate, or the ray
    /// is lit up to it: `last_off` is the sublayer of the exit before.
    fn entry(&self, z_in: f32, last_off: u32) -> u32 {
        let on = self.sublayer_of.first_above(z_in);
        if on < self.parts || on == last_off {
            return on;
        }
        let raised_mm = f64::from(z_in) + self.shrinking.z_mm;
        self.sublayer_of.first_above(raised_mm as f32)
    }

    /// Calls `emit` for every change in these rows of the extended rays, given the pixel of each ray.
    pub fn changes(
        &self,
        rows: Range<usize>,
        pixel_of: impl Fn(usize, usize) -> u32,
        mut emit: impl FnMut(Change),
    ) {
        let discs: Vec<(Disc, bool)> = self
            .shrinking
            .xy_mm
            .iter()
            .map(|&mm| (Disc::new(mm, &self.rays), mm < 0.0))
            .collect();
        let halo = discs.iter().map(|(disc, _)| disc.rows()).max().unwrap_or(0);
        let first = (rows.start as i32 - halo).max(0);
        let end = (rows.end as i32 + halo).min(self.rays.height as i32);
        let mut source = Rows::new(self, first..end);
        let mut last: Vec<Vec<Stretch>> = vec![Vec::new(); rows.len()];
        let mut last_disc = None;
        let width = self.rays.width as i32;
        for sublayer in 0..source.sublayers() {
            let changed = source.advance(sublayer);
            let (disc, grows) = &discs[sublayer as usize / self.parts as usize];
            let is_new_disc = last_disc != Some((disc, grows));
            last_disc = Some((disc, grows));
            for row in rows.clone() {
                let near = row as i32 - disc.rows()..row as i32 + disc.rows() + 1;
                if !is_new_disc && !changed.iter().any(|row| near.contains(row)) {
                    continue;
                }
                let now = if *grows {
                    grown(&source, disc, row as i32, width)
                } else {
                    shrunk(&source, disc, row as i32)
                };
                let before = &mut last[row - rows.start];
                for_each_difference(before, &now, |columns, is_on| {
                    for column in columns {
                        let pixel = pixel_of(row, column as usize);
                        let sign = if is_on { 1 } else { -1 };
                        each_change(sublayer, self.parts, sign, pixel, &mut emit);
                    }
                });
                *before = now;
            }
        }
    }
}

/// The lit stretches of rows of rays, sublayer by sublayer.
struct Rows {
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
    fn new(shrink: &Shrink<'_>, rows: Range<i32>) -> Self {
        let Shrink {
            ldi, sublayer_of, ..
        } = shrink;
        let sublayers = shrink.shrinking.xy_mm.len() as u32 * shrink.parts;
        let [left, above] = shrink.offset.map(|side| side as i32);
        let width = ldi.grid.width as usize;
        let mut flips = Vec::new();
        for row in rows.clone() {
            let Some(ray_row) = (row - above)
                .try_into()
                .ok()
                .filter(|row: &usize| *row < ldi.grid.height as usize)
            else {
                continue;
            };
            for column in 0..width {
                let hits = ldi.ray(ray_row * width + column);
                let mut last_off = 0;
                printed_ranges(hits, ldi.classes, |z_in, z_out| {
                    let on = shrink.entry(z_in, last_off);
                    let off = sublayer_of.first_above(z_out);
                    last_off = off;
                    if on < off {
                        flips.push((on, row, column as i32 + left));
                        flips.push((off, row, column as i32 + left));
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

    fn sublayers(&self) -> u32 {
        self.sublayers
    }

    /// Moves on to the next sublayer, and returns the rows that changed.
    fn advance(&mut self, sublayer: u32) -> Vec<i32> {
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

    fn row(&self, row: i32) -> &[Stretch] {
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

/// The rows of a disc around `row`, and the half width of each.
fn disc_rows(disc: &Disc, row: i32) -> impl Iterator<Item = (i32, i32)> {
    (-disc.rows()..=disc.rows())
        .map(move |step| (row + step, disc.half_widths[step.unsigned_abs() as usize]))
}

fn shrunk(source: &Rows, disc: &Disc, row: i32) -> Vec<Stretch> {
    let mut result: Option<Vec<Stretch>> = None;
    for (row, half_width) in disc_rows(disc, row) {
        let shorter = source.row(row).iter().filter_map(|stretch| {
            let shorter = stretch.start + half_width..stretch.end - half_width;
            (!shorter.is_empty()).then_some(shorter)
        });
        let both = match &result {
            None => shorter.collect(),
            Some(before) => intersection(before, shorter),
        };
        if both.is_empty() {
            return both;
        }
        result = Some(both);
    }
    result.unwrap_or_default()
}

fn intersection(a: &[Stretch], b: impl Iterator<Item = Stretch>) -> Vec<Stretch> {
    let mut result = Vec::new();
    let mut first = 0;
    for stretch in b {
        while a.get(first).is_some_and(|it| it.end <= stretch.start) {
            first += 1;
        }
        for other in a[first..].iter().take_while(|it| it.start < stretch.end) {
            result.push(other.start.max(stretch.start)..other.end.min(stretch.end));
        }
    }
    result
}

fn grown(source: &Rows, disc: &Disc, row: i32, width: i32) -> Vec<Stretch> {
    let mut result = Vec::new();
    for (row, half_width) in disc_rows(disc, row) {
        let longer = source.row(row).iter().map(|stretch| {
            (stretch.start - half_width).max(0)..(stretch.end + half_width).min(width)
        });
        result = union(&result, longer);
    }
    result
}

fn union(a: &[Stretch], b: impl Iterator<Item = Stretch>) -> Vec<Stretch> {
    let mut result: Vec<Stretch> = Vec::with_capacity(a.len() + 1);
    let mut add = |stretch: Stretch| match result.last_mut() {
        Some(last) if stretch.start <= last.end => last.end = last.end.max(stretch.end),
        _ => result.push(stretch),
    };
    let mut rest = a.iter().cloned().peekable();
    for stretch in b {
        while let Some(other) = rest.next_if(|other| other.start <= stretch.start) {
            add(other);
        }
        add(stretch);
    }
    rest.for_each(add);
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
