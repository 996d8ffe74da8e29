//! All errors of the library as one type, with a stable code and typed details for programs.

use serde::Serialize;

use crate::archive::ArchiveError;
use crate::arrange::ArrangeError;
use crate::format::Format;
use crate::grid::GridError;
use crate::inspect::LimitsError;
use crate::ldi::LdiError;
use crate::model::MeshError;
use crate::model::read::ReadError;
use crate::model::weights::WeightsError;
use crate::orientation::SearchError;
#[cfg(not(target_arch = "wasm32"))]
use crate::orientation::shard::MergeError;
use crate::plan::PlanError;
use crate::price::PriceError;

/// Any error of the library. `Display` writes one sentence that says what to do; serialised, an error is its code and an
/// object of typed details.
#[derive(Debug, thiserror::Error, Serialize)]
#[cfg_attr(
    target_arch = "wasm32",
    derive(tsify::Tsify),
    tsify(rename = "NestedError")
)]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum Error {
    /// The plan has no such layer.
    #[error("there is no layer {layer}; the plan has {layers}, from 0")]
    #[serde(rename = "no-layer")]
    NoLayer {
        /// The requested layer, from 0.
        layer: usize,
        /// Number of layers of the plan.
        layers: usize,
    },
    /// Masks, a profile or a print file were requested before a plan was made.
    #[error("there is no plan yet; make one first")]
    #[serde(rename = "no-plan")]
    NoPlan,
    /// The job takes more memory than it may. Plans and print files need the least; checks, single masks and compensated
    /// masks need all hits.
    #[error(
        "this takes about {needed_bytes} bytes of memory, and {allowed_bytes} are allowed; allow more, or choose larger pixels"
    )]
    #[serde(rename = "memory-bound")]
    MemoryBound {
        /// Bytes that it takes.
        needed_bytes: u64,
        /// Bytes that it may take.
        allowed_bytes: u64,
    },
    /// The job takes more processor time than it may.
    #[error(
        "{} takes about {needed_s} s of processor time, and {allowed_s} are allowed; allow more{}",
        work.noun(),
        work.way()
    )]
    #[serde(rename = "time-bound")]
    TimeBound {
        /// The work that takes it.
        work: Work,
        /// Seconds that it takes, of all processors together.
        needed_s: f64,
        /// Seconds that it may take.
        allowed_s: f64,
    },
    /// Pieces of supported or hollow models begin with nothing below them, and would float in the vat.
    #[error(
        "{} nothing below, the largest of {volume_mm3:.2} mm³ in layer {layer_number} at {:.2}, {:.2}, {:.2}; add supports there, turn the \
         model, or allow floating pieces",
        if *pieces == 1 { "a piece begins with".to_owned() } else { format!("{pieces} pieces begin with") },
        at_mm[0],
        at_mm[1],
        at_mm[2]
    )]
    #[serde(rename = "floating-pieces")]
    FloatingPieces {
        /// Number of such pieces.
        pieces: usize,
        /// Volume of the largest.
        volume_mm3: f64,
        /// The layer in which it begins, from 1.
        layer_number: usize,
        /// Its place, as in findings.
        at_mm: [f64; 3],
    },
    /// The options contradict each other or cannot be read.
    #[error(transparent)]
    #[serde(untagged)]
    Options(#[from] OptionsError),
    /// The file could not be read as a model.
    #[error(transparent)]
    #[serde(untagged)]
    Read(#[from] ReadError),
    /// The triangles do not form a usable mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Mesh(#[from] MeshError),
    /// Pixels or bins cannot be laid out.
    #[error(transparent)]
    #[serde(untagged)]
    Grid(#[from] GridError),
    /// The weights are invalid, or belong to another mesh.
    #[error(transparent)]
    #[serde(untagged)]
    Weights(#[from] WeightsError),
    /// Sampling failed.
    #[error(transparent)]
    #[serde(untagged)]
    Ldi(#[from] LdiError),
    /// Planning failed.
    #[error(transparent)]
    #[serde(untagged)]
    Plan(#[from] PlanError),
    /// Models cannot be arranged on plates, or cannot stay where they are.
    #[error(transparent)]
    #[serde(untagged)]
    Arrange(#[from] ArrangeError),
    /// The print file could not be written.
    #[error(transparent)]
    #[serde(untagged)]
    Archive(#[from] ArchiveError),
    /// Limits of the checks are invalid.
    #[error(transparent)]
    #[serde(untagged)]
    Limits(#[from] LimitsError),
    /// The options of a search are invalid, or it rejected a result.
    #[error(transparent)]
    #[serde(untagged)]
    Search(#[from] SearchError),
    /// There is no price.
    #[error(transparent)]
    #[serde(untagged)]
    Price(#[from] PriceError),
    /// The parts of a search cannot be merged.
    #[cfg(not(target_arch = "wasm32"))]
    #[error(transparent)]
    #[serde(untagged)]
    Merge(#[from] MergeError),
}

/// Work that takes processor time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Work {
    /// Hits of rays, which are as many as pixels that facets cover.
    Hits,
    /// Errors of layers: bins times thicknesses.
    Layers,
    /// Saliency: vertices times the cells within reach of them.
    Saliency,
    /// Everything together, where no part of it alone is certain to take too long.
    All,
}

impl Work {
    fn noun(self) -> &'static str {
        match self {
            Self::Hits => "sampling the model",
            Self::Layers => "planning",
            Self::Saliency => "saliency",
            Self::All => "this",
        }
    }

    fn way(self) -> &'static str {
        match self {
            Self::Hits => ", or choose larger pixels",
            Self::Layers => ", or choose larger bins or fewer thicknesses",
            Self::Saliency => ", do without saliency, or give the model fewer facets",
            Self::All => "",
        }
    }
}

impl Error {
    /// The stable code of the error, as serialised.
    pub fn code(&self) -> String {
        let serialised = serde_json::to_value(self).unwrap_or_default();
        let code = serialised["code"].as_str();
        code.unwrap_or_default().to_owned()
    }
}

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
    #[error("the description of the printer {printer} has an invalid {field}; correct it")]
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
    #[error(
        "give only one of these: a tolerance, a maximum number of layers or a maximum print time"
    )]
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

#[cfg(test)]
mod tests;
