/** Follows a model that is turned or painted, by previews: what the plan would be, by the facets alone. */
import type { Slicer } from "../../api/index.js";
import type { Options } from "../../api/wire.js";
import { shownOf, type Shown } from "./result.js";

export type Rotation = readonly [x: number, y: number, z: number, w: number];

export class Follower {
  /** How the model is turned while it is held; null while it is not. */
  turning: Rotation | null = null;
  readonly #slicer: Pick<Slicer, "preview">;
  readonly #show: (shown: Shown) => void;
  #running = false;
  #next: Options | null = null;
  /** How often it was told to stop: what was asked for before is news no more. */
  #stops = 0;

  constructor(slicer: Pick<Slicer, "preview">, show: (shown: Shown) => void) {
    this.#slicer = slicer;
    this.#show = show;
  }

  /** Previews the model as it is turned. */
  turn(turning: Rotation, options: Options | null): void {
    this.turning = turning;
    if (options !== null) void this.follow({ ...options, rotation: [...turning] });
  }

  /** Previews the newest options, one at a time; those between are skipped. */
  async follow(options: Options): Promise<void> {
    this.#next = options;
    if (this.#running) return;
    this.#running = true;
    try {
      for (let at: Options | null = this.#next; at !== null; at = this.#next) {
        this.#next = null;
        const stops = this.#stops;
        const { report, profile } = await this.#slicer.preview(at);
        if (this.#stops === stops) this.#show(shownOf(report, profile));
      }
    } catch {
      // Where no plan holds there is nothing to follow; the plan will say so when the model is let go.
    } finally {
      this.#running = false;
    }
  }

  /** The model was let go. */
  stop(): void {
    this.turning = null;
    this.#next = null;
    this.#stops++;
  }
}
