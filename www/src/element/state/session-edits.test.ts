/** Edits of the model itself: turning, painting weights, and applying an orientation. */
import { expect, test } from "vitest";
import { SlicerError } from "../../api/error.js";
import { SCHEMA } from "../../api/index.js";
import type { Candidate } from "../../api/wire.js";
import { model, planOf } from "./fake-slicer.js";
import { planned, session, settle, slicer, start } from "./session-fixture.js";
import { DEFAULT_SETTINGS } from "./settings.js";

test("turning the model shows previews, the newest rotation last; releasing it plans", async () => {
  await planned();
  for (let i = 1; i < 5; i++) session.turn([0, 0, i / 10, 1], false);
  await settle();
  expect(slicer.previews.map(({ rotation }) => rotation?.[2])).toEqual([0.1, 0.4]);
  expect(session.shown?.layers).toBe(99);
  session.turn([0, 0, 1, 0], true);
  await settle();
  expect(slicer.last.options?.rotation).toEqual([0, 0, 1, 0]);
  slicer.last.resolve(planOf(20));
  await settle();
  expect(session.shown?.layers).toBe(20);
  session.undo();
  expect(session.settings.rotation).toBe("");
});

test("quick turns are one undo step, and turning back at once is another", async () => {
  await planned();
  session.turn([0, 0, 0.6, 0.8], true);
  session.turn([0, 0, 1, 0], true);
  session.turn([0, 0, 0, 1], true);
  expect(session.settings.rotation).toBe("");
  session.undo();
  expect(session.settings.rotation).toBe("0,0,1,0");
  session.undo();
  expect(session.settings.rotation).toBe("");
  expect(session.canUndo).toBe(false);
});

test("another model has the pose and the unit of its file; the first one takes those of the settings", async () => {
  start({ settings: { ...DEFAULT_SETTINGS, rotation: "0,0,1,0", unit: "inch" } });
  await planned();
  expect(slicer.last.options).toMatchObject({ rotation: [0, 0, 1, 0], unit: "inch" });
  void session.open(new Blob(), "b.stl");
  slicer.last.resolve({ ...model, name: "b.stl" });
  await settle();
  expect(slicer.last.options).not.toHaveProperty("rotation");
  expect(slicer.last.options).not.toHaveProperty("unit");
});

test("a unit is applied by a button, and undone like any setting", async () => {
  await planned();
  session.change({ unit: "inch" });
  await settle();
  expect(slicer.last.options?.unit).toBe("inch");
  session.undo();
  expect(session.settings.unit).toBe("");
});

test("a stroke is previewed, and planned at its end although the options are the same", async () => {
  await planned();
  const { length } = slicer.calls;
  session.setWeights(Float32Array.of(0.5), false);
  await settle();
  expect(slicer.previews).toHaveLength(1);
  expect(session.shown?.layers).toBe(99);
  expect(slicer.calls).toHaveLength(length);
  expect(session.isCurrent).toBe(false);

  const weights = Float32Array.of(0.25);
  session.setWeights(weights, true);
  expect(slicer.calls).toHaveLength(length + 1);
  expect(slicer.last.what).toBe("plan");
  slicer.last.resolve(planOf(7));
  await settle();
  expect(session.isCurrent).toBe(true);
  expect(session.shown?.layers).toBe(7);
  expect(slicer.painted).toEqual([Float32Array.of(0.5), weights]);
});

test("weights painted during a plan are planned after it", async () => {
  await planned();
  session.setWeights(Float32Array.of(0.5), true);
  const first = slicer.last;
  session.setWeights(Float32Array.of(0.25), true);
  expect(slicer.last).toBe(first);
  first.resolve(planOf(8));
  await settle();
  expect(slicer.last).not.toBe(first);
  expect(session.isCurrent).toBe(false);
  slicer.last.resolve(planOf(7));
  await settle();
  expect(session.isCurrent).toBe(true);
});

test("weights are saved to a file and read back; a file without weights is a failure", async () => {
  await planned();
  expect(await session.saveWeights()).toBeNull();
  const weights = Float32Array.of(0.25);
  session.setWeights(weights, true);
  const saved = await session.saveWeights();
  expect(saved?.name).toBe("a.weights");
  session.setWeights(null, true);
  await session.openWeights(new File([saved?.blob ?? ""], "a.weights"));
  expect(session.weights).toEqual(weights);
  await session.openWeights(new File([], "b.weights"));
  expect(session.failure).toMatchObject({ error: { code: "weights-not-weights" }, name: "b.weights" });
  expect(session.weights).toEqual(weights);
});

test("the description of a printer is opened as an undo step; a file that is none changes nothing", async () => {
  await planned();
  const own = { model: "Mine", pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245] };
  const open = (content: BlobPart, name = "mine.json"): Promise<void> => session.openPrinter(new File([content], name));
  const opening = open(JSON.stringify(own));
  await settle();
  expect(slicer.last).toMatchObject({ what: "calibrateLayers", options: { printer: own } });
  slicer.last.resolve({});
  await opening;
  expect(session.options?.printer).toEqual({ ...own, name: "mine" });
  await open("solid", "b.json");
  expect(session.failure).toMatchObject({ error: { code: "printer-not-json" }, name: "b.json" });
  await open(" ".repeat(64_001));
  expect(session.failure).toMatchObject({ error: { code: "printer-too-long", detail: { bytes: 64_001, most_bytes: 64_000 } } });
  expect(session.settings.printer).toMatchObject(own);
  session.undo();
  expect(session.settings.printer).toBe("");
});

test("a printer that the core refuses does not replace the last one, and is not planned; one too small for the towers is not refused", async () => {
  await planned();
  const open = async (error: SlicerError): Promise<void> => {
    const opening = session.openPrinter(new File([`{ "pixels": [0, 1] }`], "bad.json"));
    await settle();
    slicer.last.reject(error);
    await opening;
  };
  session.change({ printer: "mars" });
  await settle();
  slicer.last.resolve(planOf(10));
  await settle();
  await open(new SlicerError("bad-printer", "", { printer: "bad", field: "pixels" }));
  expect(session.failure).toMatchObject({ error: { code: "bad-printer" }, name: "bad.json", task: null, settings: { printer: { pixels: [0, 1] } } });
  await settle();
  expect([session.settings.printer, session.canUndo, slicer.last.what]).toEqual(["mars", true, "calibrateLayers"]);
  await open(new SlicerError("crash", "", { system: "" }));
  expect(session.settings.printer).toMatchObject({ pixels: [0, 1] });
});

test("nobody brings a printer of their own where the page has fixed one", async () => {
  session.fixed = new Set(["printer"]);
  await session.openPrinter(new File(["{}"], "mine.json"));
  expect([session.settings.printer, session.failure, slicer.calls]).toEqual(["", null, []]);
});

test("opening another model clears the weights", async () => {
  await planned();
  session.setWeights(Float32Array.of(0.5), true);
  slicer.last.resolve(planOf(9));
  await settle();
  void session.open(new Blob(), "b.stl");
  slicer.last.resolve(model);
  await settle();
  expect(session.weights).toBeNull();
});

test("applying a candidate is an undo step; with a height, the scale stays", async () => {
  await planned();
  const stood: Candidate = {
    ...{ direction: [0, 0, 1], rotation: [1, 0, 0, 0], size_mm: [1, 2, 3.25], excluded: null, metrics: null, energy: null },
  };
  session.orient(stood);
  expect(session.options).toMatchObject({ rotation: [1, 0, 0, 0] });
  expect(session.options?.height_mm).toBeUndefined();
  await settle();
  expect(slicer.last).toMatchObject({ what: "plan", options: { rotation: [1, 0, 0, 0] } });
  session.undo();
  expect(session.options?.rotation).toBeUndefined();
  session.change({ height: "20" });
  session.orient(stood);
  expect(session.options).toMatchObject({ rotation: [1, 0, 0, 0], height_mm: 3.25 });
});

test("a search runs beside plans, and is forgotten with its model", async () => {
  await planned();
  void session.orientation.start();
  const search = slicer.last;
  expect(search.what).toBe("orient");
  expect(session.busy).toBeNull();
  session.replan();
  session.cancel();
  expect(session.orientation.busy).not.toBeNull();
  search.resolve({ schema: SCHEMA, candidates: [], best: [] });
  await settle();
  expect(session.orientation.isCurrent).toBe(true);
  session.change({ tolerances: { cusp: "0.05" } });
  expect(session.orientation.isCurrent).toBe(false);
  await planned();
  expect(session.orientation.found).toBeNull();
  expect(session.orientation.options).toBeNull();
});

test("a turn takes points placed by hand with it, undoing brings them back, and another model has none", async () => {
  await planned();
  session.change({ supports: "light", points: "1,2,3,,1", drains: "1,2,3,0,0,1,3,1", drain: "none" });
  session.turn([0, 0, 1, 0], true);
  expect(session.settings).toMatchObject({ points: "", drains: "", drain: "auto" });
  session.undo();
  expect(session.settings).toMatchObject({ points: "1,2,3,,1", drains: "1,2,3,0,0,1,3,1", drain: "none" });
  void session.open(new Blob(), "b.stl");
  slicer.last.resolve({ ...model, name: "b.stl" });
  await settle();
  expect(session.settings).toMatchObject({ supports: "light", points: "", drains: "", drain: "auto" });
});
