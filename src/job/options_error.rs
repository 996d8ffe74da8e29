//! Why options cannot be resolved.

use serde::Serialize;

/// Options that contradict each other, or that no printer or format can follow.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum OptionsError {
    /// They are not of the type of options: an unknown key, or a value of another type.
    #[error("the options cannot be read: {system}")]
    #[serde(rename = "bad-options")]
    Unreadable {
        /// What the parser said.
        system: String,
    },
    /// No printer has this name.
    #[error("there is no printer {printer}; known are {}", known.join(", "))]
    #[serde(rename = "unknown-printer")]
    UnknownPrinter {
        /// The name asked for.
        printer: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// Pixels are given without their pitch, or different pitches in x and y without pixels.
    #[error(
        "pixels and their pitch in x and y belong together; give both, or one pitch for x and y"
    )]
    #[serde(rename = "pixels-without-pitch")]
    PixelsWithoutPitch,
    /// There is no such level of anti-aliasing.
    #[error("anti-aliasing has the levels {known:?}, not {antialias}")]
    #[serde(rename = "bad-antialias")]
    BadAntialias {
        /// The level asked for.
        antialias: u32,
        /// The levels there are.
        known: [u32; 4],
    },
    /// The least weight is not from 0 to 1.
    #[error("the minimum weight must be from 0 to 1, not {weight_min}")]
    #[serde(rename = "bad-weight-min")]
    BadWeightMin {
        /// The weight asked for.
        weight_min: f64,
    },
    /// More than one of tolerance, number of layers and time is given.
    #[error("give a tolerance, the most layers or the longest time, and only one of them")]
    #[serde(rename = "several-targets")]
    SeveralTargets,
    /// The printer cannot make layers of a thickness that the options allow.
    #[error(
        "the {model} prints layers of {printer_min_mm} to {printer_max_mm} mm, not {layer_min_mm} to {layer_max_mm} mm; \
         stay within its limits, or choose another printer"
    )]
    #[serde(rename = "printer-layers")]
    PrinterLayers {
        /// What its maker calls the printer.
        model: &'static str,
        /// Least thickness that it prints.
        printer_min_mm: f64,
        /// Greatest thickness that it prints.
        printer_max_mm: f64,
        /// Least thickness asked for: of all layers, of a height range, or of uniform layers.
        layer_min_mm: f64,
        /// Greatest thickness asked for there.
        layer_max_mm: f64,
    },
    /// Heights are to be multiples of what is no whole number of the printer's motor steps.
    #[error(
        "the {model} moves in steps of {printer_step_mm} mm, and {step_mm} mm is not a whole number of them; use a multiple \
         of {printer_step_mm} mm"
    )]
    #[serde(rename = "printer-step")]
    PrinterStep {
        /// What its maker calls the printer.
        model: &'static str,
        /// Its motor step.
        printer_step_mm: f64,
        /// The step asked for.
        step_mm: f64,
    },
}
