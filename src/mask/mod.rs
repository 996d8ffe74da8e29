//! Layer masks: which pixels are lit (section 3.4), one mask in memory at a time.
//!
//! From layer to layer only those pixels change whose surface lies between the two sampling
//! heights. All masks together are therefore a list of toggles, sorted by layer, as long as the list of
//! hits; no mask is ever computed from scratch.

use crate::grid::Grid;
use crate::ldi::{Ldi, for_each_solid_range};
use crate::parallel;
use crate::plan::Plan;

/// Rays sorted together; bounds the memory of intermediate lists.
const CHUNK_ROWS: usize = 128;

/// The masks of all layers of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Masks {
    /// The pixels.
    pub grid: Grid,
    /// The toggles of layer k are `toggles[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    /// Pixels that change from the layer below, as bits of the padded mask.
    toggles: Vec<u32>,
}

impl Masks {
    /// The masks of `plan`: a pixel is lit where the middle of the layer lies inside the solid, from
    /// an entry (included) to an exit (excluded).
    pub fn new(ldi: &Ldi, plan: &Plan) -> Self {
        let layer_of = LayerOf::new(plan);
        let layers = plan.layers();
        let width = ldi.grid.width as usize;
        let row_bits = 8 * row_bytes(&ldi.grid) as u32;
        let chunks: Vec<_> = (0..ldi.rays()).step_by(width * CHUNK_ROWS).collect();
        // Layer and bit of each toggle, chunk by chunk.
        let lists = parallel::map(chunks, |first| {
            let mut list = Vec::new();
            for ray in first..(first + width * CHUNK_ROWS).min(ldi.rays()) {
                let bit = (ray / width) as u32 * row_bits + (ray % width) as u32;
                for_each_solid_range(ldi.ray(ray), |z_in, z_out| {
                    let (on, off) = (layer_of.first_above(z_in), layer_of.first_above(z_out));
                    if on < off {
                        list.push((on, bit));
                        if (off as usize) < layers {
                            list.push((off, bit));
                        }
                    }
                });
            }
            list
        });
        let mut starts = vec![0u32; layers + 2];
        for &(layer, _) in lists.iter().flatten() {
            starts[layer as usize + 2] += 1;
        }
        for layer in 2..starts.len() {
            starts[layer] += starts[layer - 1];
        }
        let mut toggles = vec![0u32; starts[layers + 1] as usize];
        for (layer, bit) in lists.into_iter().flatten() {
            let slot = &mut starts[layer as usize + 1];
            toggles[*slot as usize] = bit;
            *slot += 1;
        }
        starts.truncate(layers + 1);
        Self {
            grid: ldi.grid,
            starts,
            toggles,
        }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.starts.len() - 1
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
        let toggles = masks.starts[layer] as usize..masks.starts[layer + 1] as usize;
        for &toggle in &masks.toggles[toggles] {
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
