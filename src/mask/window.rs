//! The part of a mask that the model covers.

use std::ops::Range;

use super::{Samples, Span};
use crate::grid::Grid;

/// A rectangular part of a mask, in whole bytes of its one-bit rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Bytes of each row to the left of the window.
    pub first_byte: usize,
    /// Rows above the window.
    pub first_row: usize,
    /// Bytes of each row in the window.
    pub row_bytes: usize,
    /// Rows in the window.
    pub rows: usize,
}

impl Window {
    /// The window of a whole mask.
    pub(crate) fn whole(grid: &Grid) -> Self {
        Self {
            first_byte: 0,
            first_row: 0,
            row_bytes: grid.width.div_ceil(8) as usize,
            rows: grid.height as usize,
        }
    }

    /// Pixels per row of the window. The last ones may lie beyond the mask.
    pub fn row_pixels(&self) -> usize {
        self.row_bytes * 8
    }
}

/// The side from which masks are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// From above: x grows to the right.
    Above,
    /// From below, mirrored left to right, for screens that light the resin from below.
    Below,
}

/// Rows of pixels whose changes one thread sorts together.
const BAND_ROWS: u32 = 128;

/// Maps rays to pixels of the window.
#[derive(Debug)]
pub(super) struct Place {
    pub window: Window,
    /// For each column of rays, its pixel within a row of the window.
    pub columns: Vec<u32>,
    /// For each row of rays, the first pixel of its row of the window.
    pub rows: Vec<u32>,
}

impl Place {
    /// `rays` is the grid of the rays, which covers all or a part of `grid`; each pixel has one or more of them.
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

    /// The pixel of a ray.
    pub fn pixel(&self, row: usize, column: usize) -> u32 {
        self.rows[row] + self.columns[column]
    }

    /// The band of a row of rays.
    pub fn band_of(&self, row: usize) -> usize {
        (self.rows[row] / self.band_pixels()) as usize
    }

    fn band_pixels(&self) -> u32 {
        let row_pixels = self.window.row_pixels() as u32;
        BAND_ROWS.min(Span::BAND_PIXELS / row_pixels) * row_pixels
    }

    /// The rows of rays in bands that share no row of pixels, from the top row down.
    pub fn bands(&self) -> Vec<Range<usize>> {
        let band_pixels = self.band_pixels();
        let mut bands = Vec::new();
        let mut row = 0;
        // Several rows of rays may share a row of pixels, which is then in one band.
        for rays in self
            .rows
            .chunk_by(|a, b| a / band_pixels == b / band_pixels)
        {
            bands.push(row..row + rays.len());
            row += rays.len();
        }
        bands
    }

    /// The pixels of the window that rows of rays have.
    pub fn area(&self, rows: &Range<usize>) -> Range<u32> {
        let row_pixels = self.window.row_pixels() as u32;
        self.rows[rows.start]..self.rows[rows.end - 1] + row_pixels
    }
}
