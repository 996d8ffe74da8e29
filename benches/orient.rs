//! Time of the orientation search, by facets, directions, rays and threads: `cargo xtask bench orient [MODEL.stl …]`.
//!
//! Prints tables in Markdown. Models are 60 mm high, bins 2 µm. Times are the minimum of several whole searches, refinement
//! included; the growth exponents are those of time against facets, and against directions, fitted over all rows.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "paper/models.rs"]
#[expect(dead_code, reason = "the paper's tables use the other models")]
mod models;
#[path = "../tests/common/slicer.rs"]
mod slicer;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use std::fs;
use std::ops::ControlFlow;
use std::time::Instant;

use common::exponent;
use cusp_slicer::job::{Options, OrientationReport};
use cusp_slicer::orientation::SearchOptions;
use slicer::Slicer;

/// The time budget of one row; its first run may exceed it.
const BUDGET_S: f64 = 4.0;

/// A time in milliseconds, and a search.
type Timed = (f64, OrientationReport);

/// The minimum time of several searches, each from the loaded model on.
fn search(bytes: &[u8], options: &Options, directions: usize) -> Timed {
    let search = SearchOptions {
        directions,
        ..SearchOptions::default()
    };
    let all = Instant::now();
    let mut least = f64::INFINITY;
    loop {
        let mut slicer = Slicer::load(bytes).expect("a model");
        let clock = Instant::now();
        let found = slicer
            .orient(options, &search, &mut |_, _| ControlFlow::Continue(()))
            .expect("directions");
        least = least.min(clock.elapsed().as_secs_f64() * 1e3);
        if all.elapsed().as_secs_f64() > BUDGET_S {
            return (least, found);
        }
    }
}

fn options() -> Options {
    Options {
        height_mm: Some(60.0),
        ..Options::default()
    }
}

/// The head, with approximately this many facets.
fn head(facets: usize) -> Vec<u8> {
    let rings = (facets as f64 / 4.0).sqrt().round() as u32;
    solids::binary_stl(&models::head(rings))
}

fn row(name: &str, (ms, found): &Timed) {
    let measured = found.candidates.len();
    let layers = found
        .best
        .iter()
        .map(|best| best.metrics.map_or(0, |metrics| metrics.layers).to_string())
        .collect::<Vec<_>>();
    println!(
        "| {name} | {ms:.0} | {:.2} | {} |",
        ms / measured as f64,
        layers.join(", ")
    );
}

fn table(head: &str) {
    println!(
        "\n| {head} | ms | ms per direction | layers of the best three |\n|---|---:|---:|---|"
    );
}

fn main() {
    let models: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with('-'))
        .collect();
    println!("{} threads", rayon::current_num_threads());
    if !models.is_empty() {
        table("model, 1,000 directions");
        for model in &models {
            let bytes = fs::read(model).expect("a readable model");
            let name = std::path::Path::new(model).file_stem();
            let name = name.map_or_else(String::new, |name| name.display().to_string());
            row(&name, &search(&bytes, &options(), 1000));
        }
        return;
    }

    table("facets, 1,000 directions");
    let mut points = Vec::new();
    for facets in [25_000, 50_000, 100_000, 200_000, 400_000, 800_000] {
        let bytes = head(facets);
        let timed = search(&bytes, &options(), 1000);
        let facets = (bytes.len() - 84) / 50;
        points.push((facets as f64, timed.0));
        row(&facets.to_string(), &timed);
    }
    println!(
        "\nGrowth with facets: time ~ facets^{:.2}",
        exponent(&points)
    );

    let bytes = head(100_000);
    table("directions, 100,000 facets");
    let mut points = Vec::new();
    for directions in [250, 500, 1000, 2000, 4000] {
        let timed = search(&bytes, &options(), directions);
        points.push((directions as f64, timed.0));
        row(&directions.to_string(), &timed);
    }
    println!(
        "\nGrowth with directions: time ~ directions^{:.2}",
        exponent(&points)
    );

    table("rays across, 1,000 directions");
    for rays in [256, 2048, 16_384] {
        let options = Options { rays, ..options() };
        row(&rays.to_string(), &search(&bytes, &options, 1000));
    }

    table("threads, 1,000 directions");
    for threads in [1, rayon::current_num_threads()] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let timed = pool
            .expect("threads")
            .install(|| search(&bytes, &options(), 1000));
        row(&threads.to_string(), &timed);
    }
}
