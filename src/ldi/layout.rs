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

/// A square of a tile whose facets are peeled in the order of a list of its own.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Cell {
    /// Its top left pixel, from the tile's.
    pub corner: [u32; 2],
    /// Start of its list among those of the tile.
    pub first: u32,
    /// Always 0.
    pub padding: u32,
}

/// Greatest number of facets in a cell's list: the number of normal positive half-precision numbers below the greatest.
pub const CELL_FACETS: usize = 0x7bff - 0x400;

/// Columns and rows of the workgroups of shaders/collect.wgsl, in rays.
pub const COLLECT: [u32; 2] = [16, 8];

/// The source of the filling method.
pub const FILL: &str = concat!(
    include_str!("../../shaders/proposal.wgsl"),
    include_str!("../../shaders/fill.wgsl")
);

/// The source of depth peeling.
pub const PEEL: &str = concat!(
    include_str!("../../shaders/proposal.wgsl"),
    include_str!("../../shaders/peel.wgsl")
);
