// Depth peeling by the pair (depth, facet): each pass keeps, for every ray, the least pair that is
// greater than the one the pass before it found, so that coincident surfaces are never lost.
// Rasterisation order settles equal depths, since facets are drawn in the order of their indices.

// The part of the grid that this pass draws. Twin of `Tile` in src/ldi/layout.rs.
struct Tile {
    // Top left corner of the tile, in lattice steps from that of the grid.
    origin: vec2<i32>,
    // Columns and rows.
    size: vec2<u32>,
    // What turns a height in millimetres into a depth below 1.
    depth_per_mm: f32,
    // Lattice steps a pixel.
    steps: f32,
}

@group(0) @binding(0) var<uniform> tile: Tile;
@group(0) @binding(1) var previous: texture_2d<u32>;

// Twin of `Corner` in src/ldi/layout.rs.
struct Corner {
    // Columns to the right and rows downward, in lattice steps.
    @location(0) position: vec2<i32>,
    // Height above the plate.
    @location(1) z_mm: f32,
    // Index of the facet.
    @location(2) facet: u32,
}

struct Fragment {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) facet: u32,
}

@vertex
fn project(corner: Corner) -> Fragment {
    // Exact: lattice positions need fewer bits than a float's mantissa holds.
    let pixel = vec2<f32>(corner.position - tile.origin) / tile.steps;
    let size = vec2<f32>(tile.size);
    let x = pixel.x * 2.0 / size.x - 1.0;
    let y = 1.0 - pixel.y * 2.0 / size.y;
    return Fragment(vec4<f32>(x, y, corner.z_mm * tile.depth_per_mm, 1.0), corner.facet);
}

@fragment
fn peel(fragment: Fragment) -> @location(0) vec2<u32> {
    // Bits of non-negative floats are in the floats' order. Facets count from 1, so that (0, 0),
    // which the first pass finds, is below every pair.
    let pair = vec2<u32>(bitcast<u32>(fragment.position.z), fragment.facet + 1u);
    let last = textureLoad(previous, vec2<i32>(fragment.position.xy), 0).xy;
    if pair.x < last.x || (pair.x == last.x && pair.y <= last.y) {
        discard;
    }
    return pair;
}
