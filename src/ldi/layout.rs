//! Data as the shaders read it. tests/layout.rs compares the two.

/// The part of the grid that a pass draws.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Tile {
    /// Top left corner of the tile, in lattice steps from that of the grid.
    pub origin: [i32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// Values that one workgroup of shaders/scan.wgsl sums up.
pub const SCAN_BLOCK: u32 = 1024;
