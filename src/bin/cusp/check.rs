//! Says what will fail when a model is printed, and where.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::inspect::{Finding, Limits, Printability, Severity, Verdict};
use cusp_slicer::job::{PlatePrintability, Report};
use serde::Serialize;

use crate::budget::Budget;
use crate::failure::{Failure, in_file};
use crate::files::read_json;
use crate::job::Printing;
use crate::progress::Bar;
use crate::slice::describe_supports;
use crate::terminal::{print, print_json};
use crate::watch::stop_on_interrupt;

/// Models, and the limits of a shop.
#[derive(Args)]
pub struct Checking {
    #[command(flatten)]
    pub printing: Printing,
    /// Thresholds and severities of a shop, as a JSON file
    #[arg(long, value_name = "FILE.json")]
    limits: Option<PathBuf>,
    /// Number of findings to show of each kind, largest first
    #[arg(long, value_name = "N", default_value_t = 5)]
    show: usize,
}

/// The JSON of `check`.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Checked {
    /// The largest severity of all findings.
    verdict: Verdict,
    /// The findings on each plate.
    plates: Vec<CheckedPlate>,
    /// The limits that they were checked by.
    limits: Limits,
}

/// A plate that was checked.
#[derive(Serialize, schemars::JsonSchema)]
struct CheckedPlate {
    #[serde(flatten)]
    printability: PlatePrintability,
    /// Number of layers.
    layers: usize,
    /// Height of the print.
    height_mm: f64,
}

/// Checks each model of each plate.
pub fn check(checking: &Checking) -> Result<(), Failure> {
    let Checking { printing, show, .. } = checking;
    printing.check("check");
    let limits = checking.limits.as_deref().map(read_limits).transpose()?;
    let limits = limits.unwrap_or_default();
    let mut job = printing.read("check", &Budget::default())?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let report = job.plan(&mut progress)?;
    let (mut plates, mut texts) = (Vec::new(), Vec::new());
    for plate in &report.plates {
        let found = job.job.inspect(plate.plate, &limits, &mut progress);
        let printability = found.map_err(|error| job.failure(&error))?;
        for model in &printability.models {
            let described = describe(&model.found, plate, *show);
            texts.push(match plate.placements[..] {
                [_] if report.plates.len() == 1 => described,
                _ => {
                    let name = job.name(model.model);
                    format!("plate {}, {name}\n{described}", plate.plate + 1)
                }
            });
        }
        plates.push(CheckedPlate {
            printability,
            layers: plate.layers,
            height_mm: plate.height_mm,
        });
    }
    drop(bar);
    job.warn(&report);
    let verdicts = plates.iter().map(|plate| plate.printability.verdict);
    let verdict = verdicts.max().unwrap_or(Verdict::Ok);
    if printing.json {
        print_json(&Checked {
            verdict,
            plates,
            limits,
        })?;
    } else {
        print(&texts.join("\n\n"))?;
    }
    if verdict == Verdict::Reject {
        return Err(Failure::TOLD);
    }
    Ok(())
}

pub fn read_limits(path: &Path) -> Result<Limits, Failure> {
    let limits: Limits = read_json(path)?;
    limits.check().map_err(|error| in_file(path, &error))?;
    Ok(limits)
}

pub fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Ok => "ok",
        Verdict::Review => "review",
        Verdict::Reject => "reject",
    }
}

fn describe(printability: &Printability, report: &Report, show: usize) -> String {
    let verdict = verdict_name(printability.verdict);
    let peel = &printability.peel;
    let mut text = format!(
        "verdict   {verdict}\n\
         layers    {} of {:.3} mm in total\n\
         bodies    {}\n\
         peel      at most {:.1} mm² with {:.1} N, in layer {}; {:.0} % of that on the plate; the largest jump is {:.1} mm², to layer {}",
        report.layers,
        report.height_mm,
        printability.bodies,
        peel.area_mm2[peel.largest_layer],
        peel.pull_n[peel.largest_layer],
        peel.largest_layer + 1,
        peel.contact * 100.0,
        peel.jump_mm2,
        peel.jump_layer + 1,
    );
    text += &describe_supports(report);
    for count in &printability.counts {
        let findings = printability.findings.iter();
        let findings = findings.filter(|finding| finding.code == count.code);
        let severity = findings.clone().next().map(|finding| finding.severity);
        let severity = match severity {
            Some(Severity::Reject) => ", reject",
            Some(Severity::Review) => ", review",
            Some(Severity::Note) => ", note",
            _ => "",
        };
        let _ = write!(
            text,
            "\n\n{} × {}{severity}",
            count.found,
            count.code.name()
        );
        for finding in findings.take(show) {
            let _ = write!(text, "\n  {}", describe_finding(finding));
        }
        if count.found > show {
            let _ = write!(text, "\n  … and {} smaller", count.found - show);
        }
    }
    text
}

fn describe_finding(finding: &Finding) -> String {
    let [x, y, z] = finding.at_mm;
    let layers = match finding.layers.map(|layer| layer + 1) {
        [first, last] if first == last => format!("layer {first}"),
        [first, last] => format!("layers {first} to {last}"),
    };
    format!("at {x:.2}, {y:.2}, {z:.2}, {layers}: {finding}")
}
