/** Live previews while a model is being turned or painted: plans from the facets alone. */
import type { Slicer } from "../../api/index.js";
import type { Options } from "../../api/wire.js";
import { shownOf, type Shown } from "./result.js";

export type Rotation = readonly [x: number, y: number, z: number, w: number];

export class LivePreview {
  /** Rotation of the model while the user is turning it; otherwise null. */
  turning: Rotation | null = null;
  readonly #slicer: Pick<Slicer, "preview">;
  readonly #show: (shown: Shown) => void;
  #running = false;
  #next: Options | null = null;
  /** Number of stops; previews requested before the last one are ignored. */
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

  /** Previews the newest options, one call at a time; intermediate ones are skipped. */
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
      // Without a feasible plan, nothing is shown; the plan made on release reports the error.
    } finally {
      this.#running = false;
    }
  }

  /** Ends the previews, as on release of the model. */
  stop(): void {
    this.turning = null;
    this.#next = null;
    this.#stops++;
  }
}
