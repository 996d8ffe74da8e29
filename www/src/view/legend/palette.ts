/**
 * Layer colours by thickness. One table of 256 entries serves the shader, the legend and every chart, so that a layer has the same colour
 * everywhere. In both palettes, thin is warm and thick is cold.
 */

/** Red, green and blue, 0 to 255, sRGB. */
export type Rgb = readonly [number, number, number];

/**
 * `classic`: red (thinnest) through yellow to blue (thickest), as in the paper.
 * `safe`: viridis reversed, yellow (thinnest) to violet (thickest), without its darkest end, invisible on a dark page.
 * Lightness falls steadily, so that it is legible with every kind of colour blindness and in grey.
 */
export type PaletteName = "classic" | "safe";

/** Number of entries in a table. */
export const PALETTE_SIZE = 256;

const STOPS: Readonly<Record<PaletteName, readonly Rgb[]>> = {
  classic: [
    [200, 42, 54],
    [239, 108, 72],
    [252, 186, 103],
    [248, 231, 160],
    [176, 214, 226],
    [106, 161, 206],
    [54, 98, 172],
  ],
  safe: [
    [253, 231, 37],
    [194, 223, 35],
    [133, 213, 74],
    [81, 197, 106],
    [43, 176, 127],
    [30, 155, 138],
    [37, 133, 142],
    [45, 112, 142],
    [56, 89, 140],
    [67, 62, 133],
    [72, 33, 115],
  ],
};

/** Number of stops of a CSS gradient: enough to look the same as the table. */
const GRADIENT_STOPS = 18;

const tables = new Map<PaletteName, Uint8Array>();

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
export function table(name: PaletteName): Uint8Array {
  let found = tables.get(name);
  if (found === undefined) {
    found = filled(STOPS[name]);
    tables.set(name, found);
  }
  return found;
}

/** Position of a thickness between the limits: 0 the thinnest, 1 the thickest; clamped. 0.5 if the limits are equal. */
export function placeOf(thickness_mm: number, limits: readonly [number, number]): number {
  const span = limits[1] - limits[0];
  const place = span > 0 ? (thickness_mm - limits[0]) / span : 0.5;
  return Number.isFinite(place) ? Math.min(1, Math.max(0, place)) : 0.5;
}

/** Colour at `place`, 0 the thinnest and 1 the thickest; clamped. */
export function colourAt(name: PaletteName, place: number): Rgb {
  const colours = table(name);
  const at = 4 * Math.round(Math.min(1, Math.max(0, place)) * (PALETTE_SIZE - 1));
  return [colours[at] ?? 0, colours[at + 1] ?? 0, colours[at + 2] ?? 0];
}

/** Colour of a layer of this thickness, given the limits of the scale in mm. */
export function ofThickness(name: PaletteName, thickness_mm: number, limits: readonly [number, number]): Rgb {
  return colourAt(name, placeOf(thickness_mm, limits));
}

export const css = ([r, g, b]: Rgb): string => `rgb(${r} ${g} ${b})`;

/** The whole scale as a CSS gradient, thinnest first. */
export function gradient(name: PaletteName, direction = "to right"): string {
  const stops = Array.from({ length: GRADIENT_STOPS }, (_, i) => css(colourAt(name, i / (GRADIENT_STOPS - 1))));
  return `linear-gradient(${direction}, ${stops.join(", ")})`;
}
