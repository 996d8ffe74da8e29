/** Properties set by a page. Frameworks set new objects, equal to the previous ones, at every render. */
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { CuspSlicer } from "./cusp-slicer.js";
import { FakeSlicer, model, planOf } from "./state/fake-slicer.js";

vi.mock("../api/index.js", async (original) => ({ ...(await original<object>()), createSlicer: () => new FakeSlicer() }));

/** An element that records its events, and runs a callback of the page after each. */
class Watched extends CuspSlicer {
  readonly told: string[] = [];
  onTold = (): void => undefined;
  override dispatchEvent({ type }: Event): boolean {
    this.told.push(type);
    setTimeout(() => this.onTold());
    return true;
  }
}

let element: Watched;
let slicer: FakeSlicer;

/** Answers pending calls until none is left. */
async function settle(): Promise<void> {
  for (let answered = -1; answered < slicer.calls.length; ) {
    answered = slicer.calls.length;
    for (const { what, resolve } of slicer.calls) resolve(what === "open" ? model : what === "plan" ? planOf(10) : { findings: [] });
    await vi.advanceTimersByTimeAsync(300);
    if (answered > 50) throw new Error("it goes on for ever");
  }
}

const planned = (): number => slicer.calls.filter(({ what }) => what === "plan").length;

beforeEach(async () => {
  vi.useFakeTimers();
  vi.spyOn(console, "warn").mockImplementation(() => undefined);
  element = new Watched();
  slicer = element.slicer as unknown as FakeSlicer;
  element.load(new Blob(), "a.stl").catch(() => undefined);
  await settle();
});

afterEach(() => {
  vi.useRealTimers();
});

/** Values that a page with literals in its markup sets at each render. */
const GIVEN = {
  printer: () => ({ model: "Big One", pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245] }),
  resins: () => [{ name: "Grey", exposure_s: 2 }],
  prices: () => ({ currency: "EUR", resin: [{ per_ml: 8, name: "Grey" }] }),
  limits: () => ({ wall_mm: 0.4, most_peel_mm2: 900 }),
  weights: () => new Float32Array([1, 0.5, 0.25]),
  backend: () => "cpu",
  gpuMethod: () => "peel",
  query: () => "metric=area",
} as const;

test.each(Object.entries(GIVEN))("%s that equals what is there changes nothing, and one that differs does", async (name, value) => {
  Object.assign(element, { [name]: value() });
  await settle();
  const asked = [slicer.calls.length, slicer.orders.length];
  element.told.length = 0;
  const updates = vi.spyOn(element, "requestUpdate");
  for (const _ of [1, 2, 3]) {
    Object.assign(element, { [name]: value() });
    await settle();
  }
  expect([[slicer.calls.length, slicer.orders.length], element.told, updates.mock.calls.length]).toEqual([asked, [], 0]);
  Object.assign(element, { [name]: name === "query" ? "" : null });
  await settle();
  expect(updates.mock.calls.length).toBeGreaterThan(0);
});

test("a page that sets everything anew at each event ends with one plan", async () => {
  const render = (): void => {
    Object.assign(element, { printer: GIVEN.printer(), resins: GIVEN.resins(), prices: GIVEN.prices(), limits: GIVEN.limits() });
  };
  const before = planned();
  element.onTold = render;
  render();
  await settle();
  // The previous plan has a price, too.
  expect([planned() - before, slicer.orders.length]).toEqual([1, 2]);
  expect(element.told.filter((it) => it === "cusp-plan")).toHaveLength(2);
});

test("what a page changes in place counts once it is set again", async () => {
  const prices = { currency: "EUR" };
  const weights = new Float32Array([1, 1]);
  Object.assign(element, { prices, weights });
  await settle();
  prices.currency = "USD";
  weights[1] = 0;
  Object.assign(element, { prices, weights });
  await settle();
  expect(slicer.orders.map(({ prices }) => prices.currency)).toEqual(["EUR", "EUR", "USD", "USD"]);
  expect(slicer.painted).toEqual([new Float32Array([1, 1]), new Float32Array([1, 0])]);
});

test("the same wrong value is told once, until a good one came between", async () => {
  const wrong = (): unknown => ({ printer: { pixels: [1] } });
  const told = (): number => element.told.splice(0).filter((it) => it === "cusp-error").length;
  element.onTold = () => Object.assign(element, wrong());
  Object.assign(element, wrong());
  await settle();
  expect(told()).toBe(1);
  element.onTold = () => undefined;
  Object.assign(element, { printer: "" });
  Object.assign(element, wrong());
  await settle();
  expect(told()).toBe(1);
});

test("a framework takes a property away by setting it to undefined", async () => {
  for (const [name, value] of Object.entries(GIVEN)) {
    if (name === "query") continue;
    Object.assign(element, { [name]: value() });
    Object.assign(element, { [name]: undefined });
  }
  await settle();
  const { printer, resins, prices, limits, weights } = element;
  expect({ printer, resins, prices, limits, weights }).toEqual({ printer: "", resins: [], prices: null, limits: null, weights: null });
});
