//! Profiles weighted by facet (section 4.2). The density of a facet is multiplied by its weight, 0 to 1: the tolerance
//! holds where the weight is 1, and a facet of weight w may exceed it by a factor of 1/w.

use super::facet_bins::FacetBins;
use super::steepest::{self, NO_SURFACE};
use super::volume::VolumeError;
use super::{LayerErrors, Metric, Profile, Shape, area, cusp, roughness};
use crate::ldi::Ldi;

/// For each bin the largest weighted density (eq. 21, 22), negative where there is no surface. The area and volume
/// deviations belong to no facet; for these it is the largest weight (eq. 23, 24).
#[derive(Debug, Clone)]
pub struct Weighted {
    metric: Metric,
    values: Vec<f32>,
}

/// The value of a facet under a metric: its weighted density, or its weight.
fn value_of(facet_bins: &FacetBins, metric: Metric, weights: &[f32]) -> impl Fn(usize) -> f32 {
    move |facet| {
        let (weight, square) = (weights[facet], facet_bins.n_z_squared[facet]);
        match metric {
            Metric::Cusp => weight * cusp::density_of(square),
            Metric::Roughness => weight * roughness::density_of(square),
            Metric::Area | Metric::Volume => weight,
        }
    }
}

impl Weighted {
    /// Takes maxima over the hits in each bin, or without an LDI over all facets whose height range meets the bin.
    /// `weights` has one value per facet of the surface.
    pub fn new(
        facet_bins: &FacetBins,
        ldi: Option<&Ldi>,
        hidden: &[bool],
        metric: Metric,
        weights: &[f32],
    ) -> Self {
        let value = value_of(facet_bins, metric, weights);
        let values = match ldi {
            None => steepest::exact_maxima(facet_bins, hidden, value),
            Some(ldi) => steepest::sampled_maxima(facet_bins, ldi, hidden, value),
        };
        Self { metric, values }
    }

    /// The weighted profile of the metric.
    ///
    /// For the volume deviation it is the unweighted areas; the weights apply to a layer's deviation from its base.
    /// Multiplying the areas themselves, as eq. 24 does, would find errors on an upright prism wherever its weight changes.
    pub fn profile(&self, shape: &Shape) -> Profile {
        let density = match self.metric {
            Metric::Cusp | Metric::Roughness => steepest::densities(&self.values, |value| value),
            Metric::Area => {
                let densities = area::density(&shape.areas_mm2, shape.bins);
                densities
                    .iter()
                    .zip(self.weights())
                    .map(|(density, weight)| density * weight)
                    .collect()
            }
            Metric::Volume => return shape.profile(Metric::Volume),
        };
        Profile {
            bins: shape.bins,
            density,
        }
    }

    /// The weighted errors of layers.
    pub fn errors(&self, shape: &Shape) -> LayerErrors {
        match self.metric {
            Metric::Volume => {
                let weights = self.weights().collect();
                LayerErrors::Volume(VolumeError::weighted(&shape.areas_mm2, weights, shape.bins))
            }
            _ => LayerErrors::Sum(self.profile(shape).error_sum()),
        }
    }

    /// The largest weight of each bin; 1 where there is no surface.
    fn weights(&self) -> impl Iterator<Item = f32> {
        let values = self.values.iter();
        values.map(|&value| if value == NO_SURFACE { 1.0 } else { value })
    }
}
