/** What was found on each model of a plan. */
import type { Check } from "../../api/index.js";
import type { Finding, Printability, Report } from "../../api/wire.js";

/** What was found on a model, or on those of its copies that stand alike. */
export interface Checked {
  /** The model, by its place; null for a model alone. */
  readonly model: number | null;
  readonly copies: number;
  /** Findings are where the model stands; of several copies, where the first does. */
  readonly found: Pick<Printability, "findings" | "counts">;
}

type Place = readonly [number, number, number];

/** The models of a check, with their findings at their places on the plate. */
export function checkedOf(check: Check, { placements: all }: Report): readonly Checked[] {
  if (all.length === 1) return check.models.map((found) => ({ model: null, copies: 1, found }));
  return check.models.map(({ model, turn_deg, findings, counts }) => {
    const placements = all.filter((it) => it.model === model && (it.turn_deg ?? 0) === turn_deg);
    const { x_mm = 0, y_mm = 0 } = placements[0] ?? {};
    const moved = ([x, y, z]: Place): [number, number, number] => [x + x_mm, y + y_mm, z];
    const placed = (finding: Finding): Finding => {
      const [low, high] = finding.bounds_mm;
      return { ...finding, at_mm: moved(finding.at_mm), bounds_mm: [moved(low), moved(high)] };
    };
    return { model, copies: placements.length, found: { counts, findings: findings.map(placed) } };
  });
}
