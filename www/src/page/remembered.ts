/**
 * The printer that a person chose, and what belongs to it: the resin, its exposures and the motor step. They are there at the
 * next visit, unless the address asks for others.
 */
import type { SlicerElement } from "../element/slicer-element.js";
import { isEqual } from "../element/state/plain.js";
import { check, DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "../element/state/settings.js";
import { readKept, writeKept } from "./storage.js";

const REMEMBERED = ["printer", "resin", "exposure", "bottomExposure", "bottomLayers", "step"] as const satisfies readonly (keyof Settings)[];

/**
 * The part of a query that is remembered, without fields that are out of range; empty if all is at its default.
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
 * The settings to start with: those of the address, with the remembered ones if it asks for none of these. They go together,
 * since an exposure is right for one printer and one resin only.
 */
export function recalled(asked: string, kept: string): string {
  const own = rememberedOf(kept);
  const wanted = rememberedOf(asked);
  // An address may lack only a printer whose description is too long for it.
  const isOwn = wanted === rememberedOf(toAddress(fromAddress(own)));
  return own !== "" && (wanted === "" || isOwn) ? replaced(asked, own) : asked;
}

/** A query with other remembered settings. */
function replaced(query: string, own: string): string {
  const rest = [...new URLSearchParams(query)].filter(([key]) => !REMEMBERED.some((it) => it === key));
  return new URLSearchParams([...rest, ...new URLSearchParams(own)]).toString();
}

/** What `remember` uses of the element. */
type Chooser = Pick<SlicerElement, "query" | "printer" | "model" | "result" | "addEventListener"> & { slicer: Pick<SlicerElement["slicer"], "printers"> };

/** Starts the element with the settings of an address and the remembered ones, and remembers those that a person chooses. */
export function remember(element: Chooser, asked: string): void {
  const chosen = (): string => rememberedOf(element.query, element.printer);
  const start = recalled(asked, readKept("printer") ?? "");
  element.query = start;
  let last = chosen();
  const forget = (): void => {
    element.query = replaced(element.query, "");
  };
  // The core may refuse a description with which no plan was made yet.
  const isGood = (): boolean => typeof element.printer === "string" || isEqual(element.printer, element.result?.options.printer);
  const keep = (): void => {
    const now = chosen();
    // A printer that a link asks for is nobody's choice until it is changed.
    if (now === last || !isGood()) return;
    writeKept("printer", now);
    last = now;
  };
  element.addEventListener("cusp-change", keep);
  element.addEventListener("cusp-plan", keep);
  if (start === asked) return;
  void isUnknown(element).then((is) => is && forget());
  element.addEventListener("cusp-error", ({ detail: { code } }) => {
    if ((code === "bad-printer" || code === "bad-options") && element.model !== null && !isGood()) forget();
  });
}

/** Returns true if this version no longer knows the printer, which would only be refused. */
async function isUnknown(element: Chooser): Promise<boolean> {
  const known = await element.slicer.printers().catch(() => null);
  const { printer } = element;
  return known !== null && typeof printer === "string" && printer !== "" && !known.some(({ name }) => name === printer);
}
