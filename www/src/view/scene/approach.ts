/** Moves the camera near the largest stair steps of a model, and back. */
import { Vector3 } from "three";
import type { Triple } from "./pose.js";
import type { Scene } from "./scene.js";
import { spotsOf } from "./spots.js";
import { inParts } from "../steps/work.js";
import { FLIGHT_MS, type Viewpoint } from "./viewpoint.js";

/** Height of a stair step on the screen after the approach, CSS pixels. */
const STEP_PX = 8;

/** A model with its layers. */
export interface Stepped {
  readonly positions: Float32Array;
  /** Layer boundaries from 0 to the top, mm. */
  readonly z_mm: readonly number[];
}

export class Approach {
  readonly #scene: Scene;
  /** The model that the camera has approached. */
  #of: Float32Array | null = null;
  #stop = new AbortController();

  constructor(scene: Scene) {
    this.#scene = scene;
  }

  /**
   * Moves the camera close to the model's largest stair steps on the side facing the viewer, near enough to distinguish single steps. Once
   * per model.
   *
   * @param isCalm true to move without a flight
   */
  go(to: Stepped, isCalm: boolean): void {
    if (to.positions === this.#of) return;
    this.#of = to.positions;
    this.#stop.abort();
    this.#stop = new AbortController();
    void this.#go(to, this.#flight(isCalm), this.#stop.signal);
  }

  /** Moves the camera back, unless the user has moved it since. */
  leave(isCalm: boolean): void {
    if (this.#of === null) return;
    this.dispose();
    this.#scene.cameras.withdraw(this.#flight(isCalm));
    this.#scene.invalidate();
  }

  dispose(): void {
    this.#of = null;
    this.#stop.abort();
  }

  /** No flight on slow renderers, where it would be a few jumps. */
  #flight(isCalm: boolean): number {
    return isCalm || !this.#scene.isSmooth ? 0 : FLIGHT_MS;
  }

  async #go(to: Stepped, duration_ms: number, signal: AbortSignal): Promise<void> {
    // While the view is aligned, the other camera is in use.
    if (this.#scene.align() !== null) return;
    let place: Viewpoint | null;
    try {
      place = await this.#nearest(to, signal);
    } catch (error) {
      if (signal.aborted) return;
      throw error;
    }
    if (place === null || signal.aborted) return;
    this.#scene.cameras.approachTo(place, duration_ms);
    this.#scene.invalidate();
  }

  /** A viewpoint near the largest unobstructed steps; if all are hidden, near the largest. */
  async #nearest({ positions, z_mm }: Stepped, signal: AbortSignal): Promise<Viewpoint | null> {
    const { cameras, model } = this.#scene;
    model.pivot.updateMatrixWorld();
    const matrix = model.facets.matrixWorld.clone();
    const direction = new Vector3(...cameras.approach);
    const towards = direction.clone().transformDirection(matrix.clone().invert()).toArray() as unknown as Triple;
    const [, , x = 0, , , , y = 0, , , , z = 0, , , , offset = 0] = matrix.elements;
    const spots = await inParts(spotsOf(positions, z_mm, { height: [x, y, z, offset], towards }), signal);
    let first: Viewpoint | null = null;
    for (const { facet, point, thickness_mm } of spots) {
      const target = new Vector3(...point).applyMatrix4(matrix);
      // From above, a step appears lower.
      const seen_mm = thickness_mm * Math.hypot(direction.x, direction.y);
      const position = target.clone().addScaledVector(direction, cameras.distanceFor(seen_mm, STEP_PX));
      const place: Viewpoint = { position: position.toArray(), target: target.toArray() };
      first ??= place;
      const hit = await this.#scene.seenFrom(place);
      signal.throwIfAborted();
      if (hit?.facet === facet) return place;
    }
    return first;
  }
}
