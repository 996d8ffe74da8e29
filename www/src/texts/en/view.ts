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
    tools: { turn: "Look around", move: "Move on the plate", rotate: "Turn the model", flat: "Lay a face flat", paint: "What matters", supports: "Support points", drains: "Drain holes" },
    modes: "Mode",
    switches: "Display",
    impossible: "These tools need the 3-D view, which is not available.",
    printed: "As printed",
    measured: "Distance from the model",
    safe: "Colour-blind safe",
    aligned: "Beside the profile",
    upright: "As in the file",
  },
});

export type ViewWords = ReturnType<typeof view>;
