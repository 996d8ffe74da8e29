//! Checks a submitted plan and print file.

use std::fs;
use std::path::{Path, PathBuf};

use bytesize::ByteSize;
use clap::Args;
use cusp_slicer::inspect::{Limits, Printability, Verdict};
use cusp_slicer::job::{Backend, Claim, LoadedModel, ModelPrintability, Report, VerifyError};
use cusp_slicer::price::{Price, PriceItem};
use cusp_slicer::warning::Warning;
use serde::Serialize;

use crate::budget::Budget;
use crate::check::{read_limits, verdict_name};
use crate::files::{Failure, Reading, WeightsFile, in_file};
use crate::job_file::{JobFile, job_file};
use crate::price::Order;
use crate::terminal::{Bar, open_gpu, open_gpu_of_plate, print, print_json, warn};
use crate::usage::wrong_usage;
use crate::values::positive;
use crate::watch::{keep_within, stop_on_interrupt};

/// A plan, what it was made from, and what a shop accepts.
#[derive(Args)]
pub struct Verifying {
    /// Plan from `cusp plan --json` or from the page, or the manifest of a zip of masks
    plan: PathBuf,
    /// Model that the plan was made from: 3MF, OBJ or STL. For plates, the job file
    model: PathBuf,
    /// Recompute this print file as well, and compare every byte
    #[arg(long, value_name = "FILE")]
    print: Option<PathBuf>,
    /// File of weights that the plan was made with
    #[arg(long, value_name = "FILE")]
    weights: Option<PathBuf>,
    /// Check what will fail when it is printed, by the thresholds and severities of this file: what is rejected is no correct plan
    #[arg(long, value_name = "FILE.json")]
    limits: Option<PathBuf>,
    /// Say what it costs, by the prices of this file
    #[arg(long, value_name = "FILE.json")]
    prices: Option<PathBuf>,
    /// Take about this much memory at most, as 1GB or 512MiB: a plan may ask for more than it is worth
    #[arg(long, value_name = "SIZE", default_value = "4GB")]
    max_memory: ByteSize,
    /// Take this much processor time at most, in seconds of all cores together
    #[arg(long, value_name = "S", value_parser = positive, default_value_t = 600.0)]
    max_cpu_time: f64,
    /// Copies to price, each with its whole print time [default: 1; for plates, those of the plan]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), requires = "prices")]
    copies: Option<u32>,
    /// The finish to price, by its name in the prices
    #[arg(long, value_name = "NAME", requires = "prices")]
    finish: Option<String>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What a shop accepts, and what it asks.
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

/// A plan that matches.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Matching {
    layers: usize,
    max_error: f64,
    tolerance: f64,
    print_time_s: f64,
    resin_ml: f64,
    print_is_same: bool,
    warnings: Vec<Warning>,
}

impl Matching {
    fn of(made: &Report, print_is_same: bool) -> Self {
        Self {
            layers: made.layers,
            max_error: made.max_error,
            tolerance: made.tolerance,
            print_time_s: made.print_time_s,
            resin_ml: made.resin_ml,
            print_is_same,
            warnings: made.warnings.clone(),
        }
    }
}

/// The result of a successful verification.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Verified {
    #[serde(flatten)]
    plan: Matching,
    /// What will fail when it is printed, if limits are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    printability: Option<Printability>,
    /// What it costs, if prices are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    price: Option<Price>,
}

/// The result for a plate.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VerifiedPlate {
    #[serde(flatten)]
    plan: Matching,
    /// What will fail on each of its models, if limits are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    printability: Option<Vec<ModelPrintability>>,
}

/// The result for the plates of a job.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VerifiedPlates {
    /// Print time of these plates, one after the other.
    print_time_s: f64,
    /// Volume of resin in all of their copies.
    resin_ml: f64,
    /// The plates that the plan is of.
    plates: Vec<VerifiedPlate>,
    /// What all of their copies cost, if prices are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    price: Option<Price>,
}

fn check_print(path: &Path, sent: &[u8], made: &[u8]) -> Result<(), Failure> {
    if sent == made {
        return Ok(());
    }
    Err(Failure::of(path, &VerifyError::OtherPrint))
}

/// Prints what a plan is worth, and says by the exit code whether it is accepted.
fn show(
    verifying: &Verifying,
    verified: &impl Serialize,
    correct: String,
    verdict: Option<Verdict>,
    price: Option<&Price>,
) -> Result<(), Failure> {
    if verifying.json {
        print_json(verified)?;
    } else {
        let verdict = verdict.map(|it| format!("verdict: {}", verdict_name(it)));
        let price = price.map(|it| format!("price: {} {}", it.written(it.total), it.currency));
        let lines = [Some(correct), verdict, price];
        print(&lines.into_iter().flatten().collect::<Vec<_>>().join("\n"))?;
    }
    match verdict {
        Some(Verdict::Reject) => Err(Failure::TOLD),
        _ => Ok(()),
    }
}

/// Verifies the plans of all plates of a job, or of one.
fn verify_plates(verifying: &Verifying, text: &str, job: &JobFile) -> Result<(), Failure> {
    let (plan, path) = (&*verifying.plan, &*verifying.model);
    if verifying.copies.is_some() {
        let message = "--copies is for the plan of one model: that of plates has its copies";
        wrong_usage("verify", message);
    }
    let shop = verifying.shop()?;
    let plate = job.read_models(path.parent())?.plate;
    let mut plate = verifying.budget().bound_plate(plate);
    let files: Vec<_> = plate.models().iter().map(LoadedModel::model_file).collect();
    let claims = Claim::read_plates(text, &files).map_err(|error| Failure::of(plan, &error))?;
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
    if claims
        .iter()
        .any(|claim| claim.options().backend == Backend::Gpu)
    {
        open_gpu_of_plate(&mut plate);
    }
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let (mut plates, mut items) = (Vec::new(), Vec::new());
    for claim in &claims {
        let made = pollster::block_on(claim.plan_again(&mut plate, &mut progress));
        let made = made.map_err(|error| Failure::in_file(path, &error))?;
        claim
            .check(made)
            .map_err(|error| Failure::of(plan, &error))?;
        items.extend(made.price_items(1));
        let matching = Matching::of(made, sent.is_some());
        let limits = shop.limits.as_ref();
        let found = limits.map(|limits| plate.inspect(0, limits, &mut progress));
        let found = found.transpose();
        plates.push(VerifiedPlate {
            plan: matching,
            printability: found
                .map_err(|error| Failure::in_file(path, &error))?
                .map(|it| it.models),
        });
        if let Some((print_file, sent)) = &sent {
            let written = plate.write_archive(0, Vec::with_capacity(sent.len()), &mut progress);
            let (bytes, _) = written.map_err(|error| Failure::in_file(path, &error))?;
            check_print(print_file, sent, &bytes)?;
        }
    }
    drop(bar);
    let plans = plates.iter().map(|plate| &plate.plan);
    for plan in plans.clone() {
        warn(&plan.warnings);
    }
    let layers: Vec<String> = plans.clone().map(|plan| plan.layers.to_string()).collect();
    let found = plates
        .iter()
        .filter_map(|plate| plate.printability.as_ref());
    let verdict = found.flatten().map(|model| model.found.verdict).max();
    let verified = VerifiedPlates {
        print_time_s: plans.clone().map(|plan| plan.print_time_s).sum(),
        resin_ml: plans.map(|plan| plan.resin_ml).sum(),
        plates,
        price: shop.price(&items)?,
    };
    let correct = format!(
        "the plan is correct: {} layers, each plate within its tolerance{}",
        layers.join(" + "),
        same_print(sent.is_some()),
    );
    show(
        verifying,
        &verified,
        correct,
        verdict,
        verified.price.as_ref(),
    )
}

fn same_print(is_same: bool) -> &'static str {
    if is_same {
        "; the print file matches it"
    } else {
        ""
    }
}

pub fn verify(verifying: &Verifying) -> Result<(), Failure> {
    let (plan, model) = (&*verifying.plan, &*verifying.model);
    let budget = verifying.budget();
    keep_within(&budget);
    let text = fs::read_to_string(plan).map_err(|error| in_file(plan, &error))?;
    if let Some(job) = job_file(&[model.to_owned()])? {
        if verifying.weights.is_some() {
            let message = "weights belong to a model: name them beside it in the job file";
            wrong_usage("verify", message);
        }
        return verify_plates(verifying, &text, &job);
    }
    let shop = verifying.shop()?;
    let weights = verifying.weights.as_deref();
    let reading = Reading {
        weights: weights.map(WeightsFile::read).transpose()?,
        options: Claim::read_options(&text),
    };
    let mut slicer = budget.bound(reading.load(model)?, 1);
    let claim =
        Claim::read(&text, slicer.model_file()).map_err(|error| Failure::of(plan, &error))?;
    stop_on_interrupt();
    open_gpu(&mut slicer, claim.options().backend);
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let made = pollster::block_on(slicer.plan(claim.options(), &mut progress))
        .map_err(|error| Failure::in_file(model, &error))?;
    claim
        .check(made)
        .map_err(|error| Failure::of(plan, &error))?;
    let matching = Matching::of(made, verifying.print.is_some());
    let words = made.metric.format(made.max_error);
    let price = shop.price(&made.price_items(verifying.copies.unwrap_or(1) as usize))?;
    let limits = shop.limits.as_ref();
    let found = limits.map(|limits| slicer.inspect(limits, &mut progress));
    let printability = found
        .transpose()
        .map_err(|error| Failure::in_file(model, &error))?;
    if let Some(path) = &verifying.print {
        let sent = fs::read(path).map_err(|error| in_file(path, &error))?;
        let (bytes, _) = slicer
            .write_archive(Vec::with_capacity(sent.len()), &mut progress)
            .map_err(|error| Failure::in_file(model, &error))?;
        check_print(path, &sent, &bytes)?;
    }
    drop(bar);
    warn(&matching.warnings);
    let correct = format!(
        "the plan is correct: {} layers, largest error {words} within its tolerance{}",
        matching.layers,
        same_print(matching.print_is_same),
    );
    let verified = Verified {
        plan: matching,
        printability,
        price,
    };
    let verdict = verified.printability.as_ref().map(|it| it.verdict);
    show(
        verifying,
        &verified,
        correct,
        verdict,
        verified.price.as_ref(),
    )
}
