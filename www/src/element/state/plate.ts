/**
 * The models of a session, of which one is selected. It stands between the session and the slicer: a single copy of one model goes
 * the slicer's own way, several go to its plate, and the session shows the plan of one plate as it shows that of a model.
 */
import { SCHEMA, type Mask, type Model, type Plan, type PlateModel, type PlatesPlan, type PrintFile, type Watch } from "../../api/index.js";
import type { ArrangeError, Arranging, ModelOptions, Options, Placement, Tradeoff } from "../../api/wire.js";
import type { SlicerCalls } from "./host.js";
import type { Settings } from "./settings.js";

/** What the settings say about the selected model alone. */
export type Pose = Pick<Settings, "rotation" | "height">;

/** A model of the session. */
export interface Entry {
  readonly key: number;
  readonly model: Model;
  readonly copies: number;
  /** Its pose, as the settings have it while it is selected, and as options. */
  readonly pose: Pose;
  readonly own: Pick<ModelOptions, "rotation" | "height_mm">;
  readonly weights: Float32Array | null;
}

/** A copy on the plate shown. */
export interface Copy {
  /** Its place among all placements. */
  readonly place: number;
  readonly entry: Entry;
  readonly x_mm: number;
  readonly y_mm: number;
  readonly turn_deg: number;
  /** Height of the model in the plan; null while that is unknown. */
  readonly height_mm: number | null;
}

export interface PlateHost {
  changed(): void;
  /** The models, their copies or their places have changed: they are to be planned. */
  replate(): void;
  /** Another plate is to be shown. */
  show(plan: Plan): void;
  /** Another model was selected. */
  selected(entry: Entry): void;
}

/** What the slicer's plate has of an entry. */
interface There {
  readonly id: number;
  own: string;
  weights: Float32Array | null;
}

/** The most copies of a model. */
export const MOST_COPIES = 1000;

const UPRIGHT: Pose = { rotation: "", height: "" };

export class Plate {
  entries: readonly Entry[] = [];
  /** The place of the selected model. */
  selected = 0;
  /** The plate shown, from 0. */
  number = 0;
  arranging: Required<Arranging> = { spacing_mm: 2, turn_deg: 45 };
  /** Where copies stand by hand; empty: as they are arranged. */
  placed: readonly Placement[] = [];
  /** Where copies stand in the plan or by hand. */
  placements: readonly Placement[] = [];
  planned: PlatesPlan | null = null;
  problems: readonly ArrangeError[] = [];
  readonly #host: PlateHost;
  readonly #slicer: SlicerCalls;
  readonly #there = new Map<number, There>();
  #keys = 0;
  /** The last answers of `copies` and `crowded`: a new object would count as a change. */
  #copies: { entries: unknown; placements: unknown; number: number; planned: unknown; copies: readonly Copy[] } = {
    ...{ entries: null, placements: null, number: 0, planned: null },
    copies: [],
  };
  #crowded: { entries: unknown; problems: unknown; those: ReadonlySet<Entry> } = { entries: null, problems: null, those: new Set() };
  #options: Options = {};
  #isAsking = false;
  #asked: readonly Placement[] | null = null;
  readonly #positions = new Map<number, Promise<Float32Array>>();

  constructor(host: PlateHost, slicer: SlicerCalls) {
    this.#host = host;
    this.#slicer = slicer;
  }

  /** Whether the job is more than one copy of one model. */
  get isSeveral(): boolean {
    return this.entries.length > 1 || (this.entries[0]?.copies ?? 0) > 1;
  }

  /** Number of plates of the plan. */
  get plates(): number {
    return Math.max(1, ...this.placements.map(({ plate = 0 }) => plate + 1));
  }

  /** The copies on the plate shown. */
  get copies(): readonly Copy[] {
    const { entries, placements, number, planned } = this;
    const known = this.#copies;
    const isKnown = known.entries === entries && known.placements === placements && known.number === number && known.planned === planned;
    if (isKnown) return known.copies;
    const copies = this.#copiesNow();
    this.#copies = { entries, placements, number, planned, copies };
    return copies;
  }

  #copiesNow(): readonly Copy[] {
    return this.placements.flatMap(({ model, plate = 0, x_mm, y_mm, turn_deg = 0 }, place) => {
      const entry = this.entries[model];
      return entry === undefined || plate !== this.number ? [] : [{ place, entry, x_mm, y_mm, turn_deg, height_mm: this.heightOf(model) }];
    });
  }

  /** The models that problems name: which of their copies it is, their boxes say. */
  get crowded(): ReadonlySet<Entry> {
    const { entries, problems } = this;
    if (this.#crowded.entries === entries && this.#crowded.problems === problems) return this.#crowded.those;
    const those = this.#crowdedNow();
    this.#crowded = { entries, problems, those };
    return those;
  }

  #crowdedNow(): ReadonlySet<Entry> {
    const numbers = this.problems.flatMap((problem) => {
      if (problem.code === "plate-outside") return [problem.detail.model_number];
      return problem.code === "plate-collision" ? problem.detail.model_numbers : [];
    });
    return new Set(numbers.flatMap((number) => this.entries[number - 1] ?? []));
  }

  /** Starts again with one model. */
  open(model: Model): void {
    for (const { key } of this.entries) this.#leave(key);
    this.entries = [this.#entryOf(model)];
    this.selected = 0;
    this.#forget();
  }

  /** Reads models and adds them after the others: all, or on a failure none. Returns the new ones. */
  async add(files: readonly File[], watch: Watch): Promise<readonly Entry[]> {
    const read: Entry[] = [];
    try {
      await this.#bring(watch);
      for (const file of files) {
        const { id, name, info } = await this.#slicer.plate.add(file, {}, watch);
        const entry = this.#entryOf({ schema: SCHEMA, name, file, info });
        this.#there.set(entry.key, { id, own: "{}", weights: null });
        read.push(entry);
      }
    } catch (error) {
      for (const { key } of read) this.#leave(key);
      throw error;
    }
    this.entries = [...this.entries, ...read];
    this.#forget();
    return read;
  }

  remove(place: number): void {
    const entry = this.entries[place];
    if (entry === undefined || this.entries.length < 2) return;
    this.#leave(entry.key);
    this.entries = this.entries.filter((_, other) => other !== place);
    this.#forget();
    if (place < this.selected) this.selected--;
    else if (place === this.selected) {
      this.selected = Math.min(place, this.entries.length - 1);
      this.#tellSelected();
      return;
    }
    this.#host.replate();
  }

  setCopies(place: number, copies: number): void {
    const entry = this.entries[place];
    const within = Math.min(Math.max(1, Math.round(copies)), MOST_COPIES);
    if (entry === undefined || Number.isNaN(within) || within === entry.copies) return;
    this.#change(place, { copies: within });
    this.#forget();
    this.#host.replate();
  }

  select(place: number): void {
    if (place === this.selected || this.entries[place] === undefined) return;
    this.selected = place;
    this.#tellSelected();
  }

  /** Keeps what the settings and the brush say about the selected model. */
  keep(kept: Partial<Pick<Entry, "pose" | "own" | "weights">>): void {
    this.#change(this.selected, kept);
  }

  /** Arranges all copies again, also those that were moved. */
  arrange(arranging: Arranging = {}): void {
    this.arranging = { ...this.arranging, ...arranging };
    this.#forget();
    this.#host.replate();
  }

  /** Moves a copy on its plate; problems follow, and the plan once it is released. */
  move(place: number, to: Partial<Pick<Placement, "x_mm" | "y_mm" | "turn_deg">>, isFinal: boolean): void {
    const moved = this.placements[place];
    if (moved === undefined) return;
    this.placements = this.placed = this.placements.map((it, other) => (other === place ? { ...moved, ...to } : it));
    this.#host.changed();
    void this.#check();
    if (isFinal) this.#host.replate();
  }

  /** Shows another plate. */
  show(number: number): void {
    const plan = this.planned?.plates[number];
    if (plan === undefined) return;
    this.number = number;
    this.#host.show({ schema: SCHEMA, ...plan });
  }

  /** Height of a model in the last plan, by its place; null without a plan of several. */
  heightOf(place: number): number | null {
    const models = this.planned?.plates.flatMap(({ report }) => report.plate?.models ?? []);
    return models?.find(({ model }) => model === place)?.size_mm[2] ?? null;
  }

  /** The corners of all facets of a model, fetched once. */
  positionsOf(entry: Entry): Promise<Float32Array> {
    let positions = this.#positions.get(entry.key);
    if (positions === undefined) {
      const there = this.#there.get(entry.key);
      positions = there === undefined ? Promise.resolve(new Float32Array(0)) : this.#slicer.plate.positions(there.id);
      positions.catch(() => this.#positions.delete(entry.key));
      if (there !== undefined) this.#positions.set(entry.key, positions);
    }
    return positions;
  }

  async plan(options: Options, watch: Watch): Promise<Plan> {
    if (!this.isSeveral) {
      this.planned = null;
      this.placements = this.problems = [];
      return this.#slicer.plan(options, watch);
    }
    const { placed, arranging } = this;
    this.#options = jobOf(options);
    await this.#bring(watch);
    const planned = await this.#slicer.plate.plan(this.#options, { ...watch, arranging, placements: placed });
    this.planned = planned;
    this.number = Math.min(this.number, planned.plates.length - 1);
    this.problems = [];
    // A single copy has no placement.
    this.placements = placed.length > 0 ? placed : planned.plates.flatMap(({ report }) => report.plate?.placements ?? []);
    const plan = planned.plates[this.number];
    if (plan === undefined) throw new Error("a plan without plates");
    return { schema: SCHEMA, ...plan };
  }

  mask(layer: number): Promise<Mask> {
    return this.planned === null ? this.#slicer.mask(layer) : this.#slicer.plate.mask(this.number, layer);
  }

  export(watch: Watch, number = this.number): Promise<PrintFile> {
    return this.planned === null ? this.#slicer.export(undefined, watch) : this.#slicer.plate.export(number, watch);
  }

  /** The curve of a model; a plate has none. */
  async tradeoff(options?: Options, points?: number, watch?: Watch): Promise<Tradeoff & { schema: typeof SCHEMA }> {
    if (this.planned !== null) return { schema: SCHEMA, points: [] };
    return this.#slicer.tradeoff(options, points, watch);
  }

  /** Tells the slicer's plate what has changed since the last call. Its models are in the order of the entries. */
  async #bring(watch: Watch): Promise<void> {
    const { plate } = this.#slicer;
    for (const { key, model, copies, own, weights } of this.entries) {
      let there = this.#there.get(key);
      if (there === undefined) {
        const { id }: PlateModel = await plate.add(model.file, {}, { ...watch, name: model.name });
        this.#there.set(key, (there = { id, own: "{}", weights: null }));
      }
      const now = { copies, rotation: own.rotation, height_mm: own.height_mm };
      if (there.own !== JSON.stringify(now)) {
        await plate.update(there.id, now);
        there.own = JSON.stringify(now);
      }
      if (there.weights !== weights) {
        await plate.setWeights(there.id, weights, watch);
        there.weights = weights;
      }
    }
  }

  /** Asks what is wrong with the places, one call at a time; the newest counts. */
  async #check(): Promise<void> {
    this.#asked = this.placements;
    if (this.#isAsking) return;
    this.#isAsking = true;
    try {
      while (this.#asked !== null) {
        const asked = this.#asked;
        this.#asked = null;
        const problems = await this.#slicer.plate.problems(this.#options, asked);
        if (this.placements !== asked && this.#asked === null) break;
        this.problems = problems;
        this.#host.changed();
      }
    } catch {
      // The plan that follows reports what failed.
    } finally {
      this.#isAsking = false;
    }
  }

  #entryOf(model: Model): Entry {
    return { key: ++this.#keys, model, copies: 1, pose: UPRIGHT, own: {}, weights: null };
  }

  #change(place: number, changed: Partial<Entry>): void {
    this.entries = this.entries.map((entry, other) => (other === place ? { ...entry, ...changed } : entry));
  }

  #leave(key: number): void {
    const there = this.#there.get(key);
    this.#there.delete(key);
    this.#positions.delete(key);
    if (there !== undefined) this.#slicer.plate.remove(there.id).catch(() => undefined);
  }

  #tellSelected(): void {
    const entry = this.entries[this.selected];
    if (entry !== undefined) this.#host.selected(entry);
  }

  /** Forgets where copies stand. */
  #forget(): void {
    this.placed = this.placements = [];
    this.problems = [];
    this.number = 0;
  }
}

/** The options of a job: each model has its own pose. */
function jobOf(options: Options): Options {
  const job = { ...options };
  delete job.rotation;
  delete job.height_mm;
  return job;
}
