//! Print time of a layer: an exposure that depends on its thickness (Jacobs' working curve), and a fixed time for the
//! moves between layers.

use serde::{Deserialize, Serialize};

use crate::compensation::Compensation;
use crate::quantity::{Quantity, QuantityError};

/// A resin on a printer.
///
/// The cure depth is the layer thickness plus a fixed overcure, so the exposure is proportional to
/// exp(thickness / penetration depth).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Resin {
    /// Name of the resin.
    pub name: String,
    /// The layer thickness, in millimetres, to which `exposure_s` applies.
    pub layer_mm: f64,
    /// Exposure of a layer of that thickness, in seconds.
    pub exposure_s: f64,
    /// Penetration depth of the light, Dp, in millimetres. Published resin profiles fit 0.1 to 0.19 mm.
    pub penetration_mm: f64,
    /// Measured pairs of thickness in mm and exposure in s, sorted by thickness. If there are any, they replace the
    /// curve: exposures are interpolated linearly between them, and follow the curve through the nearest two beyond
    /// them. A single pair holds for all thicknesses.
    pub exposures: Vec<[f64; 2]>,
    /// Number of bottom layers, which hold the model on the plate.
    pub bottom_layers: usize,
    /// Exposure of a bottom layer, in seconds.
    pub bottom_exposure_s: f64,
    /// Rest per layer in seconds, in addition to the moves.
    pub wait_s: f64,
    /// Height by which the model is lifted after a layer, in millimetres.
    pub lift_mm: f64,
    /// Speed of the lift, in millimetres per minute.
    pub lift_mm_min: f64,
    /// Speed of the return, in millimetres per minute.
    pub return_mm_min: f64,
    /// Density of the cured resin, in grams per millilitre.
    pub density_g_ml: f64,
    /// Compensation for prints larger than their masks.
    #[serde(alias = "growth")]
    pub compensation: Compensation,
    /// Cure below a layer, which masks and planes make up for in place of `compensation.z_mm`. Absent: nothing does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub print_through: Option<PrintThrough>,
}

/// Cure of a resin below a layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct PrintThrough {
    /// Overcure: depth below a layer of the resin's `layer_mm` to which its own exposure cures, in millimetres.
    pub overcure_mm: f64,
    /// Part of the dose of earlier exposures that counts, from 0 to 1: resin moves between exposures.
    #[serde(default = "all")]
    pub retained: f64,
}

fn all() -> f64 {
    1.0
}

impl PrintThrough {
    /// Checks that every number is within its bounds.
    ///
    /// # Errors
    /// [`QuantityError::BadLength`].
    pub fn check(&self) -> Result<(), QuantityError> {
        Quantity::Overcure.check(self.overcure_mm)?;
        Quantity::RetainedDose.check(self.retained)?;
        Ok(())
    }
}

impl Default for Resin {
    /// Common values: 3 s for a layer of 0.05 mm, and four bottom layers of 30 s.
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
            compensation: Compensation::default(),
            print_through: None,
        }
    }
}

impl Resin {
    /// Checks that every number is within its bounds.
    ///
    /// # Errors
    /// [`QuantityError`].
    pub fn check(&self) -> Result<(), QuantityError> {
        let exposures = self.exposures.iter();
        let exposures = exposures.map(|pair| (Quantity::Exposure, pair[1]));
        let quantities = [
            (Quantity::ResinLayer, self.layer_mm),
            (Quantity::Penetration, self.penetration_mm),
            (Quantity::LiftSpeed, self.lift_mm_min),
            (Quantity::ReturnSpeed, self.return_mm_min),
            (Quantity::Density, self.density_g_ml),
            (Quantity::Exposure, self.exposure_s),
            (Quantity::BottomExposure, self.bottom_exposure_s),
            (Quantity::Wait, self.wait_s),
            (Quantity::Lift, self.lift_mm),
        ];
        for (quantity, value) in quantities.into_iter().chain(exposures) {
            quantity.check(value)?;
        }
        self.compensation.check()?;
        if let Some(print_through) = &self.print_through {
            print_through.check()?;
        }
        for pair in self.exposures.windows(2) {
            let (previous_mm, next_mm) = (pair[0][0], pair[1][0]);
            if previous_mm >= next_mm {
                return Err(QuantityError::BadExposures {
                    previous_mm,
                    next_mm,
                });
            }
        }
        Ok(())
    }

    /// Exposure of a layer of `thickness_mm` above the bottom layers, in seconds, rounded to the millisecond.
    pub fn exposure_s(&self, thickness_mm: f64) -> f64 {
        let exposure_s = match self.exposures[..] {
            [] => self.exposure_s * exp((thickness_mm - self.layer_mm) / self.penetration_mm),
            [[_, exposure_s]] => exposure_s,
            ref pairs => {
                let above = pairs.partition_point(|pair| pair[0] < thickness_mm);
                let above = above.clamp(1, pairs.len() - 1);
                through(pairs[above - 1], pairs[above], thickness_mm)
            }
        };
        // Capped at 100,000 s, more than a day.
        (exposure_s * 1e3).min(1e8).round() / 1e3
    }

    /// The thinnest and the thickest layer, in millimetres, whose exposure is measured; `None` if no thickness of layers is beyond what
    /// is measured, as there are fewer than two pairs.
    pub fn measured_mm(&self) -> Option<[f64; 2]> {
        match self.exposures[..] {
            [[thinnest_mm, _], .., [thickest_mm, _]] => Some([thinnest_mm, thickest_mm]),
            _ => None,
        }
    }

    /// Time between the exposures of two layers, in seconds: lift, return and rest.
    pub fn overhead_s(&self) -> f64 {
        let moves_min = self.lift_mm / self.lift_mm_min + self.lift_mm / self.return_mm_min;
        self.wait_s + moves_min * 60.0
    }

    /// Time of a layer of `thickness_mm` above the bottom layers, in whole microseconds, so that sums are exact.
    pub fn layer_us(&self, thickness_mm: f64) -> u64 {
        ((self.exposure_s(thickness_mm) + self.overhead_s()) * 1e6 + 0.5) as u64
    }

    /// Time of a bottom layer, whatever its thickness, in whole microseconds.
    pub fn bottom_layer_us(&self) -> u64 {
        ((self.bottom_exposure_s + self.overhead_s()) * 1e6 + 0.5) as u64
    }

    /// Exposure of each layer in seconds, given the thicknesses from the plate upward.
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

    /// Total time of layers of these thicknesses, in seconds, bottom layers included.
    pub fn print_time_s(&self, thickness_mm: &[f64]) -> f64 {
        self.time_s(&self.exposures_s(thickness_mm))
    }

    /// The same of uniform layers on a first one of `first_mm`, if that is given.
    pub fn uniform_time_s(&self, layers: usize, layer_mm: f64, first_mm: Option<f64>) -> f64 {
        let bottoms = layers.min(self.bottom_layers);
        let first_mm = first_mm.filter(|_| bottoms == 0 && layers > 0);
        let others = layers - bottoms - usize::from(first_mm.is_some());
        let [bottom_us, other_us, first_us] = [
            self.bottom_exposure_s,
            self.exposure_s(layer_mm),
            self.exposure_s(first_mm.unwrap_or(layer_mm)),
        ]
        .map(|exposure_s| self.exposed_us(exposure_s));
        let first_us = first_mm.map_or(0, |_| first_us);
        (bottoms as u64 * bottom_us + others as u64 * other_us + first_us) as f64 / 1e6
    }

    /// Total time of layers of these exposures, in seconds.
    pub fn time_s(&self, exposures_s: &[f64]) -> f64 {
        let layers_us = exposures_s.iter().map(|&it| self.exposed_us(it));
        layers_us.sum::<u64>() as f64 / 1e6
    }

    /// Time of a layer of this exposure, in whole microseconds.
    fn exposed_us(&self, exposure_s: f64) -> u64 {
        (exposure_s * 1e6 + 0.5) as u64 + (self.overhead_s() * 1e6 + 0.5) as u64
    }
}

/// Exposure of a layer of `thickness_mm` by two measured pairs: linear between them, and beyond them on Jacobs' working curve through both.
/// Exposures that do not rise fit no such curve, and the nearer one holds beyond them.
fn through(low: [f64; 2], high: [f64; 2], thickness_mm: f64) -> f64 {
    let part = (thickness_mm - low[0]) / (high[0] - low[0]);
    if (0.0..=1.0).contains(&part) {
        return low[1] + (high[1] - low[1]) * part;
    }
    let (nearest_s, beyond) = if part < 0.0 {
        (low[1], part)
    } else {
        (high[1], part - 1.0)
    };
    if low[1] > 0.0 && low[1] < high[1] {
        nearest_s * exp(beyond * ln(high[1] / low[1]))
    } else {
        nearest_s
    }
}

/// The natural logarithm of a positive number, by basic arithmetic and square roots alone.
#[cfg_attr(target_arch = "wasm32", inline(never))]
pub(crate) fn ln(x: f64) -> f64 {
    const HALVINGS: i32 = 5;
    let root = (0..HALVINGS).fold(x, |root, _| root.sqrt());
    // The series of the inverse hyperbolic tangent, accurate to the last digits up to 1e9, a day to 0.1 ms.
    let ratio = (root - 1.0) / (root + 1.0);
    let mut power = ratio;
    let mut sum = 0.0;
    for n in 0..16 {
        sum += power / f64::from(2 * n + 1);
        power *= ratio * ratio;
    }
    2.0 * sum * f64::from(1 << HALVINGS)
}

/// e to the power of x, by basic arithmetic alone: libraries differ in the last digits, which would make plans differ.
#[cfg_attr(target_arch = "wasm32", inline(never))]
pub(crate) fn exp(x: f64) -> f64 {
    const HALVINGS: i32 = 10;
    // The series is accurate to the last digits for |small| below about 1/20. Beyond, e to the power of x times any exposure is
    // nothing, or more than its cap.
    let small = x.clamp(-50.0, 50.0) / f64::from(1 << HALVINGS);
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
    use super::Resin;

    #[test]
    fn exp_is_that_of_the_library_to_twelve_digits() {
        for step in -400..=400 {
            let x = f64::from(step) / 40.0;
            let (own, library) = (super::exp(x), x.exp());
            assert!((own / library - 1.0).abs() < 1e-12, "{x}: {own} {library}");
        }
    }

    #[test]
    fn ln_is_that_of_the_library_to_twelve_digits() {
        for step in 1..=400 {
            let x = (f64::from(step) / 20.0).exp();
            let (own, library) = (super::ln(x), x.ln());
            assert!((own / library - 1.0).abs() < 1e-12, "{x}: {own} {library}");
        }
        assert_eq!(super::ln(1.0), 0.0);
    }

    #[test]
    fn beyond_measured_pairs_exposures_follow_the_curve_through_the_nearest_two() {
        let measured = |exposures: &[[f64; 2]]| Resin {
            exposures: exposures.to_vec(),
            ..Resin::default()
        };
        let two = measured(&[[0.05, 2.4], [0.1, 3.5]]);
        assert_eq!(two.measured_mm(), Some([0.05, 0.1]));
        // Dp is 0.05 / ln(3.5 / 2.4) = 0.1325 mm.
        for (thickness_mm, exposure_s) in [
            (0.15, 5.104),
            (0.2, 7.444),
            (0.1, 3.5),
            (0.075, 2.95),
            (0.05, 2.4),
            (0.025, 1.987),
        ] {
            assert_eq!(two.exposure_s(thickness_mm), exposure_s, "{thickness_mm}");
        }
        // Of several pairs the last two count above, and the first two below.
        let three = measured(&[[0.05, 2.4], [0.1, 3.5], [0.15, 7.0]]);
        assert_eq!(three.exposure_s(0.2), 14.0);
        assert_eq!(three.exposure_s(0.025), 1.987);
        // Jacobs' curve itself is found again.
        let planted = Resin::default();
        let pairs = [0.05, 0.12].map(|h| [h, 3.0 * ((h - 0.05) / 0.15_f64).exp()]);
        for thickness_mm in [0.01, 0.03, 0.15, 0.3] {
            let (found, expected) = (measured(&pairs), planted.exposure_s(thickness_mm));
            assert_eq!(found.exposure_s(thickness_mm), expected, "{thickness_mm}");
        }
        // One pair holds everywhere; exposures that fall, or are 0, fit no curve.
        let one = measured(&[[0.1, 3.5]]);
        assert_eq!([0.05, 0.1, 0.2].map(|h| one.exposure_s(h)), [3.5; 3]);
        assert_eq!(one.measured_mm(), None);
        let falling = measured(&[[0.05, 3.0], [0.1, 2.0]]);
        assert_eq!([0.02, 0.2].map(|h| falling.exposure_s(h)), [3.0, 2.0]);
        let dark = measured(&[[0.05, 0.0], [0.1, 2.0]]);
        assert_eq!([0.02, 0.2].map(|h| dark.exposure_s(h)), [0.0, 2.0]);
    }

    #[test]
    fn far_from_zero_an_exposure_is_nothing_or_as_long_as_can_be() {
        let resin = Resin {
            penetration_mm: 1e-4,
            layer_mm: 0.2,
            ..Resin::default()
        };
        assert_eq!(resin.check(), Ok(()));
        let exposures = resin.exposures_s(&[0.05, 0.05, 0.05, 0.05, 0.05, 0.19, 0.2, 0.21, 1e3]);
        assert_eq!(exposures[4..], [0.0, 0.0, 3.0, 1e5, 1e5]);
    }
}
