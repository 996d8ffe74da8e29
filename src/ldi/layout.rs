//! Data as the shaders read it. tests/layout.rs checks that sizes and offsets match the WGSL.

/// The part of the grid that a pass draws.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Tile {
    /// Top left corner of the tile, in lattice steps from the grid's top left corner.
    pub origin: [i32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// Number of values that one workgroup of shaders/scan.wgsl sums.
pub const SCAN_BLOCK: u32 = 1024;
