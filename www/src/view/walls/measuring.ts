/** Measures the walls of the model on show, once they are to be seen. */
import type { Derived } from "../steps/derived.js";
import type { Walls } from "./thickness.js";

/** Shorter work reports no progress, ms: it would only flash. */
const SOON_MS = 700;

export interface MeasuringReports {
  /** Progress, 0 to 1; null when there is nothing under way. */
  progress(progress: number | null): void;
  /** The walls of the last model that was wanted; null until they are measured. */
  walls(walls: Walls | null): void;
}

export class Measuring {
  readonly #reports: MeasuringReports;
  /** What was wanted last. */
  #of: Derived | null = null;
  /** Of which the walls are known, or being measured. */
  #measured: Derived | null = null;
  #walls: Walls | null = null;

  constructor(reports: MeasuringReports) {
    this.#reports = reports;
  }

  /** Wants the walls of a model, or of none. Those of the last model are kept until there is another. */
  want(derived: Derived | null): void {
    if (derived === this.#of) return;
    this.#of = derived;
    if (derived === null) this.#measured?.cancelWalls();
    else if (derived !== this.#measured || this.#walls === null) void this.#measure(derived);
    this.#reports.progress(null);
  }

  /** Forgets the walls of the last model: there is another. */
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
    // Given up, or another model's by now.
    if (walls === null || derived !== this.#measured) return;
    this.#walls = walls;
    this.#reports.progress(null);
    this.#reports.walls(walls);
  }
}
