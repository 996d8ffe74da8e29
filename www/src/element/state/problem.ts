/** Failures explained: a sentence, the field that caused it, and offers that may fix it. Fetched with the first failure. */
import type { ErrorCode, SlicerError } from "../../api/error.js";
import type { Language } from "../../texts/index.js";
import { filled } from "../../texts/messages.js";
import { errorOf, problemTexts } from "../../texts/problems.js";
import type { Busy } from "../parts/progress.js";
import { allowed, bestUniform, type Offer } from "./offers.js";
import { METRICS } from "./metric.js";
import * as round from "./round.js";
import { parse, withTolerance, type Field, type Settings } from "./settings.js";
import { shown } from "../../api/visible.js";

export interface Problem {
  code: ErrorCode;
  title: string;
  text: string;
  offers: Offer[];
  /** Setting that caused the failure; null if none did. */
  field: Field | Choice | null;
}

/** Settings chosen from a list. */
export type Choice = "metric" | "rays" | "printer" | "format" | "resin" | "unit" | "supports" | "infill" | "drain";

/** A failure with the state at that time. */
export interface Failure {
  error: SlicerError;
  /** The failed task; null if there was none. */
  task: Busy["task"] | null;
  /** The file's name. */
  name: string;
  /** The settings at that time. */
  settings: Settings;
  /** Intended height of the model in mm; null if none was open. */
  height_mm: number | null;
}

type Kind = keyof ReturnType<typeof problemTexts>["headings"];

const KINDS: Readonly<Record<ErrorCode, Kind>> = {
  "file-empty": "empty",
  "stl-no-facets": "empty",
  "stl-truncated": "cutShort",
  "unknown-file-kind": "unreadable",
  "other-file-kind": "unreadable",
  "no-plate": "empty",
  "stl-wrong-facet-count": "damaged",
  "stl-not-finite": "damaged",
  "stl-syntax": "damaged",
  "threemf-no-directory": "cutShort",
  "threemf-no-part": "damaged",
  "threemf-damaged-part": "damaged",
  "threemf-packed": "damaged",
  "threemf-too-large": "damaged",
  "threemf-xml": "damaged",
  "threemf-bad-attribute": "damaged",
  "threemf-no-vertex": "damaged",
  "threemf-no-object": "damaged",
  "threemf-nested": "damaged",
  "threemf-too-many": "unusable",
  "threemf-overflow": "unusable",
  "threemf-feature": "unusable",
  "threemf-encrypted": "unusable",
  "threemf-extension": "unusable",
  "threemf-no-facets": "empty",
  "obj-bad-vertex": "damaged",
  "obj-bad-corner": "damaged",
  "obj-few-corners": "damaged",
  "obj-free-form": "unusable",
  "obj-too-many": "unusable",
  "obj-no-faces": "empty",
  "mesh-no-area": "unusable",
  "mesh-zero-height": "unusable",
  "mesh-overflow": "unusable",
  "bad-height": "badValue",
  "bad-rotation": "badOptions",
  "bad-size": "badValue",
  "bad-time": "badValue",
  "bad-exposures": "badValue",
  "bad-compensation": "badValue",
  "bad-directions": "badValue",
  "bad-alpha": "badValue",
  "bad-search-limit": "badValue",
  "bad-limit": "badValue",
  "bad-options": "badOptions",
  "unknown-printer": "noSuchPrinter",
  "bad-printer": "badPrinter",
  "printer-not-json": "badPrinter",
  "printer-too-long": "badPrinter",
  "pixels-without-pitch": "badOptions",
  "bad-antialias": "badValue",
  "bad-weight-min": "badValue",
  "bad-length": "badValue",
  "several-targets": "badOptions",
  "contradictory-options": "badOptions",
  "printer-layers": "badOptions",
  "printer-step": "badOptions",
  "resin-printer": "badOptions",
  "nozzle-without-filament": "badOptions",
  "bad-nozzle": "badValue",
  "nozzle-layers": "badOptions",
  "bad-attribute": "badOptions",
  "grid-bad-size": "tooFine",
  "grid-too-fine": "tooFine",
  "too-many-bins": "tooFine",
  "too-many-facets": "tooFine",
  "out-of-memory": "tooFine",
  "memory-bound": "tooFine",
  "time-bound": "tooFine",
  "model-too-large": "tooLarge",
  "model-too-high": "tooHigh",
  "plate-empty": "plate",
  "plate-without-size": "plate",
  "plate-too-small": "tooLarge",
  "too-many-copies": "plate",
  "plate-other-copies": "plate",
  "plate-gap": "plate",
  "plate-outside": "plate",
  "plate-collision": "plate",
  "plate-no-model": "badOptions",
  "no-such-plate": "badOptions",
  "bad-spacing": "badValue",
  "bad-turn": "badValue",
  "not-whole-bins": "notWhole",
  "not-whole-steps": "notWhole",
  "layer-range-upside-down": "rangeEmpty",
  "layer-range-empty": "rangeEmpty",
  "layer-too-thick": "layerTooThick",
  "layers-do-not-fit": "doNotFit",
  "thicknesses-do-not-fit": "doNotFit",
  "too-few-thicknesses": "infeasible",
  "not-gradual": "infeasible",
  "bad-range": "badRange",
  "bad-plane": "badPlane",
  infeasible: "infeasible",
  "out-of-reach": "outOfReach",
  "no-hits": "noHits",
  "all-black": "allBlack",
  "no-gpu": "gpu",
  "gpu-emulated": "gpu",
  "gpu-failed": "gpu",
  "gpu-too-small": "gpuTooSmall",
  "uniform-only": "uniformOnly",
  "printer-uniform-only": "printerUniformOnly",
  "no-masks": "other",
  "other-first-layer": "layerTooThick",
  "file-unreadable": "unreadable",
  "bad-source": "other",
  "bad-facets": "other",
  "bad-index": "other",
  "bad-number": "other",
  "dropped-link": "unreadable",
  "folder-without-model": "unreadable",
  "fetch-failed": "notFetched",
  "start-failed": "startFailed",
  "worker-failed": "startFailed",
  crash: "crash",
  "part-failed": "other",
  "no-browser": "other",
  "floating-pieces": "floats",
  "no-layer": "other",
  "no-plan": "other",
  "no-model": "other",
  "weights-not-weights": "notWeights",
  "weights-other-mesh": "otherMesh",
  "weights-out-of-range": "notWeights",
  "price-out-of-bounds": "badValue",
  "bad-prices": "badOptions",
  "no-finish": "badOptions",
  "search-task": "other",
  "search-candidate": "other",
  "archive-write": "other",
  cancelled: "other",
};

/** Setting to which a kind of failure relates. */
const FIELDS: Partial<Record<Kind, Problem["field"]>> = {
  tooLarge: "printer",
  tooHigh: "printer",
  tooFine: "rays",
  noHits: "rays",
  floats: "supports",
  rangeEmpty: "layerMax",
  doNotFit: "layerMin",
  infeasible: "tolerance",
  layerTooThick: "layerMax",
  uniformOnly: "format",
  printerUniformOnly: "printer",
  noSuchPrinter: "printer",
  badPrinter: "printer",
};

/**
 * Explains a failure.
 *
 * @param fixed settings that only the page may change, so that no offer changes them
 */
export function explain(failure: Failure, language: Language, fixed: ReadonlySet<keyof Settings>): Problem {
  const problem = describe(failure, language, fixed);
  return { ...problem, offers: allowed(problem.offers, fixed) };
}

function describe(failure: Failure, language: Language, fixed: ReadonlySet<keyof Settings>): Problem {
  const { error, name, settings } = failure;
  // The form always gives valid options, except for a printer's description.
  const isOfPrinter = error.code === "bad-options" && typeof settings.printer === "object";
  const kind = isOfPrinter ? "badPrinter" : KINDS[error.code];
  const text = errorOf(error.code, error.detail, settings.metric, language);
  const problem = { code: error.code, title: filled(problemTexts(language).headings[kind], { name: shown(name) }), field: FIELDS[kind] ?? null };
  if (error.code === "infeasible") return { ...problem, ...waysOut(error, text, settings, language, fixed) };
  return { ...problem, text, offers: offersFor(kind, error, failure, language) };
}

function offersFor(kind: Kind, error: SlicerError, failure: Failure, language: Language): Offer[] {
  switch (kind) {
    case "doNotFit":
      return halfAsThin(failure.settings, language);
    case "tooFine":
    case "crash":
      return fewerRays(failure.settings, language);
    case "tooLarge":
    case "tooHigh":
      return [...smaller(scaleThatFits(error), failure, language), withoutPrinter(language)];
    case "floats":
      return [{ label: language.texts.offers.floating, change: { floating: "allow" } }];
    case "noSuchPrinter":
      return [...similarPrinters(error), withoutPrinter(language)];
    case "badPrinter":
      // A refused file has not replaced the previous printer.
      return failure.task === null ? [] : [withoutPrinter(language)];
    case "uniformOnly":
      // Test towers need several thicknesses, so uniform layers or images would not help.
      if (failure.task === "towers") return [];
      return [uniformLayers(error, failure.settings, language), { label: language.texts.offers.images, change: { format: "png" } }];
    case "printerUniformOnly":
      return [uniformLayers(error, failure.settings, language)];
    default:
      return [];
  }
}

type Infeasible = Extract<SlicerError, { code: "infeasible" }>;

/** Adds the core's fixes to the sentence `place`, which says where no plan keeps the tolerance, and offers them. */
function waysOut(
  { detail }: Infeasible,
  place: string,
  settings: Settings,
  language: Language,
  fixed: ReadonlySet<keyof Settings>,
): Pick<Problem, "text" | "offers"> {
  const { texts, format } = language;
  const { scale, error: written } = METRICS[settings.metric];
  const offers: Offer[] = [];

  // A model's own tolerance is set by the page.
  const least = fixed.has("tolerances") || detail.model_number !== null ? null : detail.least_tolerance;
  if (least !== null) {
    const short = round.up(least * scale);
    const label = texts.offers.tolerance({ error: written(short / scale, format) });
    offers.push({ label, change: withTolerance(settings, String(short)) });
  }
  const largest = fixed.has("layerMin") ? null : detail.largest_layer_min_mm;
  if (largest !== null) offers.push(layersFrom(largest, language));

  const way = least === null ? (largest === null ? "neither" : "thinner") : largest === null ? "larger" : "either";
  const isClosed = way === "neither" && fixed.has("layerMin");
  return { text: isClosed ? place : `${place} ${problemTexts(language).infeasible[way]}`, offers };
}

const layersFrom = (mm: number, { texts, format }: Language): Offer => ({
  label: texts.offers.layersFrom({ thickness: format.fine(mm) }),
  change: { layerMin: String(mm) },
});

function halfAsThin(settings: Settings, language: Language): Offer[] {
  const half = round.micrometreBelow((parse(settings.layerMin) ?? 0) / 2);
  return half > 0 ? [layersFrom(half, language)] : [];
}

function fewerRays(settings: Settings, { texts, format }: Language): Offer[] {
  const half = Number(settings.rays) / 2;
  return half >= 512 ? [{ label: texts.offers.rays({ count: format.count(half) }), change: { rays: String(half) } }] : [];
}

/** Scale at which a model that is too large fits; null for any other error. */
function scaleThatFits(error: SlicerError): number | null {
  return error.code === "model-too-large" || error.code === "model-too-high" ? error.detail.fitting_scale : null;
}

/** Offers the height at which the model fits, rounded down to 0.1 mm. */
function smaller(scale: number | null, { height_mm }: Failure, { texts, format }: Language): Offer[] {
  if (scale === null || height_mm === null) return [];
  const fitting = Math.floor(10 * height_mm * scale) / 10;
  return fitting > 0 ? [{ label: texts.offers.scale({ height: format.fine(fitting) }), change: { height: String(fitting) } }] : [];
}

const withoutPrinter = ({ texts }: Language): Offer => ({ label: texts.offers.noPrinter, change: { printer: "" } });

/** Maximum number of names offered; the sentence has all of them. */
const MOST_SIMILAR = 3;

/** Offers the names most similar to an unknown one. */
function similarPrinters(error: SlicerError): Offer[] {
  const similar = error.code === "unknown-printer" ? error.detail.similar : [];
  return similar.slice(0, MOST_SIMILAR).map((printer) => ({ label: printer, change: { printer } }));
}

/** Offers the best uniform layers; if none keep the tolerance, those of the thickness in the form. */
function uniformLayers(error: SlicerError, settings: Settings, language: Language): Offer {
  const isRefused = error.code === "uniform-only" || error.code === "printer-uniform-only";
  const best = isRefused ? error.detail.best : null;
  if (best) return bestUniform(best, language);
  const { texts, format } = language;
  return { label: texts.offers.uniform({ thickness: format.fine(parse(settings.uniform) ?? 0) }), change: { planner: "uniform" } };
}
