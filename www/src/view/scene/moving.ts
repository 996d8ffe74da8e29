/** Selects copies, and moves the selected ones over the plate, by pointer, handles and keyboard. */
import { Box3, Matrix4, Plane, Vector3, type Ray } from "three";
import { matrixOf, type Copies, type Copy } from "./copies.js";
import { watchDrags, type Drags } from "./drags.js";
import type { Point } from "./pointer.js";
import type { Triple } from "./pose.js";
import type { Scene } from "./scene.js";

/** Movement of copies, each with its new placement. */
export interface MoveDetail {
  readonly copies: readonly Pick<Copy, "place" | "x_mm" | "y_mm" | "turn_deg">[];
  /** False during the movement. */
  readonly final: boolean;
}

/** Selection of a copy. */
export interface SelectDetail {
  readonly place: number;
  /** True if the copy joins the selected ones, or leaves them. */
  readonly isMore: boolean;
}

export interface MovingReports {
  /** Called when a copy was pressed. */
  selected(detail: SelectDetail): void;
  moved(detail: MoveDetail): void;
}

/** Rounding of positions, mm. */
const STEP_MM = 0.05;

const GROUND = new Plane(new Vector3(0, 0, 1), 0);

const rounded = (mm: number): number => Math.round(mm / STEP_MM) * STEP_MM;

interface Drag {
  readonly place: number;
  /** Grasped point, and the plane at its height. */
  readonly from: Vector3;
  readonly plane: Plane;
  /** The copies that move, as they stood. */
  readonly copies: readonly Copy[];
  hasMoved: boolean;
}

export class Moving {
  isOn = false;
  copies: readonly Copy[] = [];
  /** Indices of the selected copies. */
  chosen: readonly number[] = [];
  readonly #scene: Scene;
  readonly #reports: MovingReports;
  #drag: Drag | null = null;
  /** The copies as they stood before the handles moved them. */
  #held: readonly Copy[] | null = null;

  constructor(scene: Scene, reports: MovingReports) {
    this.#scene = scene;
    this.#reports = reports;
  }

  /** Handles drags that begin on a copy. */
  watch(holder: HTMLElement, placeOf: (event: PointerEvent) => Point, signal: AbortSignal): void {
    const drags: Drags = {
      begin: (at, { shiftKey }) => this.isOn && !this.#scene.isHot && this.#begin(at, shiftKey),
      follow: (at) => this.#follow(at, false),
      end: (at) => {
        const drag = this.#drag;
        if (drag?.hasMoved === true) this.#follow(at, true);
        else if (drag !== null && this.chosen.length > 1) this.#reports.selected({ place: drag.place, isMore: false });
        this.#drag = null;
      },
    };
    watchDrags(holder, placeOf, drags, signal);
  }

  /** Moves the selected copies by keyboard. */
  step(x_mm: number, y_mm: number, turn_deg: number): void {
    this.#tell(this.#standing, x_mm, y_mm, true, turn_deg);
  }

  /** Moves the selected copies by the handles, from where they stood when the drag began. */
  shift(x_mm: number, y_mm: number, final: boolean): void {
    this.#held ??= this.#standing;
    this.#tell(this.#held, x_mm, y_mm, final);
    if (final) this.#held = null;
  }

  /** Selects the copy under a point; false if there is none, or only that one is selected. */
  choose(at: Point, isMore: boolean): boolean {
    const place = this.at(at);
    if (place === null || (!isMore && this.chosen.length === 1 && this.chosen[0] === place)) return false;
    this.#reports.selected({ place, isMore });
    return true;
  }

  /** Index of the copy under a point; null if there is none. */
  at(at: Point): number | null {
    return this.#hit(at)?.copy.place ?? null;
  }

  get #standing(): readonly Copy[] {
    return this.copies.filter(({ place }) => this.chosen.includes(place));
  }

  #hit(at: Point): ReturnType<typeof hitBy> {
    return hitBy(this.#scene.worldRayAt(...at), this.copies, this.#scene.copies);
  }

  #begin(at: Point, isMore: boolean): boolean {
    const hit = this.#hit(at);
    if (hit === null) return false;
    const { copy, point } = hit;
    const isChosen = this.chosen.includes(copy.place);
    if (isMore || !isChosen) this.#reports.selected({ place: copy.place, isMore });
    if (isMore) return true;
    this.#drag = {
      place: copy.place,
      from: point,
      plane: GROUND.clone().translate(new Vector3(0, 0, point.z)),
      copies: isChosen ? this.#standing : [copy],
      hasMoved: false,
    };
    return true;
  }

  #follow(at: Point, final: boolean): void {
    const drag = this.#drag;
    const point = drag === null ? null : this.#scene.worldRayAt(...at).intersectPlane(drag.plane, new Vector3());
    if (drag === null || point === null) return;
    const { x, y } = point.sub(drag.from);
    if (!drag.hasMoved && !final && rounded(x) === 0 && rounded(y) === 0) return;
    drag.hasMoved = true;
    this.#tell(drag.copies, x, y, final);
  }

  #tell(copies: readonly Copy[], x_mm: number, y_mm: number, final: boolean, turn_deg = 0): void {
    if (copies.length === 0) return;
    const moved = copies.map((copy) => ({
      place: copy.place,
      x_mm: rounded(copy.x_mm + x_mm),
      y_mm: rounded(copy.y_mm + y_mm),
      turn_deg: (copy.turn_deg + turn_deg) % 360,
    }));
    this.#reports.moved({ copies: moved, final });
  }
}

/**
 * Nearest copy that a ray meets, with the intersection: by its bounding box, or by its surface where boxes of several are behind one
 * another.
 */
export function hitBy(ray: Ray, copies: readonly Copy[], surfaces: Pick<Copies, "sizeOf" | "pointOn">): Met | null {
  const boxed = nearestFirst(ray, copies, (copy) => pointOnBox(ray, copy, surfaces.sizeOf(copy.shape)));
  const [first, second] = boxed;
  if (first === undefined || second === undefined) return first ?? null;
  return nearestFirst(ray, boxed.map(({ copy }) => copy), (copy) => surfaces.pointOn(copy, ray))[0] ?? first;
}

/** Copy that a ray meets, with the intersection. */
interface Met {
  readonly copy: Copy;
  readonly point: Vector3;
}

function nearestFirst({ origin }: Ray, copies: readonly Copy[], pointOf: (copy: Copy) => Vector3 | null): Met[] {
  const met = copies.flatMap((copy) => {
    const point = pointOf(copy);
    return point === null ? [] : [{ copy, point }];
  });
  return met.toSorted((a, b) => a.point.distanceToSquared(origin) - b.point.distanceToSquared(origin));
}

function pointOnBox(ray: Ray, copy: Copy, [x, y, z]: Triple): Vector3 | null {
  const to = matrixOf(copy);
  const own = ray.clone().applyMatrix4(new Matrix4().copy(to).invert());
  return own.intersectBox(new Box3(new Vector3(-x / 2, -y / 2, 0), new Vector3(x / 2, y / 2, z)), new Vector3())?.applyMatrix4(to) ?? null;
}
