//! Depth peeling against the scanline, solid by solid, on whatever adapter wgpu finds; reported as ignored
//! where there is none.
//!
//! Adapters that rasterise on the lattice of 1/256 pixel find the very same hits. On coarser ones,
//! rays near an edge may differ; how many is recorded below.

mod common;

use common::{on_plate, solids};
use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::{Ldi, LdiError, cpu, gpu};
use cusp_slicer::progress::silent;
use libtest_mimic::{Arguments, Failed, Trial};

/// The part of all rays that may differ from the CPU's, by adapter: measured, then rounded up.
const RECORDED: [(&str, f64); 2] = [("llvmpipe", 0.0), ("SwiftShader", 0.008)];
/// For adapters not measured yet: a sixteenth of a pixel along the edges of these solids.
const UNKNOWN: f64 = 0.008;

fn sample_both(triangles: &solids::Triangles, rays: u32) -> Result<(Ldi, Ldi, String), LdiError> {
    let mesh = on_plate(triangles);
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    let expected = cpu::sample(&mesh, &grid, &mut silent)?;
    let mut progress = silent;
    let job = gpu::sample(&mesh, &grid, gpu::Adapters::Any, &mut progress);
    let (found, adapter) = pollster::block_on(job)?;
    Ok((expected, found, adapter))
}

fn compare(
    name: &str,
    triangles: &solids::Triangles,
    rays: u32,
    clipped: f64,
) -> Result<(), Failed> {
    let (expected, found, adapter) = sample_both(triangles, rays)?;
    let differing = (0..expected.rays())
        .filter(|&ray| expected.ray(ray) != found.ray(ray))
        .count();
    let part = differing as f64 / expected.rays() as f64;
    let recorded = RECORDED.iter().find(|(known, _)| adapter.contains(known));
    let allowed = recorded.map_or(UNKNOWN, |(_, part)| *part) + clipped;
    println!(
        "{name}: {differing} of {} rays differ on {adapter}",
        expected.rays()
    );
    if part > allowed {
        return Err(
            format!("{part} of the rays differ on {adapter}, {allowed} is recorded").into(),
        );
    }
    Ok(())
}

/// Hits that both backends find are the same to the last bit.
fn shared_hits_are_equal() -> Result<(), Failed> {
    let (expected, found, _) = sample_both(&solids::sphere(10.0, 5), 300)?;
    for ray in 0..expected.rays() {
        for hit in found.ray(ray) {
            let twin = expected
                .ray(ray)
                .iter()
                .find(|other| other.facet() == hit.facet());
            if let Some(twin) = twin.filter(|twin| *twin != hit) {
                return Err(format!("ray {ray}: {hit:?} against {twin:?}").into());
            }
        }
    }
    Ok(())
}

/// A grid wider than a tile, in which facets span several tiles: clipping them may move their edges by
/// a rounding error.
fn tiles_have_no_seams() -> Result<(), Failed> {
    compare("wide cone", &solids::cone(9.0, 14.0, 16), 2500, 1e-5)
}

fn main() {
    let arguments = Arguments::from_args();
    let probe = sample_both(&solids::cube(1.0), 4);
    let missing = matches!(probe, Err(LdiError::NoGpu { .. }));
    if let Err(LdiError::NoGpu { reason }) = &probe {
        println!("every test is ignored: no usable GPU: {reason}");
    }
    let mut trials: Vec<Trial> = solids::all()
        .into_iter()
        .map(|(name, triangles)| {
            let title = format!("gpu equals cpu on the {name}");
            Trial::test(title, move || compare(name, &triangles, 300, 0.0))
        })
        .collect();
    trials.push(Trial::test(
        "hits found by both are equal",
        shared_hits_are_equal,
    ));
    trials.push(Trial::test("tiles have no seams", tiles_have_no_seams));
    let trials = trials
        .into_iter()
        .map(|trial| trial.with_ignored_flag(missing))
        .collect();
    libtest_mimic::run(&arguments, trials).exit();
}
