//! The masks of a plate: those of each model, at the places of its copies.
//!
//! Copies stand whole pixels apart, so they share rays, changes and runs: a layer of a model is read once, and its runs are
//! moved to each place.

use super::{LayerRuns, MaskCursor, Masks, ReadPlace, Run, RunReader, RunSource, row_bytes};
use crate::argsort::sort_by_number;
use crate::grid::Grid;
use crate::parallel;

/// The masks of a model, and where its copies stand.
#[derive(Debug, Clone)]
pub struct Stamp {
    /// The masks of the model as if it stood alone at the middle of the screen.
    pub masks: Masks,
    /// For each copy, columns to the right and rows downward from there, as the screen shows them.
    pub offsets: Vec<[i32; 2]>,
}

/// The masks of several models on one screen. Copies must not overlap or extend beyond the screen.
#[derive(Debug, Clone)]
pub struct PlateMasks {
    /// The pixels of the screen.
    pub grid: Grid,
    /// The models.
    pub stamps: Vec<Stamp>,
}

impl PlateMasks {
    /// The masks of a single copy in the middle, which are those of the screen.
    fn alone(&self) -> Option<&Masks> {
        let [stamp] = &self.stamps[..] else {
            return None;
        };
        (stamp.offsets == [[0, 0]]).then_some(&stamp.masks)
    }

    /// The runs of all masks.
    pub fn runs(&self) -> PlateRuns<'_> {
        let stamps = self.stamps.iter();
        PlateRuns {
            grid: self.grid,
            stamps: stamps
                .map(|stamp| (&stamp.masks as &dyn RunSource, stamp.offsets.clone()))
                .collect(),
        }
    }

    /// The mask of a layer: see [`MaskCursor::whole`]. `cursors` are those of the stamps, and are moved to the layer.
    pub fn whole(&self, cursors: &mut [MaskCursor], layer: usize) -> Vec<u8> {
        if let (Some(masks), [cursor]) = (self.alone(), &mut *cursors) {
            cursor.seek(masks, layer);
            return cursor.whole(masks);
        }
        let row_bytes = row_bytes(&self.grid);
        let mut whole = vec![0; row_bytes * self.grid.height as usize];
        for (stamp, cursor) in self.stamps.iter().zip(cursors) {
            cursor.seek(&stamp.masks, layer);
            let alone = cursor.whole(&stamp.masks);
            let (window, rows) = (stamp.masks.window, alone.chunks(row_bytes).enumerate());
            let rows = rows.skip(window.first_row).take(window.rows);
            for (row, bytes) in rows {
                for (first, pixels) in bit_runs(&bytes[window.first_byte..][..window.row_bytes]) {
                    let first = (first + window.first_byte * 8) as i64;
                    for &[right, down] in &stamp.offsets {
                        let start = first + i64::from(right);
                        let row = row as i64 + i64::from(down);
                        light(
                            &mut whole[row as usize * row_bytes..],
                            start as usize,
                            pixels,
                        );
                    }
                }
            }
        }
        whole
    }
}

/// The first bit and the length of each run of ones, most significant bits first.
fn bit_runs(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = None;
    for (place, &byte) in bytes.iter().enumerate() {
        let goes_on = if start.is_some() { 0xff } else { 0 };
        if byte == goes_on {
            continue;
        }
        for bit in 0..8 {
            let is_lit = byte & 0x80 >> bit != 0;
            let pixel = place * 8 + bit;
            match (start, is_lit) {
                (None, true) => start = Some(pixel),
                (Some(first), false) => {
                    runs.push((first, pixel - first));
                    start = None;
                }
                _ => {}
            }
        }
    }
    runs.extend(start.map(|first| (first, bytes.len() * 8 - first)));
    runs
}

/// Sets bits of a row.
fn light(row: &mut [u8], first: usize, pixels: usize) {
    for pixel in first..first + pixels {
        row[pixel / 8] |= 0x80 >> (pixel % 8);
    }
}

/// The runs of several models on one screen, where their copies stand: see [`Stamp::offsets`].
pub struct PlateRuns<'a> {
    /// The pixels of the screen.
    pub grid: Grid,
    /// Each model as if it stood alone at the middle of the screen, and its copies.
    pub stamps: Vec<(&'a dyn RunSource, Vec<[i32; 2]>)>,
}

impl RunSource for PlateRuns<'_> {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        if let [(alone, offsets)] = &self.stamps[..]
            && *offsets == [[0, 0]]
        {
            return alone.reader();
        }
        let readers = self.stamps.iter().map(|(runs, _)| runs.reader());
        Box::new(Reader {
            plate: self,
            readers: readers.collect(),
        })
    }
}

struct Reader<'a> {
    plate: &'a PlateRuns<'a>,
    readers: Vec<Box<dyn RunReader + 'a>>,
}

impl RunReader for Reader<'_> {
    /// Cost: linear in the runs of all copies, and in rows times the copies that cross them.
    fn next(&mut self, layers: usize) -> LayerRuns {
        let readers = self.readers.iter_mut();
        let alone: Vec<LayerRuns> = readers.map(|reader| reader.next(layers)).collect();
        let offsets: Vec<_> = self.plate.stamps.iter().map(|stamp| &stamp.1[..]).collect();
        stamped(self.plate.grid.width, &offsets, &alone, layers)
    }
}

/// Position of a reader in the masks of a plate.
pub struct PlateReadPlace(Vec<ReadPlace>);

impl PlateReadPlace {
    /// At the first layer.
    pub fn new(masks: &PlateMasks) -> Self {
        let stamps = masks.stamps.iter();
        Self(stamps.map(|stamp| ReadPlace::new(&stamp.masks)).collect())
    }

    /// The runs of the next layers of the same masks: see [`RunReader::next`].
    pub fn next(&mut self, masks: &PlateMasks, layers: usize) -> LayerRuns {
        if let (Some(alone), [place]) = (masks.alone(), &mut self.0[..]) {
            return place.next(alone, layers);
        }
        let stamps = masks.stamps.iter().zip(&mut self.0);
        let alone: Vec<LayerRuns> = stamps
            .map(|(stamp, place)| place.next(&stamp.masks, layers))
            .collect();
        let offsets: Vec<_> = masks.stamps.iter().map(|it| &it.offsets[..]).collect();
        stamped(masks.grid.width, &offsets, &alone, layers)
    }
}

/// The runs of layers of a screen this wide, given the places of each model's copies and its runs alone.
fn stamped(width: u32, offsets: &[&[[i32; 2]]], alone: &[LayerRuns], layers: usize) -> LayerRuns {
    LayerRuns::new(parallel::map((0..layers).collect(), |layer| {
        let runs = alone.iter().map(|runs| runs.of_layer(layer).collect());
        stamped_layer(width, offsets, &runs.collect::<Vec<_>>())
    }))
}

/// The runs of a copy that are still to be placed.
#[derive(Clone)]
struct Copy<'a> {
    runs: &'a [Run],
    /// Pixels from the copy alone to its place, counted row by row.
    offset: i64,
}

impl Copy<'_> {
    /// The place of the next run.
    fn next(&self) -> Option<u32> {
        let run = self.runs.first()?;
        Some((i64::from(run.first) + self.offset) as u32)
    }
}

/// The same of one layer.
fn stamped_layer(width: u32, offsets: &[&[[i32; 2]]], alone: &[Vec<Run>]) -> Vec<Run> {
    let mut waiting: Vec<Copy<'_>> = Vec::new();
    for (offsets, runs) in offsets.iter().zip(alone) {
        waiting.extend(offsets.iter().map(|&[right, down]| Copy {
            runs,
            offset: i64::from(down) * i64::from(width) + i64::from(right),
        }));
    }
    waiting.retain(|copy| !copy.runs.is_empty());
    // The copy that begins lowest in the list begins highest on the screen.
    sort_by_number(&mut waiting, |copy| {
        copy.next().map_or(0.0, |next| -f64::from(next))
    });
    let mut placed = Vec::with_capacity(waiting.iter().map(|copy| copy.runs.len()).sum());
    let mut crossing: Vec<Copy<'_>> = Vec::new();
    loop {
        let next = |copies: &[Copy<'_>]| copies.iter().filter_map(Copy::next).min();
        let soonest = next(&crossing)
            .into_iter()
            .chain(waiting.last().and_then(Copy::next));
        let Some(first) = soonest.min() else {
            return placed;
        };
        let row_end = (first / width + 1) * width;
        while waiting
            .last()
            .is_some_and(|copy| copy.next() < Some(row_end))
        {
            crossing.extend(waiting.pop());
        }
        let row_start = placed.len();
        for copy in &mut crossing {
            let in_row = |run: &Run| i64::from(run.first) + copy.offset < i64::from(row_end);
            let count = copy.runs.partition_point(in_row);
            let (row, rest) = copy.runs.split_at(count);
            placed.extend(row.iter().map(|run| Run {
                first: (i64::from(run.first) + copy.offset) as u32,
                ..*run
            }));
            copy.runs = rest;
        }
        crossing.retain(|copy| !copy.runs.is_empty());
        let row = &mut placed[row_start..];
        if !row.is_sorted_by_key(|run| run.first) {
            row.sort_unstable_by_key(|run| run.first);
        }
    }
}
