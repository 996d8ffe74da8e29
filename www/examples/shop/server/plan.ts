/** Checks, before any costly work, that a plan's options are offered by the shop. */
import { isDeepStrictEqual } from "node:util";
import { FIXED, HEIGHT_MM, PRINTERS, RESINS, TOLERANCE_MM, type ShopPrinter, type ShopResin } from "../catalogue.js";
import { Refusal } from "./refusal.js";

/** The options of a plan. */
export interface Wanted {
  printer: ShopPrinter;
  resin: ShopResin;
}

type Json = Readonly<Record<string, unknown>>;

/** Options that a customer decides, with the values that the shop accepts. An option in neither list must be absent. */
const FREE: Readonly<Record<string, (value: unknown) => boolean>> = {
  printer: (value) => PRINTERS.some(({ name }) => name === value),
  resin: (value) => RESINS.some((resin) => isResin(value, resin)),
  tolerance: (value) => value === null || within(value, TOLERANCE_MM),
  height_mm: (value) => value === null || within(value, HEIGHT_MM),
  rotation: (value) => value === null || (Array.isArray(value) && value.length === 4 && value.every(Number.isFinite)),
};

/** Reads the report of a plan. `cusp verify` later checks its truth. */
export function wantedBy(text: string): Wanted {
  const options = optionsOf(text);
  for (const [name, value] of Object.entries({ ...FIXED, printer: null, resin: null, ...options })) {
    const isTaken = Object.hasOwn(FREE, name)
      ? FREE[name]?.(value)
      : isDeepStrictEqual(value, (FIXED as Json)[name] ?? null);
    if (isTaken !== true) throw new Refusal("option-refused", `This shop does not print with ${name} at ${inShort(value)}.`);
  }
  const printer = PRINTERS.find(({ name }) => name === options["printer"]);
  const resin = RESINS.find((resin) => isResin(options["resin"], resin));
  if (printer === undefined || resin === undefined) throw new Error("a plan without printer and resin has passed");
  return { printer, resin };
}

function optionsOf(text: string): Json {
  let plan: unknown;
  try {
    plan = JSON.parse(text);
  } catch {
    throw new Refusal("not-a-plan", "The plan is no JSON.");
  }
  if (!isObject(plan) || !isObject(plan["options"])) throw new Refusal("not-a-plan", "The plan does not say what it was made with.");
  return plan["options"];
}

function isObject(value: unknown): value is Json {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function within(value: unknown, { least, most }: { least: number; most: number }): boolean {
  return typeof value === "number" && value >= least && value <= most;
}

function isResin(value: unknown, { note: _note, swatch: _swatch, ml_cents: _cents, ...resin }: ShopResin): boolean {
  return isObject(value) && isDeepStrictEqual({ ...value }, resin);
}

function inShort(value: unknown): string {
  const text = JSON.stringify(value) ?? "nothing";
  return text.length <= 40 ? text : `${text.slice(0, 39)}…`;
}
