//! Makes a print file from another.

use std::path::PathBuf;

use clap::Args;
use cusp_slicer::Warning;
use cusp_slicer::archive::ArchiveError;
use cusp_slicer::archive::read::{PrintFile, inspect};
use cusp_slicer::convert::{Conversion, Loss, Target};
use cusp_slicer::format::Format;
use cusp_slicer::printer::format_of;
use serde::Serialize;

use crate::failure::{Failure, in_file};
use crate::files::{Output, printer_choice, read, read_resin};
use crate::progress::Bar;
use crate::terminal::{duration, print, print_json, warn};
use crate::usage::check_json;
use crate::values::PrinterName;
use crate::visible::visible;
use crate::watch::stop_on_interrupt;

/// A print file, and what to make of it.
#[derive(Args)]
pub struct Converting {
    /// Print file to read, from any program; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Print file to write; an existing file is replaced only once the new one is complete; - is standard output
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Printer, whose screen must be that of the masks: a name of `cusp printers`, or a JSON file that describes it [default: the
    /// printer that IN names]
    #[arg(long, value_name = "NAME|FILE.json", value_parser = PrinterName, hide_possible_values = true)]
    printer: Option<String>,
    /// Format [default: the printer's, or that of OUT's extension; .zip means png]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Mirror the masks left to right [default: as the printer has them]
    #[arg(long, value_name = "BOOL")]
    mirror: Option<bool>,
    /// Resin, as a JSON file: its exposures, rests and moves replace those of IN
    #[arg(long, value_name = "FILE")]
    resin: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// A print file that was made from another.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Converted {
    pub format: Format,
    /// The printer that it is for, if it is known.
    pub printer: Option<String>,
    pub layers: usize,
    pub print_time_s: f64,
    pub losses: Vec<Loss>,
    pub warnings: Vec<Warning>,
}

impl Converting {
    fn target(&self, output: &Output<'_>) -> Result<Target, Failure> {
        let printer = self.printer.as_deref().map(printer_choice).transpose()?;
        let by_extension = || output.extension().and_then(format_of);
        let resin = self.resin.as_deref();
        Ok(Target {
            // A printer that is asked for goes before an extension.
            format: self.format.or_else(|| match printer {
                Some(_) => None,
                None => by_extension(),
            }),
            printer,
            mirror: self.mirror,
            resin: resin.map(|resin| read_resin(Some(resin))).transpose()?,
        })
    }
}

pub fn convert(converting: &Converting) -> Result<(), Failure> {
    let input = &*converting.input;
    check_json("convert", Some(&converting.output), converting.json);
    let output = Output::new(&converting.output, Some(input), "print file to read")?;
    let target = converting.target(&output)?;
    let bytes = read(input)?;
    let file = PrintFile::open(&*bytes).map_err(|error| in_file(input, &error))?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |fraction| bar.show("inspect", fraction);
    let inspection = inspect(&file, &mut progress).map_err(|_| Failure::interrupted())?;
    let conversion = Conversion::new(&file, &inspection, &target);
    let conversion = conversion.map_err(|error| in_file(input, &error))?;
    output.write(|writer| {
        let mut progress = |fraction| bar.show("convert", fraction);
        let written = conversion.write(writer, &mut progress);
        let writer = written.map_err(|error| match error {
            ArchiveError::Cancelled(_) => Failure::interrupted(),
            error => output.failed(&error),
        })?;
        Ok((writer, ()))
    })?;
    drop(bar);
    warn(&inspection.warnings);
    warn(conversion.losses());
    let warnings = conversion.warnings();
    warn(&warnings);
    let printer = conversion.printer().map(|printer| &printer.model);
    if converting.json {
        return Ok(print_json(&Converted {
            format: conversion.format(),
            printer: printer.cloned(),
            layers: inspection.layers,
            print_time_s: conversion.print_time_s(),
            losses: conversion.losses().to_vec(),
            warnings,
        })?);
    }
    let printer = printer.map_or(String::new(), |printer| format!(" for the {printer}"));
    let line = format!(
        "{}: {}{printer}, {} layers, prints in {}",
        output.name(),
        conversion.format().name(),
        inspection.layers,
        duration(conversion.print_time_s())
    );
    Ok(print(&visible(&line))?)
}
