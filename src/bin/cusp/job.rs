//! Jobs of the command line: models that are read, and what to do with them.

use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::job::{Backend, Job, JobOptions, JobReport, ModelOptions, StageProgress};
use cusp_slicer::warning::Warning;

use crate::arguments::{Choices, Places, Settings};
use crate::batch::check_inputs;
use crate::budget::Budget;
use crate::failure::Failure;
use crate::job_file::{JobFile, JobModel, LoadedModels, with_copies};
use crate::terminal::{open_gpu, say};
use crate::usage::wrong_usage;

/// Models with their copies, and how they would be printed.
#[derive(Args)]
pub struct Printing {
    /// Models: 3MF, OBJ or STL; MODEL:3 is three copies; - is standard input. Or one job file or project of `cusp plate`
    #[arg(required = true, value_name = "MODEL[:N]")]
    models: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    places: Places,
    #[command(flatten)]
    choices: Choices,
}

impl Printing {
    /// The first model, or the job file.
    pub fn first(&self) -> Option<&Path> {
        self.models.first().map(PathBuf::as_path)
    }

    /// Ends the program with a message if the choices or the names of files contradict each other.
    pub fn check(&self, command: &str) {
        self.choices.check(command);
        check_inputs(command, &self.models);
    }

    /// Reads the models.
    pub fn read(&self, command: &str, budget: &Budget) -> Result<LoadedJob, Failure> {
        LoadedJob::read(command, &self.models, &self.places, &self.choices, budget)
    }
}

/// A job whose models are read.
pub struct LoadedJob {
    /// The job file, if there is one.
    file: Option<PathBuf>,
    /// The models as in a job file.
    pub models: Vec<JobModel>,
    pub job: Job,
    pub options: JobOptions,
}

impl LoadedJob {
    /// Reads models, each with its copies, or the models of a job file.
    pub fn read(
        command: &str,
        models: &[PathBuf],
        places: &Places,
        choices: &Choices,
        budget: &Budget,
    ) -> Result<Self, Failure> {
        let file = JobFile::of(models)?;
        let settings = match &file {
            Some(file) => choices.settings_over(file.options.clone())?,
            None => choices.settings()?,
        };
        let mut read = match file {
            None if models.len() == 1 => {
                let (path, copies) = with_copies(&models[0]);
                let mut alone = Self::alone(&path, &settings, budget, 1)?;
                alone.options.models[0].copies = copies.unwrap_or(places.copies());
                alone
            }
            _ if settings.reading.weights.is_some() => {
                let message = "weights belong to a model: name them beside it in a job file";
                wrong_usage(command, message);
            }
            Some(file) => {
                let read = file.read_models(models[0].parent())?;
                Self {
                    file: Some(models[0].clone()),
                    ..Self::of(read, &file, &settings, budget)
                }
            }
            None => {
                let reading = settings.reading.options;
                let models = models.iter().map(|model| {
                    let (path, copies) = with_copies(model);
                    let own = ModelOptions {
                        copies: copies.unwrap_or(places.copies()),
                        ..ModelOptions::default()
                    };
                    JobModel::new(path, &own, &reading)
                });
                let file = JobFile {
                    models: models.collect(),
                    ..JobFile::default()
                };
                let read = file.read_models(None)?;
                Self::of(read, &file, &settings, budget)
            }
        };
        read.options.arranging = places.arranging(read.options.arranging);
        Ok(read)
    }

    /// Reads a single copy of a model, which takes its share of the budget: `workers` take some at a time.
    pub fn alone(
        model: &Path,
        settings: &Settings,
        budget: &Budget,
        workers: usize,
    ) -> Result<Self, Failure> {
        let job = Job::new(vec![settings.reading.load(model)?]);
        Ok(Self {
            file: None,
            models: vec![JobModel::new(
                model.to_owned(),
                &ModelOptions::default(),
                &settings.reading.options,
            )],
            job: budget.bound(job, workers),
            options: JobOptions {
                models: vec![ModelOptions::default()],
                ..JobOptions::of(settings.options.clone())
            },
        })
    }

    fn of(read: LoadedModels, file: &JobFile, settings: &Settings, budget: &Budget) -> Self {
        Self {
            file: None,
            models: read.files,
            job: budget.bound(Job::new(read.models), 1),
            options: JobOptions {
                options: settings.options.clone(),
                models: file.models.iter().map(JobModel::own).collect(),
                arranging: file.arranging,
                placements: file.placements.clone(),
            },
        }
    }

    /// Arranges the copies, also a single one: without a place it would stand in the middle, on no plate.
    pub fn arrange(&mut self) -> Result<(), Failure> {
        self.options.placements.clear();
        if self.is_alone() {
            self.place()?;
        }
        Ok(())
    }

    /// Number of plates. Arranges copies that have no places, except a single one: it needs no plate.
    pub fn plates(&mut self) -> Result<usize, Failure> {
        if self.options.placements.is_empty() && !self.is_alone() {
            self.place()?;
        }
        let plates = self.options.placements.iter().map(|place| place.plate + 1);
        Ok(plates.max().unwrap_or(1))
    }

    fn is_alone(&self) -> bool {
        matches!(&self.options.models[..], [one] if one.copies == 1)
    }

    fn place(&mut self) -> Result<(), Failure> {
        let places = self.job.arrange(&self.options);
        self.options.placements = places.map_err(|error| self.failure(&error))?;
        Ok(())
    }

    /// Plans all plates.
    pub fn plan(&mut self, progress: &mut StageProgress<'_>) -> Result<JobReport, Failure> {
        if self.options.options.backend == Backend::Gpu {
            open_gpu(&mut self.job);
        }
        let report = pollster::block_on(self.job.plan(&self.options, progress));
        report.map_err(|error| self.failure(&error))
    }

    /// A failure of the library, whose message names models by their files in place of their numbers.
    pub fn failure(&self, error: &cusp_slicer::Error) -> Failure {
        match (&self.file, &self.models[..]) {
            (Some(file), _) => Failure::in_file(file, error).renamed(|message| self.named(message)),
            (None, [only]) => Failure::in_file(&only.file, error),
            _ if error.code() == "cancelled" => Failure::interrupted(),
            _ => Failure::without_file(error).renamed(|message| {
                let named = self.named(message);
                if named == message {
                    format!("{}: {message}", self.names())
                } else {
                    named
                }
            }),
        }
    }

    /// The files of all models, of many the first.
    fn names(&self) -> String {
        let [first, .., last] = &self.models[..] else {
            return String::new();
        };
        let (first, last) = (first.file.display(), last.file.display());
        match self.models.len() {
            2 => format!("{first} and {last}"),
            count => format!("{first} and {} more", count - 1),
        }
    }

    /// A message with the files of models in place of their numbers.
    fn named(&self, message: &str) -> String {
        let mut parts = message.split("model ");
        let first = parts.next().unwrap_or_default().to_owned();
        let named = parts.map(|part| {
            let rest = part.trim_start_matches(|it: char| it.is_ascii_digit());
            let number: Option<usize> = part[..part.len() - rest.len()].parse().ok();
            let model = number.and_then(|number| number.checked_sub(1));
            match model.and_then(|model| self.models.get(model)) {
                Some(model) => format!("{}{rest}", model.file.display()),
                None => format!("model {part}"),
            }
        });
        std::iter::once(first).chain(named).collect()
    }

    pub fn name(&self, model: usize) -> std::path::Display<'_> {
        self.models[model].file.display()
    }

    /// Says the warnings about models, which several are named by, and about plates.
    pub fn warn(&self, report: &JobReport) {
        for plate in &report.plates {
            for model in &plate.models {
                for warning in &model.warnings {
                    self.say_of(model.model, warning);
                }
            }
            for warning in &plate.warnings {
                say(&format!("warning: {warning}"));
            }
        }
    }

    fn say_of(&self, model: usize, warning: &Warning) {
        match &self.models[..] {
            [_] => say(&format!("warning: {warning}")),
            _ => say(&format!("warning: {}: {warning}", self.name(model))),
        }
    }
}
