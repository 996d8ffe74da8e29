/** Computes the stair steps of the printed look once pose and plan have stopped changing. */
import type { Derived } from "./derived.js";
import type { Rotation } from "../scene/pose.js";
import type { Steps } from "./steps.js";

/** How long pose and plan must stay the same, ms. */
const SETTLED_MS = 150;

/** What the steps are computed from. */
export interface Job {
  readonly derived: Derived;
  readonly rotation: Rotation;
  readonly scale: number;
  readonly z_mm: readonly number[];
}

export interface PrintedReports {
  /** 0 to 1 while under way, null afterwards. */
  progress(progress: number | null): void;
  /** The steps of the last job; null while there are none. */
  steps(steps: Steps | null): void;
}

export class Printed {
  readonly #reports: PrintedReports;
  #timer = 0;
  #job: Job | null = null;

  constructor(reports: PrintedReports) {
    this.#reports = reports;
  }

  /** Replaces the last job and discards its steps; null: no job. */
  want(job: Job | null): void {
    clearTimeout(this.#timer);
    this.#job?.derived.cancel();
    this.#job = job;
    this.#reports.steps(null);
    this.#reports.progress(null);
    if (job !== null) this.#timer = window.setTimeout(() => void this.#do(job), SETTLED_MS);
  }

  async #do(job: Job): Promise<void> {
    const { derived, rotation, scale, z_mm } = job;
    const tell = (progress: number | null): void => {
      if (job === this.#job) this.#reports.progress(progress);
    };
    tell(0);
    try {
      const steps = await derived.steps(rotation, scale, z_mm, tell);
      if (steps !== null && job === this.#job) this.#reports.steps(steps);
    } finally {
      // Also if memory does not suffice: then the facets stay on show.
      tell(null);
    }
  }
}
