/** Outlines of the selected copies. */
import { BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments } from "three";
import type { Rgb } from "../legend/palette.js";
import { matrixOf, type Copy } from "./copies.js";
import type { Triple } from "./pose.js";

export class Selection {
  readonly group = new Group();
  readonly #edges: EdgesGeometry;
  readonly #lines = new LineBasicMaterial();

  constructor() {
    const box = new BoxGeometry(1, 1, 1).translate(0, 0, 0.5);
    this.#edges = new EdgesGeometry(box);
    box.dispose();
  }

  setTheme([r, g, b]: Rgb): void {
    this.#lines.color.setRGB(r / 255, g / 255, b / 255, "srgb");
  }

  set(copies: readonly Copy[], sizeOf: (copy: Copy) => Triple): void {
    const boxes = copies.map((copy) => {
      const box = new LineSegments(this.#edges, this.#lines);
      box.matrixAutoUpdate = false;
      box.matrix.copy(matrixOf(copy)).scale(box.scale.set(...sizeOf(copy)));
      return box;
    });
    this.group.clear();
    if (boxes.length > 0) this.group.add(...boxes);
  }

  dispose(): void {
    this.#edges.dispose();
    this.#lines.dispose();
  }
}
