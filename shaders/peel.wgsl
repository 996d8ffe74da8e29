// Depth peeling: each pass draws the whole mesh and keeps, for each ray, the first facet behind the one that
// the pass before kept. Follows proposal.wgsl.
//
// Facets are drawn in the order of their keys, from the plate upward, three vertices each. Keys are unique:
// every pass sees the same strict order, and the depth test decides no tie. No stage before the compute passes
// (collect.wgsl) needs a storage buffer.

// Depths are multiples of 1 / KEYS, which single precision holds exactly. Twin of `KEYS` in src/ldi/layout.rs.
const KEYS: f32 = 16777216.0;
// What one facet adds to the tally, whose format has 8 bits.
const ONE: f32 = 1.0 / 255.0;

// One more than the key of the facet that the pass before kept; 0 if it kept none.
@group(0) @binding(1) var previous: texture_2d<u32>;

struct Corners {
    @location(0) a: vec2<i32>,
    @location(1) b: vec2<i32>,
    @location(2) c: vec2<i32>,
}

@vertex
fn propose(@builtin(vertex_index) index: u32, corners: Corners) -> Candidate {
    return proposal(corners.a, corners.b, corners.c, index / 3u, index % 3u);
}

// Counts the facets of each ray by blending.
@fragment
fn tally(candidate: Candidate) -> @location(0) vec4<f32> {
    if !covers(candidate) {
        discard;
    }
    return vec4<f32>(ONE, 0.0, 0.0, 0.0);
}

struct Peeled {
    @builtin(frag_depth) depth: f32,
    @location(0) layer: u32,
}

@fragment
fn peel(candidate: Candidate) -> Peeled {
    let layer = candidate.facet + 1u;
    let pixel = vec2<i32>(candidate.position.xy);
    if !covers(candidate) || layer <= textureLoad(previous, pixel, 0).x {
        discard;
    }
    return Peeled(f32(layer) / KEYS, layer);
}
