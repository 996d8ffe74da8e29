/** Failures in words: what happened, and what to do about it. */
import * as format from "./format.js";
import { parse, type Settings } from "./settings.js";
import type { CuspError } from "./wire.js";

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

/** Words for an error of the core or the client. `name` is the file's, `settings` those that were in force. */
export function explain(error: CuspError, name: string, settings: Settings): Problem {
  const { code, message } = error;
  const problem = (title: string, text: string, offers: Offer[] = []): Problem => ({ code, title, text, offers });
  // The core's messages say what happened, where (byte or line), and mostly what to do; ours are the headings.
  const detail = sentence(message);

  if (code === "infeasible") return infeasible(error, settings);
  if (code === "infeasible-remainder") return remainder(detail, settings, code);
  if (code === "stl-empty" || code === "stl-no-facets") return problem(`${name} is empty`, detail);
  if (code === "stl-truncated") return problem(`${name} is cut short`, detail);
  if (code === "stl-not-stl") return problem(`${name} is not an STL file`, detail);
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
  if (code === "no-hits") return problem(`${name} is too thin for these pixels`, detail);
  if (code === "all-black") return problem("Every mask would be black", detail);
  if (code === "layer-too-thick") return problem("The layers are too thick for this model", detail);
  if (code === "no-gpu" || code === "gpu-failed") return problem("The GPU could not be used", detail);
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

function infeasible(error: CuspError, settings: Settings): Problem {
  const at = error.detail?.["height_mm"];
  const where = typeof at === "number" ? `, at a height of ${format.height(at)}` : "";
  const min = parse(settings.layerMin) ?? 0;
  const tolerance = parse(settings.tolerance) ?? 0;
  // A level surface costs a layer its whole thickness, so a tolerance of at least the thinnest layer nearly always
  // holds; where that is already so, a little more room is the next thing to try.
  const more = round(tolerance < min ? min : tolerance * 1.25);
  const thinner = round(Math.min(min, tolerance) / (tolerance < min ? 1 : 2));
  return {
    code: error.code,
    title: `No plan keeps ${format.fine(tolerance)}${where}`,
    text:
      `Even layers of ${format.fine(min)}, the thinnest allowed, leave a larger error there. ` +
      "Allow a larger error, or thinner layers if your printer can make them.",
    offers: [
      { label: `Tolerance ${format.fine(more)}`, change: { tolerance: String(more) } },
      { label: `Layers from ${format.fine(thinner)}`, change: { layerMin: String(thinner) } },
    ],
  };
}

function remainder(text: string, settings: Settings, code: string): Problem {
  const min = parse(settings.layerMin) ?? 0;
  const thinner = round(min / 2);
  return {
    code,
    title: "These layers do not add up to the model’s height",
    text,
    offers: thinner < min ? [{ label: `Layers from ${format.fine(thinner)}`, change: { layerMin: String(thinner) } }] : [],
  };
}

function fewerRays(settings: Settings): Offer[] {
  const half = Number(settings.rays) / 2;
  return half >= 512 ? [{ label: `${format.count(half)} rays`, change: { rays: String(half) } }] : [];
}

const round = (mm: number): number => Math.max(0.002, Math.round(mm * 1000) / 1000);

/** Makes a message of the core, which is lower case and without a full stop, a sentence. */
export function sentence(message: string): string {
  const tidy = message.trim();
  if (tidy === "") return "";
  return tidy.charAt(0).toUpperCase() + tidy.slice(1) + (/[.!?]$/.test(tidy) ? "" : ".");
}
