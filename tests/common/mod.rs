//! Shared by the suites of all programs: solids with closed forms, naive oracles and small helpers.

#![allow(
    dead_code,
    unused_imports,
    reason = "each program uses a different part of this module"
)]

pub mod oracle;
pub mod slicer;
pub mod solids;

pub use slicer::Slicer;
pub use solids::binary_stl;

use std::env;
use std::ops::ControlFlow;
use std::process::Command;

use cusp_slicer::Error;
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::job::{Options, Stage};
use cusp_slicer::ldi::visibility::{Visibility, visibility};
use cusp_slicer::ldi::{Ldi, MeshRays, RayImage, Survey, cpu};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::progress::silent;
use glam::Vec3;

/// A slicer of the model that a file of these triangles has.
pub fn load(triangles: &[[Vec3; 3]]) -> Slicer {
    Slicer::load(&binary_stl(triangles)).unwrap()
}

/// The least memory within which a job can be done.
#[cfg(not(target_arch = "wasm32"))]
pub fn least_memory_bytes(triangles: &[[Vec3; 3]], options: &Options) -> u64 {
    let mut slicer = load(triangles).with_memory(1);
    let planned = pollster::block_on(slicer.plan(options, &mut quiet));
    match planned.map(|report| report.layers) {
        Err(Error::MemoryBound {
            needed_bytes,
            allowed_bytes: 1,
        }) => needed_bytes,
        other => panic!("{other:?}"),
    }
}

/// Bins of 1 mm.
pub fn bins(count: usize) -> Bins {
    Bins {
        count,
        size_mm: 1.0,
    }
}

/// A mesh of these triangles, on the plate.
pub fn on_plate(triangles: &[[Vec3; 3]]) -> Mesh {
    Mesh::from_triangles(triangles)
        .unwrap()
        .on_plate(&Pose::default())
        .unwrap()
}

/// A mesh on the plate, and its LDI with `rays` rays along the longer side, sampled on the CPU.
pub fn sample(triangles: &[[Vec3; 3]], rays: u32) -> (Mesh, Ldi) {
    let mesh = on_plate(triangles);
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    let ldi = cpu::sample(&mesh, &grid, &mut silent).unwrap();
    (mesh, ldi)
}

/// The facets of a mesh that its rays see.
pub fn seen_along(mesh: &Mesh, ldi: &Ldi) -> Visibility {
    let image = RayImage::Kept(ldi);
    let (survey, overlaps) = Survey::with_overlaps(image, &mut silent).unwrap();
    let rays = MeshRays {
        mesh,
        image,
        overlaps: Some(&overlaps),
    };
    visibility(rays, &survey, &mut silent).unwrap()
}

/// A grid around the model, shifted by `shift` pixels from the grid that just covers it.
pub fn shifted_grid(mesh: &Mesh, rays: u32, shift: [f64; 2]) -> Grid {
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    Grid {
        width: grid.width + 2,
        height: grid.height + 2,
        corner_mm: grid.corner_mm
            + glam::DVec2::new(shift[0] - 1.0, shift[1] + 1.0) * grid.pitch_mm,
        ..grid
    }
}

/// A progress callback of a slicer that shows nothing and never cancels.
pub fn quiet(_stage: Stage, _fraction: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Asserts that two numbers differ by at most `tolerance`.
#[track_caller]
pub fn assert_near(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance,
        "{actual} is not within {tolerance} of {expected}"
    );
}

/// A 64-bit FNV-1a hash, to compare results between machines.
pub fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Runs a test in a process of its own, so that it measures no other tests. `name` is the test's, with its modules.
pub fn in_own_process(name: &str, test: impl FnOnce()) {
    const IS_ALONE: &str = "CUSP_TEST_IS_ALONE";
    if env::var_os(IS_ALONE).is_some() {
        test();
        return;
    }
    let output = Command::new(env::current_exe().unwrap())
        .args(["--exact", name, "--nocapture"])
        .env(IS_ALONE, "1")
        .output()
        .unwrap();
    let [found, said] = [&output.stdout, &output.stderr].map(|it| String::from_utf8_lossy(it));
    eprintln!("{said}");
    // If no test has the name, none fails.
    let is_passed = output.status.success() && found.contains("test result: ok. 1 passed;");
    assert!(is_passed, "{name} fails in a process of its own");
}
