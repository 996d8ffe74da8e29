/** Solids for tests, with cross-sections known in closed form. Nine numbers per facet, mm, counter-clockwise from outside. */

type Point = readonly [number, number, number];

const facets = (triangles: readonly (readonly [Point, Point, Point])[]): Float32Array =>
  Float32Array.from(triangles.flat(2));

/** A box from `from` to `to`. */
export function box([x0, y0, z0]: Point, [x1, y1, z1]: Point): Float32Array {
  const corner = (i: number): Point => [i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0];
  const quads = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  return facets(
    quads.flatMap((quad) => {
      const [a, b, c, d] = quad.map(corner) as [Point, Point, Point, Point];
      return [
        [a, b, c],
        [a, c, d],
      ] as [Point, Point, Point][];
    }),
  );
}

/** A cone on z = 0: an `around`-sided pyramid whose corners are `radius` from the axis. */
export function cone(radius: number, height: number, around: number): Float32Array {
  const rim = (i: number): Point => {
    const angle = (2 * Math.PI * (i % around)) / around;
    return [radius * Math.cos(angle), radius * Math.sin(angle), 0];
  };
  const out: [Point, Point, Point][] = [];
  for (let i = 0; i < around; i++) out.push([rim(i), rim(i + 1), [0, 0, height]], [rim(i + 1), rim(i), [0, 0, 0]]);
  return facets(out);
}

/** A ball about the origin, divided into `around` sectors of longitude and half as many bands of latitude. */
export function ball(radius: number, around: number): Float32Array {
  const circles = around / 2;
  const at = (circle: number, turn: number): Point => {
    const polar = (Math.PI * circle) / circles;
    const out = circle === 0 || circle === circles ? 0 : radius * Math.sin(polar);
    const angle = (2 * Math.PI * (turn % around)) / around;
    return [out * Math.cos(angle), out * Math.sin(angle), -radius * Math.cos(polar)];
  };
  const out: [Point, Point, Point][] = [];
  for (let circle = 0; circle < circles; circle++) {
    for (let turn = 0; turn < around; turn++) {
      const [a, b] = [at(circle, turn), at(circle, turn + 1)];
      const [c, d] = [at(circle + 1, turn), at(circle + 1, turn + 1)];
      if (circle > 0) out.push([a, b, c]);
      if (circle < circles - 1) out.push([b, d, c]);
    }
  }
  return facets(out);
}

/** Facets of several solids. */
export function together(...solids: readonly Float32Array[]): Float32Array {
  return Float32Array.from(solids.flatMap((solid) => [...solid]));
}

/** The same facets with reversed orientation. */
export function insideOut(positions: Float32Array): Float32Array {
  const out = positions.slice();
  for (let at = 0; at < out.length; at += 9) {
    out.set(positions.subarray(at + 3, at + 6), at + 6);
    out.set(positions.subarray(at + 6, at + 9), at + 3);
  }
  return out;
}
