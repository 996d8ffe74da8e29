// Dual depth peeling: each pass keeps, for each ray, the nearest and the farthest of the facets between the two
// that the pass before kept. Follows proposal.wgsl.
//
// Facets are drawn in cells of the tile, each with a list of its own, in which they ascend from the plate upward. The
// place in this list is peeled: every pass sees the same strict order. Both ends are found by blending, and
// the facets counted, so neither a depth buffer nor a storage buffer is needed before the compute passes
// (collect.wgsl).

// The targets have half precision, whose normal positive numbers ascend with their bits, one place after the other. These are
// the upper 19 bits of the least one in single precision; the lower 13 are zero.
const LEAST: u32 = 0x1c400u;

// Result of the pass before: the farthest, minus the nearest, unused, and the number of facets between.
@group(0) @binding(1) var previous: texture_2d<f32>;

struct Corners {
    @location(0) a: vec2<i32>,
    @location(1) b: vec2<i32>,
    @location(2) c: vec2<i32>,
}

@vertex
fn propose(@builtin(vertex_index) index: u32, corners: Corners) -> Candidate {
    return proposal(corners.a, corners.b, corners.c, index / 3u, index % 3u);
}

// Colours are blended by their maximum, alpha is summed.
@fragment
fn peel(candidate: Candidate) -> @location(0) vec4<f32> {
    let place = bitcast<f32>((LEAST + candidate.facet) << 13u);
    let kept = textureLoad(previous, vec2<i32>(candidate.position.xy), 0);
    if !covers(candidate) || place >= kept.x || -place >= kept.y {
        discard;
    }
    return vec4<f32>(place, -place, 0.0, 1.0);
}
