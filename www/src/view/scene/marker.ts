/** Outlines of boxes that mark places on a model; also visible through the model, whose surface in them is painted. */
import { BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, type Vector3 } from "three";
import type { Triple } from "./pose.js";

/** A place to mark, mm from the middle of the plate. */
export interface Mark {
  readonly at_mm: Triple;
  /** Minimum and maximum corner. */
  readonly bounds_mm: readonly [Triple, Triple];
  /** True for a hollow, around which no surface is painted. */
  readonly isHollow?: boolean;
}

/** In no layer palette, and visible on all of them. */
export const MARK_COLOUR = 0xff9f1a;

/** Minimum side of a box, as a fraction of the model's longest side; smaller ones would be invisible. */
const LEAST = 0.01;

/** Findings are measured in pixels, up to whose width the surface lies beside them. */
const MARGIN_MM = 0.1;

export function middleOf({ bounds_mm: [low, high] }: Mark): Triple {
  return [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
}

export class Marker {
  readonly group = new Group();
  readonly #edges = new EdgesGeometry(new BoxGeometry(1, 1, 1));
  readonly #lines: LineBasicMaterial;
  #painted: readonly LineSegments[] = [];

  constructor(isFaint = false) {
    this.#lines = new LineBasicMaterial({ color: MARK_COLOUR, transparent: true, opacity: isFaint ? 0.6 : 1, depthTest: false, depthWrite: false });
  }

  /** Diagonal of each box, mm; all marks are copies of one. */
  get diagonal_mm(): number {
    return this.group.children[0]?.scale.length() ?? 0;
  }

  /** Boxes whose surface is to be painted: minimum and maximum corner of each, with a margin. */
  get painted(): readonly (readonly [Vector3, Vector3])[] {
    return this.#painted.map(({ position, scale }) => {
      const half = scale.clone().multiplyScalar(0.5).addScalar(MARGIN_MM);
      return [position.clone().sub(half), position.clone().add(half)];
    });
  }

  set(marks: readonly Mark[], size_mm: Triple): void {
    const least = LEAST * Math.max(...size_mm);
    const boxes = marks.map((mark) => {
      const [low, high] = mark.bounds_mm;
      const box = new LineSegments(this.#edges, this.#lines);
      // After the model, through which it is visible.
      box.renderOrder = 10;
      box.position.set(...middleOf(mark));
      box.scale.set(Math.max(least, high[0] - low[0]), Math.max(least, high[1] - low[1]), Math.max(least, high[2] - low[2]));
      return box;
    });
    this.#painted = boxes.filter((_, i) => marks[i]?.isHollow !== true);
    this.group.clear();
    if (boxes.length > 0) this.group.add(...boxes);
  }

  dispose(): void {
    this.#edges.dispose();
    this.#lines.dispose();
  }
}
