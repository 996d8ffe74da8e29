//! Planners, against closed forms and naive oracles.

mod baselines;
mod cases;
mod gradual;
mod largest;
mod least_sum;
mod limits;
mod optimal;
mod thicknesses;
mod tradeoff;

use crate::common::bins;
use cusp_slicer::plan::optimal::Objective;
use cusp_slicer::plan::segment::Segment;
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::{Limits, Plan, PlanError};
use cusp_slicer::profile::deviation::DeviationError;
use cusp_slicer::profile::volume::VolumeError;
use cusp_slicer::profile::{ErrorSum, LayerErrors, Profile};
use cusp_slicer::resin::Resin;

const FIGURE_3: [f32; 8] = [0.2, 0.2, 0.2, 0.3, 0.4, 0.1, 0.2, 0.2];

fn error_sum(density: &[f32]) -> ErrorSum {
    Profile {
        bins: bins(density.len()),
        density: density.to_vec(),
    }
    .error_sum()
}

fn sum(density: &[f32]) -> LayerErrors {
    LayerErrors::Sum(error_sum(density))
}

fn volume(areas_mm2: &[f64]) -> LayerErrors {
    LayerErrors::Volume(VolumeError::new(areas_mm2, bins(areas_mm2.len())))
}

fn limits(layer_min_mm: f64, layer_max_mm: f64, tolerance: f64) -> Limits {
    Limits {
        layer_min_mm,
        layer_max_mm,
        tolerance,
        ..Limits::default()
    }
}

/// A resin without bottom layers, with `overhead_s` between layers.
fn resin(layer_mm: f64, exposure_s: f64, penetration_mm: f64, overhead_s: f64) -> Resin {
    Resin {
        layer_mm,
        exposure_s,
        penetration_mm,
        wait_s: overhead_s,
        lift_mm: 0.0,
        bottom_layers: 0,
        ..Resin::default()
    }
}

fn segment(units: usize, thickness: (u32, u32)) -> Segment {
    Segment {
        lower: 0,
        units: units as u32,
        unit: 1,
        thickness: thickness.0..=thickness.1,
    }
}

fn plan(density: &[f32], limits: &Limits) -> Result<Plan, PlanError> {
    cusp_slicer::plan::optimal::plan(&sum(density), limits, SnapPlanes::NONE, Objective::Layers)
}

/// Random densities in tenths, so that sums often equal the tolerance.
fn random_tenths(random: &mut fastrand::Rng, count: usize) -> Vec<u64> {
    let is_flat = random.bool();
    (0..count)
        .map(|_| {
            if is_flat && random.bool() {
                0
            } else {
                random.u64(0..=10)
            }
        })
        .collect()
}

fn in_tenths(tenths: &[u64]) -> Vec<f32> {
    tenths.iter().map(|&tenths| tenths as f32 / 10.0).collect()
}

/// Errors of a random model under a random metric, with a description of the model.
fn random_errors(random: &mut fastrand::Rng, count: usize) -> (LayerErrors, String) {
    match random.u32(0..3) {
        0 => {
            let tenths = random_tenths(random, count);
            (sum(&in_tenths(&tenths)), format!("{tenths:?}"))
        }
        1 => {
            let areas: Vec<f64> = (0..count).map(|_| f64::from(random.u32(0..=9))).collect();
            (volume(&areas), format!("{areas:?}"))
        }
        _ => {
            let squares = in_tenths(&random_tenths(random, count));
            let errors = DeviationError::new(&squares, bins(count));
            (LayerErrors::Deviation(errors), format!("{squares:?}"))
        }
    }
}
