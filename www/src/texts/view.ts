/** The 3-D view and its bar. */
import { ENGLISH_SENTENCES } from "../view/texts.js";

export const view = {
  view: {
    region: "The model in three dimensions",
    title: "Model",
    ...ENGLISH_SENTENCES,
    layers: "{count|one:# layer|other:# layers}",
    layer: "Layer {layer} · {height} · {thickness}",
    grid: "Grid {step}",
    building: "Working out the steps: {part}",
    measuring: "Measuring the distances: {part}",
    thin: "Thinner than {least}",
    probing: "Measuring the walls: {part}",
    tools: { turn: "Look around", move: "Move on the plate", rotate: "Turn the model", flat: "Lay a face flat", paint: "Paint important areas", supports: "Support points", drains: "Drain holes" },
    modes: "Mode",
    switches: "Display",
    impossible: "These tools need the 3-D view, which is not available.",
    printed: "As printed",
    measured: "Distance from the model",
    aligned: "Beside the profile",
    upright: "As in the file",
  },
} as const;
