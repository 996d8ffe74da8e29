//! Places of copies of models.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use crate::arguments::{Choices, Places};
use crate::budget::Budget;
use crate::failure::{Failure, in_file};
use crate::files::Output;
use crate::job::LoadedJob;
use crate::job_file::{JobFile, is_named_as_project};
use crate::terminal::{print, print_json};

/// Models to arrange.
#[derive(Args)]
pub struct Plating {
    /// Models: 3MF, OBJ or STL; MODEL:3 is three copies. Or one job file or project, to arrange it again
    #[arg(required = true, value_name = "MODEL[:N]")]
    models: Vec<PathBuf>,
    #[command(flatten)]
    budget: Budget,
    #[command(flatten)]
    places: Places,
    /// Job file to write, which other commands take in place of models; or a project, a 3MF with the models inside
    #[arg(short, long, value_name = "FILE.json|3mf")]
    output: Option<PathBuf>,
    /// Print the job file
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    choices: Choices,
}

/// Arranges models, and writes the job file or the project.
pub fn plate(plating: &Plating) -> Result<(), Failure> {
    plating.budget.keep();
    plating.choices.check("plate");
    let output = plating.output.as_deref();
    let output = output
        .map(|path| Output::new(path, None, "model"))
        .transpose()?;
    let (models, places) = (&plating.models, &plating.places);
    let mut job = LoadedJob::read("plate", models, places, &plating.choices, &plating.budget)?;
    job.options.placements.clear();
    let placements = job.job.arrange(&job.options);
    let placements = placements.map_err(|error| job.failure(&error))?;
    let models = job.models.iter().zip(&job.options.models);
    let models = models.map(|(model, own)| model.with_own(own));
    let mut written = JobFile {
        models: models.collect(),
        options: job.options.options.clone(),
        arranging: job.options.arranging,
        placements: placements.clone(),
    };
    if let Some((output, path)) = output.zip(plating.output.as_deref()) {
        let bytes = if is_named_as_project(path) {
            let project = written.project(job.job.models())?.to_bytes();
            project.map_err(|error| job.failure(&error))?
        } else if written.is_project() {
            let message =
                "the models of a project are inside it: write another project, -o NAME.3mf";
            return Err(Failure::from(in_file(path, &message)));
        } else {
            for model in &mut written.models {
                model.relate_to(path);
            }
            let mut bytes =
                serde_json::to_vec_pretty(&written).map_err(|error| error.to_string())?;
            bytes.push(b'\n');
            bytes
        };
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
        let counts = (0..job.models.len()).map(|model| (on_plate(model), model));
        let named = counts.filter(|(copies, _)| *copies > 0);
        let named = named.map(|(copies, model)| format!("{copies} × {}", job.name(model)));
        let named = named.collect::<Vec<_>>().join(", ");
        let end = if plate + 1 < plates { "\n" } else { "" };
        let _ = write!(text, "plate {} of {plates}: {named}{end}", plate + 1);
    }
    Ok(print(&text)?)
}
