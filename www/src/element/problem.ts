/** Failures in words: what happened, and what to do about it. */
import * as format from "../texts/format.js";
import { METRICS } from "./metric.js";
import * as round from "./round.js";
import { binOf, parse, withTolerance, type Settings } from "./settings.js";
import type { CuspError } from "../api/wire.js";

/** A change of settings that may well help, offered as a button. */
export interface Offer {
  label: string;
  change: Partial<Settings>;
}

export interface Problem {
  code: string;
  title: string;
  text: string;
  offers: Offer[];
}

/** Headings over the core's own words, which say what happened, where (byte or line), and mostly what to do. */
const HEADINGS: Readonly<Record<string, (name: string) => string>> = {
  "stl-empty": (name) => `${name} is empty`,
  "stl-no-facets": (name) => `${name} is empty`,
  "stl-truncated": (name) => `${name} is cut short`,
  "stl-not-stl": (name) => `${name} is not an STL file`,
  "no-hits": (name) => `${name} is too thin for these pixels`,
  "all-black": () => "Every mask would be black",
  "layer-too-thick": () => "The layers are too thick for this model",
  "layer-range-empty": () => "No layer of whole motor steps lies in this range",
  "not-whole-bins": () => "These lengths do not go together",
  "bad-range": () => "These height ranges do not go together",
  "bad-plane": () => "There can be no plane at this height",
  "bad-time": () => "These times make no sense",
  "out-of-reach": () => "No plan is as short as that",
  "no-gpu": () => "The GPU could not be used",
  "gpu-failed": () => "The GPU could not be used",
  "gpu-too-small": () => "The GPU is too small for this model",
};

/** Words for an error of the core or the client. `name` is the file's, `settings` those that were in force. */
export function explain(error: CuspError, name: string, settings: Settings): Problem {
  const { code, message } = error;
  const problem = (title: string, text: string, offers: Offer[] = []): Problem => ({ code, title, text, offers });
  const detail = sentence(message);

  if (code === "infeasible") return infeasible(error, settings);
  if (code === "layers-do-not-fit") {
    return problem("These layers do not add up to the model’s height", detail, halfAsThin(settings));
  }
  const heading = HEADINGS[code];
  if (heading !== undefined) return problem(heading(name), detail);
  if (code.startsWith("stl-")) {
    return problem(`${name} is damaged`, `${detail} Export the model again as STL and drop the new file.`);
  }
  if (code.startsWith("mesh-")) return problem(`${name} cannot be sliced`, detail);
  if (code === "file-unreadable") {
    return problem(`${name} could not be opened`, "It may have been moved, changed or locked. Choose it again.");
  }
  if (code === "out-of-memory" || code.startsWith("grid-")) {
    return problem("This resolution is too much for this computer", detail, fewerRays(settings));
  }
  if (code === "start-failed") {
    return problem(
      "The slicer could not be started",
      `Reload the page. If that does not help, this browser may be too old for WebAssembly. (${message})`,
    );
  }
  if (code === "crash") {
    return problem(
      "The slicer stopped",
      `It may have run out of memory. It has been started afresh: try again, with fewer rays if the model is large. (${message})`,
      fewerRays(settings),
    );
  }
  return problem("That did not work", detail);
}

/** For a drop that holds no STL at all. */
export function notAnStl(name: string): Problem {
  return {
    code: "not-stl",
    title: `${name} is not an STL file`,
    text: "Cusp reads binary and text STL files: export your model as STL and drop that.",
    offers: [],
  };
}

/** The core knows where it fails and what would do: the page puts that in words. */
function infeasible({ code, detail }: CuspError, settings: Settings): Problem {
  const figure = (key: string): number | null => {
    const value = detail?.[key];
    return typeof value === "number" ? value : null;
  };
  const { error, scale } = METRICS[settings.metric];
  const offers: Offer[] = [];
  const ways: string[] = [];

  const least = figure("least_tolerance");
  if (least !== null) {
    const short = round.up(least * scale);
    offers.push({ label: `Tolerance ${error(short / scale)}`, change: withTolerance(settings, String(short)) });
    ways.push("a larger error");
  }
  const largest = figure("largest_layer_min_mm");
  if (largest !== null) {
    offers.push(layersFrom(thinEnough(largest, settings)));
    ways.push("thinner layers if your printer can make them");
  }
  const place = format.interval(figure("from_mm") ?? 0, figure("to_mm") ?? 0);
  const thinnest = format.fine(figure("layer_min_mm") ?? 0);
  return {
    code,
    title: `No plan keeps ${error(figure("tolerance") ?? 0)} all the way up`,
    text:
      `From ${place} even a layer of ${thinnest}, the thinnest allowed, leaves a larger error. ` +
      (ways.length === 0 ? "Change the range of layers." : `Allow ${ways.join(", or ")}.`),
    offers,
  };
}

/**
 * A thinnest layer, in mm, that is at most the largest one that the core says will do. That holds for the bins that it
 * looked at, so where this thickness would bring other bins, one that does not is taken.
 */
function thinEnough(largest_mm: number, settings: Settings): number {
  const below = round.micrometreBelow(largest_mm);
  const sameBins = binOf({ ...settings, layerMin: String(below) }) === binOf(settings);
  return sameBins ? below : round.micrometreBelow(below - 0.001);
}

const layersFrom = (mm: number): Offer => ({
  label: `Layers from ${format.fine(mm)}`,
  change: { layerMin: String(mm) },
});

function halfAsThin(settings: Settings): Offer[] {
  const half = round.micrometreBelow((parse(settings.layerMin) ?? 0) / 2);
  return half > 0 ? [layersFrom(half)] : [];
}

function fewerRays(settings: Settings): Offer[] {
  const half = Number(settings.rays) / 2;
  return half >= 512 ? [{ label: `${format.count(half)} rays`, change: { rays: String(half) } }] : [];
}

/** Makes a message of the core, which is lower case and without a full stop, a sentence. */
export function sentence(message: string): string {
  const tidy = message.trim();
  if (tidy === "") return "";
  return tidy.charAt(0).toUpperCase() + tidy.slice(1) + (/[.!?]$/.test(tidy) ? "" : ".");
}
