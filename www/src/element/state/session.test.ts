import { expect, test, vi } from "vitest";
import { SlicerError } from "../../api/error.js";
import { SCHEMA, type LoadCall, type Loaded, type PrintFile } from "../../api/index.js";
import { model, planOf } from "./fake-slicer.js";
import { planned, session, settle, slicer, start } from "./session-fixture.js";
import { Session } from "./session.js";
import { DEFAULT_SETTINGS, type Settings } from "./settings.js";

const zip: PrintFile = { schema: SCHEMA, name: "a-cusp.zip", type: "application/zip", blob: new Blob(["zip"]), warnings: [] };
const CUT = new SlicerError("stl-truncated", "", { line: 3, expected: "facet-or-endsolid" });

test("opening a model plans it at once and selects the middle layer", async () => {
  await planned();
  expect(slicer.calls.map(({ what }) => what)).toEqual(["open", "plan"]);
  expect(session.result?.report.layers).toBe(10);
  expect(session.layer).toBe(5);
  expect(session.mask?.layer).toBe(5);
  expect(session.busy).toBeNull();
});

test("the list of printers is fetched with the first model or before, once, and again if it did not come", async () => {
  const printers = vi.spyOn(slicer, "printers").mockRejectedValueOnce(new SlicerError("start-failed", "no", { system: "" }));
  await planned();
  expect(printers).toHaveBeenCalledTimes(1);
  session.start();
  await planned();
  expect(printers).toHaveBeenCalledTimes(2);
});

test("a new plan keeps the height of the selected layer", async () => {
  await planned();
  session.selectLayer(2);
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  slicer.last.resolve(planOf(20));
  await settle();
  expect(session.layer).toBe(4);
  expect(session.mask?.layer).toBe(4);
});

test("typing waits for a pause, and an invalid value is a fault and not planned", async () => {
  await planned();
  session.change({ tolerances: { cusp: "0.0" } });
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  expect(slicer.calls).toHaveLength(3);
  slicer.last.resolve(planOf(20));
  await settle();
  session.change({ tolerances: { cusp: "x" } });
  await settle();
  expect(slicer.calls).toHaveLength(3);
  expect(session.faults.tolerance).toBeDefined();
  expect(session.earlier).toBe(true);
  expect(session.result?.report.layers).toBe(20);
});

test("with the same rays, the newest settings wait for the running plan, and intermediate ones are skipped", async () => {
  await planned();
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  session.change({ tolerances: { cusp: "0.06" } });
  await settle();
  session.change({ tolerances: { cusp: "0.07" } });
  await settle();
  expect(slicer.calls).toHaveLength(3);
  slicer.last.resolve(planOf(20));
  await settle();
  expect(slicer.last.options?.tolerance).toBe(0.07);
  expect(slicer.calls).toHaveLength(4);
});

/** A change of each setting of a hollow, supported model, and true if it moves rays. */
const CHANGES: { readonly [Key in keyof Settings]: readonly [change: Settings[Key], movesRays: boolean] } = {
  rays: ["512", true],
  height: ["30", true],
  unit: ["inch", true],
  rotation: ["0,0.6,0,0.8", true],
  printer: ["elegoo-saturn", true],
  wall: ["3", true],
  infill: ["lattice", true],
  drain: ["none", true],
  drains: ["0,0,5,0,0,-1,3,1", true],
  supports: ["heavy", true],
  lift: ["8", true],
  supportSpacing: ["2", true],
  contact: ["0.5", true],
  pillar: ["1.2", true],
  supportAngle: ["40", true],
  floating: ["allow", false],
  raft: ["on", true],
  points: ["1,1,5,,1", true],
  protect: ["on", true],
  // Until points are placed by hand, all are automatic.
  fill: ["on", false],
  // There is no raft.
  raftThickness: ["1.5", false],
  raftMargin: ["3", false],
  supportLayer: ["0.2", false],
  layerMin: ["0.04", false],
  layerMax: ["0.1", false],
  uniform: ["0.08", false],
  step: ["0.01", false],
  nozzle: ["0.6", false],
  planner: ["uniform", false],
  metric: ["deviation", false],
  minimize: ["time", false],
  snap: ["off", false],
  saliency: ["on", false],
  weightMin: ["0.5", false],
  format: ["goo", false],
  resin: ["Grey", false],
  exposure: ["4", false],
  bottomExposure: ["40", false],
  bottomLayers: ["6", false],
  penetration: ["0.12", false],
  overcure: ["0.02", false],
  retained: ["0.5", false],
  tolerances: [{ cusp: "0.05" }, false],
};

test.each(Object.entries(CHANGES))("a change of %s during a plan ends it if it moves rays, and waits for it otherwise", async (key, [change, movesRays]) => {
  await planned();
  session.change({ wall: "2", supports: "light" });
  await settle();
  const running = slicer.last;
  session.change({ [key]: change });
  await settle();
  // One that waits is planned once the running one ends.
  expect(slicer.last !== running).toBe(movesRays);
});

test("a failed plan keeps the last good one and its masks, and reports the error", async () => {
  await planned();
  session.change({ tolerances: { cusp: "0.02" } });
  await settle();
  slicer.last.reject(new SlicerError("too-many-facets", "", { facets: 9, most: 8 }));
  await settle();
  expect(session.failure?.error).toMatchObject({ code: "too-many-facets" });
  expect(session.earlier).toBe(true);
  session.selectLayer(1);
  await settle();
  expect(session.mask?.layer).toBe(1);
  session.change({ tolerances: { cusp: "0.05" } });
  expect(session.failure).toBeNull();
});

test("a file that cannot be read leaves the open model alone", async () => {
  await planned();
  void session.open(new Blob(), "b.stl");
  slicer.last.reject(CUT);
  await settle();
  expect(session.failure).toMatchObject({ error: { code: "stl-truncated" }, name: "b.stl" });
  expect(session.model?.name).toBe("a.stl");
  expect(session.result?.report.layers).toBe(10);
});

test("cancelling the first plan leaves a model that can be planned again", async () => {
  void session.open(new Blob(), "a.stl");
  slicer.last.resolve(model);
  await settle();
  session.cancel();
  await settle();
  expect(session.busy).toBeNull();
  expect(session.result).toBeNull();
  expect(session.failure).toBeNull();
  session.replan();
  slicer.last.resolve(planOf(10));
  await settle();
  expect(session.result?.report.layers).toBe(10);
});

test("a plan that was refused is not on offer again, unless a setting changes; one that a crash ended is", async () => {
  void session.open(new Blob(), "a.stl");
  slicer.last.resolve(model);
  await settle();
  slicer.last.reject(new SlicerError("too-many-facets", "", { facets: 9, most: 8 }));
  await settle();
  expect(session.canPlan).toBe(false);
  session.dismiss();
  expect(session.canPlan).toBe(false);
  session.change({ height: "9" });
  expect(session.canPlan).toBe(true);
  await settle();
  slicer.last.reject(new SlicerError("crash", "", { system: "unreachable" }));
  await settle();
  expect(session.failure?.error.code).toBe("crash");
  expect(session.canPlan).toBe(true);
  session.change({ height: "x" });
  expect(session.canPlan).toBe(false);
});

test("settings changed during an export are planned after it", async () => {
  await planned();
  const download = session.export();
  session.change({ rays: "4096" });
  await settle();
  expect(slicer.last.what).toBe("export");
  slicer.last.resolve(zip);
  expect(await download).not.toBeNull();
  await settle();
  expect(slicer.last.options?.rays).toBe(4096);
});

test("settings changed while a file is read apply to it, or to the previous model if it cannot be read", async () => {
  await planned();
  void session.open(new Blob(), "b.stl");
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  expect(slicer.last.what).toBe("open");
  slicer.last.reject(CUT);
  await settle();
  expect(slicer.last.options?.tolerance).toBe(0.05);
});

test("a print file is made once per plan", async () => {
  await planned();
  const first = session.export();
  slicer.last.resolve(zip);
  await settle();
  expect(await first).toMatchObject({ name: "a-cusp.zip" });
  const again = await session.export();
  expect(again?.blob.size).toBe(3);
  expect(slicer.calls.filter(({ what }) => what === "export")).toHaveLength(1);
});

test("test towers are for the settings on show, which may have no plan, and leave the plan alone", async () => {
  await planned();
  session.change({ printer: "saturn-3" });
  await settle();
  slicer.last.reject(new SlicerError("too-many-facets", "", { facets: 9, most: 8 }));
  await settle();
  const writing = session.calibrateLayers();
  expect(slicer.last).toMatchObject({ what: "calibrateLayers", options: { printer: "saturn-3" } });
  expect([session.towers, session.busy?.task]).toEqual(["writing", "towers"]);
  expect(await session.calibrateLayers()).toBeNull();
  slicer.last.resolve({ ...zip, name: "towers-saturn-3.goo" });
  expect(await writing).toMatchObject({ name: "towers-saturn-3.goo" });
  expect([session.towers, session.result?.report.layers]).toEqual(["ready", 10]);
});

test("test towers that fail are a failure, and they can be cancelled; settings out of range have to be mended first", async () => {
  await planned();
  const failing = session.calibrateLayers();
  slicer.last.reject(new SlicerError("crash", "", { system: "unreachable" }));
  expect(await failing).toBeNull();
  expect(session.failure).toMatchObject({ task: "towers", error: { code: "crash" } });
  const cancelled = session.calibrateLayers();
  expect(session.failure).toBeNull();
  session.cancel();
  expect(await cancelled).toBeNull();
  expect(session.notice).toBe("exportCancelled");
  session.change({ exposure: "x" });
  expect(session.towers).toBe("waiting");
  expect(await session.calibrateLayers()).toBeNull();
});

test("measured bridges set the print-through, by the resin that they were printed with", async () => {
  await planned();
  session.change({ penetration: "0.12" });
  await settle();
  const typed = session.bridges.map((_, place) => (place < 4 ? `0,${place + 1}` : ""));
  const fitted = { penetration_mm: 0.1234, print_through: { overcure_mm: 0.03, retained: 0.7 } };
  const measure = async (found: unknown): Promise<void> => {
    const measuring = session.measureBridges(typed);
    const resin = { penetration_mm: 0.12 };
    expect(slicer.last).toMatchObject({ what: "fitCure", options: { resin } });
    slicer.last.resolve(found);
    await measuring;
  };
  await measure(null);
  expect([session.cureFit, session.settings.overcure, session.bridges]).toEqual([null, "", typed]);
  await measure(fitted);
  expect(session.settings).toMatchObject({ penetration: "0.123", overcure: "0.030", retained: "0.70" });
  // A second measurement is of the same print.
  await measure(fitted);
});

test("while a mask is fetched, only the newest layer waits", async () => {
  await planned();
  slicer.masks.length = 0;
  for (let layer = 0; layer < 9; layer++) session.selectLayer(layer);
  await settle();
  expect(slicer.masks).toEqual([0, 8]);
});

test("the tolerance that the core chose is known if none is typed for that metric", async () => {
  start({ settings: { ...DEFAULT_SETTINGS, metric: "volume" } });
  expect(session.taken).toBeNull();
  await planned();
  expect(slicer.last.options).not.toHaveProperty("tolerance");
  expect(session.taken).toBe(12.5);
  session.change({ metric: "area" });
  expect(session.taken).toBeNull();
  session.change({ metric: "volume", tolerances: { volume: "20" } });
  await settle();
  slicer.last.resolve(planOf(10));
  await settle();
  expect(slicer.last.options?.tolerance).toBe(20);
  expect(session.taken).toBeNull();
});

test("of several files, the first STL is opened and the others wait; a file of another kind is a failure", async () => {
  void session.choose([new File([], "notes.txt"), new File([], "a.stl"), new File([], "b.stl")]);
  slicer.last.resolve(model);
  await settle();
  expect(session.files.map(({ name }) => name)).toEqual(["a.stl", "b.stl"]);
  void session.openFile(1);
  slicer.last.resolve({ ...model, name: "b.stl", file: session.files[1] ?? model.file });
  await settle();
  expect([session.model?.name, session.place]).toEqual(["b.stl", 1]);
  // The core inspects the content and reports what it is.
  void session.choose([new File([], "notes.txt")]);
  slicer.last.reject(new SlicerError("unknown-file-kind", ""));
  await settle();
  expect(session.failure).toMatchObject({ error: { code: "unknown-file-kind" }, name: "notes.txt" });
  expect([session.model?.name, session.place, session.files.length]).toEqual(["b.stl", 1, 2]);
});

test("the curve is fetched once, as long as only the tolerance changes", async () => {
  await planned();
  expect(session.curve).toHaveLength(3);
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  slicer.last.resolve(planOf(20));
  await settle();
  expect(slicer.curves).toHaveLength(1);
  session.change({ layerMax: "0.2" });
  await settle();
  slicer.last.resolve(planOf(15));
  await settle();
  expect(slicer.curves.map(({ layer_max_mm }) => layer_max_mm)).toEqual([0.15, 0.2]);
  expect(slicer.curves.every((options) => !("tolerance" in options))).toBe(true);
});

test("a quality is a point on the curve, applied once the curve is known", async () => {
  session.quality = 1;
  await planned();
  expect(session.settings.tolerances.cusp).toBe("0.05");
  await settle();
  expect(slicer.last.options?.tolerance).toBe(0.05);
  slicer.last.resolve(planOf(20));
  session.takePoint(2);
  await settle();
  expect(slicer.last.options?.tolerance).toBe(0.15);
});

test("a plan without any error gives the smallest valid tolerance", async () => {
  slicer.tolerances = [0];
  session.quality = 0.5;
  await planned();
  expect(session.settings.tolerances.cusp).toBe("0.001");
  expect(session.faults).toEqual({});
});

test("undo and redo of settings plan again each time", async () => {
  await planned();
  session.change({ height: "20" });
  await settle();
  slicer.last.resolve(planOf(20));
  await settle();
  session.undo();
  await settle();
  expect(slicer.last.options).not.toHaveProperty("height_mm");
  slicer.last.resolve(planOf(10));
  await settle();
  session.redo();
  expect(slicer.last.options?.height_mm).toBe(20);
  expect([session.canUndo, session.canRedo]).toEqual([true, false]);
});

test("a model comes with its positions only for a host that shows it", async () => {
  const asked: unknown[] = [];
  const spied = Object.assign(slicer, {
    load: (_source: unknown, call: LoadCall = {}): Promise<Loaded> => {
      asked.push(call.positions);
      return Promise.resolve({ ...model, ...(call.positions === true && { positions: new Float32Array(9) }) });
    },
  });
  for (const hasView of [true, false]) {
    const session = new Session({ requestUpdate: () => undefined, hasView: () => hasView }, spied);
    const opened = await session.open(new Blob(), "a.stl");
    expect([session.positions?.length, opened]).toEqual([hasView ? 9 : undefined, model]);
  }
  expect(asked).toEqual([true, undefined]);
});
