//! The shape of a model along z from both sources, facets and rays, with optional weights of facets.

use super::creases::{Creases, creases};
use super::facet_bins::{FacetBins, Flat};
use super::hidden::Hidden;
use super::normal_cones::{self, Cone, cones};
use super::weighted::Weighted;
use super::{LayerErrors, Metric, Profile, Shape, Source, section, steepest};
use crate::grid::Bins;
use crate::ldi::visibility::{Visibility, visibility};
use crate::ldi::{MeshRays, RayImage, Survey};
use crate::model::{Mesh, crossing};
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// The shape of a model from both sources.
#[derive(Debug, Clone)]
pub(crate) struct Shapes {
    pub exact: Shape,
    /// The shape as rays see it, if it was measured.
    pub sampled: Option<Shape>,
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
    sampled: Option<Weighted>,
}

impl Shapes {
    /// The shape of a sampled mesh by its facets, without areas of sections and without weights.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        facet_bins: &FacetBins,
        rays: MeshRays<'_>,
        survey: &Survey,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let (bins, mesh) = (facet_bins.bins, rays.mesh);
        let find = || {
            let found = Self::surface(facet_bins, rays, survey, progress)?;
            let value = |facet| facet_bins.n_z_squared[facet];
            let exact = steepest::exact_maxima(facet_bins, &found.0, value);
            Ok::<_, Cancelled>((found, exact))
        };
        let (mut cones, found) = parallel::beside(|| cones(mesh, bins), find);
        let ((hidden, overlaps, of_creases), exact) = found?;
        if !hidden.is_by_facets() {
            let seen = |cone: &Cone| {
                let cone = *cone;
                let spans = hidden.seen_in(cone.facet, cone.span);
                spans.map(move |span| Cone { span, ..cone })
            };
            cones = cones.iter().flat_map(seen).collect();
        }
        cones.extend(of_creases);
        Ok(Self {
            exact: Shape {
                bins,
                cones: normal_cones::maxima(&exact, &cones, |facet| hidden.is_seen(facet)),
                steepest: exact,
                areas_mm2: Vec::new(),
            },
            sampled: None,
            cones,
            flats: facet_bins.flats_but(hidden.facets()),
            hidden,
            overlaps,
            weighing: None,
        })
    }

    /// The hidden facets and parts of facets; true if bodies overlap in a way that only rays can resolve; and the cones where bodies
    /// cross.
    fn surface(
        facet_bins: &FacetBins,
        rays: MeshRays<'_>,
        survey: &Survey,
        progress: &mut Progress<'_>,
    ) -> Result<(Hidden, bool, Vec<Cone>), Cancelled> {
        let (bins, mesh) = (facet_bins.bins, rays.mesh);
        let mut first = |fraction| progress(0.5 * fraction);
        let Visibility {
            hidden,
            partly_inside,
            overlaps,
        } = visibility(rays, survey, &mut first)?;
        let hidden = Hidden::whole(hidden);
        let is_seen = |facet: u32| hidden.is_seen(facet as usize);
        let pairs = crossing::pairs(mesh, &partly_inside, is_seen);
        let Creases { cones, spans } = creases(mesh, bins, &pairs);
        let mut second = |fraction| progress(0.5 + 0.5 * fraction);
        let hidden = hidden.with_parts(facet_bins, &partly_inside, spans, rays, &mut second)?;
        Ok((hidden, overlaps, cones))
    }

    /// The same with the shape as rays see it, without areas of sections and without weights.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn with_rays(
        self,
        facet_bins: &FacetBins,
        image: RayImage<'_>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let value = |facet| facet_bins.n_z_squared[facet];
        let steepest = steepest::sampled_maxima(facet_bins, image, &self.hidden, value, progress)?;
        Ok(Self {
            sampled: Some(Shape {
                bins: facet_bins.bins,
                // Rays meet facets, not the edges between them.
                cones: steepest.clone(),
                steepest,
                areas_mm2: Vec::new(),
            }),
            ..self
        })
    }

    /// The shape from facets alone, without rays. It serves as both sources, and no facet counts as hidden. `areas_mm2`
    /// and `cones` may be empty if the metric does not need them.
    pub fn of_facets(facet_bins: &FacetBins, areas_mm2: Vec<f64>, cones: Vec<Cone>) -> Self {
        let steepest = steepest::exact(facet_bins, &[]);
        Self {
            exact: Shape {
                bins: facet_bins.bins,
                cones: normal_cones::maxima(&steepest, &cones, |_| true),
                steepest,
                areas_mm2,
            },
            sampled: None,
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

    /// Returns true if the areas of sections have been measured, from all sources.
    pub fn has_areas(&self) -> bool {
        let mut shapes = [Some(&self.exact), self.sampled.as_ref()]
            .into_iter()
            .flatten();
        shapes.all(|shape| !shape.areas_mm2.is_empty())
    }

    /// Returns true if the shape has exactly these weights of facets for this metric; with `None`, if it has no
    /// weights.
    pub fn is_weighed(&self, metric: Metric, weights: Option<&[f32]>) -> bool {
        match (&self.weighing, weights) {
            (None, None) => true,
            (Some(weighing), Some(weights)) => {
                weighing.metric == metric
                    && weighing.weights == weights
                    && weighing.sampled.is_some() == self.sampled.is_some()
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
        let mut shapes = self.weighed_by_facets(facet_bins, metric, weights);
        if let Some(weighing) = &mut shapes.weighing
            && shapes.sampled.is_some()
        {
            let (hidden, weights) = (&shapes.hidden, &weighing.weights);
            let sampled = Weighted::sampled(facet_bins, image, hidden, metric, weights, progress)?;
            weighing.sampled = Some(sampled);
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
        let weighing = weights.map(|weights| Weighing {
            exact: Weighted::exact(facet_bins, &self.cones, &self.hidden, metric, &weights),
            metric,
            weights,
            sampled: None,
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
        Some(of_source(
            source,
            &weighing.exact,
            weighing.sampled.as_ref(),
        ))
    }

    /// The shape with the areas of its sections.
    ///
    /// Cost: a pass over the rays if they are needed: for the shape as rays see it, or where only rays resolve overlaps.
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
        if !self.overlaps {
            self.exact.areas_mm2 = section::exact(mesh, self.hidden.facets(), bins);
        }
        if self.overlaps || self.sampled.is_some() {
            let areas_mm2 = section::sampled(image, bins, progress)?;
            if self.overlaps {
                self.exact.areas_mm2.clone_from(&areas_mm2);
            }
            if let Some(sampled) = &mut self.sampled {
                sampled.areas_mm2 = areas_mm2;
            }
        }
        Ok(self)
    }

    /// The shape from a source: that of facets if rays were not asked.
    pub fn of(&self, source: Source) -> &Shape {
        of_source(source, &self.exact, self.sampled.as_ref())
    }
}

fn of_source<'a, T>(source: Source, exact: &'a T, sampled: Option<&'a T>) -> &'a T {
    match source {
        Source::Exact => exact,
        Source::Sampled => sampled.unwrap_or(exact),
    }
}
