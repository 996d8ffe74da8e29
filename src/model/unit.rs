//! Units of the coordinates in a model's file.
//!
//! A unit is part of the pose, like a height: it scales the model on the plate, and weights and views stay in the file's frame.

use serde::{Deserialize, Serialize};

/// A unit of the coordinates in a model's file, by the names of 3MF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum ModelUnit {
    /// A thousandth of a millimetre.
    #[cfg_attr(feature = "cli", value(alias = "um"))]
    Micron,
    /// The unit assumed for a file without one.
    #[cfg_attr(feature = "cli", value(alias = "mm"))]
    Millimeter,
    /// 10 mm.
    #[cfg_attr(feature = "cli", value(alias = "cm"))]
    Centimeter,
    /// 25.4 mm.
    #[cfg_attr(feature = "cli", value(alias = "in"))]
    Inch,
    /// 304.8 mm.
    #[cfg_attr(feature = "cli", value(alias = "ft"))]
    Foot,
    /// 1,000 mm.
    #[cfg_attr(feature = "cli", value(alias = "m"))]
    Meter,
}

impl ModelUnit {
    /// All of them, from the smallest.
    pub const ALL: [Self; 6] = [
        Self::Micron,
        Self::Millimeter,
        Self::Centimeter,
        Self::Inch,
        Self::Foot,
        Self::Meter,
    ];

    /// Its length in millimetres.
    pub fn mm(self) -> f64 {
        match self {
            Self::Micron => 0.001,
            Self::Millimeter => 1.0,
            Self::Centimeter => 10.0,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
            Self::Meter => 1000.0,
        }
    }

    /// Its name, as in 3MF and as users type it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Micron => "micron",
            Self::Millimeter => "millimeter",
            Self::Centimeter => "centimeter",
            Self::Inch => "inch",
            Self::Foot => "foot",
            Self::Meter => "meter",
        }
    }

    /// Its name in the plural, for sentences.
    pub(crate) fn plural(self) -> &'static str {
        match self {
            Self::Micron => "microns",
            Self::Millimeter => "millimeters",
            Self::Centimeter => "centimeters",
            Self::Inch => "inches",
            Self::Foot => "feet",
            Self::Meter => "meters",
        }
    }

    /// The unit of that name.
    pub(crate) fn named(name: &[u8]) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|unit| unit.name().as_bytes() == name)
    }
}
