//! Samples one tile in two passes over the mesh (shaders/fill.wgsl), with a prefix sum between them.

use super::device::{Gpu, WORD};
use super::failed;
use super::scan::{Rows, Scan};
use super::tiles::{Intersections, Region};
use crate::ldi::layout::FILL;
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};

/// Format of the render target. A render pass needs one, though these passes write nothing to it.
const CANVAS: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The mesh and the pipelines on the GPU, shared by all tiles.
pub(super) struct Filler<'a> {
    gpu: &'a Gpu,
    vertices: u32,
    positions: wgpu::Buffer,
    corners: wgpu::Buffer,
    count: wgpu::RenderPipeline,
    fill: wgpu::RenderPipeline,
    scan: Scan,
}

impl<'a> Filler<'a> {
    pub(super) fn new(gpu: &'a Gpu, projection: &Projection<'_>) -> Result<Self, LdiError> {
        let limit_bytes = gpu.limit_bytes();
        let corner_bytes = std::mem::size_of_val(projection.vertices_of) as u64;
        let position_bytes = std::mem::size_of_val(projection.positions.as_slice()) as u64;
        let needed_bytes = corner_bytes.max(position_bytes);
        if needed_bytes > limit_bytes {
            return Err(LdiError::GpuTooSmall {
                facets: projection.facets() as u64,
                needed_bytes,
                limit_bytes,
            });
        }
        let storage =
            |label, contents| gpu.filled_buffer(label, contents, wgpu::BufferUsages::STORAGE);
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("fill.wgsl"),
                source: wgpu::ShaderSource::Wgsl(FILL.into()),
            });
        Ok(Self {
            gpu,
            vertices: projection.facets() as u32 * 3,
            positions: storage("positions", bytemuck::cast_slice(&projection.positions)),
            corners: storage("corners", bytemuck::cast_slice(projection.vertices_of)),
            count: render_pipeline(&gpu.device, &module, "count"),
            fill: render_pipeline(&gpu.device, &module, "fill"),
            scan: Scan::new(gpu),
        })
    }

    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    pub(super) async fn sample(&self, region: Region) -> Result<Option<Intersections>, LdiError> {
        let Gpu { device, queue, .. } = self.gpu;
        let Some(rows) = Rows::new(self.gpu, region) else {
            return Ok(None);
        };
        let tile = self.gpu.tile(region);
        let canvas = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("canvas"),
            size: Gpu::extent(region),
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
            (0, tile.as_entire_binding()),
            (1, self.positions.as_entire_binding()),
            (2, self.corners.as_entire_binding()),
            (3, rows.counts.as_entire_binding()),
        ];
        self.draw(&mut encoder, &canvas, &self.count, &mesh);
        self.scan.encode(self.gpu, &mut encoder, &rows);
        queue.submit([encoder.finish()]);
        let hits = rows.hits(self.gpu).await?;
        if hits * WORD > self.gpu.limit_bytes() {
            return Ok(None);
        }

        let readable = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let facets = self.gpu.buffer("facets", hits, readable);
        let mut encoder = device.create_command_encoder(&Default::default());
        let rest = [
            (4, rows.offsets.as_entire_binding()),
            (5, facets.as_entire_binding()),
        ];
        let filled = [&mesh[..], &rest].concat();
        self.draw(&mut encoder, &canvas, &self.fill, &filled);
        queue.submit([encoder.finish()]);
        let intersections = Intersections {
            offsets: rows.read_offsets(self.gpu).await?,
            facets: self.gpu.read(&facets, 0, hits).await?,
        };
        // Buffers of a lost device may read as zeros.
        self.gpu.check()?;
        facets.destroy();
        if u64::from(intersections.offsets[region.rays()]) != hits {
            return Err(failed(GpuFault::BadOffsets));
        }
        Ok(Some(intersections))
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        canvas: &wgpu::TextureView,
        pipeline: &wgpu::RenderPipeline,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) {
        let group = self.gpu.bind(&pipeline.get_bind_group_layout(0), resources);
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
