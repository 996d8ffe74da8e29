/**
 * Recently opened models, kept in the browser's own file system (OPFS) for another visit, if the user permits it.
 *
 * An index lists the models, newest first. It is written last when a model is added and first when one is removed, and browsers replace a
 * file atomically, so it never lists half a model, even if the tab is closed meanwhile. Tabs take turns.
 */
import { canKeep } from "./keeping.js";

/** Maximum number of models kept, and their total size in bytes. */
export const MOST_MODELS = 8;
export const MOST_BYTES = 200_000_000;

/** Side of a picture in pixels, sharp on dense screens. */
export const PICTURE_PX = 120;

export interface RecentModel {
  /** Digest of name and content; a model opened twice is kept once. */
  readonly id: string;
  readonly name: string;
  readonly bytes: number;
  /** Time of the last opening, in ms since 1970. */
  readonly opened_ms: number;
}

/** The index with a model opened now; the oldest are dropped when there are too many or they are too large. */
export function indexWith(index: readonly RecentModel[], model: RecentModel): RecentModel[] {
  const others = index.filter(({ id }) => id !== model.id).slice(0, MOST_MODELS - 1);
  const kept = [model];
  let bytes = model.bytes;
  for (const other of others) {
    bytes += other.bytes;
    if (bytes > MOST_BYTES) break;
    kept.push(other);
  }
  return kept;
}

/** Parses the index; malformed entries are dropped. */
export function indexIn(text: string): RecentModel[] {
  try {
    const list: unknown = JSON.parse(text);
    return Array.isArray(list) ? list.filter(isModel) : [];
  } catch {
    return [];
  }
}

function isModel(it: unknown): it is RecentModel {
  const { id, name, bytes, opened_ms } = (it ?? {}) as Record<string, unknown>;
  return typeof id === "string" && /^[0-9a-f]+$/.test(id) && typeof name === "string" && Number.isFinite(bytes) && Number.isFinite(opened_ms);
}

const FOLDER = "recent models";
const INDEX = "index.json";

/** Also the name of the lock by which tabs take turns. */
const CHANNEL = "cusp recent models";

/** Browser features used by the models. */
export interface Place {
  /** The origin's own file system. */
  root(): Promise<FileSystemDirectoryHandle>;
  /** Runs `work` exclusively among all tabs. */
  alone<T>(work: () => Promise<T>): Promise<T>;
  /** Called when the list has changed. */
  changed(): void;
}

export class RecentModels {
  readonly #place: Place;

  constructor(place: Place) {
    this.#place = place;
  }

  /** Newest first. */
  async list(): Promise<RecentModel[]> {
    const folder = await this.#folder();
    return indexIn((await textOf(folder)) ?? "");
  }

  /** Keeps a model, or moves it to the front. Removes the oldest models to make room; null if it still does not fit. */
  async keep(name: string, file: Blob): Promise<RecentModel | null> {
    if (file.size > MOST_BYTES) return null;
    const id = await digest(name, file);
    const model = { id, name, bytes: file.size, opened_ms: Date.now() };
    return this.#change(async (folder, index) => {
      const before = new Set(index.map((it) => it.id));
      for (let next = indexWith(index, model); ; next = next.slice(0, -1)) {
        const stay = next.filter((it) => before.has(it.id));
        await write(folder, INDEX, JSON.stringify(stay));
        await sweep(folder, stay);
        try {
          if (!before.has(id)) await write(folder, id, file);
          await write(folder, INDEX, JSON.stringify(next));
          return model;
        } catch (error) {
          if (next.length === 1 || !isFull(error)) return null;
        }
      }
    });
  }

  /** The file of a model; null if another tab has deleted it. */
  async open({ id, name }: RecentModel): Promise<File | null> {
    const file = await fileOf(await this.#folder(), id);
    // A copy, so that the model stays open when the kept file is removed.
    return file === null ? null : new File([await file.arrayBuffer()], name);
  }

  /** A small picture of a model; null if there is none. */
  async picture({ id }: RecentModel): Promise<Blob | null> {
    return fileOf(await this.#folder(), pictureName(id));
  }

  async setPicture(model: RecentModel, png: Blob): Promise<void> {
    await this.#change(async (folder, index) => {
      if (index.some(({ id }) => id === model.id)) await write(folder, pictureName(model.id), png);
    });
  }

  async delete(model: RecentModel): Promise<void> {
    await this.#change(async (folder, index) => {
      const next = index.filter(({ id }) => id !== model.id);
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

  async #change<T>(work: (folder: FileSystemDirectoryHandle, index: RecentModel[]) => Promise<T>): Promise<T> {
    const done = await this.#place.alone(async () => {
      const folder = await this.#folder();
      return work(folder, indexIn((await textOf(folder)) ?? ""));
    });
    this.#place.changed();
    return done;
  }
}

const pictureName = (id: string): string => `${id}.png`;

/** Deletes files that belong to no model of the index, such as those left by a closed tab. */
async function sweep(folder: FileSystemDirectoryHandle, index: readonly RecentModel[]): Promise<void> {
  const own = new Set([INDEX, ...index.flatMap(({ id }) => [id, pictureName(id)])]);
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

async function digest(name: string, file: Blob): Promise<string> {
  const bytes = await new Blob([name, "\0", file]).arrayBuffer();
  const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return Array.from(hash.subarray(0, 16), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

const isFull = (error: unknown): boolean => error instanceof Error && error.name === "QuotaExceededError";

/** The recent models of this browser; null if it cannot keep any: see {@link canKeep}. */
export function recentModels(): Promise<RecentModels | null> {
  return (found ??= find());
}

let found: Promise<RecentModels | null> | undefined;

async function find(): Promise<RecentModels | null> {
  if (!canKeep()) return null;
  const root = (): Promise<FileSystemDirectoryHandle> => navigator.storage.getDirectory();
  try {
    await root();
  } catch {
    return null;
  }
  const channel = new BroadcastChannel(CHANNEL);
  return new RecentModels({
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
