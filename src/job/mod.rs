//! A job: options are resolved once, then the stages run in order. The result of each is an immutable value.

mod calibration;
mod compare;
mod convert;
mod error;
mod facet_shapes;
#[cfg(not(target_arch = "wasm32"))]
mod front;
mod groups;
mod measured;
mod memory;
mod options;
mod options_error;
mod orient;
mod parts;
mod planned;
mod planning;
mod plate;
mod prepared;
mod price;
mod print;
mod report;
mod resolve;
mod sampled;
mod slicer;
mod stage;
mod tolerances;
mod verify;
#[cfg(not(target_arch = "wasm32"))]
mod work;

pub use calibration::{Calibration, Section};
pub use convert::{Conversion, ConvertError, Loss, Target};
pub use error::{Error, Work};
pub use groups::LayerGroups;
pub use options::*;
pub use options_error::OptionsError;
#[cfg(not(target_arch = "wasm32"))]
pub use orient::OrientationPart;
pub use orient::OrientationReport;
pub use plate::{
    ModelOptions, ModelPrintability, Placement, Plate, PlateModelReport, PlateOptions,
    PlatePrintability, PlateReport, PlatesReport,
};
pub use prepared::{Hollowed, Supported};
pub use report::*;
pub use resolve::BIN_MM;
pub use slicer::Slicer;
pub use stage::{Stage, StageProgress};
pub use verify::*;
