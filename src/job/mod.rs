//! A job: options are resolved once, then the stages run in order. The result of each is an immutable value.

mod calibration;
mod compare;
mod convert;
mod error;
mod facts;
mod jobs;
mod loaded;
mod options;
mod options_error;
mod orient;
mod outputs;
#[cfg(not(target_arch = "wasm32"))]
mod pareto_front;
mod places;
mod plan;
mod plates;
mod project;
mod report;
mod resolve;
mod shapes;
mod shares;
mod stages;
mod verify;

pub use calibration::{Calibration, Section};
pub use convert::{Conversion, ConvertError, Loss, Target};
pub use error::{Error, Work};
pub use facts::{Facts, FormatFacts, MetricFacts, StrengthProfiles};
pub use jobs::Job;
pub use loaded::LoadedModel;
pub use options::*;
pub use options_error::OptionsError;
#[cfg(not(target_arch = "wasm32"))]
pub use orient::OrientationPart;
pub use orient::OrientationReport;
pub use outputs::{ModelPrintability, PlatePrintability};
pub use plates::LayerGroups;
pub use project::{Project, ProjectModel, ProjectPart};
pub use report::*;
pub use resolve::BIN_MM;
pub use stages::prepared::{Hollowed, Supported};
pub use stages::stage::{Stage, StageProgress};
pub use verify::*;
