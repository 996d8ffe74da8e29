/** Rings that turn the model about the axes of the plate. */
import type { Camera, Object3D } from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Rotation } from "./pose.js";

/** Turning step while Shift is held, radians. */
const SNAP = Math.PI / 12;

/** Size of the rings in the controls' own unit, which keeps the outermost inside a square view. */
const SIZE = 2.5;

/** Colours of the x, y and z rings and of the ring under the pointer, legible on light and dark pages. */
const COLOURS = ["#d9534f", "#4f9d5d", "#4a80d4", "#e6a117"] as const;

export interface GizmoReports {
  /** Called when the drag of a ring starts or ends. */
  held(on: boolean): void;
  /** Called when the rings need redrawing. */
  changed(): void;
  /** Called when the drag has turned the model to this rotation. */
  turned(rotation: Rotation): void;
  /** Called when the drag has ended at this rotation. */
  done(rotation: Rotation): void;
}

export class Gizmo {
  readonly #controls: TransformControls;
  readonly #snap = ({ shiftKey }: KeyboardEvent): void => {
    this.#controls.setRotationSnap(shiftKey ? SNAP : null);
  };

  constructor(camera: Camera, surface: HTMLElement, scene: Object3D, reports: GizmoReports) {
    const controls = new TransformControls(camera, surface);
    // Resets the inline style: the style sheet decides which touches belong to the page.
    surface.style.touchAction = "";
    this.#controls = controls;
    controls.setMode("rotate");
    controls.setSpace("world");
    controls.setColors(...COLOURS);
    scene.add(controls.getHelper());
    const rotation = (): Rotation | null => {
      if (controls.object === undefined) return null;
      const { x, y, z, w } = controls.object.quaternion;
      return [x, y, z, w];
    };
    controls.addEventListener("change", () => reports.changed());
    controls.addEventListener("objectChange", () => {
      const now = rotation();
      if (now !== null) reports.turned(now);
    });
    controls.addEventListener("dragging-changed", ({ value }) => {
      reports.held(value === true);
      const now = rotation();
      if (value !== true && now !== null) reports.done(now);
    });
    addEventListener("keydown", this.#snap);
    addEventListener("keyup", this.#snap);
  }

  /** Returns true if the pointer is over a ring or drags one. */
  get isHot(): boolean {
    return this.#controls.axis !== null || this.#controls.dragging;
  }

  /** @param aspect width of the view divided by its height */
  fit(aspect: number): void {
    this.#controls.setSize(SIZE * Math.min(1, aspect));
  }

  show(object: Object3D | null, camera: Camera): void {
    this.#controls.camera = camera;
    this.#controls.enabled = object !== null;
    if (object === null) this.#controls.detach();
    else if (this.#controls.object !== object) this.#controls.attach(object);
  }

  dispose(): void {
    removeEventListener("keydown", this.#snap);
    removeEventListener("keyup", this.#snap);
    this.#controls.detach();
    this.#controls.getHelper().removeFromParent();
    this.#controls.dispose();
  }
}
