import { describe, expect, it } from "vitest";
import { colourAt, gradient, ofThickness, PALETTE_SIZE, placeOf, table, type PaletteName, type Rgb } from "./palette.js";

const NAMES: readonly PaletteName[] = ["classic", "safe"];

/** Relative luminance as WCAG defines it. */
function luminance(colour: Rgb): number {
  const [r = 0, g = 0, b = 0] = colour.map((channel) => {
    const part = channel / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

describe.each(NAMES)("the palette %s", (name) => {
  it("is one table for the shader and for the page", () => {
    const colours = table(name);
    expect(colours).toHaveLength(4 * PALETTE_SIZE);
    for (let entry = 0; entry < PALETTE_SIZE; entry++) {
      expect([...colours.subarray(4 * entry, 4 * entry + 3)]).toEqual(colourAt(name, entry / (PALETTE_SIZE - 1)));
      expect(colours[4 * entry + 3]).toBe(255);
    }
  });

  it("changes little from one entry to the next", () => {
    const colours = table(name);
    for (let i = 4; i < colours.length; i++) expect(Math.abs((colours[i] ?? 0) - (colours[i - 4] ?? 0))).toBeLessThan(6);
  });

  it("ends at the limits and is constant beyond them", () => {
    const limits = [0.03, 0.1] as const;
    expect(ofThickness(name, 0.03, limits)).toEqual(colourAt(name, 0));
    expect(ofThickness(name, 0.01, limits)).toEqual(colourAt(name, 0));
    expect(ofThickness(name, 0.1, limits)).toEqual(colourAt(name, 1));
    expect(ofThickness(name, 0.2, limits)).toEqual(colourAt(name, 1));
    expect(gradient(name)).toMatch(/^linear-gradient\(to right, rgb\(.*\)\)$/);
  });
});

it("goes from red to blue in the paper's palette", () => {
  const [thin, thick] = [colourAt("classic", 0), colourAt("classic", 1)];
  expect(thin[0]).toBeGreaterThan(2 * thin[2]);
  expect(thick[2]).toBeGreaterThan(2 * thick[0]);
});

it("darkens steadily in the palette that must be legible in grey", () => {
  for (let entry = 1; entry < PALETTE_SIZE; entry++) {
    const [before, here] = [entry - 1, entry].map((i) => luminance(colourAt("safe", i / (PALETTE_SIZE - 1))));
    expect(here).toBeLessThanOrEqual((before ?? 0) + 1e-3);
  }
  expect(luminance(colourAt("safe", 0))).toBeGreaterThan(0.7);
  expect(luminance(colourAt("safe", 1))).toBeLessThan(0.05);
});

it("puts a single thickness in the middle of the scale", () => {
  expect(placeOf(0.05, [0.05, 0.05])).toBe(0.5);
});
