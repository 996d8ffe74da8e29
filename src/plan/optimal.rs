//! The fewest layers within tolerance, by dynamic programming (Procedure 1).

use std::collections::VecDeque;
use std::ops::RangeInclusive;

use super::{Limits, Plan, PlanError};
use crate::grid::Bins;
use crate::profile::ErrorSum;

/// The arrays of Procedure 1, as figure 3 shows them.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// K\[i\]: the least number of layers up to plane i, or `None` where no plan reaches it.
    pub layers: Vec<Option<u32>>,
    /// D\[i\]: the plane below i in the best plan up to i.
    pub below: Vec<Option<u32>>,
}

/// Plans the fewest layers whose errors are all within the tolerance.
///
/// Where several plans have that number, the lower plane of each layer is the lowest possible, as
/// in Procedure 1. Cost: linear in bins, whatever the range of thicknesses.
///
/// # Errors
/// [`PlanError`]; [`PlanError::Infeasible`] names the height that cannot be passed.
pub fn plan(errors: &ErrorSum, limits: &Limits) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    let thickness = limits.thickness_in_bins(bins)?;
    let table = fill_table(
        errors,
        thickness.clone(),
        errors.to_steps(limits.tolerance_mm),
    );
    if table.layers[bins.count].is_none() {
        return Err(why_not(&table, bins, thickness, limits));
    }
    Ok(Plan {
        bins,
        boundaries: backtrack(&table),
    })
}

/// Tells a tolerance that cannot be held from thicknesses that do not add up to the height.
fn why_not(
    table: &Table,
    bins: Bins,
    thickness: RangeInclusive<u32>,
    limits: &Limits,
) -> PlanError {
    let (layer_min_mm, layer_max_mm) = (limits.layer_min_mm, limits.layer_max_mm);
    let top = bins.count as u32;
    let fewest = top.div_ceil(*thickness.end());
    if fewest * *thickness.start() > top {
        let height_mm = bins.boundary_mm((fewest - 1) * *thickness.end());
        let rest_mm = bins.boundary_mm(top) - height_mm;
        return PlanError::Remainder {
            height_mm,
            rest_mm,
            layer_min_mm,
            layer_max_mm,
        };
    }
    let reached = table.layers.iter().rposition(Option::is_some).unwrap_or(0) as u32;
    PlanError::Infeasible {
        height_mm: bins.boundary_mm(reached),
        tolerance_mm: limits.tolerance_mm,
        layer_min_mm,
    }
}

/// Lines 1 to 7 of Procedure 1: for every plane, the least number of layers and the plane below.
///
/// The inner loop is replaced by a queue of planes that may still be the best one below: since no
/// density is negative, the lowest plane within tolerance only moves up. The queue holds planes upward
/// with numbers of layers that grow from its front, where the best plane is.
pub fn fill_table(
    errors: &ErrorSum,
    thickness: RangeInclusive<u32>,
    tolerance_steps: u64,
) -> Table {
    let count = errors.bins().count;
    let mut table = Table {
        layers: vec![None; count + 1],
        below: vec![None; count + 1],
    };
    table.layers[0] = Some(0);
    let mut queue: VecDeque<(u32, u32)> = VecDeque::new();
    for plane in 1..=count as u32 {
        let Some(highest) = plane.checked_sub(*thickness.start()) else {
            continue;
        };
        if let Some(layers) = table.layers[highest as usize] {
            // A later plane wins over an earlier one only with fewer layers.
            while queue.back().is_some_and(|&(_, behind)| behind > layers) {
                queue.pop_back();
            }
            queue.push_back((highest, layers));
        }
        let lowest = plane.saturating_sub(*thickness.end());
        while queue.front().is_some_and(|&(below, _)| {
            below < lowest || errors.steps_between(below, plane) > tolerance_steps
        }) {
            queue.pop_front();
        }
        if let Some(&(below, layers)) = queue.front() {
            table.layers[plane as usize] = Some(layers + 1);
            table.below[plane as usize] = Some(below);
        }
    }
    table
}

/// Lines 8 to 11 of Procedure 1: the planes of the best plan up to the last one, upward.
fn backtrack(table: &Table) -> Vec<u32> {
    let top = table.below.len() as u32 - 1;
    let mut planes: Vec<u32> =
        std::iter::successors(Some(top), |&plane| table.below[plane as usize]).collect();
    planes.reverse();
    planes
}
