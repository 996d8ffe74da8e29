//! The fewest layers within tolerance, or the shortest print time, by dynamic programming (Procedure 1).

use super::segment::{Segment, Segments};
use super::{Limits, Plan, PlanError, timed, tradeoff};
use crate::profile::{ErrorSum, LayerErrors, Reach};
use crate::resin::Resin;

/// What a plan minimises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective<'a> {
    /// The number of layers, K.
    Layers,
    /// The print time.
    Time(&'a Resin),
}

/// Plans the fewest layers, or the shortest time, such that no layer exceeds the tolerance. Among those plans it returns
/// one with the smallest maximum error.
///
/// `snap_planes` are boundaries of bins, the most important first. Each becomes a plane, unless layers cannot add up to
/// the heights beside it or would exceed the tolerance there.
///
/// Cost: for the fewest layers under an additive metric, linear in bins, whatever the range of thicknesses; otherwise bins
/// times thicknesses.
///
/// # Errors
/// [`PlanError::Infeasible`] names the heights where no plan is within tolerance, and limits that would have one. Other
/// [`PlanError`]s are for contradictory limits.
pub fn plan(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let tolerance = errors.to_steps(limits.tolerance);
    within(errors, limits, snap_planes, objective, tolerance)?
        .map_err(|blocked| infeasible(&blocked, errors, limits, objective))
}

/// Where there is no plan, and what would do.
pub(super) fn infeasible(
    blocked: &Blocked,
    errors: &LayerErrors,
    limits: &Limits,
    objective: Objective<'_>,
) -> PlanError {
    let mm = |boundary| errors.bins().boundary_mm(boundary);
    let thinnest = blocked.segment.thickness.start() * blocked.segment.unit;
    PlanError::Infeasible {
        from_mm: mm(blocked.reached),
        to_mm: mm(blocked.next),
        tolerance: limits.tolerance,
        layer_min_mm: mm(thinnest),
        least_tolerance: tradeoff::least_tolerance(errors, limits, objective),
        largest_layer_min_mm: tradeoff::largest_layer_min_mm(errors, limits, objective),
    }
}

/// Where no plan is within tolerance.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocked {
    /// The segment that cannot be filled within tolerance.
    pub segment: Segment,
    /// The highest plane in it that layers can reach, as a boundary of bins.
    pub reached: u32,
    /// The top of the thinnest layer above that plane.
    pub next: u32,
}

/// The best plan whose layers have errors of at most `tolerance` steps, or the place that makes it impossible.
///
/// # Errors
/// [`PlanError`] if the limits allow no plan at any tolerance.
pub fn within(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
    tolerance: u64,
) -> Result<Result<Plan, Blocked>, PlanError> {
    let bins = errors.bins();
    let mut snap_planes = snap_planes.to_vec();
    loop {
        let laid_out = Segments::new(bins, limits, &snap_planes)?;
        let filled = match objective {
            Objective::Layers => fewest(errors, &laid_out.segments, tolerance),
            Objective::Time(resin) => timed::quickest(errors, &laid_out.segments, resin, tolerance),
        };
        let Stuck { segment, reached } = match filled {
            Ok(boundaries) => {
                return Ok(Ok(Plan {
                    bins,
                    boundaries,
                    snap_planes: laid_out.snap_planes,
                }));
            }
            Err(stuck) => stuck,
        };
        // The tolerance takes precedence: drop the snap planes beside this segment, and start again.
        let segment = &laid_out.segments[segment];
        let beside = [segment.lower, segment.upper()];
        let (given_up, kept): (Vec<u32>, Vec<u32>) = laid_out
            .snap_planes
            .iter()
            .partition(|snap_plane| beside.contains(snap_plane));
        if given_up.is_empty() {
            let next = (reached + segment.thickness.start()).min(segment.units);
            return Ok(Err(Blocked {
                segment: segment.clone(),
                reached: segment.boundary(reached),
                next: segment.boundary(next),
            }));
        }
        snap_planes = kept;
    }
}

/// The segment that no layers within tolerance fill, by its index, and the highest plane in it that they reach.
pub(super) struct Stuck {
    pub segment: usize,
    pub reached: u32,
}

/// The boundaries of the fewest layers within tolerance. Segments do not depend on each other.
fn fewest(errors: &LayerErrors, segments: &[Segment], tolerance: u64) -> Result<Vec<u32>, Stuck> {
    let mut boundaries = vec![0];
    for (index, segment) in segments.iter().enumerate() {
        let table = match errors {
            LayerErrors::Sum(errors) => fill_fewest(errors, segment, tolerance),
            LayerErrors::Volume(_) | LayerErrors::Deviation(_) => {
                fill_cheapest(errors, segment, tolerance, |_| 1)
            }
        };
        if !table.reaches_top() {
            return Err(Stuck {
                segment: index,
                reached: table.highest_reached(),
            });
        }
        boundaries.extend(table.planes().map(|plane| segment.boundary(plane)));
    }
    Ok(boundaries)
}

/// The arrays of Procedure 1 for the planes of a segment, as in figure 3.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// K\[p\]: the minimum cost up to plane p, in layers or microseconds; [`Self::NO_PLAN`] if no plan reaches it.
    pub cost: Vec<u64>,
    /// The smallest maximum error, in steps, among the plans of that cost.
    pub worst: Vec<u64>,
    /// D\[p\]: the plane below p in the best plan up to p.
    pub below: Vec<u32>,
}

impl Table {
    /// The cost of a plane that no plan reaches: ∞.
    pub const NO_PLAN: u64 = u64::MAX;

    fn new(units: u32) -> Self {
        let mut table = Self::unreached(units);
        table.cost[0] = 0;
        table
    }

    /// A table in which no plan reaches any plane.
    pub(super) fn unreached(units: u32) -> Self {
        let planes = units as usize + 1;
        Self {
            cost: vec![Self::NO_PLAN; planes],
            worst: vec![0; planes],
            below: vec![0; planes],
        }
    }

    pub(super) fn reaches_top(&self) -> bool {
        self.cost.last() != Some(&Self::NO_PLAN)
    }

    pub(super) fn highest_reached(&self) -> u32 {
        let reached = self.cost.iter().rposition(|&cost| cost != Self::NO_PLAN);
        reached.unwrap_or(0) as u32
    }

    /// Notes a plan of this cost and maximum error up to a plane, whose last layer begins at `below`, if it is better than the
    /// one known. Returns whether it is.
    pub(super) fn improve(&mut self, plane: u32, found: (u64, u64), below: u32) -> bool {
        let plane = plane as usize;
        let is_better = found < (self.cost[plane], self.worst[plane]);
        if is_better {
            (self.cost[plane], self.worst[plane]) = found;
            self.below[plane] = below;
        }
        is_better
    }

    /// Lines 8 to 11 of Procedure 1: the planes of the best plan in ascending order, without plane 0.
    fn planes(&self) -> impl Iterator<Item = u32> {
        let top = self.cost.len() as u32 - 1;
        let downward = std::iter::successors(Some(top), |&plane| Some(self.below[plane as usize]));
        let mut planes: Vec<u32> = downward.take_while(|&plane| plane > 0).collect();
        planes.reverse();
        planes.into_iter()
    }
}

/// A plane that may be the best one below some later plane.
#[derive(Clone, Copy)]
struct Candidate {
    plane: u32,
    layers: u64,
    worst: u64,
    /// The error of everything below it.
    steps_below: u64,
}

/// Lines 1 to 7 of Procedure 1 under an additive metric: the fewest layers up to every plane, and among those plans the
/// smallest maximum error.
///
/// A queue replaces the inner loop. No density is negative, so the lowest plane within tolerance only moves up. A plane is
/// obsolete once a higher one has neither more layers below it nor, at equal layers, a larger error. The candidates that
/// remain increase upward in layers, then in error.
///
/// Among the candidates with the fewest layers, the error below the candidate increases upward and that of the layer on
/// top decreases. The best candidate is where the two cross, and that place also only moves up.
pub fn fill_fewest(errors: &ErrorSum, segment: &Segment, tolerance: u64) -> Table {
    let mut table = Table::new(segment.units);
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let mut queue: Vec<Candidate> = Vec::new();
    let (mut front, mut best) = (0, 0);
    for plane in least..=segment.units {
        let highest = plane - least;
        let layers = table.cost[highest as usize];
        if layers != Table::NO_PLAN {
            let worst = table.worst[highest as usize];
            while queue.len() > front
                && queue
                    .last()
                    .is_some_and(|last| (last.layers, last.worst) >= (layers, worst))
            {
                queue.pop();
            }
            if best >= queue.len() {
                best = queue.len().saturating_sub(1).max(front);
            }
            queue.push(Candidate {
                plane: highest,
                layers,
                worst,
                steps_below: errors.steps_below(segment.boundary(highest)),
            });
        }
        let steps = errors.steps_below(segment.boundary(plane));
        let error_from = |below: &Candidate| steps - below.steps_below;
        while queue
            .get(front)
            .is_some_and(|below| plane - below.plane > greatest || error_from(below) > tolerance)
        {
            front += 1;
        }
        best = best.max(front);
        let Some(fewest) = queue.get(front).map(|below| below.layers) else {
            continue;
        };
        while queue
            .get(best + 1)
            .is_some_and(|next| next.layers == fewest && next.worst <= error_from(next))
        {
            best += 1;
        }
        let worst_over = |below: &Candidate| below.worst.max(error_from(below));
        let mut chosen = (worst_over(&queue[best]), queue[best].plane);
        if let Some(next) = queue.get(best + 1)
            && next.layers == fewest
            && worst_over(next) < chosen.0
        {
            chosen = (worst_over(next), next.plane);
        }
        table.cost[plane as usize] = fewest + 1;
        (table.worst[plane as usize], table.below[plane as usize]) = chosen;
    }
    table
}

/// The minimum cost up to every plane under any metric, and among those plans the smallest maximum error. A layer costs
/// `cost_of` its thickness in units.
pub fn fill_cheapest(
    errors: &LayerErrors,
    segment: &Segment,
    tolerance: u64,
    cost_of: impl Fn(u32) -> u64,
) -> Table {
    let mut table = Table::new(segment.units);
    for plane in 0..segment.units {
        let cost = table.cost[plane as usize];
        if cost == Table::NO_PLAN {
            continue;
        }
        let worst = table.worst[plane as usize];
        for_each_layer(errors, segment, tolerance, plane, |thickness, error| {
            let found = (cost + cost_of(thickness), worst.max(error));
            table.improve(plane + thickness, found, plane);
        });
    }
    table
}

/// Calls `emit(thickness, error)` with each layer within tolerance that begins at a plane of a segment.
pub(super) fn for_each_layer(
    errors: &LayerErrors,
    segment: &Segment,
    tolerance: u64,
    plane: u32,
    mut emit: impl FnMut(u32, u64),
) {
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let lower = segment.boundary(plane);
    let mut layers = errors.layers_above(lower, tolerance);
    for thickness in least..=greatest.min(segment.units - plane) {
        match layers.up_to(lower + thickness * segment.unit) {
            Reach::Within(error) => emit(thickness, error),
            Reach::Beyond => {}
            Reach::BeyondFromHere => break,
        }
    }
}
