/** The 3-D view, and the brush in it. */
import { ENGLISH_SENTENCES } from "../../view/texts.js";
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

export const view = ({ counted }: Format) => ({
  view: {
    region: "The model in three dimensions",
    title: "Model",
    ...ENGLISH_SENTENCES,
    layers: (count: number) => counted(count, LAYERS),
    layer: (layer: string, height: string, thickness: string) => `Layer ${layer} · ${height} · ${thickness}`,
    grid: (step: string) => `Grid ${step}`,
    building: (part: string) => `Working out the steps: ${part}`,
    measuring: (part: string) => `Measuring the distances: ${part}`,
    thin: (least: string) => `Thinner than ${least}`,
    probing: (part: string) => `Measuring the walls: ${part}`,
    tools: { turn: "Look around", move: "Move on the plate", rotate: "Turn the model", flat: "Lay a face flat", paint: "What matters" },
    modes: "Mode",
    switches: "Display",
    impossible: "These tools need the 3-D view, which is not available.",
    printed: "As printed",
    measured: "Distance from the model",
    safe: "Colour-blind safe",
    aligned: "Beside the profile",
    upright: "As in the file",
  },
  paint: {
    title: "What matters",
    hint: "The tolerance holds where the weight is 100%. Where something matters less, layers may be thicker. Paint on the model; drag beside it to turn the view.",
    brush: "Brush",
    modes: { less: "Matters less", more: "Matters more", erase: "Erase", soften: "Soften" },
    size: "Size (mm)",
    strength: "Strength",
    fills: "Fill a smooth region",
    crease: "Up to edges of",
    mirrors: "Mirror left and right",
    base: "Unpainted weight",
    least: "Least weight",
    saliency: "What stands out matters more",
    show: "Show",
    colours: { paint: "Painted weight", saliency: "What stands out", product: "Weight that counts", layers: "Layer thickness" },
    finding: "Finding what stands out",
    undo: "Undo stroke",
    redo: "Redo stroke",
    clear: "Clear",
    save: "Save weights",
    open: "Load weights",
  },
});

export type ViewWords = ReturnType<typeof view>;
