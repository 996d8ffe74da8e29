/** Sentences of warnings, as in the command line. */
import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { BODIES, CAVITIES, EDGES, FACETS, FAULTS, HOLES, LAYERS, OBJECTS, PARTS, PART_KINDS, POINTS, UNITS } from "./nouns.js";

export const warnings = ({ count, counted, exact, mm, tick, height, volume, error, either }: Format): WarningSentences => ({
  "degenerate-facets": ({ facets }) => `${counted(facets, FACETS)} without area left out.`,
  "inside-out": () => "The mesh was inside out, and was turned over.",
  "turned-facets": ({ facets }) => `${counted(facets, FACETS)} facing the wrong way turned over.`,
  unorientable: ({ edges }) => `Facets cannot all face the same way at ${counted(edges, EDGES)}; what is inside there is a guess: look at the masks.`,
  "open-mesh": ({ open_edges, holes }) =>
    `The mesh is not closed: ${counted(open_edges, EDGES)} without a partner, ${counted(holes, HOLES)} closed by caps; look at the masks.`,
  "skipped-objects": ({ objects }) => `${counted(objects, OBJECTS)} of the file left out: supports, surfaces, or not to be printed.`,
  "subtracted-part": ({ name }) => `The part “${name}” is subtracted.`,
  "skipped-part": ({ name, kind }) => `The ${PART_KINDS[kind]} “${name}” is left out.`,
  "other-plates": ({ plate_number, plates }) => `Plate ${count(plate_number)} of ${count(plates)} is read.`,
  "odd-size": ({ size_mm, readings }) =>
    `The file states no unit, and in millimeters the model is ${mm(size_mm)} long; ` +
    readings.map(({ unit, size_mm }) => `in ${UNITS[unit]} it would be ${mm(size_mm)}; `).join("") +
    "give its unit if it is another.",
  "unit-stated": ({ stated, given }) => `The file is in ${UNITS[stated]}, as it states, and not in ${UNITS[given]}.`,
  "nothing-hollowed": ({ wall_mm, cavity_mm }) =>
    `The model stays solid: it is nowhere thick enough for walls of ${mm(wall_mm)} around a cavity of ${mm(cavity_mm)}.`,
  "nothing-to-drain": () => "The model has no closed cavity, so that no drain hole was made; hollow it.",
  "drain-astray": ({ drain_number }) =>
    `Drain hole ${count(drain_number)} meets no void, and was left out; place it where the model is hollow, or turn it inward.`,
  undrained: ({ basins }) =>
    `${counted(basins, PARTS)} of the void stay full, since no hole leads out of them on a level or downward; place holes there, or turn the model.`,
  "closed-cavities": ({ cavities, volume_mm3, at_mm }) =>
    `${counted(cavities, CAVITIES)} closed, with ${volume(volume_mm3)} of resin, the largest at ${at_mm.map(tick).join(", ")}; make holes to them, or fill them.`,
  "support-astray": ({ point_number }) => `Support ${count(point_number)} is not on the model, and was left out; place it on the surface.`,
  unsupported: ({ points }) => `${counted(points, POINTS)} without a support, since none gets there; turn the model, or choose lighter supports.`,
  "unclosed-rays": ({ unclosed, rays }) =>
    `${count(unclosed)} of ${count(rays)} rays pass holes of the mesh, which caps close; look at the masks.`,
  "missed-bodies": ({ bodies, at_mm }) =>
    `${counted(bodies, BODIES)} of the model missing in all masks, the largest at ${at_mm.map(tick).join(", ")}: narrower than a pixel, and met by no ray; thicken it, or choose smaller pixels.`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `The error reaches ${error(metric, max_error)}, more than the tolerance of ${error(metric, tolerance)}.`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `On the mesh itself the error reaches ${error(metric, max_error)}, more than the tolerance of ${error(metric, tolerance)}: rays miss a part of the surface.`,
  "sampled-sections": () => "The surface crosses itself, so that areas of sections are counted along rays.",
  "top-moved": ({ top_mm, height_mm }) => `The print ends at ${mm(top_mm)}, since layers do not add up to ${mm(height_mm)}.`,
  "black-layers": ({ layers, from_mm }) =>
    `${counted(layers, LAYERS)} of the plan ${layers === 1 ? "is" : "are"} black, from ${height(from_mm)} up: parts hang in the air, or are thinner than a pixel; look at the masks there.`,
  "erased-parts": ({ layers, from_mm, area_mm2 }) =>
    `Compensation erases parts of ${counted(layers, LAYERS)}, from ${height(from_mm)} up, at most ${tick(area_mm2)}\u00a0mm² of one: they are no thicker than what it takes away; thicken them, or set a least width that it leaves alone.`,
  "one-thickness": ({ taker, best }) =>
    `${taker} takes one thickness for all layers, and this plan has several; ` +
    (best === null ? "choose the uniform planner." : `${count(best.layers)} uniform layers of ${mm(best.layer_mm)} keep the tolerance.`),
  "extrapolated-exposures": ({ layers, thinnest_mm, thickest_mm }) =>
    `The exposure of ${counted(layers, LAYERS)} is extrapolated, since exposures are measured from ${exact(thinnest_mm)} to ${mm(thickest_mm)} alone; measure theirs, or keep the minimum and maximum layer thickness within that range.`,
  "untried-thicknesses": ({ model }) =>
    `It is not confirmed that the ${model} prints layers of several thicknesses; print the test towers, or choose uniform layers.`,
  "untried-slicer": ({ slicers }) =>
    `It is not confirmed that ${either(slicers)} prints the layers of such a file as planned; compare the number and the heights of the layers in its preview before you print.`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `The CPU did the work of the GPU: the mesh needs a buffer of ${count(needed_bytes)} bytes, and the GPU offers ${count(limit_bytes)}.`,
  "gpu-failed": ({ fault, system }) =>
    `The CPU did the work of the GPU, which failed: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
});
