//! Checks a submitted plan and print file.

use std::fs;
use std::path::Path;

use cusp_slicer::job::{Backend, Claim, Report, Slicer};
use cusp_slicer::warning::Warning;
use serde::Serialize;

use crate::files::{Failure, WeightsFile, in_file, load_painted};
use crate::job_file::{JobFile, job_file};
use crate::terminal::{
    Bar, open_gpu, open_gpu_of_plate, print, print_json, stop_on_interrupt, warn,
};
use crate::usage::wrong_usage;

/// The result of a successful verification.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Verified {
    layers: usize,
    max_error: f64,
    tolerance: f64,
    print_time_s: f64,
    resin_ml: f64,
    print_is_same: bool,
    warnings: Vec<Warning>,
}

impl Verified {
    fn of(made: &Report, print_is_same: bool) -> Self {
        Self {
            layers: made.layers,
            max_error: made.max_error,
            tolerance: made.tolerance,
            print_time_s: made.print_time_s,
            resin_ml: made.resin_ml,
            print_is_same,
            warnings: made.warnings.clone(),
        }
    }
}

/// The result for the plates of a job.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VerifiedPlates {
    /// Print time of these plates, one after the other.
    print_time_s: f64,
    /// Volume of resin in all of their copies.
    resin_ml: f64,
    /// The plates that the plan is of.
    plates: Vec<Verified>,
}

fn check_print(path: &Path, sent: &[u8], made: &[u8]) -> Result<(), Failure> {
    if sent == made {
        return Ok(());
    }
    let reason = "it is not the print file that this plan gives";
    Err(in_file(path, &reason).into())
}

/// Verifies the plans of all plates of a job, or of one.
fn verify_plates(
    plan: &Path,
    text: &str,
    job: &JobFile,
    path: &Path,
    print_file: Option<&Path>,
    json: bool,
) -> Result<(), Failure> {
    let mut plate = job.read_models(path.parent())?.plate;
    let files: Vec<_> = plate.models().iter().map(Slicer::model_file).collect();
    let claims = Claim::read_plates(text, &files).map_err(|error| in_file(plan, &error))?;
    let sent = match print_file {
        Some(_) if claims.len() != 1 => {
            let message = format!(
                "--print is for one plate, and the plan has {}; give the manifest of its zip",
                claims.len()
            );
            wrong_usage("verify", &message);
        }
        Some(path) => Some((path, fs::read(path).map_err(|error| in_file(path, &error))?)),
        None => None,
    };
    stop_on_interrupt();
    if claims
        .iter()
        .any(|claim| claim.options().backend == Backend::Gpu)
    {
        open_gpu_of_plate(&mut plate);
    }
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let mut plates = Vec::new();
    for claim in &claims {
        let made = pollster::block_on(claim.plan_again(&mut plate, &mut progress));
        let made = made.map_err(|error| Failure::in_file(path, &error))?;
        claim.check(made).map_err(|error| in_file(plan, &error))?;
        plates.push(Verified::of(made, sent.is_some()));
        if let Some((print_file, sent)) = &sent {
            let written = plate.write_archive(0, Vec::with_capacity(sent.len()), &mut progress);
            let (bytes, _) = written.map_err(|error| Failure::in_file(path, &error))?;
            check_print(print_file, sent, &bytes)?;
        }
    }
    drop(bar);
    for plate in &plates {
        warn(&plate.warnings);
    }
    let verified = VerifiedPlates {
        print_time_s: plates.iter().map(|plate| plate.print_time_s).sum(),
        resin_ml: plates.iter().map(|plate| plate.resin_ml).sum(),
        plates,
    };
    if json {
        return Ok(print_json(&verified)?);
    }
    let layers = verified.plates.iter().map(|plate| plate.layers.to_string());
    Ok(print(&format!(
        "the plan is correct: {} layers, each plate within its tolerance{}",
        layers.collect::<Vec<_>>().join(" + "),
        same_print(sent.is_some()),
    ))?)
}

fn same_print(is_same: bool) -> &'static str {
    if is_same {
        "; the print file matches it"
    } else {
        ""
    }
}

pub fn verify(
    plan: &Path,
    model: &Path,
    print_file: Option<&Path>,
    weights: Option<&Path>,
    json: bool,
) -> Result<(), Failure> {
    let text = fs::read_to_string(plan).map_err(|error| in_file(plan, &error))?;
    if let Some(job) = job_file(&[model.to_owned()])? {
        if weights.is_some() {
            let message = "weights belong to a model: name them beside it in the job file";
            wrong_usage("verify", message);
        }
        return verify_plates(plan, &text, &job, model, print_file, json);
    }
    let weights = weights.map(WeightsFile::read).transpose()?;
    let mut slicer = load_painted(model, weights.as_ref())?;
    let claim = Claim::read(&text, slicer.model_file()).map_err(|error| in_file(plan, &error))?;
    stop_on_interrupt();
    open_gpu(&mut slicer, claim.options().backend);
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let made = pollster::block_on(slicer.plan(claim.options(), &mut progress))
        .map_err(|error| Failure::in_file(model, &error))?;
    claim.check(made).map_err(|error| in_file(plan, &error))?;
    let verified = Verified::of(made, print_file.is_some());
    let words = made.metric.format(made.max_error);
    if let Some(path) = print_file {
        let sent = fs::read(path).map_err(|error| in_file(path, &error))?;
        let (bytes, _) = slicer
            .write_archive(Vec::with_capacity(sent.len()), &mut progress)
            .map_err(|error| Failure::in_file(model, &error))?;
        check_print(path, &sent, &bytes)?;
    }
    drop(bar);
    warn(&verified.warnings);
    if json {
        return Ok(print_json(&verified)?);
    }
    Ok(print(&format!(
        "the plan is correct: {} layers, largest error {words} within its tolerance{}",
        verified.layers,
        same_print(verified.print_is_same),
    ))?)
}
