//! The steepest surface of each bin, from which the cusp height and the roughness follow: the largest
//! `n_z²`, sampled by rays or exact over all facets.
//!
//! Squares, because a division a facet is cheaper than a square root as well, and no less exact.

use super::facet_bins::FacetBins;
use crate::ldi::{Hit, Ldi};
use crate::parallel;

/// What a bin without any surface has.
pub const NO_SURFACE: f32 = -1.0;

/// Hits that are worth a thread of their own.
const CHUNK_HITS: usize = 1 << 18;

/// For each bin the largest `n_z²` over the hits in it (eq. 5), [`NO_SURFACE`] where there are none. `facet_bins` is that of
/// the mesh that `ldi` was sampled from. Facets that `hidden` names have no part; it may be empty.
///
/// Cost: linear in hits.
pub fn sampled(facet_bins: &FacetBins, ldi: &Ldi, hidden: &[bool]) -> Vec<f32> {
    sampled_maxima(facet_bins, ldi, hidden, |facet| {
        facet_bins.n_z_squared[facet]
    })
}

/// The same of any value of facets that is not negative.
pub(super) fn sampled_maxima(
    facet_bins: &FacetBins,
    ldi: &Ldi,
    hidden: &[bool],
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let bins = facet_bins.bins;
    let values: Vec<f32> = (0..facet_bins.spans.len())
        .map(|facet| {
            if hidden.get(facet) == Some(&true) {
                NO_SURFACE
            } else {
                value(facet)
            }
        })
        .collect();
    let chunks = ldi
        .hits
        .chunks(CHUNK_HITS.max(ldi.hits.len() / 16))
        .collect();
    let parts = parallel::map(chunks, |hits: &[Hit]| {
        let mut maxima = vec![NO_SURFACE; bins.count];
        for hit in hits {
            // Facets beyond these only close the surface.
            if let Some(&value) = values.get(hit.facet() as usize) {
                raise(&mut maxima[bins.of(f64::from(hit.z_mm))], value);
            }
        }
        maxima
    });
    let mut maxima = vec![NO_SURFACE; bins.count];
    for part in parts {
        for (value, other) in maxima.iter_mut().zip(part) {
            raise(value, other);
        }
    }
    maxima
}

/// For each bin the largest `n_z²` over all facets whose height range meets it, [`NO_SURFACE`] where there are none.
/// Facets that `hidden` names have no part; it may be empty.
///
/// Cost: linear in facets and bins, times the logarithm of the bins that the longest facet spans.
pub fn exact(facet_bins: &FacetBins, hidden: &[bool]) -> Vec<f32> {
    exact_maxima(facet_bins, hidden, |facet| facet_bins.n_z_squared[facet])
}

/// The same of any value of facets that is not negative.
pub(super) fn exact_maxima(
    facet_bins: &FacetBins,
    hidden: &[bool],
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let spans = facet_bins.spans.iter();
    let longest = spans.clone().map(|[lowest, highest]| highest - lowest + 1);
    let mut maxima = RangeMaxima::new(facet_bins.bins.count, longest.max().unwrap_or(1));
    for (facet, &[lowest, highest]) in spans.enumerate() {
        if hidden.get(facet) != Some(&true) {
            maxima.raise(lowest, highest, value(facet));
        }
    }
    maxima.into_values()
}

/// What metrics make of maxima: nothing where there is no surface.
pub(super) fn densities(maxima: &[f32], of: impl Fn(f32) -> f32) -> Vec<f32> {
    let values = maxima.iter();
    values
        .map(|&value| if value == NO_SURFACE { 0.0 } else { of(value) })
        .collect()
}

/// By hand: `max` is a library call in wasm. Always written, since whether a value grows is hard to foretell.
fn raise(value: &mut f32, other: f32) {
    *value = if *value < other { other } else { *value };
}

/// The maximum of values that were given to ranges of places: two writes a range, then one pass down.
struct RangeMaxima {
    count: usize,
    /// One level of `count` places after another. Level k at i is the maximum of ranges that cover the 2^k places from i on.
    levels: Vec<f32>,
}

impl RangeMaxima {
    /// For ranges of at most `longest` of `count` places.
    fn new(count: usize, longest: u32) -> Self {
        let levels = longest.ilog2() as usize + 1;
        Self {
            count,
            levels: vec![NO_SURFACE; levels * count],
        }
    }

    #[inline]
    fn raise(&mut self, first: u32, last: u32, value: f32) {
        let level = (last - first + 1).ilog2();
        let start = level as usize * self.count;
        raise(&mut self.levels[start + first as usize], value);
        let second = last + 1 - (1 << level);
        raise(&mut self.levels[start + second as usize], value);
    }

    fn into_values(mut self) -> Vec<f32> {
        let count = self.count;
        for level in (1..self.levels.len() / count).rev() {
            let half = 1 << (level - 1);
            let (below, upper) = self.levels.split_at_mut(level * count);
            let lower = &mut below[(level - 1) * count..];
            for (value, other) in lower.iter_mut().zip(&*upper) {
                raise(value, *other);
            }
            for (value, other) in lower[half..].iter_mut().zip(&*upper) {
                raise(value, *other);
            }
        }
        self.levels.truncate(count);
        // What is kept must not hold on to all levels.
        self.levels.shrink_to_fit();
        self.levels
    }
}
