/** Syncs the models of the slicer with those of a session. */
import type { Loaded, LoadCall, Slicer, Watch } from "../../api/index.js";
import type { Source } from "../../api/source.js";
import type { ModelOptions } from "../../api/wire.js";
import type { Entry } from "./plate.js";

/** State of an entry in the slicer. */
interface There {
  readonly id: number;
  own: string;
  weights: Float32Array | null;
}

/** Clears a model's own options. */
const NOTHING = { copies: undefined, rotation: undefined, height_mm: undefined, hollow: undefined, supports: undefined };

export type SyncCalls = Pick<Slicer, "add" | "load" | "positions" | "remove" | "setWeights" | "update">;

export class Sync {
  readonly #slicer: SyncCalls;
  /** Entries in the slicer by key, in the order of its models. */
  readonly #there = new Map<number, There>();
  readonly #positions = new Map<number, Promise<Float32Array>>();

  constructor(slicer: SyncCalls) {
    this.#slicer = slicer;
  }

  /** Reads a model: with `isAlone`, it replaces all others; otherwise it is appended. */
  async read(source: Source, call: LoadCall, isAlone: boolean): Promise<Loaded> {
    return isAlone ? this.#slicer.load(source, call) : this.#slicer.add(source, {}, call);
  }

  /** Records the entry of a model just read: the only one, or the last. */
  note({ key, model: { id } }: Entry, isAlone: boolean, positions?: Float32Array): void {
    if (isAlone) {
      this.#there.clear();
      this.#positions.clear();
    }
    this.#there.set(key, { id, own: "{}", weights: null });
    if (positions !== undefined) this.#positions.set(key, Promise.resolve(positions));
  }

  /** The slicer's id of an entry's model; undefined until it is read. */
  idOf(key: number | undefined): number | undefined {
    return key === undefined ? undefined : this.#there.get(key)?.id;
  }

  /** Sends changes since the last call to the slicer, whose models then match the entries in order. Null if there are none. */
  bring(entries: readonly Entry[], watch: Watch): Promise<void> | null {
    this.#leaveMisplaced(entries);
    const changed = entries.filter((entry) => this.#hasChanged(entry, entries));
    return changed.length === 0 ? null : this.#bring(changed, entries, watch);
  }

  /** Sets the weights of an entry's model, if it has been read. */
  async paint(key: number, weights: Float32Array | null, watch: Watch): Promise<void> {
    const there = this.#there.get(key);
    if (there === undefined) return;
    const before = there.weights;
    there.weights = weights;
    try {
      await this.#slicer.setWeights(weights, { ...watch, model: there.id });
    } catch (error) {
      // Weights of a later call stay.
      if (there.weights === weights) there.weights = before;
      throw error;
    }
  }

  #hasChanged(entry: Entry, entries: readonly Entry[]): boolean {
    const there = this.#there.get(entry.key);
    return there === undefined || there.weights !== entry.weights || there.own !== JSON.stringify(ownOf(entry, entries));
  }

  async #bring(changed: readonly Entry[], entries: readonly Entry[], watch: Watch): Promise<void> {
    for (const entry of changed) {
      const { key, model, weights } = entry;
      if (!this.#there.has(key)) {
        const { id } = await this.#slicer.add(model.file, {}, { ...watch, name: model.name, reading: model.reading });
        this.#there.set(key, { id, own: "{}", weights: null });
      }
      const there = this.#there.get(key) as There;
      const now = ownOf(entry, entries);
      if (there.own !== JSON.stringify(now)) {
        await this.#slicer.update(there.id, { ...NOTHING, ...now });
        there.own = JSON.stringify(now);
      }
      if (there.weights !== weights) await this.paint(key, weights, watch);
    }
  }

  /** Removes a model from the slicer. */
  leave({ key }: Entry): void {
    const there = this.#there.get(key);
    this.#there.delete(key);
    this.#positions.delete(key);
    if (there !== undefined) this.#slicer.remove(there.id).catch(() => undefined);
  }

  /** Corners of all facets of a model, fetched once; empty until it is read. */
  positionsOf({ key }: Entry): Promise<Float32Array> {
    let positions = this.#positions.get(key);
    if (positions === undefined) {
      const there = this.#there.get(key);
      positions = there === undefined ? Promise.resolve(new Float32Array(0)) : this.#slicer.positions({ model: there.id });
      positions.catch(() => this.#positions.delete(key));
      if (there !== undefined) this.#positions.set(key, positions);
    }
    return positions;
  }

  /** Removes models that are gone, or out of order as after undo; the latter are read again in order. */
  #leaveMisplaced(entries: readonly Entry[]): void {
    const there = [...this.#there.keys()];
    const place = there.findIndex((key, i) => key !== entries[i]?.key);
    if (place < 0) return;
    for (const key of there.slice(place)) {
      const { id } = this.#there.get(key) as There;
      this.#there.delete(key);
      this.#slicer.remove(id).catch(() => undefined);
    }
  }
}

/** A model's own options. Those of a single copy are empty, since the shared options have its pose. */
function ownOf({ copies, own }: Entry, entries: readonly Entry[]): ModelOptions {
  if (entries.length === 1 && copies === 1) return {};
  return { copies, ...own };
}
