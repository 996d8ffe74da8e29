//! The GPU backend against the CPU backend, on whatever adapter wgpu finds: the same LDI, bit for bit, for
//! every solid.

mod fallbacks;

use std::sync::{Arc, Mutex};

use crate::common::Slicer;
use cusp_slicer::grid::Grid;
use cusp_slicer::job::{Backend, GpuMethod, Options};
use cusp_slicer::ldi::gpu::{self, Gpu, Method};
use cusp_slicer::ldi::{Ldi, cpu};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::silent;
use glam::Vec3;
use libtest_mimic::{Failed, Trial};

use crate::common::{binary_stl, on_plate, quiet, shifted_grid, solids};
use crate::{Need, trial};

/// Samples on both backends, on a grid shifted by `shift` pixels from the one that just covers the model.
fn compare(
    triangles: &solids::Triangles,
    rays: u32,
    shift: [f64; 2],
    tiling: gpu::Tiling,
) -> Result<(), Failed> {
    let mesh = on_plate(triangles);
    let grid = shifted_grid(&mesh, rays, shift);
    let expected = cpu::sample(&mesh, &grid, &mut silent)?;
    let gpu = shared()?;
    [Method::Fill, Method::Peel]
        .into_iter()
        .try_for_each(|method| compare_method(&gpu, method, &mesh, &grid, &expected, tiling))
}

/// The device of all comparisons: opened once, as its driver compiles the shaders each time. [`close`] ends it.
static SHARED: Mutex<Option<Arc<Gpu>>> = Mutex::new(None);

fn shared() -> Result<Arc<Gpu>, Failed> {
    let mut shared = SHARED.lock().expect("no test panics while it opens");
    if let Some(gpu) = &*shared {
        return Ok(gpu.clone());
    }
    let gpu = Arc::new(pollster::block_on(Gpu::open(gpu::Adapters::Any))?);
    *shared = Some(gpu.clone());
    Ok(gpu)
}

/// Closes the shared device. Threads of a driver that outlive `main` have ended in a crash.
pub fn close() {
    drop(SHARED.lock().map(|mut shared| shared.take()));
}

fn compare_method(
    gpu: &Gpu,
    method: Method,
    mesh: &Mesh,
    grid: &Grid,
    expected: &Ldi,
    tiling: gpu::Tiling,
) -> Result<(), Failed> {
    let mut progress = silent;
    let job = gpu::sample(mesh, grid, gpu, tiling, method, &mut progress);
    let found = pollster::block_on(job)?;
    let differing = (0..expected.rays()).find(|&ray| expected.ray(ray) != found.ray(ray));
    match differing {
        Some(ray) => Err(format!(
            "ray {ray} differs by {method:?} on {}: {:?} against {:?}",
            gpu.name(),
            found.ray(ray),
            expected.ray(ray)
        )
        .into()),
        None => Ok(()),
    }
}

type Test = Box<dyn FnOnce() -> Result<(), Failed> + Send>;

pub fn trials() -> Vec<Trial> {
    let tests = tests().into_iter();
    tests
        .map(|(title, test)| trial(format!("gpu::{title}"), &[Need::Gpu], test))
        .collect()
}

fn tests() -> Vec<(String, Test)> {
    let whole = gpu::Tiling::default();
    let small = gpu::Tiling { side: 77 };
    let mut tests: Vec<(String, Test)> = Vec::new();
    for (name, triangles) in solids::all() {
        let tiled = triangles.clone();
        let title = format!("tiles have no seams on the {name}");
        tests.push((
            title,
            Box::new(move || compare(&tiled, 200, [0.0; 2], small)),
        ));
        add_variants(&mut tests, &format!("the {name}"), &triangles, 300);
    }
    for (name, triangles, rays) in solids::torture() {
        add_variants(&mut tests, name, &triangles, rays);
    }
    tests.push((
        "gpu equals cpu on large facets".to_owned(),
        Box::new(move || compare(&solids::cone(9.0, 14.0, 4), 2500, [0.0; 2], whole)),
    ));
    tests.push((
        "gpu equals cpu on needles".to_owned(),
        Box::new(move || compare(&solids::cylinder(9.0, 1.0, 400), 1200, [0.0; 2], whole)),
    ));
    tests.push((
        "tiles have no seams on large facets".to_owned(),
        Box::new(|| {
            let tiling = gpu::Tiling { side: 640 };
            compare(&solids::cone(9.0, 14.0, 4), 2500, [0.0; 2], tiling)
        }),
    ));
    tests.push((
        "a report says how its gpu sampled, and its print file does not".to_owned(),
        Box::new(report_method),
    ));
    add_bounds(&mut tests);
    fallbacks::add(&mut tests);
    tests.push((
        "auto takes a gpu where facets outnumber rays by far".to_owned(),
        Box::new(|| {
            let few = gpu::can_be_faster(999_999, 1);
            let many = gpu::can_be_faster(1_000_000, 250_000);
            let dense = gpu::can_be_faster(1_000_000, 250_001);
            let is_right = [few, many, dense] == [false, true, false];
            is_right.then_some(()).ok_or("another rule".into())
        }),
    ));
    tests
}

/// Adds tests at the capacity of one pass, cell, buffer or device.
fn add_bounds(tests: &mut Vec<(String, Test)>) {
    tests.push((
        // Beside others, in the same tiles and in others.
        "rays of more surfaces than are peeled are complete".to_owned(),
        Box::new(|| {
            let mut triangles = solids::stack(130);
            triangles.extend(solids::moved(
                &solids::sphere(9.0, 4),
                Vec3::new(7.0, 3.0, 9.0),
            ));
            compare(&triangles, 90, [0.0; 2], gpu::Tiling { side: 47 })
        }),
    ));
    tests.push((
        // A list is too long for a cell of the usual size, as nine in ten facets of the spheres are about as large as a pixel.
        "cells shrink where facets crowd".to_owned(),
        Box::new(move || {
            let ball = solids::sphere(9.0, 6);
            let pile = (0..10).flat_map(|i| solids::moved(&ball, Vec3::Z * (i as f32) * 11.0));
            compare(&pile.collect(), 90, [0.0; 2], gpu::Tiling::default())
        }),
    ));
    tests.push((
        "peeling is within the limits of compatible adapters".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::stack(20));
            let grid = Grid::around(&mesh.bounds(), 300)?;
            let expected = cpu::sample(&mesh, &grid, &mut silent)?;
            let gpu = fallbacks::with_limits(fallbacks::compatible())?;
            let tiling = gpu::Tiling::default();
            compare_method(&gpu, Method::Peel, &mesh, &grid, &expected, tiling)
        }),
    ));
    tests.push((
        "small buffers make small tiles".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::sphere(5.0, 4));
            let grid = Grid::around(&mesh.bounds(), 200)?;
            let gpu = fallbacks::with_buffers_of(1 << 15)?;
            let mut progress = silent;
            let job = gpu::sample(
                &mesh,
                &grid,
                &gpu,
                gpu::Tiling::default(),
                gpu.method(),
                &mut progress,
            );
            let same = pollster::block_on(job)? == cpu::sample(&mesh, &grid, &mut silent)?;
            same.then_some(()).ok_or("the backends differ".into())
        }),
    ));
    // The last count that is peeled, and the first that is not.
    for slabs in [127, 128] {
        tests.push((
            format!("rays of {} surfaces are complete", 2 * slabs),
            Box::new(move || compare(&solids::stack(slabs), 40, [0.0; 2], gpu::Tiling::default())),
        ));
    }
    tests.push((
        // By outline, the caps' facets could all be anywhere near the centre. Peeling has no lists.
        "a fan of more facets than a cell can list is complete".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::cylinder(9.0, 1.0, 140_000));
            let grid = Grid::around(&mesh.bounds(), 60)?;
            let expected = cpu::sample(&mesh, &grid, &mut silent)?;
            let tiling = gpu::Tiling::default();
            compare_method(&*shared()?, Method::Fill, &mesh, &grid, &expected, tiling)
        }),
    ));
    tests.push((
        "a pile that no cell can list is complete".to_owned(),
        Box::new(|| compare(&solids::stack(8_000), 8, [0.0; 2], gpu::Tiling::default())),
    ));
    tests.push((
        // Meshes are closed before they are sampled; the methods do not rely on it.
        "rays of an odd number of surfaces are complete".to_owned(),
        Box::new(|| {
            let mut mesh = on_plate(&solids::sphere(5.0, 4));
            let grid = Grid::around(&mesh.bounds(), 90)?;
            mesh.facets.truncate(mesh.facets.len() - 300);
            let expected = cpu::sample(&mesh, &grid, &mut silent)?;
            let is_odd = |ray| expected.ray(ray).len() % 2 == 1;
            if !(0..expected.rays()).any(is_odd) {
                return Err("every ray is even".into());
            }
            let tiling = gpu::Tiling::default();
            compare_method(&*shared()?, Method::Peel, &mesh, &grid, &expected, tiling)
        }),
    ));
}

/// Adds a test for the solid itself, and one each with the solid mirrored, rotated, shuffled, and shifted by a fraction
/// of a pixel.
fn add_variants(
    tests: &mut Vec<(String, Test)>,
    name: &str,
    triangles: &solids::Triangles,
    rays: u32,
) {
    let none = [0.0; 2];
    for (variant, triangles, shift) in [
        ("", triangles.clone(), none),
        (", mirrored", solids::mirrored(triangles), none),
        (", turned", solids::turned(triangles), none),
        (", shuffled", solids::shuffled(triangles), none),
        (", shifted", triangles.clone(), [0.371, -0.618]),
    ] {
        let title = format!("gpu equals cpu on {name}{variant}");
        let whole = gpu::Tiling::default();
        tests.push((
            title,
            Box::new(move || compare(&triangles, rays, shift, whole)),
        ));
    }
}

fn report_method() -> Result<(), Failed> {
    let stl = binary_stl(&solids::sphere(5.0, 4));
    let mut files = Vec::new();
    for (gpu_method, expected) in [
        (GpuMethod::Auto, "fill"),
        (GpuMethod::Fill, "fill"),
        (GpuMethod::Peel, "peel"),
    ] {
        let options = Options {
            rays: 200,
            backend: Backend::Gpu,
            gpu_method,
            ..Options::default()
        };
        let mut slicer = Slicer::load(&stl)?;
        let report = pollster::block_on(slicer.plan(&options, &mut quiet))?;
        if report.gpu_method.as_deref() != Some(expected) || report.backend != "gpu" {
            return Err(format!("{gpu_method:?} gives {:?}", report.gpu_method).into());
        }
        files.push(slicer.write_archive(Vec::new(), &mut quiet)?.0);
    }
    let is_same = files.iter().all(|file| *file == files[0]);
    is_same.then_some(()).ok_or("print files differ".into())
}
