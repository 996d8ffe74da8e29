import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { whenWanted } from "./when-wanted.js";

const element = {} as Element;
let calls: number;
let life: AbortController;
let seen: (isIntersecting: boolean) => void;
let watched: Element[];

class FakeObserver {
  constructor(told: (entries: { isIntersecting: boolean }[]) => void) {
    seen = (isIntersecting) => {
      if (watched.length > 0) told([{ isIntersecting }]);
    };
  }
  observe(it: Element): void {
    watched.push(it);
  }
  disconnect(): void {
    watched = [];
  }
}

const drag = (...types: string[]): boolean => window.dispatchEvent(Object.assign(new Event("dragenter"), { dataTransfer: { types } }));

beforeEach(() => {
  [calls, life, watched] = [0, new AbortController(), []];
  vi.stubGlobal("window", new EventTarget());
  vi.stubGlobal("IntersectionObserver", FakeObserver);
});

afterEach(() => vi.unstubAllGlobals());

const want = (): void => whenWanted(element, () => calls++, life.signal);

test("an element in view is wanted, once; one out of view is not", () => {
  want();
  seen(false);
  expect(calls).toBe(0);
  seen(true);
  seen(true);
  drag("Files");
  expect([calls, watched]).toEqual([1, []]);
});

test("so is one out of view while files are dragged over the page, but not while text is", () => {
  want();
  drag("text/plain");
  expect(calls).toBe(0);
  drag("Files");
  seen(true);
  expect([calls, watched]).toEqual([1, []]);
});

test("an element that is gone is not wanted", () => {
  want();
  life.abort();
  drag("Files");
  expect([calls, watched]).toEqual([0, []]);
});

test("where a browser does not say what is in view, every element is wanted", () => {
  vi.stubGlobal("IntersectionObserver", undefined);
  want();
  expect(calls).toBe(1);
});
