//! Surface of a print file's solid, coarse enough to display: the masks, averaged over a grid of cubes, and the surface
//! nets of the grid (Gibson, Constrained Elastic Surface Nets, 1998).

use super::{Layer, Mask};
use crate::grid::MAX_SIDE;

/// Cells along the longest side.
const CELLS: f64 = 160.0;
/// Part of a cell that is lit where the surface is: less than half, so that thin walls stay.
const LEVEL: f32 = 0.3;

/// The surface of layers with these masks, from the plate upward, as facets: nine numbers each, in millimetres, with the middle
/// of the masks at x = y = 0, counter-clockwise seen from outside. Its resolution is about a 160th of the longest side;
/// features thinner than a third of that may be missing.
///
/// `pixels` are columns and rows, and `pixel_mm` the sides of a pixel, both as the masks have them.
pub fn surface(layers: &[Layer], masks: &[Mask], pixels: [u32; 2], pixel_mm: [f64; 2]) -> Vec<f32> {
    let slabs = layers.iter().zip(masks).map(|(layer, mask)| Slab {
        mask,
        z_mm: layer.z_mm,
        thickness_mm: layer.thickness_mm,
    });
    let is_printed = |slab: &Slab<'_>| slab.thickness_mm > 0.0 && !slab.mask.rows().is_empty();
    let slabs: Vec<Slab<'_>> = slabs.filter(is_printed).collect();
    Cells::of(&slabs, pixels, pixel_mm).map_or_else(Vec::new, |cells| cells.net())
}

/// A layer that is printed.
struct Slab<'a> {
    mask: &'a Mask,
    /// Its top.
    z_mm: f64,
    thickness_mm: f64,
}

/// Lit fraction of each cell of a grid.
struct Cells {
    /// Cells in x, y and z, with a margin of empty ones.
    count: [usize; 3],
    /// The middle of the first cell, in millimetres.
    first_mm: [f64; 3],
    cell_mm: f64,
    lit: Vec<f32>,
}

impl Cells {
    /// `None` if nothing is lit.
    fn of(slabs: &[Slab<'_>], [width, height]: [u32; 2], pixel_mm: [f64; 2]) -> Option<Self> {
        let [first, end] = bounds(slabs)?;
        let low_mm = slabs.iter().map(|slab| slab.z_mm - slab.thickness_mm);
        let low_mm = low_mm.fold(f64::INFINITY, f64::min);
        let high_mm = slabs.iter().map(|slab| slab.z_mm).fold(0.0, f64::max);
        let size_mm = [
            f64::from(end[0] - first[0]) * pixel_mm[0],
            f64::from(end[1] - first[1]) * pixel_mm[1],
            high_mm - low_mm,
        ];
        let longest_mm = size_mm.into_iter().fold(0.0, f64::max);
        let cell_mm = longest_mm / CELLS;
        if !(cell_mm.is_finite() && cell_mm > 0.0) {
            return None;
        }
        let inner = size_mm.map(|side_mm| (side_mm / cell_mm).ceil().max(1.0) as usize);
        let count = inner.map(|cells| cells + 2);
        let mut cells = Self {
            count,
            first_mm: [
                (f64::from(first[0]) - f64::from(width) / 2.0) * pixel_mm[0] - cell_mm / 2.0,
                // Row 0 is at the largest y.
                (f64::from(height) / 2.0 - f64::from(end[1])) * pixel_mm[1] - cell_mm / 2.0,
                low_mm - cell_mm / 2.0,
            ],
            cell_mm,
            lit: vec![0.0; count.iter().product()],
        };
        let mut area = vec![0.0; count[0] * count[1]];
        for slab in slabs {
            area.fill(0.0);
            for row in slab.mask.rows() {
                let rows_to_end = f64::from(end[1]) - f64::from(row);
                let ends =
                    [rows_to_end - 1.0, rows_to_end].map(|rows| rows * pixel_mm[1] / cell_mm);
                for (y, row_part) in parts(ends, inner[1]) {
                    let line = &mut area[(y + 1) * count[0] + 1..][..inner[0]];
                    for run in slab.mask.row(row).chunks_exact(2) {
                        let ends = [run[0], run[1]].map(|column| {
                            (f64::from(column) - f64::from(first[0])) * pixel_mm[0] / cell_mm
                        });
                        for (x, part) in parts(ends, inner[0]) {
                            line[x] += part * row_part;
                        }
                    }
                }
            }
            let ends =
                [slab.z_mm - slab.thickness_mm, slab.z_mm].map(|z_mm| (z_mm - low_mm) / cell_mm);
            for (z, part) in parts(ends, inner[2]) {
                let plane = &mut cells.lit[(z + 1) * area.len()..][..area.len()];
                for (cell, area) in plane.iter_mut().zip(&area) {
                    *cell += area * part;
                }
            }
        }
        Some(cells)
    }

    /// The surface nets: a vertex in each cube of eight neighbours that are not all on one side of the level, and a square
    /// around each edge between neighbours that are not.
    fn net(&self) -> Vec<f32> {
        let [columns, rows, _] = self.count;
        let steps = [1, columns, columns * rows];
        let mut vertices: Vec<[f32; 3]> = Vec::new();
        // The vertices of the cubes at this height, and of those below.
        let mut planes = [vec![0u32; columns * rows], vec![0u32; columns * rows]];
        let mut facets = Vec::new();
        for z in 0..self.count[2] - 1 {
            planes.swap(0, 1);
            for y in 0..rows - 1 {
                for x in 0..columns - 1 {
                    let corner = x + y * columns + z * columns * rows;
                    let Some(place) = self.crossing(corner, steps) else {
                        continue;
                    };
                    let cube = x + y * columns;
                    planes[0][cube] = vertices.len() as u32;
                    let cell = [x, y, z];
                    vertices.push(std::array::from_fn(|axis| {
                        let cells = cell[axis] as f64 + f64::from(place[axis]);
                        (self.first_mm[axis] + cells * self.cell_mm) as f32
                    }));
                    let is_inside = self.lit[corner] >= LEVEL;
                    // Squares of four cubes around the edges from this corner; the others are behind, left and below.
                    let [here, below] = [&planes[0], &planes[1]];
                    let squares = [
                        (
                            0,
                            y > 0 && z > 0,
                            [(here, 0), (here, columns), (below, columns), (below, 0)],
                        ),
                        (
                            1,
                            x > 0 && z > 0,
                            [(here, 0), (below, 0), (below, 1), (here, 1)],
                        ),
                        (
                            2,
                            x > 0 && y > 0,
                            [(here, 0), (here, 1), (here, columns + 1), (here, columns)],
                        ),
                    ];
                    for (axis, is_whole, cubes) in squares {
                        if !is_whole || is_inside == (self.lit[corner + steps[axis]] >= LEVEL) {
                            continue;
                        }
                        let mut square = cubes.map(|(plane, back)| plane[cube - back]);
                        if !is_inside {
                            square.reverse();
                        }
                        for place in [0, 1, 2, 0, 2, 3] {
                            facets.push(square[place]);
                        }
                    }
                }
            }
        }
        let corners = facets.into_iter().map(|vertex| vertices[vertex as usize]);
        corners.flatten().collect()
    }

    /// The mean of the points where edges of a cube cross the level, in cells from its corner; `None` if none does.
    fn crossing(&self, corner: usize, steps: [usize; 3]) -> Option<[f32; 3]> {
        let at = |place: usize| {
            let offset = (0..3).map(|axis| (place >> axis & 1) * steps[axis]);
            self.lit[corner + offset.sum::<usize>()]
        };
        let lit: [f32; 8] = std::array::from_fn(at);
        let inside = lit.iter().filter(|lit| **lit >= LEVEL).count();
        if inside == 0 || inside == 8 {
            return None;
        }
        let (mut sum, mut crossings) = ([0.0; 3], 0.0f32);
        for from in 0..8usize {
            for axis in 0..3 {
                let to = from | 1 << axis;
                let (a, b) = (lit[from], lit[to]);
                if to == from || (a >= LEVEL) == (b >= LEVEL) {
                    continue;
                }
                crossings += 1.0;
                for (other, sum) in sum.iter_mut().enumerate() {
                    *sum += if other == axis {
                        (LEVEL - a) / (b - a)
                    } else {
                        (from >> other & 1) as f32
                    };
                }
            }
        }
        Some(sum.map(|sum| sum / crossings))
    }
}

/// The first column and row with a lit pixel, and the ends after the last.
fn bounds(slabs: &[Slab<'_>]) -> Option<[[u32; 2]; 2]> {
    let mut bounds = [[MAX_SIDE; 2], [0; 2]];
    for slab in slabs {
        for row in slab.mask.rows() {
            if let [first, .., end] = *slab.mask.row(row) {
                let [low, high] = &mut bounds;
                *low = [low[0].min(first.into()), low[1].min(row as u32)];
                *high = [high[0].max(end.into()), high[1].max(row as u32 + 1)];
            }
        }
    }
    (bounds[0][0] < bounds[1][0]).then_some(bounds)
}

/// The cells of a row of `count` that lie between two places, each with its part between them.
fn parts([from, to]: [f64; 2], count: usize) -> impl Iterator<Item = (usize, f32)> {
    let cells = from.max(0.0) as usize..(to.ceil() as usize).min(count);
    cells.map(move |cell| {
        let part = to.min(cell as f64 + 1.0) - from.max(cell as f64);
        (cell, part as f32)
    })
}
