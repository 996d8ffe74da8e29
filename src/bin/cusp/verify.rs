//! Checks a submitted plan and print file.

use std::fs;
use std::path::Path;

use cusp_slicer::job::Claim;
use cusp_slicer::warning::Warning;
use serde::Serialize;

use crate::files::{Failure, WeightsFile, in_file, load_painted};
use crate::terminal::{Bar, open_gpu, print, print_json, stop_on_interrupt, warn};

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

pub fn verify(
    plan: &Path,
    model: &Path,
    print_file: Option<&Path>,
    weights: Option<&Path>,
    json: bool,
) -> Result<(), Failure> {
    let text = fs::read_to_string(plan).map_err(|error| in_file(plan, &error))?;
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
    let verified = Verified {
        layers: made.layers,
        max_error: made.max_error,
        tolerance: made.tolerance,
        print_time_s: made.print_time_s,
        resin_ml: made.resin_ml,
        print_is_same: print_file.is_some(),
        warnings: made.warnings.clone(),
    };
    let words = made.metric.format(made.max_error);
    if let Some(path) = print_file {
        let sent = fs::read(path).map_err(|error| in_file(path, &error))?;
        let (bytes, _) = slicer
            .write_archive(Vec::with_capacity(sent.len()), &mut progress)
            .map_err(|error| Failure::in_file(model, &error))?;
        if sent != bytes {
            let reason = "it is not the print file that this plan gives";
            return Err(in_file(path, &reason).into());
        }
    }
    drop(bar);
    warn(&verified.warnings);
    if json {
        return Ok(print_json(&verified)?);
    }
    Ok(print(&format!(
        "the plan is correct: {} layers, largest error {words} within its tolerance{}",
        verified.layers,
        if verified.print_is_same {
            "; the print file matches it"
        } else {
            ""
        }
    ))?)
}
