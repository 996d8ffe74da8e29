//! Layer masks: which pixels are lit (section 3.4), one mask in memory at a time.
//!
//! From layer to layer only those pixels change whose surface lies between the two sampling
//! heights. All masks together are therefore a list of toggles, sorted by layer, as long as the list of
//! hits; no mask is ever computed from scratch.

use std::ops::Range;

use crate::grid::Grid;
use crate::ldi::{Ldi, for_each_solid_range};
use crate::parallel;
use crate::plan::Plan;

/// Rows whose toggles are sorted together, by one thread.
const BAND_ROWS: usize = 128;

/// The masks of all layers of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Masks {
    /// The pixels.
    pub grid: Grid,
    /// The part of them that the model is in; all others are dark in every layer.
    pub window: Window,
    layers: usize,
    /// Toggles from the topmost rows down.
    bands: Vec<Band>,
}

/// A part of a mask, in whole bytes of its rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Bytes of a row left of the part.
    pub first_byte: usize,
    /// Rows above the part.
    pub first_row: usize,
    /// Bytes of a row of the part.
    pub row_bytes: usize,
    /// Rows of the part.
    pub rows: usize,
}

/// Which way masks are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// From above: x grows to the right.
    Above,
    /// Left and right exchanged, as screens that light the resin from below want it.
    Below,
}

/// What changes between layers in some rows.
#[derive(Debug, Clone, PartialEq)]
struct Band {
    /// The toggles of layer k are `toggles[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    /// Pixels that change from the layer below, as bits of the window.
    toggles: Vec<u32>,
}

impl Masks {
    /// The masks of `plan` on `grid`, of which the rays of `ldi` are all or a part: a pixel is lit where the
    /// middle of the layer lies inside the solid, from an entry (included) to an exit (excluded).
    ///
    /// Cost: linear in rays and hits; memory is 4 bytes a toggle, of which there are at most as many as hits.
    pub fn new(ldi: &Ldi, plan: &Plan, grid: &Grid, side: Side) -> Self {
        let layer_of = LayerOf::new(plan);
        let layers = plan.layers();
        let place = Place::new(ldi, grid, side);
        let band_rays = ldi.grid.width as usize * BAND_ROWS;
        let firsts = (0..ldi.rays()).step_by(band_rays).collect();
        let bands = parallel::map(firsts, |first| {
            let rays = first..(first + band_rays).min(ldi.rays());
            Band::new(ldi, &layer_of, layers, &place, rays)
        });
        Self {
            grid: *grid,
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
        let mut cursor = MaskCursor {
            bits: vec![0; self.window.row_bytes * self.window.rows],
            lit_pixels: 0,
            layer: 0,
        };
        cursor.toggle(self, 0);
        cursor
    }
}

impl Band {
    /// Counts the toggles of each layer, then puts them in their places.
    fn new(
        ldi: &Ldi,
        layer_of: &LayerOf,
        layers: usize,
        place: &Place,
        rays: Range<usize>,
    ) -> Self {
        let for_each_toggle = |emit: &mut dyn FnMut(u32, usize)| {
            for ray in rays.clone() {
                for_each_solid_range(ldi.ray(ray), |z_in, z_out| {
                    let (on, off) = (layer_of.first_above(z_in), layer_of.first_above(z_out));
                    if on < off {
                        emit(on, ray);
                        emit(off, ray);
                    }
                });
            }
        };
        // One slot ahead, so that filling moves the start of each layer to its place. What goes dark above
        // the last layer has a slot behind it, which is cut off.
        let mut starts = vec![0u32; layers + 3];
        for_each_toggle(&mut |layer, _| starts[layer as usize + 2] += 1);
        for layer in 2..starts.len() {
            starts[layer] += starts[layer - 1];
        }
        let mut toggles = vec![0u32; starts[layers + 1] as usize];
        for_each_toggle(&mut |layer, ray| {
            let slot = &mut starts[layer as usize + 1];
            if let Some(toggle) = toggles.get_mut(*slot as usize) {
                *toggle = place.bit_of(ray) as u32;
                *slot += 1;
            }
        });
        starts.truncate(layers + 1);
        Self { starts, toggles }
    }

    fn of_layer(&self, layer: usize) -> &[u32] {
        &self.toggles[self.starts[layer] as usize..self.starts[layer + 1] as usize]
    }
}

/// The mask of one layer, movable to any other: toggles work both ways.
#[derive(Debug, Clone)]
pub struct MaskCursor {
    bits: Vec<u8>,
    lit_pixels: u64,
    layer: usize,
}

impl MaskCursor {
    /// Moves to a layer of `masks`, the ones that this cursor was made from, at a cost of the pixels
    /// that change on the way.
    pub fn seek(&mut self, masks: &Masks, layer: usize) {
        while self.layer < layer {
            self.layer += 1;
            self.toggle(masks, self.layer);
        }
        while self.layer > layer {
            self.toggle(masks, self.layer);
            self.layer -= 1;
        }
    }

    /// The window of the mask: one bit a pixel, most significant first; 1 is lit.
    pub fn bits(&self) -> &[u8] {
        &self.bits
    }

    /// The whole mask: one bit a pixel, most significant first, rows padded to whole bytes; 1 is lit.
    pub fn whole(&self, masks: &Masks) -> Vec<u8> {
        let Masks { grid, window, .. } = masks;
        let row_bytes = row_bytes(grid);
        let mut whole = vec![0; row_bytes * grid.height as usize];
        let first = window.first_row * row_bytes + window.first_byte;
        let rows = whole[first..].chunks_mut(row_bytes);
        for (row, bits) in rows.zip(self.bits.chunks(window.row_bytes)) {
            row[..bits.len()].copy_from_slice(bits);
        }
        whole
    }

    /// Number of lit pixels.
    pub fn lit_pixels(&self) -> u64 {
        self.lit_pixels
    }

    fn toggle(&mut self, masks: &Masks, layer: usize) {
        for &toggle in masks.bands.iter().flat_map(|band| band.of_layer(layer)) {
            let byte = &mut self.bits[toggle as usize / 8];
            let bit = 0x80 >> (toggle % 8);
            *byte ^= bit;
            if *byte & bit == 0 {
                self.lit_pixels -= 1;
            } else {
                self.lit_pixels += 1;
            }
        }
    }
}

/// Bytes of a row of a one-bit mask.
pub fn row_bytes(grid: &Grid) -> usize {
    grid.width.div_ceil(8) as usize
}

/// Where rays are in the window.
struct Place {
    window: Window,
    /// Columns of rays.
    width: usize,
    /// The bit of the first ray in its row of the window.
    first_bit: usize,
    side: Side,
}

impl Place {
    fn new(ldi: &Ldi, grid: &Grid, side: Side) -> Self {
        let [column, row] = grid.offset_of(&ldi.grid).map(|first| first as usize);
        let width = ldi.grid.width as usize;
        let first = match side {
            Side::Above => column,
            Side::Below => grid.width as usize - column - width,
        };
        let (first_byte, end_byte) = (first / 8, (first + width).div_ceil(8));
        let offset = first % 8;
        Self {
            window: Window {
                first_byte,
                first_row: row,
                row_bytes: end_byte - first_byte,
                rows: ldi.grid.height as usize,
            },
            width,
            first_bit: match side {
                Side::Above => offset,
                Side::Below => offset + width - 1,
            },
            side,
        }
    }

    /// The bit of a ray in the window.
    fn bit_of(&self, ray: usize) -> usize {
        let (row, column) = (ray / self.width, ray % self.width);
        let row_start = row * self.window.row_bytes * 8 + self.first_bit;
        match self.side {
            Side::Above => row_start + column,
            Side::Below => row_start - column,
        }
    }
}

/// Finds the first layer whose middle is at or above a height.
struct LayerOf {
    middles_mm: Vec<f64>,
    /// For every bin, a lower bound of the answer for heights in it.
    first: Vec<u32>,
    bin_mm: f64,
}

impl LayerOf {
    fn new(plan: &Plan) -> Self {
        let middles_mm = plan.middle_mm();
        let top = plan.boundaries[plan.layers()];
        let mut layer = 0;
        let first = (0..=top)
            .map(|bin| {
                // One bin lower than need be, to be safe from rounding in the division below.
                let floor_mm = (f64::from(bin) - 1.0) * plan.bins.size_mm;
                while middles_mm
                    .get(layer as usize)
                    .is_some_and(|&middle| middle < floor_mm)
                {
                    layer += 1;
                }
                layer
            })
            .collect();
        Self {
            middles_mm,
            first,
            bin_mm: plan.bins.size_mm,
        }
    }

    fn first_above(&self, z_mm: f32) -> u32 {
        let z_mm = f64::from(z_mm);
        let bin = ((z_mm / self.bin_mm) as usize).min(self.first.len() - 1);
        let mut layer = self.first[bin];
        while self
            .middles_mm
            .get(layer as usize)
            .is_some_and(|&middle| middle < z_mm)
        {
            layer += 1;
        }
        layer
    }
}
