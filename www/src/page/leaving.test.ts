import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Handwork } from "../element/slicer-element.js";
import { askBeforeLeaving } from "./leaving.js";

const NONE: Handwork = { isPainted: false, points: "", drains: "", models: 1 };

class Element extends EventTarget {
  work = NONE;
  report = {};
  readonly handwork = (): Handwork => this.work;
  get plates(): unknown {
    return { plates: [{ report: this.report }] };
  }
  /** Sets the user's handwork and fires an event. */
  does(work: Partial<Handwork>, event: string): void {
    this.work = { ...this.work, ...work };
    if (event !== "cusp-export") this.report = {};
    this.dispatchEvent(new Event(event));
  }
}

let element: Element;

let isKept: boolean;

const start = (asked = ""): void => {
  element = new Element();
  isKept = false;
  askBeforeLeaving(element as unknown as Parameters<typeof askBeforeLeaving>[0], asked, () => isKept);
};

const asks = (): boolean => !window.dispatchEvent(new Event("beforeunload", { cancelable: true }));

beforeEach(() => {
  vi.stubGlobal("window", new EventTarget());
  start();
});

afterEach(() => vi.unstubAllGlobals());

test("whoever only opens and plans a model leaves without a question", () => {
  element.does({}, "cusp-load");
  element.does({}, "cusp-change");
  element.does({}, "cusp-plan");
  expect(asks()).toBe(false);
});

test.each([
  ["weights", { isPainted: true }, "cusp-paint"],
  ["support points", { points: "1,2,3,,1" }, "cusp-change"],
  ["drain holes", { drains: "1,2,3" }, "cusp-change"],
  ["several models", { models: 2 }, "cusp-load"],
] as const)("%s made by hand are asked about until the print file is saved or they are gone", (_, work, event) => {
  element.does(work, event);
  expect(asks()).toBe(true);
  element.does({}, "cusp-export");
  expect(asks()).toBe(false);
  element.does({}, "cusp-plan");
  expect(asks()).toBe(true);
  element.does(NONE, "cusp-plan");
  expect(asks()).toBe(false);
});

test("points that a link brought are still in it", () => {
  start("points=1%2C2%2C3%2C%2C1&supports=light");
  element.does({ points: "1,2,3,,1" }, "cusp-plan");
  expect(asks()).toBe(false);
  element.does({ points: "1,2,3,,1;4,5,6,,1" }, "cusp-change");
  expect(asks()).toBe(true);
});

test("work that the browser has kept is left without a question", () => {
  element.does({ isPainted: true }, "cusp-paint");
  expect(asks()).toBe(true);
  isKept = true;
  expect(asks()).toBe(false);
});
