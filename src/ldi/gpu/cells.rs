//! The cells of a tile: squares of rays, each with a list of the facets over it. Depth peeling draws cell by cell, so each
//! is drawn only as often as its own deepest ray needs.

use super::tiles::Region;
use crate::ldi::layout::{CELL_FACETS, Cell};
use crate::ldi::projection::Projection;
use crate::model::FacetLists;

/// The side of cells in rays, unless their lists get too long.
const SIDE: u32 = 64;

/// The least side: cells are whole workgroups.
pub(super) const LEAST_SIDE: u32 = 16;

pub(super) struct Cells {
    region: Region,
    /// Side in rays, a multiple of [`LEAST_SIDE`].
    pub side: u32,
    columns: u32,
    lists: FacetLists,
}

impl Cells {
    /// Lists the facets of a region by cell, each list in the order of `facets`. `None` if even the lists of the smallest
    /// cells are too long, as they are for very many facets whose outlines may be anywhere within the same rectangle.
    pub fn new(projection: &Projection<'_>, facets: &[u32], region: Region) -> Option<Self> {
        let mut side = SIDE;
        loop {
            let cells = Self::of_side(projection, facets, region, side);
            let longest = (0..cells.count())
                .map(|cell| cells.lists.range(cell).len())
                .max();
            if longest.unwrap_or(0) <= CELL_FACETS {
                return Some(cells);
            }
            // Lists of a region within one cell are the same at every side.
            if side == LEAST_SIDE || region.width.max(region.height) <= LEAST_SIDE {
                return None;
            }
            side /= 2;
        }
    }

    fn of_side(projection: &Projection<'_>, facets: &[u32], region: Region, side: u32) -> Self {
        let columns = region.width.div_ceil(side);
        let rows = region.height.div_ceil(side);
        let part = |covered: std::ops::Range<u32>, first: u32, length: u32| {
            let start = covered.start.max(first) - first;
            let end = covered.end.min(first + length).saturating_sub(first);
            if start < end {
                start / side..end.div_ceil(side)
            } else {
                0..0
            }
        };
        let lists = FacetLists::new((columns * rows) as usize, facets.iter().copied(), |facet| {
            let facet = facet as usize;
            let across = part(projection.columns(facet), region.column, region.width);
            let down = part(projection.rows(facet), region.row, region.height);
            down.flat_map(move |row| {
                across
                    .clone()
                    .map(move |column| (row * columns + column) as usize)
            })
        });
        Self {
            region,
            side,
            columns,
            lists,
        }
    }

    pub fn count(&self) -> usize {
        (self.columns * self.region.height.div_ceil(self.side)) as usize
    }

    /// The facets of all lists, one list after the other.
    pub fn facets(&self) -> &[u32] {
        self.lists.all()
    }

    /// The places of a cell's facets in [`Self::facets`].
    pub fn list(&self, cell: usize) -> std::ops::Range<usize> {
        self.lists.range(cell)
    }

    /// The rays of a cell: those of its columns and rows that lie within the region.
    pub fn rays(&self, cell: usize) -> Region {
        let [column, row] =
            [cell as u32 % self.columns, cell as u32 / self.columns].map(|it| it * self.side);
        Region {
            column,
            row,
            width: self.side.min(self.region.width - column),
            height: self.side.min(self.region.height - row),
        }
    }

    /// A cell as shaders read it.
    pub fn on_gpu(&self, cell: usize) -> Cell {
        let rays = self.rays(cell);
        Cell {
            corner: [rays.column, rays.row],
            first: self.list(cell).start as u32,
            padding: 0,
        }
    }
}
