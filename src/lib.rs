//! Cusp slices 3-D models for resin printers: an STL becomes a layered depth image, this a metric
//! profile (error density along z), and this the fewest layers of varying thickness that keep the error
//! within a tolerance.
//!
//! ```
//! use cusp_slicer::options::Options;
//! use cusp_slicer::pipeline::{Slicer, Stage};
//! use std::ops::ControlFlow;
//!
//! # fn main() -> Result<(), cusp_slicer::Error> {
//! # let bytes = b"solid a\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 9 0 0 vertex 0 9 9
//! #   endloop endfacet\nendsolid".as_slice();
//! let mut slicer = Slicer::load(bytes)?;
//! let options = Options { rays: 64, ..Options::default() };
//! let mut progress = |_: Stage, _: f64| ControlFlow::Continue(());
//! let report = pollster::block_on(slicer.plan(&options, &mut progress))?;
//! assert_eq!(report.z_mm.len(), report.layers + 1);
//! # Ok(())
//! # }
//! ```
//!
//! # Conventions
//! - Millimetres and milliseconds wherever a number leaves the library, with the unit in its name.
//! - z is up; the plate is z = 0 and the model stands on it, centred on x = y = 0.
//! - Facets are counter-clockwise seen from outside; inside is a non-zero winding number.
//! - Row 0 of a mask is at the largest y; a mask is sampled at the middle of its layer.
//! - Everything that decides uses basic IEEE arithmetic or integers: a plan is the same on every machine.

mod parallel;
pub mod progress;

pub mod archive;
pub mod exposure;
pub mod file_kind;
pub mod format;
pub mod grid;
pub mod ldi;
pub mod mask;
pub mod mesh;
pub mod plan;
pub mod printer;
pub mod profile;
pub mod saliency;
pub mod stl;
pub mod weights;

pub mod direction;
mod error;
mod job;
pub mod options;
pub mod pipeline;
mod planning;
pub mod report;
pub mod verify;
pub mod warning;
#[cfg(target_arch = "wasm32")]
mod wasm;

pub use error::Error;
