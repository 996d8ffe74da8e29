//! The part of a mask that the model is in.

use super::Samples;
use crate::grid::Grid;

/// A part of a mask, in whole bytes of its one-bit rows.
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

impl Window {
    /// Pixels of a row of the part. The last ones may lie beyond the mask.
    pub fn row_pixels(&self) -> usize {
        self.row_bytes * 8
    }
}

/// Which way masks are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// From above: x grows to the right.
    Above,
    /// Left and right exchanged, as screens that light the resin from below want it.
    Below,
}

/// The pixels of the window that rays belong to.
pub(super) struct Place {
    pub window: Window,
    /// For every column of rays, the pixel in its row of the window.
    pub columns: Vec<u32>,
    /// For every row of rays, the first pixel of its row of the window.
    pub rows: Vec<u32>,
}

impl Place {
    /// `rays` are all or a part of the rays of `grid`, of which each pixel has several.
    pub fn new(rays: &Grid, grid: &Grid, samples: Samples, side: Side) -> Self {
        let [first_column, first_row] = grid.refined(samples.rays()).offset_of(rays);
        let column = |ray: u32| {
            let column = (first_column + ray) / samples.columns;
            match side {
                Side::Above => column,
                Side::Below => grid.width - 1 - column,
            }
        };
        let row = |ray: u32| (first_row + ray) / samples.rows;
        let ends = [column(0), column(rays.width - 1)];
        let first_byte = ends[0].min(ends[1]) / 8;
        let window = Window {
            first_byte: first_byte as usize,
            first_row: row(0) as usize,
            row_bytes: (ends[0].max(ends[1]) / 8 + 1 - first_byte) as usize,
            rows: (row(rays.height - 1) + 1 - row(0)) as usize,
        };
        let row_pixels = window.row_pixels() as u32;
        Self {
            window,
            columns: (0..rays.width)
                .map(|ray| column(ray) - first_byte * 8)
                .collect(),
            rows: (0..rays.height)
                .map(|ray| (row(ray) - row(0)) * row_pixels)
                .collect(),
        }
    }
}
