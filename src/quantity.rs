//! Numbers that users give, with their units and bounds, so that errors can name them.

use serde::Serialize;

/// A number that users give.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Quantity {
    /// Side of a pixel.
    Pitch,
    /// Height of a bin.
    Bin,
    /// Motor step: every height is a multiple of it.
    Step,
    /// Thickness of uniform layers.
    Layer,
    /// Thickness of the first layer.
    FirstLayer,
    /// Minimum layer thickness.
    LayerMin,
    /// Maximum layer thickness.
    LayerMax,
    /// Maximum error of a layer.
    Tolerance,
    /// Layer thickness to which the resin's exposure applies.
    ResinLayer,
    /// Penetration depth of the light.
    Penetration,
    /// Depth below a layer to which its own exposure cures.
    Overcure,
    /// Part of the dose of earlier exposures that counts.
    RetainedDose,
    /// Exposure of a layer.
    Exposure,
    /// Exposure of a bottom layer.
    BottomExposure,
    /// Rest per layer, in addition to the moves.
    Wait,
    /// Height by which the model is lifted after a layer.
    Lift,
    /// Speed of the lift.
    LiftSpeed,
    /// Speed of the return.
    ReturnSpeed,
    /// Density of the cured resin.
    Density,
}

/// The unit of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[non_exhaustive]
pub enum Unit {
    /// Lengths.
    #[serde(rename = "mm")]
    Millimetre,
    /// Times.
    #[serde(rename = "s")]
    Second,
    /// Speeds.
    #[serde(rename = "mm/min")]
    MillimetrePerMinute,
    /// Densities.
    #[serde(rename = "g/ml")]
    GramPerMillilitre,
    /// Tolerances, whose unit is the metric's ([`crate::profile::Metric::unit`]), and fractions.
    #[serde(rename = "")]
    Unstated,
}

impl Unit {
    /// The symbol of the unit; empty for [`Self::Unstated`].
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Second => "s",
            Self::MillimetrePerMinute => "mm/min",
            Self::GramPerMillilitre => "g/ml",
            Self::Unstated => "",
        }
    }
}

impl Quantity {
    /// The unit of the quantity.
    pub fn unit(self) -> Unit {
        match self {
            Self::Tolerance | Self::RetainedDose => Unit::Unstated,
            Self::Exposure | Self::BottomExposure | Self::Wait => Unit::Second,
            Self::LiftSpeed | Self::ReturnSpeed => Unit::MillimetrePerMinute,
            Self::Density => Unit::GramPerMillilitre,
            _ => Unit::Millimetre,
        }
    }

    /// The least and the greatest value: far beyond what any printer, resin or model needs, and near enough that no sum of them
    /// over all layers overflows.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Pitch
            | Self::Bin
            | Self::Step
            | Self::Layer
            | Self::FirstLayer
            | Self::LayerMin
            | Self::LayerMax => [1e-6, 1e6],
            // An upright prism has no error, so the smallest tolerance for a number of layers may be 0.
            Self::Tolerance => [0.0, 1e9],
            Self::ResinLayer => [1e-4, 10.0],
            Self::Penetration => [1e-4, 100.0],
            Self::Overcure | Self::RetainedDose => [0.0, 1.0],
            Self::Exposure | Self::BottomExposure | Self::Wait => [0.0, 1e5],
            Self::Lift => [0.0, 1e3],
            Self::LiftSpeed | Self::ReturnSpeed => [0.1, 1e6],
            Self::Density => [1e-3, 1e3],
        }
    }

    /// Its name in sentences for the terminal.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Pitch => "the pixel pitch",
            Self::Bin => "the bin height",
            Self::Step => "the motor step",
            Self::Layer => "the layer thickness",
            Self::FirstLayer => "the first layer",
            Self::LayerMin => "the minimum layer thickness",
            Self::LayerMax => "the maximum layer thickness",
            Self::Tolerance => "the tolerance",
            Self::ResinLayer => "the resin's layer thickness",
            Self::Penetration => "the penetration depth",
            Self::Overcure => "the overcure",
            Self::RetainedDose => "the retained part of earlier doses",
            Self::Exposure => "the exposure",
            Self::BottomExposure => "the bottom exposure",
            Self::Wait => "the wait between layers",
            Self::Lift => "the lift height",
            Self::LiftSpeed => "the lift speed",
            Self::ReturnSpeed => "the return speed",
            Self::Density => "the resin density",
        }
    }

    /// Returns `value` if it is within [`Self::range`].
    ///
    /// # Errors
    /// [`QuantityError::BadTime`] for times, [`QuantityError::BadLength`] for all others.
    pub fn check(self, value: f64) -> Result<f64, QuantityError> {
        let (quantity, unit, [least, most]) = (self, self.unit(), self.range());
        if (least..=most).contains(&value) {
            return Ok(value);
        }
        Err(match unit {
            Unit::Second => QuantityError::BadTime {
                quantity,
                value_s: value,
                most_s: most,
            },
            _ => QuantityError::BadLength {
                quantity,
                value,
                unit,
                least,
                most,
            },
        })
    }
}

/// Error of a number that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum QuantityError {
    /// A length, speed, density or tolerance that is out of bounds.
    #[error("{}", out_of_range(*quantity, *value))]
    #[serde(rename = "bad-length")]
    BadLength {
        /// The quantity.
        quantity: Quantity,
        /// Its value.
        value: f64,
        /// Unit of all three.
        unit: Unit,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// A time that is negative or too long.
    #[error("{}", out_of_range(*quantity, *value_s))]
    #[serde(rename = "bad-time")]
    BadTime {
        /// The quantity.
        quantity: Quantity,
        /// Its value in seconds.
        value_s: f64,
        /// The most; the least is 0.
        most_s: f64,
    },
    /// A compensation that no measurement can have found.
    #[error("masks can compensate for {least_mm} to {most_mm} mm, not for {value_mm} mm")]
    #[serde(rename = "bad-compensation")]
    BadCompensation {
        /// The distance.
        value_mm: f64,
        /// The least.
        least_mm: f64,
        /// The most.
        most_mm: f64,
    },
    /// Measured exposures that are not in order of thickness.
    #[error(
        "measured exposures must be in order of thickness, each thicker than the one before, but {next_mm} mm follows \
         {previous_mm} mm"
    )]
    #[serde(rename = "bad-exposures")]
    BadExposures {
        /// A thickness.
        previous_mm: f64,
        /// The thickness after it, which is not larger.
        next_mm: f64,
    },
}

fn out_of_range(quantity: Quantity, value: f64) -> String {
    let [least, most] = quantity.range();
    let (noun, unit) = (quantity.noun(), quantity.unit().symbol());
    let gap = if unit.is_empty() { "" } else { " " };
    format!("{noun} must be from {least} to {most}{gap}{unit}, not {value}{gap}{unit}")
}
