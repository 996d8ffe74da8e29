import { expect, test } from "vitest";
import { check, DEFAULT_SETTINGS, fromAddress, parse, sameRays, type Faults, type Settings } from "./settings.js";

function faults(patch: Partial<Settings>): Faults {
  const checked = check({ ...DEFAULT_SETTINGS, ...patch });
  return checked.ok ? {} : checked.faults;
}

function options(patch: Partial<Settings>): unknown {
  const checked = check({ ...DEFAULT_SETTINGS, ...patch });
  return checked.ok ? checked.options : checked.faults;
}

test("the settings as they come are the core's defaults", () => {
  expect(options({})).toEqual({
    rays: 2048,
    layer_min_mm: 0.05,
    layer_max_mm: 0.15,
    tolerance_mm: 0.065,
    planner: { kind: "optimal" },
  });
});

test.each([
  ["0.05", 0.05],
  [" 0,05 ", 0.05],
  [".5", 0.5],
  ["12.", 12],
  ["0", 0],
  ["", null],
  ["-1", null],
  ["1e3", null],
  ["1,2,3", null],
  ["abc", null],
])("%j is read as %j", (text, value) => {
  expect(parse(text)).toBe(value);
});

test("a height is optional, and judged only when given", () => {
  expect(options({ height: "60" })).toMatchObject({ height_mm: 60 });
  expect(faults({ height: " " })).toEqual({});
  expect(faults({ height: "tall" }).height).toMatch(/number/);
  expect(faults({ height: "0" }).height).toMatch(/0.1 to 1000/);
});

test("a range that is upside down is a fault of its upper end", () => {
  expect(faults({ layerMin: "0.2", layerMax: "0.1" })).toEqual({
    layerMax: "The thickest layer must not be thinner than the thinnest.",
  });
});

test("micrometres typed for millimetres are recognised", () => {
  expect(faults({ tolerance: "65" }).tolerance).toMatch(/65 µm is 0.065 mm/);
});

test("the uniform thickness counts only for the uniform planner", () => {
  expect(faults({ uniform: "x" })).toEqual({});
  expect(faults({ planner: "uniform", uniform: "x" }).uniform).toMatch(/number/);
  expect(options({ planner: "uniform", uniform: "0.1" })).toMatchObject({ planner: { kind: "uniform", layer_mm: 0.1 } });
});

test("bins are halved where a thickness is no whole number of them, and no further", () => {
  expect(options({ layerMin: "0.025" })).toMatchObject({ bin_mm: 0.001 });
  expect(options({ planner: "uniform", uniform: "0.035" })).toMatchObject({ bin_mm: 0.001 });
  expect(options({ uniform: "0.035" })).not.toHaveProperty("bin_mm");
  expect(faults({ layerMax: "0.1005" }).layerMax).toMatch(/0.001 mm/);
});

test("an address may name settings, and what it cannot name is ignored", () => {
  expect(fromAddress("?height=60&rays=4096&planner=uniform&uniform=0.1&backend=gpu")).toEqual({
    ...DEFAULT_SETTINGS,
    height: "60",
    rays: "4096",
    planner: "uniform",
    uniform: "0.1",
  });
  expect(fromAddress("?rays=7&planner=best&constructor=1")).toEqual(DEFAULT_SETTINGS);
});

test("only what moves the rays makes a difference to sameRays", () => {
  expect(sameRays({ rays: 1024, tolerance_mm: 0.05 }, { rays: 1024, tolerance_mm: 0.1 })).toBe(true);
  expect(sameRays({ rays: 1024 }, { rays: 2048 })).toBe(false);
  expect(sameRays({ height_mm: 60 }, {})).toBe(false);
  expect(sameRays({ pixels: [1, 2] }, { pixels: [1, 2] })).toBe(true);
});
