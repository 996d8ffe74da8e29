/** A plan and its savings, its print file, the trade-off curve, the profile and the masks. */
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

/** A file that is known by its extension. */
const file = (extension: string): string => `A .${extension} file.`;

export const plan = ({ counted, plural, size }: Format) => ({
  plan: {
    region: "The plan",
    layers: (count: number) => plural(count, LAYERS),
    time: (time: string) => `about ${time} to print`,
    resin: (ml: string) => `${ml} of resin`,
    price: "Price",
    download: "Download print file",
    earlier: "This is the last plan that worked, with the settings before the change.",
    again: "Plan again",
    none: "There is no plan for this model yet.",
    make: "Plan the layers",
    said: (count: number, time: string) =>
      `${counted(count, LAYERS)} planned, about ${time} to print.`,
    columns: { plan: "Plan", layers: "Layers", time: "Time" },
    best: (thickness: string) => `Best uniform, ${thickness}`,
    finest: (thickness: string) => `Finest uniform, ${thickness}`,
    coarsest: (thickness: string) => `Coarsest uniform, ${thickness}`,
    own: "This plan",
    within: "within tolerance",
    over: "over tolerance",
  },
  /** Notes on the download: the format of the file, the printer's support for it, and the preparation of the model. */
  file: {
    kinds: {
      png: () => "A zip of layer images.",
      chitubox: () => "A ChiTuBox zip.",
      uvj: () => "A UVJ file.",
      sl1: () => "A Prusa SL1 file.",
      goo: file,
      "photon-workshop": file,
      "anycubic-zip": file,
      ctb: () => "A .ctb file of version 3, not encrypted.",
      nanodlp: file,
      "prusa-3mf": () => "A 3MF for PrusaSlicer.",
      "orca-3mf": () => "A 3MF for OrcaSlicer and Bambu Studio, untested there so far.",
    },
    direct: (printer: string) => `The ${printer} reads it directly.`,
    convert: (printer: string, extensions: string) => `The ${printer} reads ${extensions}: convert it with UVtools first.`,
    unreadable: (printer: string) => `The ${printer} cannot read it.`,
    oneInFile: "This file has one thickness for all layers: choose uniform ones for it.",
    onePerPrint: (printer: string) => `The ${printer} takes one thickness for all layers: choose uniform ones for it.`,
    /** First layer to set in the slicer of a filament printer; any other shifts all layers. */
    match: (thickness: string, setting: string) => `Set the first layer to ${thickness} there (${setting}), or every layer is printed at another height than planned.`,
    asIs: "The model prints as it is: no supports, not hollowed.",
    hollow: "The model prints hollow: no supports.",
    supported: "The model prints with supports, not hollowed.",
    hollowSupported: "The model prints hollow, with supports.",
    together: (sentences: readonly string[]) => sentences.join(" "),
  },
  /** Test towers, which show whether a printer obeys the thickness of each layer. */
  towers: {
    download: "Download test towers",
    writing: "Writing test towers…",
    measure:
      `Two small towers to measure with a caliper. If they are ${size(0.5)} and ${size(1.5)}\u00a0mm high, the printer takes a ` +
      `thickness for each layer; if ${size(0.5)} and ${size(1)}\u00a0mm, or ${size(1)} and ${size(2)}\u00a0mm, it takes one for all.`,
  },
  /** Gain of the plan over the best uniform layers within tolerance; `uniform` is their thickness, `figure` their number or time. */
  gain: {
    over: (subject: string, error: string, tolerance: string) => `${subject} is ${error}, more than the ${tolerance} allowed.`,
    isUniform: (tolerance: string) => `Uniform layers, within ${tolerance} all the way up. Adaptive ones may need fewer.`,
    none: (thin: string, thick: string, tolerance: string) => `No uniform layers from ${thin} to ${thick} stay within ${tolerance}; these do.`,
    little: (uniform: string, figure: string, tolerance: string) => `Uniform layers of ${uniform} (${figure}) do about as well within ${tolerance}.`,
    saved: {
      layers: (part: string, uniform: string, figure: string) => `${part} fewer than the best uniform layers within tolerance (${figure} of ${uniform}).`,
      time: (part: string, uniform: string, figure: string) =>
        `${part} less time than the quickest uniform layers within tolerance (${uniform}, ${figure}).`,
    },
  },
  quality: {
    title: "Quality",
    quick: "Quicker",
    fine: "Finer",
    waiting: "Looking for the best plans",
    said: (head: string, error: string, time: string, layers: number) =>
      `${head} ${error}, ${time}, ${counted(layers, LAYERS)}`,
    axis: (head: string) => `Chart of the print time by quality (${head})`,
    time: (longest: string) => `Print time, up to ${longest}`,
    points: "The quickest plan at each quality",
    finest: (uniform: string, time: string) => `Uniform ${uniform}, the finest: ${time}`,
    coarsest: (uniform: string, time: string) => `Uniform ${uniform}, the coarsest: ${time}`,
    single: "Every quality gives this model the same layers.",
  },
  details: {
    ran: (where: string, duration: string) => `Computed on ${where} in ${duration}`,
    cpu: "the CPU",
    gpu: (how: string | null) => (how === null ? "the GPU" : `the GPU (${how})`),
    methods: { fill: "filling", peel: "depth peeling" },
    load: "Reading",
    ldi: "Casting rays",
    profile: "Measuring the surface",
    plan: "Planning",
    masks: "Masks",
    meshError: "Largest error on the mesh",
    rayError: "The same as rays see it",
    cuspError: "Largest cusp height",
    deviation: "Largest deviation",
    trueError: "Without weights and caps",
    flats: "Planes at flats",
    source: "Planned from",
    exact: "Every facet",
    sampled: "What rays see",
    overhead: "Time between exposures",
    mask: "Masks",
    maskSize: (width: string, height: string, pitch: string) => `${width} × ${height} pixels of ${pitch}`,
    bins: "Profile",
    binSize: (count: string, bin: string) => `${count} intervals of ${bin}`,
    hits: "Surface hits",
  },
  chart: {
    region: "Profile",
    title: "Profile and plan",
    line: "Profile: the further right, the thinner the layers",
    colours: "Layer thickness",
    hint: "Click to see a layer. Drag to zoom.",
    touchHint: "Tap to see a layer. Pinch to zoom.",
    at: (height: string, density: string) => `At ${height}: ${density}`,
    whole: "Whole model",
    heights: "Height (mm)",
    none: "No plan yet",
    said: (axis: string, height: string, layers: number, least: string, most: string) =>
      `Chart of the profile by height (${axis}), up to ${height}, over the ` +
      `${counted(layers, LAYERS)} of the plan, ${least} to ${most} thick.`,
  },
  findings: {
    title: "Check",
  },
  mask: {
    region: "Layers",
    title: "Layer mask",
    hint: "White is what the printer cures.",
    layer: "Layer",
    below: "Layer below",
    above: "Layer above",
    height: "Height",
    thickness: "Thickness",
    play: "Play",
    pause: "Pause",
    zoomIn: "Zoom in",
    zoomOut: "Zoom out",
    zoom: (times: string) => `${times} ×`,
    wellHint: "Drag or use the arrow keys to move.",
    touchHint: "Drag to move, pinch to zoom.",
    picture: (said: string) => `Mask. ${said}`,
    said: (layer: string, layers: string, height: string, thickness: string) =>
      `Layer ${layer} of ${layers}, at ${height}, ${thickness} thick`,
  },
});

export type PlanTexts = ReturnType<typeof plan>;
