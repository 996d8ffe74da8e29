/** Warnings as sentences, with offers. */
import type { ModelUnit, PlateChoice, Warning } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { warningOf } from "../../texts/warnings.js";
import { FORMATS } from "../../api/facts.js";
import { allowed, bestUniform, type Offer } from "./offers.js";
import type { Settings } from "./settings.js";

/** A warning as a sentence, with offers. */
export interface Advice {
  text: string;
  offers: Offer[];
  /** True if test towers would show whether the printer obeys the thickness of each layer. */
  towers: boolean;
  /** Plates of the model's project; null for other warnings. */
  plates: PlateChoice | null;
  /** True if what is taken for supports of the file may be parts of the model. */
  parts: boolean;
}

/**
 * Warnings as sentences, each once.
 *
 * @param fixed settings that only the page may change: no offer changes them, and trying out a fixed printer is up to the page
 */
export function advise(warnings: readonly Warning[], language: Language, fixed: ReadonlySet<keyof Settings>): Advice[] {
  const advice = new Map<string, Advice>();
  for (const warning of warnings) {
    if (warning.code === "untried-thicknesses" && fixed.has("printer")) continue;
    const text = warningOf(warning.code, "detail" in warning ? warning.detail : null, language);
    const best = warning.code === "one-thickness" ? warning.detail.best : null;
    const units = warning.code === "odd-size" ? warning.detail.readings : [];
    const offers = allowed([...(best ? [bestUniform(best, language)] : []), ...units.map(({ unit }) => inUnit(unit, language))], fixed);
    const plates = warning.code === "other-plates" ? warning.detail : null;
    const parts = warning.code === "own-supports";
    advice.set(text, { text, offers, plates, parts, towers: isOfPrinter(warning) && !fixed.has("printer") });
  }
  return [...advice.values()];
}

/** Warnings about a model, or without a name about the plate. */
export interface Warned {
  readonly name: string | null;
  readonly warnings: readonly Warning[];
}

/** Warnings as sentences, as in `advise`, each once with the names of its models. */
export function adviseOn(all: readonly Warned[], language: Language, fixed: ReadonlySet<keyof Settings>): (Advice & { readonly names: ReadonlySet<string> })[] {
  const said = new Map<string, Advice & { readonly names: Set<string> }>();
  for (const { name, warnings } of all) {
    for (const advice of advise(warnings, language, fixed)) {
      const { names } = said.get(advice.text) ?? { names: new Set<string>() };
      if (name !== null) names.add(name);
      said.set(advice.text, { ...advice, names });
    }
  }
  return [...said.values()];
}

const inUnit = (unit: ModelUnit, { texts }: Language): Offer => ({ label: texts.offers.unit({ unit }), change: { unit } });

/** Returns true if support for several thicknesses depends on the printer, not on the format. */
const isOfPrinter = (warning: Warning): boolean =>
  warning.code === "untried-thicknesses" || (warning.code === "one-thickness" && !FORMATS.some((format) => format === warning.detail.taker));
