//! The LDI by scanline on the CPU: count, then fill.
//!
//! Rows are processed in bands, in parallel natively. Cost: linear in facets, in the rows that they span,
//! and in hits. Memory: 8 bytes per hit and 4 per ray.

use std::ops::Range;

use super::projection::{Projection, RowHeights};
use super::rays::{BAND_ROWS, Rays};
use super::{Hit, Ldi, LdiError, assemble};
use crate::grid::Grid;
use crate::model::{FacetClasses, FacetLists, Mesh};
use crate::parallel::map_in_groups;
use crate::progress::{Progress, report};

/// Samples `mesh`, which lies inside `grid` and above z = 0.
///
/// # Errors
/// [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`], [`LdiError::Cancelled`].
pub fn sample(mesh: &Mesh, grid: &Grid, progress: &mut Progress<'_>) -> Result<Ldi, LdiError> {
    super::check_facets(mesh)?;
    report(progress, 0.0)?;
    let projection = Projection::new(mesh, grid);
    let scan = Scan::new(&projection, grid, mesh.classes);
    let mut offsets: Vec<u32> = assemble::zeroed(grid.pixels() + 1)?;
    let band_rays = BAND_ROWS as usize * grid.width as usize;

    map_in_groups(
        offsets[1..].chunks_mut(band_rays).enumerate(),
        |(band, counts)| scan.count(band, counts),
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
            let base = offsets[0];
            let cursors = offsets.iter().map(|offset| offset - base).collect();
            scan.fill(band, cursors, hits);
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

/// Heights in millimetres between which hits are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// Hits at this height are below it.
    pub above_mm: f64,
    /// Hits at this height belong to it.
    pub to_mm: f64,
}

impl Slab {
    fn contains(self, z_mm: f32) -> bool {
        let z_mm = f64::from(z_mm);
        self.above_mm < z_mm && z_mm <= self.to_mm
    }

    /// Returns true if it contains all heights of a facet with these corners.
    fn covers(self, corners_mm: [f32; 3]) -> bool {
        corners_mm.into_iter().all(|z_mm| self.contains(z_mm))
    }

    /// Returns true if a facet with these corners may reach into it.
    fn meets(self, corners_mm: [f32; 3]) -> bool {
        let corners_mm = corners_mm.map(f64::from);
        corners_mm.iter().any(|&z_mm| self.above_mm < z_mm)
            && corners_mm.iter().any(|&z_mm| z_mm <= self.to_mm)
    }
}

/// The facets of a mesh over a grid in bands of rows, to find the hits of any band.
#[derive(Debug)]
pub struct Scan<'a> {
    projection: &'a Projection<'a>,
    grid: Grid,
    bands: FacetLists,
    classes: FacetClasses,
}

/// The pixels of a facet in a row.
#[derive(Debug, Clone, Copy)]
struct FacetSpan {
    /// The first column, and the one after the last.
    columns: [u32; 2],
    /// A hit at height 0.
    surface: Hit,
    heights: RowHeights,
}

impl FacetSpan {
    #[inline]
    fn hit(&self, column: u32) -> Hit {
        Hit {
            z_mm: self.heights.at(column),
            ..self.surface
        }
    }
}

/// The rays of some rows, as a [`Scan`] finds them.
#[derive(Debug)]
pub struct ScannedRays {
    first_row: u32,
    width: u32,
    offsets: Vec<u32>,
    hits: Vec<Hit>,
    classes: FacetClasses,
}

impl ScannedRays {
    /// The rays.
    pub fn rays(&self) -> Rays<'_> {
        Rays {
            first_row: self.first_row,
            width: self.width,
            offsets: &self.offsets,
            hits: &self.hits,
            classes: self.classes,
        }
    }

    /// Adds the rays of the rows that follow.
    fn append(&mut self, rows: Rays<'_>) {
        let base = self.hits.len() as u32;
        let ends = rows.offsets[1..].iter();
        self.offsets.extend(ends.map(|offset| base + offset));
        self.hits.extend_from_slice(rows.hits);
    }
}

/// The rays of a row as they are found. Most have two hits. As every ray closes, one of the two faces down and the other up, which tells
/// them apart, so nothing needs sorting.
#[derive(Debug)]
pub struct RayRow {
    /// The row of the grid.
    pub row: u32,
    /// Number of hits of each ray.
    counts: Vec<u32>,
    /// The hits of rays that have two, the one that faces up last.
    pairs: Vec<[Hit; 2]>,
    /// The end of each other ray in `hits`.
    ends: Vec<u32>,
    hits: Vec<Hit>,
}

/// Rays side by side in a row.
pub enum RowPart<'a> {
    /// Rays that have two hits each, the one that faces up last.
    Pairs(&'a mut [[Hit; 2]]),
    /// A ray with its hits in order.
    Ray(&'a [Hit]),
}

impl RayRow {
    fn new(width: usize) -> Self {
        Self {
            row: 0,
            counts: vec![0; width],
            pairs: vec![bytemuck::Zeroable::zeroed(); width],
            ends: vec![0; width],
            hits: Vec::new(),
        }
    }

    fn fill(&mut self, spans: &[FacetSpan]) {
        self.counts.fill(0);
        for span in spans {
            add_span(&mut self.counts, span.columns);
        }
        let (mut open, mut total) = (0u32, 0);
        for (count, end) in self.counts.iter_mut().zip(&mut self.ends) {
            open = open.wrapping_add(*count);
            *count = open;
            *end = total;
            total += if open == 2 { 0 } else { open };
        }
        self.hits
            .resize(total as usize, bytemuck::Zeroable::zeroed());
        for &span in spans {
            let [from, to] = span.columns;
            let columns = from as usize..to as usize;
            let is_exit = usize::from(span.surface.is_exit());
            let pairs = (from..to).zip(&mut self.pairs[columns.clone()]);
            if total == 0 {
                for (column, pair) in pairs {
                    pair[is_exit] = span.hit(column);
                }
                continue;
            }
            let others = self.counts[columns.clone()]
                .iter()
                .zip(&mut self.ends[columns]);
            for ((column, pair), (&count, end)) in pairs.zip(others) {
                if count == 2 {
                    pair[is_exit] = span.hit(column);
                } else {
                    self.hits[*end as usize] = span.hit(column);
                    *end += 1;
                }
            }
        }
    }

    /// Calls `take` with each stretch of rays that have two hits, and each other ray that has any, by their first column.
    pub fn each(&mut self, mut take: impl FnMut(u32, RowPart<'_>)) {
        let mut first = 0;
        for counts in self.counts.chunk_by(|a, b| a == b) {
            let columns = first..first + counts.len();
            let part = columns.start as u32;
            first = columns.end;
            match counts[0] {
                0 => {}
                2 => take(part, RowPart::Pairs(&mut self.pairs[columns])),
                count => {
                    for (column, &end) in (part..).zip(&self.ends[columns]) {
                        let ray = &mut self.hits[(end - count) as usize..end as usize];
                        assemble::sort_ray(ray);
                        take(column, RowPart::Ray(ray));
                    }
                }
            }
        }
    }
}

impl<'a> Scan<'a> {
    /// A scan of all facets.
    pub fn new(projection: &'a Projection<'a>, grid: &Grid, classes: FacetClasses) -> Self {
        let facets = 0..projection.facets() as u32;
        Self::of(projection, grid, classes, facets)
    }

    /// A scan of the facets that reach into a slab.
    pub fn of_slab(
        projection: &'a Projection<'a>,
        grid: &Grid,
        classes: FacetClasses,
        slab: Slab,
    ) -> Self {
        let facets = 0..projection.facets() as u32;
        let meets = |&facet: &u32| slab.meets(projection.heights(facet as usize));
        Self::of(projection, grid, classes, facets.filter(meets))
    }

    fn of(
        projection: &'a Projection<'a>,
        grid: &Grid,
        classes: FacetClasses,
        facets: impl Iterator<Item = u32> + Clone,
    ) -> Self {
        let bands = grid.height.div_ceil(BAND_ROWS) as usize;
        let bands = projection.in_bands(bands, facets, |row| (row / BAND_ROWS) as usize);
        Self {
            projection,
            grid: *grid,
            bands,
            classes,
        }
    }

    fn rows(&self, band: usize) -> Range<u32> {
        let first = band as u32 * BAND_ROWS;
        first..(first + BAND_ROWS).min(self.grid.height)
    }

    /// The rays of some rows.
    pub(super) fn of_rows(&self, rows: Range<u32>) -> ScannedRays {
        self.scanned(rows, None)
    }

    /// The rays of some rows with their hits in a slab, up to the end of a band: as many of the rows as are returned.
    pub fn first_of(&self, rows: Range<u32>, slab: Slab) -> ScannedRays {
        let band = (rows.start / BAND_ROWS) as usize;
        let end = self.rows(band).end.min(rows.end);
        self.scanned(rows.start..end, Some(slab))
    }

    fn scanned(&self, rows: Range<u32>, slab: Option<Slab>) -> ScannedRays {
        let mut all = ScannedRays {
            first_row: rows.start,
            width: self.grid.width,
            offsets: Vec::with_capacity(rows.len() * self.grid.width as usize + 1),
            hits: Vec::new(),
            classes: self.classes,
        };
        all.offsets.push(0);
        for band in (rows.start / BAND_ROWS) as usize..rows.end.div_ceil(BAND_ROWS) as usize {
            let of_band = self.rows(band);
            let rows = rows.start.max(of_band.start)..rows.end.min(of_band.end);
            self.each_row(rows, slab, &mut |row| all.append(row));
        }
        all
    }

    /// Calls `take` with the rays of some rows of a band, row by row: their hits are found and sorted in the cache.
    pub(super) fn each_row(
        &self,
        rows: Range<u32>,
        slab: Option<Slab>,
        take: &mut dyn FnMut(Rays<'_>),
    ) {
        let mut offsets = vec![0u32; self.grid.width as usize + 1];
        let mut hits: Vec<Hit> = Vec::new();
        for (first_row, spans) in rows.clone().zip(self.spans(rows, slab)) {
            offsets.fill(0);
            let starts = &mut offsets[1..];
            for span in &spans {
                add_span(starts, span.columns);
            }
            // Starts are stored one slot ahead: filling then advances each to where it belongs.
            let (mut open, mut total) = (0u32, 0);
            for start in &mut *starts {
                open = open.wrapping_add(*start);
                *start = total;
                total += open;
            }
            hits.resize(total as usize, bytemuck::Zeroable::zeroed());
            for &span in &spans {
                let [from, to] = span.columns;
                let starts = &mut starts[from as usize..to as usize];
                for (column, start) in (from..to).zip(starts) {
                    hits[*start as usize] = span.hit(column);
                    *start += 1;
                }
            }
            assemble::sort_rays(&offsets, &mut hits);
            take(Rays {
                first_row,
                width: self.grid.width,
                offsets: &offsets,
                hits: &hits,
                classes: self.classes,
            });
        }
    }

    /// Calls `take` with some rows of a band, whose rays are not sorted.
    pub(super) fn each_unsorted(&self, rows: Range<u32>, take: &mut dyn FnMut(&mut RayRow)) {
        let mut found = RayRow::new(self.grid.width as usize);
        for (row, spans) in rows.clone().zip(self.spans(rows, None)) {
            found.row = row;
            found.fill(&spans);
            take(&mut found);
        }
    }

    /// The spans of facets in each of some rows of a band: with a slab, only their pixels in it.
    fn spans(&self, rows: Range<u32>, slab: Option<Slab>) -> Vec<Vec<FacetSpan>> {
        let facets = self.bands.of((rows.start / BAND_ROWS) as usize);
        let mut spans: Vec<Vec<FacetSpan>> = Vec::new();
        spans.resize_with(rows.len(), Vec::new);
        for &index in facets {
            let Some(facet) = self.projection.facet(index as usize) else {
                continue;
            };
            let crossed = slab.filter(|slab| !slab.covers(self.projection.heights(index as usize)));
            facet.outline.for_each_span(rows.clone(), |row, columns| {
                let spans = &mut spans[(row - rows.start) as usize];
                let mut span = FacetSpan {
                    columns: [columns.start, columns.end],
                    surface: Hit::new(0.0, index, facet.faces_up),
                    heights: facet.heights(row),
                };
                let Some(slab) = crossed else {
                    return spans.push(span);
                };
                for column in columns {
                    if slab.contains(span.heights.at(column)) {
                        span.columns = [column, column + 1];
                        spans.push(span);
                    }
                }
            });
        }
        spans
    }

    /// Writes the number of hits of every ray of a band: first the differences at the ends of spans, then their running
    /// sums along the rows.
    fn count(&self, band: usize, counts: &mut [u32]) {
        let width = self.grid.width as usize;
        let rows = self.rows(band);
        let mut add = |row: u32, columns: Range<u32>| {
            let start = (row - rows.start) as usize * width;
            add_span(
                &mut counts[start..start + width],
                [columns.start, columns.end],
            );
        };
        for &facet in self.bands.of(band) {
            if let Some(outline) = self.projection.outline(facet as usize) {
                outline.for_each_span(rows.clone(), &mut add);
            }
        }
        for row in counts.chunks_mut(width) {
            let mut open = 0u32;
            for count in row {
                open = open.wrapping_add(*count);
                *count = open;
            }
        }
    }

    /// Writes the hits of the rays of a band at their cursors, in any order within a ray.
    fn fill(&self, band: usize, mut cursors: Vec<u32>, hits: &mut [Hit]) {
        let width = self.grid.width as usize;
        let rows = self.rows(band);
        for &index in self.bands.of(band) {
            let Some(facet) = self.projection.facet(index as usize) else {
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
}

/// Adds the differences at the ends of a span to those of the counts of a row.
#[inline]
fn add_span(differences: &mut [u32], [from, to]: [u32; 2]) {
    let first = &mut differences[from as usize];
    *first = first.wrapping_add(1);
    if let Some(after) = differences.get_mut(to as usize) {
        *after = after.wrapping_sub(1);
    }
}
