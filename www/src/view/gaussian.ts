/**
 * The Gaussian sphere: each point is a direction, with the colour of the nearest sample. Drawn as two discs, from the front and from
 * behind.
 */
import type { Rgb } from "./legend/palette.js";
import type { Rotation, Triple } from "./scene/pose.js";
import { back, turn } from "./scene/turn.js";

/** Cells per side of the map of nearest directions, an octahedron unfolded into a square. */
const MAP_SIDE = 64;
/** Neighbours stored per direction; near the border of a map cell, one of them may be nearer. */
const NEIGHBOURS = 8;

/** Side from which the sphere is seen. */
export type Side = "front" | "back";

/** Position on a picture: offset from its centre, in radii. */
export type Place = readonly [right: number, up: number];

/** Direction seen at a position of a picture, in the viewer's frame: right, up, towards the viewer; null outside the disc. */
export function seenAt([right, up]: Place, side: Side): Triple | null {
  const deep = 1 - right * right - up * up;
  if (deep < 0) return null;
  // From behind, left and right are swapped.
  return side === "front" ? [right, up, Math.sqrt(deep)] : [-right, up, -Math.sqrt(deep)];
}

/** Side and position at which a direction of the viewer's frame is seen. */
export function placeOf([x, y, z]: Triple): { side: Side; place: Place } {
  return z >= 0 ? { side: "front", place: [x, y] } : { side: "back", place: [-x, y] };
}

/** Finds the nearest of a set of directions, by a map and a climb between neighbours. */
export class Nearest {
  readonly #directions: Float64Array;
  readonly #map = new Uint16Array(MAP_SIDE * MAP_SIDE);
  readonly #neighbours: Uint16Array;

  /** @param directions unit vectors, three numbers each; at least one, and no more than 65,536 */
  constructor(directions: Float64Array) {
    this.#directions = directions;
    const count = directions.length / 3;
    this.#neighbours = new Uint16Array(count * NEIGHBOURS);
    for (let index = 0; index < count; index++) this.#introduce(index, count);
    for (let row = 0; row < MAP_SIDE; row++) {
      for (let column = 0; column < MAP_SIDE; column++) {
        const [x, y, z] = unfolded((2 * column + 1) / MAP_SIDE - 1, (2 * row + 1) / MAP_SIDE - 1);
        this.#map[row * MAP_SIDE + column] = this.#search(x, y, z);
      }
    }
  }

  /** Index of the direction nearest to a unit vector. */
  at(x: number, y: number, z: number): number {
    const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
    let u = x / sum;
    let v = y / sum;
    if (z < 0) {
      const folded = (1 - Math.abs(v)) * (u < 0 ? -1 : 1);
      v = (1 - Math.abs(u)) * (v < 0 ? -1 : 1);
      u = folded;
    }
    const column = Math.min(MAP_SIDE - 1, Math.floor(((u + 1) / 2) * MAP_SIDE));
    const row = Math.min(MAP_SIDE - 1, Math.floor(((v + 1) / 2) * MAP_SIDE));
    return this.#climb(this.#map[row * MAP_SIDE + column] ?? 0, x, y, z);
  }

  #dot(index: number, x: number, y: number, z: number): number {
    const at = 3 * index;
    const directions = this.#directions;
    return (directions[at] ?? 0) * x + (directions[at + 1] ?? 0) * y + (directions[at + 2] ?? 0) * z;
  }

  #search(x: number, y: number, z: number): number {
    let best = 0;
    let most = -2;
    for (let index = 0; 3 * index < this.#directions.length; index++) {
      const dot = this.#dot(index, x, y, z);
      if (dot > most) [best, most] = [index, dot];
    }
    return best;
  }

  /** Moves from neighbour to neighbour until none is nearer. */
  #climb(from: number, x: number, y: number, z: number): number {
    let best = from;
    let most = this.#dot(from, x, y, z);
    for (let at = -1; at !== best; ) {
      at = best;
      for (let i = at * NEIGHBOURS; i < (at + 1) * NEIGHBOURS; i++) {
        const index = this.#neighbours[i] ?? 0;
        const dot = this.#dot(index, x, y, z);
        if (dot > most) {
          best = index;
          most = dot;
        }
      }
    }
    return best;
  }

  #introduce(index: number, count: number): void {
    const [x = 0, y = 0, z = 0] = this.#directions.subarray(3 * index, 3 * index + 3);
    const nearest: { other: number; dot: number }[] = [];
    for (let other = 0; other < count; other++) {
      if (other === index) continue;
      const dot = this.#dot(other, x, y, z);
      if (nearest.length === NEIGHBOURS && dot <= (nearest.at(-1)?.dot ?? 0)) continue;
      nearest.push({ other, dot });
      nearest.sort((a, b) => b.dot - a.dot);
      nearest.length = Math.min(nearest.length, NEIGHBOURS);
    }
    for (let i = 0; i < NEIGHBOURS; i++) this.#neighbours[index * NEIGHBOURS + i] = nearest[i]?.other ?? index;
  }
}

/** Direction at a position of the unfolded octahedron, both coordinates from -1 to 1. */
function unfolded(u: number, v: number): Triple {
  const z = 1 - Math.abs(u) - Math.abs(v);
  const [x, y] = z >= 0 ? [u, v] : [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

/** Darkening of the rim: enough for a disc to look like a ball, yet its colours still match their scale. */
const RIM = 0.16;

/**
 * Draws one picture as RGBA of `side_px` × `side_px` pixels.
 *
 * @param facing turns directions into the viewer's frame
 * @param colours colour of each direction; null: transparent
 */
export function drawSphere(
  pixels: Uint8ClampedArray,
  side_px: number,
  side: Side,
  facing: Rotation,
  nearest: Nearest,
  colours: readonly (Rgb | null)[],
): void {
  const inverse = back(facing);
  const [ax, ay, az] = turn(inverse, [1, 0, 0]);
  const [bx, by, bz] = turn(inverse, [0, 1, 0]);
  const [cx, cy, cz] = turn(inverse, [0, 0, 1]);
  const radius = side_px / 2;
  const sign = side === "front" ? 1 : -1;
  for (let row = 0; row < side_px; row++) {
    const up = (radius - row - 0.5) / radius;
    for (let column = 0; column < side_px; column++) {
      const at = 4 * (row * side_px + column);
      const across = (column + 0.5 - radius) / radius;
      const out = across * across + up * up;
      // Antialiases the rim over one pixel.
      const inside = (1 - Math.sqrt(out)) * radius + 0.5;
      if (inside <= 0) {
        pixels[at + 3] = 0;
        continue;
      }
      const depth = Math.sqrt(Math.max(0, 1 - out));
      const right = sign * across;
      const towards = sign * depth;
      const x = ax * right + bx * up + cx * towards;
      const y = ay * right + by * up + cy * towards;
      const z = az * right + bz * up + cz * towards;
      const colour = colours[nearest.at(x, y, z)] ?? null;
      if (colour === null) {
        pixels[at + 3] = 0;
        continue;
      }
      const light = 1 - RIM * (1 - depth) * (1 - depth);
      pixels[at] = colour[0] * light;
      pixels[at + 1] = colour[1] * light;
      pixels[at + 2] = colour[2] * light;
      pixels[at + 3] = 255 * Math.min(1, inside);
    }
  }
}
