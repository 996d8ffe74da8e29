/** State of each step: a few words, and a mark. */
import { isFilament } from "../api/facts.js";
import type { Verdict, Warning } from "../api/wire.js";
import type { Checks } from "../element/state/checks.js";
import type { Session } from "../element/state/session.js";
import { isPreSupported } from "../element/state/prepared.js";
import { parse } from "../element/state/settings.js";
import { SIZE_FIELDS } from "../element/state/support-sizes.js";
import type { Language } from "../texts/index.js";
import type { Step } from "./places.js";
import { workbenchWords } from "./texts.js";

/** `done`: the step has an effect; `look`: it needs attention; `wrong`: it must change. */
export type Mark = "done" | "look" | "wrong" | null;

export interface StepState {
  readonly words: string;
  readonly mark: Mark;
}

/** The part of a session that determines the steps. */
export type Walked = Pick<Session, "settings" | "faults" | "result" | "shown" | "earlier"> & { readonly checks: Pick<Checks, "check"> };

const VERDICT_MARKS = { ok: "done", review: "look", reject: "wrong" } as const satisfies Record<Verdict, Mark>;

/** Warnings that a void differs from the request. */
const OF_VOIDS: readonly Warning["code"][] = ["nothing-hollowed", "drain-astray", "undrained"];

/** Fields of the step of supports. */
const OF_SUPPORTS = [...SIZE_FIELDS, "supportLayer"] as const;

export function stepStates(session: Walked, language: Language): Readonly<Record<Step, StepState>> {
  const { settings, faults, result, shown, earlier, checks: { check } } = session;
  const { texts, format } = language;
  const { states: words } = workbenchWords(language);
  const others: readonly string[] = ["wall", ...OF_SUPPORTS];
  const isWrong = Object.keys(faults).some((field) => !others.includes(field));
  return {
    turn: settings.rotation === "" ? { words: words.asFile, mark: null } : { words: words.turned, mark: "done" },
    check: check === null ? { words: words.unchecked, mark: null } : { words: words.verdicts[check.verdict], mark: VERDICT_MARKS[check.verdict] },
    hollow: hollow(session, language),
    support: support(session, language),
    slice: isWrong
      ? { words: words.wrong, mark: "wrong" }
      : result === null || shown === null
        ? { words: "–", mark: null }
        : { words: `${format.count(shown.layers)} ${texts.plan.layers({ count: shown.layers })}`, mark: earlier || check?.verdict === "reject" ? "look" : "done" },
  };
}

function hollow({ settings, faults, result }: Walked, language: Language): StepState {
  const { states: words } = workbenchWords(language);
  if (isFilament(settings.format)) return { words: "–", mark: null };
  if (faults.wall !== undefined) return { words: words.wrong, mark: "wrong" };
  const wall_mm = parse(settings.wall);
  if (wall_mm === null) return { words: words.solid, mark: null };
  const isAmiss = result?.own?.warnings?.some(({ code }) => OF_VOIDS.includes(code)) ?? false;
  return { words: words.walls({ thickness: language.format.mm(wall_mm) }), mark: isAmiss ? "look" : "done" };
}

function support({ settings: { supports, format }, faults, result }: Walked, language: Language): StepState {
  const { states: words } = workbenchWords(language);
  if (isFilament(format)) return { words: "–", mark: null };
  const strength = language.texts.settings.strengths[supports];
  if (isPreSupported({ supports }, result)) return { words: words.inFile, mark: "done" };
  if (supports === "none") return { words: strength, mark: null };
  if (OF_SUPPORTS.some((field) => faults[field] !== undefined)) return { words: words.wrong, mark: "wrong" };
  const supported = result?.own?.supported;
  // Points of another strength belong to an earlier plan.
  if (supported === undefined || result?.options.supports?.strength !== supports) return { words: strength, mark: "done" };
  const mark = supported.unreached.length > 0 ? "look" : "done";
  return { words: words.supports({ strength, points: supported.points.length }), mark };
}
