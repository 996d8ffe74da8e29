//! How long sampling takes, by facets, rays and backend: `cargo xtask bench ldi [MODEL.stl …]`.
//!
//! Prints a table in Markdown. Times are the minimum of several runs; the growth exponent is that of time against
//! facets + hits, fitted over all rows in which that sum is at least a million.

#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use std::time::Instant;

use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::gpu::{self, Gpu, Method};
use cusp_slicer::ldi::{Hit, Ldi, cpu};
use cusp_slicer::model::read;
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::progress::silent;
use glam::Vec3;

/// The time budget of one cell; its first run may exceed it.
const BUDGET_S: f64 = 1.0;

/// A grid of spheres, `columns` × `columns` × `layers`, each subdivided `levels` times.
fn balls(columns: usize, layers: usize, levels: u32) -> solids::Triangles {
    let ball = solids::sphere(5.0, levels);
    let place = |i: usize| {
        let (x, y, z) = (i % columns, i / columns % columns, i / columns / columns);
        Vec3::new(x as f32, y as f32, z as f32) * 9.0
    };
    (0..columns * columns * layers)
        .flat_map(|i| solids::moved(&ball, place(i)))
        .collect()
}

/// The minimum time of several runs in seconds, and the last result.
fn time<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let all = Instant::now();
    let mut least = f64::INFINITY;
    loop {
        let clock = Instant::now();
        let result = work();
        least = least.min(clock.elapsed().as_secs_f64());
        if all.elapsed().as_secs_f64() > BUDGET_S {
            return (least, result);
        }
    }
}

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

fn on_gpu(mesh: &Mesh, grid: &Grid, device: &Gpu, method: Method) -> Ldi {
    let mut progress = silent;
    let job = gpu::sample(
        mesh,
        grid,
        device,
        gpu::Tiling::default(),
        method,
        &mut progress,
    );
    pollster::block_on(job).expect("hits")
}

fn main() {
    let device = pollster::block_on(Gpu::open(gpu::Adapters::Any));
    match &device {
        Ok(device) => println!("GPU: {}, with read-back\n", device.name()),
        Err(error) => println!("{error}\n"),
    }
    println!(
        "| facets | rays | hits | deepest ray | CPU ms | hits/µs | bytes/hit | GPU, filling, ms | GPU, peeling, ms |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let mut points = Vec::new();
    let generated = [(1, 1, 5), (1, 1, 7), (2, 2, 7), (2, 10, 7)]
        .map(|(columns, layers, levels)| Mesh::from_triangles(&balls(columns, layers, levels)));
    // Models named on the command line come first, 60 mm high.
    let named = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with('-'));
    let named =
        named.map(|path| Mesh::from_triangles(&read::read(&std::fs::read(path).unwrap()).unwrap()));
    let models = named.map(|mesh| mesh.unwrap().on_plate(&Pose::of_height(60.0)));
    for mesh in models.chain(
        generated
            .into_iter()
            .map(|mesh| mesh.unwrap().on_plate(&Pose::default())),
    ) {
        let mesh = mesh.unwrap();
        for side in [512, 2048, 8192] {
            let grid = Grid::around(&mesh.bounds(), side).unwrap();
            let (seconds, ldi) = time(|| cpu::sample(&mesh, &grid, &mut silent).unwrap());
            let work = (mesh.facets.len() + ldi.hits.len()) as f64;
            if work >= 1e6 {
                points.push((work.ln(), seconds.ln()));
            }
            // An emulated GPU takes minutes for the largest models.
            let on_gpu = [Method::Fill, Method::Peel].map(|method| match &device {
                Ok(device) if work < 2e7 => {
                    let (seconds, found) = time(|| on_gpu(&mesh, &grid, device, method));
                    assert!(found == ldi, "the backends differ by {method:?}");
                    format!("{:.0}", seconds * 1e3)
                }
                _ => "–".to_owned(),
            });
            let deepest = ldi.offsets.windows(2).map(|ray| ray[1] - ray[0]).max();
            println!(
                "| {} | {} | {} | {} | {:.1} | {:.0} | {:.1} | {} |",
                mesh.facets.len(),
                ldi.rays(),
                ldi.hits.len(),
                deepest.unwrap_or(0),
                seconds * 1e3,
                ldi.hits.len() as f64 / seconds / 1e6,
                bytes(&ldi) as f64 / ldi.hits.len() as f64,
                on_gpu.join(" | "),
            );
        }
    }
    println!(
        "\ngrowth exponent of the CPU's time over facets + hits: {:.2}",
        slope(&points)
    );
}
