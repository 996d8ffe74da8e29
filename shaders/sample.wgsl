// Which facets every ray meets, in two passes over the mesh whatever the depth: `count` adds up the
// hits of each ray, a prefix sum (scan.wgsl) turns the counts into offsets, and `fill` writes the facets
// to their places.
//
// The rasteriser only proposes pixels: every facet is drawn as one triangle somewhat larger than itself,
// and integers decide whether it covers a pixel's centre. The result does not depend on how an
// adapter rounds or clips, and equals that of src/ldi/cpu.rs hit for hit.

// The part of the grid that a pass draws. Twin of `Tile` in src/ldi/layout.rs.
struct Tile {
    // Top left corner of the tile, in lattice steps from that of the grid.
    origin: vec2<i32>,
    // Columns and rows.
    size: vec2<u32>,
}

// Lattice steps a pixel; twin of `STEPS` in src/ldi/projection.rs.
const STEPS: i32 = 256;
// By how much proposals are larger than facets, in pixels. Adapters may snap vertices to 1/16 pixel.
const MARGIN: f32 = 0.25;

@group(0) @binding(0) var<uniform> tile: Tile;
// Positions of vertices, columns to the right and rows downward, in lattice steps.
@group(0) @binding(1) var<storage, read> positions: array<vec2<i32>>;
// Three vertices a facet.
@group(0) @binding(2) var<storage, read> corners: array<u32>;
// Hits of each ray of the tile; `fill` counts them down again.
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
// Where the hits of each ray begin.
@group(0) @binding(4) var<storage, read> offsets: array<u32>;
// The facets that rays meet, in no particular order within a ray.
@group(0) @binding(5) var<storage, read_write> facets: array<u32>;

// Below this, 1 + the cosine between the normals of two edges, a corner is a needle.
const NEEDLE: f32 = 0.05;

struct Candidate {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) facet: u32,
    // The corners, so that the inside is where edge functions are positive, in lattice steps.
    @location(1) @interpolate(flat) a: vec2<i32>,
    @location(2) @interpolate(flat) b: vec2<i32>,
    @location(3) @interpolate(flat) c: vec2<i32>,
}

// The sign of u.x · v.y - u.y · v.x for components of up to 24 bits with sign. The products need
// 48 bits: they are summed in limbs of 12.
fn cross_sign(u: vec2<i32>, v: vec2<i32>) -> i32 {
    let u_high = u >> vec2<u32>(12u);
    let v_high = v >> vec2<u32>(12u);
    let u_low = u & vec2<i32>(4095);
    let v_low = v & vec2<i32>(4095);
    let low = u_low.x * v_low.y - u_low.y * v_low.x;
    let middle = u_high.x * v_low.y + u_low.x * v_high.y - u_high.y * v_low.x - u_low.y * v_high.x
        + (low >> 12u);
    let high = u_high.x * v_high.y - u_high.y * v_high.x + (middle >> 12u);
    // What is left of the lower limbs is not negative and less than one of the highest.
    if high != 0 {
        return sign(high);
    }
    return select(0, 1, ((middle | low) & 4095) != 0);
}

// The unit normal of an edge, away from the facet.
fn outward(start: vec2<f32>, end: vec2<f32>) -> vec2<f32> {
    let edge = end - start;
    return normalize(vec2<f32>(edge.y, -edge.x));
}

// The corner of a triangle whose edges lie MARGIN outside those of the facet.
fn mitre(corner: vec2<f32>, n: vec2<f32>, m: vec2<f32>) -> vec2<f32> {
    return corner + (n + m) * (MARGIN / (1.0 + dot(n, m)));
}

// A corner of a right triangle around the facet's bounding rectangle from `start` to `end`, its longest
// edge: for needles, whose mitres would reach too far.
fn enclose(start: vec2<f32>, end: vec2<f32>, other: vec2<f32>, corner: u32) -> vec2<f32> {
    let along = normalize(end - start);
    let across = vec2<f32>(-along.y, along.x);
    let sideways = dot(other - start, across);
    let low = vec2<f32>(0.0, min(sideways, 0.0)) - MARGIN;
    let high = vec2<f32>(dot(end - start, along), max(sideways, 0.0)) + MARGIN;
    let reach = low + 2.0 * (high - low) * vec2<f32>(vec2<bool>(corner == 1u, corner == 2u));
    return start + along * reach.x + across * reach.y;
}

// Three vertices a facet.
@vertex
fn propose(@builtin(vertex_index) index: u32) -> Candidate {
    let facet = index / 3u;
    let corner = index % 3u;
    let a = positions[corners[facet * 3u]];
    var b = positions[corners[facet * 3u + 1u]];
    var c = positions[corners[facet * 3u + 2u]];
    let area = cross_sign(b - a, c - a);
    if area == 0 {
        // Edge-on to the rays: three vertices in one place outside cover nothing.
        return Candidate(vec4<f32>(2.0, 2.0, 0.0, 1.0), facet, a, b, c);
    }
    if area < 0 {
        let swapped = b;
        b = c;
        c = swapped;
    }
    // In pixels from the corner of the tile; exact.
    let p = vec2<f32>(a - tile.origin) / f32(STEPS);
    let q = vec2<f32>(b - tile.origin) / f32(STEPS);
    let r = vec2<f32>(c - tile.origin) / f32(STEPS);
    let n_pq = outward(p, q);
    let n_qr = outward(q, r);
    let n_rp = outward(r, p);
    let sharpest = 1.0 + min(dot(n_pq, n_qr), min(dot(n_qr, n_rp), dot(n_rp, n_pq)));
    var pixel: vec2<f32>;
    if sharpest > NEEDLE {
        if corner == 0u {
            pixel = mitre(p, n_rp, n_pq);
        } else if corner == 1u {
            pixel = mitre(q, n_pq, n_qr);
        } else {
            pixel = mitre(r, n_qr, n_rp);
        }
    } else {
        let lengths = vec3<f32>(distance(p, q), distance(q, r), distance(r, p));
        if lengths.x >= lengths.y && lengths.x >= lengths.z {
            pixel = enclose(p, q, r, corner);
        } else if lengths.y >= lengths.z {
            pixel = enclose(q, r, p, corner);
        } else {
            pixel = enclose(r, p, q, corner);
        }
    }
    let size = vec2<f32>(tile.size);
    let x = pixel.x * 2.0 / size.x - 1.0;
    let y = 1.0 - pixel.y * 2.0 / size.y;
    return Candidate(vec4<f32>(x, y, 0.0, 1.0), facet, a, b, c);
}

// Whether a pixel centre is on the facet's side of an edge, by the top-left rule.
fn is_inside(start: vec2<i32>, end: vec2<i32>, centre: vec2<i32>) -> bool {
    let edge = end - start;
    let side = cross_sign(edge, centre - start);
    let is_top_left = edge.y < 0 || (edge.y == 0 && edge.x > 0);
    return side > 0 || (side == 0 && is_top_left);
}

fn covers(candidate: Candidate) -> bool {
    let pixel = vec2<i32>(candidate.position.xy);
    let centre = tile.origin + pixel * STEPS + STEPS / 2;
    return is_inside(candidate.a, candidate.b, centre)
        && is_inside(candidate.b, candidate.c, centre)
        && is_inside(candidate.c, candidate.a, centre);
}

fn ray_of(candidate: Candidate) -> u32 {
    let pixel = vec2<u32>(candidate.position.xy);
    return pixel.y * tile.size.x + pixel.x;
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
