//! Samples one tile: two passes over the mesh, with a prefix sum between them.

use super::device::{Gpu, WORD, failed};
use super::tiles::{Meetings, Region};
use crate::ldi::layout::{SCAN_BLOCK, Tile};
use crate::ldi::projection::{Projection, STEPS};
use crate::ldi::{GpuFault, LdiError};
use crate::model::Mesh;

/// Format of the render target. A render pass needs one, though these passes write nothing to it.
const CANVAS: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The mesh and the pipelines on the GPU, shared by all tiles.
pub(super) struct Sampler<'a> {
    gpu: &'a Gpu,
    vertices: u32,
    positions: wgpu::Buffer,
    corners: wgpu::Buffer,
    count: wgpu::RenderPipeline,
    fill: wgpu::RenderPipeline,
    scan: [wgpu::ComputePipeline; 3],
}

impl<'a> Sampler<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        mesh: &Mesh,
        projection: &Projection<'_>,
    ) -> Result<Self, LdiError> {
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
            .create_shader_module(wgpu::include_wgsl!("../../../shaders/sample.wgsl"));
        let scan = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../../shaders/scan.wgsl"));
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

    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    pub(super) async fn sample(&self, region: Region) -> Result<Option<Meetings>, LdiError> {
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
        // Buffers of a lost device may read as zeros.
        self.gpu.check()?;
        if u64::from(meetings.offsets[rays as usize]) != hits {
            return Err(failed(GpuFault::BadOffsets));
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

    /// Writes the exclusive prefix sum of `counts` to `offsets`, followed by the total.
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
