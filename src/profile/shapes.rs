//! The shape of a model along z from both sources, facets and rays, under the weights of facets.

use std::borrow::Borrow;

use super::facet_bins::{FacetBins, Flat};
use super::weighted::Weighted;
use super::{LayerErrors, Metric, Profile, Shape, Source, section, steepest};
use crate::grid::Bins;
use crate::ldi::Ldi;
use crate::ldi::visibility::{Visibility, visibility};
use crate::model::Mesh;

/// The shape of a model from both sources.
#[derive(Debug)]
pub(crate) struct Shapes {
    pub exact: Shape,
    pub sampled: Shape,
    /// Horizontal facets that are not hidden.
    pub flats: Vec<Flat>,
    /// Facets wholly inside the solid.
    hidden: Vec<bool>,
    /// Whether bodies overlap in a way that only rays can sort out.
    pub overlaps: bool,
    weighing: Option<Weighing>,
}

/// The shapes under weights.
#[derive(Debug)]
struct Weighing {
    metric: Metric,
    weights: Vec<f32>,
    exact: Weighted,
    sampled: Weighted,
}

impl Shapes {
    pub fn new(mesh: &Mesh, ldi: &Ldi, bins: Bins) -> Self {
        let Visibility { hidden, overlaps } = visibility(mesh, ldi);
        let facet_bins = FacetBins::of(mesh, bins);
        let shape = |steepest| Shape {
            bins,
            steepest,
            areas_mm2: Vec::new(),
        };
        Self {
            exact: shape(steepest::exact(&facet_bins, &hidden)),
            sampled: shape(steepest::sampled(&facet_bins, ldi, &hidden)),
            flats: facet_bins.flats_but(&hidden),
            hidden,
            overlaps,
            weighing: None,
        }
    }

    /// The shape of facets alone, where there are no rays: it stands for both sources, and no facet is known to be hidden.
    /// `areas_mm2` may be empty if the metric is not made of them.
    pub fn of_facets(facet_bins: &FacetBins, areas_mm2: Vec<f64>) -> Self {
        let exact = Shape {
            bins: facet_bins.bins,
            steepest: steepest::exact(facet_bins, &[]),
            areas_mm2,
        };
        Self {
            sampled: exact.clone(),
            exact,
            flats: facet_bins.flats.clone(),
            hidden: Vec::new(),
            overlaps: false,
            weighing: None,
        }
    }

    /// Weighs the facets of the surface for a metric, or all alike; returns whether anything was measured for it, on the
    /// facet bins that the shapes are of. Without an LDI what is exact stands for both sources.
    pub fn weigh<R: Borrow<FacetBins>>(
        &mut self,
        facet_bins: impl FnOnce() -> R,
        ldi: Option<&Ldi>,
        metric: Metric,
        weights: Option<Vec<f32>>,
    ) -> bool {
        let Some(weights) = weights else {
            self.weighing = None;
            return false;
        };
        let kept = self.weighing.as_ref();
        if kept.is_some_and(|kept| kept.metric == metric && kept.weights == weights) {
            return false;
        }
        let facet_bins = facet_bins();
        let measure = |ldi| Weighted::new(facet_bins.borrow(), ldi, &self.hidden, metric, &weights);
        let exact = measure(None);
        let sampled = ldi.map_or_else(|| exact.clone(), |ldi| measure(Some(ldi)));
        self.weighing = Some(Weighing {
            metric,
            weights,
            exact,
            sampled,
        });
        true
    }

    /// The profile of a metric, weighted if facets were weighed for it.
    pub fn profile(&self, metric: Metric, source: Source) -> Profile {
        let shape = self.of(source);
        match self.weighted(metric, source) {
            Some(weighted) => weighted.profile(shape),
            None => shape.profile(metric),
        }
    }

    /// The errors of layers, weighted if facets were weighed for the metric.
    pub fn errors(&self, metric: Metric, source: Source) -> LayerErrors {
        let shape = self.of(source);
        match self.weighted(metric, source) {
            Some(weighted) => weighted.errors(shape),
            None => shape.errors(metric),
        }
    }

    fn weighted(&self, metric: Metric, source: Source) -> Option<&Weighted> {
        let weighing = self.weighing.as_ref();
        let weighing = weighing.filter(|weighing| weighing.metric == metric)?;
        Some(match source {
            Source::Exact => &weighing.exact,
            Source::Sampled => &weighing.sampled,
        })
    }

    /// Measures the areas of sections as well, unless that was done; returns whether it was not.
    pub fn add_areas(&mut self, mesh: &Mesh, ldi: &Ldi) -> bool {
        if !self.sampled.areas_mm2.is_empty() {
            return false;
        }
        let bins = self.exact.bins;
        self.sampled.areas_mm2 = section::sampled(ldi, bins);
        self.exact.areas_mm2 = if self.overlaps {
            self.sampled.areas_mm2.clone()
        } else {
            section::exact(mesh, &self.hidden, bins)
        };
        true
    }

    pub fn of(&self, source: Source) -> &Shape {
        match source {
            Source::Exact => &self.exact,
            Source::Sampled => &self.sampled,
        }
    }
}
