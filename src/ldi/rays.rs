//! The rays of a mesh band by band, either held by an LDI or found again in each pass.

use std::ops::Range;

use super::cpu::{RayRow, Scan, ScannedRays};
use super::projection::Projection;
use super::{Hit, Ldi};
use crate::grid::Grid;
use crate::model::{FacetClasses, Mesh};
use crate::parallel;
use crate::progress::{Cancelled, Progress, report};

/// Rows of a band: few enough for the cursors of its rays to stay in the cache.
pub(super) const BAND_ROWS: u32 = 32;
/// Parts of an image that are passed over side by side. Sums over rays are made part by part, so they do not depend on the number
/// of threads.
const PARTS: usize = 16;
/// Number of progress reports of a pass that finds rays again.
const ROUNDS: usize = 64;

/// The hits of some whole rows of rays.
#[derive(Debug, Clone, Copy)]
pub struct Rays<'a> {
    /// The first of the rows.
    pub first_row: u32,
    /// Number of columns.
    pub width: u32,
    /// Start of the hits of each ray, and the end of the last ray's. The first number is that of `hits[0]`.
    pub offsets: &'a [u32],
    /// The hits of all of these rays, sorted by (height, facet) within each ray.
    pub hits: &'a [Hit],
    /// Classes of the facets of the sampled mesh.
    pub classes: FacetClasses,
}

impl<'a> Rays<'a> {
    /// Number of rays.
    pub fn count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The hits of a ray, counted from the first one of these rows, from the plate upward.
    #[inline]
    pub fn ray(&self, ray: usize) -> &'a [Hit] {
        let base = self.offsets[0];
        let [from, to] = [0, 1].map(|next| (self.offsets[ray + next] - base) as usize);
        &self.hits[from..to]
    }

    /// The hits of each ray, row by row.
    #[inline]
    pub fn each(self) -> impl Iterator<Item = &'a [Hit]> {
        let base = self.offsets[0];
        self.offsets
            .windows(2)
            .map(move |ends| &self.hits[(ends[0] - base) as usize..(ends[1] - base) as usize])
    }
}

/// Permission to work without hits and masks in memory.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Anew;

/// Permission to work without hits and masks in memory, which browsers never have: the type has no values, so that code is not
/// compiled.
#[cfg(target_arch = "wasm32")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anew {}

/// The rays of a mesh, to be passed over once or several times.
#[derive(Debug, Clone, Copy)]
pub enum RayImage<'a> {
    /// The rays of an LDI.
    Kept(&'a Ldi),
    /// The rays of a mesh through a grid, found again in every pass by the CPU: a band of rows per thread is in memory.
    Scanned {
        /// The mesh.
        mesh: &'a Mesh,
        /// The grid whose pixel centres the rays pass.
        grid: Grid,
    },
}

/// Source of a pass's bands.
#[derive(Debug)]
enum Bands<'a> {
    Kept(&'a Ldi),
    /// Rays that each pass scans again.
    Scanned(Scan<'a>),
}

/// The rays of an image, which are read in any order.
#[derive(Debug)]
pub struct RayRows<'a> {
    /// The grid whose pixel centres the rays pass.
    pub grid: Grid,
    /// Classes of the facets of the sampled mesh.
    pub classes: FacetClasses,
    source: Bands<'a>,
}

/// Rays that an LDI holds, or that were found.
#[derive(Debug)]
pub enum HeldRays<'a> {
    /// Rays of an LDI.
    Kept(Rays<'a>),
    /// Rays that were found.
    Scanned(ScannedRays),
}

impl HeldRays<'_> {
    /// The rays.
    pub fn rays(&self) -> Rays<'_> {
        match self {
            Self::Kept(rays) => *rays,
            Self::Scanned(scanned) => scanned.rays(),
        }
    }
}

impl RayRows<'_> {
    /// [`RayImage::fold`].
    fn fold<T: Send>(
        &self,
        first: impl Fn() -> T,
        step: impl Fn(&mut T, Rays<'_>) + Sync + Send,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<T>, Cancelled> {
        let step = |value: &mut T, rows| {
            // One instance of `step` for both sources keeps the module of browsers small.
            let take: &mut dyn FnMut(Rays<'_>) = &mut |rays| step(value, rays);
            match &self.source {
                Bands::Kept(ldi) => take(ldi.rows(rows)),
                Bands::Scanned(scan) => scan.each_row(rows, None, take),
            }
        };
        self.fold_bands(first, step, progress)
    }

    /// The same with a step for each source: one for rays of an LDI, one for rows that are found and not sorted.
    pub(super) fn fold_rows<T: Send>(
        &self,
        first: impl Fn() -> T,
        kept: impl Fn(&mut T, Rays<'_>) + Sync + Send,
        found: impl Fn(&mut T, &mut RayRow) + Sync + Send,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<T>, Cancelled> {
        let step = |value: &mut T, rows| match &self.source {
            Bands::Kept(ldi) => kept(value, ldi.rows(rows)),
            Bands::Scanned(scan) => scan.each_unsorted(rows, &mut |row| found(value, row)),
        };
        self.fold_bands(first, step, progress)
    }

    fn fold_bands<T: Send>(
        &self,
        first: impl Fn() -> T,
        step: impl Fn(&mut T, Range<u32>) + Sync + Send,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<T>, Cancelled> {
        let height = self.grid.height;
        let bands = height.div_ceil(BAND_ROWS) as usize;
        let part_bands = bands.div_ceil(PARTS).max(1);
        let rounds = match self.source {
            Bands::Kept(_) => 1,
            Bands::Scanned(..) => ROUNDS,
        };
        let round_bands = part_bands.div_ceil(rounds);
        let starts = (0..bands).step_by(part_bands);
        let mut parts: Vec<(usize, T)> = starts.map(|band| (band, first())).collect();
        for round in (0..part_bands).step_by(round_bands) {
            report(progress, round as f64 / part_bands as f64)?;
            parts = parallel::map(parts, |(start, mut value)| {
                let end = (start + part_bands).min(bands);
                for band in start + round..(start + round + round_bands).min(end) {
                    let first_row = band as u32 * BAND_ROWS;
                    let rows = first_row..(first_row + BAND_ROWS).min(height);
                    step(&mut value, rows);
                }
                (start, value)
            });
        }
        Ok(parts.into_iter().map(|(_, value)| value).collect())
    }

    /// Some rows of rays.
    ///
    /// Cost: nothing for rays of an LDI; otherwise linear in the facets, rows and hits of the bands of 32 rows that these meet.
    pub fn of(&self, rows: Range<u32>) -> HeldRays<'_> {
        match &self.source {
            Bands::Kept(ldi) => HeldRays::Kept(ldi.rows(rows)),
            Bands::Scanned(scan) => HeldRays::Scanned(scan.of_rows(rows)),
        }
    }
}

impl RayImage<'_> {
    /// The grid whose pixel centres the rays pass.
    pub fn grid(&self) -> &Grid {
        match self {
            Self::Kept(ldi) => &ldi.grid,
            Self::Scanned { grid, .. } => grid,
        }
    }

    /// Classes of the facets of the sampled mesh.
    pub fn classes(&self) -> FacetClasses {
        match self {
            Self::Kept(ldi) => ldi.classes,
            Self::Scanned { mesh, .. } => mesh.classes,
        }
    }

    /// Passes over all rays, part by part side by side: `step` takes the value of its part and the next rays of it, from `first`
    /// on. Returns the values of the parts in the order of rows. They are the same for a mesh and its LDI.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn fold<T: Send>(
        self,
        first: impl Fn() -> T,
        step: impl Fn(&mut T, Rays<'_>) + Sync + Send,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<T>, Cancelled> {
        self.read(|image| image.fold(first, step, progress))
    }

    /// Reads the rays in any order: `read` is called once.
    pub(crate) fn read<T>(self, read: impl FnOnce(&RayRows<'_>) -> T) -> T {
        let (grid, classes) = (*self.grid(), self.classes());
        let projection;
        let source = match self {
            Self::Kept(ldi) => Bands::Kept(ldi),
            Self::Scanned { mesh, ref grid } => {
                projection = Projection::new(mesh, grid);
                Bands::Scanned(Scan::new(&projection, grid, mesh.classes))
            }
        };
        read(&RayRows {
            grid,
            classes,
            source,
        })
    }

    /// Returns true if `holds` is true for all rays.
    pub(super) fn all(
        self,
        holds: impl Fn(&[Hit]) -> bool + Sync + Send,
        progress: &mut Progress<'_>,
    ) -> Result<bool, Cancelled> {
        let step = |all: &mut bool, rays: Rays<'_>| *all = *all && rays.each().all(&holds);
        Ok(self
            .fold(|| true, step, progress)?
            .into_iter()
            .all(|all| all))
    }
}

impl Ldi {
    fn rows(&self, rows: Range<u32>) -> Rays<'_> {
        let width = self.grid.width as usize;
        let offsets = &self.offsets[rows.start as usize * width..=rows.end as usize * width];
        Rays {
            first_row: rows.start,
            width: self.grid.width,
            offsets,
            hits: &self.hits[offsets[0] as usize..offsets[offsets.len() - 1] as usize],
            classes: self.classes,
        }
    }
}
