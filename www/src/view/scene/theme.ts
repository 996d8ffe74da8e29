/** The view's colours as the page gives them. */
import type { Rgb } from "../legend/palette.js";
import type { Theme } from "./scene.js";

/** A dark page swallows a shadow, and needs a darker resin to stay calm. */
const DARK: Pick<Theme, "resin" | "shadow"> = { resin: [168, 174, 184], shadow: 0.75 };
const LIGHT: Pick<Theme, "resin" | "shadow"> = { resin: [205, 208, 214], shadow: 0.34 };

/** Any CSS colour as red, green and blue: a canvas knows them all. */
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

/** Reads the colours off probes: elements whose `color` is what the style sheet makes of the custom properties. */
export function themeOf(probes: Readonly<Record<"ink" | "accent" | "bad", HTMLElement>>): Theme {
  const of = (probe: HTMLElement): Rgb => parsed(getComputedStyle(probe).color);
  const ink = of(probes.ink);
  // Light ink is for a dark page.
  const isDark = (ink[0] + ink[1] + ink[2]) / 3 > 127;
  return { ink, accent: of(probes.accent), bad: of(probes.bad), ...(isDark ? DARK : LIGHT) };
}
