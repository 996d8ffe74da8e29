//! Samples one tile by dual depth peeling (shaders/peel.wgsl; Bavoil and Myers, "Order Independent Transparency with Dual Depth
//! Peeling", 2008). Each pass finds the nearest and the farthest facet that are left on every ray; the first counts them, too.
//!
//! Order is by facets' heights, which rays need not meet in that order: heights are computed afterwards, and hits are
//! sorted by them. No facet may be missing: places ascend along a ray, so its facets differ, and their number must be
//! the count of the first pass. The facets of rays that are too deep are found on the CPU.

use rustc_hash::FxHashMap;

use super::cells::{Cells, LEAST_SIDE};
use super::device::{Gpu, WORD};
use super::failed;
use super::layers::{ALL, FACET_BYTES, Layers, clear, render_pipeline};
use super::scan::{Rows, Scan};
use super::tiles::{Intersections, Region};
use crate::argsort::argsort;
use crate::ldi::layout::{COLLECT, Cell};
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};

/// Number of facets from which a ray is left to the CPU. For the few rays as deep, that is faster than a pass for every
/// two facets.
const DEEP: u32 = 256;

/// The most rays along a side of a tile, each of which takes 24 bytes on the GPU: 101 MB in all.
pub(super) const MOST_SIDE: u32 = 2048;

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
    pub fn new(gpu: &'a Gpu, projection: &'a Projection<'a>) -> Self {
        let heights = (0..projection.facets()).map(|facet| {
            let [a, b, c] = projection.heights(facet).map(f64::from);
            a + b + c
        });
        let order = argsort(heights)
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
    pub async fn sample(&self, region: Region) -> Result<Option<Intersections>, LdiError> {
        let Some(rows) = Rows::new(self.gpu, region) else {
            return Ok(None);
        };
        let Some(cells) = Cells::new(self.projection, &self.order, region) else {
            // Too crowded: a smaller tile, or in the end the CPU.
            let is_least = region.width.max(region.height) <= LEAST_SIDE;
            return Ok(is_least.then(|| self.on_cpu(region)));
        };
        if cells.facets().len() as u64 * FACET_BYTES > self.gpu.device.limits().max_buffer_size {
            return Ok(None);
        }
        let layers = Layers::new(self.gpu, &self.peel, self.projection, region, &cells);
        self.count(&layers, &rows);
        let offsets = rows.read_offsets(self.gpu).await?;
        // The total may be more than an offset holds, and the counts are right even so.
        let hits: u64 = counts(&offsets).map(u64::from).sum();
        if hits * WORD > self.gpu.limit_bytes() {
            return Ok(None);
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let places = self.gpu.buffer("places", hits, usage);
        let cells_by_depth = CellsByDepth::new(&cells, region, &offsets);
        self.collect(&layers, &cells_by_depth, &rows, &places);
        let found = self.gpu.read(&places, 0, hits).await?;
        places.destroy();
        // Buffers of a lost device may read as zeros.
        self.gpu.check()?;
        self.intersections(region, &cells, &offsets, &found)
            .map(Some)
    }

    /// Runs the first pass, over all cells, and counts the facets of each ray.
    fn count(&self, layers: &Layers<'_>, rows: &Rows) {
        let Gpu { device, queue, .. } = self.gpu;
        let mut encoder = device.create_command_encoder(&Default::default());
        clear(&mut encoder, &layers.views[1], ALL);
        let all: Vec<usize> = (0..layers.cells.count()).collect();
        layers.draw(&mut encoder, 0, &all);
        let buffers = [
            (0, wgpu::BindingResource::TextureView(&layers.views[0])),
            (1, rows.counts.as_entire_binding()),
        ];
        let size = layers.textures[0].size();
        let workgroups = workgroups(size.width, size.height, 1);
        self.gpu
            .compute(&mut encoder, &self.count, &buffers, workgroups);
        self.scan.encode(self.gpu, &mut encoder, rows);
        queue.submit([encoder.finish()]);
    }

    /// Runs the other passes, and collects the facets of all of them.
    fn collect(
        &self,
        layers: &Layers<'_>,
        drawn: &CellsByDepth,
        rows: &Rows,
        places: &wgpu::Buffer,
    ) {
        let Gpu { device, queue, .. } = self.gpu;
        let Layers { views, cells, .. } = layers;
        let table: Vec<Cell> = drawn.cells.iter().map(|&cell| cells.on_gpu(cell)).collect();
        let table = self.gpu.filled_buffer(
            "cells",
            bytemuck::cast_slice(&table),
            wgpu::BufferUsages::STORAGE,
        );
        for pass in 0.. {
            let left = drawn.left(pass);
            if left.is_empty() {
                break;
            }
            // One submission a pass: systems reset a GPU that works on one for seconds.
            let mut encoder = device.create_command_encoder(&Default::default());
            if pass > 0 {
                layers.draw(&mut encoder, pass, left);
            }
            let layer = wgpu::BindingResource::TextureView(&views[pass % 2]);
            let collected = [
                (0, layer),
                (1, rows.counts.as_entire_binding()),
                (2, rows.offsets.as_entire_binding()),
                (3, places.as_entire_binding()),
                (4, table.as_entire_binding()),
            ];
            let workgroups = workgroups(cells.side, cells.side, left.len());
            self.gpu
                .compute(&mut encoder, &self.collect, &collected, workgroups);
            queue.submit([encoder.finish()]);
        }
        table.destroy();
    }

    /// The facets that rays meet, from their places in the lists of the cells.
    fn intersections(
        &self,
        region: Region,
        cells: &Cells,
        offsets: &[u32],
        places: &[u32],
    ) -> Result<Intersections, LdiError> {
        let deep = self.facets_of_deep_rays(region, offsets);
        let mut intersections = Intersections {
            offsets: Vec::with_capacity(offsets.len()),
            facets: Vec::with_capacity(places.len()),
        };
        intersections.offsets.push(0);
        for (ray, ends) in offsets.windows(2).enumerate() {
            if let Some(facets) = deep.get(&ray) {
                intersections.facets.extend(facets);
            } else {
                let places = places.get(ends[0] as usize..ends[1] as usize);
                for &place in places.ok_or_else(|| failed(GpuFault::BadOffsets))? {
                    // A facet that was counted and not peeled leaves a zero.
                    let facet = cells.facets().get((place as usize).wrapping_sub(1));
                    let facet = facet.ok_or_else(|| failed(GpuFault::BadOffsets))?;
                    intersections.facets.push(*facet);
                }
            }
            intersections
                .offsets
                .push(intersections.facets.len() as u32);
        }
        Ok(intersections)
    }

    /// The facets of the rays whose count is too great, by ray.
    fn facets_of_deep_rays(&self, region: Region, offsets: &[u32]) -> FxHashMap<usize, Vec<u32>> {
        let counts = counts(offsets).enumerate();
        let deep = counts.filter(|&(_, count)| count >= DEEP);
        let mut facets: FxHashMap<usize, Vec<u32>> =
            deep.map(|(ray, _)| (ray, Vec::new())).collect();
        if !facets.is_empty() {
            self.for_each_meeting(region, |ray, facet| {
                if let Some(facets) = facets.get_mut(&ray) {
                    facets.push(facet);
                }
            });
        }
        facets
    }

    /// The facets that the rays of a region meet, without the GPU.
    fn on_cpu(&self, region: Region) -> Intersections {
        let mut rays = vec![Vec::new(); region.rays()];
        self.for_each_meeting(region, |ray, facet| rays[ray].push(facet));
        let ends = rays.iter().scan(0, |end, facets| {
            *end += facets.len() as u32;
            Some(*end)
        });
        Intersections {
            offsets: std::iter::once(0).chain(ends).collect(),
            facets: rays.concat(),
        }
    }

    /// Calls `emit` with each ray of a region and each facet that it meets.
    fn for_each_meeting(&self, region: Region, mut emit: impl FnMut(usize, u32)) {
        let rows = region.row..region.row + region.height;
        for &facet in &self.order {
            let Some(outline) = self.projection.outline(facet as usize) else {
                continue;
            };
            outline.for_each_span(rows.clone(), |row, columns| {
                let first = columns.start.max(region.column);
                let end = columns.end.min(region.column + region.width);
                for column in first..end {
                    let ray = (row - region.row) * region.width + column - region.column;
                    emit(ray as usize, facet);
                }
            });
        }
    }
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

/// The cells of a tile, the deepest first.
struct CellsByDepth {
    cells: Vec<usize>,
    /// The facets along the deepest ray of each, not counting rays that are too deep.
    depths: Vec<u32>,
}

impl CellsByDepth {
    fn new(cells: &Cells, region: Region, offsets: &[u32]) -> Self {
        let depth = |cell: usize| {
            let rays = cells.rays(cell);
            let depths = (rays.row..rays.row + rays.height).flat_map(|row| {
                let first = (row * region.width + rays.column) as usize;
                counts(&offsets[first..=first + rays.width as usize])
            });
            depths.filter(|&count| count < DEEP).max().unwrap_or(0)
        };
        let depths: Vec<u32> = (0..cells.count()).map(depth).collect();
        let order = argsort(depths.iter().map(|&depth| -f64::from(depth)));
        Self {
            depths: order.iter().map(|&cell| depths[cell]).collect(),
            cells: order,
        }
    }

    /// The cells that are deep enough for this pass.
    fn left(&self, pass: usize) -> &[usize] {
        let end = self
            .depths
            .partition_point(|&depth| depth as usize > 2 * pass);
        &self.cells[..end]
    }
}
