//! Commands without a plan: describing models, saliency, printers.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use cusp_slicer::job::MeshInfo;
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::model::weights;
use cusp_slicer::printer::PRINTERS;
use serde::Serialize;

use crate::batch::{Batch, check_inputs, workers};
use crate::failure::Failure;
use crate::files::{Output, load};
use crate::progress::Bar;
use crate::terminal::{print, print_json};
use crate::usage::check_json;
use crate::watch::stop_on_interrupt;

pub fn info(models: &[PathBuf], options: &ReadOptions, json: bool) -> Result<(), Failure> {
    check_inputs("info", models);
    let [model] = models else {
        let batch = Batch {
            models,
            outputs: Vec::new(),
            is_json: json,
            workers: workers(),
        };
        return batch.run(|place, _| Ok(load(&models[place], options)?.info()));
    };
    let info = load(model, options)?.info();
    if json {
        print_json(&info)?;
    } else {
        print(&describe_mesh(&info))?;
    }
    Ok(())
}

fn describe_mesh(info: &MeshInfo) -> String {
    let [x, y, z] = info.size_mm;
    let mut text = format!(
        "size     {x:.3} × {y:.3} × {z:.3} mm\nfacets   {}\nvertices {}\nvolume   {:.3} ml\nclosed   {}",
        info.facets,
        info.vertices,
        info.volume_mm3 / 1e3,
        if info.closed { "yes" } else { "no" },
    );
    if let Some(unit) = info.unit {
        let _ = write!(text, "\nunit     {}, as the file states", unit.name());
    }
    for warning in &info.warnings {
        let _ = write!(text, "\nwarning  {warning}");
    }
    text
}

/// A file of weights that was written.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Weighed {
    /// Facets of the surface, each with a weight.
    pub facets: usize,
}

pub fn saliency(model: &Path, output: &Path, json: bool) -> Result<(), Failure> {
    check_json("saliency", Some(output), json);
    let output = Output::new(output, Some(model), "model")?;
    let mut loaded = load(model, &ReadOptions::default())?;
    stop_on_interrupt();
    let facets = output.write(|mut writer| {
        let bar = Bar::new();
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let saliency = loaded
            .saliency(&mut progress)
            .map_err(|error| Failure::in_file(model, &error))?
            .to_vec();
        let written = writer.write_all(&weights::to_bytes(&saliency, &loaded.positions()));
        written.map_err(|error| output.failed(&error))?;
        Ok((writer, saliency.len()))
    })?;
    if json {
        print_json(&Weighed { facets })?;
    }
    Ok(())
}

pub fn printers(json: bool) -> Result<(), Failure> {
    if json {
        return Ok(print_json(&*PRINTERS)?);
    }
    let mut text = format!(
        "{:<20} {:<30} {:>12}  {:<17} {:<23} {:<16} {:<9} reads",
        "name", "printer", "pixels", "pitch (µm)", "volume (mm)", "format", "variable"
    );
    for printer in PRINTERS.iter() {
        let by = |sides: &[f64]| {
            sides
                .iter()
                .map(f64::to_string)
                .collect::<Vec<_>>()
                .join(" × ")
        };
        let _ = write!(
            text,
            "\n{:<20} {:<30} {:>12}  {:<17} {:<23} {:<16} {:<9} {}{}",
            printer.name,
            printer.model,
            format!("{} × {}", printer.pixels[0], printer.pixels[1]),
            by(&printer.pitch_um),
            by(&printer.volume_mm),
            printer.format.name(),
            printer.variable_layers.name(),
            printer.reads.join(", "),
            if printer.reads_format {
                ""
            } else {
                " by a converter"
            }
        );
    }
    Ok(print(&text)?)
}
