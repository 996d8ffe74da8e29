//! The fewest layers within tolerance, or the shortest print time, by dynamic programming (Procedure 1).

use super::queue::{Candidate, Queue};
use super::segment::{Segment, Segments, boundaries_below};
use super::snap_cost::{ByHeight, SnapCosts, SnapPlanes};
use super::{Limits, Plan, PlanError, breadth_first, minimum_time, tradeoff};
use crate::profile::{LayerErrors, LayersAbove, Reach};
use crate::resin::Resin;

/// Quantity that a plan minimises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective<'a> {
    /// The number of layers, K.
    Layers,
    /// The print time.
    Time(&'a Resin),
}

/// Plans the fewest layers, or the shortest time, such that no layer exceeds the tolerance. Doing without a snap plane costs what
/// its price says. Among the plans of the least cost it returns one with the most snap planes, and among those one with the smallest
/// maximum error.
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
    snap_planes: SnapPlanes<'_>,
    objective: Objective<'_>,
) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let tolerance = errors.to_steps(limits.tolerance);
    within(errors, limits, snap_planes, objective, tolerance)?
        .map_err(|blocked| infeasible(&blocked, errors, limits, objective))
}

/// The error for limits without a plan, with the tolerance or minimum thickness that would allow one.
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
        model_number: None,
        tolerance: limits.tolerance,
        layer_min_mm: mm(thinnest),
        least_tolerance: tradeoff::least_tolerance(errors, limits, objective),
        largest_layer_min_mm: tradeoff::largest_layer_min_mm(errors, limits, objective),
    }
}

/// Place at which no plan is within tolerance.
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
    snap_planes: SnapPlanes<'_>,
    objective: Objective<'_>,
    tolerance: u64,
) -> Result<Result<Plan, Blocked>, PlanError> {
    let bins = errors.bins();
    let segments = Segments::new(bins, limits, &[])?.segments;
    let snap_planes = &snap_planes.by_height();
    let filled = match objective {
        Objective::Layers => fewest(errors, &segments, snap_planes, tolerance),
        Objective::Time(resin) => {
            minimum_time::quickest(errors, &segments, snap_planes, resin, tolerance)
        }
    };
    Ok(match filled {
        Ok(boundaries) => {
            let kept = kept(&segments, snap_planes, &boundaries);
            Ok(Plan::new(bins, &segments, boundaries, kept))
        }
        Err(Stuck { segment, reached }) => {
            let segment = &segments[segment];
            let next = (reached + segment.thickness.start()).min(segment.units);
            Err(Blocked {
                segment: segment.clone(),
                reached: segment.boundary(reached),
                next: segment.boundary(next),
            })
        }
    })
}

/// The snap planes that are among the boundaries of a plan, in ascending order.
fn kept(segments: &[Segment], snap_planes: &ByHeight, boundaries: &[u32]) -> Vec<u32> {
    let mut kept: Vec<u32> = segments
        .iter()
        .flat_map(|segment| {
            let planes = snap_planes.within(segment);
            planes.map(|(plane, _)| segment.boundary(plane))
        })
        .filter(|plane| boundaries.binary_search(plane).is_ok())
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The segment that no layers within tolerance fill, by its index, and the highest plane in it that they reach.
pub(super) struct Stuck {
    pub segment: usize,
    pub reached: u32,
}

/// The boundaries of the fewest layers within tolerance. Segments do not depend on each other.
fn fewest(
    errors: &LayerErrors,
    segments: &[Segment],
    snap_planes: &ByHeight,
    tolerance: u64,
) -> Result<Vec<u32>, Stuck> {
    let mut boundaries = boundaries_below(segments);
    for (index, segment) in segments.iter().enumerate() {
        let preferred = SnapCosts::within(segment, snap_planes, 1);
        // With snap planes, a plan of more layers may cost less.
        if preferred.is_empty()
            && let LayerErrors::Sum(errors) = errors
            && let Some(planes) = breadth_first::fewest(errors, segment, tolerance)
        {
            boundaries.extend(planes.into_iter().map(|plane| segment.boundary(plane)));
            continue;
        }
        let table = match errors {
            // A plane's sum is looked up once, not for each layer that it may bound.
            LayerErrors::Sum(errors) => fill_fewest_by(
                |boundary| errors.steps_below(boundary),
                |lower, upper| upper - lower,
                segment,
                &preferred,
                tolerance,
            ),
            errors if errors.is_monotone() => fill_fewest(
                |lower, upper| errors.steps_between(lower, upper),
                segment,
                &preferred,
                tolerance,
            ),
            errors => fill_cheapest(errors, segment, &preferred, tolerance, |_| 1),
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
    /// K\[p\]: the minimum cost up to plane p, in layers or microseconds, prices of snap planes included; [`Self::NO_PLAN`] if no
    /// plan reaches it.
    pub cost: Vec<u64>,
    /// The least weight of the snap planes that a plan of that cost does without.
    pub missed: Vec<u64>,
    /// The smallest maximum error, in steps, among the plans of that cost and weight.
    pub worst: Vec<u64>,
    /// D\[p\]: the plane below p in the best plan up to p.
    pub below: Vec<u32>,
}

impl Table {
    /// The cost of a plane that no plan reaches: ∞.
    pub const NO_PLAN: u64 = u64::MAX;

    pub(super) fn new(units: u32) -> Self {
        let mut table = Self::unreached(units);
        table.cost[0] = 0;
        table
    }

    /// A table in which no plan reaches any plane.
    pub(super) fn unreached(units: u32) -> Self {
        let planes = units as usize + 1;
        Self {
            cost: vec![Self::NO_PLAN; planes],
            missed: vec![0; planes],
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

    /// Cost, weight of missed snap planes, and maximum error of the best plan up to a plane.
    pub(super) fn at(&self, plane: u32) -> [u64; 3] {
        let plane = plane as usize;
        [self.cost[plane], self.missed[plane], self.worst[plane]]
    }

    #[inline]
    fn set(&mut self, plane: u32, found: [u64; 3], below: u32) {
        let plane = plane as usize;
        [self.cost[plane], self.missed[plane], self.worst[plane]] = found;
        self.below[plane] = below;
    }

    /// Notes a plan of this cost, weight and maximum error up to a plane, whose last layer begins at `below`, if it is
    /// better than the known one. Returns true if it is.
    pub(super) fn improve(&mut self, plane: u32, found: [u64; 3], below: u32) -> bool {
        let is_better = found < self.at(plane);
        if is_better {
            self.set(plane, found, below);
        }
        is_better
    }

    /// The planes of the best plan up to the top in ascending order, without plane 0.
    fn planes(&self) -> impl Iterator<Item = u32> {
        self.planes_to(self.cost.len() as u32 - 1)
    }

    /// Lines 8 to 11 of Procedure 1: the planes of the best plan up to `top` in ascending order, without plane 0.
    pub(super) fn planes_to(&self, top: u32) -> impl Iterator<Item = u32> {
        let downward = std::iter::successors(Some(top), |&plane| Some(self.below[plane as usize]));
        let mut planes: Vec<u32> = downward.take_while(|&plane| plane > 0).collect();
        planes.reverse();
        planes.into_iter()
    }
}

/// Lines 1 to 7 of Procedure 1 for errors that never shrink as a layer grows: the fewest layers up to every plane, and among
/// those plans the smallest maximum error. `error_between` is the error of the layer between two boundaries, in steps.
///
/// A queue of planes replaces the inner loop.
pub fn fill_fewest(
    error_between: impl Fn(u32, u32) -> u64,
    segment: &Segment,
    preferred: &SnapCosts,
    tolerance: u64,
) -> Table {
    let itself = |boundary| boundary;
    fill_fewest_by(itself, error_between, segment, preferred, tolerance)
}

/// [`fill_fewest`] for errors that are made from a mark of each boundary.
fn fill_fewest_by<Mark: Copy>(
    mark_of: impl Fn(u32) -> Mark,
    error_between: impl Fn(Mark, Mark) -> u64,
    segment: &Segment,
    preferred: &SnapCosts,
    tolerance: u64,
) -> Table {
    let mut table = Table::new(segment.units);
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let mut queue = Queue::new();
    for plane in least..=segment.units {
        let highest = plane - least;
        let [layers, missed, worst] = table.at(highest);
        if layers != Table::NO_PLAN {
            // With the prices and weights of all snap planes above: a layer on top costs 1, less those above its top.
            let [price, weight] = preferred.above(highest);
            queue.push(Candidate {
                plane: highest,
                cost: [layers + price, missed + weight],
                worst,
                mark: mark_of(segment.boundary(highest)),
            });
        }
        let top = mark_of(segment.boundary(plane));
        let error_from = |below: &Candidate<_, Mark>| error_between(below.mark, top);
        let is_passed = |below: &Candidate<_, Mark>| {
            plane - below.plane > greatest || error_from(below) > tolerance
        };
        if let Some((least_cost, below, worst)) = queue.best(is_passed, error_from) {
            let [cost, missed] = preferred.below(least_cost, plane);
            table.set(plane, [cost + 1, missed, worst], below);
        }
    }
    table
}

/// The minimum cost up to every plane under any metric, and among those plans the least weight of missed snap planes, then the
/// smallest maximum error. A layer costs `cost_of` its thickness in units.
pub fn fill_cheapest(
    errors: &LayerErrors,
    segment: &Segment,
    preferred: &SnapCosts,
    tolerance: u64,
    cost_of: impl Fn(u32) -> u64,
) -> Table {
    let mut table = Table::new(segment.units);
    for plane in 0..segment.units {
        let [cost, missed, worst] = table.at(plane);
        if cost == Table::NO_PLAN {
            continue;
        }
        let mut layers = layers_above(errors, segment, plane, tolerance);
        for (thickness, top) in tops(segment, plane) {
            let [price, weight] = preferred.within_layer(plane, top);
            let found = [cost + cost_of(thickness) + price, missed + weight, worst];
            // A plan that is no better even without this layer's error need not be measured.
            if found >= table.at(top) {
                continue;
            }
            match layers.up_to(segment.boundary(top)) {
                Reach::Within(error) => {
                    table.improve(top, [found[0], found[1], worst.max(error)], plane);
                }
                Reach::Beyond => {}
                Reach::BeyondFromHere => break,
            }
        }
    }
    table
}

/// The layers that begin at a plane of a segment.
pub(super) fn layers_above<'a>(
    errors: &'a LayerErrors,
    segment: &Segment,
    plane: u32,
    tolerance: u64,
) -> LayersAbove<'a> {
    errors.layers_above(segment.boundary(plane), tolerance)
}

/// The thicknesses of the layers that may begin at a plane of a segment, with the planes on top of them.
pub(super) fn tops(segment: &Segment, plane: u32) -> impl Iterator<Item = (u32, u32)> {
    let (least, greatest) = (*segment.thickness.start(), *segment.thickness.end());
    let thicknesses = least..=greatest.min(segment.units - plane);
    thicknesses.map(move |thickness| (thickness, plane + thickness))
}
