//! Facets, and parts of facets, that lie inside the solid where bodies overlap.
//!
//! On a facet the visible part ends where another facet passes through it. Between the heights of such creases it is therefore
//! visible all along or nowhere, and the rays that meet it there show which.

use std::ops::Range;
use std::sync::atomic::AtomicU8;
use std::sync::atomic::Ordering::Relaxed;

use super::facet_bins::FacetBins;
use crate::ldi::projection::Projection;
use crate::ldi::visibility::each_of_model;
use crate::ldi::{Hit, MeshRays, Rays};
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// Facets of a surface that are hidden, as a whole or in part.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hidden {
    /// For each facet, true if it is wholly hidden; may be empty.
    facets: Vec<bool>,
    /// The bins in which other facets are hidden.
    parts: FacetSpans,
}

const ON_SURFACE: u8 = 1;
const INSIDE: u8 = 2;

impl Hidden {
    /// Hides whole facets.
    pub fn whole(facets: Vec<bool>) -> Self {
        Self {
            facets,
            parts: FacetSpans::default(),
        }
    }

    /// Also hides parts of those facets that are `partly_inside`. `creases` has the bins that creases meet on each facet. A part that
    /// no ray meets counts as visible.
    ///
    /// Cost: if a facet that is not upright has parts without creases, a pass over the rays that overlap, or over all if those are not
    /// known.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn with_parts(
        self,
        facet_bins: &FacetBins,
        partly_inside: &[u32],
        mut creases: Vec<(u32, [u32; 2])>,
        rays: MeshRays<'_>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let count = facet_bins.spans.len();
        creases.sort_unstable();
        let creases_on = |facet: usize| {
            let first = creases.partition_point(|crease| (crease.0 as usize) < facet);
            let on_facet = creases[first..].iter();
            let on_facet = on_facet.take_while(move |crease| crease.0 as usize == facet);
            on_facet.map(|&(_, span)| span)
        };
        let sloping = partly_inside.iter().map(|&facet| facet as usize);
        // Rays meet no upright facet, and it raises no largest `n_z²`.
        let sloping = sloping.filter(|&facet| facet_bins.n_z_squared[facet] > 0.0);
        let between = sloping.flat_map(|facet| {
            let span = facet_bins.spans[facet];
            rest(span, creases_on(facet)).map(move |part| (facet as u32, part))
        });
        let parts = FacetSpans::new(count, between.collect());
        if parts.spans.is_empty() {
            return Ok(self);
        }
        let seen: Vec<AtomicU8> = parts.spans.iter().map(|_| AtomicU8::new(0)).collect();
        let note = |facet: u32, z_mm: f32, place: u8| {
            let bin = facet_bins.bins.of(f64::from(z_mm)) as u32;
            if let Some(part) = parts.at(facet, bin) {
                seen[part].fetch_or(place, Relaxed);
            }
        };
        let model_end = rays.mesh.classes.model_end();
        let look_along = |hits: &[Hit]| {
            // Few rays meet a facet in question.
            if hits.iter().all(|hit| parts.range(hit.facet()).is_empty()) {
                return;
            }
            each_of_model(hits, model_end, |hit, is_inside| {
                let place = if is_inside { INSIDE } else { ON_SURFACE };
                note(hit.facet(), hit.z_mm, place);
            });
        };
        if let Some(overlaps) = rays.overlaps {
            overlaps.each(look_along);
            let projection = Projection::new(rays.mesh, rays.image.grid());
            let mut facets: Vec<u32> = parts.each().map(|(facet, _)| facet).collect();
            facets.dedup();
            parallel::map(facets, |facet| {
                overlaps.any_other(&projection, facet, |z_mm| {
                    note(facet, z_mm, ON_SURFACE);
                    false
                });
            });
        } else {
            let look = |(): &mut (), rays: Rays<'_>| rays.each().for_each(look_along);
            rays.image.fold(|| (), look, progress)?;
        }
        let hidden = parts.each().zip(seen);
        let hidden =
            hidden.filter_map(|(part, seen)| (seen.into_inner() == INSIDE).then_some(part));
        Ok(Self {
            parts: FacetSpans::new(count, hidden.collect()),
            ..self
        })
    }

    /// For each facet, true if it is wholly hidden; may be empty.
    pub fn facets(&self) -> &[bool] {
        &self.facets
    }

    /// Returns true if all or a part of a facet is visible.
    #[inline]
    pub fn is_seen(&self, facet: usize) -> bool {
        self.facets.get(facet) != Some(&true)
    }

    /// Returns true if no facet is hidden in part.
    pub fn is_by_facets(&self) -> bool {
        self.parts.spans.is_empty()
    }

    /// Returns true if a part of a facet is hidden that meets this bin.
    #[inline]
    pub fn hides_part(&self, facet: u32, bin: u32) -> bool {
        self.parts.at(facet, bin).is_some()
    }

    /// The bins of `span` in which a facet is visible, which is not wholly hidden.
    #[inline]
    pub fn seen_in(&self, facet: u32, span: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
        rest(span, self.parts.of(facet).iter().copied())
    }
}

/// The bins of `span` without those of `taken`, which are in ascending order and may overlap.
#[inline]
fn rest(
    [mut from, last]: [u32; 2],
    taken: impl Iterator<Item = [u32; 2]>,
) -> impl Iterator<Item = [u32; 2]> {
    let end = last + 1;
    taken.chain([[end; 2]]).filter_map(move |[first, last]| {
        let gap = [from, first.min(end)];
        from = from.max(last + 1);
        (gap[0] < gap[1]).then(|| [gap[0], gap[1] - 1])
    })
}

/// Ranges of bins of each facet, in ascending order.
#[derive(Debug, Clone, Default)]
struct FacetSpans {
    /// The spans of facet i are `spans[starts[i]..starts[i + 1]]`. Empty if there are none at all.
    starts: Vec<u32>,
    spans: Vec<[u32; 2]>,
}

impl FacetSpans {
    /// Spans of facets below `count`, in any order.
    fn new(count: usize, mut of_facets: Vec<(u32, [u32; 2])>) -> Self {
        if of_facets.is_empty() {
            return Self::default();
        }
        of_facets.sort_unstable();
        let mut starts = vec![0; count + 1];
        for &(facet, _) in &of_facets {
            starts[facet as usize + 1] += 1;
        }
        for facet in 0..count {
            starts[facet + 1] += starts[facet];
        }
        Self {
            starts,
            spans: of_facets.into_iter().map(|(_, span)| span).collect(),
        }
    }

    #[inline]
    fn range(&self, facet: u32) -> Range<usize> {
        match self.starts.get(facet as usize..) {
            Some(&[start, end, ..]) => start as usize..end as usize,
            _ => 0..0,
        }
    }

    #[inline]
    fn of(&self, facet: u32) -> &[[u32; 2]] {
        &self.spans[self.range(facet)]
    }

    /// The place of the span of a facet that has this bin.
    #[inline]
    fn at(&self, facet: u32, bin: u32) -> Option<usize> {
        let mut places = self.range(facet);
        places.find(|&place| (self.spans[place][0]..=self.spans[place][1]).contains(&bin))
    }

    /// Each span with its facet.
    fn each(&self) -> impl Iterator<Item = (u32, [u32; 2])> {
        let facets = 0..self.starts.len().saturating_sub(1) as u32;
        facets.flat_map(|facet| self.of(facet).iter().map(move |&span| (facet, span)))
    }
}

#[cfg(test)]
mod tests {
    use super::{FacetSpans, rest};

    #[test]
    fn the_rest_of_a_span_is_what_no_other_takes() {
        let rest = |span, taken: &[[u32; 2]]| {
            let left = rest(span, taken.iter().copied());
            left.collect::<Vec<_>>()
        };
        assert_eq!(rest([3, 9], &[]), [[3, 9]]);
        assert_eq!(rest([3, 9], &[[5, 6]]), [[3, 4], [7, 9]]);
        assert_eq!(rest([3, 9], &[[0, 3], [9, 12]]), [[4, 8]]);
        assert_eq!(rest([3, 9], &[[4, 8], [5, 6]]), [[3, 3], [9, 9]]);
        assert_eq!(rest([3, 9], &[[0, 1], [11, 12]]), [[3, 9]]);
        assert!(rest([3, 9], &[[3, 9]]).is_empty());
        assert!(rest([3, 9], &[[0, 20]]).is_empty());
    }

    #[test]
    fn spans_are_found_by_facet_and_bin() {
        let given = vec![(4, [7, 8]), (1, [0, 2]), (4, [3, 5])];
        let spans = FacetSpans::new(6, given);
        assert_eq!(spans.of(4), [[3, 5], [7, 8]]);
        assert!(spans.of(0).is_empty() && spans.of(5).is_empty());
        assert_eq!(
            [2, 3, 6, 8].map(|bin| spans.at(4, bin)),
            [None, Some(1), None, Some(2)]
        );
        let each: Vec<_> = spans.each().collect();
        assert_eq!(each, [(1, [0, 2]), (4, [3, 5]), (4, [7, 8])]);
        assert!(FacetSpans::default().of(3).is_empty());
    }
}
