/** Sizes of supports as settings: typed numbers, or empty text for those of the strength. The form has an angle for the core's slope. */
import { FACTS } from "../../api/facts.js";
import type { SupportProfile, SupportStrength } from "../../api/wire.js";

/** The fields, with the names of the sizes in the core's options. */
const NAMES = {
  lift: "lift_mm",
  supportSpacing: "spacing_mm",
  contact: "contact_mm",
  pillar: "pillar_mm",
  supportAngle: "self_supporting_slope",
  raftThickness: "raft_thickness_mm",
  raftMargin: "raft_margin_mm",
} as const satisfies Record<string, keyof typeof FACTS.support_least>;

export type SizeField = keyof typeof NAMES;

/** Sizes in mm, and in degrees from level: canonical numbers, or invalid text as typed. */
export type Sizes = Record<SizeField, string>;

export const SIZE_FIELDS = Object.keys(NAMES) as SizeField[];

const DEGREES = 180 / Math.PI;

const angleOf = (slope: number): number => Math.atan(slope) * DEGREES;
const slopeOf = (angle_deg: number): number => Number(Math.tan(angle_deg / DEGREES).toFixed(4));

/** A strength's own size, in the unit of the field. */
export function usualSize(field: SizeField, strength: SupportStrength): number {
  const size = FACTS.supports[strength][NAMES[field]];
  return field === "supportAngle" ? Math.round(angleOf(size)) : size;
}

/** Typed sizes, and the switch that decides which of them count. */
type Typed = Readonly<Sizes> & { readonly raft: "off" | "on" };

/** Bounds of a size, in the unit of the field. */
function boundsOf(field: SizeField, settings: Typed, strength: SupportStrength): [least: number, most: number] {
  const least = FACTS.support_least[NAMES[field]];
  const most = FACTS.support_most_mm;
  switch (field) {
    case "supportAngle":
      return [Math.ceil(angleOf(least)), Math.floor(angleOf(most))];
    case "pillar":
      // No wider than its foot.
      return [least, FACTS.supports[strength].foot_mm];
    case "lift": {
      const { raft, raftThickness } = settings;
      if (raft === "off") return [least, most];
      // Supports need room above a raft.
      const raft_mm = raftThickness.trim() === "" ? usualSize("raftThickness", strength) : Number(raftThickness) || 0;
      return [Math.max(least, raft_mm + FACTS.raft_gap_mm), most];
    }
    case "raftThickness":
      return [least, settings.lift.trim() === "" ? usualSize("lift", strength) - FACTS.raft_gap_mm : most];
    default:
      return [least, most];
  }
}

/**
 * The sizes that differ from those of a strength; null if none do. Those of a raft that is off are not checked.
 *
 * @param within reads the number of a field, and reports one out of bounds
 */
export function profileOf(
  settings: Typed,
  strength: SupportStrength,
  within: (field: SizeField, text: string, range: readonly [number, number]) => number,
): SupportProfile | null {
  const hasRaft = settings.raft === "on";
  const profile: SupportProfile = hasRaft ? { raft: true } : {};
  for (const field of SIZE_FIELDS) {
    const isUnused = !hasRaft && (field === "raftThickness" || field === "raftMargin");
    if (isUnused || settings[field].trim() === "") continue;
    const size = within(field, settings[field], boundsOf(field, settings, strength));
    if (size !== usualSize(field, strength)) profile[NAMES[field]] = field === "supportAngle" ? slopeOf(size) : size;
  }
  return Object.keys(profile).length === 0 ? null : profile;
}
