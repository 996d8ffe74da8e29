//! Devices that fail, and devices that can do less: the CPU takes over, with a warning.

use std::ops::ControlFlow;

use crate::common::Slicer;
use cusp_slicer::job::{Backend, GpuMethod, Options, Stage, StageProgress};
use cusp_slicer::ldi::gpu::{self, Gpu, Method};
use cusp_slicer::warning::Warning;
use libtest_mimic::Failed;

use super::Test;
use crate::common::{binary_stl, quiet, solids};

/// Adds the tests of this file.
pub fn add(tests: &mut Vec<(String, Test)>) {
    tests.push((
        "a lost device hands its work to the cpu".to_owned(),
        Box::new(|| lose_device(GpuMethod::Auto)),
    ));
    tests.push((
        "a device lost while peeling hands its work to the cpu".to_owned(),
        Box::new(|| lose_device(GpuMethod::Peel)),
    ));
    tests.push((
        "a cancelled job leaves the gpu to the next".to_owned(),
        Box::new(cancel),
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
}

pub fn with_limits(required_limits: wgpu::Limits) -> Result<Gpu, Failed> {
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

pub fn with_buffers_of(bytes: u64) -> Result<Gpu, Failed> {
    with_limits(wgpu::Limits {
        max_storage_buffer_binding_size: bytes,
        ..Default::default()
    })
}

/// The limits of WebGPU's compatibility mode that wgpu can express: it cannot forbid storage buffers in one stage
/// alone.
pub fn compatible() -> wgpu::Limits {
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

/// The caller's GPU samples at any size, before and after a cancel.
fn cancel() -> Result<(), Failed> {
    let gpu = pollster::block_on(Gpu::open(gpu::Adapters::Any))?;
    let mut slicer = Slicer::load(&binary_stl(&solids::sphere(5.0, 5)))?.with_gpu(gpu);
    let plan = |slicer: &mut Slicer, rays, progress: &mut StageProgress<'_>| {
        let options = Options {
            rays,
            ..Options::default()
        };
        pollster::block_on(slicer.plan(&options, progress)).map(|report| report.backend.clone())
    };
    let mut stop = |stage: Stage, _: f64| match stage {
        Stage::Ldi => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    if plan(&mut slicer, 300, &mut stop).is_ok() {
        return Err("it went on".into());
    }
    let backends = [200, 100].map(|rays| plan(&mut slicer, rays, &mut quiet));
    for backend in backends {
        if backend? != "gpu" {
            return Err("the gpu was lost".into());
        }
    }
    Ok(())
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
        .all_warnings()
        .iter()
        .filter(|&warning| is_wanted(warning))
        .count()
        != 1
    {
        return Err(format!("the warnings are {:?}", found.all_warnings()).into());
    }
    if (found.backend.as_str(), &found.z_mm, found.models[0].hits)
        != ("cpu", &expected.z_mm, expected.models[0].hits)
    {
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

fn is_gpu_failed(warning: &Warning) -> bool {
    matches!(warning, Warning::GpuFailed { .. })
}

fn is_gpu_too_small(warning: &Warning) -> bool {
    matches!(warning, Warning::GpuTooSmall { .. })
}
