/**
 * The printed model: each layer is the cross-section at its middle, extruded from its bottom to its top. Walls and treads are exact; the
 * facets themselves are not drawn.
 */
import { Earcut } from "three/src/extras/Earcut.js";
import { cutsOf, signedArea, tracer, type Contour, type Solid } from "./contours.js";
import { Growing } from "./growing.js";

/** Several consecutive layers. */
export interface StepsPart {
  /** Corners, three numbers each, mm: for each contour point, one at the bottom of its layer and one at the top. */
  readonly positions: Float32Array;
  /** Triangles, counter-clockwise from outside. */
  readonly index: Uint32Array;
}

/** In parts, so that no buffer takes long to copy. */
export interface Steps {
  readonly parts: readonly StepsPart[];
  /** Largest distance of the contours from the cross-sections, mm. */
  readonly tolerance_mm: number;
}

/** Far finer than any printer's pixel: omitted details cannot be printed either. */
const TOLERANCE_MM = 0.001;

/** Beyond this number of contour points, the buffers (72 bytes per point) strain a phone's memory, so the tolerance becomes coarser. */
const POINTS_LIMIT = 3_000_000;

const COARSER = 4;

/** A part ends after the layer in which it reaches this number of contour points: a few megabytes. */
const PART_POINTS = 50_000;

/** An outline with area and the holes in it. */
interface Polygon {
  readonly outline: Contour;
  readonly holes: Contour[];
  readonly area: number;
}

/** Returns true if the point is inside the outline, by the parity of crossings. */
function isInside(outline: Contour, x: number, y: number): boolean {
  let inside = false;
  for (let i = 0, j = outline.length - 2; i < outline.length; j = i, i += 2) {
    const ax = outline[i] ?? 0;
    const ay = outline[i + 1] ?? 0;
    const bx = outline[j] ?? 0;
    const by = outline[j + 1] ?? 0;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

/** Assigns each hole to the smallest outline around it. A hole outside all outlines is dropped. */
export function polygons(contours: readonly Contour[]): Polygon[] {
  const out: Polygon[] = [];
  const holes: Contour[] = [];
  for (const contour of contours) {
    const area = signedArea(contour);
    if (area > 0) out.push({ outline: contour, holes: [], area });
    else if (area < 0) holes.push(contour);
  }
  out.sort((a, b) => a.area - b.area);
  for (const hole of holes) {
    const [x = 0, y = 0] = hole;
    const area = -signedArea(hole);
    out.find((polygon) => polygon.area > area && isInside(polygon.outline, x, y))?.holes.push(hole);
  }
  return out;
}

/** The current part. */
class Pile {
  readonly positions = new Growing((length) => new Float32Array(length));
  readonly index = new Growing((length) => new Uint32Array(length));

  /** Number of contour points; each has a corner at the bottom and one at the top of its layer. */
  get points(): number {
    return this.positions.length / 6;
  }

  /** Adds the corners of a contour, alternately bottom and top; returns the index of the first. */
  #corners(contour: Contour, bottom: number, top: number): number {
    const first = this.positions.length / 3;
    for (let i = 0; i < contour.length; i += 2) {
      const x = contour[i] ?? 0;
      const y = contour[i + 1] ?? 0;
      this.positions.push(x, y, bottom);
      this.positions.push(x, y, top);
    }
    return first;
  }

  #walls(first: number, points: number): void {
    for (let i = 0; i < points; i++) {
      const here = first + 2 * i;
      const next = first + 2 * ((i + 1) % points);
      this.index.push(here, next, next + 1);
      this.index.push(here, next + 1, here + 1);
    }
  }

  layer(contours: readonly Contour[], bottom: number, top: number): void {
    for (const { outline, holes } of polygons(contours)) {
      const rings = [outline, ...holes];
      const first = this.positions.length / 3;
      const starts: number[] = [];
      for (const ring of rings) {
        if (ring !== outline) starts.push((this.positions.length / 3 - first) / 2);
        this.#walls(this.#corners(ring, bottom, top), ring.length / 2);
      }
      const cap = Earcut.triangulate(rings.flat(), starts, 2);
      for (let i = 0; i < cap.length; i += 3) {
        const a = first + 2 * (cap[i] ?? 0);
        const b = first + 2 * (cap[i + 1] ?? 0);
        const c = first + 2 * (cap[i + 2] ?? 0);
        this.index.push(a + 1, b + 1, c + 1);
        this.index.push(a, c, b);
      }
    }
  }
}

/** Reverses the contours of a mesh whose facets face inwards. */
function outwards(contours: Contour[]): Contour[] {
  const total = contours.reduce((sum, contour) => sum + signedArea(contour), 0);
  if (total >= 0) return contours;
  return contours.map((contour) => {
    const out: number[] = [];
    for (let i = contour.length - 2; i >= 0; i -= 2) out.push(contour[i] ?? 0, contour[i + 1] ?? 0);
    return out;
  });
}

/** Heights at which the layers are cut: their middles. */
export const middles = (z_mm: readonly number[]): number[] =>
  z_mm.slice(1).map((top, layer) => ((z_mm[layer] ?? 0) + top) / 2);

/**
 * Stair steps of a model sliced at `z_mm` (layer boundaries, ascending). Yields its progress, 0 to 1, after each layer, so that the caller
 * can let other work run. Cost: linear in the facets plus the points of all contours.
 */
export function* stairSteps(solid: Solid, z_mm: readonly number[]): Generator<number, Steps> {
  const planes = middles(z_mm);
  const finding = cutsOf(solid, planes);
  let found = finding.next();
  for (; found.done !== true; found = finding.next()) yield 0;
  const cuts = found.value;
  for (let tolerance_mm = TOLERANCE_MM; ; tolerance_mm *= COARSER) {
    const trace = tracer(solid, tolerance_mm);
    const parts: StepsPart[] = [];
    let pile = new Pile();
    let points = 0;
    let layer = 0;
    for (; layer < planes.length && points <= POINTS_LIMIT; layer++) {
      const facets = cuts.facets.subarray(cuts.start[layer] ?? 0, cuts.start[layer + 1] ?? 0);
      const contours = outwards(trace(planes[layer] ?? 0, facets));
      pile.layer(contours, z_mm[layer] ?? 0, z_mm[layer + 1] ?? 0);
      if (pile.points >= PART_POINTS || layer === planes.length - 1) {
        points += pile.points;
        parts.push({ positions: pile.positions.done(), index: pile.index.done() });
        pile = new Pile();
      }
      yield (layer + 1) / planes.length;
    }
    if (points <= POINTS_LIMIT) return { parts, tolerance_mm };
  }
}
