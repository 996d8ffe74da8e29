//! The largest `n_z²` of the surface in each bin, sampled by rays or exact over all facets. The cusp height and the
//! roughness are computed from it.
//!
//! Squares avoid a square root per facet and are no less exact.

use super::facet_bins::FacetBins;
use super::hidden::Hidden;
use crate::ldi::{RayImage, Rays};
use crate::progress::{Cancelled, Progress};

/// The value of a bin without any surface.
pub const NO_SURFACE: f32 = -1.0;

/// For each bin the largest `n_z²` over the hits in it (eq. 5), [`NO_SURFACE`] if there are none.
///
/// `facet_bins` must be those of the sampled mesh. Hidden facets are left out; an empty `hidden`
/// hides none.
///
/// Cost: linear in hits.
///
/// # Errors
/// [`Cancelled`].
pub fn sampled(
    facet_bins: &FacetBins,
    image: RayImage<'_>,
    hidden: &[bool],
    progress: &mut Progress<'_>,
) -> Result<Vec<f32>, Cancelled> {
    let value = |facet| facet_bins.n_z_squared[facet];
    let hidden = Hidden::whole(hidden.to_vec());
    sampled_maxima(facet_bins, image, &hidden, value, progress)
}

/// [`sampled`] for any value of facets that is not negative, which may be hidden in part.
pub(super) fn sampled_maxima(
    facet_bins: &FacetBins,
    image: RayImage<'_>,
    hidden: &Hidden,
    value: impl Fn(usize) -> f32,
    progress: &mut Progress<'_>,
) -> Result<Vec<f32>, Cancelled> {
    let bins = facet_bins.bins;
    let values: Vec<f32> = (0..facet_bins.spans.len())
        .map(|facet| {
            if hidden.is_seen(facet) {
                value(facet)
            } else {
                NO_SURFACE
            }
        })
        .collect();
    let none = || vec![NO_SURFACE; bins.count];
    let is_by_facets = hidden.is_by_facets();
    let add = |maxima: &mut Vec<f32>, rays: Rays<'_>| {
        for hit in rays.hits {
            // The facets after these only close the surface.
            if let Some(&value) = values.get(hit.facet() as usize) {
                let bin = bins.of(f64::from(hit.z_mm));
                if is_by_facets || !hidden.hides_part(hit.facet(), bin as u32) {
                    raise(&mut maxima[bin], value);
                }
            }
        }
    };
    let parts = image.fold(none, add, progress)?;
    let mut maxima = vec![NO_SURFACE; bins.count];
    for part in parts {
        for (value, other) in maxima.iter_mut().zip(part) {
            raise(value, other);
        }
    }
    Ok(maxima)
}

/// For each bin the largest `n_z²` over all facets whose height range meets it, [`NO_SURFACE`] if there are none.
/// Hidden facets are left out; an empty `hidden` hides none.
///
/// Cost: linear in facets and bins, times the logarithm of the bins that the longest facet spans.
pub fn exact(facet_bins: &FacetBins, hidden: &[bool]) -> Vec<f32> {
    let hidden = Hidden::whole(hidden.to_vec());
    exact_maxima(facet_bins, &hidden, |facet| facet_bins.n_z_squared[facet])
}

/// [`exact`] for any value of facets that is not negative, which may be hidden in part.
pub(super) fn exact_maxima(
    facet_bins: &FacetBins,
    hidden: &Hidden,
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let spans = facet_bins.spans.iter();
    let longest = spans.clone().map(|[lowest, highest]| highest - lowest + 1);
    let mut maxima = RangeMaxima::new(facet_bins.bins.count, longest.max().unwrap_or(1));
    let is_by_facets = hidden.is_by_facets();
    for (facet, &span) in spans.enumerate() {
        if !hidden.is_seen(facet) {
            continue;
        }
        let mut raise = |[lowest, highest]: [u32; 2]| maxima.raise(lowest, highest, value(facet));
        if is_by_facets {
            raise(span);
        } else {
            hidden.seen_in(facet as u32, span).for_each(raise);
        }
    }
    maxima.into_values()
}

/// The density of each bin from its maximum: `without` where there is no surface, otherwise `of` the maximum.
pub(super) fn densities(maxima: &[f32], without: f32, of: impl Fn(f32) -> f32) -> Vec<f32> {
    let values = maxima.iter();
    values
        .map(|&value| {
            if value == NO_SURFACE {
                without
            } else {
                of(value)
            }
        })
        .collect()
}

/// Raises `value` to `other` if that is larger; both are [`NO_SURFACE`] or at least 0. It always stores, because a branch would be hard
/// to predict.
#[inline]
pub(super) fn raise(value: &mut f32, other: f32) {
    *value = if cfg!(target_arch = "wasm32") {
        // Browsers choose between integers without a branch, but not between floats. The bits of these ascend with them, but for the
        // sign, which is first.
        let bits = [*value, other].map(|it| it.to_bits().cast_signed());
        f32::from_bits(bits[0].max(bits[1]).cast_unsigned())
    } else if *value < other {
        other
    } else {
        *value
    };
}

/// For each index, the maximum of the values given to ranges that contain it: two writes per range, then one pass down.
pub(super) struct RangeMaxima {
    count: usize,
    /// One level of `count` values after another. Value i of level k is the maximum over ranges that contain the 2^k
    /// indices from i on.
    levels: Vec<f32>,
}

impl RangeMaxima {
    /// For ranges of at most `longest` among `count` indices.
    pub(super) fn new(count: usize, longest: u32) -> Self {
        let levels = longest.ilog2() as usize + 1;
        Self {
            count,
            levels: vec![NO_SURFACE; levels * count],
        }
    }

    #[inline]
    pub(super) fn raise(&mut self, first: u32, last: u32, value: f32) {
        let level = (last - first + 1).ilog2();
        let start = level as usize * self.count;
        raise(&mut self.levels[start + first as usize], value);
        let second = last + 1 - (1 << level);
        raise(&mut self.levels[start + second as usize], value);
    }

    pub(super) fn into_values(mut self) -> Vec<f32> {
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
        // Release the memory of the other levels.
        self.levels.shrink_to_fit();
        self.levels
    }
}
