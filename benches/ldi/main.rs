//! Time of sampling on the CPU, by facets and rays: `cargo xtask bench ldi [MODEL.stl …]`.
//!
//! Prints a table in Markdown. Times are the minimum of several runs; the growth exponent is that of time against
//! facets + hits, fitted over all rows in which that sum is at least a million.
//!
//! `cargo xtask bench ldi --layers MODEL.stl` draws docs/layers.png instead: what each pass of depth peeling finds.

#[path = "../common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
mod layers;
#[path = "../common/png_file.rs"]
mod png_file;
#[path = "../../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{balls, named, time};
use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::{Hit, Ldi, cpu};
use cusp_slicer::progress::silent;

fn bytes(ldi: &Ldi) -> usize {
    ldi.hits.len() * size_of::<Hit>() + ldi.offsets.len() * size_of::<u32>()
}

/// The slope of the line fitted to points of (ln work, ln time).
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let covariance: f64 = points
        .iter()
        .map(|point| (point.0 - x) * (point.1 - y))
        .sum();
    covariance
        / points
            .iter()
            .map(|point| (point.0 - x).powi(2))
            .sum::<f64>()
}

fn main() {
    if std::env::args().any(|argument| argument == "--layers") {
        let (_, mesh) = named().next().expect("a model: --layers MODEL.stl");
        let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        std::fs::write(docs.join("layers.png"), layers::picture(&mesh)).expect("docs/layers.png");
        return;
    }
    println!("| facets | rays | hits | ms | hits/µs | bytes/hit |");
    println!("|---:|---:|---:|---:|---:|---:|");
    let mut points = Vec::new();
    let generated = [(1, 1, 5), (1, 1, 7), (2, 2, 7), (2, 10, 7)]
        .map(|(columns, layers, levels)| balls(columns, layers, levels));
    for mesh in named().map(|(_, mesh)| mesh).chain(generated) {
        for side in [512, 2048, 8192] {
            let grid = Grid::around(&mesh.bounds(), side).unwrap();
            let (seconds, ldi) = time(|| cpu::sample(&mesh, &grid, &mut silent).unwrap());
            let work = (mesh.facets.len() + ldi.hits.len()) as f64;
            if work >= 1e6 {
                points.push((work.ln(), seconds.ln()));
            }
            println!(
                "| {} | {} | {} | {:.1} | {:.0} | {:.1} |",
                mesh.facets.len(),
                ldi.rays(),
                ldi.hits.len(),
                seconds * 1e3,
                ldi.hits.len() as f64 / seconds / 1e6,
                bytes(&ldi) as f64 / ldi.hits.len() as f64,
            );
        }
    }
    println!(
        "\ngrowth exponent of time over facets + hits: {:.2}",
        slope(&points)
    );
}
