//! The shape of a model along z from both sources, facets and rays, with optional weights of facets.

use super::creases::creases;
use super::facet_bins::{FacetBins, Flat};
use super::hidden::Hidden;
use super::normal_cones::{self, Cone, cones};
use super::weighted::Weighted;
use super::{LayerErrors, Metric, Profile, Shape, Source, section, steepest};
use crate::grid::Bins;
use crate::ldi::visibility::{Visibility, visibility};
use crate::ldi::{RayImage, Survey};
use crate::model::{Mesh, crossing};
use crate::progress::{Cancelled, Progress};

/// The shape of a model from both sources.
#[derive(Debug, Clone)]
pub(crate) struct Shapes {
    pub exact: Shape,
    pub sampled: Shape,
    /// Horizontal facets that are not hidden.
    pub flats: Vec<Flat>,
    /// The normal cones of the surface, those of hidden facets included; empty if no metric needs them.
    cones: Vec<Cone>,
    /// Facets inside the solid, and parts of facets.
    hidden: Hidden,
    /// True if bodies overlap in a way that only rays can resolve.
    pub overlaps: bool,
    weighing: Option<Weighing>,
}

/// The weighted values of one metric.
#[derive(Debug, Clone)]
struct Weighing {
    metric: Metric,
    weights: Vec<f32>,
    exact: Weighted,
    sampled: Weighted,
}

impl Shapes {
    /// The shape of a sampled mesh, without areas of sections and without weights.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        facet_bins: &FacetBins,
        mesh: &Mesh,
        image: RayImage<'_>,
        survey: &Survey,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let mut first = |fraction| progress(0.5 * fraction);
        let Visibility {
            hidden,
            partly_inside,
            overlaps,
        } = visibility(mesh, image, survey, &mut first)?;
        let bins = facet_bins.bins;
        let hidden = Hidden::whole(hidden);
        let is_seen = |facet: u32| hidden.is_seen(facet as usize);
        let pairs = crossing::pairs(mesh, &partly_inside, is_seen);
        let creases = creases(mesh, bins, &pairs);
        let mut second = |fraction| progress(0.5 + 0.25 * fraction);
        let spans = creases.spans;
        let hidden = hidden.with_parts(facet_bins, &partly_inside, spans, image, &mut second)?;
        let value = |facet| facet_bins.n_z_squared[facet];
        let exact = steepest::exact_maxima(facet_bins, &hidden, value);
        let mut third = |fraction| progress(0.75 + 0.25 * fraction);
        let sampled = steepest::sampled_maxima(facet_bins, image, &hidden, value, &mut third)?;
        let mut cones = cones(mesh, bins);
        if !hidden.is_by_facets() {
            let seen = |cone: &Cone| {
                let cone = *cone;
                let spans = hidden.seen_in(cone.facet, cone.span);
                spans.map(move |span| Cone { span, ..cone })
            };
            cones = cones.iter().flat_map(seen).collect();
        }
        cones.extend(creases.cones);
        Ok(Self {
            exact: Shape {
                bins,
                cones: normal_cones::maxima(&exact, &cones, |facet| hidden.is_seen(facet)),
                steepest: exact,
                areas_mm2: Vec::new(),
            },
            // Rays meet facets, not the edges between them.
            sampled: Shape {
                bins,
                cones: sampled.clone(),
                steepest: sampled,
                areas_mm2: Vec::new(),
            },
            cones,
            flats: facet_bins.flats_but(hidden.facets()),
            hidden,
            overlaps,
            weighing: None,
        })
    }

    /// The shape from facets alone, without rays. It serves as both sources, and no facet counts as hidden. `areas_mm2`
    /// and `cones` may be empty if the metric does not need them.
    pub fn of_facets(facet_bins: &FacetBins, areas_mm2: Vec<f64>, cones: Vec<Cone>) -> Self {
        let steepest = steepest::exact(facet_bins, &[]);
        let exact = Shape {
            bins: facet_bins.bins,
            cones: normal_cones::maxima(&steepest, &cones, |_| true),
            steepest,
            areas_mm2,
        };
        Self {
            sampled: exact.clone(),
            exact,
            cones,
            flats: facet_bins.flats.clone(),
            hidden: Hidden::default(),
            overlaps: false,
            weighing: None,
        }
    }

    /// The bins of the shape.
    pub fn bins(&self) -> Bins {
        self.exact.bins
    }

    /// Returns true if the areas of sections have been measured.
    pub fn has_areas(&self) -> bool {
        !self.sampled.areas_mm2.is_empty()
    }

    /// Returns true if the shape has exactly these weights of facets for this metric; with `None`, if it has no
    /// weights.
    pub fn is_weighed(&self, metric: Metric, weights: Option<&[f32]>) -> bool {
        match (&self.weighing, weights) {
            (None, None) => true,
            (Some(weighing), Some(weights)) => {
                weighing.metric == metric && weighing.weights == weights
            }
            _ => false,
        }
    }

    /// The shape with these weights, one per facet of the surface, for a metric; `None` removes all weights.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn weighed(
        self,
        facet_bins: &FacetBins,
        image: RayImage<'_>,
        metric: Metric,
        weights: Option<Vec<f32>>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let exact = self.weighed_by_facets(facet_bins, metric, weights);
        let hidden = &exact.hidden;
        let weighing = exact.weighing.as_ref().map(|weighing| {
            let weights = &weighing.weights;
            Weighted::sampled(facet_bins, image, hidden, metric, weights, progress)
        });
        let sampled = weighing.transpose()?;
        let mut shapes = exact;
        if let (Some(weighing), Some(sampled)) = (&mut shapes.weighing, sampled) {
            weighing.sampled = sampled;
        }
        Ok(shapes)
    }

    /// [`Self::weighed`] without rays: the exact values serve as both sources.
    pub fn weighed_by_facets(
        self,
        facet_bins: &FacetBins,
        metric: Metric,
        weights: Option<Vec<f32>>,
    ) -> Self {
        let weighing = weights.map(|weights| {
            let exact = Weighted::exact(facet_bins, &self.cones, &self.hidden, metric, &weights);
            Weighing {
                metric,
                weights,
                sampled: exact.clone(),
                exact,
            }
        });
        Self { weighing, ..self }
    }

    /// The profile of a metric, weighted if weights are set for it.
    pub fn profile(&self, metric: Metric, source: Source) -> Profile {
        let shape = self.of(source);
        match self.weighted(metric, source) {
            Some(weighted) => weighted.profile(shape),
            None => shape.profile(metric),
        }
    }

    /// The errors of layers, weighted if weights are set for the metric.
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

    /// The shape with the areas of its sections.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn with_areas(
        mut self,
        mesh: &Mesh,
        image: RayImage<'_>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let bins = self.bins();
        self.sampled.areas_mm2 = section::sampled(image, bins, progress)?;
        self.exact.areas_mm2 = if self.overlaps {
            self.sampled.areas_mm2.clone()
        } else {
            section::exact(mesh, self.hidden.facets(), bins)
        };
        Ok(self)
    }

    pub fn of(&self, source: Source) -> &Shape {
        match source {
            Source::Exact => &self.exact,
            Source::Sampled => &self.sampled,
        }
    }
}
