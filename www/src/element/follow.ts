/** Follows a model that is turned, by glances: what the plan would be, by the facets alone. */
import type { GlancedPlan, Slicer } from "../api/index.js";
import type { Options } from "../api/wire.js";
import { shownOf, type Shown } from "./result.js";
import { layerRange } from "./settings.js";

export type Rotation = readonly [x: number, y: number, z: number, w: number];

export class Follower {
  /** How the model is turned while it is held; null while it is not. */
  turning: Rotation | null = null;
  readonly #client: Pick<Slicer, "glance">;
  readonly #show: (shown: Shown) => void;
  #running = false;

  constructor(client: Pick<Slicer, "glance">, show: (shown: Shown) => void) {
    this.#client = client;
    this.#show = show;
  }

  /** Glances at the newest turn, one at a time; those between are skipped. */
  async follow(turning: Rotation, options: Options | null): Promise<void> {
    this.turning = turning;
    if (this.#running || options === null) return;
    this.#running = true;
    try {
      for (let at: Rotation | null = turning; at !== null; at = this.turning === at ? null : this.turning) {
        const asked = { ...options, rotation: [...at] as [number, number, number, number] };
        const { report, profile }: GlancedPlan = await this.#client.glance(asked);
        if (this.turning === null) break;
        this.#show(shownOf(report, profile, layerRange(asked)));
      }
    } catch {
      // Where no plan holds there is nothing to follow; the plan will say so when the model is let go.
    } finally {
      this.#running = false;
    }
  }
}
