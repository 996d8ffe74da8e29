/** Moves copies over the plate, by pointer and by keyboard. */
import { Box3, Matrix4, Plane, Vector3, type Ray } from "three";
import { matrixOf, type Copy } from "./copies.js";
import { watchDrags, type Drags } from "./drags.js";
import type { Point } from "./pointer.js";
import type { Scene } from "./scene.js";

/** Movement of a copy. */
export interface MoveDetail {
  /** Index of the copy. */
  readonly place: number;
  readonly x_mm: number;
  readonly y_mm: number;
  readonly turn_deg: number;
  /** False during the movement. */
  readonly final: boolean;
}

export interface MovingReports {
  /** Called when a copy was pressed. */
  selected(place: number): void;
  moved(detail: MoveDetail): void;
}

/** Rounding of positions, mm. */
const STEP_MM = 0.05;

const GROUND = new Plane(new Vector3(0, 0, 1), 0);

const rounded = (mm: number): number => Math.round(mm / STEP_MM) * STEP_MM;

interface Drag {
  readonly place: number;
  /** Offset from the grasped point to the copy's centre, at the height of that point. */
  readonly grasp: Vector3;
  readonly plane: Plane;
  hasMoved: boolean;
}

export class Moving {
  isOn = false;
  copies: readonly Copy[] = [];
  readonly #scene: Scene;
  readonly #reports: MovingReports;
  #drag: Drag | null = null;

  constructor(scene: Scene, reports: MovingReports) {
    this.#scene = scene;
    this.#reports = reports;
  }

  /** Handles drags that begin on a copy. */
  watch(holder: HTMLElement, placeOf: (event: PointerEvent) => Point, signal: AbortSignal): void {
    const drags: Drags = {
      begin: (at) => this.isOn && this.#begin(at),
      follow: (at) => this.#follow(at, false),
      end: (at) => {
        if (this.#drag?.hasMoved === true) this.#follow(at, true);
        this.#drag = null;
      },
    };
    watchDrags(holder, placeOf, drags, signal);
  }

  /** Moves a copy by keyboard. */
  step(place: number | null, x_mm: number, y_mm: number, turn_deg: number): void {
    const copy = this.#at(place);
    if (copy === undefined) return;
    this.#reports.moved({
      place: copy.place,
      x_mm: rounded(copy.x_mm + x_mm),
      y_mm: rounded(copy.y_mm + y_mm),
      turn_deg: (copy.turn_deg + turn_deg) % 360,
      final: true,
    });
  }

  #at(place: number | null): Copy | undefined {
    return this.copies.find((copy) => copy.place === place);
  }

  #begin(at: Point): boolean {
    const ray = this.#scene.worldRayAt(...at);
    const hit = hitBy(ray, this.copies, (copy) => this.#scene.copies.sizeOf(copy.shape));
    if (hit === null) return false;
    const { copy, point } = hit;
    this.#drag = {
      place: copy.place,
      grasp: new Vector3(copy.x_mm, copy.y_mm, 0).sub(point).setZ(0),
      plane: GROUND.clone().translate(new Vector3(0, 0, point.z)),
      hasMoved: false,
    };
    this.#reports.selected(copy.place);
    return true;
  }

  #follow(at: Point, final: boolean): void {
    const drag = this.#drag;
    const copy = this.#at(drag?.place ?? null);
    if (drag === null || copy === undefined) return;
    const point = this.#scene.worldRayAt(...at).intersectPlane(drag.plane, new Vector3());
    if (point === null) return;
    const to = point.add(drag.grasp);
    const [x_mm, y_mm] = [rounded(to.x), rounded(to.y)];
    if (!final && x_mm === copy.x_mm && y_mm === copy.y_mm) return;
    drag.hasMoved = true;
    this.#reports.moved({ place: copy.place, x_mm, y_mm, turn_deg: copy.turn_deg, final });
  }
}

/** Nearest copy whose bounding box a ray meets, with the intersection. */
export function hitBy(ray: Ray, copies: readonly Copy[], sizeOf: (copy: Copy) => readonly [number, number, number]): { copy: Copy; point: Vector3 } | null {
  let nearest: { copy: Copy; point: Vector3 } | null = null;
  for (const copy of copies) {
    const [x, y, z] = sizeOf(copy);
    const to = matrixOf(copy);
    const own = ray.clone().applyMatrix4(new Matrix4().copy(to).invert());
    const point = own.intersectBox(new Box3(new Vector3(-x / 2, -y / 2, 0), new Vector3(x / 2, y / 2, z)), new Vector3())?.applyMatrix4(to);
    if (point === undefined) continue;
    if (nearest === null || point.distanceToSquared(ray.origin) < nearest.point.distanceToSquared(ray.origin)) nearest = { copy, point };
  }
  return nearest;
}
