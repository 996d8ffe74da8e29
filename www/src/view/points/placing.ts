/** Places points on the model's surface by pointer and keyboard. */
import { Ray, Vector3 } from "three";
import type { PointDetail, SurfacePlace } from "../events.js";
import { watchDrags, type Drags } from "../scene/drags.js";
import { doubleArea } from "../scene/flat.js";
import type { Point } from "../scene/pointer.js";
import { DRAG_FROM_PX } from "../scene/pointer.js";
import { Raycast } from "../scene/raycast.js";
import type { Triple } from "../scene/pose.js";
import type { Scene } from "../scene/scene.js";
import type { Viewpoint } from "../scene/viewpoint.js";
import type { Derived } from "../steps/derived.js";
import { REACH_PX, stepped, TOUCH_REACH_PX, within } from "./nearest.js";
import { sighted } from "./sight.js";

interface Drag {
  readonly place: number;
  /** Position of the press, and offset from there to the marker's centre. */
  readonly from: Point;
  readonly grasp: Point;
  to: SurfacePlace | null;
}

export class Placing {
  isOn = false;
  selected: number | null = null;
  readonly #scene: Scene;
  readonly #tell: (detail: PointDetail) => void;
  #derived: Derived | null = null;
  #supports: { readonly of: Float32Array | null; readonly raycast: Raycast | null } = { of: null, raycast: null };
  #drag: Drag | null = null;

  constructor(scene: Scene, tell: (detail: PointDetail) => void) {
    this.#scene = scene;
    this.#tell = tell;
  }

  /** @param supports facets of the supports in front of the model, mm, z from the plate; null: none */
  prepare(derived: Derived | null, supports: Float32Array | null): void {
    if (this.#derived !== derived || !this.isOn) this.cancel();
    this.#derived = derived;
    if (!this.isOn || this.#supports.of === supports) return;
    this.#supports = { of: supports, raycast: supports === null || supports.length < 9 ? null : new Raycast(supports) };
  }

  /** Handles drags that begin on a marker, and sets the class `over` on `holder` while a pointer is over one. */
  watch(holder: HTMLElement, placeOf: (event: PointerEvent) => Point, signal: AbortSignal): void {
    const drags: Drags = {
      begin: (at, { pointerType }) => this.isOn && this.#begin(at, pointerType === "touch" ? TOUCH_REACH_PX : REACH_PX),
      follow: (at) => this.#follow(at),
      end: (_at, isDone) => {
        const drag = this.#drag;
        this.cancel();
        if (isDone && drag !== null && drag.to !== null) this.#tell({ do: "move", place: drag.place, to: drag.to });
      },
    };
    watchDrags(holder, placeOf, drags, signal);
    const over = (event: PointerEvent): void => {
      if (this.isOn && event.buttons === 0) holder.classList.toggle("over", this.#markerAt(placeOf(event), REACH_PX) !== null);
    };
    holder.addEventListener("pointermove", over, { capture: true, signal });
  }

  /** Adds a point on the model; a click next to it clears the selection. */
  clicked(at: Point): void {
    if (this.#scene.isHot) return;
    const to = this.#surfaceAt(at);
    if (to !== null) this.#tell({ do: "add", to });
    else if (this.selected !== null && !this.#isSupportAt(at)) this.#tell({ do: "select", place: null });
  }

  /**
   * Selects the next or previous point, and turns the camera if the point is out of sight.
   *
   * @param duration_ms duration of the camera's flight
   */
  step(by: 1 | -1, duration_ms: number): void {
    const place = stepped(this.selected, by, this.#scene.markers.points.length);
    if (place === null) return;
    this.#tell({ do: "select", place });
    const { cameras } = this.#scene;
    const point = this.#pointAt(place);
    const isSeen = (from: Viewpoint): boolean => cameras.shows(from, point) && !this.#isHidden(point, new Vector3(...from.position));
    const to = sighted(cameras.goal, point, this.#outward(place, point), isSeen);
    if (to === null) return;
    cameras.moveTo(to, duration_ms);
    this.#scene.invalidate();
  }

  edit(what: "remove" | "lock"): void {
    if (this.selected !== null) this.#tell({ do: what, place: this.selected });
  }

  /** Puts a dragged point back; returns true if there was one. */
  cancel(): boolean {
    const had = this.#drag !== null;
    this.#drag = null;
    if (had) {
      this.#scene.markers.drag(null);
      this.#scene.invalidate();
    }
    return had;
  }

  #begin(from: Point, reach_px: number): boolean {
    const place = this.#markerAt(from, reach_px);
    if (place === null) return false;
    const [x, y] = this.#shownAt(place);
    this.#drag = { place, from, grasp: [x - from[0], y - from[1]], to: null };
    if (place !== this.selected) this.#tell({ do: "select", place });
    return true;
  }

  #follow(at: Point): void {
    const drag = this.#drag;
    if (drag === null) return;
    const isStill = drag.to === null && Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) <= DRAG_FROM_PX;
    const to = isStill ? null : this.#surfaceAt([at[0] + drag.grasp[0], at[1] + drag.grasp[1]]);
    if (to === null) return;
    drag.to = to;
    this.#scene.markers.drag({ place: drag.place, ...to });
    this.#scene.invalidate();
  }

  /** Position of a point on the plate. */
  #pointAt(place: number): Vector3 {
    const [x, y, z] = this.#scene.markers.points[place]?.at_mm ?? [0, 0, 0];
    return new Vector3(x, y, z + this.#scene.model.lift_mm);
  }

  #shownAt(place: number): Point {
    return this.#scene.cameras.project(this.#pointAt(place));
  }

  /** The marker under a pointer. Markers behind the model are visible, but do not receive the pointer. */
  #markerAt(at: Point, reach_px: number): number | null {
    const places = this.#scene.markers.points.map((_, place) => this.#shownAt(place));
    const eye = this.#scene.cameras.current.position;
    return within(at, places, reach_px).find((place) => !this.#isHidden(this.#pointAt(place), eye)) ?? null;
  }

  /** Returns true if the model hides a point from an eye, both in the plate's frame. */
  #isHidden(point: Vector3, eye: Vector3): boolean {
    const ray = this.#scene.inFile(new Ray(eye, point.clone().sub(eye).normalize()));
    const hit = this.#derived?.raycast?.cast(ray) ?? null;
    if (hit === null) return false;
    // The point is on the surface, so only a hit clearly in front of it hides it.
    return this.#onPlate(hit.point).distanceTo(eye) < point.distanceTo(eye) - 0.01 * Math.hypot(...this.#scene.model.size_mm);
  }

  #isSupportAt(at: Point): boolean {
    return this.#supports.raycast?.cast(this.#scene.worldRayAt(...at)) != null;
  }

  /** Intersection of a ray with the model, unless a support is in front. */
  #surfaceAt(at: Point): SurfacePlace | null {
    const derived = this.#derived;
    const ray = this.#scene.rayAt(...at);
    const hit = derived?.raycast?.cast(ray) ?? null;
    if (derived === null || hit === null) return null;
    const world = this.#scene.worldRayAt(...at);
    const point = this.#onPlate(hit.point);
    const held = this.#supports.raycast?.cast(world) ?? null;
    if (held !== null && new Vector3(...held.point).distanceTo(world.origin) < point.distanceTo(world.origin)) return null;
    const [x, y, z] = point.toArray();
    return { at_mm: [x, y, z - this.#scene.model.lift_mm], inward: this.#inward(derived.positions, hit.facet, ray.direction).toArray() };
  }

  /** Transforms a point of the file into the plate's frame. */
  #onPlate(point: Triple): Vector3 {
    return new Vector3(...point).applyMatrix4(this.#scene.model.facets.matrixWorld);
  }

  /** Outward direction at a point: opposite to the hole's, or the normal of the nearest facet as in the file. */
  #outward(place: number, point: Vector3): Vector3 {
    const inward = this.#scene.markers.points[place]?.inward ?? null;
    if (inward !== null) return new Vector3(...inward).negate();
    const { facets } = this.#scene.model;
    const near = this.#derived?.raycast?.nearest(facets.worldToLocal(point.clone()).toArray(), Infinity) ?? null;
    const normal = near === null || this.#derived === null ? new Vector3() : new Vector3(...doubleArea(this.#derived.positions, near.facet));
    return normal.transformDirection(facets.matrixWorld);
  }

  /** Inward direction at a facet: the side into which the ray points, so that inverted facets do not matter. */
  #inward(positions: Float32Array, facet: number, direction: Vector3): Vector3 {
    const normal = new Vector3(...doubleArea(positions, facet));
    if (normal.length() === 0) normal.copy(direction);
    if (normal.dot(direction) < 0) normal.negate();
    return normal.transformDirection(this.#scene.model.facets.matrixWorld);
  }
}
