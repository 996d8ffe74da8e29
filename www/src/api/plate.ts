/**
 * The headless plate: several models in one job.
 *
 *     const { plate } = slicer;
 *     await plate.add(cup);
 *     await plate.add(ring, { copies: 20 });
 *     const { plates } = await plate.plan({ printer: "saturn-3-ultra" });
 *     const { name, blob } = await plate.export(0);
 *
 * As with one model, a call takes its place in the queue when it is made: it is about the models that were added, changed and
 * removed before it, awaited or not. The plate has a worker of its own, which starts on first use: its models and the one of
 * `slicer.load()` leave each other alone.
 */
import type { Compiled, Watch, WorkerHandle } from "./calls.js";
import type { Weights } from "./client.js";
import { checkWhole, SlicerError } from "./error.js";
import { PlateClient, type Loaded } from "./plate-client.js";
import type { OrderedPlates } from "./price.js";
import { CURVE_POINTS, printFile, SCHEMA, type Mask, type PrintFile, type Versioned } from "./results.js";
import { resolve, stemOf, type Source } from "./source.js";
import type { ArrangeError, Arranging, Limits, MeshInfo, ModelOptions, Options, Placement, PlateOptions, PlatePrintability, Price, Prices, Profiled, ReadOptions, Report, Tradeoff } from "./wire.js";

/** A model of a plate. */
export interface PlateModel extends Versioned {
  /** Tells it from the others for as long as the plate lives. */
  id: number;
  name: string;
  file: Blob;
  /** The choices with which it was read. */
  reading: ReadOptions;
  info: MeshInfo;
  /** How it differs from the options of the job, and its number of copies. */
  own: ModelOptions;
}

/** What to change of a model's own options; `undefined` leaves it to the job's. */
export type ModelChange = { [Name in keyof ModelOptions]?: ModelOptions[Name] | undefined };

export interface AddCall extends Watch {
  /** The model's name; that of the source if absent. */
  name?: string;
  /** Choices that the file leaves: a plate of a 3MF project, surfaces as models, curved caps. */
  reading?: ReadOptions;
}

/** What will fail when a plate is printed, and the verdict. */
export interface PlateCheck extends Versioned, PlatePrintability {}

/** How copies are arranged, or where they stand. */
export interface PlateCall extends Watch {
  arranging?: Arranging;
  /** Where each copy stands: `model` is the place of its model in `models()`, from 0. If empty, copies are arranged. */
  placements?: readonly Placement[];
}

/** The plans of all plates. */
export interface PlatesPlan extends Versioned {
  /** One for each plate. `report.plate` has its models, where each copy stands, and each copy's share of time and resin. */
  plates: Profiled<Report>[];
  /**
   * Vertex positions of the supports of each model, in the order of `models()`: nine numbers a facet, mm, z from the plate, for a
   * copy that stands in the middle and is not turned. Absent without supports.
   */
  supports?: Float32Array[];
  /** Print time of all plates, one after the other. */
  print_time_s: number;
  /** Volume of resin in all copies. */
  resin_ml: number;
}

export interface Plate {
  /** Reads a model and adds it after the others. */
  add(source: Source, own?: ModelChange, call?: AddCall): Promise<PlateModel>;
  /** Changes some of what a model has of its own. Rejects with `plate-no-model` if it is not on the plate. */
  update(id: number, own: ModelChange): Promise<PlateModel>;
  /** Rejects with `plate-no-model` if it is not on the plate. */
  remove(id: number): Promise<void>;
  /** The models in their order. */
  models(): Promise<readonly PlateModel[]>;
  /** Sets how much each facet of a model matters, as `slicer.setWeights()` does for its model. */
  setWeights(id: number, weights: Float32Array | null, call?: Watch): Promise<void>;
  /** The corners of all facets of a model in mm, nine numbers per facet, in the file's frame. */
  positions(id: number, call?: Watch): Promise<Float32Array>;
  /** Where copies stand when they are arranged: on the fewest plates, then lowest. */
  arrange(options?: Options, arranging?: Arranging, call?: Watch): Promise<Placement[]>;
  /** What is wrong with placements: copies that extend beyond their plate, and copies that overlap. */
  problems(options: Options, placements: readonly Placement[], call?: Watch): Promise<ArrangeError[]>;
  /** Plans the layers of all plates. A change of options recomputes only what depends on it. */
  plan(options?: Options, call?: PlateCall): Promise<PlatesPlan>;
  /** The mask of a layer of a plate of the last plan, both counted from 0. */
  mask(plate: number, layer: number, call?: Watch): Promise<Mask>;
  /** The best plans of a plate of the last plan, as `slicer.tradeoff()` has them of a model: 40 unless `points` says otherwise. */
  tradeoff(plate: number, points?: number, call?: Watch): Promise<Tradeoff & Versioned>;
  /** What will fail when a plate of the last plan is printed, model by model, as `slicer.check()` says it of one. */
  check(plate: number, limits?: Limits, call?: Watch): Promise<PlateCheck>;
  /** The print file of a plate of the last plan, counted from 0. */
  export(plate: number, call?: Watch): Promise<PrintFile>;
  /** What all copies of the last plan cost by the prices of a shop, each with its share of its plate's time. */
  price(prices: Prices, ordered?: OrderedPlates, call?: Watch): Promise<Price>;
}

/** A plate with its worker. */
export interface RunningPlate extends Plate {
  rest(): void;
  dispose(): void;
}

/** A model with its weights, which the page knows already. */
interface Entry extends PlateModel {
  weights: Weights;
}

export function createPlate(spawn: () => WorkerHandle, compiled: Compiled): RunningPlate {
  const client = new PlateClient(spawn, compiled);
  /** The models of a call made now, resolved once earlier calls have settled. */
  let models: Promise<readonly Entry[]> = Promise.resolve([]);
  let added = 0;

  const jobOf = (options: Options, arranging: Arranging | undefined, placements: readonly Placement[] = []): Promise<PlateOptions> =>
    models.then((all) => ({
      options,
      models: all.map(({ own }) => own),
      ...(arranging !== undefined && { arranging }),
      placements: [...placements],
    }));

  /** Replaces a model; `null` removes it. */
  const change = (id: number, changed: (entry: Entry) => Entry | null): Promise<Entry | null> => {
    const before = models;
    const outcome = before.then((all) => {
      const place = placeOf(all, id);
      const entry = changed(all[place] as Entry);
      const rest = all.filter((_, other) => other !== place);
      return { entry, all: entry === null ? rest : all.map((it, other) => (other === place ? entry : it)) };
    });
    models = outcome.then(
      ({ all }) => all,
      () => before,
    );
    return outcome.then(({ entry }) => entry);
  };

  return {
    async add(source, own = {}, { name, reading = {}, ...call } = {}) {
      const id = ++added;
      const before = models;
      const named = resolve(source, call.signal);
      const read = client.add(before, id, named.then(({ file: blob }) => ({ blob, reading })), call);
      const entry = Promise.all([named, read]).then(
        ([it, info]): Entry => ({ schema: SCHEMA, id, name: name ?? it.name, file: it.file, reading, info, own: merged({}, own), weights: null }),
      );
      models = Promise.all([before, entry]).then(
        ([all, entry]) => [...all, entry],
        () => before,
      );
      return seen(await entry);
    },
    async update(id, own) {
      return seen((await change(id, (entry) => ({ ...entry, own: merged(entry.own, own) }))) as Entry);
    },
    async remove(id) {
      await change(id, () => null);
      if ((await models).length === 0) client.trim();
    },
    models: () => models.then((all) => all.map(seen)),
    async setWeights(id, weights, call = {}) {
      const before = models;
      const own = weights?.slice() ?? null;
      const changed = change(id, (entry) => ({ ...entry, weights: own }));
      changed.catch(() => undefined);
      const painted = models;
      try {
        const sent = client.bring(painted, call);
        await changed;
        await sent;
      } catch (error) {
        // Refused weights do not apply to later calls.
        if (models === painted) models = before;
        throw error;
      }
    },
    positions: (id, call = {}) => client.positions(models, (all) => placeOf(all, id), call),
    arrange: (options = {}, arranging, call = {}) => client.arrange(models, jobOf(options, arranging), call),
    problems: (options, placements, call = {}) => client.problems(models, jobOf(options, undefined, placements), call),
    async plan(options = {}, { arranging, placements, ...call } = {}) {
      const { report, profiles, supports } = await client.plan(models, jobOf(options, arranging, placements), call);
      const { print_time_s, resin_ml } = report;
      const plates = report.plates.map((report, plate) => ({ report, profile: profiles[plate] ?? new Float32Array(0) }));
      return { schema: SCHEMA, plates, print_time_s, resin_ml, ...(supports !== undefined && { supports }) };
    },
    async mask(plate, layer, call = {}) {
      checkWhole("plate", plate);
      checkWhole("layer", layer);
      const { bits, of } = await client.mask(plate, layer, call);
      const { width, height } = reportOf(of.report.plates, plate).mask;
      return { layer, width, height, bits };
    },
    async tradeoff(plate, points = CURVE_POINTS, call = {}) {
      checkWhole("plate", plate);
      return { schema: SCHEMA, ...(await client.tradeoff(plate, points, call)) };
    },
    async check(plate, limits = {}, call = {}) {
      checkWhole("plate", plate);
      return { schema: SCHEMA, ...(await client.inspect(plate, limits, call)) };
    },
    async export(plate, call = {}) {
      checkWhole("plate", plate);
      const { blob, of } = await client.archive(plate, call);
      const report = reportOf(of.report.plates, plate);
      return printFile(`${stemOfPlate(plate, report, of.models)}-cusp`, blob, report);
    },
    price: (prices, ordered = {}, call = {}) => client.price(prices, ordered, call),
    rest: () => client.rest(),
    dispose: () => client.dispose(),
  };
}

/** What a page sees of a model: the weights are the plate's. */
function seen({ schema, id, name, file, reading, info, own }: Entry): PlateModel {
  return { schema, id, name, file, reading, info, own };
}

/** The options of a model with some of them changed. */
function merged(before: ModelOptions, changed: ModelChange): ModelOptions {
  const all = Object.entries({ ...before, ...changed });
  return Object.fromEntries(all.filter(([, value]) => value !== undefined));
}

function placeOf(all: readonly Loaded[], id: number): number {
  const place = all.findIndex((entry) => entry.id === id);
  if (place >= 0) return place;
  throw new SlicerError("plate-no-model", `there is no model ${id} on the plate`, { model_number: id, models: all.length });
}

/** The report of a plate that the core has just served. */
function reportOf(reports: readonly Report[], plate: number): Report {
  const report = reports[plate];
  if (report === undefined) throw new Error(`there is no plate ${plate}`);
  return report;
}

/** The only model's name, or the plate's. */
function stemOfPlate(plate: number, { plate: on }: Report, models: readonly Loaded[]): string {
  const [only, ...others] = on?.models ?? models.map((_, model) => ({ model }));
  const isOne = others.length === 0 && (on?.plates ?? 1) === 1;
  const name = only === undefined ? undefined : models[only.model]?.name;
  return isOne && name !== undefined ? stemOf(name) : `plate-${plate + 1}`;
}
