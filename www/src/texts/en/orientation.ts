/** The search for the best orientation. */
import type { Format } from "../format.js";
import { ISLANDS, LAYERS } from "./nouns.js";

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
    /** Largest error, and its comparison, are words of the metric. */
    qualities: { roughness: "Roughness", overhang: "Overhang", islands: "Islands", cups: "Cups", supports: "Supports", contacts: "Contacts" },
    balance: "What counts more",
    fewer: { layers: "Fewer layers", time: "Quicker" },
    better: { roughness: "Smoother", overhang: "Less overhang", islands: "Fewer islands", cups: "Smaller cups", supports: "Less support", contacts: "Smaller contacts" },
    /** Precedes the three limits. */
    most: "Leave out directions with more than",
    limits: { overhang: "Overhang, mm²", islands: "Islands", cups: "Cups, mm²" },
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
    excluded: "Does not fit, or left out",
    upright: "Up, current orientation",
    why: {
      "too-large": "Too wide or too deep for the printer.",
      "too-high": "Too high for the printer.",
      "no-plan": "No plan keeps the tolerance.",
      overhang: "Needs support over a larger area than allowed.",
      islands: "Has more islands than allowed.",
      cups: "Has larger cups than allowed.",
    },
    layers: "Layers",
    time: "Print time",
    roughness: "Roughness",
    roughnessHelp: "The mean roughness of the surface (Ra).",
    overhang: "Overhang",
    overhangHelp: "The area that faces down and may need support.",
    islands: "Islands",
    islandsHelp: "Parts that begin above the plate with nothing below them. An estimate from the surface; Check counts them in layers.",
    cups: "Cups",
    cupsHelp: "The area of hollows that are open only away from the plate. They suck at the film.",
    supportsHelp: "The volume of supports, estimated.",
    contactsHelp: "The area in which supports touch the model, estimated. Painted weights count.",
    size: "Size",
    apply: "Use this orientation",
    best: "Best orientations",
    now: "Now",
    current: "Current orientation",
    /** Differences from the current orientation. */
    differs: {
      layers: (count: number, isLess: boolean) => `${counted(count, LAYERS)} ${isLess ? "fewer" : "more"}`,
      time: (time: string, isLess: boolean) => `${time} ${isLess ? "quicker" : "longer"}`,
      error: (head: string, error: string, isLess: boolean) => `${head}: ${error} ${isLess ? "smaller" : "larger"}`,
      roughness: (roughness: string, isLess: boolean) => `${roughness} ${isLess ? "smoother" : "rougher"}`,
      overhang: (area: string, isLess: boolean) => `${area} ${isLess ? "less" : "more"} overhang`,
      islands: (count: number, isLess: boolean) => `${counted(count, ISLANDS)} ${isLess ? "fewer" : "more"}`,
      cups: (area: string, isLess: boolean) => `${area} ${isLess ? "less" : "more"} cup area`,
      supports: (volume: string, isLess: boolean) => `${volume} ${isLess ? "less" : "more"} support`,
      contacts: (area: string, isLess: boolean) => `${area} ${isLess ? "less" : "more"} contact`,
      same: { layers: "Same number of layers", time: "Same print time" },
    },
    rank: (rank: string) => `Orientation ${rank}`,
    said: (layers: number, time: string, head: string, error: string) =>
      `${counted(layers, LAYERS)}, ${time}, ${head}: ${error}`,
    found: (count: string) => `${count} directions measured.`,
    none: "No orientation fits the printer and keeps the tolerance.",
    beyond: "No orientation is within these limits. Allow more.",
  },
});

export type OrientationTexts = ReturnType<typeof orientation>;
