/** Weights of a model's facets under a brush, stroke by stroke. */
import { falloff, meanBeside, targetOf, type Brush } from "./brush.js";
import type { Triple } from "../scene/pose.js";
import { brushRegion, smoothRegion, type Surface, type Touched } from "./region.js";
import { strokeOf, Strokes } from "./strokes.js";

/** Where a brush is on a model in the file's pose. */
export interface Dab {
  readonly facet: number;
  readonly point: Triple;
  /** Where it was before in the same stroke, if it has come from there without a break. */
  readonly from: Triple | null;
}

/** Points of a path are no farther apart than this part of the radius. */
const SPACING = 0.5;

/** A pointer that has jumped this many radii has come from elsewhere: between may lie anything. */
const JUMP = 8;

/** The mirror image of a point at a plane of constant x, mm. */
export const mirrored = ([x, y, z]: Triple, middle_x: number): Triple => [2 * middle_x - x, y, z];

function pathOf({ from, point }: Dab, radius_mm: number): Triple[] {
  const [x, y, z] = point;
  if (from === null) return [point];
  const [dx, dy, dz] = [from[0] - x, from[1] - y, from[2] - z];
  const length = Math.hypot(dx, dy, dz);
  if (length > JUMP * radius_mm) return [point];
  const steps = Math.ceil(length / (SPACING * radius_mm));
  const at = (i: number): Triple => [x + (dx * i) / steps, y + (dy * i) / steps, z + (dz * i) / steps];
  return [point, ...Array.from({ length: steps }, (_, i) => at(i + 1))];
}

export class Painter {
  /** 0 to 1 a facet. Written to in place. */
  readonly weights: Float32Array;
  readonly strokes = new Strokes();
  readonly #surface: Surface;
  /** What the stroke under way has come upon, and how strongly it covers that. */
  #before = new Map<number, number>();
  #cover = new Map<number, number>();

  /** @param weights a copy is made; null: everything has weight `base` */
  constructor(surface: Surface, weights: Float32Array | null, base: number) {
    this.#surface = surface;
    this.weights = weights?.slice() ?? new Float32Array(surface.positions.length / 9).fill(base);
  }

  /** What the brush would touch there. `scale`: mm of the model as it stands for one of its file. */
  touched(dab: Dab, { fills, crease_deg, size_mm }: Brush, scale: number): Touched {
    const radius_mm = size_mm / 2 / scale;
    if (!fills) return brushRegion(this.#surface, dab.facet, pathOf(dab, radius_mm), radius_mm);
    const facets = smoothRegion(this.#surface, dab.facet, crease_deg);
    return { facets, distances_mm: facets.map(() => 0) };
  }

  /**
   * Goes on with a stroke, or begins one; gives the facets whose weight changed. However often a stroke passes over a
   * facet, it paints that once, as strongly as it came nearest; only softening goes on and on.
   */
  dab(dab: Dab, brush: Brush, scale: number): number[] {
    // The region of a fill is the same from anywhere within it.
    if (brush.fills && brush.mode !== "soften" && this.#cover.has(dab.facet)) return [];
    const { facets, distances_mm } = this.touched(dab, brush, scale);
    const radius_mm = brush.size_mm / 2 / scale;
    const target = targetOf(brush);
    const { weights } = this;
    const to = facets.map((facet, i) => {
      const now = weights[facet] ?? 0;
      const cover = brush.strength * falloff(distances_mm[i] ?? 0, radius_mm);
      const before = this.#before.get(facet) ?? now;
      this.#before.set(facet, before);
      if (target === null) return now + (meanBeside(weights, this.#surface.topology, facet) - now) * cover;
      const most = Math.max(cover, this.#cover.get(facet) ?? 0);
      this.#cover.set(facet, most);
      return before + (target - before) * most;
    });
    return facets.filter((facet, i) => {
      const [now, next] = [weights[facet], Math.fround(Math.min(1, Math.max(0, to[i] ?? 0)))];
      weights[facet] = next;
      return now !== next;
    });
  }

  /** Ends the stroke; whether it changed anything. */
  end(): boolean {
    const before = this.#before;
    const stroke = strokeOf(before.keys(), (facet) => before.get(facet) ?? 0, this.weights);
    this.#before = new Map();
    this.#cover = new Map();
    if (stroke !== null) this.strokes.note(stroke);
    return stroke !== null;
  }

  /** Takes other weights in one step that can be taken back; whether they are other ones. */
  replace(weights: Float32Array): boolean {
    const before = this.weights.slice();
    this.weights.set(weights);
    const stroke = strokeOf(before.keys(), (facet) => before[facet] ?? 0, this.weights);
    if (stroke !== null) this.strokes.note(stroke);
    return stroke !== null;
  }
}
