/** Findings on each model of a plan. */
import type { Check } from "../../api/index.js";
import type { Finding, Printability, Report } from "../../api/wire.js";

/** Findings on a model, or on those of its copies with the same turn. */
export interface Checked {
  /** Index of the model; null for a single model. */
  readonly model: number | null;
  /** Place of the first of these copies, mm, and their turn. */
  readonly from_mm: readonly [number, number];
  readonly turn_deg: number;
  /** Offsets of these copies from the first, mm. */
  readonly copies_mm: readonly (readonly [number, number])[];
  /** Findings at the place of the model; for several copies, of the first. */
  readonly found: Pick<Printability, "findings" | "counts" | "peel">;
}

type Place = readonly [number, number, number];

/** The models of a check, with findings moved to their places on the plate. */
export function checkedOf(check: Check, { plate_count, placements: all }: Report): readonly Checked[] {
  const isAlone = plate_count === 1 && all.length === 1;
  return check.models.map(({ model, turn_deg, findings, counts, peel }) => {
    const placements = all.filter((it) => it.model === model && (it.turn_deg ?? 0) === turn_deg);
    const { x_mm = 0, y_mm = 0 } = placements[0] ?? {};
    const copies_mm = placements.map((it) => [(it.x_mm ?? 0) - x_mm, (it.y_mm ?? 0) - y_mm] as const);
    return { model: isAlone ? null : model, from_mm: [x_mm, y_mm] as const, turn_deg, copies_mm, found: { counts, peel, findings: findings.map((finding) => moved(finding, [x_mm, y_mm])) } };
  });
}

/** Number of kinds of findings as severe as the verdict; notes do not count. */
export function kindsOf({ verdict, models }: Check): number {
  return new Set(models.flatMap(({ findings }) => findings.filter(({ severity }) => severity === verdict).map(({ code }) => code))).size;
}

/** A finding as the view marks it. */
export interface Outline extends Finding {
  /** True for a hollow, around which no surface is painted. */
  readonly isHollow: boolean;
}

const HOLLOWS: ReadonlySet<Finding["code"]> = new Set(["cup", "trap", "narrow-drain"]);

const outlined = (finding: Finding, place_mm: readonly [number, number]): Outline => ({ ...moved(finding, place_mm), isHollow: HOLLOWS.has(finding.code) });

/** The finding on each copy with the same turn, its own copy first. */
export function onCopies(finding: Finding, models: readonly Checked[]): readonly Outline[] {
  const copies_mm = models.find(({ found }) => found.findings.includes(finding))?.copies_mm ?? [];
  return copies_mm.map((place_mm) => outlined(finding, place_mm));
}

/** Maximum number of findings outlined at once; the largest of each kind come first. */
const MOST_OUTLINES = 200;

/** The findings that need attention, on each copy. */
export function outlinesOf(models: readonly Checked[]): readonly Outline[] {
  return models
    .flatMap(({ copies_mm, found }) => found.findings.filter(({ severity }) => severity === "review" || severity === "reject").flatMap((finding) => copies_mm.map((at_mm) => outlined(finding, at_mm))))
    .slice(0, MOST_OUTLINES);
}

/** Pull of the film at each layer of a plate, N: the sum over all copies. */
export function pullOf(models: readonly Checked[]): readonly number[] {
  const layers = models[0]?.found.peel.pull_n.length ?? 0;
  return Array.from({ length: layers }, (_, layer) => models.reduce((sum, { copies_mm, found }) => sum + copies_mm.length * (found.peel.pull_n[layer] ?? 0), 0));
}

function moved(finding: Finding, [x_mm, y_mm]: readonly [number, number]): Finding {
  const to = ([x, y, z]: Place): [number, number, number] => [x + x_mm, y + y_mm, z];
  const [low, high] = finding.bounds_mm;
  return { ...finding, at_mm: to(finding.at_mm), bounds_mm: [to(low), to(high)] };
}
