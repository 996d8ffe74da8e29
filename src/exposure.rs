//! How long a layer takes: its exposure by thickness (Jacobs' working curve) and what comes with every layer.

use serde::{Deserialize, Serialize};

use crate::grid::{GridError, positive};

/// A resin on a printer. Cure depth is layer thickness and overcure together, so that the exposure grows with
/// exp(thickness / penetration depth).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Resin {
    /// The layer thickness that `exposure_s` is for.
    pub layer_mm: f64,
    /// Seconds of exposure of such a layer.
    pub exposure_s: f64,
    /// Penetration depth of the light, Dp: published profiles of resins fit 0.1 to 0.19 mm.
    pub penetration_mm: f64,
    /// Seconds that every layer takes besides: lift, return and rest.
    pub overhead_s: f64,
}

impl Default for Resin {
    /// What is common: 3 s for 0.05 mm, and 8 s to lift and return.
    fn default() -> Self {
        Self {
            layer_mm: 0.05,
            exposure_s: 3.0,
            penetration_mm: 0.15,
            overhead_s: 8.0,
        }
    }
}

impl Resin {
    /// Returns the resin if all its numbers are usable.
    ///
    /// # Errors
    /// [`GridError::BadLength`].
    pub fn check(&self) -> Result<(), GridError> {
        positive("the resin's layer", self.layer_mm)?;
        positive("the resin's penetration depth", self.penetration_mm)?;
        let (exposure_s, overhead_s) = (self.exposure_s, self.overhead_s);
        for (name, value_s) in [
            ("exposure", exposure_s),
            ("time between layers", overhead_s),
        ] {
            if !(value_s.is_finite() && value_s >= 0.0) {
                return Err(GridError::BadTime { name, value_s });
            }
        }
        Ok(())
    }

    /// Seconds of exposure of a layer of `thickness_mm`.
    pub fn exposure_s(&self, thickness_mm: f64) -> f64 {
        self.exposure_s * exp((thickness_mm - self.layer_mm) / self.penetration_mm)
    }

    /// Time that a layer of `thickness_mm` takes, in whole microseconds, so that sums are exact; at most eleven days, so
    /// that they do not overflow.
    pub fn layer_us(&self, thickness_mm: f64) -> u64 {
        const MOST: f64 = 1e12;
        ((self.exposure_s(thickness_mm) + self.overhead_s) * 1e6 + 0.5).min(MOST) as u64
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
