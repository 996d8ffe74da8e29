//! Time and memory of the checks of printability: `cargo xtask bench inspect [MODEL.stl …]`.
//!
//! Prints a table in Markdown: a ball, 10,000 struts and each model named, 60 mm high, on more and more pixels, and the ball on a 12K screen;
//! all in 800 layers. Below it stands how time grows with hits. Times are the minimum of several runs, from finished masks. Memory is the most that the
//! checks hold, without that of the LDI.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{exponent, named, on_plate, time};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::inspect::{Held, Limits, inspect};
use cusp_slicer::ldi::{Hit, cpu};
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::plan::uniform;
use cusp_slicer::progress::silent;
use glam::Vec3;
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

const LAYERS: f64 = 800.0;

/// Rays along the longer side.
const RAYS: [u32; 4] = [512, 1024, 2048, 4096];

/// Prints a row, and returns its millions of hits and its seconds.
fn row(name: &str, mesh: &Mesh, grid: &Grid) -> (f64, f64) {
    let ldi = cpu::sample(mesh, &grid.around_model(&mesh.bounds()), &mut silent).expect("an LDI");
    let height_mm = mesh.bounds().size().z;
    let layer_mm = height_mm / LAYERS;
    let bins = Bins::of_height(height_mm, layer_mm / 5.0).expect("bins");
    let plan = uniform::plan(bins, height_mm, layer_mm, 0).expect("a plan");
    let hits = ldi.hits.len();
    let ldi_bytes = hits * size_of::<Hit>() + ldi.rays() * size_of::<u32>();
    let masks = Masks::new(&ldi, &plan, grid, Samples::ONE, Side::Above);
    drop(ldi);
    let check = || {
        inspect(
            &masks,
            None,
            &plan,
            &Limits::default(),
            &Held::default(),
            &mut silent,
        )
        .expect("findings")
    };
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let found = check();
    let bytes = ALLOCATOR.peak_usage() - before;
    let (seconds, _) = time(check);
    let findings: usize = found.counts.iter().map(|count| count.found).sum();
    println!(
        "| {name} | {:.2} | {:.0} | {:.1} | {findings} | {:.0} | {:.0} |",
        hits as f64 / 1e6,
        seconds * 1e3,
        seconds * 1e9 / hits as f64,
        bytes as f64 / 1e6,
        ldi_bytes as f64 / 1e6,
    );
    (hits as f64 / 1e6, seconds)
}

/// Rows of a model on more and more rays, and how time grows with hits.
fn rows(name: &str, mesh: &Mesh, rays: &[u32]) -> String {
    let on = |&rays| {
        let grid = Grid::around(&mesh.bounds(), rays).expect("a grid");
        row(&format!("{name} at {rays}"), mesh, &grid)
    };
    let points: Vec<(f64, f64)> = rays.iter().map(on).collect();
    format!("{name}: time ~ hits^{:.2}", exponent(&points))
}

/// Struts in three directions, `side` × `side` of them in each.
fn struts(side: usize) -> Mesh {
    let step = 1.0;
    let length = step * side as f32;
    let mut all = Vec::new();
    for i in 0..side * side {
        let (a, b) = ((i % side) as f32 * step, (i / side) as f32 * step);
        let thick = 0.2;
        for axis in 0..3 {
            let turned = |v: Vec3| match axis {
                0 => v,
                1 => Vec3::new(v.y, v.z, v.x),
                _ => Vec3::new(v.z, v.x, v.y),
            };
            let strut = solids::cuboid(turned(Vec3::new(length, thick, thick)));
            all.extend(solids::moved(&strut, turned(Vec3::new(0.0, a, b))));
        }
    }
    on_plate(&all, &Pose::default())
}

fn main() {
    println!(
        "| model | hits, millions | time, ms | ns per hit | findings | memory, MB | LDI, MB |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let ball = on_plate(&solids::sphere(20.0, 7), &Pose::default());
    let mut growth = vec![rows("ball", &ball, &RAYS)];
    let grid = Grid::plate(&ball.bounds(), [11520, 5120], [0.008; 2]).expect("a grid");
    row("ball on a 12K screen", &ball, &grid);
    growth.push(rows("10,092 struts", &struts(58), &RAYS[..3]));
    for (name, mesh) in named() {
        growth.push(rows(&name, &mesh, &RAYS));
    }
    println!("\n{}", growth.join("\n"));
}
