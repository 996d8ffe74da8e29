/** Turns hovers and clicks on the model into a height, a layer, or a face to lay flat. */
import type { HeightDetail } from "../events.js";
import type { FlatFace } from "./flat.js";
import { layerAt } from "./lookup.js";
import type { Point } from "./pointer.js";
import type { Triple } from "./pose.js";
import type { Tool } from "./keys.js";
import type { Scene } from "./scene.js";

/** Current content of the view. */
export interface Shown {
  readonly tool: Tool;
  readonly z_mm: readonly number[];
  face(facet: number): Promise<FlatFace | null>;
}

export interface PointingReports {
  height(detail: HeightDetail): void;
  /** Called when a layer was clicked, with its index from 0. */
  layer(layer: number): void;
  /** Called when a face was clicked to be laid on the plate; its normal is in the file's pose. */
  lay(normal: Triple): void;
}

export class Pointing {
  readonly #scene: Scene;
  readonly #shown: () => Shown;
  readonly #reports: PointingReports;
  #pointer: Point | null = null;
  #isPicking = false;
  #isOver = false;
  #marked: readonly number[] | null = null;

  constructor(scene: Scene, shown: () => Shown, reports: PointingReports) {
    this.#scene = scene;
    this.#shown = shown;
    this.#reports = reports;
  }

  async clicked(at: Point): Promise<void> {
    if (this.#scene.isHot) return;
    const hit = await this.#scene.pick(...at);
    if (hit === null) return;
    const { tool, z_mm } = this.#shown();
    if (tool === "flat") {
      const face = await this.#shown().face(hit.facet);
      if (face === null) return;
      this.#mark(null);
      this.#reports.lay(face.normal);
    } else if (z_mm.length >= 2) this.#reports.layer(layerAt(z_mm, hit.z_mm));
  }

  /** Runs one pick at a time, and another if the pointer has moved meanwhile. */
  async hovered(at: Point | null): Promise<void> {
    this.#pointer = at;
    if (this.#isPicking) return;
    this.#isPicking = true;
    try {
      let sought: Point | null;
      do {
        sought = this.#pointer;
        await this.#hover(sought);
      } while (sought !== this.#pointer);
    } finally {
      this.#isPicking = false;
    }
  }

  async #hover(at: Point | null): Promise<void> {
    const hit = at === null ? null : await this.#scene.pick(...at);
    const { tool, z_mm } = this.#shown();
    const layer = hit === null || z_mm.length < 2 ? null : layerAt(z_mm, hit.z_mm);
    if (hit !== null || this.#isOver) this.#reports.height({ z_mm: hit?.z_mm ?? null, layer });
    this.#isOver = hit !== null;
    if (tool !== "flat" || (hit !== null && this.#marked?.includes(hit.facet) === true)) return;
    const face = hit === null ? null : await this.#shown().face(hit.facet);
    if (this.#shown().tool === "flat") this.#mark(face?.facets ?? null);
  }

  #mark(facets: readonly number[] | null): void {
    this.#marked = facets;
    this.#scene.setFace(facets);
  }
}
