import { describe, expect, it } from "vitest";
import { colourAt, gradient, ofThickness, PALETTE_SIZE, placeOf, TABLE, type Rgb } from "./palette.js";

/** Relative luminance as WCAG defines it. */
function luminance(colour: Rgb): number {
  const [r = 0, g = 0, b = 0] = colour.map((channel) => {
    const part = channel / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

describe("the palette", () => {
  it("is one table for the shader and for the page", () => {
    expect(TABLE).toHaveLength(4 * PALETTE_SIZE);
    for (let entry = 0; entry < PALETTE_SIZE; entry++) {
      expect([...TABLE.subarray(4 * entry, 4 * entry + 3)]).toEqual(colourAt(entry / (PALETTE_SIZE - 1)));
      expect(TABLE[4 * entry + 3]).toBe(255);
    }
  });

  it("changes little from one entry to the next", () => {
    for (let i = 4; i < TABLE.length; i++) expect(Math.abs((TABLE[i] ?? 0) - (TABLE[i - 4] ?? 0))).toBeLessThan(6);
  });

  it("ends at the limits and is constant beyond them", () => {
    const limits = [0.03, 0.1] as const;
    expect(ofThickness(0.03, limits)).toEqual(colourAt(0));
    expect(ofThickness(0.01, limits)).toEqual(colourAt(0));
    expect(ofThickness(0.1, limits)).toEqual(colourAt(1));
    expect(ofThickness(0.2, limits)).toEqual(colourAt(1));
    expect(gradient()).toMatch(/^linear-gradient\(to right, rgb\(.*\)\)$/);
  });
});

it("leaves red for problems", () => {
  for (let entry = 0; entry < PALETTE_SIZE; entry++) {
    const [red, green, blue] = colourAt(entry / (PALETTE_SIZE - 1));
    expect(red).toBeLessThan(1.2 * Math.max(green, blue));
  }
});

it("darkens steadily so that it is legible in grey", () => {
  for (let entry = 1; entry < PALETTE_SIZE; entry++) {
    const [before, here] = [entry - 1, entry].map((i) => luminance(colourAt(i / (PALETTE_SIZE - 1))));
    expect(here).toBeLessThanOrEqual((before ?? 0) + 1e-3);
  }
  expect(luminance(colourAt(0))).toBeGreaterThan(0.7);
  expect(luminance(colourAt(1))).toBeLessThan(0.05);
});

it("puts a single thickness in the middle of the scale", () => {
  expect(placeOf(0.05, [0.05, 0.05])).toBe(0.5);
});
