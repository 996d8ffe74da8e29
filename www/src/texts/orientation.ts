/** Texts for the search for the best orientation, fetched with its panel. */
import { room } from "./messages.js";

export const orientationTexts = room("orientation", {
  hint: "In another orientation, the model may need fewer supports, less time, or come out smoother.",
  find: "Find the best orientation",
  again: "Search again",
  stale: "Found with settings that have changed since.",
  /** Heading of the weights. */
  counts: "What counts",
  /** Weights from 0 to 3. */
  strengths: ["not at all", "a little", "much", "most"],
  height: "Height",
  /** The largest error is a word of the metric. */
  qualities: { roughness: "Roughness", overhang: "Overhang", islands: "Islands", cups: "Suction areas", supports: "Supports", contacts: "Contacts" },
  /** Precedes the three limits. */
  most: "Leave out directions with more than",
  limits: { overhang: "Overhang, mm²", islands: "Islands", cups: "Suction areas, mm²" },
  sphere: "Sphere of directions",
  kind: "sphere",
  keys: "Arrow keys move from direction to direction. Enter applies the orientation.",
  point: "Point at a direction to see its figures. Click to apply the orientation.",
  tap: "Tap a direction to see its figures. Tap it again to apply the orientation.",
  front: "Front",
  back: "Back",
  score: "Score",
  legend: "Score: all criteria, weighted as below; lower is better",
  excluded: "Does not fit, or left out",
  upright: "Up, current orientation",
  why: {
    "too-large": "Too wide or too deep for the printer.",
    "too-high": "Too high for the printer.",
    "no-plan": "No plan keeps the tolerance.",
    overhang: "Needs support over a larger area than allowed.",
    islands: "Has more islands than allowed.",
    cups: "Has larger suction areas than allowed.",
  },
  layers: "Layers",
  time: "Print time",
  roughness: "Roughness",
  roughnessHelp: "The mean roughness of the surface (Ra).",
  overhang: "Overhang",
  overhangHelp: "The area that faces down and may need support.",
  islands: "Islands",
  islandsHelp: "Parts that begin above the plate with nothing below them. An estimate from the surface; Check counts them in layers.",
  cups: "Suction areas",
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
    layers: {
      less: "{count|one:# layer|other:# layers} fewer",
      more: "{count|one:# layer|other:# layers} more",
    },
    time: {
      less: "{amount} quicker",
      more: "{amount} longer",
    },
    error: {
      less: "{head}: {amount} smaller",
      more: "{head}: {amount} larger",
    },
    roughness: {
      less: "{amount} smoother",
      more: "{amount} rougher",
    },
    overhang: {
      less: "{amount} less overhang",
      more: "{amount} more overhang",
    },
    islands: {
      less: "{count|one:# island|other:# islands} fewer",
      more: "{count|one:# island|other:# islands} more",
    },
    cups: {
      less: "{amount} less suction area",
      more: "{amount} more suction area",
    },
    supports: {
      less: "{amount} less support",
      more: "{amount} more support",
    },
    contacts: {
      less: "{amount} less contact",
      more: "{amount} more contact",
    },
  },
  rank: "Orientation {rank}",
  said: "{layers|one:# layer|other:# layers}, {time}, {head}: {error}",
  found: "{count} directions measured.",
  none: "No orientation fits the printer and keeps the tolerance.",
  beyond: "No orientation is within these limits. Allow more.",
});
