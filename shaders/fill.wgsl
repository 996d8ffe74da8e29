// Finds the facets that each ray hits, in two passes over the mesh whatever the depth: `count` counts the
// hits of each ray, a prefix sum (scan.wgsl) turns the counts into offsets, and `fill` writes the facets
// at their offsets. Follows proposal.wgsl.

// Vertex positions in lattice steps: x to the right, y downward.
@group(0) @binding(1) var<storage, read> positions: array<vec2<i32>>;
// Three vertex indices per facet.
@group(0) @binding(2) var<storage, read> corners: array<u32>;
// Hits of each ray of the tile; `fill` counts them back down.
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
// Index of each ray's first hit.
@group(0) @binding(4) var<storage, read> offsets: array<u32>;
// The facets that rays hit, unordered within a ray.
@group(0) @binding(5) var<storage, read_write> facets: array<u32>;

@vertex
fn propose(@builtin(vertex_index) index: u32) -> Candidate {
    let facet = index / 3u;
    let a = positions[corners[facet * 3u]];
    let b = positions[corners[facet * 3u + 1u]];
    let c = positions[corners[facet * 3u + 2u]];
    return proposal(a, b, c, facet, index % 3u);
}

@fragment
fn count(candidate: Candidate) {
    if covers(candidate) {
        atomicAdd(&counts[ray_of(candidate)], 1u);
    }
}

@fragment
fn fill(candidate: Candidate) {
    if covers(candidate) {
        let ray = ray_of(candidate);
        let slot = offsets[ray] + atomicSub(&counts[ray], 1u) - 1u;
        facets[slot] = candidate.facet;
    }
}
