//! Prints that measure a printer, and the resin file that their result goes into.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use cusp_slicer::calibration::Calibration;
use cusp_slicer::cure::{Bridge, CureFit, FEWEST_BRIDGES, fit};
use cusp_slicer::resin::PrintThrough;
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
    /// Write bridges of 1 to 8 layers to measure with a caliper, which show how deep layers cure below themselves
    Cure {
        /// Layer thicknesses of the front and the back row
        #[arg(long, value_name = "MM,MM", value_delimiter = ',', value_parser = length, num_args = 2, default_values_t = Calibration::BRIDGES_MM)]
        thicknesses: Vec<f64>,
        #[command(flatten)]
        target: Target,
        /// Print file to write
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
    /// Put measured exposures, or what measured bridges say about cure, into a resin file
    Resin {
        /// A thickness and its exposure, such as 0.05=2.4
        #[arg(required_unless_present = "bridges", value_name = "MM=S", value_parser = measured)]
        measured: Vec<[f64; 2]>,
        /// Layer thickness, then measured thicknesses of the bridges of 1, 2, 3, 4, 6 and 8 layers, such as
        /// 0.05=0.16,0.24,0.31,0.37,0.49,0.60; a dash for a missing bridge; repeatable. The resin is the one that they were
        /// printed with
        #[arg(long = "bridges", value_name = "MM=MM,MM,...", value_parser = bridges)]
        bridges: Vec<Bridges>,
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
            Self::Layers { json, .. }
            | Self::Exposure { json, .. }
            | Self::Cure { json, .. }
            | Self::Resin { json, .. } => *json,
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
    | Calibrating::Cure { output, .. }
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
        Calibrating::Cure {
            thicknesses,
            target,
            ..
        } => cure(target, thicknesses, output, json),
        Calibrating::Resin {
            measured,
            bridges,
            resin,
            ..
        } => resin_file(measured, bridges, resin.as_deref(), output, json),
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

fn cure(
    target: &Target,
    thickness_mm: &[f64],
    output: &Output<'_>,
    json: bool,
) -> Result<(), Failure> {
    let &[front_mm, back_mm] = thickness_mm else {
        return Err(output.failed(&"--thicknesses takes two"));
    };
    let calibration = Calibration::cure(&target.options()?, [front_mm, back_mm]);
    let calibration = calibration.map_err(|error| output.failure(&error))?;
    let print_time_s = write(&calibration, output)?;
    if json {
        return Ok(print_json(&Calibrated { print_time_s })?);
    }
    Ok(print(&format!(
        "{}: bridges of 1, 2, 3, 4, 6 and 8 layers of {front_mm} mm in front and {back_mm} mm behind; prints in {}\n\
         Measure the thickness of each with a caliper once it is washed and cured.\n\
         Then: cusp calibrate resin --bridges {front_mm}=MM,MM,MM,MM,MM,MM --bridges {back_mm}=MM,… --resin RESIN.json -o RESIN.json",
        output.name(),
        duration(print_time_s)
    ))?)
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
    bridges: &[Bridges],
    resin: Option<&Path>,
    output: &Output<'_>,
    json: bool,
) -> Result<(), Failure> {
    let mut resin = read_resin(resin)?;
    let found = if bridges.is_empty() {
        None
    } else {
        resin.check().map_err(|error| output.failed(&error))?;
        let bridges: Vec<Bridge> = bridges.iter().flat_map(|it| it.0.clone()).collect();
        let few = format!(
            "{} bridges are too few; measure {FEWEST_BRIDGES} or more, of several numbers of layers",
            bridges.len()
        );
        Some(fit(&bridges, &resin).ok_or_else(|| output.failed(&few))?)
    };
    if let Some(found) = &found {
        // To the micrometre and the hundredth: beyond what a caliper tells.
        let round = |value: f64, to: f64| (value * to).round() / to;
        resin.penetration_mm = round(found.penetration_mm, 1e3);
        resin.print_through = Some(PrintThrough {
            overcure_mm: round(found.print_through.overcure_mm, 1e3),
            retained: round(found.print_through.retained, 1e2),
        });
    }
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
    if let Some(found) = &found {
        return Ok(print(&describe_fit(found, &output.name().to_string()))?);
    }
    let pairs = resin.exposures.iter();
    let pairs: Vec<String> = pairs.map(|[mm, s]| format!("{mm} mm {s} s")).collect();
    Ok(print(&format!("{}: {}", output.name(), pairs.join(", ")))?)
}

fn describe_fit(found: &CureFit, name: &str) -> String {
    let within = |[low, high]: [f64; 2]| format!("{low:.3} to {high:.3}");
    format!(
        "{name}: bridges fit to {:.3} mm\n\
         penetration_mm  {:.3} ({})\n\
         overcure_mm     {:.3} ({})\n\
         retained        {:.2} ({})",
        found.residual_mm,
        found.penetration_mm,
        within(found.penetration_within_mm),
        found.print_through.overcure_mm,
        within(found.overcure_within_mm),
        found.print_through.retained,
        within(found.retained_within),
    )
}

/// The measured bridges of one thickness of layers.
#[derive(Debug, Clone)]
pub struct Bridges(Vec<Bridge>);

/// Bridges as typed: the thickness of their layers, and their own for each number of layers of the piece.
fn bridges(text: &str) -> Result<Bridges, String> {
    let wanted = "such as 0.05=0.16,0.24,0.31,0.37,0.49,0.60";
    let (layer, measured) = text.split_once('=').ok_or(wanted)?;
    let layer_mm = length(layer)?;
    let mut found = Vec::new();
    let counts = Calibration::BRIDGES.iter();
    let texts: Vec<&str> = measured.split(',').map(str::trim).collect();
    if texts.len() > counts.len() {
        return Err(format!("at most {} thicknesses, {wanted}", counts.len()));
    }
    for (&layers, text) in counts.zip(texts) {
        if text != "-" {
            found.push(Bridge {
                layer_mm,
                layers: u32::from(layers),
                measured_mm: length(text)?,
            });
        }
    }
    Ok(Bridges(found))
}
