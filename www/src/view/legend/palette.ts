/**
 * Layer colours by thickness, from sand (thinnest) to indigo (thickest). One table of 256 entries serves the shader, the legend and every
 * chart, so that a layer has the same colour everywhere. Lightness falls steadily, so it is legible with every kind of colour blindness and
 * in grey; red is left for problems.
 */

/** Red, green and blue, 0 to 255, sRGB. */
export type Rgb = readonly [number, number, number];

/** Number of entries in a table. */
export const PALETTE_SIZE = 256;

/** Sand, teal, blue, indigo; not so dark that it is lost on a dark page. */
const STOPS: readonly Rgb[] = [
  [252, 227, 150],
  [203, 214, 150],
  [136, 194, 160],
  [80, 165, 168],
  [54, 130, 165],
  [52, 93, 148],
  [56, 52, 122],
];

/** Number of stops of a CSS gradient: enough to look the same as the table. */
const GRADIENT_STOPS = 18;

function filled(stops: readonly Rgb[]): Uint8Array {
  const out = new Uint8Array(4 * PALETTE_SIZE);
  for (let entry = 0; entry < PALETTE_SIZE; entry++) {
    const place = (entry / (PALETTE_SIZE - 1)) * (stops.length - 1);
    const below = Math.min(Math.floor(place), stops.length - 2);
    const part = place - below;
    for (let channel = 0; channel < 3; channel++) {
      const [from, to] = [stops[below]?.[channel] ?? 0, stops[below + 1]?.[channel] ?? 0];
      out[4 * entry + channel] = Math.round(from + (to - from) * part);
    }
    out[4 * entry + 3] = 255;
  }
  return out;
}

/** RGBA of each entry, thinnest first. Shared: do not write to it. */
export const TABLE: Uint8Array = filled(STOPS);

/** Position of a thickness between the limits: 0 the thinnest, 1 the thickest; clamped. 0.5 if the limits are equal. */
export function placeOf(thickness_mm: number, limits: readonly [number, number]): number {
  const span = limits[1] - limits[0];
  const place = span > 0 ? (thickness_mm - limits[0]) / span : 0.5;
  return Number.isFinite(place) ? Math.min(1, Math.max(0, place)) : 0.5;
}

/** Colour at `place`, 0 the thinnest and 1 the thickest; clamped. */
export function colourAt(place: number): Rgb {
  const at = 4 * Math.round(Math.min(1, Math.max(0, place)) * (PALETTE_SIZE - 1));
  return [TABLE[at] ?? 0, TABLE[at + 1] ?? 0, TABLE[at + 2] ?? 0];
}

/** Colour of a layer of this thickness, given the limits of the scale in mm. */
export function ofThickness(thickness_mm: number, limits: readonly [number, number]): Rgb {
  return colourAt(placeOf(thickness_mm, limits));
}

export const css = ([r, g, b]: Rgb): string => `rgb(${r} ${g} ${b})`;

/** The whole scale as a CSS gradient, thinnest first. */
export function gradient(direction = "to right"): string {
  const stops = Array.from({ length: GRADIENT_STOPS }, (_, i) => css(colourAt(i / (GRADIENT_STOPS - 1))));
  return `linear-gradient(${direction}, ${stops.join(", ")})`;
}
