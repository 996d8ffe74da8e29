//! How long a layer takes: its exposure by thickness (Jacobs' working curve) and what comes with every layer.

use serde::{Deserialize, Serialize};

use crate::grid::{GridError, positive};

/// A resin on a printer. Cure depth is layer thickness and overcure together, so that the exposure grows with
/// exp(thickness / penetration depth).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Resin {
    /// What it is called.
    pub name: String,
    /// The layer thickness that `exposure_s` is for.
    pub layer_mm: f64,
    /// Seconds of exposure of such a layer.
    pub exposure_s: f64,
    /// Penetration depth of the light, Dp: published profiles of resins fit 0.1 to 0.19 mm.
    pub penetration_mm: f64,
    /// Measured pairs of thickness in mm and exposure in s, by thickness; they replace the curve. Between two of them the
    /// exposure is interpolated, beyond them it is that of the nearest.
    pub exposures: Vec<[f64; 2]>,
    /// Layers at the bottom that hold the model on the plate.
    pub bottom_layers: usize,
    /// Seconds of exposure of these.
    pub bottom_exposure_s: f64,
    /// Seconds that every layer rests besides the moves.
    pub wait_s: f64,
    /// By how much the model is lifted after a layer.
    pub lift_mm: f64,
    /// How fast it is lifted, in millimetres a minute.
    pub lift_mm_min: f64,
    /// How fast it returns, in millimetres a minute.
    pub return_mm_min: f64,
    /// Mass of the cured resin.
    pub density_g_ml: f64,
}

impl Default for Resin {
    /// What is common: 3 s for 0.05 mm, four layers of 30 s at the bottom.
    fn default() -> Self {
        Self {
            name: "resin".to_owned(),
            layer_mm: 0.05,
            exposure_s: 3.0,
            penetration_mm: 0.15,
            exposures: Vec::new(),
            bottom_layers: 4,
            bottom_exposure_s: 30.0,
            wait_s: 1.0,
            lift_mm: 5.0,
            lift_mm_min: 65.0,
            return_mm_min: 150.0,
            density_g_ml: 1.1,
        }
    }
}

impl Resin {
    /// Returns the resin if all its numbers are usable.
    ///
    /// # Errors
    /// [`GridError::BadLength`], [`GridError::BadTime`].
    pub fn check(&self) -> Result<(), GridError> {
        for (name, value_mm) in [
            ("the resin's layer", self.layer_mm),
            ("the resin's penetration depth", self.penetration_mm),
            ("the lift's speed", self.lift_mm_min),
            ("the return's speed", self.return_mm_min),
            ("the resin's density", self.density_g_ml),
        ] {
            positive(name, value_mm)?;
        }
        let exposures = self.exposures.iter().map(|pair| ("exposure", pair[1]));
        let times = [
            ("exposure", self.exposure_s),
            ("exposure of the bottom", self.bottom_exposure_s),
            ("rest between layers", self.wait_s),
            ("lift", self.lift_mm),
        ];
        for (name, value_s) in times.into_iter().chain(exposures) {
            if !(value_s.is_finite() && value_s >= 0.0) {
                return Err(GridError::BadTime { name, value_s });
            }
        }
        for pair in self.exposures.windows(2) {
            if pair[0][0] >= pair[1][0] {
                let value_mm = pair[1][0];
                let name = "a thickness above the one before it";
                return Err(GridError::BadLength { name, value_mm });
            }
        }
        Ok(())
    }

    /// Seconds of exposure of a layer of `thickness_mm` above the bottom, to the nearest millisecond.
    pub fn exposure_s(&self, thickness_mm: f64) -> f64 {
        let above = self
            .exposures
            .partition_point(|pair| pair[0] < thickness_mm);
        let exposure_s = match (
            self.exposures.get(above.wrapping_sub(1)),
            self.exposures.get(above),
        ) {
            (None, None) => {
                self.exposure_s * exp((thickness_mm - self.layer_mm) / self.penetration_mm)
            }
            (Some(pair), None) | (None, Some(pair)) => pair[1],
            (Some(low), Some(high)) => {
                let part = (thickness_mm - low[0]) / (high[0] - low[0]);
                low[1] + (high[1] - low[1]) * part
            }
        };
        // More than a day is as good as a day.
        (exposure_s * 1e3).min(1e8).round() / 1e3
    }

    /// Seconds between the exposures of two layers: lift, return and rest.
    pub fn overhead_s(&self) -> f64 {
        let moves_min = self.lift_mm / self.lift_mm_min + self.lift_mm / self.return_mm_min;
        self.wait_s + moves_min * 60.0
    }

    /// Time that a layer of `thickness_mm` above the bottom takes, in whole microseconds, so that sums are exact.
    pub fn layer_us(&self, thickness_mm: f64) -> u64 {
        ((self.exposure_s(thickness_mm) + self.overhead_s()) * 1e6 + 0.5) as u64
    }

    /// Seconds of exposure of every layer of a plan.
    pub fn exposures_s(&self, thickness_mm: &[f64]) -> Vec<f64> {
        thickness_mm
            .iter()
            .enumerate()
            .map(|(layer, &thickness_mm)| {
                if layer < self.bottom_layers {
                    self.bottom_exposure_s
                } else {
                    self.exposure_s(thickness_mm)
                }
            })
            .collect()
    }

    /// Time that layers of these thicknesses take together, in seconds, bottom included.
    pub fn print_time_s(&self, thickness_mm: &[f64]) -> f64 {
        let exposures_s = self.exposures_s(thickness_mm);
        let overhead_us = (self.overhead_s() * 1e6 + 0.5) as u64;
        let layers_us = exposures_s
            .iter()
            .map(|exposure_s| (exposure_s * 1e6 + 0.5) as u64 + overhead_us);
        layers_us.sum::<u64>() as f64 / 1e6
    }
}

/// e to the power of x, by basic arithmetic alone: libraries differ in the last digits, and plans must not.
fn exp(x: f64) -> f64 {
    const HALVINGS: i32 = 10;
    let small = x / f64::from(1 << HALVINGS);
    // The series is exact to the last digits below about 1/20, which is |x| < 50.
    let mut term = 1.0;
    let mut sum = 1.0;
    for n in 1..16 {
        term *= small / f64::from(n);
        sum += term;
    }
    for _ in 0..HALVINGS {
        sum *= sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    #[test]
    fn exp_is_that_of_the_library_to_twelve_digits() {
        for step in -400..=400 {
            let x = f64::from(step) / 40.0;
            let (own, library) = (super::exp(x), x.exp());
            assert!((own / library - 1.0).abs() < 1e-12, "{x}: {own} {library}");
        }
    }
}
