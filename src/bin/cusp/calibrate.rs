//! Prints that measure a printer, and the resin file that their result goes into.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use cusp_slicer::job::Calibration;
use serde::Serialize;

use crate::arguments::Target;
use crate::failure::Failure;
use crate::files::{Output, read_resin};
use crate::progress::Bar;
use crate::terminal::{duration, print, print_json};
use crate::usage::check_json;
use crate::values::{length, measured, positive};
use crate::watch::stop_on_interrupt;

#[derive(Subcommand)]
pub enum Calibrating {
    /// Write two towers to measure with a caliper, which show if the printer prints layers of several thicknesses
    Layers {
        #[command(flatten)]
        target: Target,
        /// Print file to write
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
    /// Write a grid of towers with ridges and slots, which shows the exposure that each thickness needs
    Exposure {
        /// Layer thicknesses, one for each row of towers
        #[arg(long, value_name = "MM,MM,...", value_delimiter = ',', value_parser = length, default_values_t = [0.03, 0.05, 0.1])]
        thicknesses: Vec<f64>,
        /// Exposures, one for each column of towers
        #[arg(long, value_name = "S,S,...", value_delimiter = ',', value_parser = positive, default_values_t = [1.5, 2.0, 2.5, 3.0, 4.0])]
        exposures: Vec<f64>,
        #[command(flatten)]
        target: Target,
        /// Print file to write
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
    /// Put measured exposures into a resin file
    Resin {
        /// A thickness and its exposure, such as 0.05=2.4
        #[arg(required = true, value_name = "MM=S", value_parser = measured)]
        measured: Vec<[f64; 2]>,
        /// Resin file to start from
        #[arg(long, value_name = "FILE")]
        resin: Option<PathBuf>,
        /// Resin file to write
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
}

impl Calibrating {
    /// Returns true if a program reads the output.
    pub fn is_json(&self) -> bool {
        match self {
            Self::Layers { json, .. } | Self::Exposure { json, .. } | Self::Resin { json, .. } => {
                *json
            }
        }
    }
}

/// A calibration print that was written.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Calibrated {
    pub print_time_s: f64,
}

pub fn calibrate(calibrating: &Calibrating) -> Result<(), Failure> {
    let (Calibrating::Layers { output, .. }
    | Calibrating::Exposure { output, .. }
    | Calibrating::Resin { output, .. }) = calibrating;
    let json = calibrating.is_json();
    check_json("calibrate", Some(output), json);
    let output = &Output::new(output, None, "")?;
    match calibrating {
        Calibrating::Layers { target, .. } => layers(target, output, json),
        Calibrating::Exposure {
            thicknesses,
            exposures,
            target,
            ..
        } => exposure(target, thicknesses, exposures, output, json),
        Calibrating::Resin {
            measured, resin, ..
        } => resin_file(measured, resin.as_deref(), output, json),
    }
}

fn layers(target: &Target, output: &Output<'_>, json: bool) -> Result<(), Failure> {
    let calibration = Calibration::layers(&target.options()?);
    let calibration = calibration.map_err(|error| output.failure(&error))?;
    let print_time_s = write(&calibration, output)?;
    if json {
        return Ok(print_json(&Calibrated { print_time_s })?);
    }
    Ok(print(&format!(
        "{}: two towers of ten layers of 0.05 mm, one with ten of 0.1 mm more; prints in {}\n\
         Measure both: 0.5 and 1.5 mm say that the printer takes a thickness for each layer; 0.5 and 1.0, or 1.0 and 2.0, that \
         it takes one for all.",
        output.name(),
        duration(print_time_s)
    ))?)
}

fn exposure(
    target: &Target,
    thickness_mm: &[f64],
    exposure_s: &[f64],
    output: &Output<'_>,
    json: bool,
) -> Result<(), Failure> {
    let calibration = Calibration::exposure(&target.options()?, thickness_mm, exposure_s);
    let calibration = calibration.map_err(|error| output.failure(&error))?;
    let print_time_s = write(&calibration, output)?;
    if json {
        return Ok(print_json(&Calibrated { print_time_s })?);
    }
    let mut text = format!(
        "{}: a tower for each thickness and exposure; prints in {}\nrow, from the front    column, from the left, the bump at \
         the first tower's left",
        output.name(),
        duration(print_time_s)
    );
    for (row, thickness_mm) in thickness_mm.iter().enumerate() {
        let _ = write!(text, "\n{}  {thickness_mm} mm  ", row + 1);
        for exposure_s in exposure_s {
            let _ = write!(text, "{exposure_s:>8} s");
        }
    }
    text.push_str(
        "\nIn each row take the tower whose ridges and slots of the same width look alike: with less exposure ridges are \
         missing, with more slots are closed.\nThen: cusp calibrate resin MM=S … --resin RESIN.json -o RESIN.json",
    );
    Ok(print(&text)?)
}

/// Writes the print file, and returns its print time in seconds.
fn write(calibration: &Calibration, output: &Output<'_>) -> Result<f64, Failure> {
    stop_on_interrupt();
    output.write(|writer| {
        let bar = Bar::new();
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let written = pollster::block_on(calibration.write(writer, &mut progress));
        let (writer, report) = written.map_err(|error| output.failure(&error))?;
        Ok((writer, report.print_time_s))
    })
}

fn resin_file(
    measured: &[[f64; 2]],
    resin: Option<&Path>,
    output: &Output<'_>,
    json: bool,
) -> Result<(), Failure> {
    let mut resin = read_resin(resin)?;
    // A pair for a thickness that has one replaces it.
    resin
        .exposures
        .retain(|known| measured.iter().all(|pair| pair[0] != known[0]));
    resin.exposures.extend(measured);
    resin.exposures.sort_by(|a, b| a[0].total_cmp(&b[0]));
    resin.check().map_err(|error| output.failed(&error))?;
    let text = serde_json::to_string_pretty(&resin).map_err(|error| output.failed(&error))?;
    output.write_bytes((text + "\n").as_bytes())?;
    if json {
        return Ok(print_json(&resin)?);
    }
    let pairs = resin.exposures.iter();
    let pairs: Vec<String> = pairs.map(|[mm, s]| format!("{mm} mm {s} s")).collect();
    Ok(print(&format!("{}: {}", output.name(), pairs.join(", ")))?)
}
