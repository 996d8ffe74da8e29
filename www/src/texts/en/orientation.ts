/** The search for the best orientation. */
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

export const orientation = ({ counted }: Format) => ({
  orientation: {
    title: "Orientation",
    hint: "In another orientation, the model may need fewer layers or come out smoother.",
    find: "Find the best orientation",
    again: "Search again",
    stale: "Found with other settings than those on show.",
    cost: "Cost",
    costs: { layers: "Layers", time: "Print time" },
    quality: "Quality",
    /** The largest error, and what is less of it, are words of the metric. */
    qualities: { roughness: "Roughness", overhang: "Overhang" },
    balance: "What counts more",
    fewer: { layers: "Fewer layers", time: "Quicker" },
    better: { roughness: "Smoother", overhang: "Less overhang" },
    parts: (cost: string, costPart: string, quality: string, qualityPart: string) =>
      `${cost} ${costPart}, ${quality} ${qualityPart}`,
    sphere: "Sphere of directions",
    kind: "sphere",
    keys: "Arrow keys move from direction to direction. Enter applies the orientation.",
    point: "Point at a direction to see its figures. Click to apply the orientation.",
    tap: "Tap a direction to see its figures. Tap it again to apply the orientation.",
    front: "Front",
    back: "Back",
    score: "Score",
    legend: "Score: cost and quality as weighed above; lower is better",
    excluded: "Does not fit",
    upright: "Up, current orientation",
    why: {
      "too-large": "Too wide or too deep for the printer.",
      "too-high": "Too high for the printer.",
      "no-plan": "No plan keeps the tolerance.",
    },
    layers: "Layers",
    time: "Print time",
    roughness: "Roughness",
    roughnessHelp: "The mean roughness of the surface (Ra).",
    overhang: "Overhang",
    overhangHelp: "The area that faces down and may need support.",
    size: "Size",
    apply: "Use this orientation",
    best: "Best orientations",
    now: "Now",
    current: "Current orientation",
    /** What an orientation has more or less of than the current one. */
    differs: {
      layers: (count: number, isLess: boolean) => `${counted(count, LAYERS)} ${isLess ? "fewer" : "more"}`,
      time: (time: string, isLess: boolean) => `${time} ${isLess ? "quicker" : "longer"}`,
      error: (head: string, error: string, isLess: boolean) => `${head}: ${error} ${isLess ? "smaller" : "larger"}`,
      roughness: (roughness: string, isLess: boolean) => `${roughness} ${isLess ? "smoother" : "rougher"}`,
      overhang: (area: string, isLess: boolean) => `${area} ${isLess ? "less" : "more"} overhang`,
      same: { layers: "Same number of layers", time: "Same print time" },
    },
    rank: (rank: string) => `Orientation ${rank}`,
    said: (layers: number, time: string, head: string, error: string) =>
      `${counted(layers, LAYERS)}, ${time}, ${head}: ${error}`,
    found: (count: string) => `${count} directions measured.`,
    none: "No orientation fits the printer and keeps the tolerance.",
  },
});

export type OrientationTexts = ReturnType<typeof orientation>;
