//! The LDI by scanline on the CPU: count, then fill.
//!
//! Rows are processed in bands, in parallel natively. Cost: linear in facets, in the rows that they span,
//! and in hits. Memory: 8 bytes per hit and 4 per ray.

use super::projection::Projection;
use super::{Hit, Ldi, LdiError, assemble};
use crate::grid::Grid;
use crate::model::{FacetLists, Mesh};
use crate::parallel::map_in_groups;
use crate::progress::{Progress, report};

/// Rows of a band: few enough for the cursors of its rays to stay in the cache.
const BAND_ROWS: u32 = 32;

/// Samples `mesh`, which lies inside `grid` and above z = 0.
///
/// # Errors
/// [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`], [`LdiError::Cancelled`].
pub fn sample(mesh: &Mesh, grid: &Grid, progress: &mut Progress<'_>) -> Result<Ldi, LdiError> {
    super::check_facets(mesh)?;
    report(progress, 0.0)?;
    let projection = Projection::new(mesh, grid);
    let bands = facets_by_band(&projection, grid);
    let facets_of = |band: usize| &bands.all()[bands.range(band)];
    let mut offsets: Vec<u32> = assemble::zeroed(grid.pixels() + 1)?;
    let band_rays = BAND_ROWS as usize * grid.width as usize;

    map_in_groups(
        offsets[1..].chunks_mut(band_rays).enumerate(),
        |(band, counts)| count_band(&projection, grid, band, facets_of(band), counts),
        |()| Ok::<_, LdiError>(()),
        progress,
        [0.05, 0.35],
    )?;
    assemble::accumulate(&mut offsets)?;

    let mut hits: Vec<Hit> = assemble::zeroed(offsets[grid.pixels()] as usize)?;
    map_in_groups(
        assemble::by_rays(&offsets, &mut hits, band_rays)
            .into_iter()
            .enumerate(),
        |(band, (offsets, hits))| {
            fill_band(&projection, grid, band, facets_of(band), offsets, hits);
            assemble::sort_rays(offsets, hits);
        },
        |()| Ok::<_, LdiError>(()),
        progress,
        [0.35, 1.0],
    )?;
    Ok(Ldi {
        grid: *grid,
        offsets,
        hits,
        classes: mesh.classes,
    })
}

/// The facets that reach into each band.
fn facets_by_band(projection: &Projection<'_>, grid: &Grid) -> FacetLists {
    let bands = grid.height.div_ceil(BAND_ROWS) as usize;
    FacetLists::new(bands, 0..projection.facets() as u32, |facet| {
        let rows = projection.rows(facet as usize);
        if rows.is_empty() {
            0..0
        } else {
            (rows.start / BAND_ROWS) as usize..rows.end.div_ceil(BAND_ROWS) as usize
        }
    })
}

fn rows_of(band: usize, grid: &Grid) -> std::ops::Range<u32> {
    let first = band as u32 * BAND_ROWS;
    first..(first + BAND_ROWS).min(grid.height)
}

/// Writes the number of hits of every ray of a band: first the differences at the ends of spans, then
/// their running sums along the rows.
fn count_band(
    projection: &Projection<'_>,
    grid: &Grid,
    band: usize,
    facets: &[u32],
    counts: &mut [u32],
) {
    let rows = rows_of(band, grid);
    let width = grid.width as usize;
    for &facet in facets {
        let Some(outline) = projection.outline(facet as usize) else {
            continue;
        };
        outline.for_each_span(rows.clone(), |row, columns| {
            let start = (row - rows.start) as usize * width;
            let counts = &mut counts[start..start + width];
            counts[columns.start as usize] = counts[columns.start as usize].wrapping_add(1);
            if let Some(after) = counts.get_mut(columns.end as usize) {
                *after = after.wrapping_sub(1);
            }
        });
    }
    for row in counts.chunks_mut(width) {
        let mut open = 0u32;
        for count in row {
            open = open.wrapping_add(*count);
            *count = open;
        }
    }
}

/// Writes the hits of a band. Within a ray they are in the order of facets.
fn fill_band(
    projection: &Projection<'_>,
    grid: &Grid,
    band: usize,
    facets: &[u32],
    offsets: &[u32],
    hits: &mut [Hit],
) {
    let rows = rows_of(band, grid);
    let width = grid.width as usize;
    let base = offsets[0];
    let mut cursors: Vec<u32> = offsets.iter().map(|offset| offset - base).collect();
    for &index in facets {
        let Some(facet) = projection.facet(index as usize) else {
            continue;
        };
        facet.outline.for_each_span(rows.clone(), |row, columns| {
            let heights = facet.heights(row);
            let start = (row - rows.start) as usize * width;
            let cursors =
                &mut cursors[start + columns.start as usize..start + columns.end as usize];
            for (column, cursor) in columns.zip(cursors) {
                hits[*cursor as usize] = Hit::new(heights.at(column), index, facet.faces_up);
                *cursor += 1;
            }
        });
    }
}
