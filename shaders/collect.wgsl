// From the textures of depth peeling (peel.wgsl) to the rows of the filling method.

// Facets of each ray, in steps of 1/255.
@group(0) @binding(0) var tally: texture_2d<f32>;
// The layer peeled last: one more than a facet's key, or 0.
@group(0) @binding(1) var layer: texture_2d<u32>;
// Facets of each ray that are yet to be collected.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// Index of each ray's first facet, followed by the total.
@group(0) @binding(3) var<storage, read> offsets: array<u32>;
// One more than the keys of the facets that rays hit, ascending within a ray.
@group(0) @binding(4) var<storage, read_write> facets: array<u32>;

@compute @workgroup_size(16, 16)
fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(tally);
    if any(id.xy >= size) {
        return;
    }
    counts[id.y * size.x + id.x] = u32(round(textureLoad(tally, id.xy, 0).x * 255.0));
}

@compute @workgroup_size(16, 16)
fn collect(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(layer);
    if any(id.xy >= size) {
        return;
    }
    let ray = id.y * size.x + id.x;
    let facet = textureLoad(layer, id.xy, 0).x;
    let left = counts[ray];
    if facet == 0u || left == 0u {
        return;
    }
    counts[ray] = left - 1u;
    facets[offsets[ray + 1u] - left] = facet;
}
