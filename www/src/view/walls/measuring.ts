/** Measures the walls of the current model once they are to be shown. */
import type { Derived } from "../steps/derived.js";
import type { Walls } from "./thickness.js";

/** Shorter work reports no progress, ms, which would only flash. */
const SOON_MS = 700;

export interface MeasuringReports {
  /** Progress, 0 to 1; null when idle. */
  progress(progress: number | null): void;
  /** Walls of the last model requested; null until measured. */
  walls(walls: Walls | null): void;
}

export class Measuring {
  readonly #reports: MeasuringReports;
  /** The last model requested. */
  #of: Derived | null = null;
  /** The model whose walls are known or being measured. */
  #measured: Derived | null = null;
  #walls: Walls | null = null;

  constructor(reports: MeasuringReports) {
    this.#reports = reports;
  }

  /** Requests the walls of a model, or none. Those of the last model are cached until another is requested. */
  want(derived: Derived | null): void {
    if (derived === this.#of) return;
    this.#of = derived;
    if (derived === null) this.#measured?.cancelWalls();
    else if (derived !== this.#measured || this.#walls === null) void this.#measure(derived);
    this.#reports.progress(null);
  }

  /** Forgets the walls of the last model, which has been replaced. */
  forget(): void {
    this.#measured?.cancelWalls();
    this.#of = this.#measured = this.#walls = null;
    this.#reports.progress(null);
    this.#reports.walls(null);
  }

  async #measure(derived: Derived): Promise<void> {
    this.#measured?.cancelWalls();
    this.#measured = derived;
    this.#walls = null;
    const began = performance.now();
    const walls = await derived.walls((progress) => {
      if (derived === this.#of && performance.now() - began > SOON_MS) this.#reports.progress(progress);
    });
    // Cancelled, or another model was requested.
    if (walls === null || derived !== this.#measured) return;
    this.#walls = walls;
    this.#reports.progress(null);
    this.#reports.walls(walls);
  }
}
