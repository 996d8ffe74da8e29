//! Cusp slices 3-D models for resin printers. A model is sampled into a layered depth image (LDI), the LDI and the facets give
//! a metric profile (error density along z), and dynamic programming finds the fewest layers of varying thickness that keep
//! every layer's error within a tolerance.
//!
//! The method: H. Mao, T.-H. Kwok, Y. Chen, C. C. L. Wang, "Adaptive slicing based on efficient profile analysis",
//! Computer-Aided Design 107 (2019). Sections, equations and tables in these pages are those of the paper.
//!
//! ```
//! use std::fs::{self, File};
//! use std::ops::ControlFlow;
//!
//! use cusp_slicer::{Job, JobOptions, LoadedModel, Options, Stage};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # std::env::set_current_dir(&folder)?;
//! # let corners = ["0 0 0", "9 0 0", "0 9 0", "0 0 9"];
//! # let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|facet| {
//! #     let vertices = facet.map(|corner: usize| format!("vertex {}\n", corners[corner])).concat();
//! #     format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
//! # });
//! # fs::write("model.stl", format!("solid\n{}endsolid\n", facets.concat()))?;
//! let mut job = Job::new(vec![LoadedModel::read(&fs::read("model.stl")?)?]);
//! let options = JobOptions::of(Options { rays: 64, ..Options::default() });
//! let mut progress = |_: Stage, _: f64| ControlFlow::Continue(());
//!
//! let report = pollster::block_on(job.plan(&options, &mut progress))?;
//! println!("{} layers, {:.0} s, {:.1} ml", report.plates[0].layers, report.print_time_s, report.resin_ml);
//!
//! let file = File::create("model.zip")?;
//! job.write_archive(0, file, &mut progress)?;
//! # Ok(())
//! # }
//! ```
//!
//! # Modules, in pipeline order
//! [`model`] reads, welds and poses a mesh; [`ldi`] samples it; [`profile`] and [`plan`] find the layers; [`mask`] images them;
//! [`inspect`] finds what will fail; [`archive`] writes the print file; [`orientation`] searches for the way up. [`job`] resolves [`Options`] and runs the
//! stages. On it stand [`calibration`]'s test prints, [`convert`]'s print files, [`project`] files and the [`facts`] that the page reads.
//! [`format`](mod@format), [`filament`], [`printer`], [`resin`], [`quantity`] and [`grid`] are data that the others look things up in;
//! [`price`] is what an order costs.
//!
//! # Conventions
//! - Millimetres and seconds wherever a number leaves the library, with the unit in its name; times of stages are in
//!   milliseconds.
//! - z is up; the plate is z = 0, and the model is centred on x = y = 0 above it.
//! - Facets are counter-clockwise seen from outside; inside is a non-zero winding number.
//! - Row 0 of a mask is at the largest y; a mask is sampled at the middle of its layer.
//! - Whatever decides uses integers, basic IEEE arithmetic and square roots: a plan is the same on every machine.

// docs.rs shows the feature that an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

mod argsort;
mod crc;
pub mod misnamed;
mod parallel;
pub mod progress;
mod union_find;
mod ways;
mod xml;

pub mod compensation;
pub mod filament;
pub mod format;
pub mod grid;
pub mod price;
pub mod printer;
pub mod quantity;
pub mod resin;
pub mod warning;

pub mod model;

pub mod ldi;
pub mod prepare;
pub mod profile;

pub mod plan;

pub mod cure;

pub mod mask;

pub mod inspect;

pub mod archive;
pub mod arrange;
#[cfg(all(feature = "cli", not(target_arch = "wasm32")))]
pub mod contour;
pub mod orientation;

pub mod job;

pub mod calibration;
pub mod convert;
pub mod facts;
pub mod project;
#[cfg(all(feature = "cli", not(target_arch = "wasm32")))]
pub mod simulation;

pub use job::{Error, Job, JobOptions, JobReport, LoadedModel, Options, Report, Stage};
pub use warning::Warning;
