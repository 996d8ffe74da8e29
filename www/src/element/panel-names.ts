/** The parts that an element can show. */

/** What `panels` may name, in the order in which they stand. */
export const PANELS = ["open", "model", "settings", "plan", "view", "profile", "direction", "quality", "layers"] as const;

export type Panel = (typeof PANELS)[number];

/** Those that a list names, separated by blanks; all if it is empty. */
export function panelsOf(list: string | null): ReadonlySet<Panel> {
  const named = new Set(list?.trim().split(/\s+/) ?? []);
  const known = PANELS.filter((panel) => named.has(panel));
  return new Set(known.length === 0 ? PANELS : known);
}
