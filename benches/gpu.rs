//! Filling, depth peeling and the CPU, by model and rays, on whatever adapter wgpu finds: `cargo xtask bench gpu [MODEL.stl …]`.
//!
//! Prints a table in Markdown: times are the minimum of several runs, in milliseconds. The time of the GPU, reading its
//! result included, and the time of the CPU afterwards are separate. A row whose results differ says so, and the bench
//! then fails.

#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Instant;

use common::{balls, named, on_plate, time};
use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::gpu::{self, Adapters, Gpu, Method};
use cusp_slicer::ldi::{Ldi, LdiError, cpu};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::progress::silent;

/// Facets and hits together that an emulated GPU can sample within a minute.
const EMULATED_MOST: usize = 20_000_000;

/// Rays along the longer side of a model.
const SIDES: [u32; 3] = [512, 2048, 8192];

/// The share of its progress at which a GPU's result has been read.
const READ: f64 = 0.8;

/// Times of sampling on a GPU, in seconds.
#[derive(Clone, Copy)]
struct Times {
    on_gpu: f64,
    afterwards: f64,
}

impl Times {
    fn all(self) -> f64 {
        self.on_gpu + self.afterwards
    }
}

/// The fastest of several runs, and whether all gave `expected`.
fn sample(
    mesh: &Mesh,
    grid: &Grid,
    gpu: &Gpu,
    method: Method,
    expected: &Ldi,
) -> Result<Times, LdiError> {
    let mut best: Option<Times> = None;
    let (_, outcome) = time(|| -> Result<bool, LdiError> {
        let clock = Instant::now();
        let mut read = None;
        let mut progress = |fraction| {
            if fraction >= READ && read.is_none() {
                read = Some(clock.elapsed().as_secs_f64());
            }
            ControlFlow::Continue(())
        };
        let tiling = gpu::Tiling::default();
        let job = gpu::sample(mesh, grid, gpu, tiling, method, &mut progress);
        let found = pollster::block_on(job)?;
        let all = clock.elapsed().as_secs_f64();
        let on_gpu = read.unwrap_or(all);
        let times = Times {
            on_gpu,
            afterwards: all - on_gpu,
        };
        if best.is_none_or(|best| times.all() < best.all()) {
            best = Some(times);
        }
        Ok(found == *expected)
    });
    if outcome? {
        Ok(best.expect("a run"))
    } else {
        panic!("{method:?} differs from the CPU on {}", gpu.name());
    }
}

/// Models, each with its name and the rays along the longer side of its grids.
fn models() -> impl Iterator<Item = (String, Mesh, Vec<u32>)> {
    // Their hits would not fit into memory on larger grids.
    let stacks = [(2, 2048), (10, 512), (100, 256)].map(|(slabs, side)| {
        let mesh = on_plate(&solids::stack(slabs), &Pose::default());
        (format!("{slabs} slabs"), mesh, vec![side])
    });
    let balls = [("ball", 1, 5), ("ball", 1, 7), ("8 balls", 2, 7)]
        .map(|(name, side, levels)| (name.to_owned(), balls(side, side, levels), SIDES.to_vec()));
    let named = named().map(|(name, mesh)| (name, mesh, SIDES.to_vec()));
    named.chain(stacks).chain(balls)
}

fn main() -> ExitCode {
    let opened = Instant::now();
    let gpu = match pollster::block_on(Gpu::open(Adapters::Any)) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    let opened_ms = opened.elapsed().as_secs_f64() * 1e3;
    let hardware = pollster::block_on(Gpu::open(Adapters::Hardware));
    let is_emulated = matches!(hardware, Err(LdiError::GpuEmulated { .. }));
    let kind = if is_emulated { "emulated" } else { "hardware" };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!(
        "{}, {kind}, opened in {opened_ms:.0} ms, can {}; {threads} threads\n",
        gpu.name(),
        gpu.method().name(),
    );
    println!(
        "| model | facets | rays | hits | deepest ray | passes of peeling | CPU | filling: GPU + CPU | peeling: GPU + CPU | faster |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---|");
    let mut wrong = Vec::new();
    for (name, mesh, sides) in models() {
        for side in sides {
            let grid = Grid::around(&mesh.bounds(), side).expect("a grid");
            let facets = mesh.facets.len();
            let (on_cpu, ldi) = time(|| cpu::sample(&mesh, &grid, &mut silent).expect("hits"));
            if is_emulated && facets + ldi.hits.len() > EMULATED_MOST {
                continue;
            }
            let found =
                [Method::Fill, Method::Peel].map(|method| sample(&mesh, &grid, &gpu, method, &ldi));
            let cells = found.each_ref().map(|found| match found {
                Ok(it) => format!("{:.0} + {:.0}", it.on_gpu * 1e3, it.afterwards * 1e3),
                Err(error) => error.to_string(),
            });
            let on_gpu = found.iter().flatten().map(|it| it.all());
            let on_gpu = on_gpu.fold(f64::INFINITY, f64::min);
            let faster = if on_gpu < on_cpu { "GPU" } else { "CPU" };
            let is_chosen = !is_emulated && gpu::can_be_faster(facets, ldi.rays());
            if is_chosen != (on_gpu < on_cpu) {
                wrong.push(format!(
                    "{name}, {} rays: {:.2}",
                    ldi.rays(),
                    on_cpu / on_gpu
                ));
            }
            let deepest = ldi.offsets.windows(2).map(|ray| ray[1] - ray[0]).max();
            let deepest = deepest.unwrap_or(0);
            println!(
                "| {name} | {facets} | {} | {} | {deepest} | {} | {:.0} | {} | {faster} |",
                ldi.rays(),
                ldi.hits.len(),
                deepest.div_ceil(2),
                on_cpu * 1e3,
                cells.join(" | "),
            );
        }
    }
    if wrong.is_empty() {
        println!("\nAll results are equal. `--backend auto` chooses what is faster in every row.");
    } else {
        println!(
            "\nAll results are equal. `--backend auto` chooses what is slower here; the CPU's time over the GPU's:\n"
        );
        for row in wrong {
            println!("- {row}");
        }
    }
    ExitCode::SUCCESS
}
