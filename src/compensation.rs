//! Compensation for prints larger than their masks: light spreads sideways and cures resin below the intended layer.

use serde::{Deserialize, Serialize};

use crate::quantity::QuantityError;

/// Distances by which a print was measured to be larger than its masks, which make up for them. A resin has some, and a printer may have
/// others; they add up.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Compensation {
    /// Distance in x and y that is taken from each side of masks, in millimetres; a negative one is added.
    pub xy_mm: f64,
    /// The same for bottom layers, whose long exposure makes an elephant's foot; `xy_mm` if absent.
    pub bottom_xy_mm: Option<f64>,
    /// Number of layers above the bottom layers over which the one passes into the other.
    pub faded_layers: usize,
    /// Depth of cure below a layer that hangs over, in millimetres. Surfaces that face down move up by as much, except
    /// in the first layer.
    pub z_mm: f64,
}

/// The greatest distance that is taken for a measured one.
const MOST_MM: f64 = 1.0;

impl Compensation {
    /// Checks that every number is within its bounds.
    ///
    /// # Errors
    /// [`QuantityError::BadCompensation`].
    pub fn check(&self) -> Result<(), QuantityError> {
        let sideways = [Some(self.xy_mm), self.bottom_xy_mm];
        let sideways = sideways.into_iter().flatten();
        let out_of_bounds = sideways
            .map(|mm| (mm, -MOST_MM))
            .chain([(self.z_mm, 0.0)])
            .find(|(mm, least_mm)| !(*least_mm..=MOST_MM).contains(mm));
        match out_of_bounds {
            Some((value_mm, least_mm)) => Err(QuantityError::BadCompensation {
                value_mm,
                least_mm,
                most_mm: MOST_MM,
            }),
            None => Ok(()),
        }
    }

    /// The compensation of a resin on a printer that has its own.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let is_bottom_apart = self.bottom_xy_mm.is_some() || other.bottom_xy_mm.is_some();
        Self {
            xy_mm: self.xy_mm + other.xy_mm,
            bottom_xy_mm: is_bottom_apart.then(|| self.bottom_mm() + other.bottom_mm()),
            faded_layers: self.faded_layers.max(other.faded_layers),
            z_mm: self.z_mm + other.z_mm,
        }
    }

    /// Returns true if masks need no change.
    pub fn is_none(&self) -> bool {
        self.xy_mm == 0.0 && self.bottom_mm() == 0.0 && self.z_mm == 0.0
    }

    fn bottom_mm(&self) -> f64 {
        self.bottom_xy_mm.unwrap_or(self.xy_mm)
    }

    /// Distance in x and y of each layer, in millimetres.
    pub fn of_layers_mm(&self, layers: usize, bottom_layers: usize) -> Vec<f64> {
        let bottom_mm = self.bottom_mm();
        let steps = self.faded_layers + 1;
        (1..=layers)
            .map(|layer| {
                let step = layer.saturating_sub(bottom_layers).min(steps);
                bottom_mm + (self.xy_mm - bottom_mm) * (step as f64 / steps as f64)
            })
            .collect()
    }
}
