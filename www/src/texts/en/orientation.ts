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
    qualities: { error: "Error", roughness: "Roughness", overhang: "Overhang" },
    balance: "What counts more",
    fewer: { layers: "Fewer layers", time: "Quicker" },
    better: { error: "Less error", roughness: "Smoother", overhang: "Less overhang" },
    parts: (cost: string, costPart: string, quality: string, qualityPart: string) =>
      `${cost} ${costPart}, ${quality} ${qualityPart}`,
    sphere: "Sphere of directions",
    kind: "Gaussian sphere",
    keys: "Arrow keys move from direction to direction. Enter applies the orientation.",
    point: "Point at a direction to see its metrics. Click to apply the orientation.",
    front: "Front",
    back: "Back",
    energy: "Energy",
    legend: "Energy: less is better",
    excluded: "Does not fit",
    upright: "Up, current orientation",
    why: {
      "too-large": "Too wide or too deep for the printer.",
      "too-high": "Too high for the printer.",
      "no-plan": "No plan keeps the tolerance.",
    },
    layers: "Layers",
    time: "Print time",
    error: "Largest error",
    roughness: "Mean roughness",
    overhang: "Overhanging area",
    size: "Size",
    apply: "Use this orientation",
    best: "Best orientations",
    rank: (rank: string) => `Orientation ${rank}`,
    said: (layers: number, time: string, error: string) => `${counted(layers, LAYERS)}, ${time}, error ${error}`,
    found: (count: string) => `${count} directions measured.`,
    none: "No orientation fits the printer and keeps the tolerance.",
  },
});

export type OrientationTexts = ReturnType<typeof orientation>;
