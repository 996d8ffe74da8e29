//! Writes the section of each layer of a plan as polygons.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::contour::cli::Cli;
use cusp_slicer::contour::svg::Svg;
use cusp_slicer::contour::{Contours, ContoursReport, Copies, Heading, Lattice, LayerHeights, cut};
use cusp_slicer::progress::Cancelled;
use serde::Serialize;

use crate::budget::Budget;
use crate::failure::Failure;
use crate::files::{Output, Writer, numbered};
use crate::job::{LoadedJob, Printing};
use crate::progress::Bar;
use crate::terminal::{print, print_json};
use crate::values::not_negative;
use crate::watch::stop_on_interrupt;

/// Models, how to slice them, and where to write their contours.
#[derive(Args)]
pub struct Contouring {
    #[command(flatten)]
    pub printing: Printing,
    /// Contour file: FILE.svg, or FILE.cli (Common Layer Interface); with several plates, each name has the plate's number
    #[arg(short, long, value_name = "FILE", value_parser = contour_file)]
    output: PathBuf,
    /// Leave out points of contours where the outline moves by at most this; 0 keeps all
    #[arg(long, value_name = "MM", default_value_t = 0.005, value_parser = not_negative, help_heading = "Contours")]
    simplify: f64,
}

/// The JSON of `contours`.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Contoured {
    /// The contours of each plate.
    plates: Vec<ContoursReport>,
}

fn contour_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match is_svg(&path) {
        Some(_) => Ok(path),
        None => Err("expected the name of a file that ends in .svg or .cli".to_owned()),
    }
}

/// Returns true if a file is an SVG; `None` if it is no CLI file either.
fn is_svg(path: &Path) -> Option<bool> {
    let extension = path.extension()?;
    let is = |other| extension.eq_ignore_ascii_case(other);
    (is("svg") || is("cli")).then(|| is("svg"))
}

/// Writes the contours of each plate.
pub fn contours(contouring: &Contouring) -> Result<(), Failure> {
    let Contouring {
        printing, output, ..
    } = contouring;
    printing.check("contours");
    // Outputs that cannot be written are reported before anything is planned.
    let alone = Output::new(output, printing.first(), "model")?;
    let mut job = printing.read("contours", &Budget::default())?;
    stop_on_interrupt();
    let bar = Bar::new();
    let plan = job.plan(&mut |stage, fraction| bar.report(stage, fraction))?;
    let files = numbered(output, plan.plates.len());
    let outputs = match &files[..] {
        [_] => vec![alone],
        files => {
            let outputs = files.iter().map(|file| Output::new(file, None, "model"));
            outputs.collect::<Result<_, _>>()?
        }
    };
    let plates = outputs.iter().enumerate().map(|(plate, output)| {
        output.write(|writer| write(contouring, &job, plate, output, writer, &bar))
    });
    let plates = plates.collect::<Result<Vec<_>, _>>()?;
    drop(bar);
    job.warn(&plan);
    if printing.json {
        return Ok(print_json(&Contoured { plates })?);
    }
    let texts = plates.iter().zip(&files).map(|(report, file)| {
        let text = format!(
            "layers    {}, cut at their middles\n\
             polygons  {} with {} holes, {} points\n\
             volume    {:.1} mm³",
            report.layers, report.polygons, report.holes, report.points, report.volume_mm3
        );
        match files.len() {
            1 => text,
            _ => format!("{}\n{text}", file.display()),
        }
    });
    Ok(print(&texts.collect::<Vec<_>>().join("\n\n"))?)
}

fn write(
    contouring: &Contouring,
    job: &LoadedJob,
    plate: usize,
    output: &Output<'_>,
    writer: Writer,
    bar: &Bar,
) -> Result<(Writer, ContoursReport), Failure> {
    let planned = job.job.planned(plate);
    let (meshes, plan) = planned.map_err(|error| job.failure(&error))?;
    let places = job.job.places_mm(plate);
    let places = places.map_err(|error| job.failure(&error))?;
    let copies = meshes.into_iter().zip(places);
    let copies: Vec<_> = copies
        .map(|(mesh, places_mm)| Copies { mesh, places_mm })
        .collect();
    let (bounds, layers) = (Copies::bounds(&copies), LayerHeights::of(plan));
    let lattice = Lattice::of(&bounds);
    let names = job.models.iter().map(|model| model.file.file_name());
    let names = names.map(|name| name.unwrap_or_default().to_string_lossy());
    let heading = Heading {
        title: &names.collect::<Vec<_>>().join(", "),
        lattice,
        bounds,
        layers: layers.len(),
    };
    let failed = |error: io::Error| output.failed(&error);
    let is_svg = is_svg(&contouring.output) == Some(true);
    let mut file = File::begin(is_svg, writer, heading).map_err(failed)?;
    let mut report = ContoursReport::new(lattice, contouring.simplify);
    let mut progress = |fraction| bar.show("contours", fraction);
    let cut = cut(
        &copies,
        &layers,
        contouring.simplify,
        &mut progress,
        |layer| {
            report.add(&layer);
            file.write(&layer).map_err(Stop::Write)
        },
    );
    cut.map_err(|stop| match stop {
        Stop::Cancelled => Failure::interrupted(),
        Stop::Write(error) => failed(error),
    })?;
    Ok((file.end().map_err(failed)?, report))
}

/// Reason for which cutting stops early.
enum Stop {
    Cancelled,
    Write(io::Error),
}

impl From<Cancelled> for Stop {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A file of contours under way.
enum File<'a, W> {
    Svg(Svg<'a, W>),
    Cli(Cli<'a, W>),
}

impl<'a, W: Write> File<'a, W> {
    fn begin(is_svg: bool, writer: W, heading: Heading<'a>) -> io::Result<Self> {
        Ok(if is_svg {
            Self::Svg(Svg::begin(writer, heading)?)
        } else {
            Self::Cli(Cli::begin(writer, heading)?)
        })
    }

    fn write(&mut self, contours: &Contours) -> io::Result<()> {
        match self {
            Self::Svg(svg) => svg.write(contours),
            Self::Cli(cli) => cli.write(contours),
        }
    }

    fn end(self) -> io::Result<W> {
        match self {
            Self::Svg(svg) => svg.end(),
            Self::Cli(cli) => cli.end(),
        }
    }
}
