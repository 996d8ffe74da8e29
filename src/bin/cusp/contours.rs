//! Writes the section of each layer of a plan as polygons.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::contour::cli::Cli;
use cusp_slicer::contour::svg::Svg;
use cusp_slicer::contour::{Contours, ContoursReport, Heading, Lattice, LayerHeights, cut};
use cusp_slicer::job::Job;
use cusp_slicer::progress::Cancelled;

use crate::arguments::Studying;
use crate::budget::Budget;
use crate::files::{Failure, Output, Writer};
use crate::job::LoadedJob;
use crate::terminal::{Bar, print, print_json};
use crate::values::not_negative;
use crate::watch::stop_on_interrupt;

/// A model, how to slice it, and where to write its contours.
#[derive(Args)]
pub struct Contouring {
    #[command(flatten)]
    pub studying: Studying,
    /// Where to write the contours: FILE.svg, or FILE.cli in the Common Layer Interface
    #[arg(short, long, value_name = "FILE", value_parser = contour_file)]
    output: PathBuf,
    /// Leave out points of contours where the outline moves by at most this; 0 keeps all
    #[arg(long, value_name = "MM", default_value_t = 0.005, value_parser = not_negative, help_heading = "Contours")]
    simplify: f64,
}

fn contour_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match is_svg(&path) {
        Some(_) => Ok(path),
        None => Err("expected the name of a file that ends in .svg or .cli".to_owned()),
    }
}

/// Whether a file is an SVG; `None` if it is no CLI file either.
fn is_svg(path: &Path) -> Option<bool> {
    let extension = path.extension()?;
    let is = |other| extension.eq_ignore_ascii_case(other);
    (is("svg") || is("cli")).then(|| is("svg"))
}

pub fn contours(contouring: &Contouring) -> Result<(), Failure> {
    let Contouring {
        studying, output, ..
    } = contouring;
    studying.choices.check("contours");
    let model = &*studying.model;
    let is_svg = is_svg(output) == Some(true);
    let output = Output::new(output, Some(model), "model")?;
    let settings = studying.choices.settings()?;
    let mut job = LoadedJob::alone(model, &settings, &Budget::default(), 1)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let (plan, report) = output.write(|writer| {
        let plan = job.plan(&mut |stage, fraction| bar.report(stage, fraction))?;
        let (writer, report) = write(contouring, &job.job, &output, is_svg, writer, &bar)?;
        Ok((writer, (plan, report)))
    })?;
    drop(bar);
    job.warn(&plan);
    if studying.json {
        return Ok(print_json(&report)?);
    }
    Ok(print(&format!(
        "layers    {}, cut at their middles\n\
         polygons  {} with {} holes, {} points\n\
         volume    {:.1} mm³",
        report.layers, report.polygons, report.holes, report.points, report.volume_mm3
    ))?)
}

fn write(
    contouring: &Contouring,
    job: &Job,
    output: &Output<'_>,
    is_svg: bool,
    writer: Writer,
    bar: &Bar,
) -> Result<(Writer, ContoursReport), Failure> {
    let model = &contouring.studying.model;
    let (meshes, plan) = job
        .planned(0)
        .map_err(|error| Failure::in_file(model, &error))?;
    let mesh = meshes[0];
    let (bounds, layers) = (mesh.bounds(), LayerHeights::of(plan));
    let lattice = Lattice::of(&bounds);
    let title = model.file_name().unwrap_or_default().to_string_lossy();
    let heading = Heading {
        title: &title,
        lattice,
        bounds,
        layers: layers.len(),
    };
    let failed = |error: io::Error| output.failed(&error);
    let mut file = File::begin(is_svg, writer, heading).map_err(failed)?;
    let mut report = ContoursReport::new(lattice, contouring.simplify);
    let mut progress = |fraction| bar.show("contours", fraction);
    let cut = cut(mesh, &layers, contouring.simplify, &mut progress, |layer| {
        report.add(&layer);
        file.write(&layer).map_err(Stop::Write)
    });
    cut.map_err(|stop| match stop {
        Stop::Cancelled => Failure::interrupted(),
        Stop::Write(error) => failed(error),
    })?;
    Ok((file.end().map_err(failed)?, report))
}

/// Why cutting stops early.
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
