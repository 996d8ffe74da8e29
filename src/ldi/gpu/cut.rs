//! Cuts a grid into tiles.

use super::tiles::Region;
use crate::grid::Grid;

impl Region {
    pub(super) fn rays(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The region in two halves, or `None` if it is a single ray.
    pub(super) fn halves(self) -> Option<[Self; 2]> {
        let Self {
            column,
            row,
            width,
            height,
        } = self;
        if height > 1 {
            let upper = height / 2;
            let lower = height - upper;
            Some([
                Self {
                    row: row + upper,
                    height: lower,
                    ..self
                },
                Self {
                    height: upper,
                    ..self
                },
            ])
        } else if width > 1 {
            let left = width / 2;
            let right = width - left;
            Some([
                Self {
                    column: column + left,
                    width: right,
                    ..self
                },
                Self {
                    width: left,
                    ..self
                },
            ])
        } else {
            None
        }
    }
}

/// Cuts the grid into regions of at most `side` × `side` pixels.
pub(super) fn cut(grid: &Grid, side: u32) -> Vec<Region> {
    let parts = |length: u32| {
        let firsts = (0..length).step_by(side as usize);
        firsts.map(move |first| (first, side.min(length - first)))
    };
    parts(grid.height)
        .flat_map(|(row, height)| {
            parts(grid.width).map(move |(column, width)| Region {
                column,
                row,
                width,
                height,
            })
        })
        .collect()
}
