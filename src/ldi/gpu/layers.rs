//! The textures that depth peeling draws on (shaders/peel.wgsl): two layers of a tile, which passes read and write in turn.

use super::cells::Cells;
use super::device::Gpu;
use super::tiles::Region;
use crate::ldi::layout::PEEL;
use crate::ldi::projection::Projection;

/// Blends exactly on every adapter: half precision has each place in a list, and each count up to 2048.
const LAYER: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The layer before the first: all places lie between its two.
pub(super) const ALL: wgpu::Color = wgpu::Color {
    r: 65504.0,
    ..wgpu::Color::TRANSPARENT
};

/// A layer on which nothing is kept yet, and between whose two lies no place.
const NONE: wgpu::Color = wgpu::Color {
    g: -65504.0,
    ..wgpu::Color::TRANSPARENT
};

/// The corners of a facet in lattice steps. Each of its three vertices has all of them: `SwiftShader` is slow at drawing facets
/// as instances.
type Corners = [[i32; 2]; 3];

/// Bytes of a facet on the GPU.
pub(super) const FACET_BYTES: u64 = 3 * size_of::<Corners>() as u64;

/// The two layers of a tile that passes read and write in turn, and the facets drawn on them.
pub(super) struct Layers<'a> {
    peel: &'a wgpu::RenderPipeline,
    pub cells: &'a Cells,
    /// The corners of each facet of each cell's list, three times.
    corners: wgpu::Buffer,
    pub textures: [wgpu::Texture; 2],
    pub views: [wgpu::TextureView; 2],
    /// Bind groups of the passes that write to one layer or the other.
    seen: [wgpu::BindGroup; 2],
}

impl<'a> Layers<'a> {
    /// Layers for the rays of a region.
    pub fn new(
        gpu: &Gpu,
        peel: &'a wgpu::RenderPipeline,
        projection: &Projection<'_>,
        region: Region,
        cells: &'a Cells,
    ) -> Self {
        let corners: Vec<[Corners; 3]> = cells
            .facets()
            .iter()
            .map(|&facet| [projection.corners(facet as usize); 3])
            .collect();
        let textures = ["even layers", "odd layers"].map(|label| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: Gpu::extent(region),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: LAYER,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        });
        let views = [&textures[0], &textures[1]].map(|it| it.create_view(&Default::default()));
        let tile = gpu.tile(region);
        let seen = [&views[1], &views[0]].map(|previous| {
            let resources = [
                (0, tile.as_entire_binding()),
                (1, wgpu::BindingResource::TextureView(previous)),
            ];
            gpu.bind(&peel.get_bind_group_layout(0), &resources)
        });
        Self {
            peel,
            cells,
            corners: gpu.filled_buffer(
                "corners",
                bytemuck::cast_slice(&corners),
                wgpu::BufferUsages::VERTEX,
            ),
            textures,
            views,
            seen,
        }
    }

    /// Draws some cells in one pass.
    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder, pass: usize, drawn: &[usize]) {
        let mut render = clear(encoder, &self.views[pass % 2], NONE);
        render.set_pipeline(self.peel);
        render.set_bind_group(0, &self.seen[pass % 2], &[]);
        for &cell in drawn {
            let list = self.cells.list(cell);
            if list.is_empty() {
                continue;
            }
            let bytes = [list.start, list.end].map(|place| place as u64 * FACET_BYTES);
            let rays = self.cells.rays(cell);
            render.set_scissor_rect(rays.column, rays.row, rays.width, rays.height);
            // Numbers vertices from the beginning of the list.
            render.set_vertex_buffer(0, self.corners.slice(bytes[0]..bytes[1]));
            render.draw(0..3 * list.len() as u32, 0..1);
        }
    }
}

/// In a browser, dropping them frees nothing before garbage is collected.
impl Drop for Layers<'_> {
    fn drop(&mut self) {
        self.textures.iter().for_each(wgpu::Texture::destroy);
        self.corners.destroy();
    }
}

/// Begins a pass that clears a layer.
pub(super) fn clear<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    layer: &wgpu::TextureView,
    colour: wgpu::Color,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("peel"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: layer,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(colour),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    })
}

/// The pipeline of all passes.
pub(super) fn render_pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("peel.wgsl"),
            source: wgpu::ShaderSource::Wgsl(PEEL.into()),
        });
    let blend = |operation| wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation,
    };
    let corner = |i: u32| wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Sint32x2,
        offset: u64::from(i) * 8,
        shader_location: i,
    };
    let corners = [0, 1, 2].map(corner);
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("peel"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("propose"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Corners>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &corners,
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("peel"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: LAYER,
                    blend: Some(wgpu::BlendState {
                        color: blend(wgpu::BlendOperation::Max),
                        alpha: blend(wgpu::BlendOperation::Add),
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
}
