//! The mesh as rays see it: corners on a fixed-point lattice of 1/256 pixel, and the rule by which a
//! facet covers pixel centres.
//!
//! Integers decide coverage. A pixel centre on an edge or vertex that several facets share belongs to
//! exactly one of those that face the same way, whatever their order. The rule is the top-left rule of
//! rasterisers: a centre on a left edge, or on a horizontal top edge, is covered; on a right or bottom
//! edge it is not. The GPU backend evaluates the same rule in its fragment shader.

use std::ops::Range;

use glam::{DVec2, Vec3};

use crate::grid::Grid;
use crate::model::{FacetLists, Mesh};

/// Lattice steps per pixel.
pub const STEPS: i64 = 256;
/// From a pixel's corner to its centre, in lattice steps.
const HALF: i64 = STEPS / 2;

/// The vertices of a mesh over a grid, in lattice steps: columns to the right, rows downward.
#[derive(Debug, Clone)]
pub struct Projection<'a> {
    /// The vertices in millimetres.
    pub vertices: &'a [Vec3],
    /// The vertices of each facet.
    pub vertices_of: &'a [[u32; 3]],
    /// Position of each vertex, snapped to the nearest lattice point inside the grid.
    pub positions: Vec<[i32; 2]>,
    /// Columns and rows of the grid; facets cover none outside it.
    columns: u32,
    rows: u32,
}

impl<'a> Projection<'a> {
    /// Snaps the vertices of `mesh`, which lies inside `grid` up to rounding.
    pub fn new(mesh: &'a Mesh, grid: &Grid) -> Self {
        Self::of(&mesh.vertices, &mesh.facets, grid)
    }

    /// Snaps the vertices of facets, which lie inside `grid` up to rounding.
    pub fn of(vertices: &'a [Vec3], vertices_of: &'a [[u32; 3]], grid: &Grid) -> Self {
        let limit = DVec2::new(f64::from(grid.width), f64::from(grid.height)) * STEPS as f64;
        let positions = vertices
            .iter()
            .map(|vertex| {
                let position = grid.to_pixels(vertex.as_dvec3().truncate()) * STEPS as f64;
                let snapped = (position + 0.5).floor().clamp(DVec2::ZERO, limit);
                [snapped.x as i32, snapped.y as i32]
            })
            .collect();
        Self {
            vertices,
            vertices_of,
            positions,
            columns: grid.width,
            rows: grid.height,
        }
    }

    /// Number of facets.
    pub fn facets(&self) -> usize {
        self.vertices_of.len()
    }

    /// A facet seen from above, or `None` if it is edge-on to the rays after snapping.
    pub fn facet(&self, facet: usize) -> Option<ProjectedFacet> {
        let corners = self.corners(facet).map(|corner| corner.map(i64::from));
        let outline = Outline::of(corners)?;
        Some(ProjectedFacet::new(outline, corners, self.heights(facet)))
    }

    /// The heights of a facet's corners, in millimetres.
    pub fn heights(&self, facet: usize) -> [f32; 3] {
        self.vertices_of[facet].map(|vertex| self.vertices[vertex as usize].z)
    }

    /// The corners of a facet.
    #[inline]
    pub fn corners(&self, facet: usize) -> [[i32; 2]; 3] {
        self.vertices_of[facet].map(|vertex| self.positions[vertex as usize])
    }

    /// The outline of a facet, or `None` if it is edge-on to the rays after snapping.
    pub fn outline(&self, facet: usize) -> Option<Outline> {
        Outline::of(self.corners(facet).map(|corner| corner.map(i64::from)))
    }

    /// Facets in bands of rows, given the band of each row.
    pub(crate) fn in_bands(
        &self,
        bands: usize,
        facets: impl Iterator<Item = u32> + Clone,
        band_of: impl Fn(u32) -> usize,
    ) -> FacetLists {
        FacetLists::new(bands, facets, |facet| {
            let rows = self.rows(facet as usize);
            if rows.is_empty() {
                0..0
            } else {
                band_of(rows.start)..band_of(rows.end - 1) + 1
            }
        })
    }

    /// The rows whose pixel centres a facet may cover.
    pub fn rows(&self, facet: usize) -> Range<u32> {
        self.centres(facet, 1, self.rows)
    }

    /// The columns whose pixel centres a facet may cover.
    pub fn columns(&self, facet: usize) -> Range<u32> {
        self.centres(facet, 0, self.columns)
    }

    #[inline]
    fn centres(&self, facet: usize, axis: usize, end: u32) -> Range<u32> {
        let at = self.corners(facet).map(|corner| corner[axis]);
        let [low, high] = [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])];
        first_centre(i64::from(low)) as u32..(first_centre(i64::from(high)) as u32).min(end)
    }
}

/// The first pixel whose centre is at or beyond `position`, which is in lattice steps.
fn first_centre(position: i64) -> i64 {
    -(HALF - position).div_euclid(STEPS)
}

/// The quotient ⌈numerator / denominator⌉ for a positive denominator, and the remainder
/// quotient · denominator − numerator: 0 ≤ remainder < denominator.
///
/// Both arguments must be below 2⁵¹ in magnitude. The estimate in double precision is then off by at most
/// one, and several times faster than an integer division.
fn ceil_div_rem(numerator: i64, denominator: i64) -> (i64, i64) {
    let mut quotient = (numerator as f64 / denominator as f64) as i64;
    let mut remainder = quotient * denominator - numerator;
    if remainder < 0 {
        quotient += 1;
        remainder += denominator;
    } else if remainder >= denominator {
        quotient -= 1;
        remainder -= denominator;
    }
    (quotient, remainder)
}

/// The outline of a facet that is not edge-on to the rays. It decides which pixel centres the facet covers.
#[derive(Debug, Clone, Copy)]
pub struct Outline {
    /// Corners sorted by row, then column, in lattice steps.
    corners: [[i64; 2]; 3],
    /// Twice the signed area, in lattice steps squared. The sign is that of the facet's winding.
    area: i64,
    /// True if the middle corner is left of the edge between the others.
    bend_is_left: bool,
}

impl Outline {
    fn of(corners: [[i64; 2]; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0 {
            return None;
        }
        let mut corners = corners;
        for (upper, lower) in [(0, 1), (1, 2), (0, 1)] {
            let [p, q] = [corners[upper], corners[lower]];
            if (p[1], p[0]) > (q[1], q[0]) {
                corners.swap(upper, lower);
            }
        }
        let [top, middle, bottom] = corners;
        let turn = (middle[0] - top[0]) * (bottom[1] - top[1])
            - (middle[1] - top[1]) * (bottom[0] - top[0]);
        Some(Self {
            corners,
            area,
            bend_is_left: turn < 0,
        })
    }

    /// Calls `emit(row, columns)` for every row of `rows` in which the facet covers pixel centres.
    pub fn for_each_span(&self, rows: Range<u32>, mut emit: impl FnMut(u32, Range<u32>)) {
        let [top, middle, bottom] = self.corners;
        let first = first_centre(top[1]).max(i64::from(rows.start));
        let end = first_centre(bottom[1]).min(i64::from(rows.end));
        if first >= end {
            return;
        }
        let bend = first_centre(middle[1]).clamp(first, end);
        let mut long = Edge::new(top, bottom, first);
        for (from, to, first, end) in [(top, middle, first, bend), (middle, bottom, bend, end)] {
            if first == end {
                continue;
            }
            let mut short = Edge::new(from, to, first);
            for row in first..end {
                let columns = if self.bend_is_left {
                    short.column..long.column
                } else {
                    long.column..short.column
                };
                if columns.start < columns.end {
                    emit(row as u32, columns.start as u32..columns.end as u32);
                }
                short.step();
                long.step();
            }
        }
    }
}

/// A facet that is not edge-on to the rays, with its heights.
#[derive(Debug, Clone, Copy)]
pub struct ProjectedFacet {
    /// The pixel centres that it covers.
    pub outline: Outline,
    /// Height at the first corner, and its change per lattice step to the right and downward.
    z: f64,
    z_per_column: f64,
    z_per_row: f64,
    z_range: [f32; 2],
    /// True if the facet faces up.
    pub faces_up: bool,
}

impl ProjectedFacet {
    #[inline]
    fn new(outline: Outline, corners: [[i64; 2]; 3], z: [f32; 3]) -> Self {
        let [a, b, c] = corners;
        let area = outline.area;
        let heights = z.map(f64::from);
        let [dzb, dzc] = [heights[1] - heights[0], heights[2] - heights[0]];
        let [bx, by] = [(b[0] - a[0]) as f64, (b[1] - a[1]) as f64];
        let [cx, cy] = [(c[0] - a[0]) as f64, (c[1] - a[1]) as f64];
        let z_per_column = (dzb * cy - dzc * by) / area as f64;
        let z_per_row = (dzc * bx - dzb * cx) / area as f64;
        // The plane is exact at a; carry its height to the first corner in row order.
        let first = outline.corners[0];
        let z_first = heights[0]
            + (first[0] - a[0]) as f64 * z_per_column
            + (first[1] - a[1]) as f64 * z_per_row;
        Self {
            outline,
            z: z_first,
            z_per_column,
            z_per_row,
            z_range: [z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2])],
            // Rows run downward, so counter-clockwise from above has a negative area here.
            faces_up: area < 0,
        }
    }

    /// The heights of the facet over the pixel centres of a row.
    pub fn heights(&self, row: u32) -> RowHeights {
        let [x, y] = self.outline.corners[0];
        let rows = i64::from(row) * STEPS + HALF - y;
        RowHeights {
            z: self.z + rows as f64 * self.z_per_row,
            z_per_step: self.z_per_column,
            z_range: self.z_range,
            origin: (HALF - x) as i32,
        }
    }
}

/// The heights of a facet along a row of pixels.
#[derive(Debug, Clone, Copy)]
pub struct RowHeights {
    /// Height at the column of the facet's first corner, and its change per lattice step.
    z: f64,
    z_per_step: f64,
    z_range: [f32; 2],
    /// Centre of the first pixel relative to that corner, in lattice steps.
    origin: i32,
}

impl RowHeights {
    /// Height over the pixel centre of a column, in millimetres.
    #[inline]
    pub fn at(&self, column: u32) -> f32 {
        // At most 2²³ lattice steps in magnitude.
        let steps = column as i32 * STEPS as i32 + self.origin;
        let z = (self.z + f64::from(steps) * self.z_per_step) as f32;
        // By hand: `max` and `min` are library calls in wasm, `clamp` may panic.
        let [least, greatest] = self.z_range;
        let z = if least > z { least } else { z };
        if greatest < z { greatest } else { z }
    }
}

/// Steps down an edge row by row, and gives the first column whose centre is not left of it. The
/// quotient stays exact, because each step adds the quotient and the remainder of the slope.
struct Edge {
    column: i64,
    /// `column` · denominator minus the exact numerator: 0 ≤ remainder < denominator.
    remainder: i64,
    denominator: i64,
    step: i64,
    step_remainder: i64,
}

impl Edge {
    #[inline]
    fn new(from: [i64; 2], to: [i64; 2], row: i64) -> Self {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let y = row * STEPS + HALF;
        let numerator = (from[0] - HALF) * dy + (y - from[1]) * dx;
        let denominator = dy * STEPS;
        let (column, remainder) = ceil_div_rem(numerator, denominator);
        let (step, step_remainder) = ceil_div_rem(dx * STEPS, denominator);
        Self {
            column,
            remainder,
            denominator,
            step,
            step_remainder,
        }
    }

    fn step(&mut self) {
        self.column += self.step;
        self.remainder += self.step_remainder;
        if self.remainder >= self.denominator {
            self.remainder -= self.denominator;
            self.column -= 1;
        }
    }
}
