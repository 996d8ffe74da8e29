//! Samples one tile by dual depth peeling (shaders/peel.wgsl; Bavoil and Myers, "Order Independent Transparency with Dual Depth
//! Peeling", 2008). Each pass finds the nearest and the farthest facet that are left on every ray; the first counts them, too.
//!
//! Order is by facets' heights, which rays need not meet in that order: heights are computed afterwards, and hits are
//! sorted by them. What counts is that no facet is missing: places ascend along a ray, so its facets differ, and their
//! number must be what was counted. The facets of rays that are too deep are found on the CPU.

use rustc_hash::FxHashMap;

use super::cells::Cells;
use super::device::{Gpu, WORD, failed};
use super::scan::{Rows, Scan};
use super::tiles::{Meetings, Region};
use crate::ldi::layout::{COLLECT, Cell, PEEL};
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};
use crate::model::Mesh;
use crate::order::ascending;

/// Blends exactly on every adapter: half precision has each place in a list, and each count up to 2048.
const LAYER: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Rays of so many facets are left to the CPU, which is faster at a few of them than a pass for every two facets.
const DEEP: u32 = 256;

/// The layer before the first: all places lie between its two.
const ALL: wgpu::Color = wgpu::Color {
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
const FACET_BYTES: u64 = 3 * size_of::<Corners>() as u64;

/// The mesh and the pipelines on the GPU, shared by all tiles.
pub(super) struct Peeler<'a> {
    gpu: &'a Gpu,
    projection: &'a Projection<'a>,
    /// The facets that are not edge-on to the rays, by height.
    order: Vec<u32>,
    peel: wgpu::RenderPipeline,
    count: wgpu::ComputePipeline,
    collect: wgpu::ComputePipeline,
    scan: Scan,
}

impl<'a> Peeler<'a> {
    pub fn new(gpu: &'a Gpu, mesh: &Mesh, projection: &'a Projection<'a>) -> Self {
        let heights = mesh.facets.iter().map(|facet| {
            let [a, b, c] = facet.map(|vertex| f64::from(mesh.vertices[vertex as usize].z));
            a + b + c
        });
        let order = ascending(heights)
            .into_iter()
            .filter(|&facet| projection.outline(facet).is_some());
        let collect = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../../shaders/collect.wgsl"));
        Self {
            gpu,
            projection,
            order: order.map(|facet| facet as u32).collect(),
            peel: render_pipeline(gpu),
            count: gpu.compute_pipeline(&collect, "count"),
            collect: gpu.compute_pipeline(&collect, "collect"),
            scan: Scan::new(gpu),
        }
    }

    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    pub async fn sample(&self, region: Region) -> Result<Option<Meetings>, LdiError> {
        let Gpu { device, queue, .. } = self.gpu;
        let Some(rows) = Rows::new(self.gpu, region) else {
            return Ok(None);
        };
        let Some(cells) = Cells::new(self.projection, &self.order, region) else {
            return Ok(None);
        };
        if cells.facets().len() as u64 * FACET_BYTES > device.limits().max_buffer_size {
            return Ok(None);
        }
        let layers = Layers::new(self, region, &cells);

        let mut encoder = device.create_command_encoder(&Default::default());
        clear(&mut encoder, &layers.views[1], ALL);
        let drawn: Vec<usize> = (0..cells.count()).collect();
        layers.draw(&mut encoder, 0, &cells, &drawn);
        let counts = [
            (0, wgpu::BindingResource::TextureView(&layers.views[0])),
            (1, rows.counts.as_entire_binding()),
        ];
        let whole = workgroups(region.width, region.height, 1);
        self.gpu.compute(&mut encoder, &self.count, &counts, whole);
        self.scan.encode(self.gpu, &mut encoder, &rows);
        queue.submit([encoder.finish()]);
        let offsets = rows.read_offsets(self.gpu).await?;
        let hits = u64::from(offsets[region.rays()]);
        if hits * WORD > self.gpu.limit_bytes() {
            return Ok(None);
        }
        if hits == 0 {
            return self.meetings(region, &cells, &offsets, &[]).map(Some);
        }

        // Cells by depth: each pass draws those that are deep enough.
        let depths: Vec<u32> = (0..cells.count())
            .map(|cell| depth(cells.rays(cell), region, &offsets))
            .collect();
        let deepest_first = ascending(depths.iter().map(|&depth| -f64::from(depth)));
        let drawn: Vec<usize> = deepest_first
            .into_iter()
            .filter(|&cell| depths[cell] > 0)
            .collect();
        let table: Vec<Cell> = drawn.iter().map(|&cell| cells.on_gpu(cell)).collect();
        let storage = wgpu::BufferUsages::STORAGE;
        let table = self
            .gpu
            .filled_buffer("cells", bytemuck::cast_slice(&table), storage);
        let places = self
            .gpu
            .buffer("places", hits, storage | wgpu::BufferUsages::COPY_SRC);

        let mut encoder = device.create_command_encoder(&Default::default());
        for pass in 0.. {
            let left = drawn.partition_point(|&cell| depths[cell] > 2 * pass);
            if left == 0 {
                break;
            }
            let pass = pass as usize;
            if pass > 0 {
                layers.draw(&mut encoder, pass, &cells, &drawn[..left]);
            }
            let collected = [
                (
                    0,
                    wgpu::BindingResource::TextureView(&layers.views[pass % 2]),
                ),
                (1, rows.counts.as_entire_binding()),
                (2, rows.offsets.as_entire_binding()),
                (3, places.as_entire_binding()),
                (4, table.as_entire_binding()),
            ];
            self.gpu.compute(
                &mut encoder,
                &self.collect,
                &collected,
                workgroups(cells.side, cells.side, left),
            );
        }
        queue.submit([encoder.finish()]);
        let places = self.gpu.read(&places, 0, hits).await?;
        // Buffers of a lost device may read as zeros.
        self.gpu.check()?;
        self.meetings(region, &cells, &offsets, &places).map(Some)
    }

    /// The facets that rays meet, from their places in the lists of the cells.
    fn meetings(
        &self,
        region: Region,
        cells: &Cells,
        offsets: &[u32],
        places: &[u32],
    ) -> Result<Meetings, LdiError> {
        let deep = self.facets_of_deep_rays(region, offsets);
        let mut meetings = Meetings {
            offsets: Vec::with_capacity(offsets.len()),
            facets: Vec::with_capacity(places.len()),
        };
        meetings.offsets.push(0);
        for (ray, ends) in offsets.windows(2).enumerate() {
            if let Some(facets) = deep.get(&ray) {
                meetings.facets.extend(facets);
            } else {
                let places = places.get(ends[0] as usize..ends[1] as usize);
                for &place in places.ok_or_else(|| failed(GpuFault::BadOffsets))? {
                    // A facet that was counted and not peeled leaves a zero.
                    let facet = cells.facets().get((place as usize).wrapping_sub(1));
                    let facet = facet.ok_or_else(|| failed(GpuFault::BadOffsets))?;
                    meetings.facets.push(*facet);
                }
            }
            meetings.offsets.push(meetings.facets.len() as u32);
        }
        Ok(meetings)
    }

    /// The facets of the rays whose count is too great, by ray.
    fn facets_of_deep_rays(&self, region: Region, offsets: &[u32]) -> FxHashMap<usize, Vec<u32>> {
        let counts = counts(offsets).enumerate();
        let deep = counts.filter(|&(_, count)| count >= DEEP);
        let mut facets: FxHashMap<usize, Vec<u32>> =
            deep.map(|(ray, _)| (ray, Vec::new())).collect();
        if facets.is_empty() {
            return facets;
        }
        let rows = region.row..region.row + region.height;
        for facet in 0..self.projection.facets() {
            let Some(outline) = self.projection.outline(facet) else {
                continue;
            };
            outline.for_each_span(rows.clone(), |row, columns| {
                let first = columns.start.max(region.column);
                let end = columns.end.min(region.column + region.width);
                for column in first..end {
                    let ray = (row - region.row) * region.width + column - region.column;
                    if let Some(facets) = facets.get_mut(&(ray as usize)) {
                        facets.push(facet as u32);
                    }
                }
            });
        }
        facets
    }
}

/// The two layers of a tile that passes read and write in turn, and what is drawn on them.
struct Layers<'a> {
    peel: &'a wgpu::RenderPipeline,
    /// The corners of each facet of each cell's list, three times.
    corners: wgpu::Buffer,
    views: [wgpu::TextureView; 2],
    /// What the passes see that write the one layer or the other.
    seen: [wgpu::BindGroup; 2],
}

impl<'a> Layers<'a> {
    fn new(peeler: &'a Peeler<'_>, region: Region, cells: &Cells) -> Self {
        let gpu = peeler.gpu;
        let corners: Vec<[Corners; 3]> = cells
            .facets()
            .iter()
            .map(|&facet| [peeler.projection.corners(facet as usize); 3])
            .collect();
        let views = ["even layers", "odd layers"].map(|label| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: region.extent(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: LAYER,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        });
        let tile = gpu.tile(region);
        let seen = [&views[1], &views[0]].map(|previous| {
            let resources = [
                (0, tile.as_entire_binding()),
                (1, wgpu::BindingResource::TextureView(previous)),
            ];
            gpu.bind(&peeler.peel.get_bind_group_layout(0), &resources)
        });
        Self {
            peel: &peeler.peel,
            corners: gpu.filled_buffer(
                "corners",
                bytemuck::cast_slice(&corners),
                wgpu::BufferUsages::VERTEX,
            ),
            views,
            seen,
        }
    }

    /// Draws some cells in one pass.
    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pass: usize,
        cells: &Cells,
        drawn: &[usize],
    ) {
        let mut render = clear(encoder, &self.views[pass % 2], NONE);
        render.set_pipeline(self.peel);
        render.set_bind_group(0, &self.seen[pass % 2], &[]);
        for &cell in drawn {
            let list = cells.list(cell);
            if list.is_empty() {
                continue;
            }
            let bytes = [list.start, list.end].map(|place| place as u64 * FACET_BYTES);
            let rays = cells.rays(cell);
            render.set_scissor_rect(rays.column, rays.row, rays.width, rays.height);
            // Numbers vertices from the beginning of the list.
            render.set_vertex_buffer(0, self.corners.slice(bytes[0]..bytes[1]));
            render.draw(0..3 * list.len() as u32, 0..1);
        }
    }
}

/// Begins a pass that clears a layer.
fn clear<'a>(
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

/// The workgroups that collect from `cells` cells of this size.
fn workgroups(width: u32, height: u32, cells: usize) -> [u32; 3] {
    let [columns, rows] = COLLECT;
    [width.div_ceil(columns), height.div_ceil(rows), cells as u32]
}

/// The facets of each ray.
fn counts(offsets: &[u32]) -> impl Iterator<Item = u32> {
    offsets.windows(2).map(|ends| ends[1].wrapping_sub(ends[0]))
}

/// The facets of the deepest ray of a part of a region, not counting those that are too deep.
fn depth(rays: Region, region: Region, offsets: &[u32]) -> u32 {
    let rows = rays.row..rays.row + rays.height;
    let depths = rows.flat_map(|row| {
        let first = (row * region.width + rays.column) as usize;
        counts(&offsets[first..=first + rays.width as usize])
    });
    depths.filter(|&count| count < DEEP).max().unwrap_or(0)
}

fn render_pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
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
