/** Snapshots as projects. Fetched with the first one. */
import { FACTS } from "../../api/facts.js";
import type { Project } from "../../api/index.js";
import type { Options, Placement } from "../../api/wire.js";
import { METRICS } from "./metric.js";
import { DEFAULT_SETTINGS, rotationText, toAddress, withTolerance, type Settings } from "./settings.js";
import { poseIn, type Snapshot } from "./snapshot.js";

/** Part of a snapshot that a project keeps beside its job: the form as filled in. */
export function formOf({ query, models, selected, placed }: Snapshot): string {
  return JSON.stringify({ query, poses: models.map(({ pose }) => pose), selected, placed });
}

/** The snapshot in a project. One that another program wrote has no form: its models come with their poses, the printer and the tolerance. */
export function snapshotIn({ part: { job, models, form = "" }, files }: Project, settings: Settings): Snapshot {
  const { options = {}, models: own = [], arranging, placements = [] } = job;
  const { query, poses = [], selected = 0, placed = placements } = parsed(form);
  const named = models.map(({ name, reading = {} }, place) => {
    const { file, weights = null } = files[place] ?? { file: new Blob() };
    const { copies = 1, rotation, height_mm } = own[place] ?? {};
    const turn = rotation ?? options.rotation ?? null;
    const stated = { rotation: turn === null ? "" : rotationText(turn), height: String(height_mm ?? options.height_mm ?? "") };
    const pose = poses[place] ?? toAddress({ ...DEFAULT_SETTINGS, ...stated }, Infinity);
    return { name, file: new File([file], name), reading, copies, pose, weights };
  });
  const chosen = poseIn(named[selected]?.pose ?? "");
  return { query: query ?? toAddress({ ...ofJob(options, settings), ...chosen }, Infinity), models: named, selected, arranging: { ...FACTS.arranging, ...arranging }, placed };
}

/** Settings of a job that another program wrote, in which null is absent. */
function ofJob({ printer, metric, tolerance, layer_min_mm, layer_max_mm }: Options, settings: Settings): Settings {
  const own = { ...settings, printer: printer ?? "", metric: metric ?? DEFAULT_SETTINGS.metric };
  own.layerMin = String(layer_min_mm ?? settings.layerMin);
  own.layerMax = String(layer_max_mm ?? settings.layerMax);
  return typeof tolerance === "number" ? { ...own, ...withTolerance(own, String(tolerance * METRICS[own.metric].scale)) } : own;
}

interface Form {
  query?: string;
  poses?: readonly string[];
  selected?: number;
  placed?: readonly Placement[];
}

/** A form that is not ours counts as absent. */
function parsed(form: string): Form {
  try {
    const { query, poses, selected, placed } = JSON.parse(form) as Record<string, unknown>;
    const isOurs = typeof query === "string" && Array.isArray(poses) && poses.every((it) => typeof it === "string") && Number.isInteger(selected) && Array.isArray(placed);
    return isOurs ? ({ query, poses, selected, placed } as Form) : {};
  } catch {
    return {};
  }
}
