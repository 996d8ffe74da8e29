//! Several models on plates: arranging them, planning and slicing them together.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::arrange::Arranging;
use cusp_slicer::job::{Backend, JobReport};

use crate::arguments::{Choices, Slicing};
use crate::budget::Budget;
use crate::files::{Failure, Output, in_file, is_folder, is_standard, make_folder};
use crate::job_file::{Job, JobFile, JobModel, job_file, path_from, read_job};
use crate::terminal::{Bar, duration, open_gpu_of_plate, print, print_json, warn};
use crate::usage::{check_json, wrong_usage};
use crate::values::not_negative;
use crate::watch::{keep_within, stop_on_interrupt};

/// How models are arranged.
#[derive(Default, Args)]
pub struct Places {
    /// Copies of each model that names no number of its own, as MODEL:3 does
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Plate")]
    pub copies: Option<u32>,
    /// Least distance between copies [default: 2]
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Plate")]
    spacing: Option<f64>,
    /// Turn copies about z in steps of this where that saves a plate: a multiple of 15 that divides 360; 0 turns none [default: 45]
    #[arg(long, value_name = "DEGREES", help_heading = "Plate")]
    turn: Option<u32>,
}

impl Places {
    fn are_given(&self) -> bool {
        self.copies.is_some() || self.spacing.is_some() || self.turn.is_some()
    }

    pub fn arranging(&self, arranging: Arranging) -> Arranging {
        Arranging {
            spacing_mm: self.spacing.unwrap_or(arranging.spacing_mm),
            turn_deg: self.turn.unwrap_or(arranging.turn_deg),
        }
    }
}

/// Models to arrange.
#[derive(Args)]
pub struct Plating {
    /// Models: 3MF, OBJ or STL; MODEL:3 is three copies. Or one job file, to arrange it again
    #[arg(required = true, value_name = "MODEL[:N]")]
    models: Vec<PathBuf>,
    #[command(flatten)]
    budget: Budget,
    #[command(flatten)]
    places: Places,
    /// Where to write the job file, which `cusp slice` and `cusp plan` take in place of models
    #[arg(short, long, value_name = "FILE.json")]
    output: Option<PathBuf>,
    /// Print the job file
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    choices: Choices,
}

/// Reads the models if they are to share plates: with `--arrange`, or as a job file.
pub fn job(command: &str, slicing: &Slicing) -> Result<Option<Job>, Failure> {
    let places = &slicing.places;
    let file = job_file(&slicing.models)?;
    if file.is_none() && !slicing.arrange {
        if places.are_given() {
            let message = "--copies, --spacing and --turn are for plates: add --arrange";
            wrong_usage(command, message);
        }
        return Ok(None);
    }
    let mut job = read_job(command, file, &slicing.models, places, &slicing.choices)?;
    job.plate = slicing.budget.bound_plate(std::mem::take(&mut job.plate));
    if slicing.arrange {
        job.options.placements.clear();
        if let [one] = &job.options.models[..]
            && one.copies == 1
        {
            // Without a place it would stand in the middle, on no plate.
            let places = job.plate.arrange(&job.options);
            job.options.placements = places.map_err(|error| job.failure(&error))?;
        }
    }
    Ok(Some(job))
}

impl Job {
    /// A failure of the library, whose message names models by their files in place of their numbers.
    pub fn failure(&self, error: &cusp_slicer::Error) -> Failure {
        let [only] = &self.paths[..] else {
            return Failure::in_file(Path::new("plate"), error)
                .renamed(|message| self.named(message));
        };
        Failure::in_file(only, error)
    }

    /// A message with the files of models in place of their numbers.
    fn named(&self, message: &str) -> String {
        let names = self.paths.iter().enumerate();
        // From the last, so that model 12 is not model 1 with a 2.
        names
            .rev()
            .fold(message.to_owned(), |message, (model, path)| {
                message.replace(&format!("model {}", model + 1), &path.display().to_string())
            })
    }

    pub fn make_plan(&mut self, bar: &Bar) -> Result<JobReport, Failure> {
        if self.options.options.backend == Backend::Gpu {
            open_gpu_of_plate(&mut self.plate);
        }
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let report = pollster::block_on(self.plate.plan(&self.options, &mut progress));
        report.map_err(|error| self.failure(&error))
    }

    pub fn name(&self, model: usize) -> std::path::Display<'_> {
        self.paths[model].display()
    }
}

/// Plans plates, and prints the report.
pub fn plan(mut job: Job, slicing: &Slicing) -> Result<(), Failure> {
    stop_on_interrupt();
    let bar = Bar::new();
    let report = job.make_plan(&bar)?;
    drop(bar);
    show(&job, slicing, &report)
}

/// Slices plates, each into a print file.
pub fn slice(mut job: Job, slicing: &Slicing, output: &Path) -> Result<(), Failure> {
    check_json("slice", Some(output), slicing.json);
    stop_on_interrupt();
    let bar = Bar::new();
    let mut report = job.make_plan(&bar)?;
    let files = print_files(&job, output, report.plates.len())?;
    let outputs = files.iter().map(|file| Output::new(file, None, "model"));
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    for (number, output) in outputs.iter().enumerate() {
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let written = output.write(|writer| {
            let written = job.plate.write_archive(number, writer, &mut progress);
            let (writer, report) = written.map_err(|error| output.failure(&error))?;
            Ok((writer, report.clone()))
        })?;
        report.plates[number] = written;
    }
    drop(bar);
    show(&job, slicing, &report)
}

/// The print file of each plate. Those of several have their number in the name.
fn print_files(job: &Job, output: &Path, plates: usize) -> Result<Vec<PathBuf>, Failure> {
    let numbered = |folder: &Path, stem: &str, end: &str| {
        let name = |number| folder.join(format!("{stem}-{number}.{end}"));
        (1..=plates).map(name).collect()
    };
    if is_folder(output) {
        let print_file = job.options.options.print_file();
        let print_file = print_file.map_err(|error| job.failure(&error))?;
        make_folder(output)?;
        return Ok(numbered(output, "plate", &print_file.extension));
    }
    if plates == 1 {
        return Ok(vec![output.to_owned()]);
    }
    if is_standard(output) {
        let reason = format!("{plates} plates are as many print files; name a folder by -o");
        return Err(in_file(output, &reason).into());
    }
    let part =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, end) = (part(output.file_stem()), part(output.extension()));
    let folder = output.parent().unwrap_or(Path::new(""));
    Ok(numbered(folder, &stem, &end))
}

fn show(job: &Job, slicing: &Slicing, report: &JobReport) -> Result<(), Failure> {
    for plate in &report.plates {
        warn(&plate.warnings);
    }
    if slicing.json {
        return Ok(print_json(report)?);
    }
    let mut text = String::new();
    for (number, plate) in report.plates.iter().enumerate() {
        let _ = writeln!(
            text,
            "plate {} of {}: {} layers, {:.3} mm, {}, {:.1} ml of resin",
            number + 1,
            report.plates.len(),
            plate.layers,
            plate.height_mm,
            duration(plate.print_time_s),
            plate.resin_ml,
        );
        for model in plate.plate.iter().flat_map(|plate| &plate.models) {
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
    Ok(print(&text)?)
}

/// Arranges models, and writes the job file.
pub fn plate(plating: &Plating) -> Result<(), Failure> {
    keep_within(&plating.budget);
    plating.choices.check("plate");
    let output = plating.output.as_deref();
    let output = output
        .map(|path| Output::new(path, None, "model"))
        .transpose()?;
    let file = job_file(&plating.models)?;
    let mut job = read_job(
        "plate",
        file,
        &plating.models,
        &plating.places,
        &plating.choices,
    )?;
    job.plate = plating.budget.bound_plate(std::mem::take(&mut job.plate));
    job.options.placements.clear();
    let placements = job.plate.arrange(&job.options);
    let placements = placements.map_err(|error| job.failure(&error))?;
    let beside = plating.output.as_deref();
    let models = (0..job.paths.len()).map(|model| JobModel {
        weights: job.weights[model]
            .as_deref()
            .map(|path| path_from(beside, path)),
        file: path_from(beside, &job.paths[model]),
        ..JobModel::of(&job.options.models[model])
    });
    let written = JobFile {
        models: models.collect(),
        options: job.options.options.clone(),
        arranging: job.options.arranging,
        placements: placements.clone(),
    };
    if let Some(output) = output {
        let mut bytes = serde_json::to_vec_pretty(&written).map_err(|error| error.to_string())?;
        bytes.push(b'\n');
        output.write_bytes(&bytes)?;
    }
    if plating.json {
        return Ok(print_json(&written)?);
    }
    let plates = placements
        .iter()
        .map(|place| place.plate + 1)
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for plate in 0..plates {
        let on_plate = |model: usize| {
            let copies = placements
                .iter()
                .filter(|it| it.plate == plate && it.model == model);
            copies.count()
        };
        let counts = (0..job.paths.len()).map(|model| (on_plate(model), model));
        let named = counts.filter(|(copies, _)| *copies > 0);
        let named = named.map(|(copies, model)| format!("{copies} × {}", job.name(model)));
        let named = named.collect::<Vec<_>>().join(", ");
        let end = if plate + 1 < plates { "\n" } else { "" };
        let _ = write!(text, "plate {} of {plates}: {named}{end}", plate + 1);
    }
    Ok(print(&text)?)
}
