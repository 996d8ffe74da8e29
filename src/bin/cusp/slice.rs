//! Plans and print files.

use std::fmt::Write as _;
use std::path::Path;

use cusp_slicer::filament::FilamentReport;
use cusp_slicer::job::{
    Backend, BestUniform, Comparison, FrontPoint, Options, PlannerReport, Report, Slicer,
    StageProgress,
};
use cusp_slicer::profile::Metric;
use serde::Serialize;

use crate::arguments::{Settings, Slicing, Studying};
use crate::batch::{Batch, check_inputs, outputs_in, workers};
use crate::export::{export, export_plugs};
use crate::files::{Failure, Output, is_folder, make_folder};
use crate::plate;
use crate::terminal::{Bar, duration, open_gpu, print, print_json, warn};
use crate::usage::{check_json, wrong_usage};
use crate::watch::{keep_within, stop_on_interrupt};

pub fn slice(slicing: &Slicing, output: &Path) -> Result<(), Failure> {
    keep_within(&slicing.budget);
    slicing.choices.check("slice");
    check_inputs("slice", &slicing.models);
    check_meshes("slice", slicing);
    if let Some(job) = plate::job("slice", slicing)? {
        return plate::slice(job, slicing, output);
    }
    if is_folder(output) {
        return slice_all(slicing, output);
    }
    let [model] = &*slicing.models else {
        let message = "several models become a print file each, in a folder: -o prints/; or one in all: --arrange";
        wrong_usage("slice", message);
    };
    check_json("slice", Some(output), slicing.json);
    let output = Output::new(output, Some(model), "model")?;
    let settings = slicing.choices.settings()?;
    let mut slicer = slicing.load(model, &settings, 1)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let report = slice_one(&mut slicer, model, &settings, &output, &mut progress)?;
    drop(bar);
    write_meshes(slicing, &slicer)?;
    show(slicing, &report)
}

pub fn plan(slicing: &Slicing) -> Result<(), Failure> {
    keep_within(&slicing.budget);
    slicing.choices.check("plan");
    check_inputs("plan", &slicing.models);
    check_meshes("plan", slicing);
    if let Some(job) = plate::job("plan", slicing)? {
        return plate::plan(job, slicing);
    }
    let [model] = &*slicing.models else {
        return plan_all(slicing);
    };
    let settings = slicing.choices.settings()?;
    let mut slicer = slicing.load(model, &settings, 1)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let report = make_plan(&mut slicer, model, &settings.options, &mut progress)?.clone();
    drop(bar);
    write_meshes(slicing, &slicer)?;
    show(slicing, &report)
}

/// Meshes are written of one model.
fn check_meshes(command: &str, slicing: &Slicing) {
    if slicing.models.len() < 2 && !slicing.arrange {
        return;
    }
    for (file, option) in [(&slicing.export, "--export"), (&slicing.plugs, "--plugs")] {
        if file.is_some() {
            let message = format!("{option} is of one model: name one, without --arrange");
            wrong_usage(command, &message);
        }
    }
}

fn write_meshes(slicing: &Slicing, slicer: &Slicer) -> Result<(), Failure> {
    if let Some(file) = &slicing.export {
        export(slicer, file)?;
    }
    if let Some(file) = &slicing.plugs {
        export_plugs(slicer, file)?;
    }
    Ok(())
}

/// Slices each model into a print file in a folder.
fn slice_all(slicing: &Slicing, folder: &Path) -> Result<(), Failure> {
    let settings = slicing.choices.settings()?;
    // Wrong options are wrong for every model: they are reported once.
    let print_file = settings.options.print_file();
    let print_file = print_file.map_err(|error| error.to_string())?;
    make_folder(folder)?;
    let batch = Batch {
        outputs: outputs_in(folder, &slicing.models, &print_file.extension)?,
        ..batch_of(slicing, &settings)
    };
    let outputs = batch.outputs.iter().zip(batch.models);
    let outputs = outputs.map(|(output, model)| Output::new(output, Some(model), "model"));
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    batch.run(|place, progress| {
        let model = &batch.models[place];
        let mut slicer = slicing.load(model, &settings, batch.at_a_time())?;
        slice_one(&mut slicer, model, &settings, &outputs[place], progress)
    })
}

/// Plans each model.
fn plan_all(slicing: &Slicing) -> Result<(), Failure> {
    let settings = slicing.choices.settings()?;
    let options = &settings.options;
    options.check().map_err(|error| error.to_string())?;
    let batch = batch_of(slicing, &settings);
    batch.run(|place, progress| {
        let model = &batch.models[place];
        let mut slicer = slicing.load(model, &settings, batch.at_a_time())?;
        make_plan(&mut slicer, model, options, progress).cloned()
    })
}

fn batch_of<'a>(slicing: &'a Slicing, settings: &Settings) -> Batch<'a> {
    Batch {
        models: &slicing.models,
        outputs: Vec::new(),
        is_json: slicing.json,
        workers: match settings.options.backend {
            // A GPU works on one model at a time.
            Backend::Gpu => 1,
            Backend::Auto | Backend::Cpu => workers(),
        },
    }
}

/// Plans a model and writes its print file.
fn slice_one(
    slicer: &mut Slicer,
    model: &Path,
    settings: &Settings,
    output: &Output<'_>,
    progress: &mut StageProgress<'_>,
) -> Result<Report, Failure> {
    output.write(|writer| {
        make_plan(slicer, model, &settings.options, progress)?;
        let written = slicer.write_archive(writer, progress);
        let (writer, report) = written.map_err(|error| output.failure(&error))?;
        Ok((writer, report.clone()))
    })
}

/// Makes the plan that the options ask for.
pub fn make_plan<'a>(
    slicer: &'a mut Slicer,
    model: &Path,
    options: &Options,
    progress: &mut StageProgress<'_>,
) -> Result<&'a Report, Failure> {
    open_gpu(slicer, options.backend);
    pollster::block_on(slicer.plan(options, progress))
        .map_err(|error| Failure::in_file(model, &error))
}

fn show(slicing: &Slicing, report: &Report) -> Result<(), Failure> {
    warn(&report.warnings);
    if slicing.json {
        print_json(report)?;
    } else {
        print(&describe_plan(report))?;
    }
    Ok(())
}

fn describe_plan(report: &Report) -> String {
    match &report.print_file.filament {
        Some(filament) => describe_filament(report, filament),
        None => describe_resin(report),
    }
}

/// A plan for a filament printer: what masks, exposures and resin mean nothing for, and what to set in the slicer.
fn describe_filament(report: &Report, filament: &FilamentReport) -> String {
    let words = |error| report.metric.format(error);
    let [thinnest, thickest] = thinnest_and_thickest(report);
    format!(
        "layers    {} of {thinnest:.3} to {thickest:.3} mm, {:.3} mm in total\n\
         uniform   {}\n\
         error     {} above the first layer, tolerance {}\n\
         deviation {} from the model at most\n\
         planes    {} at flats and sharp changes\n\
         sampled   {} hits on {}, {:.0} ms in total\n\
         slicer    {filament}",
        report.layers,
        report.height_mm,
        describe_uniform(report),
        words(report.max_error),
        words(report.tolerance),
        Metric::Deviation.format(report.max_deviation_mm),
        report.snapped_mm.len(),
        report.hits,
        report.adapter.as_deref().unwrap_or("the CPU"),
        report.timings_ms.total,
    )
}

/// Uniform layers: the best within tolerance and the change from them to the plan, and those of the thinnest and the thickest.
fn describe_uniform(report: &Report) -> String {
    let uniform = &report.uniform;
    let best = match uniform.best(report.options.minimize) {
        Some(BestUniform {
            layers, layer_mm, ..
        }) => {
            let change = |own: f64, of: f64| format!("{:+.0} %", (own / of - 1.0) * 100.0);
            let fewest = uniform.fewest.map_or(f64::NAN, |it| it.layers as f64);
            let quickest = uniform.quickest.map_or(f64::NAN, |it| it.print_time_s);
            format!(
                "{layers} of {layer_mm:.3} mm at best within tolerance; this plan: {} layers, {} time{}",
                change(report.layers as f64, fewest),
                change(report.print_time_s, quickest),
                if uniform.is_enough {
                    format!(" (--planner uniform --layer {layer_mm:.3} does about as well)")
                } else {
                    String::new()
                }
            )
        }
        None => "none within tolerance".to_owned(),
    };
    let end = |it: &PlannerReport, name: &str| {
        let error = report.metric.format(it.max_error);
        format!("{} at {name} thickness (error {error})", it.layers)
    };
    format!(
        "{best}\n          {}, {}",
        end(&uniform.finest, "minimum"),
        end(&uniform.coarsest, "maximum")
    )
}

fn thinnest_and_thickest(report: &Report) -> [f64; 2] {
    let thickness_mm = report.thickness_mm.iter();
    thickness_mm.fold([f64::INFINITY, 0.0], |[low, high], &layer_mm| {
        [low.min(layer_mm), high.max(layer_mm)]
    })
}

fn describe_resin(report: &Report) -> String {
    let [thinnest, thickest] = thinnest_and_thickest(report);
    let words = |error| report.metric.format(error);
    let unweighted = match report.true_error {
        error if error == report.max_error => String::new(),
        error => format!(" ({} without weights and caps)", words(error)),
    };
    format!(
        "layers    {} of {thinnest:.3} to {thickest:.3} mm, {:.3} mm in total\n\
         time      {}, {:.1} ml of resin\n\
         uniform   {}\n\
         error     {} on the mesh{unweighted}, {} as sampled, tolerance {}\n\
         deviation {} from the model at most\n\
         planes    {} at flats and sharp changes\n\
         masks     {} × {} pixels of {:.4} mm\n\
         sampled   {} hits on {}, {:.0} ms in total",
        report.layers,
        report.height_mm,
        duration(report.print_time_s),
        report.resin_ml,
        describe_uniform(report),
        words(report.max_error),
        words(report.sampled_error),
        words(report.tolerance),
        Metric::Deviation.format(report.max_deviation_mm),
        report.snapped_mm.len(),
        report.mask.width,
        report.mask.height,
        report.mask.pitch_mm,
        report.hits,
        report.adapter.as_deref().unwrap_or("the CPU"),
        report.timings_ms.total,
    )
}

/// Loads the model and runs `ask`, which makes no plan, with a progress bar.
fn study<T>(
    studying: &Studying,
    settings: &Settings,
    ask: impl AsyncFnOnce(&mut Slicer, &mut StageProgress<'_>) -> Result<T, cusp_slicer::Error>,
) -> Result<T, Failure> {
    let mut slicer = settings.reading.load(&studying.model)?;
    stop_on_interrupt();
    open_gpu(&mut slicer, settings.options.backend);
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    pollster::block_on(ask(&mut slicer, &mut progress))
        .map_err(|error| Failure::in_file(&studying.model, &error))
}

pub fn tradeoff(studying: &Studying, points: usize) -> Result<(), Failure> {
    studying.choices.check("tradeoff");
    let settings = studying.choices.settings()?;
    let options = &settings.options;
    let curve = study(studying, &settings, async |slicer, progress| {
        slicer.tradeoff(options, points, progress).await
    })?;
    if studying.json {
        return Ok(print_json(&curve)?);
    }
    let mut text = format!(
        "tolerance     layers  largest error  time\n{:>9}",
        options.metric.unit()
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
    Ok(print(&text)?)
}

/// What `compare` prints as JSON.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Compared {
    #[serde(flatten)]
    comparison: Comparison,
    front: Vec<FrontPoint>,
}

/// Numbers of layers for which `compare` shows the front.
const FRONT_POINTS: usize = 9;

pub fn compare(studying: &Studying) -> Result<(), Failure> {
    studying.choices.check("compare");
    let settings = studying.choices.settings()?;
    let options = &settings.options;
    let (comparison, front) = study(studying, &settings, async |slicer, progress| {
        let comparison = slicer.compare(options, progress).await?;
        let front = slicer.front(options, FRONT_POINTS, progress).await?;
        Ok((comparison, front))
    })?;
    if studying.json {
        return Ok(print_json(&Compared { comparison, front })?);
    }
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
    for point in &front {
        let (sum, maximum) = (&point.least_sum, &point.least_maximum);
        let _ = write!(
            text,
            "\n{:>6}  {:<8.2}  {:<16.5}    {:<8.2}  {:.5}",
            point.layers, sum.volume_mm3, sum.max_error, maximum.volume_mm3, maximum.max_error
        );
    }
    Ok(print(&text)?)
}
