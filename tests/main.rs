//! Every test that needs nothing but the crate and the command line, in one program, so that the crate is linked once. A suite is a module.

mod archive;
mod calibration;
mod cli;
mod common;
mod compensation;
mod contours;
mod cure;
mod deviation;
mod docs;
#[cfg(target_os = "linux")]
mod endurance;
mod filament;
mod filament_roundness;
mod fuzz;
mod grid;
mod inspect;
mod job;
mod layout;
mod ldi;
mod mask;
mod memory;
mod mesh;
mod orientation;
mod overlap;
mod plan;
mod plate;
mod prepare;
mod price;
mod printability;
mod printer;
mod profile;
mod quantity;
mod read;
mod saliency;
mod simulate;
mod vanishing;
mod verify;
mod web;

use peak_alloc::PeakAlloc;

/// Counts allocations, for `memory.rs`.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;
