/** A fake slicer for tests of the session. */
import { absentSlicer } from "../../api/absent.js";
import { SlicerError } from "../../api/error.js";
import { SCHEMA, type Check, type Loaded, type LoadCall, type Mask, type Model, type OrientationReport, type OrientCall, type Ordered, type Plan, type PreviewedPlan, type PrintFile, type Project, type Slicer, type TestTowers, type Watch } from "../../api/index.js";
import type { Candidate, CureFit, Preview, MeshInfo, Options, Price, Prices, Report, Resin, SearchOptions, Tradeoff } from "../../api/wire.js";

const info = { facets: 1, size_mm: [1, 1, 10], warnings: [] } as unknown as MeshInfo;
export const model: Model = { schema: SCHEMA, id: 1, name: "a.stl", file: new Blob(), reading: {}, info, own: {} };

export function planOf(layers: number, height_mm = 10): Plan {
  const z_mm = Array.from({ length: layers + 1 }, (_, i) => (i * height_mm) / layers);
  const mask = { width: 8, height: 1, pitch_mm: 1 };
  const report = { layers, height_mm, z_mm, mask, metric: "volume", tolerance: 12.5, planner: "optimal", models: [], placements: [{ model: 0 }], warnings: [] } as unknown as Report;
  const of = { report, profile: new Float32Array(1) };
  return { schema: SCHEMA, ...of, plates: [of], print_time_s: 1, resin_ml: 1 };
}

/** A slicer whose calls the test resolves or rejects one by one. */
export class FakeSlicer {
  // Replaced by tests of several models.
  add: Slicer["add"] = absentSlicer().add;
  update: Slicer["update"] = absentSlicer().update;
  remove: Slicer["remove"] = absentSlicer().remove;
  problems: Slicer["problems"] = absentSlicer().problems;
  readonly projects: Project[] = [];
  readonly writeProject = async (project: Project): Promise<Blob> => new Blob([String(this.projects.push(project))]);
  readonly readProject = async (): Promise<Project | null> => this.projects.at(-1) ?? null;
  readonly positions = async (): Promise<Float32Array> => new Float32Array(9);
  readonly plugs = async (): Promise<Uint8Array> => new Uint8Array(84);
  readonly saliency = async (): Promise<Float32Array> => new Float32Array(1);
  readonly calls: { what: string; options?: Options; resolve(value: unknown): void; reject(error: unknown): void }[] = [];
  readonly masks: number[] = [];

  readonly warm = (): void => undefined;
  readonly printers = async (): Promise<[]> => [];
  readonly loads: LoadCall[] = [];
  readonly load = (_source: unknown, call: LoadCall = {}): Promise<Loaded> => {
    this.loads.push(call);
    return this.#call("open", call);
  };
  readonly plan = (options: Options = {}, call: Watch = {}): Promise<Plan> => this.#call("plan", call, options);
  readonly export = (_options?: Options, call: Watch = {}): Promise<PrintFile> => this.#call("export", call);
  readonly calibrateLayers = (options: Options = {}, call: Watch = {}): Promise<TestTowers> => this.#call("calibrateLayers", call, options);
  readonly calibrateCure = (options: Options = {}, call: Watch = {}): Promise<PrintFile> => this.#call("calibrateCure", call, options);
  readonly fitCure = (_measured_mm: readonly number[], resin: Resin = {}): Promise<CureFit | null> => this.#call("fitCure", {}, { resin });
  readonly orient = (options: Options = {}, _search?: SearchOptions, call: OrientCall = {}): Promise<OrientationReport> =>
    this.#call("orient", call, options);
  readonly measure = (options: Options = {}): Promise<Candidate> => this.#call("measure", {}, options);
  readonly mask = async (layer: number): Promise<Mask> => {
    this.masks.push(layer);
    return { layer, width: 8, height: 1, bits: Uint8Array.of(255) };
  };
  readonly check = (): Promise<Check> => this.#call("check", {});
  readonly previews: Options[] = [];
  readonly preview = async (options: Options = {}): Promise<PreviewedPlan> => {
    this.previews.push(options);
    return { schema: SCHEMA, report: { layers: 99, z_mm: [0], thickness_mm: [], lift_mm: 0 } as unknown as Preview, profile: new Float32Array() };
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
  readonly tradeoff = async (options: Options = {}): Promise<Tradeoff & { schema: typeof SCHEMA }> => {
    this.curves.push(options);
    const points = this.tolerances.map((tolerance) => ({ tolerance, layers: 1, max_error: tolerance, print_time_s: 1 }));
    return { schema: SCHEMA, points };
  };

  readonly orders: { prices: Prices; ordered: Ordered }[] = [];
  readonly price = async (prices: Prices, ordered: Ordered = {}): Promise<Price> => {
    this.orders.push({ prices, ordered });
    if (prices.currency === "") throw new SlicerError("bad-prices", "no", { field: "currency" });
    return { currency: prices.currency, digits: 2, copies: 1, finish: null, lines: [], total: 1240 + this.orders.length };
  };

  get last(): (typeof this.calls)[number] {
    const call = this.calls.at(-1);
    if (call === undefined) throw new Error("nothing was asked");
    return call;
  }

  #call<T>(what: string, watch: Pick<Watch, "signal">, options?: Options): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      watch.signal?.addEventListener("abort", () => reject(watch.signal?.reason));
      this.calls.push({ what, resolve, reject, ...(options && { options }) });
    });
  }
}
