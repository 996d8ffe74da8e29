//! The shadow of a model on the plate, in cells of whole pixels.

use glam::{DVec2, Vec3};

use super::Screen;
use crate::model::Mesh;

/// Least depth, in pixels, by which a surface must reach into a pixel to light it. The ray nearest to the edge of a
/// pixel, of four across it, is 1/8 pixel away, and sampling moves corners by less than 1/256 pixel.
const INSET: f64 = 1.0 / 8.0 - 1.0 / 256.0;

/// A set of cells, row by row in words of 64.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cells {
    pub columns: usize,
    pub rows: usize,
    pub words: Vec<u64>,
}

impl Cells {
    pub fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            rows,
            words: vec![0; columns.div_ceil(64) * rows],
        }
    }

    pub fn row_words(&self) -> usize {
        self.columns.div_ceil(64)
    }

    pub fn row(&self, row: usize) -> &[u64] {
        let words = self.row_words();
        &self.words[row * words..(row + 1) * words]
    }

    pub fn fill(&mut self, row: usize, columns: std::ops::Range<usize>) {
        let start = row * self.row_words();
        for column in columns {
            self.words[start + column / 64] |= 1 << (column % 64);
        }
    }

    pub fn has(&self, column: usize, row: usize) -> bool {
        self.row(row)[column / 64] >> (column % 64) & 1 == 1
    }

    /// Number of cells in the set.
    pub fn count(&self) -> u64 {
        self.words
            .iter()
            .map(|word| u64::from(word.count_ones()))
            .sum()
    }

    /// The cells that are within `reach` of one of these: columns to either side for each number of rows up or down. The
    /// result is larger by that reach on all sides.
    pub fn grown(&self, reach: &[usize]) -> Self {
        let sideways = reach[0];
        let rows = reach.len() - 1;
        let mut grown = Self::new(self.columns + 2 * sideways, self.rows + 2 * rows);
        for row in 0..self.rows {
            for column in (0..self.columns).filter(|&column| self.has(column, row)) {
                // A cell surrounded by others adds only itself.
                let is_inner = column > 0
                    && row > 0
                    && column + 1 < self.columns
                    && row + 1 < self.rows
                    && self.has(column - 1, row)
                    && self.has(column + 1, row)
                    && self.has(column, row - 1)
                    && self.has(column, row + 1);
                if is_inner {
                    grown.fill(row + rows, column + sideways..column + sideways + 1);
                    continue;
                }
                for (away, &columns) in reach.iter().enumerate() {
                    let middle = column + sideways;
                    let range = middle - columns..middle + columns + 1;
                    grown.fill(row + rows - away, range.clone());
                    grown.fill(row + rows + away, range);
                }
            }
        }
        grown
    }
}

/// The shadow of a model that stands at the middle of the screen.
#[derive(Debug, Clone)]
pub struct Outline {
    pub(super) cells: Cells,
    /// The cell of the screen where the first cell of the shadow lies, columns to the right and rows downward; negative beyond
    /// the screen.
    pub(super) first: [i64; 2],
    /// The pixels that the shadow covers: first column and row, and those after the last.
    pub(super) pixels: [[i64; 2]; 2],
    /// Area of the shadow in mm², rounded up to whole cells.
    pub area_mm2: f64,
}

impl Outline {
    /// The shadow of a mesh that is centred on x = y = 0. It covers every pixel that the model and its supports can light.
    ///
    /// Cost: linear in facets and in the cells that they cover.
    pub fn of(mesh: &Mesh, screen: &Screen) -> Self {
        let bounds = mesh.printed_bounds();
        let first = screen.pixels_to(DVec2::new(bounds.min.x, bounds.max.y)) + INSET;
        let last = screen.pixels_to(DVec2::new(bounds.max.x, bounds.min.y)) - INSET;
        let pixels = [
            [first.x.floor() as i64, first.y.floor() as i64],
            // A model that is thinner than a pixel still has one.
            [
                last.x.max(first.x).floor() as i64 + 1,
                last.y.max(first.y).floor() as i64 + 1,
            ],
        ];
        let cell = screen.cell.map(i64::from);
        let first_cell = [0, 1].map(|axis| pixels[0][axis].div_euclid(cell[axis]));
        let last_cell = [0, 1].map(|axis| (pixels[1][axis] - 1).div_euclid(cell[axis]));
        let size = [0, 1].map(|axis| (last_cell[axis] - first_cell[axis] + 1) as usize);
        let mut cells = Cells::new(size[0], size[1]);
        let origin = DVec2::new(
            (first_cell[0] * cell[0]) as f64,
            (first_cell[1] * cell[1]) as f64,
        );
        let side = DVec2::new(cell[0] as f64, cell[1] as f64);
        let place =
            |vertex: &Vec3| (screen.pixels_to(vertex.as_dvec3().truncate()) - origin) / side;
        let corners: Vec<DVec2> = mesh.vertices.iter().map(place).collect();
        let inset = INSET / side;
        for facet in &mesh.facets {
            cover(
                &mut cells,
                facet.map(|vertex| corners[vertex as usize]),
                inset,
            );
        }
        Self {
            area_mm2: cells.count() as f64 * screen.cell_mm2(),
            cells,
            first: first_cell,
            pixels,
        }
    }
}

/// Adds the cells that a triangle meets farther than `inset` from their edges, given its corners in cells.
fn cover(cells: &mut Cells, corners: [DVec2; 3], inset: DVec2) {
    let low = corners[0].min(corners[1]).min(corners[2]);
    let high = corners[0].max(corners[1]).max(corners[2]);
    let [last_column, last_row] = [cells.columns - 1, cells.rows - 1];
    let row_of = |y: f64| (y.max(0.0) as usize).min(last_row);
    let column_of = |x: f64| (x.max(0.0) as usize).min(last_column);
    let rows = row_of(low.y)..=row_of(high.y);
    // Most facets of a scan lie within a cell that another has covered.
    let column = column_of(low.x);
    if rows.start() == rows.end() && column == column_of(high.x) && cells.has(column, *rows.start())
    {
        return;
    }
    for row in rows {
        // The part of the triangle within the row.
        let (top, bottom) = (row as f64 + inset.y, row as f64 + 1.0 - inset.y);
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut include = |x: f64| {
            left = left.min(x);
            right = right.max(x);
        };
        for edge in 0..3 {
            let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
            if (top..=bottom).contains(&from.y) {
                include(from.x);
            }
            for y in [top, bottom] {
                if (from.y < y) != (to.y < y) {
                    include(from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y)));
                }
            }
        }
        if left > right {
            continue;
        }
        let first = (left + inset.x).max(0.0) as usize;
        let last = column_of(right - inset.x);
        // Otherwise it lies between the rays.
        if first <= last {
            cells.fill(row, first..last + 1);
        }
    }
}
