//! The door for browsers: the slicer, or with the feature `reader` the reader of print files.
//!
//! Two builds of one package, since only the page opens print files. Errors are thrown as `{ code, message, detail }`.

#![cfg(target_arch = "wasm32")]

#[cfg(not(feature = "reader"))]
mod given;
mod js;
#[cfg(feature = "reader")]
mod reader;
#[cfg(not(feature = "reader"))]
mod slicer;
