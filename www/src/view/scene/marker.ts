/** Boxes that mark places on a model; also visible through the model. */
import { BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial } from "three";
import type { Triple } from "./pose.js";

/** A place to mark, in the frame of the posed model: centred on x = y = 0, with the plate at z = 0. Lengths in mm. */
export interface Mark {
  readonly at_mm: Triple;
  /** Minimum and maximum corner. */
  readonly bounds_mm: readonly [Triple, Triple];
}

/** In no layer palette, and visible on all of them. */
export const MARK_COLOUR = 0xff9f1a;

/** Minimum side of a box, as a fraction of the model's longest side; smaller ones would be invisible. */
const LEAST = 0.01;

export function middleOf({ bounds_mm: [low, high] }: Mark): Triple {
  return [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
}

export class Marker {
  readonly group = new Group();
  readonly #box = new BoxGeometry(1, 1, 1);
  readonly #edges = new EdgesGeometry(this.#box);
  readonly #fill = new MeshBasicMaterial({ color: MARK_COLOUR, transparent: true, opacity: 0.25, depthTest: false, depthWrite: false });
  readonly #lines: LineBasicMaterial;
  readonly #isFaint: boolean;

  /** @param isFaint true for outlines alone */
  constructor(isFaint = false) {
    this.#isFaint = isFaint;
    this.#lines = new LineBasicMaterial({ color: MARK_COLOUR, transparent: true, opacity: isFaint ? 0.6 : 1, depthTest: false, depthWrite: false });
  }

  /** Diagonal of each box, mm; all marks are copies of one. */
  get diagonal_mm(): number {
    return this.group.children[0]?.scale.length() ?? 0;
  }

  set(marks: readonly Mark[], size_mm: Triple): void {
    const least = LEAST * Math.max(...size_mm);
    const boxes = marks.map((mark) => {
      const [low, high] = mark.bounds_mm;
      const [fill, lines] = [new Mesh(this.#box, this.#fill), new LineSegments(this.#edges, this.#lines)];
      // After the model, through which it is visible.
      fill.renderOrder = 10;
      lines.renderOrder = 11;
      const box = new Group().add(...(this.#isFaint ? [lines] : [fill, lines]));
      box.position.set(...middleOf(mark));
      box.scale.set(Math.max(least, high[0] - low[0]), Math.max(least, high[1] - low[1]), Math.max(least, high[2] - low[2]));
      return box;
    });
    this.group.clear();
    if (boxes.length > 0) this.group.add(...boxes);
  }

  dispose(): void {
    this.#box.dispose();
    this.#edges.dispose();
    this.#fill.dispose();
    this.#lines.dispose();
  }
}
