/** Points placed on the model by hand: support contacts and drain holes. Settings store them as text. */
import type { Triple } from "../../view/scene/pose.js";

export interface Placed {
  /** x and y from the model's centre, z from its lowest point, mm. */
  readonly at_mm: Triple;
  /** Direction of a drain hole into the model, a unit vector; null for a support. */
  readonly inward: Triple | null;
  /** Diameter of the contact or hole; null for the default of the strength. */
  readonly diameter_mm: number | null;
  /** True if the point stays when the others are placed automatically again. */
  readonly isLocked: boolean;
}

/** Settings that store such points. */
export type PlacedKind = "points" | "drains";

/** Smallest and largest diameter of a contact or hole. */
export const LEAST_MM = 0.1;
export const MOST_MM = 50;

const rounded = (mm: number): number => Math.round(mm * 1000) / 1000 + 0;

/** Parses the points of a setting; null if malformed. */
/** Setting of one model of several without points, whatever the others have. */
export const NO_POINTS = "none";

export function placedFrom(text: string, kind: PlacedKind): readonly Placed[] | null {
  if (text === "" || text === NO_POINTS) return [];
  const list = text.split(";").map((point) => pointFrom(point.split(","), kind));
  return list.every((point) => point !== null) ? list : null;
}

function pointFrom(parts: readonly string[], kind: PlacedKind): Placed | null {
  const hasWay = kind === "drains";
  if (parts.length !== (hasWay ? 8 : 5) || parts.at(-1)?.match(/^[01]$/) == null) return null;
  const numbers = parts.map((part) => (part.trim() === "" ? Number.NaN : Number(part)));
  const [x = NaN, y = NaN, z = NaN, dx = NaN, dy = NaN, dz = NaN] = numbers;
  const [size = NaN, lock] = numbers.slice(-2);
  const length = Math.hypot(dx, dy, dz);
  const isPoint = Number.isFinite(x + y + z) && (!hasWay || (Number.isFinite(length) && length > 0));
  const isSized = parts.at(-2) === "" ? !hasWay : size >= LEAST_MM && size <= MOST_MM;
  if (!isPoint || !isSized) return null;
  return { at_mm: [x, y, z], inward: hasWay ? [dx, dy, dz] : null, diameter_mm: Number.isNaN(size) ? null : size, isLocked: lock === 1 };
}

/** Formats points for a setting, to the micrometre. */
export function placedText(list: readonly Placed[]): string {
  const parts = ({ at_mm, inward, diameter_mm, isLocked }: Placed): readonly (number | string)[] => [
    ...[...at_mm, ...(inward ?? [])].map(rounded),
    diameter_mm === null ? "" : rounded(diameter_mm),
    Number(isLocked),
  ];
  return list.map((point) => parts(point).join()).join(";");
}
