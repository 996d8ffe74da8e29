//! The fewest layers with few thicknesses.
//!
//! Each thickness needs an exposure of its own, and each exposure has to be calibrated. [`of`] plans with given thicknesses,
//! [`at_most`] chooses the best ones.
//!
//! Layers of few thicknesses rarely add up to the height of the model. The top is therefore the nearest height that they reach
//! within tolerance, the lower of two equally near. It moves by at most half the least thickness of the set, or half the minimum
//! thickness if that is more. Mandatory planes do not move.

use super::optimal::{self, Objective, Table, layers_above};
use super::segment::{Segment, Segments, boundaries_below};
use super::snap_cost::SnapPlanes;
use super::thickness_subset::Search;
use super::tradeoff::{least_steps, round_up};
use super::{Limits, Plan, PlanError};
use crate::grid::Bins;
use crate::profile::{LayerErrors, Reach};
use crate::progress::{Cancelled, Progress};
use crate::quantity::Quantity;

/// Plans the fewest layers within tolerance whose thicknesses, in millimetres, are all in a set. Among the plans with so few layers
/// it returns one with the smallest maximum error. Thicknesses outside the limits, or of the height range, are left out.
///
/// Cost: bins times thicknesses of the set; if there is no plan, as much for each of some 40 tolerances.
///
/// # Errors
/// [`PlanError::NotWholeBins`] or [`PlanError::NotWholeSteps`] for a thickness, [`PlanError::ThicknessesDoNotFit`]
/// if the set has no plan. Other [`PlanError`]s are for contradictory limits.
pub fn of(
    errors: &LayerErrors,
    limits: &Limits,
    thicknesses_mm: &[f64],
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let units = Bins {
        count: bins.count,
        size_mm: bins.boundary_mm(limits.unit(bins)?),
    };
    let mut set = Vec::with_capacity(thicknesses_mm.len());
    for &thickness_mm in thicknesses_mm {
        let whole = limits.whole_units(bins, Quantity::Layer, thickness_mm)?;
        // Thicker ones are outside every range.
        set.push(whole.min(f64::from(u32::MAX)) as u32);
    }
    set.sort_unstable();
    set.dedup();
    let segments = Segments::new(bins, limits, &[])?.segments;
    let steps = errors.to_steps(limits.tolerance);
    let stuck = match fewest(errors, &segments, &set, steps) {
        Ok(plan) => return Ok(plan),
        Err(stuck) => stuck,
    };
    let loosest = fewest(errors, &segments, &set, u64::MAX).ok();
    let least_tolerance = loosest.and_then(|loosest| {
        let most = loosest.max_error_steps(errors);
        let has_plan = |steps| Ok(fewest(errors, &segments, &set, steps).is_ok());
        Some(round_up(errors.to_value(least_steps(most, has_plan).ok()?)))
    });
    Err(PlanError::ThicknessesDoNotFit {
        from_mm: bins.boundary_mm(stuck.reached),
        to_mm: bins.boundary_mm(stuck.upper),
        model_number: None,
        tolerance: limits.tolerance,
        thicknesses_mm: set
            .into_iter()
            .map(|thickness| units.boundary_mm(thickness))
            .collect(),
        least_tolerance,
    })
}

/// A plan with few thicknesses.
#[derive(Debug, Clone, PartialEq)]
pub struct FewThicknesses {
    /// The plan.
    pub plan: Plan,
    /// The thicknesses that its layers have, in millimetres, argsort.
    pub thicknesses_mm: Vec<f64>,
    /// A proven lower bound of the number of layers. It equals that of the plan unless the search ended early.
    pub least_layers: usize,
}

/// Steps of a search for the best set that take ten to thirty seconds: see [`at_most`].
pub const DEFAULT_STEPS: u64 = 10_000_000_000;

/// Plans the fewest layers within tolerance that have at most `count` distinct thicknesses. The plan is the one that [`of`] returns
/// for the best set. Ties between sets go to the one found first, so its maximum error may not be the smallest of all.
///
/// The search is a branch and bound over sets, see `few.rs`, and exact unless it ends early. Its time grows steeply with `count`:
/// of 51 thicknesses on 30,000 bins it finds the best one in 0.1 s, the best three in half a second, four in 2 s and five in 10 to
/// 20 s; six take more than the default. After `most_steps`, see [`DEFAULT_STEPS`], it ends with the best set so far, and a proven bound in
/// [`FewThicknesses::least_layers`]. A step is a bin and a thickness, not a time, so the result is the same everywhere. Memory:
/// 4 bytes for each pair of bin and thickness.
///
/// # Errors
/// [`Cancelled`]. Otherwise [`PlanError::TooFewThicknesses`] if no set of at most `count` thicknesses has a plan,
/// [`PlanError::Infeasible`] if no thicknesses have. Other [`PlanError`]s are for contradictory limits.
pub fn at_most(
    errors: &LayerErrors,
    limits: &Limits,
    count: usize,
    most_steps: u64,
    progress: &mut Progress<'_>,
) -> Result<Result<FewThicknesses, PlanError>, Cancelled> {
    let bins = errors.bins();
    let laid_out = limits
        .check(bins)
        .and_then(|()| Segments::new(bins, limits, &[]));
    let segments = match laid_out {
        Ok(Segments { segments, .. }) => segments,
        Err(error) => return Ok(Err(error)),
    };
    let tolerance = errors.to_steps(limits.tolerance);
    let found = Search::new(errors, &segments, tolerance).run(count, most_steps, progress)?;
    if let Some((set, least_layers)) = found
        && let Ok(plan) = fewest(errors, &segments, &set, tolerance)
    {
        return Ok(Ok(FewThicknesses {
            thicknesses_mm: distinct(&plan)
                .into_iter()
                .map(|thickness| bins.boundary_mm(thickness))
                .collect(),
            least_layers: least_layers + plan.exempt_layers,
            plan,
        }));
    }
    let unrestricted = optimal::plan(errors, limits, SnapPlanes::NONE, Objective::Layers);
    Ok(Err(unrestricted.map_or_else(
        |error| error,
        |plan| PlanError::TooFewThicknesses {
            thicknesses: count,
            enough: distinct(&plan).len(),
        },
    )))
}

/// The thicknesses of a plan in bins, argsort, without that of a fixed first layer.
fn distinct(plan: &Plan) -> Vec<u32> {
    let layers = plan.covered().windows(2);
    let mut thicknesses: Vec<u32> = layers.map(|layer| layer[1] - layer[0]).collect();
    thicknesses.sort_unstable();
    thicknesses.dedup();
    thicknesses
}

/// Place at which a set has no plan, as boundaries of bins.
struct Stuck {
    /// The highest plane that layers reach below `upper`.
    reached: u32,
    /// The mandatory plane, or the top, that they do not reach.
    upper: u32,
}

/// The plan of the fewest layers whose thicknesses, in units, are all in an ascending set.
fn fewest(
    errors: &LayerErrors,
    segments: &[Segment],
    set: &[u32],
    tolerance: u64,
) -> Result<Plan, Stuck> {
    let bins = errors.bins();
    let mut boundaries = boundaries_below(segments);
    for (index, segment) in segments.iter().enumerate() {
        let ends = if index + 1 < segments.len() {
            vec![segment.units]
        } else {
            segment.ends(bins, set.first().copied().unwrap_or(1))
        };
        let table = fill(errors, segment, set, &ends, tolerance);
        let is_reached = |end: &&u32| table.cost[**end as usize] != Table::NO_PLAN;
        let Some(&end) = ends.iter().find(is_reached) else {
            return Err(Stuck {
                reached: segment.boundary(table.highest_reached()),
                upper: segment.upper().min(bins.count as u32),
            });
        };
        boundaries.extend(table.planes_to(end).map(|plane| segment.boundary(plane)));
    }
    Ok(Plan::new(bins, segments, boundaries, Vec::new()))
}

/// Fewest layers of a set up to every plane, and the smallest maximum error of plans with that number.
fn fill(
    errors: &LayerErrors,
    segment: &Segment,
    set: &[u32],
    ends: &[u32],
    tolerance: u64,
) -> Table {
    let highest = ends.iter().copied().max().unwrap_or(0);
    let mut table = Table::new(highest);
    let allowed: Vec<u32> = set
        .iter()
        .copied()
        .filter(|thickness| segment.thickness.contains(thickness))
        .collect();
    for plane in 0..highest {
        let [cost, missed, worst] = table.at(plane);
        if cost == Table::NO_PLAN {
            continue;
        }
        let mut layers = layers_above(errors, segment, plane, tolerance);
        for &thickness in &allowed {
            let top = plane + thickness;
            if top > highest {
                break;
            }
            match layers.up_to(segment.boundary(top)) {
                Reach::Within(error) => {
                    table.improve(top, [cost + 1, missed, worst.max(error)], plane);
                }
                Reach::Beyond => {}
                Reach::BeyondFromHere => break,
            }
        }
    }
    table
}
