/** Paints weights by pointer and by keyboard. */
import type { Raycast, RayHit } from "../scene/raycast.js";
import { BRUSH, type Brush } from "./brush.js";
import type { Derived } from "../steps/derived.js";
import type { PaintDetail } from "../events.js";
import { Painter, mirrored, type Dab } from "./painter.js";
import { watchDrags, type Drags } from "../scene/drags.js";
import type { Point } from "../scene/pointer.js";
import { extentOf, UPRIGHT, type Triple } from "../scene/pose.js";
import { normalsOf, type Surface } from "./region.js";
import type { Scene } from "../scene/scene.js";

/** A mirrored point is painted if the model is within this distance of it, as a fraction of the brush's radius. */
const MIRROR_WITHIN = 0.5;

export interface PaintingReports {
  /** Called when the weights of these facets have changed; null: of any facet. */
  changed(facets: readonly number[] | Uint32Array | null): void;
  painted(detail: PaintDetail): void;
}

/** Data for painting a model, computed when painting begins. */
interface Ready {
  readonly of: Derived;
  readonly painter: Painter;
  readonly raycast: Raycast;
  /** Middle of the model's x extent in its file, mm. */
  readonly middle_x: number;
}

export class Painting {
  brush: Brush = BRUSH;
  readonly #scene: Scene;
  readonly #reports: PaintingReports;
  #ready: Ready | null = null;
  #asked: Derived | null = null;
  #preparing: Promise<void> = Promise.resolve();
  #weights: Float32Array | null = null;
  /** Last position of the painting pointer, and the last hits of it and its mirror image on the model. */
  #stroke: { at: Point; last: RayHit | null; lastMirrored: RayHit | null } | null = null;
  #frame = 0;
  #isOn = false;

  constructor(scene: Scene, reports: PaintingReports) {
    this.#scene = scene;
    this.#reports = reports;
  }

  /** Weight of each facet, 0 to 1, including the current stroke; null: all 1. */
  get weights(): Float32Array | null {
    return this.#ready?.painter.weights ?? this.#weights;
  }

  /** Sets weights from outside; those last reported by `painted` have no effect. */
  set weights(weights: Float32Array | null) {
    if (weights === this.#weights) return;
    this.#weights = weights;
    const painter = this.#ready?.painter;
    const facets = painter?.weights.length ?? 0;
    if (weights !== null && painter !== undefined && weights.length !== facets) return;
    painter?.replace(weights ?? new Float32Array(facets).fill(1));
    this.#reports.changed(null);
  }

  /** Prepares the brush for a model when the tool is first selected; null: no model. */
  prepare(derived: Derived | null, isOn: boolean): void {
    this.#isOn = isOn;
    if (this.#ready !== null && this.#ready.of !== derived) this.#ready = null;
    if (!isOn) this.#scene.setFace(null);
    if (derived === null || !isOn || this.#asked === derived) return;
    this.#asked = derived;
    this.#preparing = this.#make(derived);
  }

  async #make(derived: Derived): Promise<void> {
    const topology = await derived.topology();
    const { positions, raycast } = derived;
    if (topology === null || this.#asked !== derived || raycast === null) return;
    const surface: Surface = { positions, topology, normals: normalsOf(positions) };
    const { least, greatest } = extentOf(topology.points, UPRIGHT, 1);
    const known = this.#weights?.length === positions.length / 9 ? this.#weights : null;
    const painter = new Painter(surface, known, 1);
    this.#ready = { of: derived, painter, raycast, middle_x: (least[0] + greatest[0]) / 2 };
    this.#reports.changed(null);
  }

  /** Handles drags that begin on the model. */
  watch(holder: HTMLElement, placeOf: (event: PointerEvent) => Point, signal: AbortSignal): void {
    const moved = (at: Point): void => {
      if (this.#stroke !== null) this.#stroke.at = at;
    };
    const drags: Drags = {
      begin: (at) => this.#begin(at),
      follow: (at) => {
        moved(at);
        if (this.#frame === 0) this.#frame = requestAnimationFrame(this.#follow);
      },
      end: (at) => {
        moved(at);
        this.#follow();
        this.#end();
      },
    };
    watchDrags(holder, placeOf, drags, signal);
    signal.addEventListener("abort", () => cancelAnimationFrame(this.#frame));
  }

  /** Paints one dab as a separate stroke, for the keyboard, once the brush is ready. */
  async stamp(at: Point): Promise<void> {
    await this.#preparing;
    if (this.#begin(at)) this.#end();
  }

  /** Highlights the facets that the brush would paint under a hovering pointer. */
  hover(at: Point | null): void {
    if (!this.#isOn || this.#ready === null || this.#stroke !== null) return;
    const hit = at === null ? null : this.#hitAt(at);
    const { painter } = this.#ready;
    const scale = this.#scene.model.scale;
    this.#scene.setFace(hit === null ? null : painter.touched({ ...hit, from: null }, this.brush, scale).facets);
  }

  undo(): void {
    const painter = this.#ready?.painter;
    this.#stepped(painter?.strokes.undo(painter.weights) ?? null);
  }

  redo(): void {
    const painter = this.#ready?.painter;
    this.#stepped(painter?.strokes.redo(painter.weights) ?? null);
  }

  #stepped(facets: Uint32Array | null): void {
    if (facets === null) return;
    this.#reports.changed(facets);
    this.#tell(true);
  }

  /** Begins a stroke; returns false if the model is not under the point. */
  #begin(at: Point): boolean {
    if (!this.#isOn || this.#ready === null || this.#stroke !== null || this.#hitAt(at) === null) return false;
    this.#stroke = { at, last: null, lastMirrored: null };
    this.#scene.setFace(null);
    this.#follow();
    return true;
  }

  #end(): void {
    this.#stroke = null;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    if (this.#ready?.painter.end() === true) this.#tell(true);
  }

  #hitAt(at: Point): RayHit | null {
    return this.#ready?.raycast.cast(this.#scene.rayAt(...at)) ?? null;
  }

  /** Paints up to the pointer's position. */
  readonly #follow = (): void => {
    this.#frame = 0;
    const stroke = this.#stroke;
    if (stroke === null) return;
    const hit = this.#hitAt(stroke.at);
    const changed = this.#dab(hit, stroke.last);
    stroke.last = hit;
    if (this.brush.mirrors) {
      const other = hit === null ? null : this.#mirror(hit.point);
      changed.push(...this.#dab(other, stroke.lastMirrored));
      stroke.lastMirrored = other;
    }
    if (changed.length === 0) return;
    this.#reports.changed(changed);
    this.#tell(false);
  };

  #dab(hit: RayHit | null, last: RayHit | null): number[] {
    if (hit === null || this.#ready === null) return [];
    const dab: Dab = { ...hit, from: last?.point ?? null };
    return this.#ready.painter.dab(dab, this.brush, this.#scene.model.scale);
  }

  #mirror(point: Triple): RayHit | null {
    if (this.#ready === null) return null;
    const { raycast, middle_x } = this.#ready;
    return raycast.nearest(mirrored(point, middle_x), (MIRROR_WITHIN * this.brush.size_mm) / 2 / this.#scene.model.scale);
  }

  #tell(final: boolean): void {
    if (this.#ready === null) return;
    const { weights, strokes } = this.#ready.painter;
    this.#weights = weights.slice();
    this.#reports.painted({ weights: this.#weights, final, canUndo: strokes.canUndo, canRedo: strokes.canRedo });
  }
}
