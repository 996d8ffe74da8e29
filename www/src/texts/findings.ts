/** Texts of the findings, fetched with their panel. */
import type { Code, Finding, Printability, Severity } from "../api/wire.js";
import type { Format } from "./format.js";
import { room, type Tree } from "./messages.js";

const FINDINGS = {
  checking: "Checking the layers …",
  /** Shown if there are no findings. */
  none: "Nothing was found that would fail.",
  verdicts: { ok: "Can be printed like this", review: "Worth a look before it is printed", reject: "Will not print like this" },
  severities: { note: "for information", review: "worth a look", reject: "will fail" },
  kinds: {
    island: "Islands",
    "loose-body": "Loose bodies",
    "separate-body": "Separate bodies",
    speck: "Loose pixels",
    overhang: "Overhangs",
    cup: "Suction areas",
    trap: "Trapped resin",
    "narrow-drain": "Narrow drains",
    "thin-wall": "Thin walls",
    "thin-floor": "Thin floors",
    "narrow-gap": "Narrow gaps",
    "small-hole": "Small holes",
    "low-gap": "Low gaps",
    "thin-roof": "Thin roofs",
    "closed-gap": "Closed gaps",
    "peel-area": "Large layers",
    "peel-jump": "Sudden growth",
    "small-contact": "Little contact with the plate",
  },
  /** Explanation of each kind. */
  sentences: {
    island: "An island starts in layer {first} and joins the rest in layer {joins}, after growing to {volume}.",
    "loose-body": "A body of {volume} touches neither the plate nor another body.",
    "separate-body": "A body of {volume} on the plate touches no other.",
    speck: "A few pixels touch nothing, {area} in {layers|one:# layer|other:# layers}.",
    overhang: "Surfaces of {area} overhang by more than {limit}, too flat to support themselves.",
    cup: "A hollow of {resin} opens only away from the plate, and sucks at the film with up to {area}.",
    trap: "{resin} of resin are enclosed.",
    "narrow-drain": "At least {resin} of resin can drain only through openings narrower than {limit}.",
    "thin-wall": "A wall is thinner than {limit} over {volume}.",
    "thin-floor": "A floor is thinner than {limit} along z over {area}.",
    "narrow-gap": "A gap is narrower than {limit} over {volume} and may close.",
    "small-hole": "A hole is smaller than {limit} over {volume} and may close.",
    "low-gap": "A gap is lower than {limit} along z over {area} and may close.",
    "thin-roof": "A roof of {area} is so thin that its last layer alone cures too deep.",
    "closed-gap": "A gap of {area} closes, as light through its roof cures it.",
    "peel-area": "The layer peels {area} off the film, more than the limit of {limit}.",
    "peel-jump": "The layer peels {area} more off the film than the one below; the limit is {limit}.",
    "small-contact": "Only {area} hold the print on the plate, less than {limit} of its largest layer.",
  },
  /** Advice on each kind. */
  /** Labels of buttons that remedy findings. */
  fixes: {
    supports: "Add supports",
    stronger: "Use stronger supports",
    raft: "Add a raft",
    drain: "Drill drain holes",
    hollow: "Hollow the model",
    orient: "Find a better orientation",
    here: "Add a support here",
  },
  advice: {
    island: "Support it, or turn the model.",
    "loose-body": "Support it, join it, or leave it out.",
    "separate-body": "Join them if they are meant to be one.",
    speck: "Remove them from the model.",
    overhang: "Support them, or turn the model.",
    cup: "Make a hole near the plate, or turn the model.",
    trap: "Make two holes to drain them.",
    "narrow-drain": "Widen them, or add one.",
    "thin-wall": "Make it thicker, or the model larger.",
    "thin-floor": "Make it thicker, or the model larger.",
    "narrow-gap": "Make it wider, or the model larger.",
    "small-hole": "Make it wider, or the model larger.",
    "low-gap": "Make it higher, or turn the model.",
    "thin-roof": "Make it thicker, or turn the model.",
    "closed-gap": "Make it higher, or turn the model.",
    "peel-area": "Turn the model, or hollow it.",
    "peel-jump": "Turn the model.",
    "small-contact": "Put it on a raft, or turn it.",
  },
  layers: "layers {first} to {last}",
  layer: "layer {number}",
  /** Label of the button that shows all findings of a kind. */
  all: "Show all {count}",
  /** Number of smaller findings of a kind that are not listed. */
  smaller: "And {count} smaller ones.",
  /** Explains the effect of choosing a finding. */
  hint: "Choose a finding to see where it is. Escape deselects it.",
  /** Label of the switch that colours the model by wall thickness. */
  walls: "Show wall thickness",
  /** Explains the colours and the marked areas. */
  wallsHint: "Colours each point by the thickness directly beneath it. Stripes mark walls thinner than {limit}.",
} as const satisfies {
  verdicts: Record<Printability["verdict"], string>;
  severities: Record<Exclude<Severity, "ignore">, string>;
  kinds: Record<Code, string>;
  sentences: Record<Code, string>;
  advice: Record<Code, string>;
} & Tree;

export const findingsTexts = room("check", FINDINGS);

export type FindingsTexts = ReturnType<typeof findingsTexts>;

/** Formatted figures of a finding. */
export interface Said {
  readonly area: string;
  readonly volume: string;
  /** The volume as an amount of resin. */
  readonly resin: string;
  /** The limit with its unit. */
  readonly limit: string;
  /** First layer, counted from 1. */
  readonly first: string;
  readonly joins: string;
  /** Number of layers. */
  readonly layers: number;
}

export function saidOf({ code, area_mm2, volume_mm3, limit, layers: [first, last], joins_layer }: Finding, format: Format): Said {
  return {
    area: `${figure(area_mm2, format)}\u00a0mm²`,
    volume: `${figure(volume_mm3, format)}\u00a0mm³`,
    resin: format.millilitres(volume_mm3 / 1000),
    limit: limitOf(code, limit, format),
    first: format.count(first + 1),
    joins: format.count((joins_layer ?? last + 1) + 1),
    layers: last + 1 - first,
  };
}

/** Formats a figure with four significant digits, or two below 1. */
const figure = (value: number, format: Format): string => format.exact(Number(value.toPrecision(value < 1 ? 2 : 4)));

function limitOf(code: Code, limit: number, format: Format): string {
  if (code === "small-contact") return format.percent(limit, 1);
  return code === "peel-area" || code === "peel-jump" ? `${format.exact(limit)}\u00a0mm²` : format.mm(limit);
}
