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
    layers: usize,
    /// Toggles from the topmost rows down.
    bands: Vec<Band>,
}

/// What changes between layers in some rows.
#[derive(Debug, Clone, PartialEq)]
struct Band {
    /// The toggles of layer k are `toggles[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    /// Pixels that change from the layer below, as bits of the padded mask.
    toggles: Vec<u32>,
}

impl Masks {
    /// The masks of `plan` on `grid`, of which the rays of `ldi` are all or a part: a pixel is lit where the
    /// middle of the layer lies inside the solid, from an entry (included) to an exit (excluded).
    ///
    /// Cost: linear in rays and hits; memory is 4 bytes a toggle, of which there are at most as many as hits.
    pub fn new(ldi: &Ldi, plan: &Plan, grid: &Grid) -> Self {
        let layer_of = LayerOf::new(plan);
        let layers = plan.layers();
        let band_rays = ldi.grid.width as usize * BAND_ROWS;
        let firsts = (0..ldi.rays()).step_by(band_rays).collect();
        let bands = parallel::map(firsts, |first| {
            let rays = first..(first + band_rays).min(ldi.rays());
            Band::new(ldi, &layer_of, layers, grid, rays)
        });
        Self {
            grid: *grid,
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
            row_bytes: row_bytes(&self.grid),
            bits: vec![0; row_bytes(&self.grid) * self.grid.height as usize],
            lit_pixels: 0,
            layer: 0,
        };
        cursor.toggle(self, 0);
        cursor
    }
}

impl Band {
    /// Counts the toggles of each layer, then puts them in their places.
    fn new(ldi: &Ldi, layer_of: &LayerOf, layers: usize, grid: &Grid, rays: Range<usize>) -> Self {
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
        let width = ldi.grid.width as usize;
        let row_bits = 8 * row_bytes(grid);
        let [first_column, first_row] = grid.offset_of(&ldi.grid).map(|first| first as usize);
        for_each_toggle(&mut |layer, ray| {
            let slot = &mut starts[layer as usize + 1];
            if let Some(toggle) = toggles.get_mut(*slot as usize) {
                let (column, row) = (first_column + ray % width, first_row + ray / width);
                *toggle = (row * row_bits + column) as u32;
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
    row_bytes: usize,
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

    /// One bit a pixel, most significant first, rows padded to whole bytes; 1 is lit.
    pub fn bits(&self) -> &[u8] {
        &self.bits
    }

    /// Bytes of a row of [`Self::bits`].
    pub fn row_bytes(&self) -> usize {
        self.row_bytes
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
fn row_bytes(grid: &Grid) -> usize {
    grid.width.div_ceil(8) as usize
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
