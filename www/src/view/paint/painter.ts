/** Paints the weights of a model's facets, stroke by stroke. */
import { falloff, meanBeside, targetOf, type Brush } from "./brush.js";
import type { Triple } from "../scene/pose.js";
import { brushRegion, smoothRegion, type Surface, type Touched } from "./region.js";
import { strokeOf, Strokes } from "./strokes.js";

/** Contact of a brush with a model, in the file's pose. */
export interface Dab {
  readonly facet: number;
  readonly point: Triple;
  /** Previous point of the same stroke, unless the brush has left the model since. */
  readonly from: Triple | null;
}

/** Maximum distance between points of a path, as a fraction of the radius. */
const SPACING = 0.5;

/** A jump of more radii than this makes no path, since anything may lie in between. */
const JUMP = 8;

/** The mirror image of a point in a plane of constant x, mm. */
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
  /** Weight of each facet, 0 to 1. Modified in place. */
  readonly weights: Float32Array;
  readonly strokes = new Strokes();
  readonly #surface: Surface;
  /** Weights before the current stroke, and the stroke's coverage of each facet. */
  #before = new Map<number, number>();
  #cover = new Map<number, number>();

  /** @param weights are copied; null: every facet has weight `base` */
  constructor(surface: Surface, weights: Float32Array | null, base: number) {
    this.#surface = surface;
    this.weights = weights?.slice() ?? new Float32Array(surface.positions.length / 9).fill(base);
  }

  /** Facets that the brush would paint. `scale` is the factor applied to the file's lengths. */
  touched(dab: Dab, { fills, crease_deg, size_mm }: Brush, scale: number): Touched {
    const radius_mm = size_mm / 2 / scale;
    if (!fills) return brushRegion(this.#surface, dab.facet, pathOf(dab, radius_mm), radius_mm);
    const facets = smoothRegion(this.#surface, dab.facet, crease_deg);
    return { facets, distances_mm: facets.map(() => 0) };
  }

  /**
   * Continues or begins a stroke; returns the facets whose weight changed. A stroke paints a facet once, with the strength of its nearest
   * pass, however often it passes over; only softening accumulates.
   */
  dab(dab: Dab, brush: Brush, scale: number): number[] {
    // A fill covers the same region from anywhere within it.
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

  /** Ends the stroke; returns true if it changed any weight. */
  end(): boolean {
    const before = this.#before;
    const stroke = strokeOf(before.keys(), (facet) => before.get(facet) ?? 0, this.weights);
    this.#before = new Map();
    this.#cover = new Map();
    if (stroke !== null) this.strokes.note(stroke);
    return stroke !== null;
  }

  /** Replaces the weights as one undo step; returns true if any changed. */
  replace(weights: Float32Array): boolean {
    const before = this.weights.slice();
    this.weights.set(weights);
    const stroke = strokeOf(before.keys(), (facet) => before[facet] ?? 0, this.weights);
    if (stroke !== null) this.strokes.note(stroke);
    return stroke !== null;
  }
}
