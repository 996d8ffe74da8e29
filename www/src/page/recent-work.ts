/**
 * Recent work, kept in the browser's own file system (OPFS) for another visit unless the user turns this off: models with copies, poses,
 * points by hand, weights and settings.
 *
 * An index holds all of it but the files of the models and their weights, which are named by their digests, so that works share them. It is
 * written last when work is kept and first when it is deleted, and browsers replace a file atomically, so it never lists half a work, even
 * if the tab is closed meanwhile. Tabs take turns.
 */
import type { Snapshot, SnapshotModel } from "../element/state/snapshot.js";
import { isEqual } from "../element/state/plain.js";
import { canKeep } from "./keeping.js";

/** Maximum number of works kept, and their total size in bytes. */
export const MOST_WORKS = 8;
export const MOST_BYTES = 200_000_000;

/** Side of a picture in pixels, sharp on dense screens. */
export const PICTURE_PX = 120;

export interface RecentWork {
  readonly id: string;
  /** Sum of its models' files and weights. */
  readonly bytes: number;
  /** Time of the last change, in ms since 1970. */
  readonly changed_ms: number;
  readonly work: KeptWork;
}

/** A snapshot whose files stand beside the index. */
export interface KeptWork extends Omit<Snapshot, "models"> {
  readonly models: readonly KeptModel[];
}

interface KeptModel extends Omit<SnapshotModel, "file" | "weights"> {
  /** Digest of the file, which is its name. */
  readonly file: string;
  readonly weights: string | null;
}

/** The index with a work changed now. The same work of an earlier visit goes, and the oldest if there are too many or they are too large. */
export function indexWith(index: readonly RecentWork[], own: RecentWork): RecentWork[] {
  const others = index.filter(({ id, work }) => id !== own.id && !isEqual(work, own.work)).slice(0, MOST_WORKS - 1);
  const kept = [own];
  let bytes = own.bytes;
  for (const other of others) {
    bytes += other.bytes;
    if (bytes > MOST_BYTES) break;
    kept.push(other);
  }
  return kept;
}

/** Parses the index; malformed entries are dropped. */
export function indexIn(text: string): RecentWork[] {
  try {
    const list: unknown = JSON.parse(text);
    return Array.isArray(list) ? list.filter(isRecent) : [];
  } catch {
    return [];
  }
}

const isName = (it: unknown): it is string => typeof it === "string" && /^[\w-]+$/.test(it);

function isRecent(it: unknown): it is RecentWork {
  const { id, bytes, changed_ms, work } = (it ?? {}) as Record<string, unknown>;
  return isName(id) && Number.isFinite(bytes) && Number.isFinite(changed_ms) && isWork(work);
}

function isWork(it: unknown): it is KeptWork {
  const { query, models, selected, arranging, placed } = (it ?? {}) as Record<string, unknown>;
  const isArranging = typeof arranging === "object" && arranging !== null;
  const areModels = Array.isArray(models) && models.length > 0 && models.every(isModel);
  return typeof query === "string" && Number.isInteger(selected) && isArranging && Array.isArray(placed) && areModels;
}

function isModel(it: unknown): it is KeptModel {
  const { name, file, reading, copies, pose, weights } = (it ?? {}) as Record<string, unknown>;
  const isReading = typeof reading === "object" && reading !== null;
  return typeof name === "string" && isName(file) && isReading && Number.isInteger(copies) && typeof pose === "string" && (weights === null || isName(weights));
}

const FOLDER = "recent work";
const INDEX = "index.json";

/** Also the name of the lock by which tabs take turns. */
const CHANNEL = "cusp recent work";

/** Browser features used by the store. */
export interface Place {
  /** The origin's own file system. */
  root(): Promise<FileSystemDirectoryHandle>;
  /** Runs `work` exclusively among all tabs. */
  alone<T>(work: () => Promise<T>): Promise<T>;
  /** Called when the list has changed. */
  changed(): void;
}

export class RecentWorks {
  readonly #place: Place;

  constructor(place: Place) {
    this.#place = place;
  }

  /** Newest first. */
  async list(): Promise<RecentWork[]> {
    const folder = await this.#folder();
    return indexIn((await textOf(folder)) ?? "");
  }

  /** Keeps a work in place of its earlier state, and moves it to the front. Removes the oldest to make room; null if it still does not fit. */
  async keep(id: string, { models, ...rest }: Snapshot): Promise<RecentWork | null> {
    if (models.reduce((sum, { file }) => sum + file.size, 0) > MOST_BYTES) return null;
    const files = new Map<string, Blob>();
    const named = async (file: Blob): Promise<string> => {
      const name = await digestOf(file);
      files.set(name, file);
      return name;
    };
    const kept: KeptModel[] = [];
    for (const { file, weights, ...model } of models) {
      kept.push({ ...model, file: await named(file), weights: weights === null ? null : await named(new Blob([weights.slice()])) });
    }
    const bytes = [...files.values()].reduce((sum, { size }) => sum + size, 0);
    // As it reads from the index.
    const work = JSON.parse(JSON.stringify({ ...rest, models: kept })) as KeptWork;
    const own = { id, bytes, changed_ms: Date.now(), work };
    return this.#change(async (folder, index) => {
      for (let next = indexWith(index, own); ; next = next.slice(0, -1)) {
        const stay = index.filter((it) => next.some(({ id }) => id === it.id));
        if (stay.length < index.length) {
          await write(folder, INDEX, JSON.stringify(stay));
          await sweep(folder, stay);
        }
        const there = new Set(stay.flatMap(filesOf));
        try {
          for (const [name, file] of files) if (!there.has(name)) await write(folder, name, file);
          await write(folder, INDEX, JSON.stringify(next));
          await sweep(folder, next);
          return own;
        } catch (error) {
          if (next.length === 1 || !isFull(error)) return null;
        }
      }
    });
  }

  /** The snapshot of a work; null if another tab has deleted it. */
  async open({ work: { models, ...rest } }: RecentWork): Promise<Snapshot | null> {
    const folder = await this.#folder();
    const opened: SnapshotModel[] = [];
    for (const { file, weights, ...model } of models) {
      const content = await fileOf(folder, file);
      const painted = weights === null ? null : await fileOf(folder, weights);
      if (content === null || (weights !== null && painted === null)) return null;
      // A copy, so that the model stays open when the kept file is removed.
      const copy = new File([await content.arrayBuffer()], model.name);
      opened.push({ ...model, file: copy, weights: painted === null ? null : new Float32Array(await painted.arrayBuffer()) });
    }
    return { ...rest, models: opened };
  }

  /** A small picture of a work; null if there is none. */
  async picture({ id }: RecentWork): Promise<Blob | null> {
    return fileOf(await this.#folder(), pictureName(id));
  }

  async setPicture(work: RecentWork, png: Blob): Promise<void> {
    await this.#change(async (folder, index) => {
      if (index.some(({ id }) => id === work.id)) await write(folder, pictureName(work.id), png);
    });
  }

  async delete(work: RecentWork): Promise<void> {
    await this.#change(async (folder, index) => {
      const next = index.filter(({ id }) => id !== work.id);
      await write(folder, INDEX, JSON.stringify(next));
      await sweep(folder, next);
    });
  }

  async deleteAll(): Promise<void> {
    await this.#place.alone(async () => {
      const root = await this.#place.root();
      await root.removeEntry(FOLDER, { recursive: true }).catch(() => undefined);
    });
    this.#place.changed();
  }

  async #folder(): Promise<FileSystemDirectoryHandle> {
    return (await this.#place.root()).getDirectoryHandle(FOLDER, { create: true });
  }

  async #change<T>(work: (folder: FileSystemDirectoryHandle, index: RecentWork[]) => Promise<T>): Promise<T> {
    const done = await this.#place.alone(async () => {
      const folder = await this.#folder();
      return work(folder, indexIn((await textOf(folder)) ?? ""));
    });
    this.#place.changed();
    return done;
  }
}

const pictureName = (id: string): string => `${id}.png`;

const filesOf = ({ work: { models } }: RecentWork): string[] => models.flatMap(({ file, weights }) => (weights === null ? [file] : [file, weights]));

/** Deletes files that belong to no work of the index, such as those left by a closed tab. */
async function sweep(folder: FileSystemDirectoryHandle, index: readonly RecentWork[]): Promise<void> {
  const own = new Set([INDEX, ...index.flatMap((it) => [pictureName(it.id), ...filesOf(it)])]);
  const names: string[] = [];
  for await (const name of folder.keys()) names.push(name);
  for (const name of names) {
    // A file being read stays until the next time.
    if (!own.has(name)) await folder.removeEntry(name).catch(() => undefined);
  }
}

async function write(folder: FileSystemDirectoryHandle, name: string, content: Blob | string): Promise<void> {
  const handle = await folder.getFileHandle(name, { create: true });
  const stream = await handle.createWritable();
  try {
    await stream.write(content);
    await stream.close();
  } catch (error) {
    await stream.abort().catch(() => undefined);
    throw error;
  }
}

async function fileOf(folder: FileSystemDirectoryHandle, name: string): Promise<File | null> {
  try {
    return await (await folder.getFileHandle(name)).getFile();
  } catch {
    return null;
  }
}

const textOf = async (folder: FileSystemDirectoryHandle): Promise<string | null> => (await fileOf(folder, INDEX))?.text() ?? null;

/** Digests of files that were kept before. */
const digests = new WeakMap<Blob, Promise<string>>();

function digestOf(file: Blob): Promise<string> {
  const digest = digests.get(file) ?? sha(file);
  digests.set(file, digest);
  return digest;
}

async function sha(file: Blob): Promise<string> {
  const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", await file.arrayBuffer()));
  return Array.from(hash.subarray(0, 16), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

const isFull = (error: unknown): boolean => error instanceof Error && error.name === "QuotaExceededError";

/** The recent work of this browser; null if it cannot keep any: see {@link canKeep}. */
export function recentWorks(): Promise<RecentWorks | null> {
  return (found ??= find());
}

let found: Promise<RecentWorks | null> | undefined;

async function find(): Promise<RecentWorks | null> {
  if (!canKeep()) return null;
  const root = (): Promise<FileSystemDirectoryHandle> => navigator.storage.getDirectory();
  try {
    // Earlier versions kept models here.
    await (await root()).removeEntry("recent models", { recursive: true }).catch(() => undefined);
  } catch {
    return null;
  }
  const channel = new BroadcastChannel(CHANNEL);
  return new RecentWorks({
    root,
    alone: (work) => navigator.locks.request(CHANNEL, work),
    // oxlint-disable-next-line unicorn/require-post-message-target-origin -- a channel reaches this origin alone
    changed: () => channel.postMessage(null),
  });
}

/** Calls back whenever the list changes, here or in another tab. Returns a function that stops it. */
export function watchRecent(changed: () => void): () => void {
  const channel = new BroadcastChannel(CHANNEL);
  channel.onmessage = changed;
  return () => channel.close();
}
