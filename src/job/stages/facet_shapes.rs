//! The shapes of a model from its facets alone, as previews and orientation searches take them.

use super::parts::Layering;
use crate::grid::Bins;
use crate::model::Mesh;
use crate::profile::facet_bins::FacetBins;
use crate::profile::normal_cones::{Cone, cones};
use crate::profile::shapes::Shapes;
use crate::profile::{Metric, section};

/// Inputs of some metrics besides facets by bins. The other lists stay empty.
#[derive(Debug, Default)]
pub struct Extra {
    /// Areas of sections.
    areas_mm2: Vec<f64>,
    /// Normal cones.
    pub cones: Vec<Cone>,
}

impl Extra {
    /// The inputs of a metric, for a mesh that stands on the plate.
    pub fn of(mesh: &Mesh, metric: Metric, bins: Bins) -> Self {
        let mut extra = Self::default();
        if metric.needs_areas() {
            extra.areas_mm2 = section::exact(mesh, &[], bins);
        }
        if metric.needs_cones() {
            extra.cones = cones(mesh, bins);
        }
        extra
    }
}

/// The shapes from facets alone, weighted for the metric. Calls `extra` only if the metric needs any of it.
pub fn shapes_of<E>(
    facet_bins: &FacetBins,
    extra: impl FnOnce() -> Result<Extra, E>,
    layering: &Layering,
    weights: Option<Vec<f32>>,
) -> Result<Shapes, E> {
    let metric = layering.metric;
    let Extra { areas_mm2, cones } = if metric.needs_areas() || metric.needs_cones() {
        extra()?
    } else {
        Extra::default()
    };
    let shapes = Shapes::of_facets(facet_bins, areas_mm2, cones);
    Ok(shapes.weighed_by_facets(facet_bins, layering.metric, weights))
}
