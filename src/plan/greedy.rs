//! Planners that look no further than the next layer, for comparison: they may exceed the tolerance, and need more
//! layers than the optimal one.

use super::segment::{Segment, Segments};
use super::{Limits, Plan, PlanError};
use crate::profile::LayerErrors;

/// What a greedy planner looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// The profile: as many bins as stay within tolerance (section 3.3).
    Profile,
    /// The surface at the current plane alone, taken as straight from there on (\[3\] of the paper).
    Plane,
}

/// Layer by layer upward, each as thick as the tolerance allows by what `sight` shows, but within the limits.
///
/// # Errors
/// [`PlanError`] for limits that contradict each other.
pub fn plan(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    sight: Sight,
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let tolerance = errors.to_steps(limits.tolerance);
    let laid_out = Segments::new(bins, limits, snap_planes)?;
    let mut boundaries = vec![0];
    for segment in &laid_out.segments {
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
    Ok(Plan {
        bins,
        boundaries,
        snap_planes: laid_out.snap_planes,
    })
}

fn thickest_within(errors: &LayerErrors, segment: &Segment, plane: u32, tolerance: u64) -> u32 {
    let lower = segment.boundary(plane);
    let greatest = *segment.thickness.end();
    let is_within =
        |&units: &u32| errors.steps_between(lower, lower + units * segment.unit) <= tolerance;
    (1..=greatest).take_while(is_within).last().unwrap_or(0)
}

/// The thickness whose error would be the tolerance if the surface went on as in the bin above the plane.
fn thickest_straight(errors: &LayerErrors, segment: &Segment, plane: u32, tolerance: u64) -> u32 {
    let lower = segment.boundary(plane);
    let bins = match errors {
        LayerErrors::Sum(sum) => {
            let a_bin = sum.steps_between(lower, lower + 1).max(1);
            tolerance as f64 / a_bin as f64
        }
        // A section that grows by a each bin has the error a · n² / 2 after n bins.
        LayerErrors::Volume(_) => {
            let a_bin = errors.steps_between(lower, lower + 2).max(1);
            (2.0 * tolerance as f64 / a_bin as f64).sqrt()
        }
    };
    (bins / f64::from(segment.unit)).min(f64::from(u32::MAX)) as u32
}

/// The thickness nearest to the one wanted, rather below than above, with which the rest of the segment can still be
/// filled.
fn nearest_that_fits(segment: &Segment, plane: u32, wanted: u32) -> u32 {
    let rest = segment.units - plane;
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let wanted = wanted.clamp(least, greatest);
    let fits = |units: &u32| *units <= rest && segment.can_fill(rest - units);
    let below = (least..=wanted).rev().find(fits);
    // A segment that can be filled can be filled from one of these.
    below
        .or_else(|| (wanted..=greatest).find(fits))
        .unwrap_or(rest)
}
