//! Checks a submitted plan and print file.

use std::fs;
use std::path::{Path, PathBuf};

use bytesize::ByteSize;
use clap::Args;
use cusp_slicer::inspect::{Limits, Verdict};
use cusp_slicer::job::{Backend, Claim, Job, LoadedModel, PlatePrintability, VerifyError};
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::price::{Price, PriceItem};
use cusp_slicer::warning::Warning;
use serde::Serialize;

use crate::batch::check_inputs;
use crate::budget::Budget;
use crate::check::{read_limits, verdict_name};
use crate::failure::{Failure, in_file};
use crate::files::{Reading, WeightsFile};
use crate::job_file::{JobFile, LoadedModels};
use crate::price::Order;
use crate::progress::Bar;
use crate::terminal::{open_gpu, print, print_json, warn};
use crate::usage::wrong_usage;
use crate::values::positive;
use crate::watch::stop_on_interrupt;

/// A plan, the files that it was made from, and the limits of a shop.
#[derive(Args)]
pub struct Verifying {
    /// Plan from `cusp plan --json` or from the page, or the manifest of a zip of masks
    plan: PathBuf,
    /// Models that the plan was made from, in their order: 3MF, OBJ or STL. Or the job file
    #[arg(required = true, value_name = "MODEL")]
    models: Vec<PathBuf>,
    /// Recompute this print file as well, and compare every byte
    #[arg(long, value_name = "FILE")]
    print: Option<PathBuf>,
    /// File of weights that the plan was made with
    #[arg(long, value_name = "FILE")]
    weights: Option<PathBuf>,
    /// Check that the plan can be printed, by the thresholds and severities in this file; a rejected plan fails
    #[arg(long, value_name = "FILE.json")]
    limits: Option<PathBuf>,
    /// Show its price, by the prices of this file
    #[arg(long, value_name = "FILE.json")]
    prices: Option<PathBuf>,
    /// Take at most about this much memory, such as 1GB or 512MiB, even if the plan needs more
    #[arg(long, value_name = "SIZE", default_value = "4GB")]
    max_memory: ByteSize,
    /// Take this much processor time at most, in seconds of all cores together
    #[arg(long, value_name = "S", value_parser = positive, default_value_t = 600.0)]
    max_cpu_time: f64,
    /// Prints of the plan to price [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), requires = "prices")]
    copies: Option<u32>,
    /// The finish to price, by its name in the prices
    #[arg(long, value_name = "NAME", requires = "prices")]
    finish: Option<String>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Limits and prices of a shop.
struct Shop<'a> {
    limits: Option<Limits>,
    order: Option<Order<'a>>,
}

impl Verifying {
    fn budget(&self) -> Budget {
        Budget::of(self.max_memory, self.max_cpu_time)
    }

    fn shop(&self) -> Result<Shop<'_>, Failure> {
        let order = self.prices.as_deref();
        let order = order.map(|path| Order::read(path, self.finish.as_deref()));
        Ok(Shop {
            limits: self.limits.as_deref().map(read_limits).transpose()?,
            order: order.transpose()?,
        })
    }
}

impl Shop<'_> {
    fn price(&self, items: &[PriceItem]) -> Result<Option<Price>, Failure> {
        let order = self.order.as_ref();
        order.map(|order| order.price(items)).transpose()
    }
}

/// A plate whose plan matches.
#[derive(Serialize, schemars::JsonSchema)]
struct VerifiedPlate {
    layers: usize,
    max_error: f64,
    tolerance: f64,
    print_time_s: f64,
    resin_ml: f64,
    print_is_same: bool,
    warnings: Vec<Warning>,
    /// Printability of the plate, if limits are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    printability: Option<PlatePrintability>,
}

/// The result of a successful verification.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Verified {
    /// Print time of these plates, one after the other.
    print_time_s: f64,
    /// Volume of resin in all of their copies.
    resin_ml: f64,
    /// The plates that the plan is of.
    plates: Vec<VerifiedPlate>,
    /// Price of all of their copies, if prices are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    price: Option<Price>,
}

fn check_print(path: &Path, sent: &[u8], made: &[u8]) -> Result<(), Failure> {
    if sent == made {
        return Ok(());
    }
    Err(Failure::of(path, &VerifyError::OtherPrint))
}

pub fn verify(verifying: &Verifying) -> Result<(), Failure> {
    let (plan, models) = (&*verifying.plan, &verifying.models);
    let budget = verifying.budget();
    budget.keep();
    check_inputs("verify", models);
    let text = fs::read_to_string(plan).map_err(|error| in_file(plan, &error))?;
    let shop = verifying.shop()?;
    let read = verifying.read(&text)?;
    let mut job = budget.bound(Job::new(read.models), 1);
    let files: Vec<_> = job.models().iter().map(LoadedModel::model_file).collect();
    let claims = Claim::read(&text, &files).map_err(|error| Failure::of(plan, &error))?;
    let sent = match verifying.print.as_deref() {
        Some(_) if claims.len() != 1 => {
            let message = format!(
                "--print is for one plate, and the plan has {}; give the manifest of its zip",
                claims.len()
            );
            wrong_usage("verify", &message);
        }
        Some(path) => Some((path, fs::read(path).map_err(|error| in_file(path, &error))?)),
        None => None,
    };
    stop_on_interrupt();
    let mut backends = claims.iter().map(|claim| claim.options().backend);
    if backends.any(|backend| backend == Backend::Gpu) {
        open_gpu(&mut job);
    }
    // The models fail together: the first names them.
    let failed = |error: cusp_slicer::Error| Failure::in_file(&models[0], &error);
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let (mut plates, mut items, mut worst) = (Vec::new(), Vec::new(), String::new());
    for claim in &claims {
        let made = pollster::block_on(claim.plan_again(&mut job, &mut progress));
        let made = made.map_err(failed)?;
        claim
            .check(made)
            .map_err(|error| Failure::of(plan, &error))?;
        items.extend(made.price_items(verifying.copies.unwrap_or(1) as usize));
        worst = made.metric.format(made.max_error);
        let mut plate = VerifiedPlate {
            layers: made.layers,
            max_error: made.max_error,
            tolerance: made.tolerance,
            print_time_s: made.print_time_s,
            resin_ml: made.resin_ml,
            print_is_same: sent.is_some(),
            warnings: made.all_warnings(),
            printability: None,
        };
        let limits = shop.limits.as_ref();
        let found = limits.map(|limits| job.inspect(0, limits, &mut progress));
        plate.printability = found.transpose().map_err(failed)?;
        plates.push(plate);
        if let Some((print_file, sent)) = &sent {
            let written = job.write_archive(0, Vec::with_capacity(sent.len()), &mut progress);
            let (bytes, _) = written.map_err(failed)?;
            check_print(print_file, sent, &bytes)?;
        }
    }
    drop(bar);
    for plate in &plates {
        warn(&plate.warnings);
    }
    let layers: Vec<String> = plates
        .iter()
        .map(|plate| plate.layers.to_string())
        .collect();
    let correct = format!(
        "the plan is correct: {} layers, {} within its tolerance{}",
        layers.join(" + "),
        match plates.len() {
            1 => format!("largest error {worst}"),
            _ => "each plate".to_owned(),
        },
        match sent {
            Some(_) => "; the print file matches it",
            None => "",
        }
    );
    let sum = |of: fn(&VerifiedPlate) -> f64| plates.iter().map(of).sum();
    let verified = Verified {
        print_time_s: sum(|plate| plate.print_time_s),
        resin_ml: sum(|plate| plate.resin_ml),
        price: shop.price(&items)?,
        plates,
    };
    verifying.show(&verified, correct)
}

impl Verifying {
    /// Reads the models: of one alone, as the plan says that it was read.
    fn read(&self, text: &str) -> Result<LoadedModels, Failure> {
        let file = JobFile::of(&self.models)?;
        if self.weights.is_some() && (file.is_some() || self.models.len() > 1) {
            let message = "weights belong to a model: name them beside it in the job file";
            wrong_usage("verify", message);
        }
        if let Some(file) = file {
            return file.read_models(self.models[0].parent());
        }
        let weights = self.weights.as_deref().map(WeightsFile::read).transpose()?;
        let options = match &self.models[..] {
            [_] => Claim::read_options(text),
            _ => ReadOptions::default(),
        };
        let reading = Reading { weights, options };
        let mut read = LoadedModels::default();
        for model in &self.models {
            read.models.push(reading.load(model)?);
        }
        Ok(read)
    }

    /// Prints the checks and the price of a plan, and sets the exit code by its acceptance.
    fn show(&self, verified: &Verified, correct: String) -> Result<(), Failure> {
        let found = verified
            .plates
            .iter()
            .filter_map(|it| it.printability.as_ref());
        let verdict = found.map(|it| it.verdict).max();
        if self.json {
            print_json(verified)?;
        } else {
            let verdict = verdict.map(|it| format!("verdict: {}", verdict_name(it)));
            let price = verified.price.as_ref();
            let price = price.map(|it| format!("price: {} {}", it.written(it.total), it.currency));
            let lines = [Some(correct), verdict, price];
            print(&lines.into_iter().flatten().collect::<Vec<_>>().join("\n"))?;
        }
        match verdict {
            Some(Verdict::Reject) => Err(Failure::TOLD),
            _ => Ok(()),
        }
    }
}
