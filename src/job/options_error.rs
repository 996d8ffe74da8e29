//! Errors of resolving options.

use serde::Serialize;

use crate::format::Format;

/// Options that cannot be read, are out of bounds, contradict each other, or exceed the printer's abilities.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum OptionsError {
    /// The options do not have the right type: an unknown key, or a value of another type.
    #[error("the options cannot be read: {system}")]
    #[serde(rename = "bad-options")]
    Unreadable {
        /// The parser's message.
        system: String,
    },
    /// No printer has this name.
    #[error(
        "there is no printer {printer} among the {known} known ones{}",
        if similar.is_empty() { String::new() } else { format!("; similar are {}", similar.join(", ")) }
    )]
    #[serde(rename = "unknown-printer")]
    UnknownPrinter {
        /// The requested name.
        printer: String,
        /// Known names that are similar.
        similar: Vec<String>,
        /// Number of known printers.
        known: usize,
    },
    /// The description of a printer has a value out of bounds.
    #[error("the printer {printer} cannot have this {field}; correct its description")]
    #[serde(rename = "bad-printer")]
    BadPrinter {
        /// Its name.
        printer: String,
        /// The name of the field.
        field: &'static str,
    },
    /// Pixels are given without their pitch, or different pitches in x and y without pixels.
    #[error(
        "pixels and their pitch in x and y belong together; give both, or one pitch for x and y"
    )]
    #[serde(rename = "pixels-without-pitch")]
    PixelsWithoutPitch,
    /// The anti-aliasing level does not exist.
    #[error("anti-aliasing has the levels {known:?}, not {antialias}")]
    #[serde(rename = "bad-antialias")]
    BadAntialias {
        /// The requested level.
        antialias: u32,
        /// The known levels.
        known: [u32; 4],
    },
    /// A length of hollowing or of supports is out of bounds.
    #[error("{option} must be from {least_mm} mm to {most_mm} mm, not {value_mm} mm")]
    #[serde(rename = "bad-size")]
    BadLength {
        /// Its name in the options.
        option: &'static str,
        /// Its value.
        value_mm: f64,
        /// The least value.
        least_mm: f64,
        /// The largest value.
        most_mm: f64,
    },
    /// The minimum weight is not from 0 to 1.
    #[error("the minimum weight must be from 0 to 1, not {weight_min}")]
    #[serde(rename = "bad-weight-min")]
    BadWeightMin {
        /// The requested weight.
        weight_min: f64,
    },
    /// More than one of tolerance, number of layers and time is given.
    #[error("give a tolerance, the most layers or the longest time, and only one of them")]
    #[serde(rename = "several-targets")]
    SeveralTargets,
    /// Two options that exclude each other.
    #[error("{option} does not go with {other}; leave one of them out")]
    #[serde(rename = "contradictory-options")]
    Contradictory {
        /// Name of an option.
        option: &'static str,
        /// Name of the other.
        other: &'static str,
    },
    /// The options allow layer thicknesses that the printer cannot print.
    #[error(
        "the {model} prints layers of {printer_min_mm} to {printer_max_mm} mm, not {layer_min_mm} to {layer_max_mm} mm; \
         stay within its limits, or choose another printer"
    )]
    #[serde(rename = "printer-layers")]
    PrinterLayers {
        /// Make and model of the printer.
        model: String,
        /// Minimum layer thickness of the printer.
        printer_min_mm: f64,
        /// Maximum layer thickness of the printer.
        printer_max_mm: f64,
        /// Requested minimum thickness: of all layers, of a height range, or of uniform layers.
        layer_min_mm: f64,
        /// Requested maximum thickness of the same layers.
        layer_max_mm: f64,
    },
    /// The requested step is not a whole number of the printer's motor steps.
    #[error(
        "the {model} moves in steps of {printer_step_mm} mm, and {step_mm} mm is not a whole number of them; use a multiple \
         of {printer_step_mm} mm"
    )]
    #[serde(rename = "printer-step")]
    PrinterStep {
        /// Make and model of the printer.
        model: String,
        /// Motor step of the printer.
        printer_step_mm: f64,
        /// The requested step.
        step_mm: f64,
    },
    /// The format is for filament printers, and the printer is none.
    #[error(
        "{} files are for filament printers, and the {model} prints resin; leave the printer out, or choose a format that it reads",
        format.name()
    )]
    #[serde(rename = "resin-printer")]
    ResinPrinter {
        /// The requested format.
        format: Format,
        /// Make and model of the printer.
        model: String,
    },
    /// A nozzle is given for a format that is not for filament printers.
    #[error(
        "a nozzle goes with the formats for filament printers only: {}; choose one of them, or leave the nozzle out",
        formats.map(Format::name).join(", ")
    )]
    #[serde(rename = "nozzle-without-filament")]
    NozzleWithoutFilament {
        /// The formats for filament printers.
        formats: [Format; 2],
    },
    /// No nozzle has this width.
    #[error("the nozzle must be {least_mm} to {most_mm} mm wide, not {nozzle_mm} mm")]
    #[serde(rename = "bad-nozzle")]
    BadNozzle {
        /// The requested width.
        nozzle_mm: f64,
        /// The least width.
        least_mm: f64,
        /// The greatest width.
        most_mm: f64,
    },
    /// The options allow layer thicknesses that the slicer does not print through the nozzle.
    #[error(
        "through a nozzle of {nozzle_mm} mm {} prints layers of {nozzle_min_mm} to {nozzle_max_mm} mm, not {layer_min_mm} to \
         {layer_max_mm} mm; stay within its limits, or name another nozzle",
        slicers.join(" or ")
    )]
    #[serde(rename = "nozzle-layers")]
    NozzleLayers {
        /// Names of the slicers.
        slicers: Vec<&'static str>,
        /// Width of the nozzle.
        nozzle_mm: f64,
        /// Minimum layer thickness of the nozzle.
        nozzle_min_mm: f64,
        /// Maximum layer thickness of the nozzle.
        nozzle_max_mm: f64,
        /// Requested minimum thickness: of all layers, of a height range, of uniform layers, or of the first layer.
        layer_min_mm: f64,
        /// Requested maximum thickness of the same layers.
        layer_max_mm: f64,
    },
}
