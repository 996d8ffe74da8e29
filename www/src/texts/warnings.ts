/** Sentences of warnings, as in the command line. */
import type { WarningCode, WarningDetails } from "../api/warning.js";
import { sayer, type Cases, type Sentences } from "./codes.js";
import { room, say, type Spoken } from "./messages.js";
import "./nouns.js";

export const warnings = {
  "degenerate-facets": "Left out {facets|one:# facet|other:# facets} without area.",
  "inside-out": "The mesh was inside out, and was turned over.",
  "turned-facets": "Turned over {facets|one:# facet|other:# facets} that faced the wrong way.",
  unorientable: "Facets cannot all face the same way at {edges|one:# edge|other:# edges}; what is inside there is a guess: look at the masks.",
  "open-mesh": "The mesh is not closed: {open_edges|one:# edge|other:# edges} without a partner, {holes|one:# hole|other:# holes} closed by caps; look at the masks.",
  "skipped-objects": "{objects|one:# object|other:# objects} of the file left out: supports, surfaces, or not to be printed.",
  "subtracted-part": "The part “{name}” is subtracted.",
  "skipped-part": "The {kind|nouns.partKinds} “{name}” is left out.",
  "other-plates": "Plate {plate_number|count} of {plates|count} is read.",
  "odd-size": "The file states no unit; in millimeters the model is {size_mm|mm} long; {readings}set its unit if that is another.",
  "unit-stated": "The file is in {stated|settings.units}, as it states, and not in {given|settings.units}.",
  "nothing-hollowed": "The model stays solid: it is nowhere thick enough for walls of {wall_mm|mm} around a cavity of {cavity_mm|mm}.",
  "nothing-to-drain": "The model has no closed cavity, so no drain hole was made; hollow it first.",
  "drain-astray": "Drain hole {drain_number|count} meets no void, and was left out; place it where the model is hollow, or turn it inward.",
  undrained: "{basins|one:# part of the void stays|other:# parts of the void stay} full, since no hole there drains sideways or downward; place holes there, or turn the model.",
  "closed-cavities": "{cavities|one:# cavity of the model stays|other:# cavities of the model stay} closed, with {volume_mm3|volume} of resin, the largest at {at_mm.0|tick}, {at_mm.1|tick}, {at_mm.2|tick}; make holes to them, or fill them.",
  "support-astray": "Support {point_number|count} is not on the model, and was left out; place it on the surface.",
  unsupported: "{points|one:# point|other:# points} without a support, since the model is in the way on all sides; turn the model.",
  "own-supports": {
    kept: "Supports of the file hold the model at {tips|one:# point|other:# points}; they are printed unchanged.",
    replaced: "Supports of the file hold the model at {tips|one:# point|other:# points}; those that you chose replace them.",
  },
  "unclosed-rays": "{unclosed|count} of {rays|count} rays pass holes of the mesh, which caps close; look at the masks.",
  "missed-bodies": "All masks miss {bodies|one:# body|other:# bodies} of the model, the largest at {at_mm.0|tick}, {at_mm.1|tick}, {at_mm.2|tick}: narrower than a pixel, and hit by no ray; thicken it, or choose smaller pixels.",
  "tolerance-exceeded": "The error reaches {max_error|error}, more than the tolerance of {tolerance|error}.",
  "tolerance-exceeded-on-mesh": "On the mesh itself the error reaches {max_error|error}, more than the tolerance of {tolerance|error}: rays miss a part of the surface.",
  "sampled-sections": "The surface crosses itself, so that areas of sections are counted along rays.",
  "top-moved": "The print ends at {top_mm|mm}, since layers do not add up to {height_mm|mm}.",
  "extrapolated-exposures": "The exposure of {layers|one:# layer|other:# layers} is extrapolated, since exposures are measured from {thinnest_mm|exact} to {thickest_mm|mm} alone; measure theirs, or keep the minimum and maximum layer thickness within that range.",
  "black-layers": "{layers|one:# layer of the plan is|other:# layers of the plan are} black, from {from_mm|height} up: parts hang in the air, or are thinner than a pixel; look at the masks there.",
  "thin-roofs": "Light cures through thin roofs of {area_mm2|tick}\u00a0mm², whose undersides are up to {deep_mm|height} too low, the first at {at_mm.0|tick}, {at_mm.1|tick}, {at_mm.2|tick}; thicken them, or turn the model.",
  "closed-gaps": "Light cures through roofs down to the floor and closes gaps over {area_mm2|tick}\u00a0mm², the first at {at_mm.0|tick}, {at_mm.1|tick}, {at_mm.2|tick}; widen them, or turn the model.",
  "erased-parts": "Compensation erases parts of {layers|one:# layer|other:# layers}, from {from_mm|height} up, at most {area_mm2|tick}\u00a0mm² in a layer: they are too thin for it; thicken them, or set a minimum feature width.",
  "one-thickness": {
    none: "{taker} takes one thickness for all layers, and this plan has several; choose the uniform planner.",
    best: "{taker} takes one thickness for all layers, and this plan has several; {best.layers|count} uniform layers of {best.layer_mm|mm} keep the tolerance.",
  },
  "untried-thicknesses": "It is not confirmed that the {model} prints layers of several thicknesses; print the test towers, or choose uniform layers.",
  "untried-slicer": "It is not confirmed that {slicers|either} prints the layers of such a file as planned; compare the number and the heights of the layers in its preview before you print.",
  "gpu-too-small": "The CPU did the work of the GPU: the mesh needs a buffer of {needed_bytes|count} bytes, and the GPU offers {limit_bytes|count}.",
  "gpu-failed": {
    bare: "The CPU did the work of the GPU, which failed: {fault|nouns.gpuFaults}.",
    system: "The CPU did the work of the GPU, which failed: {fault|nouns.gpuFaults} ({system}).",
  },
} as const satisfies Sentences<WarningCode>;

room("warnings", warnings);

const cases: Cases<typeof warnings, WarningDetails> = {
  "own-supports": ({ replaced }) => (replaced ? "replaced" : "kept"),
  "one-thickness": ({ best }) => (best === null ? "none" : "best"),
  "gpu-failed": ({ system }) => (system === null ? "bare" : "system"),
};

const sayWarning = sayer<typeof warnings, WarningDetails>("warnings", cases);

export function warningOf<Code extends WarningCode>(code: Code, detail: WarningDetails[Code], language: Spoken): string {
  const readings = detail !== null && "readings" in detail && { readings: detail.readings.map((reading) => say("nouns.reading", { ...reading }, language)).join("") };
  return sayWarning(code, detail, language, readings || {});
}
