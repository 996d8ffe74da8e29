/** Points that somebody has placed on the model: the contacts of supports, and drain holes. As a setting they are a text. */
import type { Triple } from "../../view/scene/pose.js";

export interface Placed {
  /** x and y from the model's middle, z from its lowest point, mm. */
  readonly at_mm: Triple;
  /** The way a drain hole goes in, a unit vector; null for a support. */
  readonly inward: Triple | null;
  /** Of the contact or of the hole; null for that of the strength. */
  readonly diameter_mm: number | null;
  /** True if it stays where it is when the others are placed anew. */
  readonly isLocked: boolean;
}

/** The settings that hold such points. */
export type PlacedKind = "points" | "drains";

/** No contact and no hole is smaller, or larger, than that. */
export const LEAST_MM = 0.1;
export const MOST_MM = 50;

const rounded = (mm: number): number => Math.round(mm * 1000) / 1000 + 0;

/** The points of a setting; null if it is none. */
export function placedFrom(text: string, kind: PlacedKind): readonly Placed[] | null {
  if (text === "") return [];
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

/** The setting that holds these points, to the micrometre. */
export function placedText(list: readonly Placed[]): string {
  const parts = ({ at_mm, inward, diameter_mm, isLocked }: Placed): readonly (number | string)[] => [
    ...[...at_mm, ...(inward ?? [])].map(rounded),
    diameter_mm === null ? "" : rounded(diameter_mm),
    Number(isLocked),
  ];
  return list.map((point) => parts(point).join()).join(";");
}
