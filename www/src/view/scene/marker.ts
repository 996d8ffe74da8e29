/** A box that marks a place on the model; seen through it, too. */
import { BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial } from "three";
import type { Triple } from "./pose.js";

/** A place to show, in the frame of the model as it stands: centred on x = y = 0, with the plate at z = 0. Lengths in mm. */
export interface Mark {
  readonly at_mm: Triple;
  /** Its smallest and largest corner. */
  readonly bounds_mm: readonly [Triple, Triple];
}

/** In no palette of layers as a whole, and seen on each. */
export const MARK_COLOUR = 0xff9f1a;

/** The least side of a box, as a part of the model's longest: smaller ones would not be seen. */
const LEAST = 0.01;

export function middleOf({ bounds_mm: [low, high] }: Mark): Triple {
  return [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
}

export class Marker {
  readonly group = new Group();
  readonly #box = new BoxGeometry(1, 1, 1);
  readonly #edges = new EdgesGeometry(this.#box);
  readonly #fill = new MeshBasicMaterial({ color: MARK_COLOUR, transparent: true, opacity: 0.25, depthTest: false, depthWrite: false });
  readonly #lines = new LineBasicMaterial({ color: MARK_COLOUR, transparent: true, depthTest: false, depthWrite: false });

  constructor() {
    const [fill, lines] = [new Mesh(this.#box, this.#fill), new LineSegments(this.#edges, this.#lines)];
    // After the model, which it shines through.
    fill.renderOrder = 10;
    lines.renderOrder = 11;
    this.group.add(fill, lines);
    this.group.visible = false;
  }

  set(mark: Mark | null, size_mm: Triple): void {
    this.group.visible = mark !== null;
    if (mark === null) return;
    const [low, high] = mark.bounds_mm;
    const least = LEAST * Math.max(...size_mm);
    this.group.position.set(...middleOf(mark));
    this.group.scale.set(Math.max(least, high[0] - low[0]), Math.max(least, high[1] - low[1]), Math.max(least, high[2] - low[2]));
  }

  dispose(): void {
    this.#box.dispose();
    this.#edges.dispose();
    this.#fill.dispose();
    this.#lines.dispose();
  }
}
