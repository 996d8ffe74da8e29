//! An open GPU: device, queue, buffers, and the errors that the device reports asynchronously.

use std::sync::{Arc, Mutex, PoisonError};

use super::tiles::Region;
use super::{Adapters, Method};
use crate::ldi::layout::Tile;
use crate::ldi::projection::STEPS;
use crate::ldi::{GpuFault, LdiError};

/// Bytes of a count, an offset or a facet.
pub(super) const WORD: u64 = 4;

/// An open GPU. Any number of meshes may be sampled on it.
#[derive(Debug)]
pub struct Gpu {
    name: String,
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    method: Method,
    is_emulated: bool,
    failure: Failure,
}

/// The faster method of those that a device can do.
async fn faster_method(device: &wgpu::Device) -> Method {
    // wgpu does not report the number of storage buffers that a stage may have, so this asks for a layout with those
    // that filling needs.
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let entry = |binding, visibility, read_only| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries = [
        entry(1, wgpu::ShaderStages::VERTEX, true),
        entry(2, wgpu::ShaderStages::VERTEX, true),
        entry(3, wgpu::ShaderStages::FRAGMENT, false),
        entry(4, wgpu::ShaderStages::FRAGMENT, true),
        entry(5, wgpu::ShaderStages::FRAGMENT, false),
    ];
    let _ = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("probe"),
        entries: &entries,
    });
    match scope.pop().await {
        None => Method::Fill,
        Some(_) => Method::Peel,
    }
}

/// The first error that a device reported through a callback, and that no call returned.
#[derive(Debug, Clone, Default)]
struct Failure(Arc<Mutex<Option<LdiError>>>);

impl Failure {
    fn note(&self, fault: GpuFault, system: String) {
        let mut slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slot.get_or_insert(LdiError::GpuFailed {
            fault,
            system: Some(system),
        });
    }

    fn get(&self) -> Option<LdiError> {
        let slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slot.clone()
    }
}

fn no_gpu(error: impl std::fmt::Display) -> LdiError {
    LdiError::NoGpu {
        system: error.to_string(),
    }
}

/// The error of a call that failed.
fn call_failed(error: impl std::fmt::Display) -> LdiError {
    LdiError::GpuFailed {
        fault: GpuFault::Error,
        system: Some(error.to_string()),
    }
}

impl Gpu {
    /// Opens the system's high-performance adapter.
    ///
    /// # Errors
    /// [`LdiError::NoGpu`] if there is no such adapter, [`LdiError::GpuEmulated`].
    pub async fn open(adapters: Adapters) -> Result<Self, LdiError> {
        // Not OpenGL: it would double the time of the search, and adds no machine that is fast enough.
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = instance
            .request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            })
            .await
            .map_err(no_gpu)?;
        let info = adapter.get_info();
        let name = if info.name.is_empty() {
            "GPU".to_owned()
        } else {
            info.name
        };
        let is_emulated = info.device_type == wgpu::DeviceType::Cpu;
        if adapters == Adapters::Hardware && is_emulated {
            return Err(LdiError::GpuEmulated { adapter: name });
        }
        let descriptor = wgpu::DeviceDescriptor {
            // Adapters of WebGPU's compatibility mode offer less.
            required_limits: wgpu::Limits::default().or_worse_values_from(&adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(no_gpu)?;
        Ok(Self {
            is_emulated,
            ..Self::with_device(name, device, queue).await
        })
    }

    /// Uses a device that is already open. Reports call it `name`.
    ///
    /// Its callbacks for uncaptured errors and for its loss are replaced.
    pub async fn with_device(name: String, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let method = faster_method(&device).await;
        let failure = Failure::default();
        let of_device = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            of_device.note(GpuFault::Error, error.to_string());
        }));
        let of_device = failure.clone();
        device.set_device_lost_callback(move |reason, message| {
            of_device.note(GpuFault::DeviceLost, format!("{reason:?}: {message}"));
        });
        Self {
            name,
            device,
            queue,
            method,
            is_emulated: false,
            failure,
        }
    }

    /// The faster method of those that the device can do.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Returns true if it is known to be emulated in software.
    pub fn is_emulated(&self) -> bool {
        self.is_emulated
    }

    /// The name of the adapter, as in reports.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The device, for example to destroy it.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    pub(super) fn check(&self) -> Result<(), LdiError> {
        match self.failure.get() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    pub(super) fn buffer(
        &self,
        label: &str,
        words: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: words.max(1) * WORD,
            usage,
            mapped_at_creation: false,
        })
    }

    /// A buffer with these contents. They are written through the queue, because mapping a buffer whose allocation
    /// failed would panic.
    pub(super) fn filled_buffer(
        &self,
        label: &str,
        contents: &[u8],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let words = (contents.len() as u64).div_ceil(WORD);
        let buffer = self.buffer(label, words, usage | wgpu::BufferUsages::COPY_DST);
        self.queue.write_buffer(&buffer, 0, contents);
        buffer
    }

    /// Waits for the queue and reads `words` 32-bit words of a buffer, starting at word `first`.
    pub(super) async fn read(
        &self,
        source: &wgpu::Buffer,
        first: u64,
        words: u64,
    ) -> Result<Vec<u32>, LdiError> {
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let readback = self.buffer("readback", words, usage);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(source, first * WORD, &readback, 0, words * WORD);
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = futures_channel::oneshot::channel();
        readback.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is dropped only with the whole job.
            let _ = sender.send(result);
        });
        // Blocks natively; in the browser the event loop calls back.
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(call_failed)?;
        let mapped = receiver.await;
        self.check()?;
        mapped.map_err(call_failed)?.map_err(call_failed)?;
        let bytes = readback.get_mapped_range(..).map_err(call_failed)?;
        let words = bytemuck::cast_slice(&bytes[..(words * WORD) as usize]).to_vec();
        drop(bytes);
        // In a browser, dropping frees nothing before garbage is collected.
        readback.destroy();
        Ok(words)
    }

    /// The size of textures for a region.
    pub(super) fn extent(region: Region) -> wgpu::Extent3d {
        wgpu::Extent3d {
            width: region.width,
            height: region.height,
            depth_or_array_layers: 1,
        }
    }

    /// The uniform with a tile's place.
    pub(super) fn tile(&self, region: Region) -> wgpu::Buffer {
        let tile = Tile {
            origin: [region.column, region.row].map(|pixel| pixel as i32 * STEPS as i32),
            size: [region.width, region.height],
        };
        let tile = bytemuck::bytes_of(&tile);
        self.filled_buffer("tile", tile, wgpu::BufferUsages::UNIFORM)
    }

    /// The most bytes that a shader can be given in one buffer.
    pub(super) fn limit_bytes(&self) -> u64 {
        self.device.limits().max_storage_buffer_binding_size
    }

    pub(super) fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = resources
            .iter()
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: resource.clone(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    pub(super) fn compute_pipeline(
        &self,
        module: &wgpu::ShaderModule,
        step: &str,
    ) -> wgpu::ComputePipeline {
        self.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(step),
                layout: None,
                module,
                entry_point: Some(step),
                compilation_options: Default::default(),
                cache: None,
            })
    }

    /// Runs a compute pipeline over `workgroups` in x, y and z.
    pub(super) fn compute(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        resources: &[(u32, wgpu::BindingResource<'_>)],
        workgroups: [u32; 3],
    ) {
        let group = self.bind(&pipeline.get_bind_group_layout(0), resources);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(workgroups[0], workgroups[1], workgroups[2]);
    }
}
