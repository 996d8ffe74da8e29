/** The cameras of the view: a free one in perspective, and one from the side at the scale of a neighbouring chart. */
import { MathUtils, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Rotation, Triple } from "./pose.js";
import { FIRST_LOOK } from "./turn.js";
import { areSame, between, eased, type Viewpoint } from "./viewpoint.js";

/** Positions of heights in the view, CSS pixels from its upper edge. */
export interface Frame {
  /** Top of the model. */
  readonly top_px: number;
  /** Plate, z = 0. */
  readonly bottom_px: number;
}

/** Room above and below the heights shown in an aligned view, CSS pixels. */
export interface Inset {
  readonly top_px: number;
  readonly bottom_px: number;
}

/** A range of heights, mm. */
export type Heights = readonly [bottom: number, top: number];

/** Height range of an aligned view, and its position there. */
export interface Alignment {
  /** Null for the whole model. */
  readonly heights_mm: Heights | null;
  readonly inset: Inset;
}

const FIELD_OF_VIEW_DEG = 26;

/** Margin factor around the model in the free view. */
const ROOM = 1.14;

/** Limits of the camera's distance, as multiples of that at which the whole model is visible. */
const NEAREST = 0.05;
const FARTHEST = 6;

/** Steepness of the view of a place, as rise over run. */
const SIDEWAYS = 0.6;

/** A place faced by the camera covers at least this many pixels, unless it is smaller than this fraction of the model. */
const FACED_PX = 180;
const FACED_PART = 0.3;

/** Fraction of a view's width and height that counts as visible. */
const SIGHT = 0.9;

const FIRST = new Vector3(...FIRST_LOOK);

/** A perspective camera with z upwards. */
export function perspective(): PerspectiveCamera {
  const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG);
  camera.up.set(0, 0, 1);
  return camera;
}

/** Distance from the model's centre in direction `look` at which all corners of its bounds are just visible. */
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

/** Moves a camera to the initial view, with the whole model visible. */
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

/** A camera movement in progress. */
interface Flight {
  readonly from: Viewpoint;
  readonly to: Viewpoint;
  readonly start_ms: number;
  readonly duration_ms: number;
}

export class Cameras {
  readonly controls: OrbitControls;
  readonly #free = perspective();
  readonly #side = new OrthographicCamera();
  #aligned = false;
  #size_mm: Triple = [1, 1, 1];
  #view: readonly [number, number] = [1, 1];
  /** Width of the strip at the right that other content covers, CSS pixels. */
  #aside_px = 0;
  /** Viewpoint of the free camera before the view was aligned, to restore afterwards. */
  #left: Viewpoint | null = null;
  #flight: Flight | null = null;
  /** Minimum distance near a place that the camera has approached. */
  #nearest = Infinity;
  /** Viewpoints of the free camera before and after it approached a place. */
  #approached: { readonly from: Viewpoint; readonly to: Viewpoint } | null = null;

  /** @param surface keeps its `touch-action` from the style sheet */
  constructor(surface: HTMLElement) {
    this.#side.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.#free, surface);
    this.controls.rotateSpeed = 0.9;
    this.controls.zoomSpeed = 1.2;
    surface.style.touchAction = "";
    this.controls.addEventListener("start", () => (this.#flight = null));
  }

  get current(): PerspectiveCamera | OrthographicCamera {
    return this.#aligned ? this.#side : this.#free;
  }

  setDamping(on: boolean): void {
    this.controls.enableDamping = on;
    this.controls.dampingFactor = 0.12;
  }

  /**
   * Sets the size of the view. A camera not yet moved by the user keeps showing the whole model.
   *
   * @param aside_px width of a strip at the right that is covered: the scene is centred in the rest
   */
  setView(width_px: number, height_px: number, aside_px = 0): void {
    const at = this.#aligned ? this.#left : this.#viewpoint;
    const isFirst = this.#flight === null && at !== null && areSame(at, this.#first);
    this.#view = [width_px, height_px];
    this.#aside_px = Math.min(aside_px, width_px / 2);
    this.#shape(this.#free);
    if (!isFirst) return;
    if (this.#aligned) this.#left = this.#first;
    else {
      this.#limit();
      this.#goTo(this.#first);
    }
  }

  /** Follows a model that has changed its pose: moves up or down with the model's centre. */
  follow(size_mm: Triple): void {
    const risen = (size_mm[2] - this.#size_mm[2]) / 2;
    this.#size_mm = size_mm;
    if (this.#aligned) return;
    this.#flight = null;
    this.controls.target.z += risen;
    this.#free.position.z += risen;
    this.#limit();
  }

  /** Returns to the initial view of the whole model. */
  reset(size_mm: Triple = this.#size_mm): void {
    this.#size_mm = size_mm;
    this.#left = this.#flight = this.#approached = null;
    this.#nearest = Infinity;
    if (this.#aligned) {
      this.#lookAlong(QUARTER_TURN, 0);
      return;
    }
    this.#limit();
    this.#goTo(this.#first);
  }

  /** Turns around the target, to the right and upwards, degrees. */
  turn(right_deg: number, up_deg: number): void {
    this.#flight = null;
    this.controls.rotateLeft(-MathUtils.degToRad(right_deg));
    this.controls.rotateUp(-MathUtils.degToRad(up_deg));
    this.controls.update();
  }

  /** Zooms in by this factor; a factor below one zooms out. */
  zoom(factor: number): void {
    if (this.#aligned) return;
    this.#flight = null;
    this.controls.dollyIn(1 / factor);
    this.controls.update();
  }

  setAligned(aligned: boolean): void {
    if (aligned === this.#aligned) return;
    const { controls } = this;
    if (aligned) this.#left = this.#viewpoint;
    this.#flight = null;
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

  /** Direction for approaching a place: that of the free camera, but at most 45° steep. */
  get approach(): Triple {
    const { position, target } = this.#viewpoint;
    const [x, y, z] = [position[0] - target[0], position[1] - target[1], position[2] - target[2]];
    const level = Math.hypot(x, y);
    const height = Math.sign(z) * Math.min(Math.abs(z), Math.max(level, 1e-9));
    // Vertical views have no level direction, so use the front.
    const away = new Vector3(level > 0 ? x : 0, level > 0 ? y : -1, level > 0 ? height : Math.sign(z)).normalize();
    return [away.x, away.y, away.z];
  }

  /** Distance at which a length across the line of sight covers this many pixels of the view; at most that of the whole model. */
  distanceFor(length_mm: number, pixels: number): number {
    const slope = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
    const whole = distanceOf(this.#size_mm, FIRST, this.#aspect);
    return Math.min(whole, (this.#view[1] * length_mm) / (2 * slope * pixels));
  }

  /** A camera at this viewpoint with the view's shape, for visibility tests. */
  tried({ position, target }: Viewpoint): PerspectiveCamera {
    const camera = perspective();
    const away = new Vector3(...position).distanceTo(new Vector3(...target));
    camera.near = 0.005 * away;
    camera.far = away + 40 * Math.hypot(...this.#size_mm);
    camera.position.set(...position);
    camera.lookAt(new Vector3(...target));
    camera.updateMatrixWorld();
    this.#shape(camera);
    return camera;
  }

  /** Middle of the uncovered part of the view, CSS pixels. */
  get middle(): readonly [number, number] {
    return [(this.#view[0] - this.#aside_px) / 2, this.#view[1] / 2];
  }

  /** Width of the uncovered part of the view, CSS pixels. */
  get width_px(): number {
    return this.#view[0] - this.#aside_px;
  }

  /** Viewpoint of the free camera, or the end of its flight. */
  get goal(): Viewpoint {
    return this.#flight?.to ?? this.#viewpoint;
  }

  /** Returns true if a camera at this viewpoint has a point within its view, not at the very edge. Ignores occlusion. */
  shows(from: Viewpoint, point: Vector3): boolean {
    const { x, y, z } = point.clone().project(this.tried(from));
    const covered = this.#aside_px / this.#view[0];
    return Math.max(Math.abs(x + covered) / (1 - covered), Math.abs(y)) < SIGHT && z < 1;
  }

  moveTo(to: Viewpoint, duration_ms: number): void {
    if (!this.#aligned) this.#fly(this.#viewpoint, to, duration_ms);
  }

  /** Moves the free camera to a viewpoint, from which `withdraw` returns. */
  approachTo(to: Viewpoint, duration_ms: number): void {
    if (this.#aligned) return;
    const from = this.#viewpoint;
    this.#approached = { from, to };
    const away = new Vector3(...to.position).distanceTo(new Vector3(...to.target));
    this.#nearest = NEAREST * away;
    this.#limit();
    this.#fly(from, to, duration_ms);
  }

  /** Turns a place to the viewer: around z in an aligned view, otherwise from outside, near enough to see `length_mm` there. */
  face([x, y, z]: Triple, length_mm: number, duration_ms: number): void {
    const outward = Math.hypot(x, y);
    // In the middle of the model, no side is nearer than another.
    const isCentral = outward < 0.02 * Math.hypot(...this.#size_mm);
    if (this.#aligned) {
      if (!isCentral) this.#lookAlong(QUARTER_TURN, Math.atan2(x, -y));
      return;
    }
    const [fx, fy] = isCentral ? FIRST_LOOK : [x / outward, y / outward];
    // From below for places in the lower half.
    const direction = new Vector3(fx, fy, 0).normalize().setZ(2 * z < this.#size_mm[2] ? -SIDEWAYS : SIDEWAYS).normalize();
    const whole_mm = Math.hypot(...this.#size_mm);
    const away = this.distanceFor(Math.max(length_mm, FACED_PART * whole_mm), FACED_PX);
    const position = new Vector3(x, y, z).addScaledVector(direction, away).toArray();
    const before = this.#approached?.from;
    this.approachTo({ position, target: [x, y, z] }, duration_ms);
    // After several places in a row, the way back leads to the viewpoint before the first.
    if (before !== undefined && this.#approached !== null) this.#approached = { ...this.#approached, from: before };
  }

  /** Moves the free camera back to its viewpoint before the approach, unless the user has moved it since. */
  withdraw(duration_ms: number): void {
    const approached = this.#approached;
    this.#approached = null;
    if (approached === null || this.#aligned) return;
    const now = this.#viewpoint;
    const isUntouched = this.#flight?.to === approached.to || areSame(now, approached.to);
    if (isUntouched) this.#fly(now, approached.from, duration_ms);
  }

  /** Advances a camera movement; returns true until it ends. */
  advance(now_ms: number): boolean {
    const flight = this.#flight;
    if (flight === null) return false;
    const part = Math.min(1, Math.max(0, (now_ms - flight.start_ms) / flight.duration_ms));
    if (part === 1) this.#flight = null;
    this.#goTo(part === 1 ? flight.to : between(flight.from, flight.to, eased(part)));
    return part < 1;
  }

  /** Prepares the current camera for drawing; returns the positions of heights, or null in perspective. */
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
    // The scale must not change during a turn around z, so the diagonal counts.
    const across = Math.hypot(this.#size_mm[0], this.#size_mm[1]);
    const perPixel = Math.max((top - bottom) / room, heights === null ? across / (0.94 * this.width_px) : 0, 1e-9);
    const lowest = bottom - inset.bottom_px * perPixel;
    const z = this.controls.target.z;
    Object.assign(this.#side, {
      left: -this.middle[0] * perPixel,
      right: (width - this.middle[0]) * perPixel,
      bottom: lowest - z,
      top: lowest + height * perPixel - z,
      near: 0.01 * reach,
      far: 20 * reach,
    });
    this.#side.updateProjectionMatrix();
    // Rounded to hundredths, so that rounding errors do not count as a change.
    const rowOf = (z_mm: number): number => Math.round(100 * (height - (z_mm - lowest) / perPixel)) / 100;
    return { top_px: rowOf(this.#size_mm[2]), bottom_px: rowOf(0) };
  }

  /** Rotation of the current camera: turns its right, up and backward axes into the plate's frame. */
  get turned(): Rotation {
    const { x, y, z, w } = this.current.quaternion;
    return [x, y, z, w];
  }

  /** Position of a point of the scene in the view, CSS pixels. */
  project(point: Vector3): readonly [number, number] {
    const { x, y } = point.clone().project(this.current);
    return [((x + 1) / 2) * this.#view[0], ((1 - y) / 2) * this.#view[1]];
  }

  dispose(): void {
    this.controls.dispose();
  }

  /** Aspect ratio of the uncovered part of the view. */
  get #aspect(): number {
    return this.width_px / this.#view[1];
  }

  /** Gives a camera the shape of the view, with the axis through the middle of its uncovered part. */
  #shape(camera: PerspectiveCamera): void {
    const [width, height] = this.#view;
    camera.aspect = width / height;
    const slope = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
    camera.filmOffset = (camera.getFilmWidth() * slope * this.#aside_px) / height;
    camera.updateProjectionMatrix();
  }

  /** Initial viewpoint, which shows the whole model. */
  get #first(): Viewpoint {
    const middle = this.#size_mm[2] / 2;
    const [x, y, z] = FIRST.toArray().map((part) => part * distanceOf(this.#size_mm, FIRST, this.#aspect)) as [number, number, number];
    return { position: [x, y, middle + z], target: [0, 0, middle] };
  }

  get #viewpoint(): Viewpoint {
    const { position } = this.#free;
    const { target } = this.controls;
    return { position: [position.x, position.y, position.z], target: [target.x, target.y, target.z] };
  }

  #fly(from: Viewpoint, to: Viewpoint, duration_ms: number): void {
    this.#flight = duration_ms > 0 ? { from, to, start_ms: performance.now(), duration_ms } : null;
    if (duration_ms <= 0) this.#goTo(to);
  }

  #goTo({ position, target }: Viewpoint): void {
    this.#free.position.set(...position);
    this.controls.target.set(...target);
    this.controls.update();
  }

  #limit(): void {
    const distance = distanceOf(this.#size_mm, FIRST, this.#aspect);
    this.controls.minDistance = Math.min(NEAREST * distance, this.#nearest);
    this.controls.maxDistance = FARTHEST * distance;
  }

  /** Sets the polar angle from above and the azimuth from the front. */
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
