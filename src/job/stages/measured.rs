//! The shape of a sampled model along z: the second stage.

use std::cell::LazyCell;
use std::sync::Arc;

use super::parts::Layering;
use super::sampled::Sampled;
use crate::grid::Bins;
use crate::job::Error;
use crate::ldi::{LdiError, MeshRays};
use crate::model::Mesh;
use crate::profile::Source;
use crate::profile::facet_bins::FacetBins;
use crate::profile::shapes::Shapes;
use crate::progress::Progress;

/// The measured shape of a sampled model, with the rays that it was measured on. Immutable and shared.
#[derive(Debug)]
pub struct Measured {
    pub of: Arc<Sampled>,
    pub shapes: Shapes,
}

impl Measured {
    /// Measures what `layering` and the weights of facets need. Reuses what `kept` has of it, and returns `kept` itself if
    /// nothing is missing.
    ///
    /// # Errors
    /// [`Error::Grid`]; [`Error::Ldi`] if `progress` cancels.
    pub fn new(
        of: &Arc<Sampled>,
        layering: &Layering,
        weights: Option<Vec<f32>>,
        kept: Option<Arc<Self>>,
        progress: &mut Progress<'_>,
    ) -> Result<Arc<Self>, Error> {
        let (mesh, image) = (of.mesh(), of.image());
        let weights = weights_with_greys(mesh, layering, weights);
        let bins = Bins::of_height(of.height_mm, layering.bin_mm)?;
        let metric = layering.metric;
        let is_of_these =
            |kept: &Arc<Self>| Arc::ptr_eq(&kept.of, of) && kept.shapes.bins() == bins;
        let kept = kept.filter(is_of_these);
        let has_rays =
            |shapes: &Shapes| shapes.sampled.is_some() || layering.source == Source::Exact;
        let has_areas = |shapes: &Shapes| shapes.has_areas() || !metric.needs_areas();
        if let Some(kept) = &kept
            && has_rays(&kept.shapes)
            && has_areas(&kept.shapes)
            && kept.shapes.is_weighed(metric, weights.as_deref())
        {
            return Ok(Arc::clone(kept));
        }
        let facet_bins = LazyCell::new(|| FacetBins::of(mesh, bins));
        // There are up to four passes over the rays.
        let mut pass = |number: f64, fraction: f64| progress((number + fraction) / 4.0);
        let mut first = |fraction| pass(0.0, fraction);
        let mut shapes = if let Some(kept) = kept {
            kept.shapes.clone()
        } else {
            let rays = MeshRays {
                mesh,
                image,
                overlaps: of.overlaps().ok(),
            };
            Shapes::new(&facet_bins, rays, &of.survey, &mut first).map_err(LdiError::from)?
        };
        if !has_rays(&shapes) {
            let mut second = |fraction| pass(1.0, fraction);
            let with_rays = shapes.with_rays(&facet_bins, image, &mut second);
            shapes = with_rays.map_err(LdiError::from)?;
        }
        if !has_areas(&shapes) {
            let with_areas = shapes.with_areas(mesh, image, &mut |fraction| pass(2.0, fraction));
            shapes = with_areas.map_err(LdiError::from)?;
        }
        if !shapes.is_weighed(metric, weights.as_deref()) {
            let mut last = |fraction| pass(3.0, fraction);
            let weighed = shapes.weighed(&facet_bins, image, metric, weights, &mut last);
            shapes = weighed.map_err(LdiError::from)?;
        }
        Ok(Arc::new(Self {
            of: Arc::clone(of),
            shapes,
        }))
    }
}

/// Factor of the height to which a step of grey sets a bottom, over equal steps: brightness acts by its logarithm.
const GREY_RESIDUAL: f32 = 2.0;

/// Weights of facets where greys set the bottoms of surfaces that face down: their stairs are those of greys, not of layers. The first
/// layer is not compensated, so facets in it keep their weights.
pub fn weights_with_greys(
    mesh: &Mesh,
    layering: &Layering,
    weights: Option<Vec<f32>>,
) -> Option<Vec<f32>> {
    let residual = (GREY_RESIDUAL / layering.greys as f32).min(1.0);
    if residual == 1.0 {
        return weights;
    }
    let limits = &layering.limits;
    let first_mm = limits
        .layer_max_mm
        .max(limits.first_layer_mm.unwrap_or(0.0));
    let mut weights = weights.unwrap_or_else(|| vec![1.0; mesh.surface_facets]);
    for (facet, weight) in weights.iter_mut().enumerate() {
        let is_above = || {
            mesh.corners(facet)
                .iter()
                .all(|corner| corner.z >= first_mm)
        };
        if mesh.faces_down(facet) && is_above() {
            *weight *= residual;
        }
    }
    Some(weights)
}

/// A model after some turns of 15°, sampled and measured. All copies that stand like this share it.
#[derive(Debug)]
pub struct Shape {
    pub model: usize,
    pub turns: u32,
    pub sampled: Arc<Sampled>,
    /// Absent until the profile is made.
    pub measured: Option<Arc<Measured>>,
}

/// A model that a plan is made for, alone or with others.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    pub height_mm: f64,
    pub shapes: &'a Shapes,
    /// The model, by its index in the job.
    pub model: usize,
    /// Its own tolerance, in place of the plan's.
    pub tolerance: Option<f64>,
}

impl<'a> Part<'a> {
    /// A model alone.
    pub fn alone(height_mm: f64, shapes: &'a Shapes) -> Self {
        Self {
            height_mm,
            shapes,
            model: 0,
            tolerance: None,
        }
    }
}
