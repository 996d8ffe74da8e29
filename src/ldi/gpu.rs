//! The LDI on the GPU: shaders/sample.wgsl finds which facets each ray meets, shaders/scan.wgsl turns counts
//! into compressed rows, and both are read back once for each tile.
//!
//! Coverage is decided by the same integers as in the CPU backend, and heights are computed by the same
//! function, so that the two return the same [`Ldi`] to the last bit on every adapter.

use std::sync::{Arc, Mutex, PoisonError};

use super::layout::{SCAN_BLOCK, Tile};
use super::projection::{Projection, STEPS};
use super::{Ldi, LdiError, assemble};
use crate::grid::Grid;
use crate::model::Mesh;
use crate::progress::{Progress, report};

/// Which adapters may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adapters {
    /// Any, emulated ones included.
    Any,
    /// Only real GPUs: an emulated one is slower than the CPU backend.
    Hardware,
}

/// How large tiles are, and so how much memory sampling takes on the GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tiling {
    /// Longest side of a tile in pixels, at most 4096: what the least that WebGPU promises can hold.
    pub side: u32,
}

impl Default for Tiling {
    /// Tiles of 4096 pixels a side: counts and offsets take 128 MiB.
    fn default() -> Self {
        Self { side: MAX_SIDE }
    }
}

const MAX_SIDE: u32 = 4096;
/// What passes draw on, since they must draw on something; nothing is written to it.
const CANVAS: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
/// Bytes of a count, an offset or a facet.
const WORD: u64 = 4;

/// Samples `mesh`, which lies inside `grid` and above z = 0.
///
/// # Errors
/// [`LdiError::GpuTooSmall`], [`LdiError::GpuFailed`], [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`],
/// [`LdiError::Cancelled`].
pub async fn sample(
    mesh: &Mesh,
    grid: &Grid,
    gpu: &Gpu,
    tiling: Tiling,
    progress: &mut Progress<'_>,
) -> Result<Ldi, LdiError> {
    super::check_facets(mesh)?;
    report(progress, 0.0)?;
    let projection = Projection::new(mesh, grid);
    let sampler = Sampler::new(gpu, mesh, &projection)?;

    let side = tiling
        .side
        .clamp(1, gpu.device.limits().max_texture_dimension_2d);
    let mut waiting = tiles(grid, side);
    waiting.reverse();
    let mut sampled = Vec::new();
    while let Some(region) = waiting.pop() {
        match sampler.sample(region).await? {
            Some(rays) => sampled.push((region, rays)),
            // More rays or hits than a buffer can hold: halve the tile.
            None => waiting.extend(region.halves().ok_or_else(|| LdiError::GpuFailed {
                reason: "one ray has more hits than the GPU can store".to_owned(),
            })?),
        }
        let done = sampled.len() as f64;
        report(progress, 0.8 * done / (done + waiting.len() as f64))?;
    }
    assemble_ldi(&projection, grid, &sampled, progress)
}

/// Part of the grid, in pixels.
#[derive(Debug, Clone, Copy)]
struct Region {
    column: u32,
    row: u32,
    width: u32,
    height: u32,
}

impl Region {
    fn rays(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Two parts of the region, or `None` if it is a single ray.
    fn halves(self) -> Option<[Self; 2]> {
        let Self {
            column,
            row,
            width,
            height,
        } = self;
        if height > 1 {
            let upper = height / 2;
            let lower = height - upper;
            Some([
                Self {
                    row: row + upper,
                    height: lower,
                    ..self
                },
                Self {
                    height: upper,
                    ..self
                },
            ])
        } else if width > 1 {
            let left = width / 2;
            let right = width - left;
            Some([
                Self {
                    column: column + left,
                    width: right,
                    ..self
                },
                Self {
                    width: left,
                    ..self
                },
            ])
        } else {
            None
        }
    }
}

/// The grid in parts of at most `side` pixels.
fn tiles(grid: &Grid, side: u32) -> Vec<Region> {
    let parts = |length: u32| {
        let firsts = (0..length).step_by(side as usize);
        firsts.map(move |first| (first, side.min(length - first)))
    };
    parts(grid.height)
        .flat_map(|(row, height)| {
            parts(grid.width).map(move |(column, width)| Region {
                column,
                row,
                width,
                height,
            })
        })
        .collect()
}

/// The facets that the rays of a region meet, in compressed rows.
struct Meetings {
    offsets: Vec<u32>,
    facets: Vec<u32>,
}

/// Joins the tiles, computes heights and puts hits in order.
fn assemble_ldi(
    projection: &Projection<'_>,
    grid: &Grid,
    sampled: &[(Region, Meetings)],
    progress: &mut Progress<'_>,
) -> Result<Ldi, LdiError> {
    let mut offsets: Vec<u32> = assemble::zeroed(grid.pixels() + 1)?;
    for (region, meetings) in sampled {
        for row in 0..region.height {
            let from = (row * region.width) as usize;
            let to = ((region.row + row) * grid.width + region.column) as usize;
            for column in 0..region.width as usize {
                let [first, end] = [0, 1].map(|next| meetings.offsets[from + column + next]);
                // More hits than 32 bits count would make offsets shrink.
                offsets[to + column + 1] = end
                    .checked_sub(first)
                    .ok_or_else(|| gpu_failed("a tile has more hits than it can count"))?;
            }
        }
    }
    assemble::accumulate(&mut offsets)?;
    let mut facets: Vec<u32> = assemble::zeroed(offsets[grid.pixels()] as usize)?;
    for (region, meetings) in sampled {
        for row in 0..region.height {
            // A row of a tile is contiguous in both.
            let from = (row * region.width) as usize;
            let from = meetings.offsets[from]..meetings.offsets[from + region.width as usize];
            let to = offsets[((region.row + row) * grid.width + region.column) as usize];
            let row = &meetings.facets[from.start as usize..from.end as usize];
            facets[to as usize..to as usize + row.len()].copy_from_slice(row);
        }
    }
    let hits = assemble::hits_of_facets(projection, grid, &offsets, &facets, progress, [0.8, 1.0])?;
    Ok(Ldi {
        grid: *grid,
        offsets,
        hits,
    })
}

/// An open GPU, which any number of meshes may be sampled on.
#[derive(Debug)]
pub struct Gpu {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
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

fn gpu_failed(reason: impl std::fmt::Display) -> LdiError {
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

    fn check(&self) -> Result<(), LdiError> {
        match self.failure.get() {
            Some(reason) => Err(gpu_failed(reason)),
            None => Ok(()),
        }
    }

    fn buffer(&self, label: &str, words: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: words.max(1) * WORD,
            usage,
            mapped_at_creation: false,
        })
    }

    /// A buffer with contents. They are written rather than mapped: mapping a buffer that there was no memory
    /// for would panic.
    fn filled_buffer(
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
    async fn read(
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

/// What stays the same for all tiles.
struct Sampler<'a> {
    gpu: &'a Gpu,
    vertices: u32,
    positions: wgpu::Buffer,
    corners: wgpu::Buffer,
    count: wgpu::RenderPipeline,
    fill: wgpu::RenderPipeline,
    scan: [wgpu::ComputePipeline; 3],
}

impl<'a> Sampler<'a> {
    fn new(gpu: &'a Gpu, mesh: &Mesh, projection: &Projection<'_>) -> Result<Self, LdiError> {
        let limit_bytes = gpu.device.limits().max_storage_buffer_binding_size;
        let corner_bytes = std::mem::size_of_val(mesh.facets.as_slice()) as u64;
        let position_bytes = std::mem::size_of_val(projection.positions.as_slice()) as u64;
        let needed_bytes = corner_bytes.max(position_bytes);
        if needed_bytes > limit_bytes {
            return Err(LdiError::GpuTooSmall {
                facets: mesh.facets.len() as u64,
                needed_bytes,
                limit_bytes,
            });
        }
        let storage =
            |label, contents| gpu.filled_buffer(label, contents, wgpu::BufferUsages::STORAGE);
        let sample = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../shaders/sample.wgsl"));
        let scan = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../shaders/scan.wgsl"));
        Ok(Self {
            gpu,
            vertices: mesh.facets.len() as u32 * 3,
            positions: storage("positions", bytemuck::cast_slice(&projection.positions)),
            corners: storage("corners", bytemuck::cast_slice(&mesh.facets)),
            count: render_pipeline(&gpu.device, &sample, "count"),
            fill: render_pipeline(&gpu.device, &sample, "fill"),
            scan: ["scan_blocks", "scan_totals", "add_totals"].map(|step| {
                gpu.device
                    .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                        label: Some(step),
                        layout: None,
                        module: &scan,
                        entry_point: Some(step),
                        compilation_options: Default::default(),
                        cache: None,
                    })
            }),
        })
    }

    /// The meetings of one tile, or `None` if they do not fit into a buffer.
    async fn sample(&self, region: Region) -> Result<Option<Meetings>, LdiError> {
        let Gpu { device, queue, .. } = self.gpu;
        let rays = region.rays() as u64;
        let limit_bytes = device.limits().max_storage_buffer_binding_size;
        if (rays + 1) * WORD > limit_bytes {
            return Ok(None);
        }
        let blocks = rays.div_ceil(u64::from(SCAN_BLOCK));
        let storage = wgpu::BufferUsages::STORAGE;
        let readable = storage | wgpu::BufferUsages::COPY_SRC;
        let counts = self.gpu.buffer("counts", rays, storage);
        let offsets = self.gpu.buffer("offsets", rays + 1, readable);
        let totals = self.gpu.buffer("totals", blocks + 1, readable);
        let tile = Tile {
            origin: [region.column, region.row].map(|pixel| pixel as i32 * STEPS as i32),
            size: [region.width, region.height],
        };
        let tile = bytemuck::bytes_of(&tile);
        let tile = self
            .gpu
            .filled_buffer("tile", tile, wgpu::BufferUsages::UNIFORM);
        let canvas = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("canvas"),
            size: wgpu::Extent3d {
                width: region.width,
                height: region.height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: CANVAS,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let canvas = canvas.create_view(&Default::default());

        let mut encoder = device.create_command_encoder(&Default::default());
        let mesh = [
            (0, &tile),
            (1, &self.positions),
            (2, &self.corners),
            (3, &counts),
        ];
        self.draw(&mut encoder, &canvas, &self.count, &mesh);
        self.scan(&mut encoder, &counts, &offsets, &totals, blocks as u32);
        queue.submit([encoder.finish()]);
        let hits = u64::from(self.gpu.read(&totals, blocks, 1).await?[0]);
        if hits * WORD > limit_bytes {
            return Ok(None);
        }

        let facets = self.gpu.buffer("facets", hits, readable);
        let mut encoder = device.create_command_encoder(&Default::default());
        let filled = [&mesh[..], &[(4, &offsets), (5, &facets)]].concat();
        self.draw(&mut encoder, &canvas, &self.fill, &filled);
        queue.submit([encoder.finish()]);
        let meetings = Meetings {
            offsets: self.gpu.read(&offsets, 0, rays + 1).await?,
            facets: self.gpu.read(&facets, 0, hits).await?,
        };
        // A device that was lost may map zeros.
        self.gpu.check()?;
        if u64::from(meetings.offsets[rays as usize]) != hits {
            return Err(gpu_failed("it returned offsets that do not add up"));
        }
        Ok(Some(meetings))
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        canvas: &wgpu::TextureView,
        pipeline: &wgpu::RenderPipeline,
        buffers: &[(u32, &wgpu::Buffer)],
    ) {
        let group = self.bind(&pipeline.get_bind_group_layout(0), buffers);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: canvas,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..self.vertices, 0..1);
    }

    /// Writes the exclusive prefix sum of `counts` to `offsets`, and its total behind it.
    fn scan(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        counts: &wgpu::Buffer,
        offsets: &wgpu::Buffer,
        totals: &wgpu::Buffer,
        blocks: u32,
    ) {
        let [scan_blocks, scan_totals, add_totals] = &self.scan;
        let all = [(0, counts), (1, offsets), (2, totals)];
        for (pipeline, buffers, workgroups) in [
            (scan_blocks, &all[..], blocks),
            (scan_totals, &all[2..], 1),
            (add_totals, &all[..], blocks),
        ] {
            let group = self.bind(&pipeline.get_bind_group_layout(0), buffers);
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(workgroups, 1, 1);
        }
    }

    fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = buffers
            .iter()
            .map(|&(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.gpu
            .device
            .create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout,
                entries: &entries,
            })
    }
}

fn render_pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    fragment: &str,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: None,
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("propose"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: CANVAS,
                blend: None,
                write_mask: wgpu::ColorWrites::empty(),
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
