//! The least sum of layer errors for every number of layers.
//!
//! Alexa, Hildebrand and Lefebvre, *Optimal Discrete Slicing*, ACM Transactions on Graphics 36(1), 2017, minimise the volume
//! between print and model for all numbers of slices at once, by dynamic programming over slices and heights. So does this, for
//! any error of layers. It is meant for the volume deviation. Under an additive metric every plan has the same sum, and what
//! breaks ties decides: the result is then the smallest maximum error for every number of layers.

use super::optimal::{self, Objective, layers_above, tops};
use super::segment::{Segment, Segments, boundaries_below};
use super::snap_cost::SnapPlanes;
use super::{Limits, Plan, PlanError};
use crate::profile::{LayerErrors, Reach};

/// The plan with the least sum of errors among those with as many layers.
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSum {
    /// The plan.
    pub plan: Plan,
    /// The sum of its layers' errors, in steps of the errors.
    pub sum_steps: u64,
    /// The same in the metric's unit.
    pub sum: f64,
}

/// Plans the least sum of errors for every number of layers up to `most_layers`, from the fewest up. Numbers of which there is no
/// plan are left out. No layer exceeds the tolerance. Of plans with the same sum it returns one with the smallest maximum error.
///
/// A sum may grow with the number of layers: all numbers are returned, not only those that lower the sum.
///
/// Cost: time in layers times planes times thicknesses. Memory: 8 bytes for each pair of plane and thickness, and 2 for
/// each pair of a number of layers and a plane that it reaches. For 30,000 bins, layers of 25 to 75 bins and all
/// numbers of layers these are 12 and 24 MB. Thicknesses more than 65,535 units above the least are not considered.
///
/// # Errors
/// [`PlanError::LayersOutOfReach`] if every plan within tolerance has more layers, [`PlanError::Infeasible`] if there is none.
/// Other [`PlanError`]s are for contradictory limits.
pub fn plans(
    errors: &LayerErrors,
    limits: &Limits,
    most_layers: usize,
) -> Result<Vec<LeastSum>, PlanError> {
    let bins = errors.bins();
    limits.check(bins)?;
    let segments = Segments::new(bins, limits, &[])?.segments;
    let tolerance = errors.to_steps(limits.tolerance);
    let table = Errors::measure(errors, &segments, tolerance);
    let below = boundaries_below(&segments);
    let found = table.plans(most_layers.saturating_sub(below.len() - 1));
    if found.is_empty() {
        let fewest = optimal::plan(errors, limits, SnapPlanes::NONE, Objective::Layers)?;
        return Err(PlanError::LayersOutOfReach {
            layers: most_layers,
            least_layers: fewest.layers(),
        });
    }
    let Segment { lower, unit, .. } = segments[0];
    let plan = |planes: Vec<u32>| {
        let above = planes.into_iter().skip(1);
        let mut boundaries = below.clone();
        boundaries.extend(above.map(|plane| lower + plane * unit));
        Plan::new(bins, &segments, boundaries, Vec::new())
    };
    let found = found.into_iter();
    Ok(found
        .map(|(sum_steps, planes)| LeastSum {
            plan: plan(planes),
            sum_steps,
            sum: errors.to_value(sum_steps),
        })
        .collect())
}

/// The errors of all layers, and the planes that they lead to.
struct Errors {
    /// The least thickness in units.
    least: usize,
    /// Number of thicknesses.
    count: usize,
    /// The top, in units.
    top: usize,
    /// For each plane the errors of the layers above it, from the thinnest to the thickest; [`NO_LAYER`] where there is none.
    steps: Vec<u64>,
    /// For each plane the fewest layers from it to the top.
    fewest_above: Vec<usize>,
}

/// In place of the error of a layer that is not possible. No sum is as large.
const NO_LAYER: u64 = u64::MAX;

/// The least sum up to a plane, and the smallest maximum error of plans with that sum.
type Best = [u64; 2];

const NO_PLAN: Best = [NO_LAYER, 0];

/// The last layers of the best plans with a certain number of layers.
struct Row {
    /// The lowest plane that they may reach.
    lowest: usize,
    /// For each plane from there, how much thicker than the least the last layer is.
    thicker: Vec<u16>,
}

impl Errors {
    fn measure(errors: &LayerErrors, segments: &[Segment], tolerance: u64) -> Self {
        let least = segments.iter().map(|segment| *segment.thickness.start());
        let greatest = segments
            .iter()
            .map(|segment| segment.units.min(*segment.thickness.end()));
        let least = least.min().unwrap_or(1) as usize;
        let greatest = greatest.max().unwrap_or(1) as usize;
        let count = (greatest.max(least) - least + 1).min(1 << 16);
        let top: u32 = segments.iter().map(|segment| segment.units).sum();
        let top = top as usize;
        let mut steps = vec![NO_LAYER; top * count];
        let mut base = 0;
        for segment in segments {
            for plane in 0..segment.units {
                let start = (base + plane) as usize * count;
                let row = &mut steps[start..start + count];
                let mut layers = layers_above(errors, segment, plane, tolerance);
                for (thickness, upper) in tops(segment, plane) {
                    let Some(slot) = row.get_mut(thickness as usize - least) else {
                        break;
                    };
                    match layers.up_to(segment.boundary(upper)) {
                        Reach::Within(error) => *slot = error,
                        Reach::Beyond => {}
                        Reach::BeyondFromHere => break,
                    }
                }
            }
            base += segment.units;
        }
        let mut fewest_above = vec![usize::MAX; top + 1];
        fewest_above[top] = 0;
        for plane in (0..top).rev() {
            let row = &steps[plane * count..(plane + 1) * count];
            let layers = row.iter().zip(plane + least..);
            let above = layers.filter(|(error, _)| **error != NO_LAYER);
            let fewest = above.map(|(_, upper)| fewest_above[upper]).min();
            fewest_above[plane] = fewest.map_or(usize::MAX, |layers| layers.saturating_add(1));
        }
        Self {
            least,
            count,
            top,
            steps,
            fewest_above,
        }
    }

    /// For each number of layers up to `most` of which there is a plan, the least sum and the planes.
    fn plans(&self, most: usize) -> Vec<(u64, Vec<u32>)> {
        let mut below = vec![NO_PLAN; self.top + 1];
        let mut best = below.clone();
        below[0] = [0; 2];
        let (mut lowest, mut highest) = (0, 0);
        let mut rows: Vec<Row> = Vec::new();
        let mut found = Vec::new();
        for layers in 1..=most {
            let is_useful = |plane: &usize| {
                below[*plane] != NO_PLAN
                    && self.fewest_above[*plane].saturating_add(layers - 1) <= most
            };
            let useful = (lowest..=highest.min(self.top.saturating_sub(1))).filter(is_useful);
            let useful: Vec<usize> = useful.collect();
            let (Some(&first), Some(&last)) = (useful.first(), useful.last()) else {
                break;
            };
            lowest = first + self.least;
            highest = (last + self.least + self.count - 1).min(self.top);
            if lowest > highest {
                break;
            }
            best[lowest..=highest].fill(NO_PLAN);
            let mut thicker = vec![0; highest - lowest + 1];
            for plane in useful {
                self.add_layers(plane, below[plane], &mut best, &mut thicker, lowest);
            }
            rows.push(Row { lowest, thicker });
            if highest == self.top && best[self.top] != NO_PLAN {
                found.push((best[self.top][0], self.planes(&rows)));
            }
            std::mem::swap(&mut below, &mut best);
        }
        found
    }

    /// Puts every layer that begins at a plane on the best plan up to it. `lowest` is the plane of the first of `thicker`.
    fn add_layers(
        &self,
        plane: usize,
        [sum, worst]: Best,
        best: &mut [Best],
        thicker: &mut [u16],
        lowest: usize,
    ) {
        let steps = &self.steps[plane * self.count..][..self.count];
        let above = plane + self.least;
        let Some(tops) = best.get_mut(above..) else {
            return;
        };
        // Near the top not all layers fit, and `thicker` ends there.
        let tops = tops.iter_mut().zip(&mut thicker[above - lowest..]);
        for ((top, thicker), (&error, number)) in tops.zip(steps.iter().zip(0..)) {
            let sum = sum.saturating_add(error);
            if sum < top[0] {
                *top = [sum, worst.max(error)];
                *thicker = number;
            } else if sum == top[0] && sum != NO_LAYER && worst.max(error) < top[1] {
                top[1] = worst.max(error);
                *thicker = number;
            }
        }
    }

    /// The planes of the best plan up to the top with as many layers as there are rows.
    fn planes(&self, rows: &[Row]) -> Vec<u32> {
        let mut plane = self.top;
        let mut planes = vec![plane as u32];
        for row in rows.iter().rev() {
            plane -= self.least + usize::from(row.thicker[plane - row.lowest]);
            planes.push(plane as u32);
        }
        planes.reverse();
        planes
    }
}
