//! The rows of a tile: hits counted for each ray, and the prefix sum (shaders/scan.wgsl) that turns them into offsets.

use super::device::{Gpu, WORD};
use super::tiles::Region;
use crate::ldi::LdiError;
use crate::ldi::layout::SCAN_BLOCK;

/// The pipelines of the prefix sum.
pub(super) struct Scan([wgpu::ComputePipeline; 3]);

/// Buffers for the rows of a tile.
pub(super) struct Rows {
    rays: u64,
    /// Hits of each ray.
    pub counts: wgpu::Buffer,
    /// Index of each ray's first hit, followed by the number of all hits.
    pub offsets: wgpu::Buffer,
    totals: wgpu::Buffer,
}

impl Rows {
    /// `None` if the tile has more rays than a buffer holds.
    pub fn new(gpu: &Gpu, region: Region) -> Option<Self> {
        let rays = region.rays() as u64;
        if (rays + 1) * WORD > gpu.limit_bytes() {
            return None;
        }
        let storage = wgpu::BufferUsages::STORAGE;
        let readable = storage | wgpu::BufferUsages::COPY_SRC;
        Some(Self {
            rays,
            counts: gpu.buffer("counts", rays, storage),
            offsets: gpu.buffer("offsets", rays + 1, readable),
            totals: gpu.buffer("totals", blocks(rays) + 1, readable),
        })
    }

    /// The number of all hits.
    pub async fn hits(&self, gpu: &Gpu) -> Result<u64, LdiError> {
        Ok(u64::from(
            gpu.read(&self.totals, blocks(self.rays), 1).await?[0],
        ))
    }

    pub async fn read_offsets(&self, gpu: &Gpu) -> Result<Vec<u32>, LdiError> {
        gpu.read(&self.offsets, 0, self.rays + 1).await
    }
}

/// In a browser, dropping buffers frees nothing before garbage is collected.
impl Drop for Rows {
    fn drop(&mut self) {
        for buffer in [&self.counts, &self.offsets, &self.totals] {
            buffer.destroy();
        }
    }
}

fn blocks(rays: u64) -> u64 {
    rays.div_ceil(u64::from(SCAN_BLOCK))
}

impl Scan {
    pub fn new(gpu: &Gpu) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("../../../shaders/scan.wgsl"));
        Self(
            ["scan_blocks", "scan_totals", "add_totals"]
                .map(|step| gpu.compute_pipeline(&module, step)),
        )
    }

    /// Writes the exclusive prefix sum of the counts to the offsets, followed by the total.
    pub fn encode(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, rows: &Rows) {
        let [scan_blocks, scan_totals, add_totals] = &self.0;
        let all = [
            (0, rows.counts.as_entire_binding()),
            (1, rows.offsets.as_entire_binding()),
            (2, rows.totals.as_entire_binding()),
        ];
        let blocks = blocks(rows.rays) as u32;
        for (pipeline, buffers, workgroups) in [
            (scan_blocks, &all[..], blocks),
            (scan_totals, &all[2..], 1),
            (add_totals, &all[..], blocks),
        ] {
            gpu.compute(encoder, pipeline, buffers, [workgroups, 1, 1]);
        }
    }
}
