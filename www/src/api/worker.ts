/** The worker, which holds one job. Only workers import the WebAssembly package. */
import * as Comlink from "comlink";
import init, { calibrate_cure, calibrate_layers, encode_group, head_bytes, fit_cure, identify, Job, OrientationSearch, price, printers, project_files, project_part, write_project, type InitOutput } from "../../pkg/cusp_slicer.js";
import { acceptCompatible } from "./adapters.js";
import { bytesOf } from "./bytes.js";
import { encodeGroups, isLong } from "./encode-groups.js";
import { holdLock } from "./liveness.js";
import { ring } from "./ring.js";
import { stlOf } from "./stl.js";
import "./callbacks.js";
import { endUpperHalves } from "./vectors.js";
import type { Help, KnownPrinter, OnProgress, Options, PackedCandidates, Remote, SearchStep, Written } from "./wire.js";

/** Chunks of a print file are merged into a Blob at this many bytes; the browser may keep that on disk. */
const BLOB_PART_BYTES = 8 << 20;

/** Parts of each ring for the warm-up, and rays: enough rounds in most loops for optimised code. */
const REHEARSED = 32;
const REHEARSED_RAYS = 256;

let job: Job | null = null;
let search: OrientationSearch | null = null;
/** The exports of the core. */
let core: InitOutput | null = null;

/** The job, without models at first. */
const current = (): Job => (job ??= new Job());

async function compile(address: string): Promise<WebAssembly.Module> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`the slicer could not be loaded (HTTP ${response.status})`);
  // Streaming needs the right content type, which plain file hosts do not always send.
  const typed = response.headers.get("content-type")?.startsWith("application/wasm") ?? false;
  return typed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

/** Writes a calibration print by a function of the core. */
async function calibrated(write: typeof calibrate_layers, options: Options, progress: OnProgress): Promise<Written> {
  const sink = new BlobSink();
  const report = await write(options, sink.take, progress);
  return { blob: sink.finish(), report };
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

/** Returns a function that hands out the encoded layer groups, and forgets each; null if the file is too short for helpers. */
async function encodedBy(plate: number, helpers: number, help: Help, progress: OnProgress): Promise<((group: number) => Uint8Array) | null> {
  const groups = current().layer_groups(plate);
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

const api: Remote = {
  async boot(module) {
    endUpperHalves();
    const compiled = typeof module === "string" ? await compile(module) : module;
    core = await init({ module_or_path: compiled });
    return compiled;
  },
  memory: () => core?.memory.buffer.byteLength ?? 0,
  async warmUp() {
    const one = ring(REHEARSED);
    const overlapping = one.map((mm, i) => (i % 3 === 0 ? mm + 1 : mm));
    const ringed = new Job();
    ringed.add(stlOf(Float32Array.from([...one, ...overlapping])), {});
    await ringed.plan({ options: { rays: REHEARSED_RAYS, backend: "cpu" } }, () => undefined);
    ringed.mask(0, 0);
    const groups = ringed.layer_groups(0);
    if (groups !== undefined) await encodeGroups(groups, 0, () => Promise.resolve(null), () => undefined);
    groups?.free();
    ringed.free();
  },
  async add(file, reading, progress, wantsPositions) {
    progress("load", 0, 0);
    // Rejects a file of another kind before reading all of it.
    identify(await bytesOf(file.slice(0, head_bytes())), file.size);
    current().add(await bytesOf(file), reading);
    const place = current().models() - 1;
    const info = current().info(place);
    if (wantsPositions !== true) return { info };
    const positions = current().positions(place);
    return Comlink.transfer({ info, positions }, [positions.buffer]);
  },
  remove: (model) => current().remove(model),
  async plan(options, progress) {
    const job = current();
    const report = await job.plan(options, progress);
    const { plates } = report;
    const profiles = plates.map(({ metric, source }, plate) => job.profile(plate, metric, source));
    const places = Array.from({ length: job.models() }, (_, model) => model);
    const models = plates.flatMap((plate) => plate.models);
    const isSupported = models.some(({ supported }) => supported !== undefined);
    const isHollow = models.some(({ hollowed }) => hollowed !== undefined);
    const supports = isSupported ? places.map((model) => job.supports(model)) : null;
    const voids = isHollow ? places.map((model) => job.voids(model)) : null;
    const buffers = [profiles, supports, voids].flatMap((arrays) => arrays?.map(({ buffer }) => buffer) ?? []);
    return Comlink.transfer({ report, profiles, ...(supports && { supports }), ...(voids && { voids }) }, buffers);
  },
  arrange: (options) => current().arrange(options),
  problems: (options) => current().problems(options),
  tradeoff: (plate, options, points, progress) => current().tradeoff(plate, options, points, progress),
  compare: (plate, options, progress) => current().compare(plate, options, progress),
  inspect: (plate, limits, progress) => current().inspect(plate, limits, progress),
  mask(plate, layer) {
    const bits = current().mask(plate, layer);
    return Comlink.transfer(bits, [bits.buffer]);
  },
  async archive(plate, progress, take, helpers, help) {
    const encoded = helpers === 0 ? null : await encodedBy(plate, helpers, help, progress);
    if (take !== null) {
      current().archive(plate, encoded, (chunk) => take(own(chunk)), progress);
      return null;
    }
    const sink = new BlobSink();
    current().archive(plate, encoded, sink.take, progress);
    return sink.finish();
  },
  encodeGroup(format, canvas, runs) {
    const bytes = encode_group(format, canvas, runs);
    return Comlink.transfer(bytes, [bytes.buffer]);
  },
  plugs(model) {
    const file = stlOf(current().plugs(model));
    return Comlink.transfer(file, [file.buffer]);
  },
  positions(model) {
    const positions = current().positions(model);
    return Comlink.transfer(positions, [positions.buffer]);
  },
  preview(model, options) {
    const report = current().preview(model, options);
    const profile = current().preview_profile();
    return Comlink.transfer({ report, profile }, [profile.buffer]);
  },
  saliency(model, progress) {
    const saliency = current().saliency(model, progress);
    return Comlink.transfer(saliency, [saliency.buffer]);
  },
  setWeights(model, weights) {
    current().set_weights(model, weights);
  },
  weightsFile(model, weights) {
    const bytes = own(current().weights_file(model, weights));
    return Comlink.transfer(bytes, [bytes.buffer]);
  },
  async readWeights(model, file) {
    const weights = current().read_weights(model, await bytesOf(file));
    return Comlink.transfer(weights, [weights.buffer]);
  },
  startSearch(model, options, wanted, measured) {
    const started = measured === null ? current().search(model, options, wanted) : OrientationSearch.of_measured(wanted, measured);
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
  evaluate(model, options, tasks) {
    const measure = (directions: [number, number, number][]): PackedCandidates => current().evaluate(model, options, Float64Array.from(directions.flat()));
    const results = tasks.map(({ number, directions }) => ({ number, candidates: measure(directions) }));
    return Comlink.transfer(results, results.map(({ candidates }) => candidates.buffer));
  },
  calibrateLayers: (options, progress) => calibrated(calibrate_layers, options, progress),
  calibrateCure: (options, progress) => calibrated(calibrate_cure, options, progress),
  fitCure: (measured_mm, resin) => fit_cure(Float64Array.from(measured_mm), resin) ?? null,
  // The core fills in the defaults of its list.
  printers: () => printers() as KnownPrinter[],
  async readProject(file) {
    const bytes = await bytesOf(file);
    const part = project_part(bytes);
    if (part === undefined) return null;
    const parts = project_files(bytes);
    const files = Array.from({ length: parts.length / 2 }, (_, model) => {
      const [own, weights] = parts.slice(2 * model) as Uint8Array<ArrayBuffer>[];
      return { file: new Blob(own === undefined ? [] : [own]), weights: weights === undefined || weights.length === 0 ? null : new Float32Array(weights.buffer) };
    });
    return { part, files };
  },
  async writeProject(part, files) {
    const bytes: Uint8Array[] = [];
    for (const { file, weights } of files) bytes.push(await bytesOf(file), new Uint8Array(weights?.slice().buffer ?? []));
    const project = own(write_project(part, bytes));
    return Comlink.transfer(project, [project.buffer]);
  },
  price(prices, items, finish) {
    const numbers = items.flatMap(({ copies, resin_ml, support_ml = NaN, print_time_s }) => [copies, resin_ml, support_ml, print_time_s]);
    return price(prices, Float64Array.from(numbers), finish);
  },
};

if (globalThis.navigator?.gpu !== undefined) acceptCompatible(navigator.gpu);
// On a server that imports every entry, there is no message target.
if (globalThis.addEventListener !== undefined) {
  holdLock();
  Comlink.expose(api);
}
