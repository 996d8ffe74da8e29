//! Layer masks: which pixels are lit (section 3.4), one mask in memory at a time.
//!
//! From layer to layer only those pixels change whose surface lies between the two sampling
//! heights. All masks together are therefore a list of changes, sorted by layer, as long as the list of
//! hits; no mask is ever computed from scratch.

mod samples;
mod window;

use std::ops::Range;

pub use samples::{LEVELS, Samples};
pub use window::{Side, Window};

use crate::grid::Grid;
use crate::ldi::{Ldi, Solid, printed_ranges};
use crate::parallel;
use crate::plan::Plan;
use samples::SublayerOf;
use window::Place;

/// Rows of rays whose changes are sorted together, by one thread.
const BAND_ROWS: usize = 128;

/// The masks of all layers of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Masks {
    /// The pixels.
    pub grid: Grid,
    /// What the light of a pixel is averaged over.
    pub samples: Samples,
    /// The part of the pixels that the model is in; all others are dark in every layer.
    pub window: Window,
    layers: usize,
    /// Changes from the topmost rows down.
    bands: Vec<Band>,
}

/// What changes between layers in some rows.
#[derive(Debug, Clone, PartialEq)]
struct Band {
    /// The changes of layer k are those from `starts[k]` to `starts[k + 1]`.
    starts: Vec<u32>,
    /// Pixels of the window that change from the layer below.
    pixels: Vec<u32>,
    /// By how many samples each changes; empty where a pixel has one, which can but flip.
    by: Vec<i8>,
}

impl Masks {
    /// The masks of `plan` on `grid`, of whose samples the rays of `ldi` are all or a part ([`Grid::refined`]): a sample
    /// is lit where the middle of its part of the layer lies inside the solid, from an entry (included) to an exit
    /// (excluded).
    ///
    /// Cost: linear in rays and hits; memory is 4 bytes a change, of which there are at most as many as hits, or with
    /// several samples 5 bytes and twice as many.
    pub fn new(ldi: &Ldi, plan: &Plan, grid: &Grid, samples: Samples, side: Side) -> Self {
        let sublayer_of = SublayerOf::new(plan, samples.sublayers);
        let layers = plan.layers();
        let place = Place::new(&ldi.grid, grid, samples, side);
        let rows = ldi.grid.height as usize;
        let firsts = (0..rows).step_by(BAND_ROWS).collect();
        let bands = parallel::map(firsts, |first| {
            let rows = first..(first + BAND_ROWS).min(rows);
            Band::new(ldi, &sublayer_of, layers, samples, &place, rows)
        });
        Self {
            grid: *grid,
            samples,
            window: place.window,
            layers,
            bands,
        }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// A cursor at the first layer.
    pub fn cursor(&self) -> MaskCursor {
        let Window {
            row_bytes, rows, ..
        } = self.window;
        let light = if self.samples == Samples::ONE {
            Light::Bits(vec![0; row_bytes * rows])
        } else {
            Light::Samples(vec![0; self.window.row_pixels() * rows])
        };
        let mut cursor = MaskCursor {
            light,
            lit_pixels: 0,
            layer: 0,
        };
        cursor.change(self, 0, 1);
        cursor
    }
}

/// The layers of `plan` in whose masks no pixel has any light, from 0: those with no sampled height at which the solid
/// has a section ([`Solid::heights_mm`]).
///
/// Cost: linear in layers and height ranges; no mask is made.
pub fn black_layers(solid: &Solid, plan: &Plan, samples: Samples) -> Vec<usize> {
    let sublayer_of = SublayerOf::new(plan, samples.sublayers);
    let parts = samples.sublayers;
    let mut black = Vec::new();
    let mut next = 0;
    for &(z_in, z_out) in &solid.heights_mm {
        let on = sublayer_of.first_above(z_in);
        let off = sublayer_of.first_above(z_out);
        if on < off {
            black.extend(next..on / parts);
            next = next.max(off.div_ceil(parts));
        }
    }
    black.extend(next..plan.layers() as u32);
    black.into_iter().map(|layer| layer as usize).collect()
}

/// A pixel of the window and how many more of its samples a layer has lit than the one below.
struct Change {
    layer: u32,
    pixel: u32,
    by: i8,
}

impl Band {
    /// Finds the changes, counts those of each layer, then puts them in their places.
    fn new(
        ldi: &Ldi,
        sublayer_of: &SublayerOf,
        layers: usize,
        samples: Samples,
        place: &Place,
        rows: Range<usize>,
    ) -> Self {
        let width = ldi.grid.width as usize;
        let parts = samples.sublayers;
        let mut changes: Vec<Change> = Vec::new();
        for row in rows {
            for (column, &in_row) in place.columns.iter().enumerate() {
                let pixel = place.rows[row] + in_row;
                printed_ranges(ldi.ray(row * width + column), ldi.classes, |z_in, z_out| {
                    let on = sublayer_of.first_above(z_in);
                    let off = sublayer_of.first_above(z_out);
                    if on == off {
                        return;
                    }
                    for (sublayer, sign) in [(on, 1), (off, -1)] {
                        let (layer, below) = (sublayer / parts, sublayer % parts);
                        let mut change = |layer, parts: u32| {
                            let by = sign * parts as i8;
                            changes.push(Change { layer, pixel, by });
                        };
                        change(layer, parts - below);
                        if below > 0 {
                            change(layer + 1, below);
                        }
                    }
                });
            }
        }
        // What goes dark above the last layer is of no interest.
        changes.retain(|change| (change.layer as usize) < layers);
        // One slot ahead, so that filling moves the start of each layer to its place.
        let mut starts = vec![0u32; layers + 2];
        for change in &changes {
            starts[change.layer as usize + 2] += 1;
        }
        for layer in 2..starts.len() {
            starts[layer] += starts[layer - 1];
        }
        let is_one = samples == Samples::ONE;
        let mut pixels = vec![0u32; changes.len()];
        let mut by = vec![0i8; if is_one { 0 } else { changes.len() }];
        for change in &changes {
            let slot = &mut starts[change.layer as usize + 1];
            pixels[*slot as usize] = change.pixel;
            if !is_one {
                by[*slot as usize] = change.by;
            }
            *slot += 1;
        }
        starts.truncate(layers + 1);
        Self { starts, pixels, by }
    }

    fn of_layer(&self, layer: usize) -> Range<usize> {
        self.starts[layer] as usize..self.starts[layer + 1] as usize
    }
}

/// The light in the window of a mask, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Light {
    /// One bit a pixel, most significant first; 1 is lit.
    Bits(Vec<u8>),
    /// Lit samples of each pixel, a byte each.
    Samples(Vec<u8>),
}

/// The mask of one layer, movable to any other: changes work both ways.
#[derive(Debug, Clone)]
pub struct MaskCursor {
    light: Light,
    lit_pixels: u64,
    layer: usize,
}

impl MaskCursor {
    /// Moves to a layer of `masks`, the ones that this cursor was made from, at a cost of the pixels
    /// that change on the way.
    pub fn seek(&mut self, masks: &Masks, layer: usize) {
        while self.layer < layer {
            self.layer += 1;
            self.change(masks, self.layer, 1);
        }
        while self.layer > layer {
            self.change(masks, self.layer, -1);
            self.layer -= 1;
        }
    }

    /// The window of the mask.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// The whole mask: one bit a pixel, most significant first, rows padded to whole bytes; 1 is lit, with several
    /// samples at least half.
    pub fn whole(&self, masks: &Masks) -> Vec<u8> {
        let Masks { grid, window, .. } = masks;
        let row_bytes = row_bytes(grid);
        let mut whole = vec![0; row_bytes * grid.height as usize];
        let first = window.first_row * row_bytes + window.first_byte;
        let rows = whole[first..].chunks_mut(row_bytes);
        match &self.light {
            Light::Bits(bits) => {
                for (row, bits) in rows.zip(bits.chunks(window.row_bytes)) {
                    row[..bits.len()].copy_from_slice(bits);
                }
            }
            Light::Samples(samples) => {
                let half = masks.samples.total().div_ceil(2) as u8;
                for (row, samples) in rows.zip(samples.chunks(window.row_pixels())) {
                    for (byte, pixels) in row.iter_mut().zip(samples.chunks(8)) {
                        *byte = pixels
                            .iter()
                            .fold(0, |byte, &pixel| byte << 1 | u8::from(pixel >= half));
                    }
                }
            }
        }
        whole
    }

    /// Number of pixels with any light.
    pub fn lit_pixels(&self) -> u64 {
        self.lit_pixels
    }

    fn change(&mut self, masks: &Masks, layer: usize, sign: i8) {
        for band in &masks.bands {
            let changes = band.of_layer(layer);
            match &mut self.light {
                Light::Bits(bits) => {
                    for &pixel in &band.pixels[changes] {
                        let byte = &mut bits[pixel as usize / 8];
                        let bit = 0x80 >> (pixel % 8);
                        *byte ^= bit;
                        if *byte & bit == 0 {
                            self.lit_pixels -= 1;
                        } else {
                            self.lit_pixels += 1;
                        }
                    }
                }
                Light::Samples(samples) => {
                    for (&pixel, &by) in band.pixels[changes.clone()].iter().zip(&band.by[changes])
                    {
                        let lit = &mut samples[pixel as usize];
                        self.lit_pixels -= u64::from(*lit > 0);
                        *lit = lit.wrapping_add_signed(sign * by);
                        self.lit_pixels += u64::from(*lit > 0);
                    }
                }
            }
        }
    }
}

/// Bytes of a row of a one-bit mask.
pub fn row_bytes(grid: &Grid) -> usize {
    grid.width.div_ceil(8) as usize
}
