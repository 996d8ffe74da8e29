//! Greedy planners, for comparison. They look no further than the next layer, so they may exceed the tolerance or use more
//! layers than the optimal planner.

use super::optimal::layers_above;
use super::segment::{Segment, Segments, boundaries_below};
use super::{Limits, Plan, PlanError};
use crate::profile::{LayerErrors, Reach};

/// Information that a greedy planner uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// The profile: a layer takes as many bins as stay within tolerance (section 3.3).
    Profile,
    /// Only the surface at the current plane, extrapolated with its slope there (\[3\] of the paper).
    Plane,
}

/// Plans layer by layer upward. Each layer is as thick as `sight` suggests for the tolerance, clamped to the limits.
///
/// # Errors
/// [`PlanError`] if the limits are contradictory.
pub fn plan(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    sight: Sight,
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let tolerance = errors.to_steps(limits.tolerance);
    let Segments {
        segments,
        snap_planes,
    } = Segments::new(bins, limits, snap_planes)?;
    let mut boundaries = boundaries_below(&segments);
    for segment in &segments {
        let mut plane = 0;
        while plane < segment.units {
            let wanted = match sight {
                Sight::Profile => thickest_within(errors, segment, plane, tolerance),
                Sight::Plane => thickest_straight(errors, segment, plane, tolerance),
            };
            plane += nearest_that_fits(segment, plane, wanted);
            boundaries.push(segment.boundary(plane));
        }
    }
    Ok(Plan::new(bins, &segments, boundaries, snap_planes))
}

fn thickest_within(errors: &LayerErrors, segment: &Segment, plane: u32, tolerance: u64) -> u32 {
    // No layer is thicker than the rest of the segment.
    let greatest = (*segment.thickness.end()).min(segment.units - plane);
    let mut layers = layers_above(errors, segment, plane, tolerance);
    let is_within = |&units: &u32| {
        let top = segment.boundary(plane + units);
        matches!(layers.up_to(top), Reach::Within(_))
    };
    (1..=greatest).take_while(is_within).last().unwrap_or(0)
}

/// The thickness whose error would equal the tolerance if the surface continued as in the bin above the plane.
fn thickest_straight(errors: &LayerErrors, segment: &Segment, plane: u32, tolerance: u64) -> u32 {
    let lower = segment.boundary(plane);
    let bins = match errors {
        // Both grow in proportion to the thickness on an even slope.
        LayerErrors::Sum(_) | LayerErrors::Deviation(_) | LayerErrors::Largest(_) => {
            let a_bin = errors.steps_between(lower, lower + 1).max(1);
            tolerance as f64 / a_bin as f64
        }
        // A section that grows by a per bin has an error of a · n² / 2 after n bins.
        LayerErrors::Volume(_) => {
            let a_bin = errors.steps_between(lower, lower + 2).max(1);
            (2.0 * tolerance as f64 / a_bin as f64).sqrt()
        }
    };
    (bins / f64::from(segment.unit)).min(f64::from(u32::MAX)) as u32
}

/// The largest thickness, at most `wanted`, that leaves a rest of the segment that layers can fill; if there is none, the
/// smallest above `wanted`.
fn nearest_that_fits(segment: &Segment, plane: u32, wanted: u32) -> u32 {
    let rest = segment.units - plane;
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let wanted = wanted.clamp(least, greatest);
    let fits = |units: &u32| *units <= rest && segment.can_fill(rest - units);
    let below = (least..=wanted.min(rest)).rev().find(fits);
    // Since the segment can be filled, one of these exists.
    below
        .or_else(|| (wanted..=greatest).find(fits))
        .unwrap_or(rest)
}
