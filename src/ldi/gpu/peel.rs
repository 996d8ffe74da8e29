//! Samples one tile by depth peeling (shaders/peel.wgsl): a tally of the facets along each ray, then a pass over the mesh
//! for each facet along the deepest one.
//!
//! Order is by facets' heights, which rays need not meet in that order: heights are computed afterwards, and hits are
//! sorted by them. What counts is that no facet is missing: keys ascend along a ray, so its facets differ, and their
//! number must be what was tallied. The facets of rays that are too deep for the tally are found on the CPU.

use rustc_hash::FxHashMap;

use super::device::{Gpu, WORD, failed};
use super::scan::{Rows, Scan};
use super::tiles::{Meetings, Region};
use crate::ldi::layout::{COLLECT_SIDE, KEYS, PEEL};
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};
use crate::model::Mesh;
use crate::order::ascending;

const TALLY: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
const LAYER: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The tally of a ray that meets at least as many facets.
const TALLY_END: u32 = u8::MAX as u32;

/// The corners of a facet in lattice steps. Each of its three vertices has all of them: `SwiftShader` is slow at drawing facets
/// as instances.
type Corners = [[i32; 2]; 3];

/// Bytes of a facet on the GPU.
const FACET_BYTES: u64 = 3 * size_of::<Corners>() as u64;

/// The mesh and the pipelines on the GPU, shared by all tiles.
pub(super) struct Peeler<'a> {
    gpu: &'a Gpu,
    projection: &'a Projection<'a>,
    /// The facets by their keys.
    order: Vec<u32>,
    /// The corners of each facet three times, by key.
    corners: wgpu::Buffer,
    tally: wgpu::RenderPipeline,
    peel: wgpu::RenderPipeline,
    count: wgpu::ComputePipeline,
    collect: wgpu::ComputePipeline,
    scan: Scan,
}

impl<'a> Peeler<'a> {
    pub fn new(
        gpu: &'a Gpu,
        mesh: &Mesh,
        projection: &'a Projection<'a>,
    ) -> Result<Self, LdiError> {
        let facets = mesh.facets.len() as u64;
        let needed_bytes = facets * FACET_BYTES;
        // A key needs as many bits as the depth buffer holds.
        let limit_bytes = gpu
            .device
            .limits()
            .max_buffer_size
            .min(u64::from(KEYS - 1) * FACET_BYTES);
        if needed_bytes > limit_bytes {
            return Err(LdiError::GpuTooSmall {
                facets,
                needed_bytes,
                limit_bytes,
            });
        }
        let heights = mesh.facets.iter().map(|facet| {
            let [a, b, c] = facet.map(|vertex| f64::from(mesh.vertices[vertex as usize].z));
            a + b + c
        });
        let order: Vec<u32> = ascending(heights)
            .into_iter()
            .map(|facet| facet as u32)
            .collect();
        let corners_of = |&facet: &u32| {
            mesh.facets[facet as usize].map(|vertex| projection.positions[vertex as usize])
        };
        let corners: Vec<[Corners; 3]> = order.iter().map(|it| [corners_of(it); 3]).collect();
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("peel.wgsl"),
                source: wgpu::ShaderSource::Wgsl(PEEL.into()),
            });
        let collect = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../../shaders/collect.wgsl"));
        let sum = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let sum = wgpu::BlendState {
            color: sum,
            alpha: sum,
        };
        Ok(Self {
            gpu,
            projection,
            order,
            corners: gpu.filled_buffer(
                "corners",
                bytemuck::cast_slice(&corners),
                wgpu::BufferUsages::VERTEX,
            ),
            tally: render_pipeline(gpu, &module, "tally", TALLY, Some(sum), None),
            peel: render_pipeline(
                gpu,
                &module,
                "peel",
                LAYER,
                None,
                Some(wgpu::CompareFunction::Less),
            ),
            count: gpu.compute_pipeline(&collect, "count"),
            collect: gpu.compute_pipeline(&collect, "collect"),
            scan: Scan::new(gpu),
        })
    }

    /// The facets that the rays of one tile meet, or `None` if they do not fit into a buffer.
    pub async fn sample(&self, region: Region) -> Result<Option<Meetings>, LdiError> {
        let Gpu { device, queue, .. } = self.gpu;
        let Some(rows) = Rows::new(self.gpu, region) else {
            return Ok(None);
        };
        let tile = self.gpu.tile(region);
        let texture = |label, format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: region.extent(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let workgroups = [region.width, region.height].map(|side| side.div_ceil(COLLECT_SIDE));

        let tally = texture("tally", TALLY);
        let mut encoder = device.create_command_encoder(&Default::default());
        let place = [(0, tile.as_entire_binding())];
        self.draw(&mut encoder, &self.tally, &place, &tally, None);
        let counts = [
            (0, wgpu::BindingResource::TextureView(&tally)),
            (2, rows.counts.as_entire_binding()),
        ];
        self.gpu
            .compute(&mut encoder, &self.count, &counts, workgroups);
        self.scan.encode(self.gpu, &mut encoder, &rows);
        queue.submit([encoder.finish()]);
        let offsets = rows.read_offsets(self.gpu).await?;
        let depth = tallies(&offsets).filter(|&tally| tally < TALLY_END).max();
        let depth = depth.unwrap_or(0);
        let hits = u64::from(offsets[region.rays()]);
        if hits * WORD > self.gpu.limit_bytes() {
            return Ok(None);
        }

        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let facets = self.gpu.buffer("facets", hits, usage);
        let layers = [texture("even layers", LAYER), texture("odd layers", LAYER)];
        let nearest = texture("depth", DEPTH);
        let mut encoder = device.create_command_encoder(&Default::default());
        for pass in 0..depth as usize {
            let [previous, layer] = [&layers[(pass + 1) % 2], &layers[pass % 2]];
            let seen = [
                place[0].clone(),
                (1, wgpu::BindingResource::TextureView(previous)),
            ];
            self.draw(&mut encoder, &self.peel, &seen, layer, Some(&nearest));
            let collected = [
                (1, wgpu::BindingResource::TextureView(layer)),
                (2, rows.counts.as_entire_binding()),
                (3, rows.offsets.as_entire_binding()),
                (4, facets.as_entire_binding()),
            ];
            self.gpu
                .compute(&mut encoder, &self.collect, &collected, workgroups);
        }
        queue.submit([encoder.finish()]);
        let keys = self.gpu.read(&facets, 0, hits).await?;
        // Buffers of a lost device may read as zeros.
        self.gpu.check()?;
        self.meetings(region, &offsets, &keys).map(Some)
    }

    /// The facets that rays meet, from the keys that were peeled.
    fn meetings(
        &self,
        region: Region,
        offsets: &[u32],
        keys: &[u32],
    ) -> Result<Meetings, LdiError> {
        let deep = self.facets_of_deep_rays(region, offsets);
        let mut meetings = Meetings {
            offsets: Vec::with_capacity(offsets.len()),
            facets: Vec::with_capacity(keys.len()),
        };
        meetings.offsets.push(0);
        for (ray, ends) in offsets.windows(2).enumerate() {
            if let Some(facets) = deep.get(&ray) {
                meetings.facets.extend(facets);
            } else {
                let keys = keys.get(ends[0] as usize..ends[1] as usize);
                for &key in keys.ok_or_else(|| failed(GpuFault::BadOffsets))? {
                    // A facet that was tallied and not peeled leaves a zero.
                    let facet = self.order.get((key as usize).wrapping_sub(1));
                    let facet = facet.ok_or_else(|| failed(GpuFault::BadOffsets))?;
                    meetings.facets.push(*facet);
                }
            }
            meetings.offsets.push(meetings.facets.len() as u32);
        }
        Ok(meetings)
    }

    /// The facets of the rays whose tally is at its end, by ray.
    fn facets_of_deep_rays(&self, region: Region, offsets: &[u32]) -> FxHashMap<usize, Vec<u32>> {
        let tallies = tallies(offsets).enumerate();
        let deep = tallies.filter(|&(_, tally)| tally >= TALLY_END);
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

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        resources: &[(u32, wgpu::BindingResource<'_>)],
        target: &wgpu::TextureView,
        depth: Option<&wgpu::TextureView>,
    ) {
        let group = self.gpu.bind(&pipeline.get_bind_group_layout(0), resources);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("peel"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..3 * self.order.len() as u32, 0..1);
    }
}

/// The tally of each ray.
fn tallies(offsets: &[u32]) -> impl Iterator<Item = u32> {
    offsets.windows(2).map(|ends| ends[1].wrapping_sub(ends[0]))
}

fn render_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    fragment: &str,
    format: wgpu::TextureFormat,
    blend: Option<wgpu::BlendState>,
    depth_compare: Option<wgpu::CompareFunction>,
) -> wgpu::RenderPipeline {
    let corner = |i: u32| wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Sint32x2,
        offset: u64::from(i) * 8,
        shader_location: i,
    };
    let corners = [0, 1, 2].map(corner);
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: None,
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("propose"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Corners>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &corners,
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: depth_compare.map(|compare| wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(fragment),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
}
