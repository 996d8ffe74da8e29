/**
 * Fake worker for tests: keeps the texts of its files and plans at once. One copy makes one plate; several make two plates, each with
 * copies of every model. The supports of a model hold its index.
 */
import type { WorkerHandle } from "./calls.js";
import type { JobOptions, MeshInfo, ModelPrintability, Placement, Preview, Price, Report, SlicerWorker } from "./wire.js";

/** Hook of a call, which may hang or throw. */
export type Work = (what: string) => Promise<void>;

/** @param work called with a description of each call */
export function fakeWorker(work: Work = async () => undefined): SlicerWorker {
  const models: { file: string; weights: string }[] = [];
  let planned: JobOptions = {};
  const all = (own: JobOptions["models"] = []): string =>
    models.map(({ file, weights }, place) => file + weights + ((own[place]?.copies ?? 1) === 1 ? "" : `×${own[place]?.copies}`)).join(" ") || "nothing";
  const say = (what: string): void => void work(what);
  const notFaked = (): Promise<never> => Promise.reject(new Error("not faked"));
  return {
    boot: async () => ({}),
    memory: () => 0,
    warmUp: async () => say("warmUp"),
    add: async (file, _reading, _progress, wantsPositions) => {
      const text = file.size < 100 ? await file.text() : "large";
      await work(`add ${text}`);
      if (text === "bad") throw { code: "empty-file", message: "no", detail: null };
      models.push({ file: text, weights: "" });
      const info = { facets: 1, search_bytes: 200 } as MeshInfo;
      return wantsPositions === true ? { info, positions: new Float32Array(9) } : { info };
    },
    remove: (model) => {
      say(`remove ${models[model]?.file}`);
      models.splice(model, 1);
    },
    positions: (model) => {
      say(`positions of ${models[model]?.file}`);
      return Float32Array.of(model);
    },
    setWeights: (model, weights) => {
      const there = models[model];
      say(`weigh ${there?.file} ${weights === null ? "equally" : weights.join()}`);
      if (weights?.some((weight) => weight > 1)) throw { code: "weights-out-of-range", message: "no", detail: null };
      if (there !== undefined) there.weights = weights === null ? "" : `*${weights.join()}`;
    },
    arrange: ({ models: own = [] }) => own.map((_, model): Placement => ({ model, plate: 0, x_mm: 0, y_mm: 0, turn_deg: 0 })),
    problems: () => [],
    plan: async (job, progress) => {
      const { options, models: own = [] } = job;
      progress("ldi", 0.5, 0.4);
      await work(`plan ${options?.tolerance} of ${all(own)}`);
      planned = job;
      const isAlone = models.length === 1 && (own[0]?.copies ?? 1) === 1;
      const plates = isAlone ? 1 : 2;
      const on = models.map((_, model) => own[model] ?? {}).map(({ copies = 1 }, model) => ({ model, copies, size_mm: [1, 1, 1], resin_ml: 1.5, print_time_s: 15, warnings: [] }));
      const report = (plate: number): Report => ({ ...fakeReport(job), plate, plate_count: plates, models: on, placements: [] }) as unknown as Report;
      return {
        report: { schema: 3, print_time_s: 60, resin_ml: 3, plates: Array.from({ length: plates }, (_, plate) => report(plate)) },
        profiles: Array.from({ length: plates }, (_, plate) => Float32Array.of(plate + 1)),
        ...([options, ...own].some((it) => it?.supports !== undefined) && { supports: own.map((_, model) => Float32Array.of(model)) }),
      };
    },
    tradeoff: async (plate, { options }, points) => {
      await work(`tradeoff ${points} of plate ${plate}, ${options?.rays} rays`);
      return { points: [] };
    },
    compare: notFaked,
    inspect: (plate, { wall_mm }) => {
      say(`inspect ${wall_mm} of plate ${plate}, ${planned.options?.tolerance}`);
      return { verdict: "review", models: [{ model: 0, turn_deg: 0 } as ModelPrintability] };
    },
    mask: (plate, layer) => {
      say(`mask ${layer} of plate ${plate}, ${planned.options?.tolerance}`);
      return new Uint8Array(2);
    },
    archive: (plate, _progress, take) => {
      say(`archive ${plate}`);
      for (const chunk of ["z", "ip"]) take?.(new TextEncoder().encode(chunk));
      return take === null ? new Blob(["zip"]) : null;
    },
    encodeGroup: () => new Uint8Array(1),
    plugs: (model) => {
      say(`plugs of ${models[model]?.file}, ${planned.options?.tolerance}`);
      return new Uint8Array(84);
    },
    preview: (model) => {
      say(`preview ${models[model]?.file}`);
      return { report: {} as Preview, profile: new Float32Array() };
    },
    saliency: () => Float32Array.of(0.5),
    weightsFile: (_, weights) => Uint8Array.from(weights, (weight) => 100 * weight),
    readWeights: async (_, file) => Float32Array.from(new Uint8Array(await file.arrayBuffer()), (byte) => byte / 100),
    startSearch: () => new Float64Array(0),
    advanceSearch: () => ({ tasks: [], measured: 0, progress: 0, rated: null, result: null }),
    evaluate: () => [],
    calibrateLayers: notFaked,
    calibrateCure: notFaked,
    fitCure: () => null,
    printers: () => [],
    readProject: notFaked,
    writeProject: notFaked,
    price: ({ currency }, items, finish) => {
      say(`price of ${JSON.stringify(items)}, ${finish}`);
      return { currency, total: 1 } as Price;
    },
  };
}

/** A report whose masks are as wide as the tolerance. */
export function fakeReport({ options }: JobOptions): Report {
  return {
    mask: { width: options?.tolerance ?? 9, height: 2 },
    print_file: { format: "uvj", extension: "uvj", media_type: "application/octet-stream" },
    models: [],
    warnings: [{ code: "inside-out" }],
    resin_ml: 2,
    print_time_s: 60,
  } as unknown as Report;
}

/** Starts fake workers, whose calls are logged as `worker number: call`. */
export function fakeWorkers(log: string[], own: (number: number, work: Work) => Partial<SlicerWorker> = () => ({}), work: Work = async () => undefined): () => WorkerHandle {
  let workers = 0;
  return () => {
    const number = ++workers;
    const working: Work = async (what) => {
      log.push(`${number}: ${what}`);
      await work(what);
    };
    return { remote: { ...fakeWorker(working), ...own(number, working) }, terminate: () => void log.push(`${number}: ended`), onBroken: () => undefined };
  };
}
