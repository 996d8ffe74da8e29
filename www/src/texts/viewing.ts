/** Texts of the 3-D view and its tools, fetched with it. */
import { ENGLISH_SENTENCES } from "../view/texts.js";
import { room } from "./messages.js";

export const viewingTexts = room("view", {
  ...ENGLISH_SENTENCES,
  layers: "{count|one:# layer|other:# layers}",
  layer: "Layer {layer} · {height} · {thickness}",
  grid: "Grid {step}",
  building: "Working out the steps: {part}",
  measuring: "Measuring the distances: {part}",
  thin: "Thinner than {least}",
  probing: "Measuring the walls: {part}",
  tools: { turn: "Look", move: "Move", rotate: "Turn", size: "Scale", flat: "Lay flat", paint: "Paint", supports: "Supports", drains: "Drains" },
  /** Purpose of each tool, at the pointer. */
  hints: {
    turn: "Look around, and select models",
    move: "Move models on the plate",
    rotate: "Turn the model",
    size: "Scale the model",
    flat: "Lay a face flat",
    paint: "Paint important areas",
    supports: "Support points",
    drains: "Drain holes",
  },
  modes: "Mode",
  switches: "Display",
  impossible: "These tools need the 3-D view, which is not available.",
  printed: "As printed",
  measured: "Distance from the model",
  aligned: "Beside the profile",
  cut: "Cut at the layer",
  upright: "As in the file",
  /** Label of an axis, with the unit of its field. */
  axis: { mm: "{axis} (mm)", deg: "{axis} (°)" },
  /** Label of the turn of a copy about the vertical. */
  spin: "Turn (°)",
  percent: "Scale (%)",
  mirror: "Mirror",
  duplicate: "Duplicate",
  remove: "Remove",
});

export type ViewingTexts = ReturnType<typeof viewingTexts>;
