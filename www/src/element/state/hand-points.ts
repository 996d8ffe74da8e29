/**
 * Placing the points of supports and drain holes by hand. As long as nobody does, they are automatic; the first edit takes all that
 * the last plan has, so that everything stays where it is seen. These are the lists, and the settings that they become.
 */
import type { Drain, Options, SupportPoint } from "../../api/wire.js";
import type { Triple } from "../../view/scene/pose.js";
import { placedFrom, placedText, type Placed, type PlacedKind } from "./placed.js";
import type { Result } from "./result.js";
import type { Settings } from "./settings.js";

/** A point as the plan has it. */
export interface HandPoint extends Placed {
  /** True if no support gets there, or the hole meets no void. */
  readonly isUnreached: boolean;
}

export interface HandPoints {
  readonly kind: PlacedKind;
  readonly list: readonly HandPoint[];
  /** True if that is all there is: not while the plan has yet to say which are placed automatically. */
  readonly isWhole: boolean;
}

/** The core puts a point that is given back to it within this of where it was, mm. */
const SAME_MM = 0.05;

interface Given {
  readonly settings: Settings;
  /** What the settings give; null if one is invalid. */
  readonly options: Options | null;
  readonly result: Result | null;
  readonly isCurrent: boolean;
}

/** The points of these settings, with those that the last plan has placed automatically. */
export function pointsOf(kind: PlacedKind, { settings, options, result, isCurrent }: Given): HandPoints {
  const own = isPlaced(kind, settings) ? (placedFrom(settings[kind], kind) ?? []) : [];
  const isAutomatic = kind === "points" ? settings.supports !== "none" && (own.length === 0 || settings.fill === "on") : settings.drain === "auto";
  const planned = result !== null && isSamePose(result.options, options) ? plannedOf(kind, result) : null;
  const reached = [...(planned?.reached ?? [])];
  const unreached = [...(planned?.unreached ?? [])];
  const list = own.map((point): HandPoint => {
    const isReached = take(reached, point);
    take(unreached, point);
    return { ...point, isUnreached: isCurrent && planned !== null && !isReached };
  });
  if (isAutomatic) {
    list.push(...reached.map((point) => ({ ...point, isUnreached: false })), ...unreached.map((point) => ({ ...point, isUnreached: true })));
  }
  return { kind, list, isWhole: !isAutomatic || planned !== null };
}

/** Returns true if the points of a setting are used. */
const isPlaced = (kind: PlacedKind, { supports }: Settings): boolean => kind === "drains" || supports !== "none";

function isSamePose(a: Options, b: Options | null): boolean {
  const poseOf = ({ rotation, height_mm, unit }: Options): string => JSON.stringify([rotation, height_mm, unit]);
  return b !== null && poseOf(a) === poseOf(b);
}

/** What a plan has; null if it has no such thing. */
function plannedOf(kind: PlacedKind, { own: { supported, hollowed } = {} }: Result): { reached: Placed[]; unreached: Placed[] } | null {
  if (kind === "drains") return hollowed === undefined ? null : { reached: hollowed.drains.map(drainOf), unreached: [] };
  return supported === undefined ? null : { reached: supported.points.map(contactOf), unreached: supported.unreached.map(contactOf) };
}

const contactOf = ({ at_mm, contact_mm }: SupportPoint): Placed =>
  settled({ at_mm, inward: null, diameter_mm: contact_mm ?? null, isLocked: false });

const drainOf = ({ at_mm, direction, diameter_mm }: Drain): Placed => settled({ at_mm, inward: direction, diameter_mm, isLocked: false });

/** A point as the setting will have it, so that it is the same before and after. */
function settled(point: Placed): Placed {
  const [same] = placedFrom(placedText([point]), point.inward === null ? "points" : "drains") ?? [];
  return same ?? point;
}

/** Takes the point that is this one out of a list; returns whether it was there. */
function take(list: Placed[], { at_mm: [x, y, z] }: Placed): boolean {
  const place = list.findIndex(({ at_mm }) => Math.hypot(at_mm[0] - x, at_mm[1] - y, at_mm[2] - z) < SAME_MM);
  if (place >= 0) list.splice(place, 1);
  return place >= 0;
}

/** What a point is told by: where it is. */
export const keyOf = ({ at_mm }: Placed): string => at_mm.join();

/** Where a point is put: on the surface, and the way inward from there. */
export interface Put {
  readonly at_mm: Triple;
  readonly inward: Triple;
}

/** A point that somebody puts there. */
export function pointAt(kind: PlacedKind, { at_mm, inward }: Put, diameter_mm: number | null): Placed {
  return settled({ at_mm, inward: kind === "drains" ? inward : null, diameter_mm, isLocked: true });
}

/** The change of settings that adds a point. */
export function added(points: HandPoints, point: Placed, settings: Settings): Partial<Settings> {
  return withList(points, [...points.list, point], settings);
}

/** The change of settings that moves a point. */
export function moved(points: HandPoints, place: number, to: Put, settings: Settings): Partial<Settings> {
  return replaced(points, place, (point) => pointAt(points.kind, to, point.diameter_mm), settings);
}

export function resized(points: HandPoints, place: number, diameter_mm: number, settings: Settings): Partial<Settings> {
  return replaced(points, place, (point) => ({ ...point, diameter_mm, isLocked: true }), settings);
}

export function locked(points: HandPoints, place: number, settings: Settings): Partial<Settings> {
  return replaced(points, place, (point) => ({ ...point, isLocked: !point.isLocked }), settings);
}

export function removed(points: HandPoints, place: number, settings: Settings): Partial<Settings> {
  return withList(points, points.list.filter((_, other) => other !== place), settings);
}

function replaced(points: HandPoints, place: number, change: (point: Placed) => Placed, settings: Settings): Partial<Settings> {
  return withList(points, points.list.map((point, other) => (other === place ? change(point) : point)), settings);
}

/** The change of settings that leaves these points alone, with those that are still to come. Without any there is nothing to hold. */
function withList({ kind, isWhole }: HandPoints, list: readonly Placed[], settings: Settings): Partial<Settings> {
  const text = placedText(list);
  if (kind === "drains") return { drains: text, drain: isWhole ? "none" : "auto" };
  if (list.length === 0) return cleared(kind);
  return { points: text, fill: isWhole ? "off" : "on", supports: strengthOf(settings) };
}

/** The change of settings that places all points anew, except the locked ones. */
export function automatic({ kind, list }: HandPoints, settings: Settings): Partial<Settings> {
  const kept = list.filter(({ isLocked }) => isLocked);
  const text = placedText(kept);
  if (kind === "drains") return { drains: text, drain: "auto" };
  return { points: text, fill: kept.length > 0 ? "on" : "off", supports: strengthOf(settings) };
}

/** The change of settings that leaves none. */
export function cleared(kind: PlacedKind): Partial<Settings> {
  return kind === "drains" ? { drains: "", drain: "none" } : { points: "", fill: "off", supports: "none" };
}

const strengthOf = ({ supports }: Settings): Settings["supports"] => (supports === "none" ? "medium" : supports);
