/** The models that the slicer's plate has been brought, kept in step with those of a session. */
import type { Watch } from "../../api/index.js";
import type { SlicerCalls } from "./host.js";
import type { Entry } from "./plate.js";

/** What the slicer's plate has of an entry. */
interface There {
  readonly id: number;
  own: string;
  weights: Float32Array | null;
}

export class Brought {
  readonly #slicer: Pick<SlicerCalls, "plate">;
  /** By the keys of entries, in the order of the slicer's plate. */
  readonly #there = new Map<number, There>();
  readonly #positions = new Map<number, Promise<Float32Array>>();

  constructor(slicer: Pick<SlicerCalls, "plate">) {
    this.#slicer = slicer;
  }

  /** Notes that the slicer's plate has a model, after all others. */
  note({ key }: Entry, id: number): void {
    this.#there.set(key, { id, own: "{}", weights: null });
  }

  /** Tells the slicer's plate what has changed since the last call. Its models are in the order of the entries. */
  async bring(entries: readonly Entry[], watch: Watch): Promise<void> {
    const { plate } = this.#slicer;
    this.#leaveMisplaced(entries);
    for (const entry of entries) {
      const { key, model, copies, own, weights } = entry;
      if (!this.#there.has(key)) {
        const { id } = await plate.add(model.file, {}, { ...watch, name: model.name, reading: model.reading });
        this.note(entry, id);
      }
      const there = this.#there.get(key) as There;
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

  /** Takes a model off the slicer's plate. */
  leave({ key }: Entry): void {
    this.#leave(key);
  }

  /** The corners of all facets of a model, fetched once; none before it is there. */
  positionsOf({ key }: Entry): Promise<Float32Array> {
    let positions = this.#positions.get(key);
    if (positions === undefined) {
      const there = this.#there.get(key);
      positions = there === undefined ? Promise.resolve(new Float32Array(0)) : this.#slicer.plate.positions(there.id);
      positions.catch(() => this.#positions.delete(key));
      if (there !== undefined) this.#positions.set(key, positions);
    }
    return positions;
  }

  /** Takes models off that have others before them now, as after undo: they are read again, in their order. */
  #leaveMisplaced(entries: readonly Entry[]): void {
    const there = [...this.#there.keys()];
    const place = there.findIndex((key, i) => key !== entries[i]?.key);
    if (place >= 0) for (const key of there.slice(place)) this.#leave(key);
  }

  #leave(key: number): void {
    const there = this.#there.get(key);
    this.#there.delete(key);
    this.#positions.delete(key);
    if (there !== undefined) this.#slicer.plate.remove(there.id).catch(() => undefined);
  }
}
