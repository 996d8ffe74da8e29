//! The fewest layers whose thickness changes gradually.
//!
//! Each thickness has its own exposure, and an abrupt change of exposure shows on the surface. Lefebvre's `IceSL` smooths
//! transitions for that reason. Here the change from a layer to the next is a constraint, and the plan is optimal under it.

use std::collections::VecDeque;

use super::optimal::{self, Objective, layers_above, tops};
use super::segment::{Segment, Segments, boundaries_below};
use super::snap_cost::SnapPlanes;
use super::tradeoff::least_steps;
use super::{Limits, Plan, PlanError};
use crate::grid::Bins;
use crate::profile::{LayerErrors, Reach};

/// Plans the fewest layers within tolerance such that the thicknesses of neighbouring layers differ by at most `change_mm`
/// millimetres, rounded down to whole units. Among the plans with so few layers it returns one with the smallest maximum error.
///
/// The change is bounded everywhere, also across mandatory planes and the ends of height ranges. The first layer may have any
/// thickness of its range, and so may the one on a first layer that is fixed. A change of 0 asks for layers of one thickness, which rarely add up to the height between two planes.
///
/// Cost: time in bins times thicknesses, whatever the change, and 4 bytes for each pair of them.
///
/// # Errors
/// [`PlanError::NotGradual`] names the least change that would do, [`PlanError::Infeasible`] is for a tolerance that no change
/// would meet. Other [`PlanError`]s are for contradictory limits.
pub fn plan(errors: &LayerErrors, limits: &Limits, change_mm: f64) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let segments = Segments::new(bins, limits, &[])?.segments;
    let tolerance = errors.to_steps(limits.tolerance);
    let units = Bins {
        count: bins.count,
        size_mm: bins.boundary_mm(limits.unit(bins)?),
    };
    let widest = Widths::of(&segments).count as u32 - 1;
    if change_mm >= 0.0 {
        let change = units.floor(change_mm).min(f64::from(widest)) as u32;
        if let Some(boundaries) = fewest(errors, &segments, change, tolerance) {
            return Ok(Plan::new(bins, &segments, boundaries, Vec::new()));
        }
    }
    optimal::plan(errors, limits, SnapPlanes::NONE, Objective::Layers)?;
    // There is a plan without the constraint, so the widest change does.
    let least = least_steps(u64::from(widest), |change| {
        Ok(fewest(errors, &segments, change as u32, tolerance).is_some())
    })?;
    Err(PlanError::NotGradual {
        change_mm,
        least_change_mm: units.boundary_mm(least as u32),
    })
}

/// The thicknesses that layers may have in any segment, in units.
struct Widths {
    least: u32,
    count: usize,
}

impl Widths {
    fn of(segments: &[Segment]) -> Self {
        let least = segments.iter().map(|segment| *segment.thickness.start());
        let greatest = segments
            .iter()
            .map(|segment| segment.units.min(*segment.thickness.end()));
        let (least, greatest) = (least.min().unwrap_or(1), greatest.max().unwrap_or(1));
        Self {
            least,
            count: (greatest.max(least) - least) as usize + 1,
        }
    }

    fn place(&self, thickness: u32) -> usize {
        (thickness - self.least) as usize
    }
}

/// Layers and maximum error of the best plan up to a plane whose last layer has a certain thickness.
type Best = [u64; 2];

const NO_PLAN: Best = [u64::MAX, 0];

/// The boundaries of the fewest layers, or `None`.
///
/// A state is a plane and the thickness of the layer below it. A layer of thickness t may follow any state of its lower plane
/// whose thickness differs by at most `change`; the minima of these windows come all together in time linear in thicknesses.
fn fewest(
    errors: &LayerErrors,
    segments: &[Segment],
    change: u32,
    tolerance: u64,
) -> Option<Vec<u32>> {
    let widths = Widths::of(segments);
    let top: u32 = segments.iter().map(|segment| segment.units).sum();
    // No layer is thicker than this, so no more planes than that are needed at a time.
    let rows = widths.least as usize + widths.count;
    let row = |plane: u32| {
        let start = plane as usize % rows * widths.count;
        start..start + widths.count
    };
    let mut best = vec![NO_PLAN; rows * widths.count];
    // For each state, the thickness of the layer before its last one.
    let mut before = vec![0u32; (top as usize + 1) * widths.count];
    let mut minima = Minima::default();
    let mut base = 0;
    for segment in segments {
        for plane in 0..segment.units {
            let lower = base + plane;
            let states = &mut best[row(lower)];
            let is_reached = lower == 0 || states.iter().any(|state| *state != NO_PLAN);
            if !is_reached {
                continue;
            }
            minima.find(states, change as usize);
            states.fill(NO_PLAN);
            let mut layers = layers_above(errors, segment, plane, tolerance);
            for (thickness, upper) in tops(segment, plane) {
                let place = widths.place(thickness);
                let below = minima.places[place];
                let [count, worst] = match minima.least[place] {
                    _ if lower == 0 => [0; 2],
                    NO_PLAN => continue,
                    least => least,
                };
                match layers.up_to(segment.boundary(upper)) {
                    Reach::Within(error) => {
                        let state = row(base + upper).start + place;
                        best[state] = [count + 1, worst.max(error)];
                        let state = (base + upper) as usize * widths.count + place;
                        before[state] = widths.least + below;
                    }
                    Reach::Beyond => {}
                    Reach::BeyondFromHere => break,
                }
            }
        }
        base += segment.units;
    }
    let states = &best[row(top)];
    let (place, found) = states.iter().enumerate().min_by_key(|(_, state)| **state)?;
    if *found == NO_PLAN {
        return None;
    }
    let Segment { lower, unit, .. } = segments[0];
    let (mut plane, mut thickness) = (top, widths.least + place as u32);
    let mut boundaries = boundaries_below(segments);
    let below = boundaries.len();
    while plane > 0 {
        boundaries.push(lower + plane * unit);
        let state = plane as usize * widths.count + widths.place(thickness);
        plane -= thickness;
        thickness = before[state];
    }
    boundaries[below..].reverse();
    Some(boundaries)
}

/// The minima of sliding windows.
#[derive(Default)]
struct Minima {
    /// For each place the least value of its window.
    least: Vec<Best>,
    /// Place of that value; the lowest place if several are equal.
    places: Vec<u32>,
    /// Places of the window whose values ascend: none has a smaller one after it.
    queue: VecDeque<usize>,
}

impl Minima {
    /// Finds the minima of the windows of `reach` places to either side of each.
    fn find(&mut self, values: &[Best], reach: usize) {
        self.queue.clear();
        self.least.clear();
        self.places.clear();
        let mut next = 0;
        for place in 0..values.len() {
            while next < values.len() && next <= place + reach {
                while self
                    .queue
                    .back()
                    .is_some_and(|&last| values[last] > values[next])
                {
                    self.queue.pop_back();
                }
                self.queue.push_back(next);
                next += 1;
            }
            while self
                .queue
                .front()
                .is_some_and(|&first| first + reach < place)
            {
                self.queue.pop_front();
            }
            // A place is in its own window, so the queue is never empty.
            let first = self.queue.front().copied().unwrap_or(place);
            self.least.push(values[first]);
            self.places.push(first as u32);
        }
    }
}
