/**
 * The colour of a layer: red where it is thinnest, through yellow, to blue where it is thickest, as in the paper.
 * The stops are a diverging scale that stays readable with the common kinds of colour blindness.
 */

export type Rgb = readonly [number, number, number];

const STOPS: readonly Rgb[] = [
  [200, 42, 54],
  [239, 108, 72],
  [252, 186, 103],
  [248, 231, 160],
  [176, 214, 226],
  [106, 161, 206],
  [54, 98, 172],
];

/** The colour at `t`, 0 the thinnest and 1 the thickest; clamped. */
export function at(t: number): Rgb {
  const clamped = Number.isFinite(t) ? Math.min(1, Math.max(0, t)) : 0.5;
  const place = clamped * (STOPS.length - 1);
  const below = Math.min(Math.floor(place), STOPS.length - 2);
  const [a, b] = [STOPS[below], STOPS[below + 1]];
  if (a === undefined || b === undefined) return [0, 0, 0];
  const part = place - below;
  const mix = (from: number, to: number): number => Math.round(from + (to - from) * part);
  return [mix(a[0], b[0]), mix(a[1], b[1]), mix(a[2], b[2])];
}

/** The colour of a layer of this thickness, given the limits of the scale in mm. */
export function ofThickness(mm: number, limits: readonly [number, number]): Rgb {
  const span = limits[1] - limits[0];
  return at(span > 0 ? (mm - limits[0]) / span : 0.5);
}

export const css = ([r, g, b]: Rgb): string => `rgb(${r} ${g} ${b})`;

/** The whole scale from left to right, for the legend. */
export function gradient(): string {
  return `linear-gradient(to right, ${STOPS.map(css).join(", ")})`;
}
