//! Walls and gaps that are too thin within a layer.
//!
//! A pixel is thick if a disc of the limit's diameter fits into the lit pixels, or into the dark ones, with its centre within
//! the limit of the pixel. Allowing for the distance of the centre leaves out corners of 60° and more.
//!
//! A disc fits wherever a square around it does, and squares are found with few looks at each row, so these come first: they
//! leave little for discs to decide.

use std::ops::Range;

use super::rows::{Disc, FAR, Rest, Rows, Span, intersect, subtract};
use crate::grid::Grid;

/// Finds pixels where the mask is thinner than a limit.
pub(super) struct Thickness {
    /// The disc that must fit.
    disc: Disc,
    /// Greatest distance of its centre.
    reach: Disc,
    /// Rows that are examined together.
    block_rows: i32,
    /// Blocks whose rows hold the disc.
    blocks: i32,
}

impl Thickness {
    /// `None` if the limit is below the resolution of the pixels, so that nothing is thin.
    pub fn new(limit_mm: f64, grid: &Grid) -> Option<Self> {
        let disc = Disc::to_fit(limit_mm, grid)?;
        let disc_rows = 2 * disc.rows() + 1;
        let block_rows = (disc_rows / 4).max(1);
        Some(Self {
            reach: Disc::new(limit_mm, grid),
            blocks: (disc_rows + block_rows - 1) / block_rows,
            block_rows,
            disc,
        })
    }

    /// The lit pixels that are thin.
    pub fn thin_walls(&self, lit: &Rows) -> Rows {
        self.thin(lit, 0, [-FAR, FAR])
    }

    /// The thin dark pixels in the first `columns` columns. Everything outside the rows is dark.
    pub fn thin_gaps(&self, lit: &Rows, columns: i32) -> Rows {
        let margin = self.reach.rows() + 2 * self.disc.rows() + 2 * self.block_rows;
        self.thin(&lit.inverted(margin), margin, [0, columns])
    }

    /// The thin pixels in these columns, and without the first and the last `margin` rows.
    fn thin(&self, solid: &Rows, margin: i32, columns: [i32; 2]) -> Rows {
        let squares = self.squares(solid);
        let doubtful = self.doubtful(solid, &squares, margin, columns);
        let mut thin = Rows::default();
        if doubtful.is_blank() {
            for _ in margin..solid.len() - margin {
                thin.end_row();
            }
            return thin;
        }
        let mut centres = Centres::new(solid, &self.disc);
        let (mut rest, mut less) = (Vec::new(), Vec::new());
        for row in margin..solid.len() - margin {
            rest.clear();
            rest.extend_from_slice(doubtful.row(row));
            for &(step, half_width) in self.reach.steps() {
                if rest.is_empty() {
                    break;
                }
                less.clear();
                subtract(&rest, centres.row(row + step), half_width, &mut less);
                std::mem::swap(&mut rest, &mut less);
            }
            thin.push_row(&rest);
        }
        thin
    }

    /// For each block, the columns at which a square fits that begins with the block's first row.
    fn squares(&self, solid: &Rows) -> Rows {
        let mut blocks = Rows::default();
        let mut both = [Vec::new(), Vec::new()];
        for first in (0..solid.len()).step_by(self.block_rows as usize) {
            let [common, next] = &mut both;
            common.clear();
            common.extend_from_slice(solid.row(first));
            for row in first + 1..first + self.block_rows {
                next.clear();
                intersect(common, solid.row(row), 0, next);
                std::mem::swap(common, next);
                if common.is_empty() {
                    break;
                }
            }
            blocks.push_row(common);
        }
        let half_width = self.disc.half_width(0).unwrap_or(0);
        let mut squares = Rows::default();
        for block in 0..blocks.len() {
            let [common, next] = &mut both;
            common.clear();
            for span in blocks.row(block) {
                let (start, end) = (span.start + half_width, span.end - half_width);
                if start < end {
                    common.push(Span { start, end });
                }
            }
            for other in block + 1..block + self.blocks {
                if common.is_empty() {
                    break;
                }
                next.clear();
                intersect(common, blocks.row(other), half_width, next);
                std::mem::swap(common, next);
            }
            squares.push_row(common);
        }
        squares
    }

    /// The pixels that squares do not show to be thick.
    fn doubtful(&self, solid: &Rows, squares: &Rows, margin: i32, columns: [i32; 2]) -> Rows {
        let mut doubtful = Rows::default();
        let mut rest = Rest::default();
        let mut within = Vec::new();
        for row in 0..solid.len() {
            if row < margin || row >= solid.len() - margin {
                doubtful.end_row();
                continue;
            }
            let block = row / self.block_rows;
            within.clear();
            for span in solid.row(row) {
                let (start, end) = (span.start.max(columns[0]), span.end.min(columns[1]));
                if start < end {
                    within.push(Span { start, end });
                }
            }
            if within.is_empty() {
                doubtful.end_row();
                continue;
            }
            // Squares around the row, below it and above it.
            let firsts = [block - self.blocks / 2, block, block + 1 - self.blocks];
            let near = firsts.into_iter().filter_map(|first| {
                let middle = first * self.block_rows + self.disc.rows();
                let half_width = self.reach.half_width(middle - row)?;
                Some((squares.row(first), half_width))
            });
            doubtful.push_row(rest.of(&within, near));
        }
        doubtful
    }
}

/// The centres of discs that fit, found row by row as they are asked for.
struct Centres<'a> {
    solid: &'a Rows,
    disc: &'a Disc,
    spans: Vec<Span>,
    /// Places of each row's spans, if they have been requested.
    places: Vec<Option<Range<usize>>>,
    common: Vec<Span>,
    next: Vec<Span>,
}

impl<'a> Centres<'a> {
    fn new(solid: &'a Rows, disc: &'a Disc) -> Self {
        Self {
            solid,
            disc,
            spans: Vec::new(),
            places: vec![None; solid.len() as usize],
            common: Vec::new(),
            next: Vec::new(),
        }
    }

    fn row(&mut self, row: i32) -> &[Span] {
        if row < 0 || row >= self.solid.len() {
            return &[];
        }
        let place = match &self.places[row as usize] {
            Some(known) => known.clone(),
            None => self.find(row),
        };
        &self.spans[place]
    }

    fn find(&mut self, row: i32) -> Range<usize> {
        let Self { common, next, .. } = self;
        common.clear();
        common.push(Span {
            start: -FAR,
            end: FAR,
        });
        for &(step, half_width) in self.disc.steps() {
            next.clear();
            intersect(common, self.solid.row(row + step), half_width, next);
            std::mem::swap(common, next);
            if common.is_empty() {
                break;
            }
        }
        let start = self.spans.len();
        self.spans.extend_from_slice(common);
        let place = start..self.spans.len();
        self.places[row as usize] = Some(place.clone());
        place
    }
}
