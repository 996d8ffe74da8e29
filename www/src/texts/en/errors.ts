/** Sentences about failures, as in the command line. */
import type { UniformLayers } from "../../api/wire.js";
import type { Format } from "../format.js";
import { adviceOn, ended, FILE_KINDS, flatKind, STL_KEYWORDS, type ErrorSentences, type QuantityNouns, type StlNouns, type WorkWords } from "../sentences.js";
import { FACETS, FAULTS } from "./nouns.js";
import { readers } from "./readers.js";

const QUANTITIES: QuantityNouns = {
  pitch: "The pixel pitch",
  bin: "The bin height",
  step: "The motor step",
  layer: "The layer thickness",
  "first-layer": "The first layer",
  "layer-min": "The minimum layer thickness",
  "layer-max": "The maximum layer thickness",
  tolerance: "The tolerance",
  "resin-layer": "The resin's layer thickness",
  penetration: "The penetration depth",
  exposure: "The exposure",
  "bottom-exposure": "The bottom exposure",
  wait: "The wait between layers",
  lift: "The lift height",
  "lift-speed": "The lift speed",
  "return-speed": "The return speed",
  density: "The resin density",
};

const WORK: WorkWords = {
  hits: ["Sampling the model", ", or choose larger pixels"],
  layers: ["Planning", ", or choose larger bins or fewer thicknesses"],
  saliency: ["Finding what stands out", ", do without it, or give the model fewer facets"],
  all: ["This", ""],
};

const EXPECTED: StlNouns = {
  ...STL_KEYWORDS,
  "facet-or-endsolid": "`facet` or `endsolid`",
  "normal-number": "a number of the normal",
  coordinate: "a coordinate",
};

/** Advice on uniform layers in place of adaptive ones. */
const inPlace = (best: UniformLayers | null | undefined, { count, mm }: Pick<Format, "count" | "mm">): string =>
  best ? `${count(best.layers)} uniform layers of ${mm(best.layer_mm)}, which keep the tolerance` : "the uniform planner";

export const errors = ({ count, counted, exact, mm, measure, error, either }: Format): ErrorSentences => ({
  ...readers({ count }),
  "file-empty": () => "The file is empty; export the model again.",
  "unknown-file-kind": () => "This is no model that Cusp reads; export it as STL, 3MF or OBJ.",
  "no-plate": ({ plate_number, plates }) => `There is no plate ${count(plate_number)}: the file has ${count(plates)}.`,
  "other-file-kind": ({ kind }) =>
    flatKind(kind, { picture: "picture", document: "document", drawing: "drawing" }, (noun) => `This is a ${noun} (${FILE_KINDS[kind]}); Cusp opens STL, 3MF, OBJ and print files.`) ??
    `This is a ${FILE_KINDS[kind]} file, which Cusp does not read; ${adviceOn(kind, {
      model: "export the model as STL, 3MF or OBJ",
      packed: "unpack it, and open the model inside",
      page: "download the model itself; the address may need a login, or lead to a page about the model",
    })}.`,
  "stl-truncated": (detail) =>
    "line" in detail
      ? `The STL is cut short: it ends at line ${count(detail.line)}, where ${EXPECTED[detail.expected]} should follow.`
      : `The STL is cut short: its header announces ${counted(detail.declared_facets, FACETS)}, which need ${count(detail.expected_bytes)} bytes, ` +
        `but the file ends at byte ${count(detail.found_bytes)}; copy or export it again.`,
  "stl-wrong-facet-count": ({ declared_facets, found_facets }) =>
    `The facet count is wrong: the header at byte 80 announces ${counted(declared_facets, FACETS)}, but ${count(found_facets)} follow; export the model again.`,
  "stl-not-finite": (detail) =>
    "line" in detail
      ? `Line ${count(detail.line)}: \`${detail.text}\` is not a finite number; export the model again.`
      : `The coordinate at byte ${count(detail.byte)} (facet ${count(detail.facet)}) is not a finite number; export the model again.`,
  "stl-syntax": ({ line, expected, found }) =>
    `Line ${count(line)}: expected ${EXPECTED[expected]}, found \`${found}\`; export the model again.`,
  "stl-no-facets": () => "The STL holds no facets; export the model again.",
  "mesh-no-area": ({ facets }) => `None of the ${counted(facets, FACETS)} has an area; export the model again.`,
  "mesh-zero-height": () => "The model has no height; is it flat, or lying in the plane z = constant?",
  "mesh-overflow": () => "The model is too large: at this height it measures more than a kilometre; choose another unit or height.",
  "bad-height": ({ height_mm }) => `The height must be greater than 0, not ${mm(height_mm)}.`,
  "bad-rotation": () => "The rotation must be a quaternion x, y, z, w whose length is not zero.",
  "bad-length": ({ quantity, value, unit, least, most }, metric) =>
    `${QUANTITIES[quantity]} must be from ${exact(least)} to ${measure(most, unit, metric)}, not ${measure(value, unit, metric)}.`,
  "bad-time": ({ quantity, value_s, most_s }) => `${QUANTITIES[quantity]} must be from 0 to ${measure(most_s, "s")}, not ${measure(value_s, "s")}.`,
  "bad-exposures": ({ previous_mm, next_mm }) =>
    `Measured exposures must be in order of thickness, each thicker than the one before, but ${mm(next_mm)} follows ${mm(previous_mm)}.`,
  "bad-growth": ({ least_mm, most_mm, value_mm }) =>
    `The growth of a print must be ${exact(least_mm)} to ${mm(most_mm)}, not ${mm(value_mm)}.`,
  "bad-options": ({ system }) => `The options cannot be read: ${ended(system)}`,
  "unknown-printer": ({ printer, similar, known }) =>
    `There is no printer ${printer} among the ${count(known)} known ones${similar.length === 0 ? "" : `; similar are ${similar.join(", ")}`}.`,
  "bad-printer": ({ printer, field }) => `The printer ${printer} cannot have this ${field}; correct its description.`,
  "printer-not-json": ({ system }) => `This file does not describe a printer in JSON: ${ended(system)}`,
  "printer-too-long": ({ bytes, most_bytes }) => `A printer’s description has at most ${count(most_bytes)} bytes, and this file has ${count(bytes)}; choose another file.`,
  "pixels-without-pitch": () => "Pixels and their pitch in x and y belong together; give both, or one pitch for x and y.",
  "bad-antialias": ({ antialias, known }) => `Anti-aliasing has the levels ${known.join(", ")}, not ${exact(antialias)}.`,
  "bad-size": ({ option, value_mm, least_mm, most_mm }) => `${option} must be from ${mm(least_mm)} to ${mm(most_mm)}, not ${mm(value_mm)}.`,
  "bad-weight-min": ({ weight_min }) => `The minimum weight must be from 0 to 1, not ${exact(weight_min)}.`,
  "bad-directions": ({ directions, most }) => `A search looks along 1 to ${count(most)} directions, not ${count(directions)}.`,
  "bad-limit": ({ limit, value, least, most }) => `${limit} is ${exact(value)}, but must be from ${exact(least)} to ${exact(most)}.`,
  "bad-alpha": ({ alpha }) => `Alpha must be from 0 to 1, not ${exact(alpha)}.`,
  "bad-search-limit": ({ limit, value }) => `${limit} is ${exact(value)}, but must be 0 or more.`,
  "search-task": ({ task }) => `Task ${exact(task)} is not out: hand in each task's result once.`,
  "search-candidate": ({ place }) => `Candidate ${exact(place)} is not one that was measured for its direction.`,
  "several-targets": () => "Give a tolerance, the most layers or the longest time, and only one of them.",
  "contradictory-options": ({ option, other }) => `${option} does not go with ${other}; leave one of them out.`,
  "printer-layers": ({ model, printer_min_mm, printer_max_mm, layer_min_mm, layer_max_mm }) =>
    `The ${model} prints layers of ${exact(printer_min_mm)} to ${mm(printer_max_mm)}, not ${exact(layer_min_mm)} to ${mm(layer_max_mm)}; ` +
    "stay within its limits, or choose another printer.",
  "printer-step": ({ model, printer_step_mm, step_mm }) =>
    `The ${model} moves in steps of ${mm(printer_step_mm)}, and ${mm(step_mm)} is not a whole number of them; use a multiple of ${mm(printer_step_mm)}.`,
  "resin-printer": ({ format, model }) =>
    `${format} files are for filament printers, and the ${model} prints resin; leave the printer out, or choose a format that it reads.`,
  "nozzle-without-filament": ({ formats }) =>
    `A nozzle goes with the formats for filament printers only: ${formats.join(", ")}; choose one of them, or leave the nozzle out.`,
  "bad-nozzle": ({ nozzle_mm, least_mm, most_mm }) => `The nozzle must be ${exact(least_mm)} to ${mm(most_mm)} wide, not ${mm(nozzle_mm)}.`,
  "nozzle-layers": ({ slicers, nozzle_mm, nozzle_min_mm, nozzle_max_mm, layer_min_mm, layer_max_mm }) =>
    `Through a nozzle of ${mm(nozzle_mm)} ${either(slicers)} prints layers of ${exact(nozzle_min_mm)} to ${mm(nozzle_max_mm)}, ` +
    `not ${exact(layer_min_mm)} to ${mm(layer_max_mm)}; stay within its limits, or name another nozzle.`,
  "grid-bad-size": ({ width, height, max_side, max_pixels }) =>
    `A mask of ${count(width)} × ${count(height)} pixels is not possible: there can be 1 to ${count(max_side)} a side, and ${count(max_pixels)} in all.`,
  "grid-too-fine": ({ width, height, max_side, max_pixels }) =>
    `Anti-aliasing asks for ${count(width)} × ${count(height)} rays, and there can be ${count(max_side)} a side, and ${count(max_pixels)} in all; choose a lower level.`,
  "model-too-large": ({ model_mm_x, model_mm_y, grid_mm_x, grid_mm_y, fitting_scale }) =>
    `The model is ${exact(model_mm_x)} × ${mm(model_mm_y)}, but the grid covers only ${exact(grid_mm_x)} × ${mm(grid_mm_y)}; a scale of ${exact(fitting_scale)} fits.`,
  "model-too-high": ({ model_mm_z, printer_mm_z, fitting_scale }) =>
    `The model is ${mm(model_mm_z)} high, but the printer only prints ${mm(printer_mm_z)}; a scale of ${exact(fitting_scale)} fits.`,
  "plate-empty": () => "There is no model on the plate; add one.",
  "plate-without-size": () => "The size of the plate is not known; choose a printer, or give pixels and pitch.",
  "bad-spacing": ({ spacing_mm }) => `The spacing must be 0 to 100 mm, not ${mm(spacing_mm)}.`,
  "bad-turn": ({ turn_deg }) => `Models turn in steps of 0, 15, 30, 45, 60, 90, 120 or 180°, not ${exact(turn_deg)}°.`,
  "plate-too-small": ({ model_number, size_mm, plate_mm }) =>
    `Model ${count(model_number)} is ${exact(size_mm[0])} × ${mm(size_mm[1])}, and the plate ${exact(plate_mm[0])} × ${mm(plate_mm[1])}; scale it, or choose another orientation or printer.`,
  "too-many-copies": ({ copies, most_copies }) =>
    `${count(copies)} copies are too many for a job, which has ${count(most_copies)} at most; make several jobs of them.`,
  "plate-other-copies": ({ model_number, copies, places }) =>
    `Model ${count(model_number)} is to be printed ${count(copies)} times, and has ${count(places)} places; correct one of them, or arrange the plate.`,
  "plate-gap": ({ plate_number }) => `Nothing stands on plate ${count(plate_number)}, but on one after it; number plates without gaps.`,
  "plate-outside": ({ model_number, copy_number, plate_number }) =>
    `Copy ${count(copy_number)} of model ${count(model_number)} extends beyond plate ${count(plate_number)}; move it, or arrange the plate.`,
  "plate-collision": ({ model_numbers, copy_numbers, plate_number }) =>
    `Copy ${count(copy_numbers[0])} of model ${count(model_numbers[0])} and copy ${count(copy_numbers[1])} of model ${count(model_numbers[1])} overlap on plate ${count(plate_number)}; move one, or arrange the plate.`,
  "plate-no-model": ({ model_number, models }) => `There is no model ${count(model_number)}; the plate has ${count(models)}.`,
  "no-such-plate": ({ plate_number, plates }) => `There is no plate ${count(plate_number)}; there are ${count(plates)}.`,
  "too-many-bins": ({ height_mm, bin_mm }) => `${mm(height_mm)} in bins of ${mm(bin_mm)} are too many; choose a larger bin.`,
  "not-whole-bins": ({ quantity, length_mm, bin_mm }) =>
    `${QUANTITIES[quantity]} of ${mm(length_mm)} is no whole number of bins of ${mm(bin_mm)}; choose a bin that divides it.`,
  "not-whole-steps": ({ quantity, length_mm, step_mm }) =>
    `${QUANTITIES[quantity]} of ${mm(length_mm)} is no whole number of steps of ${mm(step_mm)}; choose a multiple of ${mm(step_mm)}.`,
  "layer-range-upside-down": ({ layer_min_mm, layer_max_mm }) =>
    `The least layer thickness of ${mm(layer_min_mm)} is more than the greatest of ${mm(layer_max_mm)}; lower one or raise the other.`,
  "layer-range-empty": ({ layer_min_mm, layer_max_mm, step_mm }) =>
    `No whole number of steps of ${mm(step_mm)} lies between the layer thicknesses ${exact(layer_min_mm)} and ${mm(layer_max_mm)}; ` +
    "widen the range or choose a smaller step.",
  "layer-too-thick": ({ layer_mm, height_mm }) => `Layers of ${mm(layer_mm)} are too thick for a model that is ${mm(height_mm)} high.`,
  "layers-do-not-fit": ({ from_mm, to_mm, layer_min_mm, layer_max_mm }) =>
    `Layers of ${exact(layer_min_mm)} to ${mm(layer_max_mm)} do not add up to the height from ${exact(from_mm)} to ${mm(to_mm)}; ` +
    "widen the range of thicknesses or move the planes.",
  "thicknesses-do-not-fit": ({ from_mm, to_mm, model_number, tolerance, thicknesses_mm, least_tolerance }) =>
    `Layers of ${thicknesses_mm.map(exact).join(", ")} mm do not lead from z = ${exact(from_mm)} to ${mm(to_mm)} within the tolerance of ${exact(tolerance)}${model_number === null ? "" : ` on model ${count(model_number)}`}; ` +
    (least_tolerance === null
      ? "add a thickness or move the planes."
      : `raise the tolerance to ${exact(least_tolerance)} or add a thickness.`),
  "too-few-thicknesses": ({ thicknesses, enough }) =>
    `No plan within the tolerance has at most ${count(thicknesses)} layer thicknesses; allow ${count(enough)}, or raise the tolerance.`,
  "not-gradual": ({ change_mm, least_change_mm }) =>
    `No plan within the tolerance changes the layer thickness by at most ${mm(change_mm)} from layer to layer; allow changes of ${mm(least_change_mm)}, or raise the tolerance.`,
  "bad-range": ({ from_mm, to_mm }) =>
    `The height range from ${exact(from_mm)} to ${mm(to_mm)} is empty or overlaps another; give ranges upward and apart.`,
  "bad-plane": ({ z_mm, height_mm }) => `There can be no plane at ${mm(z_mm)} in a model that is ${mm(height_mm)} high.`,
  infeasible: ({ from_mm, to_mm, model_number, tolerance, layer_min_mm }, metric) =>
    `No plan keeps every layer's error${model_number === null ? "" : ` on model ${count(model_number)}`} within ${error(metric, tolerance)}: from z = ${exact(from_mm)} to ${mm(to_mm)} even a layer of ${mm(layer_min_mm)} exceeds it.`,
  "out-of-reach": (detail) =>
    "layers" in detail
      ? `No plan has at most ${count(detail.layers)} layers; it takes at least ${count(detail.least_layers)}.`
      : `No plan prints in at most ${measure(detail.time_s, "s")}; it takes at least ${measure(detail.least_time_s, "s")}.`,
  "no-plan": () => "There is no plan yet; make one first.",
  "memory-bound": ({ needed_bytes, allowed_bytes }) =>
    `This takes about ${count(needed_bytes)} bytes of memory, and ${count(allowed_bytes)} are allowed; allow more, or choose larger pixels.`,
  "time-bound": ({ work, needed_s, allowed_s }) => {
    const [subject, way] = WORK[work];
    return `${subject} takes about ${count(needed_s)}\u00a0s of processor time, and ${count(allowed_s)} are allowed; allow more${way}.`;
  },
  "no-layer": ({ layer, layers }) => `There is no layer ${count(layer)}; the plan has ${count(layers)}, from 0.`,
  "no-hits": ({ pitch_mm }) =>
    `No pixel of ${mm(pitch_mm)} meets the model, which is too small or too thin for them; choose smaller pixels.`,
  "too-many-facets": ({ facets, most }) => `${count(facets)} facets are too many; at most ${count(most)} can be sliced.`,
  "out-of-memory": ({ hits, needed_bytes }) =>
    `The model needs ${count(needed_bytes)} bytes for ${count(hits)} surface points at this resolution, more than there is; choose fewer rays.`,
  "no-gpu": ({ system }) => `No usable GPU: ${ended(system)}`,
  "gpu-emulated": ({ adapter }) => `No usable GPU: ${adapter} is emulated in software.`,
  "gpu-too-small": ({ facets, needed_bytes, limit_bytes }) =>
    `${counted(facets, FACETS)} need a GPU buffer of ${count(needed_bytes)} bytes, and this GPU offers ${count(limit_bytes)}; use the CPU.`,
  "gpu-failed": ({ fault, system }) => `The GPU failed: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
  "all-black": () =>
    "All masks are black: the model encloses nothing that the middle of a layer meets; check the model, or choose thinner layers.",
  "uniform-only": ({ format, others, best }) =>
    `${format} files have one thickness for all layers, and this plan has several; choose ${others.join(", ")}, or ${inPlace(best, { count, mm })}.`,
  "printer-uniform-only": ({ model, best }) =>
    `The ${model} takes one thickness for all layers, and this plan has several; choose ${inPlace(best, { count, mm })}.`,
  "weights-not-weights": () => "This is no file of weights: it does not begin with CUSPWT01, or is cut short.",
  "weights-other-mesh": ({ weights_facets, mesh_facets }) =>
    `These weights are for another mesh, of ${counted(weights_facets, FACETS)}; this one has ${count(mesh_facets)}; ` +
    "paint it again, or open the model that they were made for.",
  "weights-out-of-range": ({ facet, weight }) => `The weight of facet ${count(facet)} is ${exact(weight)}, and weights are 0 to 1.`,
  "price-out-of-bounds": ({ field, value, least, most }) =>
    `${field} is ${exact(value)}, but must be from ${exact(least)} to ${exact(most)}; correct the prices or the order.`,
  "bad-prices": ({ field }) =>
    `Prices cannot have this ${field}; a currency is three capitals of ISO 4217, quantity breaks ascend, and every finish has a name of its own.`,
  "no-finish": ({ finish, known }) => `There is no finish ${finish}; ${known.length > 0 ? `known are ${known.join(", ")}` : "the prices name none"}.`,
  "no-masks": ({ format }) =>
    `${format} files hold a model and its layers, and no masks; slice the model itself into this format, or choose another.`,
  "other-first-layer": ({ layer_mm, first_layer_mm }) =>
    `The first layer of this plan is ${mm(layer_mm)} thick, not ${mm(first_layer_mm)} as set; the model is lower than that, so choose a thinner first layer.`,
  "archive-write": ({ system }) => `The print file could not be written: ${ended(system)}`,
  cancelled: () => "Cancelled.",
  "bad-attribute": ({ attribute, value, known }) =>
    `The attribute ${attribute} cannot be ${String(value)}${known === undefined ? "" : `; known are ${known.join(", ")}`}.`,
  "part-failed": ({ part, system }) => `A part of the page could not be loaded: ${part} (${system}).`,
  "no-browser": () => "There is no browser here; call this in the page.",
  "no-model": () => "There is no model yet; open one first.",
  "file-unreadable": () => "It may have been moved, changed or locked. Choose it again.",
  "bad-source": ({ given }) =>
    `A model cannot be read from ${given}; pass a file, its bytes or a stream of them, an address, a response, or the positions of its facets.`,
  "bad-facets": ({ list, numbers, multiple_of }) => `The list ${list} has ${count(numbers)} numbers, and needs a multiple of ${exact(multiple_of)}.`,
  "bad-index": ({ place, index, vertices }) =>
    `The index at place ${count(place)} is ${exact(index)}, which is no vertex: there are ${count(vertices)}, from 0.`,
  "bad-number": ({ argument, value }) => `The argument ${argument} is ${String(value)}, and must be a whole number from 0.`,
  "dropped-link": () => "This is a link, not a file. Download the model, and drop the file here.",
  "folder-without-model": () => "The folder holds no STL, 3MF or OBJ file. Drop the one with the models, or a model itself.",
  "fetch-failed": (detail) =>
    "status" in detail ? `The address did not answer with a file (HTTP ${detail.status}).` : `The address did not answer (${detail.system}).`,
  "worker-failed": ({ system }) => `Reload the page. If that does not help, tell its operator: a script is missing, or the page’s policy forbids the worker. (${system})`,
  "start-failed": ({ system }) => `Reload the page. If that does not help, this browser may be too old for WebAssembly. (${system})`,
  crash: ({ system }) =>
    `It may have run out of memory. It has been restarted: try again, with fewer rays if the model is large. (${system})`,
});
