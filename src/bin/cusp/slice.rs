//! Plans and print files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use cusp_slicer::filament::FilamentReport;
use cusp_slicer::job::{
    Backend, BestUniform, Job, JobReport, PlannerReport, Report, StageProgress,
};
use cusp_slicer::profile::Metric;

use crate::arguments::{Settings, Slicing};
use crate::batch::{Batch, check_inputs, outputs_in, workers};
use crate::export::{export, export_plugs};
use crate::failure::{Failure, in_file, is_standard};
use crate::files::{Output, is_folder, make_folder, numbered};
use crate::job::LoadedJob;
use crate::job_file::JobFile;
use crate::progress::Bar;
use crate::terminal::{duration, print, print_json};
use crate::usage::{check_json, wrong_usage};
use crate::watch::stop_on_interrupt;

pub fn slice(slicing: &Slicing, output: &Path) -> Result<(), Failure> {
    slicing.budget.keep();
    slicing.choices.check("slice");
    check_inputs("slice", &slicing.models);
    slicing.check_meshes("slice", slicing.models.len());
    let is_plate = slicing.is_plate("slice")?;
    if !is_plate && is_folder(output) {
        return slice_all(slicing, output);
    }
    if !is_plate && slicing.models.len() > 1 {
        let message = "several models become a print file each, in a folder: -o prints/; or one in all: --arrange";
        wrong_usage("slice", message);
    }
    check_json("slice", Some(output), slicing.json);
    // Outputs that cannot be written are reported before anything is planned.
    let [first, ..] = &*slicing.models else {
        return Ok(());
    };
    let file = (!is_folder(output)).then(|| Output::new(output, Some(first), "model"));
    let file = file.transpose()?;
    let mut job = slicing.read("slice")?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut report = job.plan(&mut |stage, fraction| bar.report(stage, fraction))?;
    let files = match file {
        Some(_) if report.plates.len() == 1 => Vec::new(),
        _ => files_of(&job, output, report.plates.len())?,
    };
    let further = files.iter().map(|file| Output::new(file, None, "model"));
    let outputs = match file {
        Some(file) if files.is_empty() => vec![file],
        _ => further.collect::<Result<_, _>>()?,
    };
    for (plate, output) in outputs.iter().enumerate() {
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        report.plates[plate] = write_plate(&mut job.job, plate, output, &mut progress)?;
    }
    drop(bar);
    write_meshes(slicing, &job)?;
    show(slicing, &job, &report)
}

pub fn plan(slicing: &Slicing) -> Result<(), Failure> {
    slicing.budget.keep();
    slicing.choices.check("plan");
    check_inputs("plan", &slicing.models);
    slicing.check_meshes("plan", slicing.models.len());
    if !slicing.is_plate("plan")? && slicing.models.len() > 1 {
        return plan_all(slicing);
    }
    let mut job = slicing.read("plan")?;
    stop_on_interrupt();
    let bar = Bar::new();
    let report = job.plan(&mut |stage, fraction| bar.report(stage, fraction))?;
    drop(bar);
    write_meshes(slicing, &job)?;
    show(slicing, &job, &report)
}

impl Slicing {
    /// Returns true if the models stand on plates: those that are arranged, or those of a job file.
    fn is_plate(&self, command: &str) -> Result<bool, Failure> {
        let is_file = JobFile::is(&self.models)?;
        if !is_file && !self.arrange && self.places.are_given() {
            let message = "--copies, --spacing and --turn are for plates: add --arrange";
            wrong_usage(command, message);
        }
        Ok(is_file || self.arrange)
    }

    /// Refuses files of one mesh where there are several models.
    fn check_meshes(&self, command: &str, models: usize) {
        for (file, option) in [(&self.export, "--export"), (&self.plugs, "--plugs")] {
            if models > 1 && file.is_some() {
                let message = format!("{option} is of one model: name one");
                wrong_usage(command, &message);
            }
        }
    }

    fn read(&self, command: &str) -> Result<LoadedJob, Failure> {
        let (places, choices) = (&self.places, &self.choices);
        let mut job = LoadedJob::read(command, &self.models, places, choices, &self.budget)?;
        self.check_meshes(command, job.models.len());
        if self.arrange {
            job.arrange()?;
        }
        Ok(job)
    }
}

/// Writes the print file of a plate. Returns the report with the time that this took.
fn write_plate(
    job: &mut Job,
    plate: usize,
    output: &Output<'_>,
    progress: &mut StageProgress<'_>,
) -> Result<Report, Failure> {
    output.write(|writer| {
        let written = job.write_archive(plate, writer, progress);
        let (writer, report) = written.map_err(|error| output.failure(&error))?;
        Ok((writer, report.clone()))
    })
}

/// The print file of each plate. Those of several have their number in the name.
fn files_of(job: &LoadedJob, output: &Path, plates: usize) -> Result<Vec<PathBuf>, Failure> {
    if is_folder(output) {
        let print_file = job.options.options.print_file();
        let print_file = print_file.map_err(|error| job.failure(&error))?;
        make_folder(output)?;
        let name = |number| output.join(format!("plate-{number}.{}", print_file.extension));
        return Ok((1..=plates).map(name).collect());
    }
    if is_standard(output) {
        let reason = format!("{plates} plates are as many print files; name a folder by -o");
        return Err(in_file(output, &reason).into());
    }
    Ok(numbered(output, plates))
}

/// Meshes are written of one model.
fn write_meshes(slicing: &Slicing, job: &LoadedJob) -> Result<(), Failure> {
    if let Some(file) = &slicing.export {
        export(&job.job, file)?;
    }
    if let Some(file) = &slicing.plugs {
        export_plugs(&job.job, file)?;
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
        let (model, workers) = (&batch.models[place], batch.at_a_time());
        let mut job = LoadedJob::alone(model, &settings, &slicing.budget, workers)?;
        let mut report = job.plan(progress)?;
        report.plates[0] = write_plate(&mut job.job, 0, &outputs[place], progress)?;
        Ok(report)
    })
}

/// Plans each model.
fn plan_all(slicing: &Slicing) -> Result<(), Failure> {
    let settings = slicing.choices.settings()?;
    settings
        .options
        .check()
        .map_err(|error| error.to_string())?;
    let batch = batch_of(slicing, &settings);
    batch.run(|place, progress| {
        let (model, workers) = (&batch.models[place], batch.at_a_time());
        LoadedJob::alone(model, &settings, &slicing.budget, workers)?.plan(progress)
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

fn show(slicing: &Slicing, job: &LoadedJob, report: &JobReport) -> Result<(), Failure> {
    job.warn(report);
    if slicing.json {
        return Ok(print_json(report)?);
    }
    let is_alone = report.plates.len() == 1 && report.plates[0].placements.len() == 1;
    if is_alone && !slicing.arrange {
        return Ok(print(&describe_plan(&report.plates[0]))?);
    }
    Ok(print(&describe_plates(job, report))?)
}

fn describe_plates(job: &LoadedJob, report: &JobReport) -> String {
    let mut text = String::new();
    for plate in &report.plates {
        let _ = writeln!(
            text,
            "plate {} of {}: {} layers, {:.3} mm, {}, {:.1} ml of resin",
            plate.plate + 1,
            plate.plate_count,
            plate.layers,
            plate.height_mm,
            duration(plate.print_time_s),
            plate.resin_ml,
        );
        for model in &plate.models {
            let _ = writeln!(
                text,
                "  {} × {}: {} and {:.1} ml each, error {}",
                model.copies,
                job.name(model.model),
                duration(model.print_time_s),
                model.resin_ml,
                plate.metric.format(model.max_error),
            );
        }
    }
    let _ = write!(
        text,
        "in all {}, {:.1} ml of resin",
        duration(report.print_time_s),
        report.resin_ml
    );
    text
}

fn describe_plan(report: &Report) -> String {
    match &report.print_file.filament {
        Some(filament) => describe_filament(report, filament),
        None => describe_resin(report) + &describe_bottoms(report) + &describe_supports(report),
    }
}

/// A line about surfaces that face down, if the resin states its print-through.
fn describe_bottoms(report: &Report) -> String {
    let Some(found) = &report.print_through else {
        return String::new();
    };
    let (after, before) = (&found.after, &found.before);
    format!(
        "\nbottoms   {:.3} mm off on average and {:.3} at most; {:.3} and {:.3} without compensation for print-through",
        after.mean_mm, after.largest_mm, before.mean_mm, before.largest_mm
    )
}

/// A line about the supports of each model: how many contacts there are, and what the one bears that bears most.
pub fn describe_supports(report: &Report) -> String {
    let supported = report.models.iter().filter_map(|it| it.supported.as_ref());
    let mut text = String::new();
    for supported in supported {
        let _ = write!(text, "\nsupports  {} contacts", supported.points.len());
        if let Some(load) = supported.load {
            let [x, y, z] = load.at_mm;
            let _ = write!(
                text,
                "; at most {:.2} N at a tip that bears {:.2}, at {x:.2}, {y:.2}, {z:.2}",
                load.newtons, load.limit_n
            );
        }
    }
    text
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
        hits(report),
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

fn hits(report: &Report) -> usize {
    report.models.iter().map(|model| model.hits).sum()
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
    let seen = report.sampled_error.map_or_else(String::new, |error| {
        format!(", {} as sampled", words(error))
    });
    format!(
        "layers    {} of {thinnest:.3} to {thickest:.3} mm, {:.3} mm in total\n\
         time      {}, {:.1} ml of resin\n\
         uniform   {}\n\
         error     {} on the mesh{unweighted}{seen}, tolerance {}\n\
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
        words(report.tolerance),
        Metric::Deviation.format(report.max_deviation_mm),
        report.snapped_mm.len(),
        report.mask.width,
        report.mask.height,
        report.mask.pitch_mm,
        hits(report),
        report.adapter.as_deref().unwrap_or("the CPU"),
        report.timings_ms.total,
    )
}
