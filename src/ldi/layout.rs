//! Data as shaders/peel.wgsl reads it. tests/layout.rs compares the two.

/// A corner of a facet; three in a row make a triangle.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Corner {
    /// Columns to the right and rows downward, in lattice steps.
    pub position: [i32; 2],
    /// Height above the plate.
    pub z_mm: f32,
    /// Index of the facet.
    pub facet: u32,
}

/// The part of the grid that a pass draws.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Tile {
    /// Top left corner of the tile, in lattice steps from that of the grid.
    pub origin: [i32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
    /// What turns a height in millimetres into a depth below 1.
    pub depth_per_mm: f32,
    /// Lattice steps a pixel.
    pub steps: f32,
}
