//! Estimates of a job's work, made before it. They divide counts that are cheap to find by a rate that no processor
//! exceeds, so a job that is refused would indeed have taken too long.

use super::memory::hits_of;
use super::parts::{Layering, Target, Thicknesses};
use crate::grid::{Bins, Grid};
use crate::job::{Error, Minimize, Planner, Work};
use crate::model::{Mesh, saliency};
use crate::plan::minimum_time::MOST_BOTTOM_LAYERS;
use crate::profile::Metric;

/// Hits that a processor finds in a second, at most.
const HITS_PER_S: f64 = 1e8;
/// Cells that a processor looks up in a second, at most.
const CELLS_PER_S: f64 = 2e8;
/// Layers whose errors a processor measures in a second, at most.
const LAYERS_PER_S: f64 = 1e9;
/// Plans that a search for a tolerance comes to, without those that end early.
const SEARCHES: f64 = 20.0;

/// Checks that the rays of a mesh take no more than this processor time.
///
/// # Errors
/// [`Error::TimeBound`].
pub fn check_hits(mesh: &Mesh, rays: &Grid, allowed_s: f64) -> Result<(), Error> {
    check(Work::Hits, hits_of(mesh, rays) / HITS_PER_S, allowed_s)
}

/// Checks that the saliency of a mesh takes no more than this processor time.
///
/// # Errors
/// [`Error::TimeBound`].
pub fn check_saliency(mesh: &Mesh, allowed_s: f64) -> Result<(), Error> {
    let cells = (mesh.vertices.len() * saliency::CELLS_WITHIN_REACH) as f64;
    check(Work::Saliency, cells / CELLS_PER_S, allowed_s)
}

/// Checks that a plan in these bins takes no more than this processor time.
///
/// # Errors
/// [`Error::TimeBound`].
pub fn check_plan(bins: Bins, layering: &Layering, allowed_s: f64) -> Result<(), Error> {
    let layers = layers_to_measure(bins, layering);
    check(Work::Layers, layers / LAYERS_PER_S, allowed_s)
}

fn check(work: Work, needed_s: f64, allowed_s: f64) -> Result<(), Error> {
    if needed_s <= allowed_s {
        return Ok(());
    }
    Err(Error::TimeBound {
        work,
        needed_s: needed_s.ceil(),
        allowed_s,
    })
}

/// Number of layer errors that a planner measures: bins times thicknesses, unless the fewest layers are wanted under a
/// metric that adds up.
fn layers_to_measure(bins: Bins, layering: &Layering) -> f64 {
    let limits = layering.limits(0.0);
    let (Ok(unit), Ok(thickness)) = (
        limits.unit(bins),
        limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm),
    ) else {
        // The plan reports the error.
        return 0.0;
    };
    let planes = bins.count as f64 / f64::from(unit);
    let is_found_by_time = matches!(layering.target, Target::Time(_));
    let is_by_time = is_found_by_time || layering.minimize == Minimize::Time;
    let adds_up = !matches!(layering.metric, Metric::Volume | Metric::Deviation);
    let is_any = layering.thicknesses == Thicknesses::Any;
    let is_optimal = layering.planner == Planner::Optimal;
    let is_linear = is_any && adds_up && !is_by_time || !is_optimal;
    let thicknesses = f64::from(thickness.end() - thickness.start() + 1).min(planes);
    // The layers above a plane end at the top.
    let layers = if is_linear {
        planes
    } else {
        (planes - thicknesses / 2.0) * thicknesses
    };
    // The time of a layer depends on the number of bottom layers below it.
    let of_bottom = if is_by_time {
        layering.resin.bottom_layers.min(MOST_BOTTOM_LAYERS) as f64 + 1.0
    } else {
        1.0
    };
    let searches = match layering.target {
        Target::Tolerance(_) => 1.0,
        Target::AtLeast(_) | Target::Layers(_) | Target::Time(_) => SEARCHES,
    };
    layers * of_bottom * searches
}
