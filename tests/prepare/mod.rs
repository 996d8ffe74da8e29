//! Hollowing and drain holes against closed forms, naive distances and the checks.

mod drain;
mod held;
mod hollow;
mod jobs;
mod own_supports;
mod support;

use crate::common::Slicer;
use cusp_slicer::job::{Options, Report};
use cusp_slicer::prepare::Hollowing;

use crate::common::quiet;

/// Options that hollow a model, with pixels of 0.1 mm.
fn hollowed(hollow: Hollowing) -> Options {
    Options {
        hollow: Some(hollow),
        pitch_mm: Some(0.1),
        ..Options::default()
    }
}

fn plan(slicer: &mut Slicer, options: &Options) -> Report {
    pollster::block_on(slicer.plan(options, &mut quiet))
        .unwrap()
        .clone()
}
