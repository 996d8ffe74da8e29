// From the targets of depth peeling (peel.wgsl) to the rows of the filling method.

// Stands for the first place in a list. Twin of the constant in peel.wgsl.
const LEAST: u32 = 0x1c400u;

// Columns and rows of a workgroup: no more threads than WebGPU's compatibility mode allows. Twins of `COLLECT` in
// src/ldi/layout.rs.
const COLUMNS: u32 = 16u;
const ROWS: u32 = 8u;

// A square of the tile with a list of its own. Twin of `Cell` in src/ldi/layout.rs.
struct Cell {
    // Its top left pixel.
    corner: vec2<u32>,
    // Start of its list.
    first: u32,
}

// The last facets peeled: the farthest, minus the nearest, unused, and the number of facets.
@group(0) @binding(0) var layer: texture_2d<f32>;
// Facets of each ray that are yet to be collected.
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;
// Index of each ray's first facet, followed by the total.
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
// One more than the places of the facets that rays meet in the lists, ascending within a ray.
@group(0) @binding(3) var<storage, read_write> places: array<u32>;
@group(0) @binding(4) var<storage, read> cells: array<Cell>;

@compute @workgroup_size(COLUMNS, ROWS)
fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(layer);
    if any(id.xy >= size) {
        return;
    }
    counts[id.y * size.x + id.x] = u32(round(textureLoad(layer, id.xy, 0).w));
}

fn place_of(half: f32) -> u32 {
    return (bitcast<u32>(half) >> 13u) - LEAST;
}

// Nearest facets fill a ray's row from its beginning, farthest ones from its end.
@compute @workgroup_size(COLUMNS, ROWS)
fn collect(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) id: vec3<u32>) {
    let cell = cells[group.z];
    let pixel = cell.corner + group.xy * vec2<u32>(COLUMNS, ROWS) + id.xy;
    let size = textureDimensions(layer);
    if any(pixel >= size) {
        return;
    }
    let ray = pixel.y * size.x + pixel.x;
    let found = textureLoad(layer, pixel, 0);
    let left = counts[ray];
    if found.x <= 0.0 || left == 0u {
        return;
    }
    let first = offsets[ray];
    let end = offsets[ray + 1u];
    let kept = (end - first - left) / 2u;
    // One facet left is both nearest and farthest, more are not. Otherwise the count is wrong, and slots stay empty.
    if (left == 1u) != (found.x == -found.y) {
        return;
    }
    places[first + kept] = cell.first + place_of(-found.y) + 1u;
    places[end - 1u - kept] = cell.first + place_of(found.x) + 1u;
    counts[ray] = left - min(left, 2u);
}
