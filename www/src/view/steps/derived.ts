/** Data derived from the facets of one model, computed on first request without blocking the view. */
import type { Solid } from "./contours.js";
import { measured, type MeasuredSteps } from "./distances.js";
import { flatFace, type FlatFace } from "../scene/flat.js";
import { posed, UPRIGHT, type Rotation } from "../scene/pose.js";
import { Raycast } from "../scene/raycast.js";
import { stairSteps, type Steps } from "./steps.js";
import { topologyOf, type Topology } from "../scene/topology.js";
import { wallsOf, type Walls } from "../walls/thickness.js";
import { inParts } from "./work.js";

/** Fraction of the progress bar for the topology, if not yet known. */
const TOPOLOGY_PART = 0.3;

export class Derived {
  readonly positions: Float32Array;
  readonly #stop = new AbortController();
  #topology: Promise<Topology> | null = null;
  #hasTopology = false;
  #raycast: Raycast | null = null;
  #steps = new AbortController();
  #walls = new AbortController();

  /** @param positions nine numbers per facet, mm, in the file's pose */
  constructor(positions: Float32Array) {
    this.positions = positions;
  }

  /** Connectivity of the facets; null after disposal. */
  topology(): Promise<Topology | null> {
    return this.#whileAlive(this.#found());
  }

  /** Raycaster of the model; null without facets. Built synchronously on first request. */
  get raycast(): Raycast | null {
    if (this.positions.length >= 9) this.#raycast ??= new Raycast(this.positions);
    return this.#raycast;
  }

  /** Distinct points of the model; null after disposal. */
  async points(): Promise<Float32Array | null> {
    return (await this.topology())?.points ?? null;
  }

  /** Flat face around a facet; null if there is none, or after disposal. */
  async face(facet: number): Promise<FlatFace | null> {
    const topology = await this.topology();
    return topology === null ? null : flatFace(this.positions, topology, facet);
  }

  /** Stair steps in this pose; null if cancelled, or if another pose or plan was requested meanwhile. */
  steps(rotation: Rotation, scale: number, z_mm: readonly number[], tell: (progress: number) => void): Promise<Steps | null> {
    this.cancel();
    return this.#ofSolid(rotation, scale, this.#steps.signal, (solid) => stairSteps(solid, z_mm), tell);
  }

  /** The stair steps with their distances from the model; null as for `steps`. */
  measured(rotation: Rotation, scale: number, steps: Steps, tell: (progress: number) => void): Promise<MeasuredSteps | null> {
    this.cancel();
    return this.#ofSolid(rotation, scale, this.#steps.signal, (solid) => measured(solid, steps), tell);
  }

  /** Wall thickness of the model, in the file's lengths; null if cancelled. */
  walls(tell: (progress: number) => void): Promise<Walls | null> {
    this.cancelWalls();
    return this.#ofSolid(UPRIGHT, 1, this.#walls.signal, wallsOf, tell);
  }

  /** Cancels the current computation or measurement of steps. */
  cancel(): void {
    this.#steps.abort();
    this.#steps = new AbortController();
  }

  /** Cancels the current measurement of walls. */
  cancelWalls(): void {
    this.#walls.abort();
    this.#walls = new AbortController();
  }

  dispose(): void {
    this.#steps.abort();
    this.#walls.abort();
    this.#stop.abort();
  }

  /** Runs work on the posed model until aborted. */
  async #ofSolid<Result>(
    rotation: Rotation,
    scale: number,
    signal: AbortSignal,
    work: (solid: Solid) => Generator<number, Result>,
    tell: (progress: number) => void,
  ): Promise<Result | null> {
    const before = this.#hasTopology ? 0 : TOPOLOGY_PART;
    // The search for the topology continues even if the work is cancelled.
    const found = this.#found((progress) => {
      if (!signal.aborted) tell(before * progress);
    });
    const topology = await this.#whileAlive(found);
    if (topology === null || signal.aborted) return null;
    const points = posed(topology.points, rotation, scale);
    try {
      return await inParts(work({ points, topology }), signal, (progress) => tell(before + (1 - before) * progress));
    } catch (error) {
      if (signal.aborted) return null;
      throw error;
    }
  }

  /** The topology, computed on first request. */
  #found(tell?: (progress: number) => void): Promise<Topology> {
    this.#topology ??= inParts(topologyOf(this.positions), this.#stop.signal, tell).finally(() => (this.#hasTopology = true));
    return this.#topology;
  }

  async #whileAlive<Result>(work: Promise<Result>): Promise<Result | null> {
    try {
      return await work;
    } catch (error) {
      if (this.#stop.signal.aborted) return null;
      throw error;
    }
  }
}
