/**
 * Support points and drain holes placed by hand, and their settings. They are automatic until the first edit, which adopts all points of
 * the last plan, so that everything stays in place.
 */
import type { Drain, Options, SupportPoint } from "../../api/wire.js";
import type { Triple } from "../../view/scene/pose.js";
import { NO_POINTS, placedFrom, placedText, type Placed, type PlacedKind } from "./placed.js";
import type { Result } from "./result.js";
import type { Settings } from "./settings.js";

/** A point with its state in the plan. */
export interface HandPoint extends Placed {
  /** True if no support reaches it, or the hole meets no void. */
  readonly isUnreached: boolean;
}

export interface HandPoints {
  readonly kind: PlacedKind;
  readonly list: readonly HandPoint[];
  /** True if the list is complete; false until the plan reports the automatic points. */
  readonly isWhole: boolean;
  /** True if no other model shares the setting for supports. */
  readonly isAlone: boolean;
}

/** Tolerance for recognising a point in the core's results, mm. */
const SAME_MM = 0.05;

interface Given {
  readonly settings: Settings;
  /** Options of the settings; null if one is invalid. */
  readonly options: Options | null;
  readonly result: Result | null;
  readonly isCurrent: boolean;
  readonly isAlone: boolean;
}

/** Points of these settings and automatic points of the last plan. */
export function pointsOf(kind: PlacedKind, { settings, options, result, isCurrent, isAlone }: Given): HandPoints {
  const own = isPlaced(kind, settings) ? (placedFrom(settings[kind], kind) ?? []) : [];
  const isAutomatic = kind === "points" ? settings.supports !== "none" && settings.points !== NO_POINTS && (own.length === 0 || settings.fill === "on") : settings.drain === "auto";
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
  return { kind, list, isWhole: !isAutomatic || planned !== null, isAlone };
}

/** Returns true if the setting's points are used. */
const isPlaced = (kind: PlacedKind, { supports }: Settings): boolean => kind === "drains" || supports !== "none";

function isSamePose(a: Options, b: Options | null): boolean {
  const poseOf = ({ rotation, height_mm, unit }: Options): string => JSON.stringify([rotation, height_mm, unit]);
  return b !== null && poseOf(a) === poseOf(b);
}

/** Points of a plan; null if it has neither supports nor a void. */
function plannedOf(kind: PlacedKind, { own: { supported, hollowed } = {} }: Result): { reached: Placed[]; unreached: Placed[] } | null {
  if (kind === "drains") return hollowed === undefined ? null : { reached: hollowed.drains.map(drainOf), unreached: [] };
  return supported === undefined ? null : { reached: supported.points.map(contactOf), unreached: supported.unreached.map(contactOf) };
}

const contactOf = ({ at_mm, contact_mm }: SupportPoint): Placed =>
  settled({ at_mm, inward: null, diameter_mm: contact_mm ?? null, isLocked: false });

const drainOf = ({ at_mm, direction, diameter_mm }: Drain): Placed => settled({ at_mm, inward: direction, diameter_mm, isLocked: false });

/** A point rounded as in the setting, so that a round trip does not change it. */
function settled(point: Placed): Placed {
  const [same] = placedFrom(placedText([point]), point.inward === null ? "points" : "drains") ?? [];
  return same ?? point;
}

/** Removes the matching point from a list; returns true if there was one. */
function take(list: Placed[], { at_mm: [x, y, z] }: Placed): boolean {
  const place = list.findIndex(({ at_mm }) => Math.hypot(at_mm[0] - x, at_mm[1] - y, at_mm[2] - z) < SAME_MM);
  if (place >= 0) list.splice(place, 1);
  return place >= 0;
}

/** Key of a point: its place. */
export const keyOf = ({ at_mm }: Placed): string => at_mm.join();

/** A new place for a point: on the surface, with the inward direction. */
export interface Put {
  readonly at_mm: Triple;
  readonly inward: Triple;
}

/** A point placed by hand. */
export function pointAt(kind: PlacedKind, { at_mm, inward }: Put, diameter_mm: number | null): Placed {
  return settled({ at_mm, inward: kind === "drains" ? inward : null, diameter_mm, isLocked: true });
}

/** Change of settings that adds a point. */
export function added(points: HandPoints, point: Placed, settings: Settings): Partial<Settings> {
  return withList(points, [...points.list, point], settings);
}

/** Change of settings that moves a point. */
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

/**
 * Change of settings that fixes this list, with automatic points still to come if it is incomplete. An empty list of points removes the
 * supports.
 */
function withList({ kind, isWhole, isAlone }: HandPoints, list: readonly Placed[], settings: Settings): Partial<Settings> {
  const text = placedText(list);
  const isNone = list.length === 0 && (kind === "points" || isWhole);
  if (isNone) return cleared(kind, isAlone);
  if (kind === "drains") return { drains: text, drain: isWhole ? "none" : "auto" };
  return { points: text, fill: isWhole ? "off" : "on", supports: strengthOf(settings) };
}

/** Change of settings that places all points automatically again, except locked ones. */
export function automatic({ kind, list }: HandPoints, settings: Settings): Partial<Settings> {
  const kept = list.filter(({ isLocked }) => isLocked);
  const text = placedText(kept);
  if (kind === "drains") return { drains: text, drain: "auto" };
  return { points: text, fill: kept.length > 0 ? "on" : "off", supports: strengthOf(settings) };
}

/** Change of settings that removes all points. */
export function cleared(kind: PlacedKind, isAlone: boolean): Partial<Settings> {
  const text = isAlone ? "" : NO_POINTS;
  if (kind === "drains") return { drains: text, drain: "none" };
  return { points: text, fill: "off", ...(isAlone && { supports: "none" }) };
}

const strengthOf = ({ supports }: Settings): Settings["supports"] => (supports === "none" ? "medium" : supports);
