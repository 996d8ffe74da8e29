//! The limits of a plan: layer thicknesses, tolerance, mandatory planes and motor step.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::PlanError;
use crate::argsort::argsort;
use crate::grid::Bins;
use crate::quantity::Quantity;
use crate::union_find;

/// The limits that every plan must respect.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Minimum layer thickness in millimetres, `t_min`.
    pub layer_min_mm: f64,
    /// Maximum layer thickness in millimetres, `t_max`.
    pub layer_max_mm: f64,
    /// Maximum error of a layer in the metric's unit, ε.
    pub tolerance: f64,
    /// Height ranges with layer thicknesses of their own. They must not overlap; their ends are planes.
    pub ranges: Vec<HeightRange>,
    /// Heights at which there must be a plane, in millimetres above the plate.
    pub planes_mm: Vec<f64>,
    /// Thickness of the first layer in millimetres, whatever its error and the range of thicknesses; chosen like all others if
    /// absent.
    pub first_layer_mm: Option<f64>,
    /// The printer's motor step in millimetres: every height is a multiple of it. One bin if absent.
    pub step_mm: Option<f64>,
}

/// A height range with layer thicknesses of its own, all in millimetres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct HeightRange {
    /// Its lower end, above the plate.
    pub from_mm: f64,
    /// Its upper end, above the plate.
    pub to_mm: f64,
    /// Minimum layer thickness within it.
    pub layer_min_mm: f64,
    /// Maximum layer thickness within it.
    pub layer_max_mm: f64,
}

impl HeightRange {
    /// Ranges that may overlap as ranges that do not, in ascending order: where several meet, layers must be within the limits of
    /// all. If they cannot be, that range is empty, and there is no plan.
    pub fn joined(ranges: &[Self]) -> Vec<Self> {
        let mut ends: Vec<f64> = ranges
            .iter()
            .flat_map(|range| [range.from_mm, range.to_mm])
            .collect();
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup();
        let covering = |order: Vec<usize>| first_to_cover(&ends, ranges, order);
        // Those that demand most come first.
        let thickest_first = argsort(ranges.iter().map(|range| -range.layer_min_mm));
        let thinnest_first = argsort(ranges.iter().map(|range| range.layer_max_mm));
        let limits = covering(thickest_first)
            .into_iter()
            .zip(covering(thinnest_first));
        let between = ends.windows(2).zip(limits);
        let joined = between.filter_map(|(ends, (least, greatest))| {
            Some(Self {
                from_mm: ends[0],
                to_mm: ends[1],
                layer_min_mm: ranges[least?].layer_min_mm,
                layer_max_mm: ranges[greatest?].layer_max_mm,
            })
        });
        joined.collect()
    }
}

/// For each interval between ends, the first range of `order` that covers it.
fn first_to_cover(ends: &[f64], ranges: &[HeightRange], order: Vec<usize>) -> Vec<Option<usize>> {
    let mut covering = vec![None; ends.len().saturating_sub(1)];
    // The next interval that nothing covers yet, from each interval on.
    let mut uncovered: Vec<u32> = (0..ends.len() as u32).collect();
    let interval_at = |mm: f64| ends.partition_point(|&end| end < mm);
    for place in order {
        let range = &ranges[place];
        let to = interval_at(range.to_mm);
        let mut interval = interval_at(range.from_mm);
        loop {
            interval = union_find::find(&mut uncovered, interval as u32) as usize;
            if interval >= to {
                break;
            }
            covering[interval] = Some(place);
            uncovered[interval] += 1;
        }
    }
    covering
}

impl Limits {
    /// The unit of thickness in bins: the motor step, or 1.
    ///
    /// # Errors
    /// [`PlanError::Quantity`], [`PlanError::NotWholeBins`].
    pub fn unit(&self, bins: Bins) -> Result<u32, PlanError> {
        Quantity::Bin.check(bins.size_mm)?;
        match self.step_mm {
            None => Ok(1),
            Some(step_mm) => Ok(whole_bins(bins, Quantity::Step, step_mm)?.min(MAX_UNIT) as u32),
        }
    }

    /// A range of layer thicknesses in units: ⌈`t_min`/unit⌉ to ⌊`t_max`/unit⌋.
    ///
    /// # Errors
    /// [`PlanError::Quantity`], [`PlanError::NotWholeBins`], [`PlanError::UpsideDownRange`], [`PlanError::EmptyRange`].
    pub fn thickness(
        &self,
        bins: Bins,
        layer_min_mm: f64,
        layer_max_mm: f64,
    ) -> Result<RangeInclusive<u32>, PlanError> {
        Quantity::LayerMin.check(layer_min_mm)?;
        Quantity::LayerMax.check(layer_max_mm)?;
        if layer_min_mm > layer_max_mm {
            return Err(PlanError::UpsideDownRange {
                layer_min_mm,
                layer_max_mm,
            });
        }
        let unit = f64::from(self.unit(bins)?);
        let units = Bins {
            count: bins.count,
            size_mm: unit * bins.size_mm,
        };
        let least = units.ceil(layer_min_mm).max(1.0);
        let greatest = units.floor(layer_max_mm);
        if least > greatest {
            return Err(PlanError::EmptyRange {
                layer_min_mm,
                layer_max_mm,
                step_mm: units.boundary_mm(1),
            });
        }
        // The middle of a layer more than twice as thick as the model is high lies above the model, so no plan has one. In bins,
        // no thickness is then above 32 bits.
        let limit = (2.0 * bins.count as f64 / unit).floor() + 1.0;
        Ok(least.min(limit) as u32..=greatest.min(limit) as u32)
    }

    /// Thickness of the first layer in bins, if it is fixed; 0 otherwise.
    ///
    /// # Errors
    /// [`PlanError::Quantity`], [`PlanError::NotWholeBins`], [`PlanError::NotWholeSteps`].
    pub fn first_layer(&self, bins: Bins) -> Result<u32, PlanError> {
        let Some(first_layer_mm) = self.first_layer_mm else {
            return Ok(0);
        };
        let unit = self.unit(bins)?;
        let whole = self.whole_units(bins, Quantity::FirstLayer, first_layer_mm)?;
        // Above any model, and small enough to count in bins.
        let limit = f64::from(bins.count as u32 / unit + 1);
        Ok(whole.min(limit) as u32 * unit)
    }

    /// A thickness as a whole number of units, which it must be.
    pub(super) fn whole_units(
        &self,
        bins: Bins,
        quantity: Quantity,
        length_mm: f64,
    ) -> Result<f64, PlanError> {
        let units = Bins {
            count: bins.count,
            size_mm: bins.boundary_mm(self.unit(bins)?),
        };
        whole_bins(units, quantity, length_mm).map_err(|error| match error {
            PlanError::NotWholeBins {
                quantity,
                length_mm,
                bin_mm,
            } if self.step_mm.is_some() => PlanError::NotWholeSteps {
                quantity,
                length_mm,
                step_mm: bin_mm,
            },
            error => error,
        })
    }

    /// Checks everything that does not depend on the model.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn check(&self, bins: Bins) -> Result<(), PlanError> {
        Quantity::Tolerance.check(self.tolerance)?;
        self.first_layer(bins)?;
        self.thickness(bins, self.layer_min_mm, self.layer_max_mm)?;
        for range in &self.ranges {
            self.thickness(bins, range.layer_min_mm, range.layer_max_mm)?;
        }
        Ok(())
    }
}

/// An upper bound on the bins of a motor step.
const MAX_UNIT: f64 = (1 << 20) as f64;

/// A length as a whole number of bins, which it must be.
pub(super) fn whole_bins(bins: Bins, quantity: Quantity, length_mm: f64) -> Result<f64, PlanError> {
    Quantity::Bin.check(bins.size_mm)?;
    quantity.check(length_mm)?;
    let whole = bins.floor(length_mm);
    if whole < 1.0 || bins.ceil(length_mm) > whole {
        return Err(PlanError::NotWholeBins {
            quantity,
            length_mm,
            bin_mm: bins.size_mm,
        });
    }
    Ok(whole)
}
