/** Works out the stair steps and the flat faces of one model, off the path of whatever is on show. */
import { flatFace, type FlatFace } from "./flat.js";
import { posed, type Rotation } from "./pose.js";
import { stairSteps, type Steps } from "./steps.js";
import { topologyOf, type Topology } from "./topology.js";
import { inParts } from "./work.js";

/** Part of the progress bar that finding the topology takes, when it has not been found yet. */
const TOPOLOGY_PART = 0.3;

export class Printing {
  readonly #positions: Float32Array;
  readonly #stop = new AbortController();
  #topology: Promise<Topology> | null = null;
  #steps = new AbortController();

  /** @param positions nine numbers a facet, mm, in the file's pose */
  constructor(positions: Float32Array) {
    this.#positions = positions;
  }

  /** Found once, when first asked for. */
  topology(tell?: (progress: number) => void): Promise<Topology> {
    this.#topology ??= inParts(topologyOf(this.#positions), this.#stop.signal, tell);
    return this.#topology;
  }

  async face(facet: number): Promise<FlatFace | null> {
    return flatFace(this.#positions, await this.topology(), facet);
  }

  /** The stair steps in this pose; `null` if another pose or plan has been asked for meanwhile. */
  async steps(
    rotation: Rotation,
    scale: number,
    z_mm: readonly number[],
    tell: (progress: number) => void,
  ): Promise<Steps | null> {
    this.cancel();
    const { signal } = this.#steps;
    try {
      const topology = await this.topology((progress) => tell(TOPOLOGY_PART * progress));
      signal.throwIfAborted();
      const points = posed(topology.points, rotation, scale);
      return await inParts(stairSteps({ points, topology }, z_mm), signal, (progress) =>
        tell(TOPOLOGY_PART + (1 - TOPOLOGY_PART) * progress),
      );
    } catch (error) {
      if (signal.aborted || this.#stop.signal.aborted) return null;
      throw error;
    }
  }

  /** Drops the steps under way. */
  cancel(): void {
    this.#steps.abort();
    this.#steps = new AbortController();
  }

  dispose(): void {
    this.#steps.abort();
    this.#stop.abort();
    // Nobody may be waiting for it any more.
    this.#topology?.catch(() => undefined);
  }
}
