//! Tiles of a grid, and the joining of their results.

use super::failed;
use crate::grid::Grid;
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, Ldi, LdiError, assemble};
use crate::model::FacetClasses;
use crate::progress::Progress;

/// The size of tiles, which bounds the GPU memory that sampling takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tiling {
    /// Longest side of a tile in pixels, at most 4096: the default limits of WebGPU hold such a tile.
    pub side: u32,
}

impl Default for Tiling {
    /// Tiles of 4096 × 4096 pixels. Counts and offsets of one take 128 MiB.
    fn default() -> Self {
        Self { side: MAX_SIDE }
    }
}

const MAX_SIDE: u32 = 4096;

/// A rectangle of the grid, in pixels.
#[derive(Debug, Clone, Copy)]
pub struct Region {
    /// Its first column.
    pub column: u32,
    /// Its first row.
    pub row: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The facets that the rays of a region meet, in compressed rows: those of ray i are
/// `facets[offsets[i]..offsets[i + 1]]`, in any order.
#[derive(Debug)]
pub struct Intersections {
    /// Start of each ray's facets, and the end of the last ray's.
    pub offsets: Vec<u32>,
    /// The facets of all rays.
    pub facets: Vec<u32>,
}

/// Joins the tiles, computes heights and sorts the hits of each ray.
pub(super) fn join(
    projection: &Projection<'_>,
    grid: &Grid,
    classes: FacetClasses,
    sampled: &[(Region, Intersections)],
    progress: &mut Progress<'_>,
) -> Result<Ldi, LdiError> {
    let mut offsets: Vec<u32> = assemble::zeroed(grid.pixels() + 1)?;
    for (region, intersections) in sampled {
        for row in 0..region.height {
            let from = (row * region.width) as usize;
            let to = ((region.row + row) * grid.width + region.column) as usize;
            for column in 0..region.width as usize {
                let [first, end] = [0, 1].map(|next| intersections.offsets[from + column + next]);
                // Offsets that overflow 32 bits would decrease.
                offsets[to + column + 1] = end
                    .checked_sub(first)
                    .ok_or_else(|| failed(GpuFault::TooManyHits))?;
            }
        }
    }
    assemble::accumulate(&mut offsets)?;
    let mut facets: Vec<u32> = assemble::zeroed(offsets[grid.pixels()] as usize)?;
    for (region, intersections) in sampled {
        for row in 0..region.height {
            // The hits of a tile's row are contiguous in the tile and in the grid.
            let from = (row * region.width) as usize;
            let from =
                intersections.offsets[from]..intersections.offsets[from + region.width as usize];
            let to = offsets[((region.row + row) * grid.width + region.column) as usize];
            let row = &intersections.facets[from.start as usize..from.end as usize];
            facets[to as usize..to as usize + row.len()].copy_from_slice(row);
        }
    }
    let hits = assemble::hits_of_facets(projection, grid, &offsets, &facets, progress, [0.8, 1.0])?;
    Ok(Ldi {
        grid: *grid,
        offsets,
        hits,
        classes,
    })
}
