//! Samples of a pixel for anti-aliasing: several rays side by side, and several heights within a layer.

use std::ops::Range;

use crate::ldi::cpu::Slab;
use crate::ldi::projection::RowHeights;
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
    /// The middle of the sublayer below each, then that of the last, then infinity: sublayer i is the answer for heights above value i,
    /// up to value i + 1.
    ends_mm: Vec<f64>,
    /// For every bin, a lower bound of the answer for heights in it.
    first: Vec<u32>,
    bins_per_mm: f64,
}

impl SublayerOf {
    pub fn new(plan: &Plan, sublayers: u32) -> Self {
        let mut ends_mm = vec![f64::NEG_INFINITY];
        ends_mm.extend(plan.middles_of_parts_mm(sublayers));
        ends_mm.push(f64::INFINITY);
        let top = plan.boundaries[plan.layers()];
        let mut sublayer = 0;
        let first = (0..=top)
            .map(|bin| {
                // One bin of margin for rounding in `first_above`.
                let floor_mm = (f64::from(bin) - 1.0) * plan.bins.size_mm;
                sublayer = above(&ends_mm, sublayer, floor_mm);
                sublayer
            })
            .collect();
        Self {
            ends_mm,
            first,
            bins_per_mm: 1.0 / plan.bins.size_mm,
        }
    }

    /// The heights whose first sublayer belongs to these layers, each of which has `parts` sublayers.
    pub fn slab(&self, layers: &Range<usize>, parts: u32) -> Slab {
        let [first, end] = [layers.start, layers.end].map(|layer| layer * parts as usize);
        Slab {
            above_mm: self.ends_mm[first].max(-1.0),
            to_mm: self.ends_mm[end],
        }
    }

    #[inline]
    pub fn first_above(&self, z_mm: f32) -> u32 {
        let z_mm = f64::from(z_mm);
        let bin = ((z_mm * self.bins_per_mm) as usize).min(self.first.len() - 1);
        above(&self.ends_mm, self.first[bin], z_mm)
    }

    /// Calls `emit(sublayer, columns)` for the columns of a facet in a row, in ranges of one sublayer each.
    #[inline]
    pub fn each_range(
        &self,
        heights: RowHeights,
        columns: Range<u32>,
        mut emit: impl FnMut(u32, Range<u32>),
    ) {
        let Range { mut start, end } = columns;
        // Heights ascend or descend along the row, so a range with both ends in a sublayer is wholly in it.
        let last_mm = f64::from(heights.at(end - 1));
        let mut sublayer = self.first_above(heights.at(start));
        loop {
            let place = sublayer as usize;
            let (above_mm, to_mm) = (self.ends_mm[place], self.ends_mm[place + 1]);
            let contains = |z_mm: f64| above_mm < z_mm && z_mm <= to_mm;
            if contains(last_mm) {
                return emit(sublayer, start..end);
            }
            let mut next = start + 1;
            let mut next_mm = f64::from(heights.at(next));
            while contains(next_mm) {
                next += 1;
                next_mm = f64::from(heights.at(next));
            }
            emit(sublayer, start..next);
            start = next;
            // On all but steep facets it is the next one.
            let rises = next_mm > to_mm;
            sublayer = match if rises { place + 1 } else { place - 1 } {
                near if self.ends_mm[near] < next_mm && next_mm <= self.ends_mm[near + 1] => {
                    near as u32
                }
                _ => self.first_above(next_mm as f32),
            };
        }
    }
}

/// The first sublayer from one on whose middle is at or above a height.
#[inline]
fn above(ends_mm: &[f64], mut sublayer: u32, z_mm: f64) -> u32 {
    while ends_mm[sublayer as usize + 1] < z_mm {
        sublayer += 1;
    }
    sublayer
}
