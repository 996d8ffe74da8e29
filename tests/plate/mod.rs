//! Several models in one job: arranging, planning for all, and masks of copies, against the models alone and naive oracles.

mod arranging;
mod masks;
mod sharing;

use crate::common::{load, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::job::{Backend, Job, JobOptions, JobReport, ModelOptions, Options, Placement};
use cusp_slicer::prepare::{SupportProfile, SupportStrength, Supporting};

/// Options with a screen of 40 × 30 mm in pixels of 0.1 mm.
fn options() -> Options {
    Options {
        pixels: Some([400, 300]),
        pitch_mm: Some(0.1),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The same with supports.
fn supported() -> Options {
    let lift_mm = 3.0;
    Options {
        supports: Some(Supporting {
            profile: Some(SupportProfile {
                lift_mm,
                ..SupportStrength::Light.profile()
            }),
            ..Supporting::default()
        }),
        ..options()
    }
}

fn plate(models: &[&solids::Triangles]) -> Job {
    Job::new(
        models
            .iter()
            .map(|model| load(model).into_model())
            .collect(),
    )
}

/// A job of these numbers of copies.
fn job(options: Options, copies: &[usize]) -> JobOptions {
    let models = copies.iter().map(|&copies| ModelOptions {
        copies,
        ..ModelOptions::default()
    });
    JobOptions {
        options,
        models: models.collect(),
        ..JobOptions::default()
    }
}

/// The same with copies at these places and no others.
fn placed(options: &JobOptions, placements: &[Placement]) -> JobOptions {
    let mut options = options.clone();
    for (model, own) in options.models.iter_mut().enumerate() {
        own.copies = placements.iter().filter(|it| it.model == model).count();
    }
    options.placements = placements.to_vec();
    options
}

fn plan(plate: &mut Job, options: &JobOptions) -> Result<JobReport, Error> {
    pollster::block_on(plate.plan(options, &mut quiet))
}

/// The mask of a layer as rows of pixels.
fn pixels(bits: &[u8], width: usize) -> Vec<Vec<bool>> {
    let rows = bits.chunks(width.div_ceil(8));
    rows.map(|row| {
        let lit = |column: usize| row[column / 8] & (0x80 >> (column % 8)) != 0;
        (0..width).map(lit).collect()
    })
    .collect()
}
