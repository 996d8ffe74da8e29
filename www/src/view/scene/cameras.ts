/** The cameras of the view: one free and in perspective, one from the side at the scale of a chart beside the view. */
import { MathUtils, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Rotation, Triple } from "./pose.js";
import { FIRST_LOOK } from "./turn.js";

/** Where heights appear in the view, CSS pixels from its upper edge. */
export interface Frame {
  /** The top of the model. */
  readonly top_px: number;
  /** The plate, z = 0. */
  readonly bottom_px: number;
}

/** Room above and below the heights shown when aligned, CSS pixels. */
export interface Inset {
  readonly top_px: number;
  readonly bottom_px: number;
}

/** A range of heights, mm. */
export type Heights = readonly [bottom: number, top: number];

/** Where an aligned view shows which heights. */
export interface Alignment {
  /** Null for the whole model. */
  readonly heights_mm: Heights | null;
  readonly inset: Inset;
}

const FIELD_OF_VIEW_DEG = 26;

/** Room around the model in the free view. */
const ROOM = 1.14;

/** Limits of the camera's distance, as multiples of that at which the whole model is visible. */
const NEAREST = 0.05;
const FARTHEST = 6;

const FIRST = new Vector3(...FIRST_LOOK);

/** A perspective camera with z upwards. */
export function perspective(): PerspectiveCamera {
  const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG);
  camera.up.set(0, 0, 1);
  return camera;
}

/** Distance from a model's middle along `look`, a direction, at which all corners of its bounds are just visible. */
export function distanceOf(size_mm: Triple, look: Vector3, aspect: number): number {
  const right = new Vector3(0, 0, 1).cross(look).normalize();
  const up = look.clone().cross(right);
  const slope = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
  let distance = 1e-3;
  for (let corner = 0; corner < 8; corner++) {
    const at = new Vector3(...size_mm.map((side, axis) => (corner & (1 << axis) ? side / 2 : -side / 2)));
    const across = (ROOM * Math.abs(at.dot(right))) / (slope * aspect);
    const high = (ROOM * Math.abs(at.dot(up))) / slope;
    distance = Math.max(distance, at.dot(look) + Math.max(across, high));
  }
  return distance;
}

/** Puts a camera at the first view of a model, with all of the model visible. */
export function lookFirst(camera: PerspectiveCamera, size_mm: Triple): void {
  const middle = new Vector3(0, 0, size_mm[2] / 2);
  const distance = distanceOf(size_mm, FIRST, camera.aspect);
  camera.position.copy(middle).addScaledVector(FIRST, distance);
  camera.near = 0.01 * distance;
  camera.far = 40 * distance;
  camera.lookAt(middle);
  camera.updateProjectionMatrix();
}

const QUARTER_TURN = Math.PI / 2;

export class Cameras {
  readonly controls: OrbitControls;
  readonly #free = perspective();
  readonly #side = new OrthographicCamera();
  #aligned = false;
  #size_mm: Triple = [1, 1, 1];
  #view: readonly [number, number] = [1, 1];
  /** Where the free camera was before the view was aligned, to be restored afterwards. */
  #left: { readonly position: Triple; readonly target: Triple } | null = null;

  /** @param surface gets its `touch-action` from the style sheet, not from here */
  constructor(surface: HTMLElement) {
    this.#side.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.#free, surface);
    this.controls.rotateSpeed = 0.9;
    this.controls.zoomSpeed = 1.2;
    surface.style.touchAction = "";
  }

  get current(): PerspectiveCamera | OrthographicCamera {
    return this.#aligned ? this.#side : this.#free;
  }

  setDamping(on: boolean): void {
    this.controls.enableDamping = on;
    this.controls.dampingFactor = 0.12;
  }

  setView(width_px: number, height_px: number): void {
    this.#view = [width_px, height_px];
    this.#free.aspect = width_px / height_px;
    this.#free.updateProjectionMatrix();
  }

  /** Follows a model that has changed its pose: moves up or down with the model's middle. */
  follow(size_mm: Triple): void {
    const risen = (size_mm[2] - this.#size_mm[2]) / 2;
    this.#size_mm = size_mm;
    if (this.#aligned) return;
    this.controls.target.z += risen;
    this.#free.position.z += risen;
    this.#limit();
  }

  /** Returns to the first view of the whole model. */
  reset(size_mm: Triple = this.#size_mm): void {
    this.#size_mm = size_mm;
    this.#left = null;
    const target = new Vector3(0, 0, size_mm[2] / 2);
    if (this.#aligned) {
      this.#lookAlong(QUARTER_TURN, 0);
      return;
    }
    this.controls.target.copy(target);
    this.#free.position.copy(target).addScaledVector(FIRST, distanceOf(size_mm, FIRST, this.#free.aspect));
    this.#limit();
    this.controls.update();
  }

  /** Turns about the target: to the right and upwards, degrees. */
  turn(right_deg: number, up_deg: number): void {
    this.controls.rotateLeft(-MathUtils.degToRad(right_deg));
    this.controls.rotateUp(-MathUtils.degToRad(up_deg));
    this.controls.update();
  }

  /** Zooms in by this factor; a factor below one zooms out. */
  zoom(factor: number): void {
    if (this.#aligned) return;
    this.controls.dollyIn(1 / factor);
    this.controls.update();
  }

  setAligned(aligned: boolean): void {
    if (aligned === this.#aligned) return;
    const { controls } = this;
    if (aligned) this.#left = this.#viewpoint;
    this.#aligned = aligned;
    controls.object = this.current;
    controls.enableZoom = controls.enablePan = !aligned;
    controls.minPolarAngle = aligned ? QUARTER_TURN : 0;
    controls.maxPolarAngle = aligned ? QUARTER_TURN : Math.PI;
    if (aligned) this.#lookAlong(QUARTER_TURN, 0);
    else if (this.#left !== null) {
      this.#limit();
      this.#goTo(this.#left);
    } else this.reset();
  }

  /** Prepares the current camera for drawing; returns where heights appear, or `null` in perspective. */
  prepare(alignment: Alignment | null): Frame | null {
    const reach = Math.hypot(...this.#size_mm);
    if (!this.#aligned || alignment === null) {
      const away = this.#free.position.distanceTo(this.controls.target);
      this.#free.near = Math.max(away - 4 * reach, 0.005 * away);
      this.#free.far = away + 40 * reach;
      this.#free.updateProjectionMatrix();
      return null;
    }
    const { heights_mm: heights, inset } = alignment;
    const [width, height] = this.#view;
    const [bottom, top] = heights ?? [0, this.#size_mm[2]];
    const room = Math.max(1, height - inset.top_px - inset.bottom_px);
    // Turning about z must not change the scale, so the diagonal counts.
    const across = Math.hypot(this.#size_mm[0], this.#size_mm[1]);
    const perPixel = Math.max((top - bottom) / room, heights === null ? across / (0.94 * width) : 0, 1e-9);
    const lowest = bottom - inset.bottom_px * perPixel;
    const z = this.controls.target.z;
    Object.assign(this.#side, {
      left: (-width / 2) * perPixel,
      right: (width / 2) * perPixel,
      bottom: lowest - z,
      top: lowest + height * perPixel - z,
      near: 0.01 * reach,
      far: 20 * reach,
    });
    this.#side.updateProjectionMatrix();
    // To hundredths, so that rounding errors do not count as a change.
    const rowOf = (z_mm: number): number => Math.round(100 * (height - (z_mm - lowest) / perPixel)) / 100;
    return { top_px: rowOf(this.#size_mm[2]), bottom_px: rowOf(0) };
  }

  /** Rotation of the current camera: turns its right, up and backward axes into the plate's frame. */
  get turned(): Rotation {
    const { x, y, z, w } = this.current.quaternion;
    return [x, y, z, w];
  }

  /** Where a point of the scene is in the view, CSS pixels. */
  project(point: Vector3): readonly [number, number] {
    const { x, y } = point.clone().project(this.current);
    return [((x + 1) / 2) * this.#view[0], ((1 - y) / 2) * this.#view[1]];
  }

  dispose(): void {
    this.controls.dispose();
  }

  get #viewpoint(): { readonly position: Triple; readonly target: Triple } {
    const { position } = this.#free;
    const { target } = this.controls;
    return { position: [position.x, position.y, position.z], target: [target.x, target.y, target.z] };
  }

  #goTo({ position, target }: { readonly position: Triple; readonly target: Triple }): void {
    this.#free.position.set(...position);
    this.controls.target.set(...target);
    this.controls.update();
  }

  #limit(): void {
    const distance = distanceOf(this.#size_mm, FIRST, this.#free.aspect);
    this.controls.minDistance = NEAREST * distance;
    this.controls.maxDistance = FARTHEST * distance;
  }

  /** Polar angle from above and azimuth from the front. */
  #lookAlong(polar: number, azimuth: number): void {
    const reach = 10 * Math.hypot(...this.#size_mm);
    const target = new Vector3(0, 0, this.#size_mm[2] / 2);
    this.controls.target.copy(target);
    this.#side.position
      .set(Math.sin(polar) * Math.sin(azimuth), -Math.sin(polar) * Math.cos(azimuth), Math.cos(polar))
      .multiplyScalar(reach)
      .add(target);
    this.controls.minDistance = 0;
    this.controls.maxDistance = Infinity;
    this.controls.update();
  }
}
