/** Computes the stair steps of the printed look once pose and plan have stopped changing, and measures them on request. */
import type { Derived } from "./derived.js";
import { isMeasured } from "./distances.js";
import type { Rotation } from "../scene/pose.js";
import type { Steps } from "./steps.js";

/** Delay after the last change of pose or plan, ms. */
const SETTLED_MS = 150;

/** Input of the steps. */
export interface Job {
  readonly derived: Derived;
  readonly rotation: Rotation;
  readonly scale: number;
  readonly z_mm: readonly number[];
}

export interface PrintedReports {
  /** Progress of computing the steps, 0 to 1; null at the end. */
  building(progress: number | null): void;
  /** Progress of measuring them, likewise. */
  measuring(progress: number | null): void;
  /** Steps of the last job, later with their distances; null until computed. */
  steps(steps: Steps | null): void;
}

/** Returns true if two jobs have the same steps. */
function areSame(a: Job | null, b: Job | null): boolean {
  if (a === null || b === null) return a === b;
  return a.derived === b.derived && a.rotation === b.rotation && a.scale === b.scale && a.z_mm === b.z_mm;
}

export class Printed {
  readonly #reports: PrintedReports;
  #timer = 0;
  #job: Job | null = null;
  /** Steps of the job, once computed. */
  #steps: Steps | null = null;
  #measures = false;

  constructor(reports: PrintedReports) {
    this.#reports = reports;
  }

  /**
   * Replaces the last job and discards its steps, unless they are the same; null: no job.
   *
   * @param measures true if the distances of the steps are needed too
   */
  want(job: Job | null, measures: boolean): void {
    const isNew = !areSame(job, this.#job);
    const before = this.#measures;
    this.#measures = measures;
    if (isNew) this.#begin(job);
    else if (this.#job !== null && this.#steps !== null && !isMeasured(this.#steps) && measures !== before) {
      if (measures) void this.#measure(this.#job, this.#steps);
      else this.#job.derived.cancel();
    }
  }

  #begin(job: Job | null): void {
    clearTimeout(this.#timer);
    this.#job?.derived.cancel();
    this.#job = job;
    this.#steps = null;
    this.#reports.steps(null);
    this.#reports.building(null);
    this.#reports.measuring(null);
    if (job !== null) this.#timer = window.setTimeout(() => void this.#build(job), SETTLED_MS);
  }

  async #build(job: Job): Promise<void> {
    const { derived, rotation, scale, z_mm } = job;
    // If memory runs out, the facets stay visible.
    const steps = await this.#told(job, "building", (tell) => derived.steps(rotation, scale, z_mm, tell));
    if (steps === null) return;
    this.#steps = steps;
    this.#reports.steps(steps);
    if (this.#measures) await this.#measure(job, steps);
  }

  async #measure(job: Job, steps: Steps): Promise<void> {
    const { derived, rotation, scale } = job;
    const measured = await this.#told(job, "measuring", (tell) => derived.measured(rotation, scale, steps, tell));
    if (measured === null) return;
    this.#steps = measured;
    this.#reports.steps(measured);
  }

  /** Reports the progress of work on a job; null if there is another job at its end. */
  async #told<Result>(
    job: Job,
    report: "building" | "measuring",
    work: (tell: (progress: number) => void) => Promise<Result | null>,
  ): Promise<Result | null> {
    const tell = (progress: number | null): void => {
      if (job === this.#job) this.#reports[report](progress);
    };
    tell(0);
    try {
      const result = await work(tell);
      return job === this.#job ? result : null;
    } finally {
      // Also if memory runs out.
      tell(null);
    }
  }
}
