/** Models of known volume. Lengths in mm. */
import { strToU8, zipSync } from "fflate";
import { binaryStl } from "../src/page/example.js";

export interface Solid {
  bytes: Uint8Array;
  /** Volume of the mesh itself, not of the surface that it approximates. */
  volume_mm3: number;
}

/** A sphere of triangles, divided into `around` sectors of longitude and half as many bands of latitude. */
export function sphere(radius: number, around: number): Solid {
  const circles = around / 2;
  const at = (circle: number, turn: number): [number, number, number] => {
    const polar = (Math.PI * circle) / circles;
    // At a pole, every point of the circle is the same, down to the last bit.
    const out = circle === 0 || circle === circles ? 0 : radius * Math.sin(polar);
    const angle = (2 * Math.PI * (turn % around)) / around;
    return [out * Math.cos(angle) + 0, out * Math.sin(angle) + 0, radius - radius * Math.cos(polar)];
  };
  const triangles: number[] = [];
  for (let circle = 0; circle < circles; circle++) {
    for (let turn = 0; turn < around; turn++) {
      const [a, b] = [at(circle, turn), at(circle, turn + 1)];
      const [c, d] = [at(circle + 1, turn), at(circle + 1, turn + 1)];
      if (circle > 0) triangles.push(...a, ...b, ...c);
      if (circle < circles - 1) triangles.push(...b, ...d, ...c);
    }
  }
  const packed = Float32Array.from(triangles);
  return { bytes: binaryStl(packed), volume_mm3: volume(packed) };
}

/** Two cubes, one above the other, with a gap between them. */
export function floating(side: number, gap: number): Uint8Array {
  const below = facetsOf(side, side);
  const above = below.map((part, i) => (i % 3 === 2 ? part + side + gap : part));
  return binaryStl(Float32Array.from([...below, ...above]));
}

/** A square cup that stands on its floor; walls and floor have the same thickness. */
export function cup(side: number, height: number, wall: number): Uint8Array {
  const outside = facetsOf(side, height);
  const inner = side - 2 * wall;
  // The hollow faces inwards, from the floor up to the rim.
  const hollow = facetsOf(inner, height - wall).map((part) => part + wall);
  const flipped: number[] = [];
  const isLevel = (facets: readonly number[], at: number, z: number): boolean => [2, 5, 8].every((k) => Math.abs((facets[at + k] ?? 0) - z) < 1e-9);
  for (let at = 0; at < hollow.length; at += 9) {
    if (isLevel(hollow, at, height)) continue;
    for (const k of [0, 6, 3]) flipped.push(...hollow.slice(at + k, at + k + 3));
  }
  const kept: number[] = [];
  for (let at = 0; at < outside.length; at += 9) if (!isLevel(outside, at, height)) kept.push(...outside.slice(at, at + 9));
  // The rim, between the outer and the inner square.
  const square = (from: number, to: number): [number, number][] => [[from, from], [to, from], [to, to], [from, to]];
  const [outer, inside] = [square(0, side), square(wall, side - wall)];
  for (let k = 0; k < 4; k++) {
    const [a, b, c, d] = [outer[k], outer[(k + 1) % 4], inside[(k + 1) % 4], inside[k]] as [[number, number], [number, number], [number, number], [number, number]];
    kept.push(...a, height, ...b, height, ...c, height, ...a, height, ...c, height, ...d, height);
  }
  return binaryStl(Float32Array.from([...kept, ...flipped]));
}

/** A prism that stands upright on a square. */
export function prism(side: number, height: number): Solid {
  const packed = Float32Array.from(facetsOf(side, height));
  return { bytes: binaryStl(packed), volume_mm3: volume(packed) };
}

/** A cube with a closed cubic hollow in its middle. */
export function sealed(side: number, wall: number): Uint8Array {
  const inner = facetsOf(side - 2 * wall, side - 2 * wall).map((part) => part + wall);
  // Inverted by swapping each facet's last two corners.
  const inward = inner.map((_, i) => inner[i - (i % 9) + ((9 - (i % 9 - (i % 3))) % 9) + (i % 3)] ?? 0);
  return binaryStl(Float32Array.from([...facetsOf(side, side), ...inward]));
}

function facetsOf(side: number, height: number): number[] {
  const corners = [[0, 0], [side, 0], [side, side], [0, side]] as const;
  const triangles: number[] = [];
  for (const [index, [x, y]] of corners.entries()) {
    const [u, v] = corners[(index + 1) % corners.length] ?? [0, 0];
    triangles.push(...[x, y, 0, u, v, 0, u, v, height], ...[x, y, 0, u, v, height, x, y, height]);
  }
  for (const [a, b] of [[1, 2], [2, 3]] as const) {
    const [p, q, r] = [corners[0], corners[a], corners[b]];
    triangles.push(...[...p, height, ...q, height, ...r, height], ...[...p, 0, ...r, 0, ...q, 0]);
  }
  return triangles;
}

/** The same surface, each triangle cut into four at the middles of its sides. */
export function finer(triangles: Float32Array): Float32Array {
  const out = new Float32Array(4 * triangles.length);
  for (let at = 0; at < triangles.length; at += 9) {
    const corner = (k: number): number[] => [...triangles.subarray(at + 3 * (k % 3), at + 3 * (k % 3) + 3)];
    const middle = (k: number): number[] => corner(k).map((part, axis) => (part + (corner(k + 1)[axis] ?? 0)) / 2);
    const [a, b, c] = [corner(0), corner(1), corner(2)];
    const [ab, bc, ca] = [middle(0), middle(1), middle(2)];
    out.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca].flat(), 4 * at);
  }
  return out;
}

/** Signed volume of triangles given as nine coordinates each. */
export function volume(triangles: Float32Array): number {
  let six = 0;
  for (let i = 0; i < triangles.length; i += 9) {
    const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0, cx = 0, cy = 0, cz = 0] = triangles.subarray(i, i + 9);
    six += ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx);
  }
  return six / 6;
}

/** The distinct corners of a binary STL, one line each, and its triangles as indices into that list. */
function indexed(stl: Uint8Array): { corners: readonly string[]; triangles: readonly (readonly number[])[] } {
  const view = new DataView(stl.buffer, stl.byteOffset);
  const places = new Map<string, number>();
  const place = (at: number): number => {
    const corner = [0, 4, 8].map((axis) => view.getFloat32(at + axis, true)).join(" ");
    const known = places.get(corner) ?? places.size;
    places.set(corner, known);
    return known;
  };
  const triangles = Array.from({ length: view.getUint32(80, true) }, (_, facet) => [12, 24, 36].map((corner) => place(84 + 50 * facet + corner)));
  return { corners: [...places.keys()], triangles };
}

/** The model of an STL as an OBJ. */
export function objOf(stl: Uint8Array): Uint8Array {
  const { corners, triangles } = indexed(stl);
  const lines = [...corners.map((corner) => `v ${corner}`), ...triangles.map((places) => `f ${places.map((place) => place + 1).join(" ")}`)];
  return new TextEncoder().encode(`${lines.join("\n")}\n`);
}

/** The model of an STL as a 3MF project: once on the first of two plates, twice on the second. */
export function projectOf(stl: Uint8Array): Uint8Array {
  const instance = (id: number): string => `<model_instance><metadata key="object_id" value="1"/><metadata key="instance_id" value="${id}"/></model_instance>`;
  const settings = `<config><plate>${instance(0)}</plate><plate>${instance(1)}${instance(2)}</plate></config>`;
  const places = [0, 100, 150].map((x) => `<item objectid="1" transform="1 0 0 0 1 0 0 0 1 ${x} 0 0"/>`);
  return threeMfOf(stl, places.join(""), { "Metadata/model_settings.config": strToU8(settings) });
}

/** The model of an STL as a 3MF. */
export function threeMfOf(stl: Uint8Array, items = '<item objectid="1"/>', others: Record<string, Uint8Array> = {}): Uint8Array {
  const { corners, triangles } = indexed(stl);
  const tag = (name: string, keys: readonly string[], values: readonly (string | number)[]): string =>
    `<${name} ${keys.map((key, i) => `${key}="${values[i]}"`).join(" ")}/>`;
  const vertices = corners.map((corner) => tag("vertex", ["x", "y", "z"], corner.split(" ")));
  const facets = triangles.map((places) => tag("triangle", ["v1", "v2", "v3"], places));
  const mesh = `<mesh><vertices>${vertices.join("")}</vertices><triangles>${facets.join("")}</triangles></mesh>`;
  const model = `<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1">${mesh}</object></resources><build>${items}</build></model>`;
  const types = `<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>`;
  const start = `<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" Target="/3D/model.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>`;
  return zipSync({ "[Content_Types].xml": strToU8(types), "_rels/.rels": strToU8(start), "3D/model.model": strToU8(model), ...others });
}
