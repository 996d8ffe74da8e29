/** The orientation search: its aims, its results so far, and their validity. */
import { isAbort } from "../../api/error.js";
import type { Found, OrientCall, Slicer } from "../../api/index.js";
import type { Candidate, Options, SearchOptions, Terms } from "../../api/wire.js";
import { advanced, type Busy } from "../parts/progress.js";
import type { Rotation } from "../../view/scene/pose.js";
import { back, turn, unit, UPRIGHT } from "../../view/scene/turn.js";
import { rotationText, type Settings } from "./settings.js";

/** Weights of what a print needs, of which only the ratios count, and exclusion limits for candidates. */
export type Aims = Readonly<
  { ranking: Required<Terms> } & Required<Pick<SearchOptions, "most_overhang_mm2" | "most_islands" | "most_cups_mm2">>
>;

/** Input of a search. */
export interface Subject {
  readonly name: string;
  readonly options: Options;
  readonly weights: Float32Array | null;
}

/** A pose of the model, measured like the candidates. */
export interface Posed {
  readonly rotation: Rotation;
  readonly candidate: Candidate;
}

export interface OrientationHost {
  /** The subject of a search started now; null without a model, or if a setting is invalid. */
  subject(): Subject | null;
  changed(): void;
  progressed(busy: Busy): void;
  failed(error: unknown): void;
}

/** Initial aims: what makes a print fail counts most, then what has to be taken off it, then its time. */
export const AIMS: Aims = {
  ranking: { islands: 3, supports: 3, contacts: 2, cups: 2, height: 1, time: 1, layers: 1, roughness: 1, overhang: 0, error: 0 },
  most_overhang_mm2: undefined,
  most_islands: undefined,
  most_cups_mm2: undefined,
};

export class OrientationSearch {
  aims = AIMS;
  /** The candidates measured so far; null before a search. */
  found: Found | null = null;
  /** Best candidates that differ from one another, best first; empty until known. */
  best: readonly Candidate[] = [];
  /** The current pose; null until measured. Comparable with the candidates, since the settings of the search also apply to it. */
  now: Posed | null = null;
  /** The progress of the search; null if none runs. */
  busy: Busy | null = null;
  readonly #host: OrientationHost;
  readonly #slicer: Pick<Slicer, "orient" | "measure">;
  #of: Subject | null = null;
  /** Keys of the options for which the results are valid, one per applied pose. */
  #keys = new Set<string>();
  /** All candidates, once measured. */
  #measured: readonly Candidate[] | null = null;
  #abort: AbortController | null = null;

  constructor(host: OrientationHost, slicer: Pick<Slicer, "orient" | "measure">) {
    this.#host = host;
    this.#slicer = slicer;
  }

  /** Options of the metrics shown. */
  get options(): Options | null {
    return this.#of?.options ?? null;
  }

  /** Returns true if a search can start. */
  get isPossible(): boolean {
    return this.#host.subject() !== null;
  }

  /** Returns true if a search started now would give the same result. */
  get isCurrent(): boolean {
    const now = this.#host.subject();
    return now !== null && this.#of?.weights === now.weights && this.#keys.has(keyOf(now.options));
  }

  /** Starts a new search; resolves once it has ended. */
  async start(): Promise<void> {
    const subject = this.#host.subject();
    if (subject === null) return;
    this.forget();
    this.#of = subject;
    this.#keys.add(keyOf(subject.options));
    await this.#run(subject);
  }

  /** Stops a search; its measurements stay visible. */
  cancel(): void {
    const abort = this.#abort;
    if (abort === null) return;
    this.#abort = null;
    this.busy = null;
    abort.abort();
    this.#host.changed();
  }

  /** Changes the aims, and rates measured candidates again. */
  aim(change: Partial<Aims>): void {
    this.aims = { ...this.aims, ...change };
    this.#host.changed();
    // A running search applies the change at its end.
    if (this.busy === null && this.#measured !== null && this.#of !== null && this.isCurrent) void this.#run(this.#of);
  }

  /** Notes that the model took a candidate's pose, for whose options the results are valid as well. */
  applied(options: Options): void {
    this.#keys.add(keyOf(options));
  }

  /** Measures the current pose unless known. Call it once the model has a new pose and a plan for it. */
  async measure(): Promise<void> {
    const subject = this.#of;
    const rotation = this.#host.subject()?.options.rotation ?? UPRIGHT;
    if (subject === null || this.#measured === null || !this.isCurrent || isPose(this.now?.rotation, rotation)) return;
    const candidate =
      [...this.best, ...this.#measured].find((it) => isPose(it.rotation, rotation)) ??
      // Without a measurement, candidates have no comparison. A broken worker is reported elsewhere.
      (await this.#slicer.measure(subject.options, unit(turn(back(rotation), [0, 0, 1]))).catch(() => null));
    // The model may have been turned on in the meantime.
    if (candidate === null || this.#of !== subject || !isPose(this.#host.subject()?.options.rotation ?? UPRIGHT, rotation)) return;
    this.now = { rotation, candidate };
    this.#host.changed();
  }

  forget(): void {
    this.cancel();
    this.found = null;
    this.best = [];
    this.now = null;
    this.#of = null;
    this.#measured = null;
    this.#keys = new Set();
  }

  async #run(subject: Subject): Promise<void> {
    const abort = new AbortController();
    this.#abort = abort;
    const isMine = (): boolean => this.#abort === abort;
    const { name, options } = subject;
    let busy: Busy = { task: "orient", name, stage: "orientation", fraction: 0, done: 0, started_ms: performance.now() };
    const call: OrientCall = {
      signal: abort.signal,
      onProgress: (stage, fraction, done) => {
        if (!isMine()) return;
        busy = advanced(busy, { stage, fraction, done }, performance.now());
        this.busy = busy;
        this.#host.progressed(busy);
        this.#host.changed();
      },
      onCandidates: (found) => {
        if (!isMine()) return;
        this.found = found;
        this.#host.changed();
      },
    };
    this.busy = busy;
    this.#host.changed();
    try {
      for (let aims: Aims | null = null; aims !== this.aims && (aims === null || this.isCurrent); ) {
        aims = this.aims;
        const measured = this.#measured ?? undefined;
        const { candidates, best } = await this.#slicer.orient(options, aims, { ...call, measured });
        if (!isMine()) return;
        this.#measured = candidates;
        this.best = best;
      }
      void this.measure();
    } catch (error) {
      if (isMine() && !isAbort(error)) this.#host.failed(error);
    } finally {
      if (isMine()) {
        this.#abort = null;
        this.busy = null;
        this.#host.changed();
      }
    }
  }
}

/**
 * Key of the options that affect the metrics of all directions. The pose matters only with a requested height, which applies in that pose.
 * The backend, number of rays, hollowing and print format do not matter. Supports are estimated for each direction, so only their sizes
 * matter: as in the core, the profile takes precedence over the strength, and medium is the default.
 */
function keyOf({ rotation, height_mm, rays: _rays, hollow: _hollow, supports, backend: _backend, gpu_method: _method, format: _format, ...options }: Options): string {
  const sizes = supports?.profile ?? supports?.strength ?? "medium";
  return JSON.stringify(height_mm === undefined ? { ...options, sizes } : { ...options, sizes, height_mm, rotation });
}

/** Returns true if two rotations are equal to the digits kept in settings. */
export function isPose(one: Rotation | undefined, other: Rotation): boolean {
  return one !== undefined && rotationText(one) === rotationText(other);
}

/** Change of settings that puts the model in a candidate's pose. */
export function withPose({ height }: Settings, { rotation, size_mm }: Candidate): Partial<Settings> {
  // The height depends on the pose; adapt it to keep the scale.
  const scaled = height.trim() === "" ? {} : { height: String(Number(size_mm[2].toFixed(6))) };
  return { rotation: rotationText(rotation), ...scaled };
}
