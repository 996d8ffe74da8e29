//! The rays along which bodies overlap or touch, with their hits.
//!
//! All other rays pass through one body after another: each of their hits separates inside from outside. Masks and profiles
//! follow from facets alone there, so that no other hits are kept.

use std::ops::Range;

use super::projection::Projection;
use super::{Hit, LdiError, RayImage, assemble};
use crate::model::{FacetClass, FacetClasses, Mesh, Winding};
use crate::parallel;

/// The rays along which bodies overlap or touch, with their hits.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overlaps {
    /// Those of consecutive rows each, from the top row down.
    parts: Vec<Part>,
}

/// The rays of some rows along which bodies overlap.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    first_row: u32,
    /// Words of each row in `marks`.
    words: usize,
    /// A bit for each ray of each row, set if bodies overlap along it.
    marks: Vec<u64>,
    /// The end of each row in `ends`.
    rows: Vec<u32>,
    /// The end of each marked ray in `hits`.
    ends: Vec<u32>,
    hits: Vec<Hit>,
}

/// The rays of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct MeshRays<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// All rays.
    pub image: RayImage<'a>,
    /// Those along which bodies overlap; `None` if no hits are kept.
    pub overlaps: Option<&'a Overlaps>,
}

/// 1 if a ray along which no bodies overlap enters what is printed where it meets a facet, -1 if it leaves it.
#[inline]
pub fn sign_of(class: FacetClass, faces_up: bool) -> i8 {
    if (class == FacetClass::Void) == faces_up {
        1
    } else {
        -1
    }
}

/// Returns true if each hit of a ray, higher than the one before, changes between outside and inside of what is printed.
#[inline]
pub(super) fn is_plain(hits: &[Hit], classes: FacetClasses) -> bool {
    let mut last_mm = -1.0;
    let mut rises = |hit: &Hit| {
        let rises = hit.z_mm > last_mm;
        last_mm = hit.z_mm;
        rises
    };
    if classes.is_model_alone() {
        let (bodies, rest) = hits.as_chunks::<2>();
        return rest.is_empty()
            && bodies.iter().all(|[enters, leaves]| {
                rises(enters) && rises(leaves) && !enters.is_exit() && leaves.is_exit()
            });
    }
    let mut winding = Winding::default();
    let mut is_inside = false;
    hits.iter().all(|hit| {
        let class = classes.of(hit.facet());
        winding.pass(class, hit.winding());
        is_inside = !is_inside;
        let enters = sign_of(class, hit.is_exit()) > 0;
        rises(hit) && enters == is_inside && winding.is_inside() == is_inside
    })
}

impl Part {
    /// No rays, from a row of this width on.
    pub(super) fn new(first_row: u32, width: u32) -> Self {
        Self {
            first_row,
            words: width.div_ceil(64) as usize,
            marks: Vec::new(),
            rows: Vec::new(),
            ends: Vec::new(),
            hits: Vec::new(),
        }
    }

    /// Adds a ray, which comes after all that were added.
    ///
    /// # Errors
    /// [`LdiError::OutOfMemory`].
    pub(super) fn add(&mut self, row: u32, column: u32, hits: &[Hit]) -> Result<(), LdiError> {
        let end = self.hits.len() + hits.len();
        let row = (row - self.first_row) as usize;
        let more_rows = (row + 1).saturating_sub(self.rows.len());
        let fits = self.rows.try_reserve(more_rows).is_ok()
            && self.marks.try_reserve(more_rows * self.words).is_ok()
            && self.ends.try_reserve(1).is_ok()
            && self.hits.try_reserve(hits.len()).is_ok();
        let (true, Ok(end)) = (fits, u32::try_from(end)) else {
            return Err(assemble::out_of_memory(end as u64));
        };
        self.rows.resize(row + 1, self.ends.len() as u32);
        self.marks.resize((row + 1) * self.words, 0);
        self.marks[row * self.words + column as usize / 64] |= 1 << (column % 64);
        self.hits.extend_from_slice(hits);
        self.ends.push(end);
        self.rows[row] = self.ends.len() as u32;
        Ok(())
    }

    fn hits_of(&self, place: usize) -> &[Hit] {
        let start = place.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.hits[start as usize..self.ends[place] as usize]
    }

    /// The marks of a row; none if it has no such rays.
    #[inline]
    fn marks_of(&self, row: u32) -> &[u64] {
        let start = (row - self.first_row) as usize * self.words;
        self.marks.get(start..start + self.words).unwrap_or(&[])
    }

    /// The place of the first ray of a row.
    fn first_of(&self, row: u32) -> usize {
        let above = (row - self.first_row).checked_sub(1);
        above.map_or(0, |above| self.rows[above as usize] as usize)
    }
}

/// Returns the first marked column in `from..end`, or `end` if no column there is marked.
#[inline]
fn next_marked(marks: &[u64], from: u32, end: u32) -> u32 {
    let first = from / 64;
    let mut bits = marks
        .get(first as usize)
        .map_or(0, |word| word & (u64::MAX << (from % 64)));
    for word in first.. {
        if bits != 0 {
            return end.min(word * 64 + bits.trailing_zeros());
        }
        if (word + 1) * 64 >= end {
            break;
        }
        bits = marks.get(word as usize + 1).copied().unwrap_or(0);
    }
    end
}

/// The rays of a row along which bodies overlap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowOverlaps<'a> {
    /// None if there are no such rays.
    marks: &'a [u64],
}

impl RowOverlaps<'_> {
    /// The columns without those of these rays, in ranges.
    #[inline]
    pub fn others(self, columns: Range<u32>) -> impl Iterator<Item = Range<u32>> {
        let Range { mut start, end } = columns;
        std::iter::from_fn(move || {
            while start < end {
                let marked = match self.marks {
                    [] => end,
                    marks => next_marked(marks, start, end),
                };
                let range = start..marked;
                start = marked + 1;
                if !range.is_empty() {
                    return Some(range);
                }
            }
            None
        })
    }
}

impl Overlaps {
    /// Those of consecutive rows each, from the top row down.
    pub(super) fn new(parts: Vec<Part>) -> Self {
        Self { parts }
    }

    /// The part that has the rays of a row, if any has.
    fn part_of(&self, row: u32) -> Option<&Part> {
        let after = self.parts.partition_point(|part| part.first_row <= row);
        self.parts.get(after.checked_sub(1)?)
    }

    /// The rays of a row.
    #[inline]
    pub(crate) fn row(&self, row: u32) -> RowOverlaps<'_> {
        let marks = self.part_of(row).map_or(&[][..], |part| part.marks_of(row));
        RowOverlaps { marks }
    }

    /// Calls `emit` with row, column and hits of each ray of some rows of the grid.
    pub fn each_of_rows(&self, rows: Range<u32>, mut emit: impl FnMut(u32, u32, &[Hit])) {
        for row in rows {
            let Some(part) = self.part_of(row) else {
                continue;
            };
            let marks = part.marks_of(row);
            if marks.is_empty() {
                continue;
            }
            let end = marks.len() as u32 * 64;
            let mut column = next_marked(marks, 0, end);
            for place in part.first_of(row).. {
                if column == end {
                    break;
                }
                emit(row, column, part.hits_of(place));
                column = next_marked(marks, column + 1, end);
            }
        }
    }

    /// Calls `look` with the hits of each ray.
    pub(crate) fn each(&self, look: impl Fn(&[Hit]) + Sync + Send) {
        self.all(|hits| {
            look(hits);
            true
        });
    }

    /// Returns true if `holds` is true for the hits of all rays.
    pub(super) fn all(&self, holds: impl Fn(&[Hit]) -> bool + Sync + Send) -> bool {
        let parts = parallel::map(self.parts.iter().collect(), |part| {
            (0..part.ends.len()).all(|place| holds(part.hits_of(place)))
        });
        parts.into_iter().all(|all| all)
    }

    /// Calls `visit` with the height at which each other ray meets a facet, until it returns true; returns whether it did.
    pub(crate) fn any_other(
        &self,
        projection: &Projection<'_>,
        facet: u32,
        mut visit: impl FnMut(f32) -> bool,
    ) -> bool {
        let Some(projected) = projection.facet(facet as usize) else {
            return false;
        };
        let mut is_done = false;
        let rows = projection.rows(facet as usize);
        projected.outline.for_each_span(rows, |row, columns| {
            if is_done {
                return;
            }
            let heights = projected.heights(row);
            is_done = self
                .row(row)
                .others(columns)
                .flatten()
                .any(|column| visit(heights.at(column)));
        });
        is_done
    }
}
