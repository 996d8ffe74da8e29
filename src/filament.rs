//! Slicers for filament printers: which layers they print through a nozzle, and which of their settings a plan depends on.
//! [`crate::archive::layer_profile`] writes the files that they read.

use serde::Serialize;

use crate::format::Format;

/// The width of most nozzles, in millimetres.
pub const USUAL_NOZZLE_MM: f64 = 0.4;

/// The least and the greatest width of a nozzle, in millimetres.
pub const NOZZLES_MM: [f64; 2] = [0.15, 2.0];

/// A slicer for filament printers, or several that read the same file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilamentSlicer {
    /// PrusaSlicer.
    Prusa,
    /// OrcaSlicer and Bambu Studio.
    Orca,
}

/// The rule by which a slicer limits layers, as parts of the nozzle's width.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct LayerRule {
    /// Least thickness, whatever the nozzle.
    pub least_mm: f64,
    /// Least thickness in hundredths of the width; 0 if only `least_mm` counts.
    pub least_percent: f64,
    /// Greatest thickness in hundredths of the width.
    pub most_percent: f64,
}

/// The layers that a slicer prints through a nozzle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NozzleLayers {
    /// Least layer thickness in millimetres.
    pub least_mm: f64,
    /// Greatest layer thickness in millimetres.
    pub most_mm: f64,
    /// Thickness of the first layer in millimetres, unless another is asked for.
    pub first_mm: f64,
}

impl FilamentSlicer {
    /// The slicer that reads a format; `None` for formats of masks.
    pub fn of(format: Format) -> Option<Self> {
        match format {
            Format::Prusa3mf => Some(Self::Prusa),
            Format::Orca3mf => Some(Self::Orca),
            _ => None,
        }
    }

    /// The names of the programs.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Prusa => &["PrusaSlicer"],
            Self::Orca => &["OrcaSlicer", "Bambu Studio"],
        }
    }

    /// The programs' name for the thickness of the first layer, with the path to the setting.
    pub fn first_layer_setting(self) -> &'static str {
        match self {
            Self::Prusa => "Print Settings > Layers and perimeters > First layer height",
            Self::Orca => "Quality > Layer height > First layer height (Initial layer height)",
        }
    }

    /// Returns true if it is known that they print the layers of a plan as they are: for PrusaSlicer, tests compare them.
    pub fn is_tried(self) -> bool {
        self == Self::Prusa
    }

    /// The limits of layers: what the slicer has by default, or, for OrcaSlicer and Bambu Studio, what their printers' own profiles
    /// have. Bambu's nozzles of 0.2, 0.4, 0.6 and 0.8 mm print 0.2 to 0.7 times their width; PrusaSlicer prints from 0.07 mm to
    /// 0.75 times the width.
    pub fn rule(self) -> LayerRule {
        let [least_mm, least_percent, most_percent] = match self {
            Self::Prusa => [0.07, 0.0, 75.0],
            Self::Orca => [0.0, 20.0, 70.0],
        };
        LayerRule {
            least_mm,
            least_percent,
            most_percent,
        }
    }

    /// The layers that the slicer prints through a nozzle of this width. All are whole hundredths of a millimetre. A first layer of
    /// half the width is what most profiles have.
    pub fn layers(self, nozzle_mm: f64) -> NozzleLayers {
        // Of a millimetre. Products such as 0.4 · 75 are not whole.
        const ROUNDING: f64 = 1e-6;
        let up = |hundredths: f64| (hundredths - ROUNDING).ceil() / 100.0;
        let down = |hundredths: f64| (hundredths + ROUNDING).floor() / 100.0;
        let rule = self.rule();
        let least_mm = up(nozzle_mm * rule.least_percent).max(rule.least_mm);
        let most_mm = down(nozzle_mm * rule.most_percent);
        NozzleLayers {
            least_mm,
            most_mm,
            // Not clamped: an impossible nozzle, which is refused later, may have no limits.
            first_mm: down(nozzle_mm * 50.0).max(least_mm).min(most_mm),
        }
    }
}

/// The setting of the slicer that must match the plan. Without it, every layer is printed at another height than planned.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FilamentReport {
    /// The names of the programs that read the file.
    pub slicers: Vec<&'static str>,
    /// Width of the nozzle in millimetres.
    pub nozzle_mm: f64,
    /// Thickness of the first layer in millimetres, to be set in the slicer.
    pub first_layer_mm: f64,
    /// The programs' English name for it, with the path to the setting; for sentences.
    #[serde(skip)]
    pub setting: &'static str,
    /// True if it is known that they print these layers as they are.
    pub is_tried: bool,
}

impl FilamentReport {
    /// For a plan whose first layer is `first_layer_mm` thick.
    pub fn new(slicer: FilamentSlicer, nozzle_mm: f64, first_layer_mm: f64) -> Self {
        Self {
            slicers: slicer.names().to_vec(),
            nozzle_mm,
            first_layer_mm,
            setting: slicer.first_layer_setting(),
            is_tried: slicer.is_tried(),
        }
    }
}

impl std::fmt::Display for FilamentReport {
    /// The instruction for the slicer.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "set the first layer to {} mm in {} ({}), or every layer is printed at another height than planned",
            self.first_layer_mm,
            self.slicers.join(" or "),
            self.setting,
        )
    }
}
