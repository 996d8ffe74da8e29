//! Time and weight of supports: `cargo xtask bench support [MODEL.stl …]`.
//!
//! Prints tables in Markdown: a ball and each model named, 60 mm high, with supports of each strength, and the
//! estimates of the orientation search compared with the supports that are built. Times are the minimum of several
//! runs. Volumes of the first table count overlaps once per body.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/slicer.rs"]
mod slicer;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{named, on_plate, time};
use cusp_slicer::job::Options;
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::orientation::Task;
use cusp_slicer::prepare::{SupportStrength, Supporting, support};
use cusp_slicer::progress::silent;
use peak_alloc::PeakAlloc;
use slicer::Slicer;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() {
    let ball = on_plate(&solids::sphere(30.0, 7), &Pose::default());
    let models: Vec<(String, Mesh)> = std::iter::once(("ball".to_owned(), ball))
        .chain(named())
        .collect();
    strengths(&models);
    println!();
    estimates(&models);
}

fn strengths(models: &[(String, Mesh)]) {
    println!(
        "| model | facets | strength | time, ms | contacts | unreached | on the model | volume, ml | facets | memory, MB |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|---:|---:|---:|");
    for (name, mesh) in models {
        for strength in [
            SupportStrength::Light,
            SupportStrength::Medium,
            SupportStrength::Heavy,
        ] {
            let supporting = Supporting {
                strength,
                ..Supporting::default()
            };
            let work = || support(mesh, &supporting, None, 0.0, &mut silent).expect("no failure");
            let before = ALLOCATOR.current_usage();
            ALLOCATOR.reset_peak_usage();
            drop(work());
            let bytes = ALLOCATOR.peak_usage() - before;
            let (seconds, supports) = time(work);
            println!(
                "| {name} | {} | {strength:?} | {:.0} | {} | {} | {} | {:.2} | {} | {:.0} |",
                mesh.surface_facets,
                seconds * 1e3,
                supports.points.len(),
                supports.unreached.len(),
                supports.on_model,
                supports.shell.volume_mm3() / 1e3,
                supports.shell.facets.len(),
                bytes as f64 / 1e6,
            );
        }
    }
}

/// Compares estimates of contacts and volume with supports that are built, along the axes and the space diagonals.
fn estimates(models: &[(String, Mesh)]) {
    println!(
        "| model | contacts, estimated for built | ml, likewise | order of contacts | order of ml |"
    );
    println!("|---|---:|---:|---:|---:|");
    let mut silent = |_, _| std::ops::ControlFlow::Continue(());
    let options = Options {
        supports: Some(Supporting::default()),
        pitch_mm: Some(0.1),
        ..Options::default()
    };
    let profile = SupportStrength::default().profile();
    let contact_mm2 = std::f64::consts::PI / 4.0 * profile.contact_mm * profile.contact_mm;
    for (name, mesh) in models {
        let corners =
            (0..mesh.surface_facets).map(|facet| mesh.corners(facet).map(glam::DVec3::as_vec3));
        let file = solids::binary_stl(&corners.collect::<Vec<_>>());
        let mut slicer = Slicer::load(&file).expect("a model");
        let directions =
            (0..27).map(|it| [it % 3, it / 3 % 3, it / 9].map(|part| f64::from(part - 1)));
        let directions = directions.map(|it| (it, it.iter().map(|part| part * part).sum::<f64>()));
        let directions = directions.filter(|&(_, squares)| squares == 1.0 || squares == 3.0);
        let directions = directions.map(|(it, squares)| it.map(|part| part / squares.sqrt()));
        let task = Task {
            number: 0,
            directions: directions.collect(),
        };
        let found = slicer.evaluate(&options, task).expect("no failure");
        let mut contacts = Vec::new();
        let mut volumes = Vec::new();
        for candidate in &found.candidates {
            let metrics = candidate.metrics.expect("a plan");
            let posed = Options {
                rotation: Some(candidate.rotation),
                ..options.clone()
            };
            let report = pollster::block_on(slicer.plan(&posed, &mut silent)).expect("a plan");
            let built = report.models[0].supported.as_ref().expect("supports");
            let points = built.points.len() + built.unreached.len();
            contacts.push([metrics.contact_mm2 / contact_mm2, points as f64]);
            volumes.push([metrics.support_ml, built.support_ml]);
        }
        println!(
            "| {name} | {} | {} | {:.2} | {:.2} |",
            spread(&contacts),
            spread(&volumes),
            agreement(&contacts),
            agreement(&volumes)
        );
    }
}

/// The median, the second least and the second largest ratio of the estimate to the supports that are built.
fn spread(pairs: &[[f64; 2]]) -> String {
    let mut parts: Vec<f64> = pairs
        .iter()
        .map(|[estimated, built]| estimated / built)
        .collect();
    parts.sort_by(f64::total_cmp);
    let [least, median, most] = [1, parts.len() / 2, parts.len() - 2].map(|at| parts[at]);
    format!("{median:.2}, {least:.2} to {most:.2}")
}

/// Agreement of both orders: Spearman's coefficient, 1 for the same order.
fn agreement(pairs: &[[f64; 2]]) -> f64 {
    let ranks = [0, 1].map(|side| {
        let rank = |pair: &[f64; 2]| pairs.iter().filter(|it| it[side] < pair[side]).count() as f64;
        pairs.iter().map(rank).collect::<Vec<f64>>()
    });
    let count = pairs.len() as f64;
    let means = ranks.each_ref().map(|it| it.iter().sum::<f64>() / count);
    let product = |one: usize, other: usize| -> f64 {
        let pairs = ranks[one].iter().zip(&ranks[other]);
        pairs
            .map(|(a, b)| (a - means[one]) * (b - means[other]))
            .sum()
    };
    product(0, 1) / (product(0, 0) * product(1, 1)).sqrt()
}
