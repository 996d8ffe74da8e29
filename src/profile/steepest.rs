//! The steepest surface of each bin, from which the cusp height and the roughness follow: the largest
//! `n_z²`, sampled by rays or exact over all facets.
//!
//! Squares, because a division a facet is cheaper than a square root as well, and no less exact.

use crate::grid::Bins;
use crate::ldi::{Hit, Ldi};
use crate::mesh::Mesh;
use crate::parallel;

/// What a bin without any surface has.
pub const NO_SURFACE: f32 = -1.0;

/// Hits that are worth a thread of their own.
const CHUNK_HITS: usize = 1 << 18;

/// For each bin the largest `n_z²` over the hits in it (eq. 5), [`NO_SURFACE`] where there are none. `mesh` is the
/// one that `ldi` was sampled from. Facets that `hidden` names have no part; it may be empty.
///
/// Cost: linear in hits.
pub fn sampled(mesh: &Mesh, ldi: &Ldi, hidden: &[bool], bins: Bins) -> Vec<f32> {
    sampled_maxima(mesh, ldi, hidden, bins, |facet| mesh.n_z_squared(facet))
}

/// The same of any value of facets that is not negative.
pub(super) fn sampled_maxima(
    mesh: &Mesh,
    ldi: &Ldi,
    hidden: &[bool],
    bins: Bins,
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let values: Vec<f32> = (0..mesh.facets.len())
        .map(|facet| {
            if facet < mesh.surface_facets && hidden.get(facet) != Some(&true) {
                value(facet)
            } else {
                NO_SURFACE
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
            let value = values[hit.facet() as usize];
            raise(&mut maxima[bins.of(f64::from(hit.z_mm))], value);
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
pub fn exact(mesh: &Mesh, hidden: &[bool], bins: Bins) -> Vec<f32> {
    exact_maxima(mesh, hidden, bins, |facet| mesh.n_z_squared(facet))
}

/// The same of any value of facets that is not negative.
pub(super) fn exact_maxima(
    mesh: &Mesh,
    hidden: &[bool],
    bins: Bins,
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let bin_of: Vec<u32> = mesh
        .vertices
        .iter()
        .map(|vertex| bins.of(f64::from(vertex.z)) as u32)
        .collect();
    let mut maxima = RangeMaxima::new(bins.count);
    for (facet, corners) in mesh.facets[..mesh.surface_facets].iter().enumerate() {
        if hidden.get(facet) == Some(&true) {
            continue;
        }
        let [a, b, c] = corners.map(|vertex| bin_of[vertex as usize]);
        let (lowest, highest) = (a.min(b).min(c), a.max(b).max(c));
        maxima.raise(lowest as usize, highest as usize, value(facet));
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

/// By hand: `max` is a library call in wasm.
fn raise(value: &mut f32, other: f32) {
    if *value < other {
        *value = other;
    }
}

/// The maximum of values that were given to ranges of places: two writes a range, then one pass down.
struct RangeMaxima {
    count: usize,
    /// Level k at i is the maximum of ranges that cover the 2^k places from i on.
    levels: Vec<Vec<f32>>,
}

impl RangeMaxima {
    fn new(count: usize) -> Self {
        Self {
            count,
            levels: vec![vec![NO_SURFACE; count]],
        }
    }

    fn raise(&mut self, first: usize, last: usize, value: f32) {
        let level = (last - first + 1).ilog2() as usize;
        while self.levels.len() <= level {
            self.levels.push(vec![NO_SURFACE; self.count]);
        }
        let maxima = &mut self.levels[level];
        raise(&mut maxima[first], value);
        raise(&mut maxima[last + 1 - (1 << level)], value);
    }

    fn into_values(mut self) -> Vec<f32> {
        while self.levels.len() > 1 {
            let upper = self.levels.pop().unwrap_or_default();
            let half = 1 << (self.levels.len() - 1);
            let lower = self.levels.last_mut().expect("the lowest level stays");
            for (value, other) in lower.iter_mut().zip(&upper) {
                raise(value, *other);
            }
            for (value, other) in lower[half..].iter_mut().zip(&upper) {
                raise(value, *other);
            }
        }
        self.levels.pop().unwrap_or_default()
    }
}
