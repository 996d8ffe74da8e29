/** Reads the view's colours from the page. */
import type { Rgb } from "../legend/palette.js";
import type { Theme } from "./scene.js";

/** On a dark page, the shadow must be stronger to be visible, and the resin darker to avoid glare. */
const DARK: Pick<Theme, "resin" | "shadow"> = { resin: [168, 174, 184], shadow: 0.75 };
const LIGHT: Pick<Theme, "resin" | "shadow"> = { resin: [205, 208, 214], shadow: 0.34 };

/** Converts any CSS colour to red, green and blue by painting it on a canvas. */
function parsed(colour: string): Rgb {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  if (pen === null) return [128, 128, 128];
  pen.fillStyle = colour;
  pen.fillRect(0, 0, 1, 1);
  const [r = 0, g = 0, b = 0] = pen.getImageData(0, 0, 1, 1).data;
  return [r, g, b];
}

/** Reads the colours from probes: elements whose `color` the style sheet derives from the custom properties. */
export function themeOf(probes: Readonly<Record<"ink" | "accent" | "bad", HTMLElement>>): Theme {
  const of = (probe: HTMLElement): Rgb => parsed(getComputedStyle(probe).color);
  const ink = of(probes.ink);
  // Light ink means a dark page.
  const isDark = (ink[0] + ink[1] + ink[2]) / 3 > 127;
  return { ink, accent: of(probes.accent), bad: of(probes.bad), ...(isDark ? DARK : LIGHT) };
}
