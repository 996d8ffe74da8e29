//! The orientation search, whole or in shards.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::job::{LoadedModel, Options, OrientationPart, OrientationReport};
use cusp_slicer::model::Pose;
use cusp_slicer::orientation::shard::Shard;
use cusp_slicer::orientation::{
    Candidate, Cost, Exclusion, MAX_DIRECTIONS, Quality, SearchOptions, Terms,
};

use crate::arguments::{Choices, Settings};
use crate::batch::check_inputs;
use crate::export::write_stl;
use crate::failure::{Failure, in_file};
use crate::files::{Output, Reading, parse_json};
use crate::progress::Bar;
use crate::terminal::{duration, print, print_json, print_json_line, say, to_json};
use crate::usage::check_json;
use crate::values::{fraction, rank, shard};
use crate::watch::{is_stopped, stop_on_interrupt};

/// The options of the orientation search.
#[derive(Args)]
pub struct Orienting {
    /// Models: 3MF, OBJ or STL
    #[arg(required = true, value_name = "MODEL")]
    models: Vec<PathBuf>,
    /// Print one JSON object per model, each on its own line
    #[arg(long)]
    pub json: bool,
    /// Directions to evaluate, spread evenly; the axes and the normals of large flats are added
    #[arg(long, value_name = "N", default_value_t = SearchOptions::default().directions as u32, value_parser = clap::value_parser!(u32).range(1..=MAX_DIRECTIONS as i64), help_heading = "Search")]
    directions: u32,
    /// Weight of the cost against the quality, 0 to 1
    #[arg(long, value_name = "A", default_value_t = SearchOptions::default().alpha, value_parser = fraction, help_heading = "Search")]
    alpha: f64,
    /// Measure of cost
    #[arg(long, value_enum, default_value_t = SearchOptions::default().cost, help_heading = "Search")]
    cost: Cost,
    /// Measure of quality; less is better
    #[arg(long, value_enum, default_value_t = SearchOptions::default().quality, help_heading = "Search")]
    quality: Quality,
    #[arg(long, value_name = "NAME=WEIGHT", help = format!("Weigh all criteria, in place of two: {}, each from 0; repeatable", Terms::NAMES.join(", ")), value_parser = rank, conflicts_with_all = ["alpha", "cost", "quality"], help_heading = "Search")]
    rank: Vec<(usize, f64)>,
    /// Exclude orientations with a larger area that needs support, in mm²
    #[arg(long, value_name = "MM2", help_heading = "Search")]
    most_overhang: Option<f64>,
    /// Exclude orientations with more islands
    #[arg(long, value_name = "N", help_heading = "Search")]
    most_islands: Option<usize>,
    /// Exclude orientations with a larger area of cups, in mm²
    #[arg(long, value_name = "MM2", help_heading = "Search")]
    most_cups: Option<f64>,
    /// Write the model in the Kth best orientation to -o; for a single model
    #[arg(long, value_name = "K", requires = "output", conflicts_with = "shard", value_parser = clap::value_parser!(u32).range(1..=3), help_heading = "Search")]
    apply: Option<u32>,
    /// Model file to write, in that orientation
    #[arg(
        short,
        long,
        value_name = "FILE",
        requires = "apply",
        help_heading = "Search"
    )]
    output: Option<PathBuf>,
    /// Measure only shard I of N, and print a part for --merge
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Several machines")]
    shard: Option<Shard>,
    /// Measure nothing: merge these parts, made with the same models and options
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with = "shard", help_heading = "Several machines")]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    choices: Choices,
}

impl Orienting {
    fn ranking(&self) -> Option<Terms> {
        let mut terms = [0.0; Terms::NAMES.len()];
        for &(term, weight) in &self.rank {
            terms[term] = weight;
        }
        (!self.rank.is_empty()).then(|| Terms::from_array(terms))
    }

    fn search(&self) -> SearchOptions {
        SearchOptions {
            directions: self.directions as usize,
            alpha: self.alpha,
            cost: self.cost,
            quality: self.quality,
            ranking: self.ranking(),
            most_overhang_mm2: self.most_overhang,
            most_islands: self.most_islands,
            most_cups_mm2: self.most_cups,
        }
    }
}

pub fn orient(orienting: &Orienting) -> Result<(), Failure> {
    orienting.choices.check("orient");
    let Settings { options, reading } = orienting.choices.settings()?;
    if orienting.models.len() > 1 && orienting.apply.is_some() {
        return Err("--apply is for one model".to_owned().into());
    }
    check_inputs("orient", &orienting.models);
    let target = orienting.output.as_deref();
    check_json("orient", target, orienting.json);
    let target = target.map(|output| Output::new(output, Some(&orienting.models[0]), "model"));
    let target = target.transpose()?;
    // Wrong options are wrong for every model: report them once.
    options.check().map_err(|error| error.to_string())?;
    let task = Task {
        options,
        reading,
        parts: read_parts(orienting)?,
        target,
    };
    stop_on_interrupt();
    // The result of a shard is for a program, too.
    let is_json = orienting.json || orienting.shard.is_some();
    let mut is_any_bad = false;
    for model in &orienting.models {
        if is_stopped() {
            return Err(Failure::interrupted());
        }
        match task.answer(orienting, model) {
            Ok(answer) if is_json => print_json_line(&answer)?,
            Ok(answer) => print(&answer)?,
            // A bad model does not affect the rest of the batch.
            Err(failure) if failure.exit_code == 1 => {
                say(failure.message.as_deref().unwrap_or_default());
                // Parts that are merged hold nothing else.
                if orienting.json
                    && orienting.shard.is_none()
                    && let Some(mut failed) = failure.told()
                {
                    failed.error.file = Some(model.display().to_string());
                    print_json(&failed)?;
                }
                is_any_bad = true;
            }
            Err(failure) => return Err(failure),
        }
    }
    if is_any_bad {
        return Err(Failure::TOLD);
    }
    Ok(())
}

/// Options shared by all models of a batch.
struct Task<'a> {
    options: Options,
    reading: Reading,
    parts: Vec<OrientationPart>,
    /// The file to write: as the user named it, and where it is.
    target: Option<Output<'a>>,
}

impl Task<'_> {
    /// The text to print for a model.
    fn answer(&self, orienting: &Orienting, model: &Path) -> Result<String, Failure> {
        let options = &self.options;
        let mut loaded = self.reading.load(model)?;
        let bar = Bar::new();
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let search = orienting.search();
        if let Some(shard) = orienting.shard {
            let part = loaded.measure_shard(options, &search, shard, &mut progress);
            return Ok(to_json(
                &part.map_err(|error| Failure::in_file(model, &error))?,
            )?);
        }
        let found = if orienting.merge.is_empty() {
            loaded.orient(options, &search, &mut progress)
        } else {
            let merged = loaded.merge_shards(options, &search, &self.parts);
            merged.and_then(|search| loaded.finish_search(options, search, &mut progress))
        };
        let found = found.map_err(|error| Failure::in_file(model, &error))?;
        if let (Some(number), Some(output)) = (orienting.apply, &self.target) {
            let candidate = found.best.get(number as usize - 1).ok_or_else(|| {
                let reason = format!("only {} orientations were found", found.best.len());
                in_file(model, &reason)
            })?;
            apply(&loaded, options, candidate, output)?;
        }
        if orienting.json {
            Ok(to_json(&found)?)
        } else {
            Ok(describe(model, options, &found))
        }
    }
}

/// Reads the parts to merge: one JSON object per line.
fn read_parts(orienting: &Orienting) -> Result<Vec<OrientationPart>, Failure> {
    let mut parts = Vec::new();
    for path in &orienting.merge {
        let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
        for line in text.lines() {
            parts.push(parse_json(path, line)?);
        }
    }
    Ok(parts)
}

/// Writes the model, oriented and on the plate, as a binary STL.
fn apply(
    loaded: &LoadedModel,
    options: &Options,
    candidate: &Candidate,
    output: &Output<'_>,
) -> Result<(), Failure> {
    let pose = Pose {
        rotation: Some(candidate.rotation),
        height_mm: options.height_mm.map(|_| candidate.size_mm[2]),
        unit: options.unit,
    };
    let corners = loaded.positions_on_plate(&pose);
    let corners = corners.map_err(|error| output.failure(&error))?;
    let (facets, _) = corners.as_chunks::<9>();
    let facets = facets
        .iter()
        .map(|&[ax, ay, az, bx, by, bz, cx, cy, cz]| [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]);
    write_stl(facets, output)
}

fn describe(model: &Path, options: &Options, found: &OrientationReport) -> String {
    let excluded = |why| {
        let candidates = found.candidates.iter();
        candidates.filter(|it| it.excluded == Some(why)).count()
    };
    let mut text = format!("{}: {} directions", model.display(), found.candidates.len());
    for (why, words) in [
        (Exclusion::TooLarge, "too large for the plate"),
        (Exclusion::TooHigh, "too high for the printer"),
        (Exclusion::NoPlan, "without a plan within tolerance"),
        (Exclusion::Overhang, "with too much overhang"),
        (Exclusion::Islands, "with too many islands"),
        (Exclusion::Cups, "with too much area of cups"),
    ] {
        let count = excluded(why);
        if count > 0 {
            let _ = write!(text, ", {count} {words}");
        }
    }
    if found.best.is_empty() {
        let advice = if found.candidates.iter().any(|it| it.metrics.is_some()) {
            "no orientation is within the limits of the search; allow more"
        } else {
            "no orientation can be printed; choose another printer or wider limits"
        };
        let _ = write!(text, "\n{advice}");
        return text;
    }
    text.push_str(
        "\n     energy  layers  time         largest error  roughness   overhang     islands  cups         supports    contacts    size",
    );
    let rows = found.best.iter().enumerate();
    let rows = rows.map(|(place, candidate)| ((place + 1).to_string(), candidate));
    for (name, candidate) in rows.chain([("now".to_owned(), &found.now)]) {
        let [x, y, z] = candidate.size_mm;
        let Some(metrics) = &candidate.metrics else {
            let _ = write!(
                text,
                "\n{name:<4} does not fit: {x:.1} × {y:.1} × {z:.1} mm"
            );
            continue;
        };
        let _ = write!(
            text,
            "\n{name:<4} {:.4}  {:>6}  {:<11}  {:<13}  {:<10}  {:<11}  {:>7}  {:<11}  {:<10}  {:<10}  {x:.1} × {y:.1} × {z:.1} mm",
            candidate.energy.unwrap_or_default(),
            metrics.layers,
            duration(metrics.print_time_s),
            options.metric.format(metrics.max_error),
            format!("{:.4} mm", metrics.roughness_mm),
            format!("{:.1} mm²", metrics.overhang_mm2),
            metrics.islands,
            format!("{:.1} mm²", metrics.cups_mm2),
            format!("{:.2} ml", metrics.support_ml),
            format!("{:.1} mm²", metrics.contact_mm2),
        );
    }
    let [x, y, z, w] = found.best[0].rotation;
    let _ = write!(text, "\nto print the first: --rotation={x},{y},{z},{w}");
    text
}
