//! The curve of quality, and planners side by side: of each plate, without a plan.

use std::fmt::Write as _;

use cusp_slicer::Error;
use cusp_slicer::job::{Backend, Comparison, FrontPoint, Job, JobOptions, StageProgress};
use serde::Serialize;

use crate::budget::Budget;
use crate::failure::Failure;
use crate::job::{LoadedJob, Printing};
use crate::progress::Bar;
use crate::terminal::{duration, open_gpu, print, print_json};
use crate::watch::stop_on_interrupt;

/// The JSON of a command that studies plates.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Studied<T> {
    /// The answer for each plate.
    plates: Vec<T>,
}

/// The planners of a plate.
#[derive(Serialize, schemars::JsonSchema)]
pub struct ComparedPlate {
    #[serde(flatten)]
    comparison: Comparison,
    front: Vec<FrontPoint>,
}

/// Numbers of layers for which `compare` shows the front.
const FRONT_POINTS: usize = 9;

/// Prints the curve of each plate.
pub fn tradeoff(printing: &Printing, points: usize) -> Result<(), Failure> {
    let (curves, job) = study(
        "tradeoff",
        printing,
        async |job, plate, options, progress| job.tradeoff(plate, options, points, progress).await,
    )?;
    show(printing, curves, |curve| {
        let mut text = format!(
            "tolerance     layers  largest error  time\n{:>9}",
            job.options.options.metric.unit()
        );
        for point in &curve.points {
            let _ = write!(
                text,
                "\n{:<12.5} {:>7}  {:<13.5}  {}",
                point.tolerance,
                point.layers,
                point.max_error,
                duration(point.print_time_s)
            );
        }
        text
    })
}

/// Prints the planners of each plate.
pub fn compare(printing: &Printing) -> Result<(), Failure> {
    let (compared, _) = study(
        "compare",
        printing,
        async |job, plate, options, progress| {
            Ok(ComparedPlate {
                comparison: job.compare(plate, options, progress).await?,
                front: job.front(plate, options, FRONT_POINTS, progress).await?,
            })
        },
    )?;
    show(printing, compared, describe_planners)
}

/// Reads the job and asks about each plate, with a progress bar.
fn study<T>(
    command: &str,
    printing: &Printing,
    mut ask: impl AsyncFnMut(&mut Job, usize, &JobOptions, &mut StageProgress<'_>) -> Result<T, Error>,
) -> Result<(Vec<T>, LoadedJob), Failure> {
    printing.check(command);
    let mut job = printing.read(command, &Budget::default())?;
    stop_on_interrupt();
    if job.options.options.backend == Backend::Gpu {
        open_gpu(&mut job.job);
    }
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let mut answers = Vec::new();
    for plate in 0..job.plates()? {
        let answer = pollster::block_on(ask(&mut job.job, plate, &job.options, &mut progress));
        answers.push(answer.map_err(|error| job.failure(&error))?);
    }
    Ok((answers, job))
}

fn show<T: Serialize>(
    printing: &Printing,
    plates: Vec<T>,
    describe: impl Fn(&T) -> String,
) -> Result<(), Failure> {
    if printing.json {
        return Ok(print_json(&Studied { plates })?);
    }
    let count = plates.len();
    let texts = plates.iter().enumerate().map(|(plate, it)| match count {
        1 => describe(it),
        _ => format!("plate {} of {count}\n{}", plate + 1, describe(it)),
    });
    Ok(print(&texts.collect::<Vec<_>>().join("\n\n"))?)
}

fn describe_planners(ComparedPlate { comparison, front }: &ComparedPlate) -> String {
    let mut text = format!(
        "{} facets, {} mm high\nplanner      layers  largest error  time",
        comparison.facets, comparison.height_mm
    );
    for row in &comparison.rows {
        let _ = write!(
            text,
            "\n{:<11} {:>7}  {:<13}  {}",
            row.planner,
            row.layers,
            comparison.metric.format(row.max_error),
            duration(row.print_time_s)
        );
    }
    let unit = comparison.metric.unit();
    let _ = write!(
        text,
        "\n\n        least sum of volume error      smallest largest error\n\
         layers  sum, mm³  largest error{unit:>3}    sum, mm³  largest error{unit:>3}",
    );
    for point in front {
        let (sum, maximum) = (&point.least_sum, &point.least_maximum);
        let _ = write!(
            text,
            "\n{:>6}  {:<8.2}  {:<16.5}    {:<8.2}  {:.5}",
            point.layers, sum.volume_mm3, sum.max_error, maximum.volume_mm3, maximum.max_error
        );
    }
    text
}
