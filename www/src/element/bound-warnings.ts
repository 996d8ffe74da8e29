/** Warnings about the models and the plan; their sentences are fetched with the first. */
import { nothing } from "lit";
import type { Warning } from "../api/wire.js";
import { shown } from "../api/visible.js";
import type { Facts } from "./facts.js";
import { FetchedPanel } from "./parts/part.js";
import type { Warned } from "./state/advice.js";
import type { Session } from "./state/session.js";

const warningsCode = new FetchedPanel("warnings", () => import("./panels/warnings.js"));

export function warningsPanel({ element, session, language, saveTowers }: Facts): unknown {
  const all = warnedOf(session);
  if (all.every(({ warnings }) => warnings.length === 0)) return nothing;
  return warningsCode.code?.warnings(all, session, language, saveTowers) ?? warningsCode.instead(element, language);
}

function warnedOf({ result, settings, plate: { entries } }: Session): Warned[] {
  // Once a unit or a height is chosen, the size is intended.
  const isSized = settings.unit !== "" || settings.height.trim() !== "";
  const asked = (all: readonly Warning[]): Warning[] => all.filter(({ code }) => code !== "odd-size" || !isSized);
  const planned = result?.report.models ?? [];
  const ofModels = entries.map(({ model: { name, info } }, place) => ({
    name: entries.length > 1 ? shown(name) : null,
    warnings: asked([...info.warnings, ...planned.flatMap((of) => (of.model === place ? of.warnings : []))]),
  }));
  return [...ofModels, { name: null, warnings: asked(result?.report.warnings ?? []) }];
}
