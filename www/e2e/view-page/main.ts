/** A page with only the view, which tests control through `window.harness`. */
import { CuspView } from "../../src/view/cusp-view.js";
import { ball, box, cone } from "../../src/view/fixtures.js";

export interface Heard {
  readonly type: string;
  readonly detail: unknown;
}

const TYPES = ["cusp-rotate", "cusp-height", "cusp-layer", "cusp-frame", "cusp-view-error"];

/** Nine numbers a facet from a binary STL. */
function facetsOf(stl: ArrayBuffer): Float32Array {
  const view = new DataView(stl);
  const count = view.getUint32(80, true);
  const out = new Float32Array(9 * count);
  for (let facet = 0; facet < count; facet++) {
    for (let i = 0; i < 9; i++) out[9 * facet + i] = view.getFloat32(84 + 50 * facet + 12 + 4 * i, true);
  }
  return out;
}

const heard: Heard[] = [];
customElements.define("cusp-view", CuspView);
const view = document.createElement("cusp-view");
for (const type of TYPES) {
  view.addEventListener(type, (event) => heard.push({ type, detail: (event as CustomEvent<unknown>).detail }));
}

const harness = {
  view,
  heard,
  solids: { ball, box, cone },
  facetsOf,
  /** Sets properties and waits until they are drawn. */
  async set(properties: Partial<CuspView>): Promise<void> {
    Object.assign(view, properties);
    await view.updateComplete;
    await harness.drawn();
  },
  /** Waits for two frames: the requested one, and the one after it. */
  async drawn(): Promise<void> {
    for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
  },
  show(): void {
    document.querySelector("main")?.append(view);
  },
};

export type Harness = typeof harness;

Object.assign(window, { harness });
