/** Handles that turn the model about the axes of the plate, move its copies over the plate, or scale it. */
import { Object3D, Vector3, type Camera } from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Tool } from "./keys.js";
import type { Rotation } from "./pose.js";

/** Turning step while Shift is held, radians. */
const SNAP = Math.PI / 12;

/** Size of the rings in the controls' own unit, which keeps the outermost inside a square view; size of arrows. */
const RINGS = 2.5;
const ARROWS = 1.2;

/** Colours of x, y and z and of what is under the pointer, legible on light and dark pages. */
const COLOURS = ["#d9534f", "#4f9d5d", "#4a80d4", "#e6a117"] as const;

/** Smallest and largest factor of one drag. */
const LEAST_FACTOR = 0.05;
const MOST_FACTOR = 20;

export interface GizmoReports {
  /** Called when a drag starts or ends. */
  held(on: boolean): void;
  /** Called when the handles need redrawing. */
  changed(): void;
  /** Called when the drag has turned the model to this rotation. */
  turned(rotation: Rotation): void;
  /** Called when the drag has ended at this rotation. */
  done(rotation: Rotation): void;
  /** Called when the drag has moved the copies by this, mm. */
  shifted(x_mm: number, y_mm: number, isFinal: boolean): void;
  /** Called when the drag has scaled the model by this factor. */
  sized(factor: number, isFinal: boolean): void;
}

export class Gizmo {
  readonly #controls: TransformControls;
  readonly #reports: GizmoReports;
  /** Carries the arrows: at the selected copy. */
  readonly #handle = new Object3D();
  readonly #start = new Vector3();
  #aspect = 1;
  readonly #snap = ({ shiftKey }: KeyboardEvent): void => {
    this.#controls.setRotationSnap(shiftKey ? SNAP : null);
  };

  constructor(camera: Camera, surface: HTMLElement, scene: Object3D, reports: GizmoReports) {
    const controls = new TransformControls(camera, surface);
    // Resets the inline style: the style sheet decides which touches belong to the page.
    surface.style.touchAction = "";
    this.#controls = controls;
    this.#reports = reports;
    controls.setSpace("world");
    controls.setColors(...COLOURS);
    scene.add(controls.getHelper(), this.#handle);
    controls.addEventListener("change", () => reports.changed());
    controls.addEventListener("objectChange", () => this.#tell(false));
    controls.addEventListener("dragging-changed", ({ value }) => {
      reports.held(value === true);
      if (value === true) this.#start.copy(this.#handle.position);
      else this.#tell(true);
    });
    addEventListener("keydown", this.#snap);
    addEventListener("keyup", this.#snap);
  }

  /** Returns true if the pointer is over a handle or drags one. */
  get isHot(): boolean {
    return this.#controls.axis !== null || this.#controls.dragging;
  }

  /** @param aspect width of the view divided by its height */
  fit(aspect: number): void {
    this.#aspect = Math.min(1, aspect);
    this.#resize();
  }

  /**
   * Shows the handles of a tool, if it has any.
   *
   * @param pivot object that the rings turn
   * @param middle place of the arrows, mm
   */
  show(tool: Tool, pivot: Object3D, middle: Vector3, camera: Camera): void {
    const controls = this.#controls;
    const mode = MODES[tool];
    controls.camera = camera;
    controls.enabled = mode !== undefined;
    if (mode === undefined) return void controls.detach();
    if (!controls.dragging) this.#handle.position.copy(middle);
    const object = mode === "rotate" ? pivot : this.#handle;
    if (controls.object === object && controls.mode === mode) return;
    controls.setMode(mode);
    // Copies stay on the plate.
    controls.showZ = mode !== "translate";
    controls.attach(object);
    this.#resize();
  }

  dispose(): void {
    removeEventListener("keydown", this.#snap);
    removeEventListener("keyup", this.#snap);
    this.#controls.detach();
    this.#controls.getHelper().removeFromParent();
    this.#controls.dispose();
  }

  #resize(): void {
    this.#controls.setSize((this.#controls.mode === "rotate" ? RINGS : ARROWS) * this.#aspect);
  }

  #tell(isFinal: boolean): void {
    const { object, mode } = this.#controls;
    if (object === undefined) return;
    if (mode === "rotate") {
      const { x, y, z, w } = object.quaternion;
      return isFinal ? this.#reports.done([x, y, z, w]) : this.#reports.turned([x, y, z, w]);
    }
    const { position, scale } = this.#handle;
    if (mode === "translate") return this.#reports.shifted(position.x - this.#start.x, position.y - this.#start.y, isFinal);
    // Models scale as a whole: the axis that was dragged farthest counts.
    const factors = scale.toArray().map((part) => Math.min(Math.max(part, LEAST_FACTOR), MOST_FACTOR));
    const factor = factors.reduce((most, part) => (Math.abs(Math.log(part)) > Math.abs(Math.log(most)) ? part : most), 1);
    if (isFinal) scale.setScalar(1);
    this.#reports.sized(factor, isFinal);
  }
}

const MODES: Readonly<Partial<Record<Tool, "rotate" | "translate" | "scale">>> = { rotate: "rotate", move: "translate", size: "scale" };
