//! An open GPU: its device and queue, its buffers, and the errors that no call returns.

use std::sync::{Arc, Mutex, PoisonError};

use crate::ldi::LdiError;

/// Bytes of a count, an offset or a facet.
pub(super) const WORD: u64 = 4;

/// Which adapters may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adapters {
    /// Any, emulated ones included.
    Any,
    /// Only real GPUs: an emulated one is slower than the CPU backend.
    Hardware,
}

/// An open GPU, which any number of meshes may be sampled on.
#[derive(Debug)]
pub struct Gpu {
    name: String,
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    failure: Failure,
}

/// The first error of a device that no call returned.
#[derive(Debug, Clone, Default)]
struct Failure(Arc<Mutex<Option<String>>>);

impl Failure {
    fn note(&self, reason: &str) {
        let mut slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slot.get_or_insert_with(|| reason.to_owned());
    }

    fn get(&self) -> Option<String> {
        let slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slot.clone()
    }
}

fn no_gpu(reason: impl std::fmt::Display) -> LdiError {
    LdiError::NoGpu {
        reason: reason.to_string(),
    }
}

pub(super) fn gpu_failed(reason: impl std::fmt::Display) -> LdiError {
    LdiError::GpuFailed {
        reason: reason.to_string(),
    }
}

impl Gpu {
    /// Opens the adapter that the system prefers for speed.
    ///
    /// # Errors
    /// [`LdiError::NoGpu`] if there is none of the kind asked for.
    pub async fn open(adapters: Adapters) -> Result<Self, LdiError> {
        // OpenGL is left out: it adds no machine worth having and doubles the time of the search.
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
        if adapters == Adapters::Hardware && info.device_type == wgpu::DeviceType::Cpu {
            return Err(no_gpu(format!("{name} is emulated in software")));
        }
        let descriptor = wgpu::DeviceDescriptor::default();
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(no_gpu)?;
        Ok(Self::with_device(name, device, queue))
    }

    /// Uses a device that is open already and whose errors nobody else listens to; `name` is what reports
    /// call it.
    pub fn with_device(name: String, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let failure = Failure::default();
        let of_device = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            of_device.note(&error.to_string());
        }));
        let of_device = failure.clone();
        device.set_device_lost_callback(move |reason, message| {
            of_device.note(&format!("the device was lost ({reason:?}): {message}"));
        });
        Self {
            name,
            device,
            queue,
            failure,
        }
    }

    /// What reports call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The device, for instance to destroy it.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    pub(super) fn check(&self) -> Result<(), LdiError> {
        match self.failure.get() {
            Some(reason) => Err(gpu_failed(reason)),
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

    /// A buffer with contents. They are written rather than mapped: mapping a buffer that there was no memory
    /// for would panic.
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

    /// Waits for the queue and copies words out of a buffer.
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
            // The receiver is gone only if the whole job is.
            let _ = sender.send(result);
        });
        // Natively this waits; in the browser the event loop calls back.
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(gpu_failed)?;
        let mapped = receiver.await;
        self.check()?;
        mapped.map_err(gpu_failed)?.map_err(gpu_failed)?;
        let bytes = readback.get_mapped_range(..).map_err(gpu_failed)?;
        Ok(bytemuck::cast_slice(&bytes[..(words * WORD) as usize]).to_vec())
    }
}
