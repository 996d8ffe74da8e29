/** The work of a session as data: what another session needs to go on with it. */
import type { Arranging, Placement, ReadOptions } from "../../api/wire.js";
import { DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "./settings.js";

/** The selected model, and where copies stand. */
export interface Arrangement {
  /** Index of the selected model. */
  readonly selected: number;
  readonly arranging: Required<Arranging>;
  /** Places of copies set by hand; empty if all are arranged. */
  readonly placed: readonly Placement[];
}

export interface Snapshot extends Arrangement {
  /** All settings, as a query of any length. */
  readonly query: string;
  readonly models: readonly SnapshotModel[];
}

export interface SnapshotModel {
  readonly name: string;
  readonly file: Blob;
  readonly reading: ReadOptions;
  readonly copies: number;
  /** Its pose and its points by hand, as a query. */
  readonly pose: string;
  readonly weights: Float32Array | null;
}

/** Settings of the selected model alone: its pose, and its points placed by hand. */
export const POSE = ["rotation", "height", "points", "fill", "drains", "drain"] as const satisfies readonly (keyof Settings)[];

export type Pose = Pick<Settings, (typeof POSE)[number]>;

export const poseText = (pose: Pose): string => toAddress({ ...DEFAULT_SETTINGS, ...pose }, Infinity);

/** The pose in a query. */
export function poseIn(query: string): Pose {
  const settings = fromAddress(query);
  return Object.fromEntries(POSE.map((key) => [key, settings[key]])) as Pose;
}
