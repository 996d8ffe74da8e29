import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Session } from "./session.js";
import { DEFAULT_SETTINGS } from "./settings.js";
import { SlicerError } from "../../api/error.js";
import { SCHEMA, type GlancedPlan, type LoadCall, type Mask, type Model, type OrientCall, type Orientation, type Plan, type PrintFile, type Watch } from "../../api/index.js";
import type { Candidate, Glance, MeshInfo, Options, Report, Search, Tradeoff } from "../../api/wire.js";

const info = { facets: 1, size_mm: [1, 1, 10], warnings: [] } as unknown as MeshInfo;
const model: Model = { schema: SCHEMA, name: "a.stl", file: new Blob(), info };

function planOf(layers: number, height_mm = 10): Plan {
  const z_mm = Array.from({ length: layers + 1 }, (_, i) => (i * height_mm) / layers);
  const mask = { width: 8, height: 1, pitch_mm: 1 };
  const report = { layers, height_mm, z_mm, mask, metric: "volume", tolerance: 12.5, planner: "optimal" } as unknown as Report;
  return { schema: SCHEMA, report, profile: new Float32Array(1) };
}

/** A slicer whose answers the test gives, call by call. */
class FakeSlicer {
  readonly calls: { what: string; options?: Options; resolve(value: unknown): void; reject(error: unknown): void }[] = [];
  readonly masks: number[] = [];

  readonly warm = (): void => undefined;
  readonly printers = async (): Promise<[]> => [];
  readonly load = (_source: unknown, call: LoadCall = {}): Promise<Model> => this.#call("open", call);
  readonly plan = (options: Options = {}, call: Watch = {}): Promise<Plan> => this.#call("plan", call, options);
  readonly export = (_options?: Options, call: Watch = {}): Promise<PrintFile> => this.#call("export", call);
  readonly orient = (options: Options = {}, _search?: Search, call: OrientCall = {}): Promise<Orientation> =>
    this.#call("orient", call, options);
  readonly mask = async (layer: number): Promise<Mask> => {
    this.masks.push(layer);
    return { layer, width: 8, height: 1, bits: Uint8Array.of(255) };
  };
  readonly glances: Options[] = [];
  readonly glance = async (options: Options = {}): Promise<GlancedPlan> => {
    this.glances.push(options);
    return { schema: SCHEMA, report: { layers: 99, z_mm: [0], thickness_mm: [] } as unknown as Glance, profile: new Float32Array() };
  };
  readonly painted: (Float32Array | null)[] = [];
  readonly setWeights = async (weights: Float32Array | null): Promise<void> => void this.painted.push(weights);
  readonly weightsFile = async (weights: Float32Array): Promise<Blob> => new Blob([weights.slice()]);
  readonly readWeights = async (file: unknown): Promise<Float32Array> => {
    const bytes = await (file as Blob).arrayBuffer();
    if (bytes.byteLength === 0) throw new SlicerError("weights-not-weights", "no weights");
    return new Float32Array(bytes);
  };
  readonly curves: Options[] = [];
  tolerances = [0.05, 0.1, 0.15];
  readonly tradeoff = async (options: Options = {}): Promise<Tradeoff & { schema: 1 }> => {
    this.curves.push(options);
    const points = this.tolerances.map((tolerance) => ({ tolerance, layers: 1, max_error: tolerance, print_time_s: 1 }));
    return { schema: SCHEMA, points };
  };

  get last(): (typeof this.calls)[number] {
    const call = this.calls.at(-1);
    if (call === undefined) throw new Error("nothing was asked");
    return call;
  }

  #call<T>(what: string, watch: Pick<Watch, "signal">, options?: Options): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      watch.signal?.addEventListener("abort", () => reject(watch.signal?.reason));
      this.calls.push({ what, resolve: resolve as (value: unknown) => void, reject, ...(options && { options }) });
    });
  }
}

const zip: PrintFile = { schema: SCHEMA, name: "a-cusp.zip", type: "application/zip", blob: new Blob(["zip"]), warnings: [] };
const CUT = new SlicerError("stl-truncated", "", { line: 3, expected: "facet" });

let slicer: FakeSlicer;
let session: Session;
const settle = (): Promise<unknown> => vi.advanceTimersByTimeAsync(300);

beforeEach(() => {
  vi.useFakeTimers();
  slicer = new FakeSlicer();
  session = new Session({ requestUpdate: () => undefined }, slicer);
});

afterEach(() => {
  vi.useRealTimers();
});

async function planned(layers = 10): Promise<void> {
  void session.open(new Blob(), "a.stl");
  slicer.last.resolve(model);
  await settle();
  slicer.last.resolve(planOf(layers));
  await settle();
}

test("opening plans at once and looks at the middle", async () => {
  await planned();
  expect(slicer.calls.map(({ what }) => what)).toEqual(["open", "plan"]);
  expect(session.result?.report.layers).toBe(10);
  expect(session.layer).toBe(5);
  expect(session.mask?.layer).toBe(5);
  expect(session.busy).toBeNull();
});

test("a new plan keeps the height that is looked at", async () => {
  await planned();
  session.selectLayer(2);
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  slicer.last.resolve(planOf(20));
  await settle();
  expect(session.layer).toBe(4);
  expect(session.mask?.layer).toBe(4);
});

test("typing waits for a pause, and nonsense plans nothing and says so", async () => {
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

test("over the same rays the newest settings wait for the plan under way, and those between are skipped", async () => {
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

test("new rays end the plan under way", async () => {
  await planned();
  session.change({ rays: "4096" });
  await settle();
  session.change({ rays: "512" });
  await settle();
  expect(slicer.last.options?.rays).toBe(512);
  slicer.last.resolve(planOf(30));
  await settle();
  expect(session.result?.report.layers).toBe(30);
  expect(session.failure).toBeNull();
});

test("a failed plan keeps the last good one and its masks, and says what happened", async () => {
  await planned();
  session.change({ tolerances: { cusp: "0.02" } });
  await settle();
  slicer.last.reject(new SlicerError("too-many-facets", "", { facets: 9 }));
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

test("settings changed during a download wait for it", async () => {
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

test("settings changed while a file is read belong to it, or to the model before if it cannot be read", async () => {
  await planned();
  void session.open(new Blob(), "b.stl");
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  expect(slicer.last.what).toBe("open");
  slicer.last.reject(CUT);
  await settle();
  expect(slicer.last.options?.tolerance).toBe(0.05);
});

test("a zip is made once for each plan", async () => {
  await planned();
  const first = session.export();
  slicer.last.resolve(zip);
  await settle();
  expect(await first).toMatchObject({ name: "a-cusp.zip" });
  const again = await session.export();
  expect(again?.blob.size).toBe(3);
  expect(slicer.calls.filter(({ what }) => what === "export")).toHaveLength(1);
});

test("masks: while one is fetched only the newest layer waits", async () => {
  await planned();
  slicer.masks.length = 0;
  for (let layer = 0; layer < 9; layer++) session.selectLayer(layer);
  await settle();
  expect(slicer.masks).toEqual([0, 8]);
});

test("the tolerance that the core took is known where none is typed for that metric", async () => {
  session = new Session({ requestUpdate: () => undefined }, slicer, { settings: { ...DEFAULT_SETTINGS, metric: "volume" } });
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

test("of several files the first is opened and the others wait; of none it says that none will do", async () => {
  void session.choose([new File([], "notes.txt"), new File([], "a.stl"), new File([], "b.stl")]);
  slicer.last.resolve(model);
  await settle();
  expect(session.files.map(({ name }) => name)).toEqual(["a.stl", "b.stl"]);
  void session.openFile(1);
  slicer.last.resolve({ ...model, name: "b.stl" });
  await settle();
  expect([session.model?.name, session.place]).toEqual(["b.stl", 1]);
  // The core looks inside and says what it is.
  void session.choose([new File([], "notes.txt")]);
  slicer.last.reject(new SlicerError("stl-not-stl", ""));
  await settle();
  expect(session.failure).toMatchObject({ error: { code: "stl-not-stl" }, name: "notes.txt" });
  expect([session.model?.name, session.place, session.files.length]).toEqual(["b.stl", 1, 2]);
});

test("the curve is asked for once, as long as nothing but the tolerance changes", async () => {
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

test("a quality is a place on the curve, taken when that is known", async () => {
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

test("a plan without any error gives the least tolerance that can be asked for", async () => {
  slicer.tolerances = [0];
  session.quality = 0.5;
  await planned();
  expect(session.settings.tolerances.cusp).toBe("0.001");
  expect(session.faults).toEqual({});
});

test("settings go back and forth, and are planned each time", async () => {
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

test("while the model is turned glances are shown, the newest turn last; let go, it is planned", async () => {
  await planned();
  for (let i = 1; i < 5; i++) session.turn([0, 0, i / 10, 1], false);
  await settle();
  expect(slicer.glances.map(({ rotation }) => rotation?.[2])).toEqual([0.1, 0.4]);
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

test("another model stands as in its file; the first one as the settings say", async () => {
  session = new Session({ requestUpdate: () => undefined }, slicer, { settings: { ...DEFAULT_SETTINGS, rotation: "0,0,1,0" } });
  await planned();
  expect(slicer.last.options?.rotation).toEqual([0, 0, 1, 0]);
  void session.open(new Blob(), "b.stl");
  slicer.last.resolve({ ...model, name: "b.stl" });
  await settle();
  expect(slicer.last.options).not.toHaveProperty("rotation");
});

test("a stroke is followed by glances, and planned at its end though the options are the same", async () => {
  await planned();
  const { length } = slicer.calls;
  session.setWeights(Float32Array.of(0.5), false);
  await settle();
  expect(slicer.glances).toHaveLength(1);
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

test("what is painted while a plan is made is planned after it", async () => {
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

test("weights are saved and come back from their file; a file that holds none is a failure", async () => {
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

test("another model is all alike", async () => {
  await planned();
  session.setWeights(Float32Array.of(0.5), true);
  slicer.last.resolve(planOf(9));
  await settle();
  void session.open(new Blob(), "b.stl");
  slicer.last.resolve(model);
  await settle();
  expect(session.weights).toBeNull();
});

test("standing as a candidate does is a step that can be undone; a height keeps its scale", async () => {
  await planned();
  const stood: Candidate = {
    ...{ direction: [0, 0, 1], rotation: [1, 0, 0, 0], size_mm: [1, 2, 3.25], excluded: null, figures: null, energy: null },
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

test("a search goes on beside plans, and is forgotten with its model", async () => {
  await planned();
  session.orientation.start();
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
