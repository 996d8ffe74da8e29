/** Warnings as data: a code for programs with typed details. The core gives no sentences; an element has its own. */
import type { Warning } from "./wire.js";

export type WarningCode = Warning["code"];

/** Every code that a warning can have, and what it means. A code once published keeps its meaning. */
export const WARNING_CODES = {
  "degenerate-facets": "Facets without an area were left out.",
  "inside-out": "The whole mesh was inside out, and was turned over.",
  "open-mesh": "The mesh is not closed; flat caps close its holes.",
  "unclosed-rays": "Rays pass holes of the mesh and close only by the caps over them.",
  "tolerance-exceeded": "Layers exceed the tolerance, which the planner does not look at.",
  "tolerance-exceeded-on-mesh": "Layers keep the tolerance where rays see the surface, and exceed it elsewhere.",
  "sampled-sections": "The surface crosses itself, so that areas of sections are counted along rays.",
  "top-moved": "Layers do not add up to the model's height, and the top was moved.",
  "black-layers": "No pixel of these layers is lit: parts hang in the air, or are thinner than a pixel.",
  "gpu-too-small": "The model does not fit into the GPU's buffers; the CPU did its work.",
  "gpu-failed": "The GPU failed; the CPU did its work.",
} as const satisfies Record<WarningCode, string>;
