//! The fewest layers within tolerance, or the shortest print, by dynamic programming (Procedure 1).

use super::segment::{Segment, Segments};
use super::{Limits, Plan, PlanError, tradeoff};
use crate::profile::{ErrorSum, LayerErrors};
use crate::resin::Resin;

/// What is to be as little as possible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective<'a> {
    /// The number of layers, K.
    Layers,
    /// The time that the layers take together.
    Time(&'a Resin),
}

/// Plans the fewest layers, or the shortest time, with all errors within the tolerance; among those plans one whose
/// largest error is the least.
///
/// There is a plane at each of `snap_planes`, boundaries of bins in the order of their importance, unless layers do not add
/// up or exceed the tolerance beside it.
///
/// Cost: linear in bins, whatever the range of thicknesses, for the fewest layers under an additive metric; bins times
/// thicknesses otherwise.
///
/// # Errors
/// [`PlanError`]; [`PlanError::Infeasible`] names the height that cannot be passed, and what would do.
pub fn plan(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let tolerance = errors.to_steps(limits.tolerance);
    match within(errors, limits, snap_planes, objective, tolerance)? {
        Ok(plan) => Ok(plan),
        Err(blocked) => {
            let mm = |boundary| bins.boundary_mm(boundary);
            let unit = blocked.segment.unit;
            Err(PlanError::Infeasible {
                from_mm: mm(blocked.reached),
                to_mm: mm(blocked.next),
                tolerance: limits.tolerance,
                layer_min_mm: mm(blocked.segment.thickness.start() * unit),
                least_tolerance: tradeoff::least_tolerance(errors, limits, objective),
                largest_layer_min_mm: tradeoff::largest_layer_min_mm(errors, limits, objective),
            })
        }
    }
}

/// Where a plan cannot go on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocked {
    /// The segment that cannot be filled within tolerance.
    pub segment: Segment,
    /// The highest plane that layers can reach in it, a boundary of bins.
    pub reached: u32,
    /// The top of the thinnest layer from there.
    pub next: u32,
}

/// The best plan whose errors are at most so many steps, or where there is none.
///
/// # Errors
/// [`PlanError`] for limits that no tolerance makes good.
pub fn within(
    errors: &LayerErrors,
    limits: &Limits,
    snap_planes: &[u32],
    objective: Objective<'_>,
    tolerance: u64,
) -> Result<Result<Plan, Blocked>, PlanError> {
    let bins = errors.bins();
    let mut snap_planes = snap_planes.to_vec();
    'snap_planes: loop {
        let laid_out = Segments::new(bins, limits, &snap_planes)?;
        let mut boundaries = vec![0];
        for segment in &laid_out.segments {
            let table = fill(errors, segment, objective, tolerance);
            if table.reaches_top() {
                boundaries.extend(table.planes().map(|plane| segment.boundary(plane)));
                continue;
            }
            // Wishes give way to the tolerance.
            let beside = [segment.lower, segment.upper()];
            let (given_up, kept): (Vec<u32>, Vec<u32>) = laid_out
                .snap_planes
                .iter()
                .partition(|snap_plane| beside.contains(snap_plane));
            if given_up.is_empty() {
                let reached = table.highest_reached();
                let next = (reached + segment.thickness.start()).min(segment.units);
                return Ok(Err(Blocked {
                    segment: segment.clone(),
                    reached: segment.boundary(reached),
                    next: segment.boundary(next),
                }));
            }
            snap_planes = kept;
            continue 'snap_planes;
        }
        return Ok(Ok(Plan {
            bins,
            boundaries,
            snap_planes: laid_out.snap_planes,
        }));
    }
}

fn fill(
    errors: &LayerErrors,
    segment: &Segment,
    objective: Objective<'_>,
    tolerance: u64,
) -> Table {
    match (errors, objective) {
        (LayerErrors::Sum(errors), Objective::Layers) => fill_fewest(errors, segment, tolerance),
        (_, Objective::Layers) => fill_cheapest(errors, segment, tolerance, |_| 1),
        (_, Objective::Time(resin)) => {
            let unit_mm = f64::from(segment.unit) * errors.bins().size_mm;
            let times: Vec<u64> = (0..=*segment.thickness.end())
                .map(|units| resin.layer_us(f64::from(units) * unit_mm))
                .collect();
            fill_cheapest(errors, segment, tolerance, |units| times[units as usize])
        }
    }
}

/// The arrays of Procedure 1, as figure 3 shows them, for the planes of a segment.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// K\[p\]: the least cost up to plane p, layers or microseconds; [`Self::NO_PLAN`] where no plan reaches it.
    pub cost: Vec<u64>,
    /// The least largest error in steps of the plans of that cost.
    pub worst: Vec<u64>,
    /// D\[p\]: the plane below p in the best plan up to p.
    pub below: Vec<u32>,
}

impl Table {
    /// The cost of a plane that no plan reaches: ∞.
    pub const NO_PLAN: u64 = u64::MAX;

    fn new(units: u32) -> Self {
        let planes = units as usize + 1;
        let mut table = Self {
            cost: vec![Self::NO_PLAN; planes],
            worst: vec![0; planes],
            below: vec![0; planes],
        };
        table.cost[0] = 0;
        table
    }

    fn reaches_top(&self) -> bool {
        self.cost.last() != Some(&Self::NO_PLAN)
    }

    fn highest_reached(&self) -> u32 {
        let reached = self.cost.iter().rposition(|&cost| cost != Self::NO_PLAN);
        reached.unwrap_or(0) as u32
    }

    /// Lines 8 to 11 of Procedure 1: the planes of the best plan but the lowest, upward.
    fn planes(&self) -> impl Iterator<Item = u32> {
        let top = self.cost.len() as u32 - 1;
        let downward = std::iter::successors(Some(top), |&plane| Some(self.below[plane as usize]));
        let mut planes: Vec<u32> = downward.take_while(|&plane| plane > 0).collect();
        planes.reverse();
        planes.into_iter()
    }
}

/// A plane that may be the best one below the planes to come.
#[derive(Clone, Copy)]
struct Candidate {
    plane: u32,
    layers: u64,
    worst: u64,
    /// Error of all that is below it.
    steps_below: u64,
}

/// Lines 1 to 7 of Procedure 1 under an additive metric: the fewest layers to every plane, and among those plans the
/// least largest error.
///
/// The inner loop is replaced by a queue. No density is negative, so the lowest plane within tolerance only moves up;
/// and a plane is of no more use once a higher one has no more layers below it, nor a larger error. What is left in the
/// queue grows upward in layers, then in error. Of the candidates with the fewest layers, the error of the layer on top
/// shrinks upward, so that the best is where the two errors cross; that place only moves up too.
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

/// The least cost to every plane under any metric, where a layer costs `cost_of` its thickness in units, and among
/// those plans the least largest error.
pub fn fill_cheapest(
    errors: &LayerErrors,
    segment: &Segment,
    tolerance: u64,
    cost_of: impl Fn(u32) -> u64,
) -> Table {
    let mut table = Table::new(segment.units);
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    for plane in 0..segment.units {
        let cost = table.cost[plane as usize];
        if cost == Table::NO_PLAN {
            continue;
        }
        let lower = segment.boundary(plane);
        let worst = table.worst[plane as usize];
        let (mut error, mut measured) = (0, lower);
        for thickness in least..=greatest.min(segment.units - plane) {
            let upper = lower + thickness * segment.unit;
            error += errors.steps_added(lower, measured, upper);
            measured = upper;
            // Errors of thicker layers are no less.
            if error > tolerance {
                break;
            }
            let above = (plane + thickness) as usize;
            let found = (cost + cost_of(thickness), worst.max(error));
            if found < (table.cost[above], table.worst[above]) {
                (table.cost[above], table.worst[above]) = found;
                table.below[above] = plane;
            }
        }
    }
    table
}
