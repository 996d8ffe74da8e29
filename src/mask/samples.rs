//! Samples of a pixel for anti-aliasing: several rays side by side, and several heights within a layer.

use std::ops::Range;

use crate::ldi::cpu::Slab;
use crate::plan::Plan;

/// Levels of anti-aliasing.
pub const LEVELS: [u32; 4] = [1, 2, 4, 8];

/// Samples of each pixel of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Samples {
    /// Rays per pixel in x.
    pub columns: u32,
    /// Rays per pixel in y.
    pub rows: u32,
    /// Equal parts of a layer's thickness, each sampled at its middle.
    pub sublayers: u32,
}

impl Samples {
    /// One ray through the centre of each pixel, sampled at the middle of the layer.
    pub const ONE: Self = Self {
        columns: 1,
        rows: 1,
        sublayers: 1,
    };

    /// A level of n has n rays per pixel and n parts of a layer. `None` if the level is not in [`LEVELS`].
    pub fn of_level(level: u32) -> Option<Self> {
        let [columns, rows] = match level {
            1 => [1, 1],
            2 => [2, 1],
            4 => [2, 2],
            8 => [4, 2],
            _ => return None,
        };
        Some(Self {
            columns,
            rows,
            sublayers: level,
        })
    }

    /// Rays per pixel in x and y.
    pub fn rays(self) -> [u32; 2] {
        [self.columns, self.rows]
    }

    /// Total number of samples per pixel: 1 to 64.
    pub fn total(self) -> u32 {
        self.columns * self.rows * self.sublayers
    }
}

/// Finds the first sublayer whose middle is at or above a height.
#[derive(Debug)]
pub(super) struct SublayerOf {
    middles_mm: Vec<f64>,
    /// For every bin, a lower bound of the answer for heights in it.
    first: Vec<u32>,
    bins_per_mm: f64,
}

impl SublayerOf {
    pub fn new(plan: &Plan, sublayers: u32) -> Self {
        let middles_mm = plan.middles_of_parts_mm(sublayers);
        let top = plan.boundaries[plan.layers()];
        let mut sublayer = 0;
        let first = (0..=top)
            .map(|bin| {
                // One bin of margin for rounding in `first_above`.
                let floor_mm = (f64::from(bin) - 1.0) * plan.bins.size_mm;
                while middles_mm
                    .get(sublayer as usize)
                    .is_some_and(|&middle| middle < floor_mm)
                {
                    sublayer += 1;
                }
                sublayer
            })
            .collect();
        Self {
            middles_mm,
            first,
            bins_per_mm: 1.0 / plan.bins.size_mm,
        }
    }

    /// The heights whose first sublayer belongs to these layers, each of which has `parts` sublayers.
    pub fn slab(&self, layers: &Range<usize>, parts: u32) -> Slab {
        let [first, end] = [layers.start, layers.end].map(|layer| layer * parts as usize);
        let below = first
            .checked_sub(1)
            .map(|sublayer| self.middles_mm[sublayer]);
        Slab {
            above_mm: below.unwrap_or(-1.0),
            to_mm: self.middles_mm[end - 1],
        }
    }

    #[inline]
    pub fn first_above(&self, z_mm: f32) -> u32 {
        let z_mm = f64::from(z_mm);
        let bin = ((z_mm * self.bins_per_mm) as usize).min(self.first.len() - 1);
        let mut sublayer = self.first[bin];
        while self
            .middles_mm
            .get(sublayer as usize)
            .is_some_and(|&middle| middle < z_mm)
        {
            sublayer += 1;
        }
        sublayer
    }
}
