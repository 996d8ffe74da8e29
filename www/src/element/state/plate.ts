/** The models of a session, one of which is selected, and the placements of their copies. The session shows the plan of one plate. */
import { SCHEMA, type LoadCall, type Mask, type Model, type Ordered, type Plan, type PrintFile, type Project, type Watch } from "../../api/index.js";
import type { Source } from "../../api/source.js";
import { FACTS } from "../../api/facts.js";
import type { ArrangeError, Arranging, ModelOptions, Options, Placement, Price, Prices, Printer, Tradeoff } from "../../api/wire.js";
import { placesOf } from "./collisions.js";
import type { SlicerCalls } from "./host.js";
import { DEFAULT_SETTINGS, quaternion, rotationText, type Fault } from "./settings.js";
import { isEqual } from "./plain.js";
import { poseIn, poseText, type Arrangement, type Pose, type Snapshot } from "./snapshot.js";
import { Sync } from "./sync.js";
import { read } from "./typed.js";

/** The corresponding options, with the voids and supports to which points and holes belong. */
export type Own = Pick<ModelOptions, "rotation" | "height_mm" | "hollow" | "supports">;

/** A pose as settings and, if these are valid, as options. */
export interface Posed {
  readonly pose: Pose;
  readonly own?: Own;
}

/** A model to add, with its own pose and copies. */
export interface Added {
  readonly source: Source;
  readonly own: Pick<Own, "rotation" | "height_mm"> & { readonly copies?: number };
  /** By default, the name of the source. */
  readonly name?: string;
}

/** A model of the session. */
export interface Entry extends Required<Posed> {
  readonly key: number;
  readonly model: Model;
  readonly copies: number;
  readonly weights: Float32Array | null;
}

/** Models, copies and placements as an undo step restores them. */
export interface PlateState extends Arrangement {
  /** Number of the set of models, which changes when a model is opened. */
  readonly job: number;
  readonly entries: readonly Entry[];
}

/** A copy on the plate shown. */
export interface Copy {
  /** Index among all placements. */
  readonly place: number;
  readonly entry: Entry;
  readonly x_mm: number;
  readonly y_mm: number;
  readonly turn_deg: number;
  /** Height of the model in the plan; null until known. */
  readonly height_mm: number | null;
  /** Vertex positions of its supports, for an unrotated copy in the middle of the plate; null if there are none for its pose. */
  readonly supports: Float32Array | null;
}

/** New coordinates of a copy. */
export interface Moved extends Partial<Pick<Placement, "x_mm" | "y_mm" | "turn_deg">> {
  /** Index among all placements. */
  readonly place: number;
}

/** An invalid number of copies, as typed for a model. */
export interface MisreadCopies {
  readonly key: number;
  readonly text: string;
  readonly fault: Fault;
}

export interface PlateHost {
  changed(): void;
  /** Called before models, copies or placements change; `kind` is that of the undo step, or null for none. */
  changing(kind: string | null): void;
  /** Called when models, copies or placements have changed and need a new plan. */
  replate(): void;
  /** Called when another plate is to be shown. */
  show(plan: Plan): void;
  /** Called when another model was selected. */
  selected(entry: Entry): void;
  /** Options of a model in a pose, with the current settings; null if one is invalid. */
  own(pose: Pose): Own | null;
}

/** Size of the plate of several copies without a printer, as of many screens of 4K; the side of its pixels. */
export const USUAL_VOLUME: Pick<Printer, "volume_mm"> = { volume_mm: [192, 120, 245] };
const USUAL_PIXEL_MM = 0.05;

/** Maximum number of copies per model. */
export const [, MOST_COPIES] = FACTS.usual.copies;

export class Plate {
  entries: readonly Entry[] = [];
  /** Index of the selected model. */
  selected = 0;
  /** Index of the plate shown. */
  number = 0;
  arranging: Required<Arranging> = FACTS.arranging;
  /** Places of copies set by hand; empty if all are arranged. */
  placed: readonly Placement[] = [];
  /** Current placements, from the plan or by hand. */
  placements: readonly Placement[] = [];
  /** The plan of several copies; null if there is only one. */
  planned: Plan | null = null;
  /** Models of that plan. */
  #planned: readonly Entry[] = [];
  problems: readonly ArrangeError[] = [];
  /** The last number of copies typed, if invalid. */
  misread: MisreadCopies | null = null;
  readonly #host: PlateHost;
  readonly #slicer: SlicerCalls;
  readonly #sync: Sync;
  #keys = 0;
  #job = 0;
  #jobs = 0;
  /** True while a copy is being dragged. */
  #isMoving = false;
  #drags = 0;
  /** Cached values of `copies` and `colliding`, since a new object would count as a change. */
  #copies: { entries: unknown; placements: unknown; number: number; planned: unknown; copies: readonly Copy[] } = {
    ...{ entries: null, placements: null, number: 0, planned: null },
    copies: [],
  };
  #colliding: { placements: unknown; problems: unknown; places: ReadonlySet<number> } = { placements: null, problems: null, places: new Set() };
  #options: Options = {};
  #isAsking = false;
  #asked: readonly Placement[] | null = null;

  constructor(host: PlateHost, slicer: SlicerCalls) {
    this.#host = host;
    this.#slicer = slicer;
    this.#sync = new Sync(slicer);
  }

  /** Returns true if the job is more than one copy of one model. */
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
      if (entry === undefined || plate !== this.number) return [];
      return [{ place, entry, x_mm, y_mm, turn_deg, height_mm: this.heightOf(model), supports: this.#supportsOf(entry) }];
    });
  }

  /** Supports of a model in the last plan; null if its pose has changed since. */
  #supportsOf({ key, own }: Entry): Float32Array | null {
    const place = this.#planned.findIndex((it) => it.key === key && JSON.stringify(it.own) === JSON.stringify(own));
    return this.planned?.supports?.[place] ?? null;
  }

  /** Indices of copies with faulty placements. */
  get colliding(): ReadonlySet<number> {
    const { placements, problems } = this;
    if (this.#colliding.placements === placements && this.#colliding.problems === problems) return this.#colliding.places;
    const places = placesOf(problems, placements);
    this.#colliding = { placements, problems, places };
    return places;
  }

  /** Reads a model that replaces all others. With reading options, reads the selected one again and keeps its copies. */
  async open(source: Source, call: LoadCall): Promise<Entry & { positions: Float32Array | null }> {
    const isAgain = call.reading !== undefined;
    const isAlone = !isAgain || this.entries.length < 2;
    const { positions, ...model } = await this.#sync.read(source, call, isAlone);
    const { copies = 1 } = this.entries[this.selected] ?? {};
    const entry = this.#entryOf(model, isAgain ? { copies } : {});
    this.#sync.note(entry, isAlone, positions);
    if (isAgain) {
      this.#host.changing(`read ${entry.key}`);
      this.#take(this.entries.map((it, place) => (place === this.selected ? entry : it)));
    } else {
      this.#replace([entry], 0);
    }
    this.#forget();
    return { ...entry, positions: positions ?? null };
  }

  /** Models, copies and placements of a snapshot. */
  get snapshot(): Omit<Snapshot, "query"> {
    const { selected, arranging, placed } = this;
    const models = this.entries.map(({ model: { name, file, reading }, copies, pose, weights }) => ({ name, file, reading, copies, pose: poseText(pose), weights }));
    return { models, selected, arranging, placed };
  }

  /** Models with these options, and the copies where they stand. */
  project(options: Options, form: string): Project {
    this.#settle();
    const { isSeveral, entries, placements, arranging } = this;
    const models = entries.map(({ copies, own }) => ({ copies, ...own }));
    const job = { options: isSeveral ? sharedOf(options) : withoutOwn(options), models, arranging, placements: isSeveral ? [...placements] : [] };
    const named = entries.map(({ model: { name, reading } }) => ({ name, reading }));
    return { part: { job, models: named, form }, files: entries.map(({ model: { file }, weights }) => ({ file, weights })) };
  }

  /** Replaces all models by those of a snapshot. Returns the selected one. */
  async reopen({ models, selected, arranging, placed }: Snapshot, call: LoadCall): Promise<Entry & { positions: Float32Array | null }> {
    const read: (Entry & { positions: Float32Array | null })[] = [];
    for (const { file, name, reading, copies, pose, weights } of models) {
      const isFirst = read.length === 0;
      const { positions, ...model } = await this.#sync.read(file, { ...call, name, reading }, isFirst);
      const entry = { ...this.#entryOf(model, { copies }), pose: poseIn(pose), weights };
      this.#sync.note(entry, isFirst, positions);
      read.push({ ...entry, positions: positions ?? null });
    }
    const chosen = read[selected] ?? read[0];
    if (chosen === undefined) throw new Error("a snapshot without models");
    this.#replace(read.map(({ positions: _positions, ...entry }) => entry), read.indexOf(chosen));
    this.arranging = arranging;
    this.#forget();
    this.placed = this.placements = placed;
    return chosen;
  }

  /** The slicer's id of the selected model. */
  get selectedId(): number | undefined {
    return this.#sync.idOf(this.entries[this.selected]?.key);
  }

  /** Sets the weights of the selected model. If the core refuses them, the plan reports the error. */
  paint(weights: Float32Array | null): void {
    this.keep({ weights });
    const { key } = this.entries[this.selected] ?? {};
    if (key !== undefined) this.#sync.paint(key, weights, {}).catch(() => undefined);
  }

  /** Reads models and appends them, all or none. Returns the new ones. */
  async add(added: readonly Added[], call: LoadCall): Promise<readonly Entry[]> {
    const entries: Entry[] = [];
    try {
      await this.#sync.bring(this.entries, call);
      for (const { source, own, name } of added) {
        const { positions, ...model } = await this.#sync.read(source, name === undefined ? call : { ...call, name }, false);
        const entry = this.#entryOf(model, own);
        this.#sync.note(entry, false, positions);
        entries.push(entry);
      }
    } catch (error) {
      for (const entry of entries) this.#sync.leave(entry);
      throw error;
    }
    this.#host.changing("add");
    this.entries = [...this.entries, ...entries];
    this.#forget();
    return entries;
  }

  remove(place: number): void {
    const entry = this.entries[place];
    if (entry === undefined || this.entries.length < 2) return;
    this.#host.changing(`remove ${entry.key}`);
    this.#take(this.entries.filter((_, other) => other !== place));
    this.#forget();
    if (place < this.selected) this.selected--;
    else if (place === this.selected) {
      this.selected = Math.min(place, this.entries.length - 1);
      this.#tellSelected();
      return;
    }
    this.#host.replate();
  }

  /** Sets the number of copies from text. Invalid text is kept and shown with its fault. */
  typeCopies(place: number, text: string, decimal?: string): void {
    const key = this.entries[place]?.key;
    const { value, fault: kind } = read(text, "", decimal);
    const within = { value, least: 1, most: MOST_COPIES, unit: "" } as const;
    let fault: Fault | null = null;
    if (value === null) fault = { kind, ...within };
    else if (!Number.isInteger(value)) fault = { kind: "whole" };
    else if (value < 1 || value > MOST_COPIES) fault = { kind: "range", ...within };
    else this.setCopies(place, value);
    this.misread = fault === null || key === undefined ? null : { key, text, fault };
    this.#host.changed();
  }

  setCopies(place: number, copies: number): void {
    this.misread = null;
    const entry = this.entries[place];
    const within = countOf(copies);
    if (entry === undefined || Number.isNaN(within) || within === entry.copies) return;
    this.#host.changing(`copies ${entry.key}`);
    this.#change(place, { copies: within });
    this.#forget();
    this.#host.replate();
  }

  /** Adds a copy of each of these copies, or of the selected model. */
  duplicate(places: readonly number[]): void {
    const models = places.length === 0 ? [this.selected] : places.map((place) => this.placements[place]?.model);
    const copies = this.entries.map(({ copies }, model) => countOf(copies + models.filter((it) => it === model).length));
    if (copies.every((count, model) => count === this.entries[model]?.copies)) return;
    this.misread = null;
    this.#host.changing("duplicate");
    this.entries = this.entries.map((entry, model) => ({ ...entry, copies: copies[model] ?? 1 }));
    this.#forget();
    this.#host.replate();
  }

  /** Removes copies; the others stay where they stand. Without others, nothing changes. */
  removeCopies(places: readonly number[]): void {
    const staying = this.placements.filter((_, place) => !places.includes(place));
    if (staying.length === 0 || staying.length === this.placements.length) return;
    const isStaying = (model: number): boolean => staying.some((it) => it.model === model);
    const models = this.entries.map((_, model) => model).filter(isStaying);
    const selected = models.indexOf(this.selected);
    this.misread = null;
    this.#host.changing(`remove copies ${places.join()}`);
    const counted = this.entries.map((entry, model) => ({ ...entry, copies: staying.filter((it) => it.model === model).length }));
    this.#take(counted.filter((_, model) => isStaying(model)));
    this.#forget();
    const plates = [...new Set(staying.map(({ plate = 0 }) => plate))].toSorted((a, b) => a - b);
    const placed = staying.map((it) => ({ ...it, model: models.indexOf(it.model), plate: plates.indexOf(it.plate ?? 0) }));
    if (this.isSeveral) this.placed = this.placements = placed;
    this.selected = Math.max(0, selected);
    if (selected < 0) this.#tellSelected();
    else this.#host.replate();
  }

  select(place: number): void {
    if (place === this.selected || this.entries[place] === undefined) return;
    this.#host.changing(null);
    this.selected = place;
    this.#tellSelected();
  }

  /** Stores changes of the selected model's pose or weights. */
  keep(kept: Partial<Omit<Entry, "key" | "model">>): void {
    this.#change(this.selected, kept);
  }

  /** State for an undo step. */
  get state(): PlateState {
    const { entries, selected, arranging, placed } = this;
    return { job: this.#job, entries, selected, arranging, placed };
  }

  /** Restores a state, with this pose of the model that was selected then. Returns false if nothing changes. */
  restore(state: PlateState, posed: Posed): boolean {
    const { job, entries, selected, arranging, placed } = state;
    const chosen = entries[selected];
    if (chosen === undefined) return false;
    const isSame = entries.length === this.entries.length && entries.every(({ key, copies }, i) => key === this.entries[i]?.key && copies === this.entries[i].copies);
    const isSelected = chosen.key === this.entries[this.selected]?.key;
    if (isSame && isSelected && arranging === this.arranging && placed === this.placed) return false;
    const { number } = this;
    this.misread = null;
    // Painted weights have their own undo steps.
    const painted = new Map(this.entries.map(({ key, weights }) => [key, weights]));
    this.#take(entries.map((entry) => ({ ...entry, weights: painted.has(entry.key) ? (painted.get(entry.key) ?? null) : entry.weights })));
    this.#job = job;
    this.selected = selected;
    this.keep(posed);
    this.arranging = arranging;
    this.#forget();
    this.placed = this.placements = placed;
    if (placed.length > 0) this.number = Math.min(number, this.plates - 1);
    if (isSelected) this.#host.replate();
    else this.#tellSelected();
    return true;
  }

  /** Arranges all copies automatically, including those moved by hand. */
  arrange(arranging: Arranging = {}): void {
    this.#host.changing(`arrange ${Object.keys(arranging).join()}`);
    this.arranging = { ...this.arranging, ...arranging };
    this.#forget();
    this.#host.replate();
  }

  /** Moves copies on their plates. Problems are checked during the move; the plan follows on release. */
  move(copies: readonly Moved[], isFinal: boolean): void {
    const moved = new Map(copies.map(({ place, ...to }) => [place, to]));
    // A drag is one undo step, and so are presses of an arrow key in quick succession.
    if (!this.#isMoving) this.#host.changing(isFinal ? `move ${[...moved.keys()].join()}` : `drag ${++this.#drags}`);
    this.#isMoving = !isFinal;
    this.placements = this.placed = this.placements.map((it, place) => ({ ...it, ...moved.get(place) }));
    this.#host.changed();
    void this.#check();
    if (isFinal) this.#host.replate();
  }

  /** Shows another plate. */
  show(number: number): void {
    const { planned } = this;
    const plan = planned?.plates[number];
    if (planned === null || plan === undefined) return;
    this.number = number;
    this.#host.show({ ...planned, ...plan });
  }

  /** Height of a model in the last plan, by its index; null without a plan of several copies. */
  heightOf(place: number): number | null {
    const models = this.planned?.plates.flatMap(({ report }) => report.models);
    return models?.find(({ model }) => model === place)?.size_mm[2] ?? null;
  }

  /** The corners of all facets of a model, fetched once. */
  positionsOf(entry: Entry): Promise<Float32Array> {
    return this.#sync.positionsOf(entry);
  }

  async plan(options: Options, watch: Watch): Promise<Plan> {
    this.#settle();
    const { entries, placed, arranging } = this;
    const synced = this.#sync.bring(entries, watch);
    // The call must be made immediately to keep its place in the queue.
    if (synced !== null) await synced;
    if (!this.isSeveral) {
      this.planned = null;
      this.placements = this.problems = [];
      return this.#slicer.plan(options, watch);
    }
    this.#options = sharedOf(options);
    const planned = await this.#slicer.plan(this.#options, { ...watch, arranging, placements: placed });
    this.planned = planned;
    this.#planned = entries;
    this.number = Math.min(this.number, planned.plates.length - 1);
    this.problems = [];
    this.placements = placed.length > 0 ? placed : planned.plates.flatMap(({ report }) => report.placements);
    const plan = planned.plates[this.number];
    if (plan === undefined) throw new Error("a plan without plates");
    return { ...planned, ...plan };
  }

  mask(layer: number): Promise<Mask> {
    return this.#slicer.mask(layer, { plate: this.number });
  }

  export(watch: Watch, plate = this.number): Promise<PrintFile> {
    return this.#slicer.export(undefined, { ...watch, plate });
  }

  price(prices: Prices, ordered: Ordered): Promise<Price> {
    return this.#slicer.price(prices, ordered);
  }

  /** Trade-off curve of the plate shown. */
  async tradeoff(options: Options = {}, points?: number, watch: Watch = {}): Promise<Tradeoff & { schema: typeof SCHEMA }> {
    if (this.planned === null) return this.#slicer.tradeoff(options, points, watch);
    const { number: plate, placements, arranging } = this;
    return this.#slicer.tradeoff(sharedOf(options), points, { ...watch, plate, placements, arranging });
  }

  /** Checks the placements for problems, one call at a time; only the newest answer counts. */
  async #check(): Promise<void> {
    this.#asked = this.placements;
    if (this.#isAsking) return;
    this.#isAsking = true;
    try {
      while (this.#asked !== null) {
        const asked = this.#asked;
        this.#asked = null;
        const problems = await this.#slicer.problems(this.#options, asked);
        if (this.placements !== asked && this.#asked === null) break;
        this.problems = problems;
        this.#host.changed();
      }
    } catch {
      // The next plan reports any failure.
    } finally {
      this.#isAsking = false;
    }
  }

  #entryOf(model: Model, { copies = 1, ...own }: Added["own"] = {}): Entry {
    return { key: ++this.#keys, model, copies: countOf(copies) || 1, pose: poseOf(own), own, weights: null };
  }

  /** Takes other models in place of all, which undo brings back. */
  #replace(entries: readonly Entry[], selected: number): void {
    if (this.entries.length > 0) this.#host.changing(`replace ${this.#job}`);
    this.#job = ++this.#jobs;
    this.entries = entries;
    this.selected = selected;
  }

  /** Replaces the models; removed ones are also removed from the slicer. */
  #take(entries: readonly Entry[]): void {
    const kept = new Set(entries.map(({ key }) => key));
    for (const entry of this.entries) if (!kept.has(entry.key)) this.#sync.leave(entry);
    this.entries = entries;
  }

  #change(place: number, changed: Partial<Entry>): void {
    this.entries = this.entries.map((entry, other) => (other === place ? { ...entry, ...changed } : entry));
  }

  /** Updates the options of each model for the current settings. */
  #settle(): void {
    const entries = this.entries.map((entry) => {
      const own = this.#host.own(entry.pose);
      return own === null || isEqual(own, entry.own) ? entry : { ...entry, own };
    });
    // The array is replaced only if a model has changed.
    if (entries.some((entry, place) => entry !== this.entries[place])) this.entries = entries;
  }

  #tellSelected(): void {
    const entry = this.entries[this.selected];
    if (entry !== undefined) this.#host.selected(entry);
  }

  /** Forgets the placements. */
  #forget(): void {
    this.placed = this.placements = [];
    this.problems = [];
    this.number = 0;
  }
}

/** The pose of options as settings, without points by hand. */
export function poseOf({ rotation, height_mm }: Pick<Own, "rotation" | "height_mm">): Pose {
  const unit = quaternion(String(rotation));
  const { points, fill, drains, drain } = DEFAULT_SETTINGS;
  return { rotation: unit === null ? "" : rotationText(unit), height: height_mm === undefined ? "" : String(height_mm), points, fill, drains, drain };
}

/** Options except for pose, void and supports, which belong to a model. */
function withoutOwn({ rotation: _rotation, height_mm: _height, hollow: _hollow, supports: _supports, ...shared }: Options): Options {
  return shared;
}

/** Options shared by several models. Without a printer, the plate has a usual size. */
function sharedOf(options: Options): Options {
  const shared = withoutOwn(options);
  if (shared.printer !== undefined) return shared;
  const { rays: _rays, ...rest } = shared;
  const [x_mm, y_mm] = USUAL_VOLUME.volume_mm;
  return { ...rest, pixels: [x_mm / USUAL_PIXEL_MM, y_mm / USUAL_PIXEL_MM], pitch_mm: USUAL_PIXEL_MM };
}

/** Number of copies clamped to its bounds; NaN if invalid. */
const countOf = (copies: number): number => Math.min(Math.max(1, Math.round(copies)), MOST_COPIES);
