//! Profiles weighted by facet (section 4.2). The density of a facet is multiplied by its weight, 0 to 1: the tolerance
//! holds where the weight is 1, and a facet of weight w may exceed it by a factor of 1/w.

use std::convert::Infallible;

use super::deviation::{DeviationError, weight_levels};
use super::facet_bins::FacetBins;
use super::hidden::Hidden;
use super::normal_cones::{self, Cone};
use super::steepest::{self, NO_SURFACE};
use super::volume::VolumeError;
use super::{ErrorRule, LayerErrors, Metric, Profile, Shape, area, cusp};
use crate::ldi::RayImage;
use crate::progress::{Cancelled, Progress};

/// For each bin the largest weighted density (eq. 21, 22), negative where there is no surface. The area and volume
/// deviations belong to no facet; for these it is the largest weight (eq. 23, 24).
#[derive(Debug, Clone)]
pub struct Weighted {
    metric: Metric,
    /// The density where there is no surface, with the largest weight: rays meet no upright walls.
    without: f32,
    values: Vec<f32>,
    /// For the deviation, the largest `n_z²` over the normal cones of each bin whose weight is at least a level, with that level.
    levels: Vec<(f32, Vec<f32>)>,
}

/// The value of a facet under a metric: its weighted density, or its weight.
fn value_of(facet_bins: &FacetBins, metric: Metric, weights: &[f32]) -> impl Fn(usize) -> f32 {
    move |facet| {
        let (weight, square) = (weights[facet], facet_bins.n_z_squared[facet]);
        match metric.row().error {
            ErrorRule::Slope(slope) => weight * slope.of(square),
            ErrorRule::Deviation | ErrorRule::Area | ErrorRule::Volume => weight,
        }
    }
}

impl Weighted {
    /// Takes maxima over all facets whose height range meets a bin. `weights` has one value per facet of the surface, `cones` are
    /// those of the same facets.
    pub(super) fn exact(
        facet_bins: &FacetBins,
        cones: &[Cone],
        hidden: &Hidden,
        metric: Metric,
        weights: &[f32],
    ) -> Self {
        let counts = |facet: usize| hidden.is_seen(facet);
        let maxima = |value: &dyn Fn(usize) -> f32| {
            Ok::<_, Infallible>(steepest::exact_maxima(facet_bins, hidden, value))
        };
        let Ok(exact) = Self::new(facet_bins, cones, metric, weights, counts, maxima);
        exact
    }

    /// Takes maxima over the hits in each bin; the rest is as for [`Self::exact`]. Rays meet facets, not the cones between them.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn sampled(
        facet_bins: &FacetBins,
        image: RayImage<'_>,
        hidden: &Hidden,
        metric: Metric,
        weights: &[f32],
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let maxima = |value: &dyn Fn(usize) -> f32| {
            steepest::sampled_maxima(facet_bins, image, hidden, value, progress)
        };
        Self::new(facet_bins, &[], metric, weights, |_| false, maxima)
    }

    /// `maxima` finds the maximum of a value of facets in each bin, and `counts` returns true for facets whose cones
    /// count.
    fn new<E>(
        facet_bins: &FacetBins,
        cones: &[Cone],
        metric: Metric,
        weights: &[f32],
        counts: impl Fn(usize) -> bool,
        mut maxima: impl FnMut(&dyn Fn(usize) -> f32) -> Result<Vec<f32>, E>,
    ) -> Result<Self, E> {
        let largest = weights.iter().fold(
            0.0,
            |most: f32, &weight| if most < weight { weight } else { most },
        );
        let without = match metric.row().error {
            ErrorRule::Slope(slope) => largest * slope.without(),
            _ => 0.0,
        };
        if !metric.needs_cones() {
            return Ok(Self {
                metric,
                without,
                values: maxima(&value_of(facet_bins, metric, weights))?,
                levels: Vec::new(),
            });
        }
        let levels = weight_levels()
            .map(|(above, level)| {
                let steepest = maxima(&|facet| {
                    if weights[facet] > above {
                        facet_bins.n_z_squared[facet]
                    } else {
                        NO_SURFACE
                    }
                })?;
                let counts = |facet: usize| counts(facet) && weights[facet] > above;
                Ok((level, normal_cones::maxima(&steepest, cones, counts)))
            })
            .collect::<Result<Vec<(f32, Vec<f32>)>, E>>()?;
        let mut values = vec![NO_SURFACE; facet_bins.bins.count];
        for (level, squares) in &levels {
            for (value, &square) in values.iter_mut().zip(squares) {
                if square >= 0.0 {
                    steepest::raise(value, level * cusp::density_of(square));
                }
            }
        }
        Ok(Self {
            metric,
            without,
            values,
            levels,
        })
    }

    /// The weighted profile of the metric.
    ///
    /// For the volume deviation it is the unweighted areas; the weights apply to a layer's deviation from its base.
    /// Multiplying the areas themselves, as eq. 24 does, would find errors on an upright prism wherever its weight changes.
    pub fn profile(&self, shape: &Shape) -> Profile {
        let density = match self.metric.row().error {
            ErrorRule::Slope(_) | ErrorRule::Deviation => {
                steepest::densities(&self.values, self.without, |value| value)
            }
            ErrorRule::Area => {
                let densities = area::density(&shape.areas_mm2, shape.bins);
                densities
                    .iter()
                    .zip(self.weights())
                    .map(|(density, weight)| density * weight)
                    .collect()
            }
            ErrorRule::Volume => return shape.profile(self.metric),
        };
        Profile {
            bins: shape.bins,
            density,
        }
    }

    /// The weighted errors of layers.
    pub fn errors(&self, shape: &Shape) -> LayerErrors {
        match self.metric.row().error {
            ErrorRule::Volume => {
                let weights = self.weights().collect();
                LayerErrors::Volume(VolumeError::weighted(&shape.areas_mm2, weights, shape.bins))
            }
            ErrorRule::Deviation => {
                LayerErrors::Deviation(DeviationError::weighted(&self.levels, shape.bins))
            }
            ErrorRule::Slope(_) | ErrorRule::Area => {
                LayerErrors::Sum(self.profile(shape).error_sum())
            }
        }
    }

    /// The largest weight of each bin; 1 where there is no surface.
    fn weights(&self) -> impl Iterator<Item = f32> {
        let values = self.values.iter();
        values.map(|&value| if value == NO_SURFACE { 1.0 } else { value })
    }
}
