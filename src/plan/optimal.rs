//! The fewest layers within tolerance, by dynamic programming (Procedure 1).

use super::{Limits, Plan, PlanError};
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
/// in Procedure 1. Errors of layers come from a running sum, so the cost is bins × thicknesses.
///
/// # Errors
/// [`PlanError`]; [`PlanError::Infeasible`] names the height that cannot be passed.
pub fn plan(errors: &ErrorSum, limits: &Limits) -> Result<Plan, PlanError> {
    let bins = errors.bins();
    let thickness = limits.thickness_in_bins(bins)?;
    let (least, top) = (*thickness.start(), bins.count as u32);
    let table = fill_table(errors, thickness, errors.to_steps(limits.tolerance_mm));
    if table.layers[bins.count].is_none() {
        let reached = table.layers.iter().rposition(Option::is_some).unwrap_or(0) as u32;
        let height_mm = bins.boundary_mm(reached);
        return Err(if top - reached < least {
            PlanError::Remainder {
                height_mm,
                rest_mm: bins.boundary_mm(top - reached),
                layer_min_mm: limits.layer_min_mm,
                layer_max_mm: limits.layer_max_mm,
            }
        } else {
            PlanError::Infeasible {
                height_mm,
                tolerance_mm: limits.tolerance_mm,
                layer_min_mm: limits.layer_min_mm,
            }
        });
    }
    Ok(Plan {
        bins,
        boundaries: backtrack(&table),
    })
}

/// Lines 1 to 7 of Procedure 1: for every plane, the least number of layers and the plane below.
pub fn fill_table(
    errors: &ErrorSum,
    thickness: std::ops::RangeInclusive<u32>,
    tolerance_steps: u64,
) -> Table {
    let count = errors.bins().count;
    let mut table = Table {
        layers: vec![None; count + 1],
        below: vec![None; count + 1],
    };
    table.layers[0] = Some(0);
    for plane in 1..=count as u32 {
        let Some(highest) = plane.checked_sub(*thickness.start()) else {
            continue;
        };
        let lowest = plane.saturating_sub(*thickness.end());
        for below in lowest..=highest {
            let Some(layers) = table.layers[below as usize] else {
                continue;
            };
            let is_better = table.layers[plane as usize].is_none_or(|best| best > layers + 1);
            if is_better && errors.steps_between(below, plane) <= tolerance_steps {
                table.layers[plane as usize] = Some(layers + 1);
                table.below[plane as usize] = Some(below);
            }
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
