/** The worker: the only file that imports the WebAssembly package. One model is open at a time, and there is one plate. */
import * as Comlink from "comlink";
import init, { calibrate_layers, encode_group, head_bytes, identify, OrientationSearch, Plate, price, printers, Slicer, type InitOutput } from "../../pkg/cusp_slicer.js";
import { acceptCompatible } from "./adapters.js";
import { bytesOf } from "./bytes.js";
import { encodeGroups, isLong } from "./encode-groups.js";
import { holdLock } from "./liveness.js";
import { ring } from "./ring.js";
import { stlOf } from "./stl.js";
import "./told.js";
import { endUpperHalves } from "./vectors.js";
import type { Help, KnownPrinter, OnProgress, PackedCandidates, PlateWorker, ReadOptions, Remote, SearchStep } from "./wire.js";

/** Chunks of a print file are merged into a Blob at this many bytes; the browser may keep that on disk. */
const BLOB_PART_BYTES = 8 << 20;

/** The size of a rehearsal: a few ms of work once it is compiled, but in most loops enough rounds to have them compiled well. */
const REHEARSED = 20;
const REHEARSED_RAYS = 128;

let slicer: Slicer | null = null;
let plate: Plate | null = null;
let search: OrientationSearch | null = null;
/** The exports of the core. */
let core: InitOutput | null = null;

/** The open model. The client opens one before any call that needs it. */
function current(): Slicer {
  if (slicer === null) throw new Error("no model is open");
  return slicer;
}

async function compile(address: string): Promise<WebAssembly.Module> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`the slicer could not be loaded (HTTP ${response.status})`);
  // Streaming needs the right content type, which plain file hosts do not always send.
  const typed = response.headers.get("content-type")?.startsWith("application/wasm") ?? false;
  return typed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

/** Bytes that can be transferred: a view of the core's memory, or of a larger buffer, is copied. */
function own(bytes: Uint8Array): Uint8Array<ArrayBuffer> {
  const isShared = bytes.buffer === core?.memory.buffer || bytes.byteLength !== bytes.buffer.byteLength;
  return isShared ? bytes.slice() : (bytes as Uint8Array<ArrayBuffer>);
}

/** Collects chunks into a Blob without ever holding all of them in one array. */
class BlobSink {
  #done = new Blob([]);
  #parts: Uint8Array<ArrayBuffer>[] = [];
  #bytes = 0;

  readonly take = (chunk: Uint8Array): void => {
    this.#parts.push(own(chunk));
    this.#bytes += chunk.byteLength;
    if (this.#bytes >= BLOB_PART_BYTES) this.#fold();
  };

  finish(): Blob {
    this.#fold();
    return this.#done;
  }

  #fold(): void {
    this.#done = new Blob([this.#done, ...this.#parts]);
    this.#parts = [];
    this.#bytes = 0;
  }
}

/** The plate, empty at first. */
const onPlate = (): Plate => (plate ??= new Plate());

/** Reads a model; a file that is none is rejected before all of it is read. */
async function read(file: Blob, reading: ReadOptions): Promise<Slicer> {
  identify(await bytesOf(file.slice(0, head_bytes())), file.size);
  return new Slicer(await bytesOf(file), reading);
}

/** Hands out the layers of the print file once helpers have encoded them, and forgets each; null if it is written sooner without. */
async function encodedBy(helpers: number, help: Help, progress: OnProgress): Promise<((group: number) => Uint8Array) | null> {
  const groups = current().layer_groups();
  if (groups === undefined) return null;
  try {
    if (!isLong(groups)) return null;
    const encoded: (Uint8Array | undefined)[] = await encodeGroups(groups, helpers, help, progress);
    return (group) => {
      const bytes = encoded[group];
      encoded[group] = undefined;
      return bytes ?? new Uint8Array();
    };
  } finally {
    groups.free();
  }
}

const plateApi: Pick<Remote, keyof PlateWorker> = {
  async addToPlate(file, reading, progress) {
    progress("load", 0, 0);
    const model = await read(file, reading);
    const info = model.info();
    onPlate().add(model);
    return info;
  },
  removeFromPlate: (model) => onPlate().remove(model),
  platePositions(model) {
    const positions = onPlate().positions(model);
    return Comlink.transfer(positions, [positions.buffer]);
  },
  setPlateWeights: (model, weights) => onPlate().set_weights(model, weights),
  arrangePlate: (options) => onPlate().arrange(options),
  plateProblems: (options) => onPlate().problems(options),
  async planPlate(options, progress) {
    const plate = onPlate();
    const report = await plate.plan(options, progress);
    const profiles = report.plates.map(({ metric, source }, number) => plate.profile(number, metric, source));
    const isSupported = report.plates.some(({ supported }) => supported !== undefined);
    const supports = isSupported ? (options.models ?? []).map((_, model) => plate.supports(model)) : [];
    const buffers = [...profiles, ...supports].map(({ buffer }) => buffer);
    return Comlink.transfer({ report, profiles, ...(isSupported && { supports }) }, buffers);
  },
  plateMask(number, layer) {
    const bits = onPlate().mask(number, layer);
    return Comlink.transfer(bits, [bits.buffer]);
  },
  tradeoffPlate: (number, points) => onPlate().tradeoff(number, points),
  inspectPlate: (number, limits, progress) => onPlate().inspect(number, limits, progress),
  archivePlate(number, progress) {
    const sink = new BlobSink();
    onPlate().archive(number, sink.take, progress);
    return sink.finish();
  },
};

const api: Remote = {
  ...plateApi,
  async boot(module) {
    endUpperHalves();
    const compiled = typeof module === "string" ? await compile(module) : module;
    core = await init({ module_or_path: compiled });
    return compiled;
  },
  memory: () => core?.memory.buffer.byteLength ?? 0,
  async rehearse() {
    const model = new Slicer(stlOf(ring(REHEARSED)), {});
    await model.plan({ rays: REHEARSED_RAYS, backend: "cpu" }, () => undefined);
    model.mask(0);
    model.free();
  },
  async open(file, reading, progress, wantsPositions) {
    progress("load", 0, 0);
    const opened = await read(file, reading);
    slicer?.free();
    slicer = opened;
    const info = opened.info();
    if (wantsPositions !== true) return { info };
    const positions = opened.positions();
    return Comlink.transfer({ info, positions }, [positions.buffer]);
  },
  async plan(options, progress) {
    const report = await current().plan(options, progress);
    const profile = current().profile(report.metric, report.source);
    const supports = report.supported === undefined ? {} : { supports: current().supports() };
    const voids = report.hollowed === undefined ? {} : { voids: current().voids() };
    const plan = { report, profile, ...supports, ...voids };
    return Comlink.transfer(plan, [profile, supports.supports, voids.voids].flatMap((it) => it?.buffer ?? []));
  },
  tradeoff: (options, points, progress) => current().tradeoff(options, points, progress),
  compare: (options, progress) => current().compare(options, progress),
  inspect: (limits, progress) => current().inspect(limits, progress),
  mask(layer) {
    const bits = current().mask(layer);
    return Comlink.transfer(bits, [bits.buffer]);
  },
  async archive(progress, take, helpers, help) {
    const encoded = helpers === 0 ? null : await encodedBy(helpers, help, progress);
    if (take !== null) {
      current().archive(encoded, (chunk) => take(own(chunk)), progress);
      return null;
    }
    const sink = new BlobSink();
    current().archive(encoded, sink.take, progress);
    return sink.finish();
  },
  encodeGroup(format, canvas, runs) {
    const bytes = encode_group(format, canvas, runs);
    return Comlink.transfer(bytes, [bytes.buffer]);
  },
  plugs() {
    const file = stlOf(current().plugs());
    return Comlink.transfer(file, [file.buffer]);
  },
  positions() {
    const positions = current().positions();
    return Comlink.transfer(positions, [positions.buffer]);
  },
  preview(options) {
    const report = current().preview(options);
    const profile = current().preview_profile();
    return Comlink.transfer({ report, profile }, [profile.buffer]);
  },
  saliency(progress) {
    const saliency = current().saliency(progress);
    return Comlink.transfer(saliency, [saliency.buffer]);
  },
  setWeights(weights) {
    current().set_weights(weights);
  },
  weightsFile(weights) {
    const bytes = own(current().weights_file(weights));
    return Comlink.transfer(bytes, [bytes.buffer]);
  },
  async readWeights(file) {
    const weights = current().read_weights(await bytesOf(file));
    return Comlink.transfer(weights, [weights.buffer]);
  },
  startSearch(options, wanted, measured) {
    const started = measured === null ? current().search(options, wanted) : OrientationSearch.of_measured(wanted, measured);
    search?.free();
    search = started;
    const directions = search.directions();
    return Comlink.transfer(directions, [directions.buffer]);
  },
  advanceSearch(results, most, rateFrom) {
    if (search === null) throw new Error("no search was started");
    for (const { number, candidates } of results) search.accept(number, candidates);
    const tasks = search.next_tasks(most);
    const measured = search.measured();
    const rated = measured >= rateFrom ? search.rated() : null;
    const best = search.best();
    const result = best === undefined ? null : { best, candidates: search.rated() };
    const step: SearchStep = { tasks, measured, progress: search.progress(), rated, result };
    return Comlink.transfer(step, [rated, result?.candidates, best].flatMap((numbers) => numbers?.buffer ?? []));
  },
  evaluate(options, tasks) {
    const measure = (directions: [number, number, number][]): PackedCandidates => current().evaluate(options, Float64Array.from(directions.flat()));
    const results = tasks.map(({ number, directions }) => ({ number, candidates: measure(directions) }));
    return Comlink.transfer(results, results.map(({ candidates }) => candidates.buffer));
  },
  async calibrateLayers(options, progress) {
    const sink = new BlobSink();
    const report = await calibrate_layers(options, sink.take, progress);
    return { blob: sink.finish(), report };
  },
  // The core fills in what its list leaves out.
  printers: () => printers() as KnownPrinter[],
  price(prices, items, finish) {
    const numbers = items.flatMap(({ copies, resin_ml, print_time_s }) => [copies, resin_ml, print_time_s]);
    return price(prices, Float64Array.from(numbers), finish);
  },
};

if (globalThis.navigator?.gpu !== undefined) acceptCompatible(navigator.gpu);
// On a server that imports every entry there is nothing to listen to.
if (globalThis.addEventListener !== undefined) {
  holdLock();
  Comlink.expose(api);
}
