//! The LDI by depth peeling on the GPU; the shader is shaders/peel.wgsl.
//!
//! The GPU decides which facets each ray meets. Heights are then computed by the same function as in the
//! CPU backend, so that a hit found by both is the same to the last bit. Grids larger than a texture
//! are sampled in tiles.

use std::sync::{Arc, Mutex};

use wgpu::util::DeviceExt;

use super::layout::{Corner, Tile};
use super::projection::{Projection, STEPS};
use super::{Hit, Ldi, LdiError, assemble};
use crate::grid::Grid;
use crate::mesh::Mesh;
use crate::progress::{Progress, report};

/// Which adapters may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adapters {
    /// Any, emulated ones included.
    Any,
    /// Only real GPUs: an emulated one is slower than the CPU backend.
    Hardware,
}

/// Longest side of a tile in pixels: bounds the memory of textures and read-back to some 80 MB.
const MAX_TILE: u32 = 2048;
/// Bytes of one vertex buffer.
const MAX_VERTEX_BYTES: usize = 96 << 20;
/// What a ray's previous and current pair are stored as.
const PAIR: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
const PAIR_BYTES: u32 = 8;
/// What a pass leaves for a ray without a further hit: greater than every pair, so that all later
/// passes discard there too.
const DONE: f64 = u32::MAX as f64;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Samples `mesh`, which lies inside `grid` and above z = 0, and tells which adapter did it.
///
/// # Errors
/// [`LdiError::NoGpu`] if there is no adapter of the kind asked for, [`LdiError::GpuFailed`] if it fails,
/// [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`], [`LdiError::Cancelled`].
pub async fn sample(
    mesh: &Mesh,
    grid: &Grid,
    adapters: Adapters,
    progress: &mut Progress<'_>,
) -> Result<(Ldi, String), LdiError> {
    super::check_facets(mesh)?;
    report(progress, 0.0)?;
    let gpu = Gpu::open(adapters).await?;
    let projection = Projection::new(mesh, grid);
    let peeler = Peeler::new(&gpu, mesh, &projection, grid);
    let mut found = Vec::new();
    let (columns, rows) = (
        tiles(grid.width, peeler.tile_side),
        tiles(grid.height, peeler.tile_side),
    );
    let tile_count = (columns.len() * rows.len()) as f64;
    for (index, (row, column)) in rows
        .iter()
        .flat_map(|&row| columns.iter().map(move |&column| (row, column)))
        .enumerate()
    {
        let region = Region {
            column: column.0,
            row: row.0,
            width: column.1,
            height: row.1,
        };
        let base = index as f64 / tile_count;
        let mut tile_progress = |fraction: f64| progress(base + 0.9 * fraction / tile_count);
        peeler.peel(region, &mut found, &mut tile_progress).await?;
    }
    let ldi = assemble_ldi(&projection, grid, &found)?;
    report(progress, 1.0)?;
    Ok((ldi, gpu.name))
}

/// First index and length of the parts of `length`.
fn tiles(length: u32, side: u32) -> Vec<(u32, u32)> {
    (0..length)
        .step_by(side as usize)
        .map(|first| (first, side.min(length - first)))
        .collect()
}

/// A ray and a facet that it meets.
type Meeting = [u32; 2];

/// Compressed rows from meetings in any order.
fn assemble_ldi(
    projection: &Projection<'_>,
    grid: &Grid,
    found: &[Meeting],
) -> Result<Ldi, LdiError> {
    let mut offsets: Vec<u32> = assemble::zeroed(grid.pixels() + 1)?;
    for [ray, _] in found {
        offsets[*ray as usize + 1] += 1;
    }
    assemble::accumulate(&mut offsets)?;
    let mut hits: Vec<Hit> = assemble::zeroed(found.len())?;
    let mut cursors = offsets.clone();
    // Neighbouring rays mostly meet the same facet, so it is worth keeping.
    let mut current = (u32::MAX, None);
    for &[ray, index] in found {
        if current.0 != index {
            current = (index, projection.facet(index as usize));
        }
        let Some(facet) = current.1 else { continue };
        let z_mm = facet.height_at(ray % grid.width, ray / grid.width);
        hits[cursors[ray as usize] as usize] = Hit::new(z_mm, index, facet.faces_up);
        cursors[ray as usize] += 1;
    }
    assemble::sort_rays(&offsets, 0, &mut hits);
    Ok(Ldi {
        grid: *grid,
        offsets,
        hits,
    })
}

/// An open device.
struct Gpu {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// The first error that no call returned.
    failure: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    async fn open(adapters: Adapters) -> Result<Self, LdiError> {
        let no_gpu = |reason: &dyn std::fmt::Display| LdiError::NoGpu {
            reason: reason.to_string(),
        };
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
            .map_err(|error| no_gpu(&error))?;
        let info = adapter.get_info();
        if adapters == Adapters::Hardware && info.device_type == wgpu::DeviceType::Cpu {
            return Err(no_gpu(&format!("{} is emulated in software", info.name)));
        }
        let limits = adapter.limits();
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                required_limits: wgpu::Limits {
                    max_texture_dimension_2d: limits.max_texture_dimension_2d.min(MAX_TILE),
                    ..wgpu::Limits::downlevel_defaults()
                },
                ..Default::default()
            })
            .await
            .map_err(|error| no_gpu(&error))?;
        let failure = Arc::new(Mutex::new(None));
        let first_failure = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut slot = first_failure
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner);
            slot.get_or_insert_with(|| error.to_string());
        }));
        let name = if info.name.is_empty() {
            info.vendor.to_string()
        } else {
            info.name
        };
        Ok(Self {
            name,
            device,
            queue,
            failure,
        })
    }

    fn check(&self) -> Result<(), LdiError> {
        match &*self
            .failure
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
        {
            Some(reason) => Err(LdiError::GpuFailed {
                reason: reason.clone(),
            }),
            None => Ok(()),
        }
    }
}

/// Part of the grid, in pixels.
#[derive(Debug, Clone, Copy)]
struct Region {
    column: u32,
    row: u32,
    width: u32,
    height: u32,
}

/// What stays the same for all tiles and passes.
struct Peeler<'a> {
    gpu: &'a Gpu,
    grid: Grid,
    tile_side: u32,
    depth_per_mm: f32,
    pipeline: wgpu::RenderPipeline,
    /// Corners of facets with the number of vertices.
    buffers: Vec<(wgpu::Buffer, u32)>,
}

impl<'a> Peeler<'a> {
    fn new(gpu: &'a Gpu, mesh: &Mesh, projection: &Projection<'_>, grid: &Grid) -> Self {
        let facets_a_buffer = MAX_VERTEX_BYTES / size_of::<[Corner; 3]>();
        let visible: Vec<u32> = (0..projection.facets() as u32)
            .filter(|&facet| projection.facet(facet as usize).is_some())
            .collect();
        let buffers = visible
            .chunks(facets_a_buffer)
            .map(|facets| {
                let corners: Vec<Corner> = facets
                    .iter()
                    .flat_map(|&facet| {
                        mesh.facets[facet as usize].map(|vertex| Corner {
                            position: projection.positions[vertex as usize],
                            z_mm: mesh.vertices[vertex as usize].z,
                            facet,
                        })
                    })
                    .collect();
                let buffer = gpu
                    .device
                    .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                        label: Some("corners"),
                        contents: bytemuck::cast_slice(&corners),
                        usage: wgpu::BufferUsages::VERTEX,
                    });
                (buffer, corners.len() as u32)
            })
            .collect();
        Self {
            gpu,
            grid: *grid,
            tile_side: gpu.device.limits().max_texture_dimension_2d.min(MAX_TILE),
            // A little below 1 at the top, so that rounding never clips a hit.
            depth_per_mm: (0.999 / mesh.bounds().max.z) as f32,
            pipeline: pipeline(&gpu.device),
            buffers,
        }
    }

    /// Appends all meetings of one tile: passes until one finds nothing.
    async fn peel(
        &self,
        region: Region,
        found: &mut Vec<Meeting>,
        progress: &mut Progress<'_>,
    ) -> Result<(), LdiError> {
        let device = &self.gpu.device;
        let size = wgpu::Extent3d {
            width: region.width,
            height: region.height,
            depth_or_array_layers: 1,
        };
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let pair_usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let pairs = [texture(PAIR, pair_usage), texture(PAIR, pair_usage)];
        let views = [0, 1].map(|side: usize| pairs[side].create_view(&Default::default()));
        let depth = texture(DEPTH, wgpu::TextureUsages::empty()).create_view(&Default::default());
        let tile = Tile {
            origin: [region.column, region.row].map(|pixel| pixel as i32 * STEPS as i32),
            size: [region.width, region.height],
            depth_per_mm: self.depth_per_mm,
            steps: STEPS as f32,
        };
        let tile = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("tile"),
            contents: bytemuck::bytes_of(&tile),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let groups = [0, 1].map(|previous: usize| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: tile.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::TextureView(&views[previous]),
                    },
                ],
            })
        });
        let row_bytes =
            (region.width * PAIR_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let readback = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(row_bytes) * u64::from(region.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });

        for pass in 0.. {
            let (previous, current) = (pass % 2, (pass + 1) % 2);
            let mut encoder = device.create_command_encoder(&Default::default());
            self.draw(&mut encoder, &views[current], &depth, &groups[previous]);
            encoder.copy_texture_to_buffer(
                pairs[current].as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer: &readback,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row_bytes),
                        rows_per_image: None,
                    },
                },
                size,
            );
            self.gpu.queue.submit([encoder.finish()]);
            let before = found.len();
            self.read(&readback, region, row_bytes, found).await?;
            // How many passes there will be is not known; most hits are in the first few.
            report(progress, 1.0 - 0.8f64.powi(pass as i32 + 1))?;
            if found.len() == before {
                break;
            }
        }
        Ok(())
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        group: &wgpu::BindGroup,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("peel"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: DONE,
                        g: DONE,
                        b: DONE,
                        a: DONE,
                    }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        for (buffer, vertices) in &self.buffers {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..*vertices, 0..1);
        }
    }

    /// Waits for a pass and appends what it found.
    async fn read(
        &self,
        readback: &wgpu::Buffer,
        region: Region,
        row_bytes: u32,
        found: &mut Vec<Meeting>,
    ) -> Result<(), LdiError> {
        let failed = |reason: &dyn std::fmt::Display| LdiError::GpuFailed {
            reason: reason.to_string(),
        };
        let (sender, receiver) = futures_channel::oneshot::channel();
        readback.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if the whole job is.
            let _ = sender.send(result);
        });
        // Natively this waits; in the browser the event loop calls back.
        self.gpu
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| failed(&error))?;
        let mapped = receiver.await;
        self.gpu.check()?;
        mapped
            .map_err(|error| failed(&error))?
            .map_err(|error| failed(&error))?;
        {
            let bytes = readback
                .get_mapped_range(..)
                .map_err(|error| failed(&error))?;
            let width = region.width as usize;
            for (row, bytes) in bytes.chunks_exact(row_bytes as usize).enumerate() {
                let pairs: &[[u32; 2]] =
                    bytemuck::cast_slice(&bytes[..width * PAIR_BYTES as usize]);
                let first_ray = (region.row + row as u32) * self.grid.width + region.column;
                for (column, &[_, facet]) in pairs.iter().enumerate() {
                    if facet != u32::MAX {
                        found.push([first_ray + column as u32, facet - 1]);
                    }
                }
            }
        }
        readback.unmap();
        Ok(())
    }
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let shader = device.create_shader_module(wgpu::include_wgsl!("../../shaders/peel.wgsl"));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("peel"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: Some("project"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Corner>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Sint32x2, 1 => Float32, 2 => Uint32],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: Some("peel"),
            compilation_options: Default::default(),
            targets: &[Some(PAIR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
