/** Remembers the user's printer with its resin, exposures and motor step for the next visit, unless the URL sets others. */
import type { SlicerElement } from "../element/slicer-element.js";
import { isEqual } from "../element/state/plain.js";
import { check, DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "../element/state/settings.js";
import { readKept, writeKept } from "./storage.js";

const REMEMBERED = ["printer", "resin", "exposure", "bottomExposure", "bottomLayers", "penetration", "overcure", "retained", "step"] as const satisfies readonly (keyof Settings)[];

/**
 * The part of a query to remember, without fields that are out of range; empty if all are at their defaults.
 *
 * @param printer the printer, if its description is too long for the query
 */
export function rememberedOf(query: string, printer?: Settings["printer"]): string {
  const settings = fromAddress(query);
  const own = { ...DEFAULT_SETTINGS, ...Object.fromEntries(REMEMBERED.map((key) => [key, settings[key]])) };
  if (printer !== undefined) own.printer = printer;
  const checked = check(own);
  for (const key of REMEMBERED) if (!checked.ok && key in checked.faults) own[key] = "";
  const kept = new URLSearchParams(toAddress(own));
  if (typeof own.printer === "object") kept.set("printer", JSON.stringify(own.printer));
  return kept.toString();
}

/**
 * Initial settings: those of the URL, with the remembered ones if the URL sets none of these. They are used all or none, since an exposure
 * is valid for only one printer and resin.
 */
export function recalled(asked: string, kept: string): string {
  const own = rememberedOf(kept);
  const wanted = rememberedOf(asked);
  // A URL may lack only a printer whose description is too long for it.
  const isOwn = wanted === rememberedOf(toAddress(fromAddress(own)));
  return own !== "" && (wanted === "" || isOwn) ? replaced(asked, own) : asked;
}

/** A query with its remembered settings replaced. */
function replaced(query: string, own: string): string {
  const rest = [...new URLSearchParams(query)].filter(([key]) => !REMEMBERED.some((it) => it === key));
  return new URLSearchParams([...rest, ...new URLSearchParams(own)]).toString();
}

/** Printers at the top of the list. */
const MOST_RECENT = 5;

/** The part of the element used by `remember`. */
type Chooser = Pick<SlicerElement, "query" | "printer" | "recentPrinters" | "model" | "result" | "addEventListener"> & { slicer: Pick<SlicerElement["slicer"], "printers"> };

/** Starts the element with the settings of a URL and the remembered ones, and remembers the user's choices. */
export function remember(element: Chooser, asked: string): void {
  const chosen = (): string => rememberedOf(element.query, element.printer);
  const start = recalled(asked, readKept("printer") ?? "");
  element.query = start;
  element.recentPrinters = (readKept("printers") ?? "").split(",").filter((name) => name !== "");
  let last = chosen();
  const forget = (): void => {
    element.query = replaced(element.query, "");
  };
  // The core may refuse a description that has not been used in a plan.
  const isGood = (): boolean => typeof element.printer === "string" || isEqual(element.printer, element.result?.options.printer);
  const keep = (): void => {
    const now = chosen();
    // A printer from a link is not the user's choice until changed.
    if (now === last || !isGood()) return;
    writeKept("printer", now);
    last = now;
    const { printer, recentPrinters: before } = element;
    if (typeof printer !== "string" || printer === "" || printer === before[0]) return;
    element.recentPrinters = [printer, ...before.filter((name) => name !== printer)].slice(0, MOST_RECENT);
    writeKept("printers", element.recentPrinters.join());
  };
  element.addEventListener("cusp-change", keep);
  element.addEventListener("cusp-plan", keep);
  if (start === asked) return;
  void isUnknown(element).then((is) => is && forget());
  element.addEventListener("cusp-error", ({ detail: { code } }) => {
    if ((code === "bad-printer" || code === "bad-options") && element.model !== null && !isGood()) forget();
  });
}

/** Returns true if this version does not know the printer and would refuse it. */
async function isUnknown(element: Chooser): Promise<boolean> {
  const known = await element.slicer.printers().catch(() => null);
  const { printer } = element;
  return known !== null && typeof printer === "string" && printer !== "" && !known.some(({ name }) => name === printer);
}
