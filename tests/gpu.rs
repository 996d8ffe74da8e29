//! The GPU backend against the CPU backend, on whatever adapter wgpu finds: the same LDI, bit for bit, for
//! every solid. Without an adapter the tests are reported as ignored.

mod common;

use std::ops::ControlFlow;

use common::{binary_stl, on_plate, quiet, shifted_grid, solids};
use cusp_slicer::grid::Grid;
use cusp_slicer::job::{Backend, GpuMethod, Options, Slicer, Stage, StageProgress};
use cusp_slicer::ldi::gpu::{self, Gpu, Method};
use cusp_slicer::ldi::{GpuFault, Ldi, LdiError, cpu};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::silent;
use cusp_slicer::warning::Warning;
use glam::Vec3;
use libtest_mimic::{Arguments, Completion, Failed, Trial};

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
    let gpu = pollster::block_on(Gpu::open(gpu::Adapters::Any))?;
    [Method::Fill, Method::Peel]
        .into_iter()
        .try_for_each(|method| compare_method(&gpu, method, &mesh, &grid, &expected, tiling))
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

type Test = Box<dyn Fn() -> Result<(), Failed> + Send>;

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
        "a lost device hands its work to the cpu".to_owned(),
        Box::new(|| lose_device(GpuMethod::Auto)),
    ));
    tests.push((
        "a device lost while peeling hands its work to the cpu".to_owned(),
        Box::new(|| lose_device(GpuMethod::Peel)),
    ));
    tests.push((
        // Beside others, in the same tiles and in others.
        "rays of more surfaces than peeling counts are complete".to_owned(),
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
            compare(&pile.collect(), 90, [0.0; 2], whole)
        }),
    ));
    tests.push((
        "a pile that no cell can list is left to the cpu".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::stack(8_000));
            let grid = Grid::around(&mesh.bounds(), 8)?;
            let gpu = pollster::block_on(Gpu::open(gpu::Adapters::Any))?;
            let mut progress = silent;
            let job = gpu::sample(
                &mesh,
                &grid,
                &gpu,
                gpu::Tiling::default(),
                Method::Peel,
                &mut progress,
            );
            match pollster::block_on(job) {
                Err(LdiError::GpuFailed {
                    fault: GpuFault::TooManyHits,
                    ..
                }) => Ok(()),
                other => Err(format!("{:?}", other.map(|ldi| ldi.hits.len())).into()),
            }
        }),
    ));
    tests.push((
        "a report says how its gpu sampled, and its print file does not".to_owned(),
        Box::new(report_method),
    ));
    tests.push((
        // As it does if a buffer does not fit into its memory.
        "a gpu that reports an error hands its work to the cpu".to_owned(),
        Box::new(|| report_an_error(pollster::block_on(Gpu::open(gpu::Adapters::Any))?)),
    ));
    tests.push((
        "a gpu with small buffers hands its work to the cpu".to_owned(),
        Box::new(|| {
            plans_with_warning(
                with_buffers_of(1 << 10)?,
                GpuMethod::Auto,
                is_gpu_too_small,
                &mut quiet,
            )
        }),
    ));
    tests.push((
        "a gpu without storage buffers hands its work to the cpu".to_owned(),
        Box::new(no_storage_buffers),
    ));
    tests.push((
        "peeling is within the limits of compatible adapters".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::stack(20));
            let grid = Grid::around(&mesh.bounds(), 300)?;
            let expected = cpu::sample(&mesh, &grid, &mut silent)?;
            let gpu = with_limits(compatible())?;
            let tiling = gpu::Tiling::default();
            compare_method(&gpu, Method::Peel, &mesh, &grid, &expected, tiling)
        }),
    ));
    tests.push((
        "small buffers make small tiles".to_owned(),
        Box::new(|| {
            let mesh = on_plate(&solids::sphere(5.0, 4));
            let grid = Grid::around(&mesh.bounds(), 200)?;
            let gpu = with_buffers_of(1 << 15)?;
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
    tests
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

fn with_limits(required_limits: wgpu::Limits) -> Result<Gpu, Failed> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let device = adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits,
        ..Default::default()
    });
    let (device, queue) = pollster::block_on(device)?;
    let gpu = Gpu::with_device(adapter.get_info().name, device, queue);
    Ok(pollster::block_on(gpu))
}

fn with_buffers_of(bytes: u64) -> Result<Gpu, Failed> {
    with_limits(wgpu::Limits {
        max_storage_buffer_binding_size: bytes,
        ..Default::default()
    })
}

/// The limits of WebGPU's compatibility mode, as far as wgpu has them: it cannot forbid storage buffers in one stage alone.
fn compatible() -> wgpu::Limits {
    wgpu::Limits {
        max_texture_dimension_2d: 4096,
        max_storage_buffers_per_shader_stage: 4,
        max_compute_invocations_per_workgroup: 128,
        max_compute_workgroup_size_x: 128,
        max_compute_workgroup_size_y: 128,
        ..Default::default()
    }
}

/// A device that has too few storage buffers to fill peels; and has too few for that, too.
fn no_storage_buffers() -> Result<(), Failed> {
    let gpu = with_limits(wgpu::Limits {
        max_storage_buffers_per_shader_stage: 2,
        ..Default::default()
    })?;
    if gpu.method() != Method::Peel {
        return Err("it fills".into());
    }
    plans_with_warning(gpu, GpuMethod::Auto, is_gpu_failed, &mut quiet)
}

/// Makes the device report an uncaptured error in the middle of the job.
fn report_an_error(gpu: Gpu) -> Result<(), Failed> {
    let device = gpu.device().clone();
    let mut progress = move |stage: Stage, _: f64| {
        if stage == Stage::Ldi {
            let _ = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::MAX,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            });
        }
        ControlFlow::Continue(())
    };
    plans_with_warning(gpu, GpuMethod::Auto, is_gpu_failed, &mut progress)
}

/// Destroys the device in the middle of the job.
fn lose_device(method: GpuMethod) -> Result<(), Failed> {
    let gpu = pollster::block_on(Gpu::open(gpu::Adapters::Any))?;
    let device = gpu.device().clone();
    let mut progress = move |stage: Stage, _: f64| {
        if stage == Stage::Ldi {
            device.destroy();
        }
        ControlFlow::Continue(())
    };
    plans_with_warning(gpu, method, is_gpu_failed, &mut progress)
}

/// The plan must be the CPU's, with the expected warning exactly once: the GPU is not tried again.
fn plans_with_warning(
    gpu: Gpu,
    gpu_method: GpuMethod,
    is_wanted: fn(&Warning) -> bool,
    progress: &mut StageProgress<'_>,
) -> Result<(), Failed> {
    let stl = binary_stl(&solids::sphere(5.0, 5));
    let options = |backend| Options {
        rays: 300,
        backend,
        gpu_method,
        ..Options::default()
    };
    let mut on_cpu = Slicer::load(&stl)?;
    let expected = pollster::block_on(on_cpu.plan(&options(Backend::Cpu), &mut quiet))?.clone();
    let mut slicer = Slicer::load(&stl)?.with_gpu(gpu);
    let found = pollster::block_on(slicer.plan(&options(Backend::Auto), progress))?;
    if found
        .warnings
        .iter()
        .filter(|&warning| is_wanted(warning))
        .count()
        != 1
    {
        return Err(format!("the warnings are {:?}", found.warnings).into());
    }
    if (found.backend.as_str(), &found.z_mm, found.hits) != ("cpu", &expected.z_mm, expected.hits) {
        return Err("the plan is not the CPU's".into());
    }
    // The failure leaves no trace in the print file.
    let (expected, _) = on_cpu.write_archive(Vec::new(), &mut quiet)?;
    let (found, _) = slicer.write_archive(Vec::new(), &mut quiet)?;
    if found != expected {
        return Err("the print file is not the CPU's".into());
    }
    Ok(())
}

fn main() {
    let arguments = Arguments::from_args();
    let missing = match pollster::block_on(Gpu::open(gpu::Adapters::Any)) {
        Err(LdiError::NoGpu { system }) => Some(system),
        _ => None,
    };
    let trials = tests()
        .into_iter()
        .map(|(title, test)| {
            let missing = missing.clone();
            Trial::ignorable_test(title, move || match missing {
                Some(reason) => Ok(Completion::ignored_with(reason)),
                None => test().map(|()| Completion::Completed),
            })
        })
        .collect();
    libtest_mimic::run(&arguments, trials).exit();
}

fn is_gpu_failed(warning: &Warning) -> bool {
    matches!(warning, Warning::GpuFailed { .. })
}

fn is_gpu_too_small(warning: &Warning) -> bool {
    matches!(warning, Warning::GpuTooSmall { .. })
}
