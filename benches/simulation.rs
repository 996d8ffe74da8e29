//! Simulation of the print files of plans: `cargo xtask bench simulation MODEL.stl …`.
//!
//! For each model, 60 mm high at 2048 rays: layers, the bound that the plan promises, both simulated distances, and how long the
//! simulation took, under the cusp height, the deviation, the greedy planner and uniform layers. All keep the same tolerance, 65 µm of
//! cusp height or 32.5 µm to either side: a uniform layer of 65 µm does so on every slope.

#[path = "../tests/common/slicer.rs"]
mod slicer;

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use cusp_slicer::job::{Backend, Options, Planner, Stage};
use cusp_slicer::model::read;
use cusp_slicer::profile::Metric;
use cusp_slicer::progress::silent;
use cusp_slicer::simulation::{Knowledge, Original, simulate};
use slicer::Slicer;

fn quiet(_: Stage, _: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn main() {
    let plain = Options {
        height_mm: Some(60.0),
        backend: Backend::Cpu,
        ..Options::default()
    };
    let plans = [
        ("cusp height", plain.clone()),
        (
            "deviation",
            Options {
                metric: Metric::Deviation,
                ..plain.clone()
            },
        ),
        (
            "greedy",
            Options {
                planner: Planner::Greedy,
                ..plain.clone()
            },
        ),
        (
            "uniform",
            Options {
                planner: Planner::Uniform { layer_mm: 0.065 },
                ..plain
            },
        ),
    ];
    println!(
        "| model | plan | layers | bound (µm) | print to model (µm) | half diagonal (µm) | model to print (µm) | simulation (s) |\n\
         |---|---|---:|---:|---:|---:|---:|---:|"
    );
    for path in std::env::args().skip(1).filter(|it| !it.starts_with('-')) {
        let bytes = std::fs::read(&path).expect("a model to read");
        let contents = read::read(&bytes).expect("an STL");
        let originals = [Original::of(&contents).expect("a mesh")];
        let name = Path::new(&path).file_stem().unwrap_or_default();
        let mut slicer = Slicer::load(&bytes).expect("a model");
        for (plan, options) in &plans {
            let report = pollster::block_on(slicer.plan(options, &mut quiet)).cloned();
            let report = report.expect("a plan");
            let (print_file, _) = slicer
                .write_archive(Vec::new(), &mut quiet)
                .expect("a file");
            let clock = Instant::now();
            let found = simulate(&originals, &print_file, &Knowledge::default(), &mut silent);
            let seconds = clock.elapsed().as_secs_f64();
            let found = found.expect("a simulation");
            let um = |mm: f64| format!("{:.1}", mm * 1000.0);
            println!(
                "| {} | {plan} | {} | {} | {} | {} | {} | {seconds:.1} |",
                name.display(),
                report.layers,
                um(report.max_deviation_mm),
                um(found.print_to_model.max_mm),
                um(found.half_pixel_diagonal_mm),
                um(found.model_to_print.max_mm),
            );
        }
    }
}
