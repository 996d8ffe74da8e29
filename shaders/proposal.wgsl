// Pixels that a facet covers: the source that fill.wgsl and peel.wgsl begin with.
//
// The rasteriser only proposes pixels: every facet is drawn as one triangle slightly larger than itself,
// and integers decide whether the facet covers a pixel centre. The result does not depend on how an
// adapter rounds or clips, and equals that of src/ldi/cpu.rs hit for hit.

// The part of the grid that a pass draws. Twin of `Tile` in src/ldi/layout.rs.
struct Tile {
    // Top left corner of the tile relative to that of the grid, in lattice steps.
    origin: vec2<i32>,
    // Columns and rows.
    size: vec2<u32>,
}

// Lattice steps per pixel; twin of `STEPS` in src/ldi/projection.rs.
const STEPS: i32 = 256;
// Distance by which proposals extend beyond facets, in pixels. Adapters may snap vertices to 1/16 pixel.
const MARGIN: f32 = 0.25;

@group(0) @binding(0) var<uniform> tile: Tile;
// A corner is a needle if 1 + the cosine between the normals of its edges is below this.
const NEEDLE: f32 = 0.05;

// The vertices of a facet agree in all but their positions.
struct Candidate {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat, either) facet: u32,
    // The corners in lattice steps, ordered so that edge functions are positive inside.
    @location(1) @interpolate(flat, either) a: vec2<i32>,
    @location(2) @interpolate(flat, either) b: vec2<i32>,
    @location(3) @interpolate(flat, either) c: vec2<i32>,
}

// The sign of u.x · v.y - u.y · v.x for signed components of up to 24 bits. The products need 48 bits, so
// they are summed in 12-bit limbs.
fn cross_sign(u: vec2<i32>, v: vec2<i32>) -> i32 {
    let u_high = u >> vec2<u32>(12u);
    let v_high = v >> vec2<u32>(12u);
    let u_low = u & vec2<i32>(4095);
    let v_low = v & vec2<i32>(4095);
    let low = u_low.x * v_low.y - u_low.y * v_low.x;
    let middle = u_high.x * v_low.y + u_low.x * v_high.y - u_high.y * v_low.x - u_low.y * v_high.x
        + (low >> 12u);
    let high = u_high.x * v_high.y - u_high.y * v_high.x + (middle >> 12u);
    // The remainder of the lower limbs is not negative, and less than one unit of the highest.
    if high != 0 {
        return sign(high);
    }
    return select(0, 1, ((middle | low) & 4095) != 0);
}

// The unit normal of an edge, pointing away from the facet.
fn outward(start: vec2<f32>, end: vec2<f32>) -> vec2<f32> {
    let edge = end - start;
    return normalize(vec2<f32>(edge.y, -edge.x));
}

// The corner of a triangle whose edges lie MARGIN outside those of the facet.
fn mitre(corner: vec2<f32>, n: vec2<f32>, m: vec2<f32>) -> vec2<f32> {
    return corner + (n + m) * (MARGIN / (1.0 + dot(n, m)));
}

// A corner of a right triangle that encloses the facet's bounding rectangle along its longest edge, from
// `start` to `end`: for needles, whose mitres would reach too far.
fn enclose(start: vec2<f32>, end: vec2<f32>, other: vec2<f32>, corner: u32) -> vec2<f32> {
    let along = normalize(end - start);
    let across = vec2<f32>(-along.y, along.x);
    let sideways = dot(other - start, across);
    let low = vec2<f32>(0.0, min(sideways, 0.0)) - MARGIN;
    let high = vec2<f32>(dot(end - start, along), max(sideways, 0.0)) + MARGIN;
    let reach = low + 2.0 * (high - low) * vec2<f32>(vec2<bool>(corner == 1u, corner == 2u));
    return start + along * reach.x + across * reach.y;
}

// One of the three vertices that propose the pixels of a facet with these corners.
fn proposal(a: vec2<i32>, second: vec2<i32>, third: vec2<i32>, facet: u32, corner: u32) -> Candidate {
    var b = second;
    var c = third;
    let area = cross_sign(b - a, c - a);
    if area == 0 {
        // Edge-on to the rays: three coincident vertices outside the view cover nothing.
        return Candidate(vec4<f32>(2.0, 2.0, 0.0, 1.0), facet, a, b, c);
    }
    if area < 0 {
        let swapped = b;
        b = c;
        c = swapped;
    }
    // Pixels relative to the tile's corner; exact.
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

// Returns true if a pixel centre is on the inner side of an edge, by the top-left rule.
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
