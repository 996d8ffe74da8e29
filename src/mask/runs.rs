//! Masks as runs of lit pixels, straight from the changes between layers.
//!
//! A run begins where a pixel differs from the one to its left. Two edges for every span of changed pixels are all that a new
//! layer costs, and two levels of bits find the edges without looking at the pixels between them.

use std::ops::Range;
use std::sync::Arc;

use super::{Band, Masks, Samples, Window};
use crate::parallel;

/// Consecutive pixels of a row with the same light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// The first pixel, counted row by row from the top left of the screen.
    pub first: u32,
    /// Number of pixels.
    pub pixels: u32,
    /// Their brightness, 1 to 255.
    pub grey: u8,
}

/// The runs of consecutive layers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerRuns {
    /// By bands of rows, from the top row down.
    bands: Vec<BandRuns>,
    layers: usize,
}

/// The runs of consecutive layers in a band of rows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct BandRuns {
    /// The end of each layer in `runs`.
    ends: Vec<usize>,
    runs: Vec<Run>,
}

impl LayerRuns {
    /// Collects the runs of each layer, sorted, none across the end of a row.
    pub fn new(layers: impl IntoIterator<Item = Vec<Run>>) -> Self {
        let mut band = BandRuns::default();
        for layer in layers {
            band.runs.extend(layer);
            band.ends.push(band.runs.len());
        }
        Self {
            layers: band.ends.len(),
            bands: vec![band],
        }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// Layers that follow each other, in the same bands.
    pub(super) fn joined(parts: Vec<Self>) -> Self {
        let joined = parts.into_iter().reduce(|mut all, following| {
            all.layers += following.layers;
            for (band, following) in all.bands.iter_mut().zip(following.bands) {
                let runs = band.runs.len();
                let ends = following.ends.iter().map(|end| runs + end);
                band.ends.extend(ends);
                band.runs.extend(following.runs);
            }
            all
        });
        joined.unwrap_or_else(|| Self::new([]))
    }

    /// The runs as numbers, for another worker of the same build.
    pub fn to_words(&self) -> Vec<u32> {
        let runs: usize = self.bands.iter().map(|band| band.runs.len()).sum();
        let mut words = Vec::with_capacity(1 + self.bands.len() * self.layers + 3 * runs);
        words.push(self.layers as u32);
        for band in &self.bands {
            words.extend(band.ends.iter().map(|&end| end as u32));
            for run in &band.runs {
                words.extend([run.first, run.pixels, u32::from(run.grey)]);
            }
        }
        words
    }

    /// The runs of [`Self::to_words`]; `None` of other numbers.
    pub fn of_words(words: &[u32]) -> Option<Self> {
        let (&layers, mut rest) = words.split_first()?;
        let layers = layers as usize;
        let mut bands = Vec::new();
        while !rest.is_empty() && layers > 0 {
            let (ends, runs) = rest.split_at_checked(layers)?;
            if !ends.is_sorted() {
                return None;
            }
            let (runs, after) = runs.split_at_checked(3 * *ends.last()? as usize)?;
            rest = after;
            let (runs, _) = runs.as_chunks::<3>();
            let run = |&[first, pixels, grey]: &[u32; 3]| Run {
                first,
                pixels,
                grey: grey as u8,
            };
            bands.push(BandRuns {
                ends: ends.iter().map(|&end| end as usize).collect(),
                runs: runs.iter().map(run).collect(),
            });
        }
        Some(Self { bands, layers })
    }

    /// The lit runs of a layer, row by row; no run goes on in the next row.
    pub fn of_layer(&self, layer: usize) -> impl Iterator<Item = Run> {
        self.bands.iter().flat_map(move |band| {
            let first = layer.checked_sub(1).map_or(0, |below| band.ends[below]);
            band.runs[first..band.ends[layer]].iter().copied()
        })
    }
}

/// Layers that can be read as runs, from the first to the last.
pub trait RunSource: Sync {
    /// A reader at the first layer.
    fn reader(&self) -> Box<dyn RunReader + '_>;
}

/// Reads runs layer by layer.
pub trait RunReader {
    /// The runs of the next layers: as many as are asked for, which must not be more than there are.
    fn next(&mut self, layers: usize) -> LayerRuns;
}

impl RunSource for Masks {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        Box::new(Reader {
            masks: self,
            place: ReadPlace::new(self),
        })
    }
}

impl<T: RunSource + Send> RunSource for Arc<T> {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        (**self).reader()
    }
}

struct Reader<'a> {
    masks: &'a Masks,
    place: ReadPlace,
}

impl RunReader for Reader<'_> {
    fn next(&mut self, layers: usize) -> LayerRuns {
        self.place.next(self.masks, layers)
    }
}

/// Position of a reader in the masks.
pub struct ReadPlace {
    states: Vec<State>,
    next: usize,
}

impl ReadPlace {
    /// At the first layer.
    pub fn new(masks: &Masks) -> Self {
        let bands = masks.bands.iter();
        Self {
            states: bands.map(|band| State::new(band, masks.samples)).collect(),
            next: 0,
        }
    }

    /// Number of layers of the masks that are left.
    pub(super) fn left(&self, masks: &Masks) -> usize {
        masks.layers - self.next
    }

    /// Goes on at the first layer of masks that follow: their changes apply to the last layer that was read.
    pub(super) fn restarted(self) -> Self {
        Self { next: 0, ..self }
    }

    /// The runs of the next layers of the same masks: see [`RunReader::next`].
    ///
    /// Cost: linear in the changes and in the runs. Bands are read in parallel.
    pub fn next(&mut self, masks: &Masks, layers: usize) -> LayerRuns {
        let range = self.next..self.next + layers;
        self.next = range.end;
        let greys = greys(masks.samples);
        let bands = masks.bands.iter().zip(self.states.drain(..)).collect();
        let read = parallel::map(bands, |(band, mut state)| {
            let place = Place::new(masks, band);
            let mut found = BandRuns::default();
            for layer in range.clone() {
                state.change(band, layer);
                state.collect(&place, &greys, &mut found.runs);
                found.ends.push(found.runs.len());
            }
            (state, found)
        });
        let bands;
        (self.states, bands) = read.into_iter().unzip();
        LayerRuns { bands, layers }
    }
}

/// The brightness of a pixel for each number of its lit samples.
fn greys(samples: Samples) -> Vec<u8> {
    let total = samples.total();
    (0..=total)
        .map(|lit| ((255 * lit + total / 2) / total) as u8)
        .collect()
}

/// Position of a band's pixels on the screen.
struct Place {
    /// Pixels of each row of the window.
    row_pixels: u32,
    /// The first row of the band on the screen.
    first_row: u32,
    /// The first column of the window on the screen.
    first_column: u32,
    /// Columns of the screen.
    width: u32,
}

impl Place {
    fn new(masks: &Masks, band: &Band) -> Self {
        let Window {
            first_byte,
            first_row,
            ..
        } = masks.window;
        let row_pixels = masks.window.row_pixels() as u32;
        Self {
            row_pixels,
            first_row: first_row as u32 + band.area.start / row_pixels,
            first_column: first_byte as u32 * 8,
            width: masks.grid.width,
        }
    }
}

/// The light of a band at a layer.
struct State {
    edges: Edges,
    /// The number of lit samples of each pixel. Empty if pixels have a single sample: an edge then always is a flip.
    lit: Vec<u8>,
}

impl State {
    fn new(band: &Band, samples: Samples) -> Self {
        let pixels = band.area.len();
        Self {
            edges: Edges::new(pixels + 1),
            lit: vec![0; if samples == Samples::ONE { 0 } else { pixels }],
        }
    }

    fn change(&mut self, band: &Band, layer: usize) {
        let changes = band.of_layer(layer);
        let spans = &band.spans[changes.clone()];
        if self.lit.is_empty() {
            for span in spans {
                let Range { start, end } = span.range();
                self.edges.flip(start as usize);
                self.edges.flip(end as usize);
            }
            return;
        }
        let spans = spans.iter().zip(&band.by[changes]);
        let pixels = spans.flat_map(|(span, &by)| span.range().map(move |pixel| (pixel, by)));
        for (pixel, by) in pixels {
            let place = pixel as usize;
            let old = self.lit[place];
            let new = old.wrapping_add_signed(by);
            self.lit[place] = new;
            let left = place.checked_sub(1).map_or(0, |left| self.lit[left]);
            let right = self.lit.get(place + 1).copied().unwrap_or(0);
            for (edge, other) in [(place, left), (place + 1, right)] {
                if (old == other) != (new == other) {
                    self.edges.flip(edge);
                }
            }
        }
    }

    fn collect(&self, place: &Place, greys: &[u8], runs: &mut Vec<Run>) {
        let mut row = 0;
        let mut row_end = place.row_pixels;
        // Runs of the band that go on in the next row are cut at its end.
        let mut add = |mut start: u32, end: u32, grey: u8| {
            while start < end {
                while start >= row_end {
                    row += 1;
                    row_end += place.row_pixels;
                }
                let stop = end.min(row_end);
                let column = place.first_column + start + place.row_pixels - row_end;
                runs.push(Run {
                    first: (place.first_row + row) * place.width + column,
                    pixels: stop - start,
                    grey,
                });
                start = stop;
            }
        };
        let mut from = 0;
        if self.lit.is_empty() {
            let mut is_lit = false;
            self.edges.each(|edge| {
                if is_lit {
                    add(from, edge, 255);
                }
                is_lit = !is_lit;
                from = edge;
            });
            return;
        }
        self.edges.each(|edge| {
            let lit = self.lit[from as usize];
            if lit > 0 {
                add(from, edge, greys[usize::from(lit)]);
            }
            from = edge;
        });
    }
}

/// A set of places, with a bit for each word of 64 places that holds one.
struct Edges {
    words: Vec<u64>,
    filled: Vec<u64>,
}

impl Edges {
    fn new(places: usize) -> Self {
        let words = places.div_ceil(64);
        Self {
            words: vec![0; words],
            filled: vec![0; words.div_ceil(64)],
        }
    }

    fn flip(&mut self, place: usize) {
        let word = place / 64;
        self.words[word] ^= 1 << (place % 64);
        let bit = 1 << (word % 64);
        if self.words[word] == 0 {
            self.filled[word / 64] &= !bit;
        } else {
            self.filled[word / 64] |= bit;
        }
    }

    /// Calls `take` with each place of the set, in ascending order.
    fn each(&self, mut take: impl FnMut(u32)) {
        for (index, &filled) in self.filled.iter().enumerate() {
            each_one(filled, index, |word| {
                each_one(self.words[word as usize], word as usize, &mut take);
            });
        }
    }
}

/// Calls `take` with the places of the ones of the word at `index`.
fn each_one(mut bits: u64, index: usize, mut take: impl FnMut(u32)) {
    while bits != 0 {
        take(index as u32 * 64 + bits.trailing_zeros());
        bits &= bits - 1;
    }
}
