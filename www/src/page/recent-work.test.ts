import { beforeEach, expect, test } from "vitest";
import type { Snapshot } from "../element/state/snapshot.js";
import { indexIn, indexWith, MOST_BYTES, MOST_WORKS, RecentWorks, type RecentWork } from "./recent-work.js";

/** File system in memory that is full at `room` bytes, and fails for files for which `broken` returns true. */
class Folder {
  readonly files = new Map<string, Blob>();
  readonly folders = new Map<string, Folder>();
  room = Infinity;
  broken: (name: string) => boolean = () => false;

  getDirectoryHandle(name: string): Promise<Folder> {
    const folder = this.folders.get(name) ?? new Folder();
    this.folders.set(name, folder);
    return Promise.resolve(folder);
  }
  getFileHandle(name: string, { create = false } = {}): Promise<unknown> {
    if (!create && !this.files.has(name)) return Promise.reject(new DOMException("", "NotFoundError"));
    // As in browsers, the file exists from now on, and is replaced when its stream closes.
    if (!this.files.has(name)) this.files.set(name, new Blob());
    let written = new Blob();
    return Promise.resolve({
      getFile: () => Promise.resolve(this.files.get(name)),
      createWritable: () =>
        Promise.resolve({
          write: (content: Blob | string) => {
            written = new Blob([content]);
            const others = [...this.files].reduce((sum, [other, { size }]) => sum + (other === name ? 0 : size), 0);
            const error = this.broken(name) ? "InvalidStateError" : others + written.size > this.room ? "QuotaExceededError" : null;
            return error === null ? Promise.resolve() : Promise.reject(new DOMException("", error));
          },
          close: () => Promise.resolve(void this.files.set(name, written)),
          abort: () => Promise.resolve(),
        }),
    });
  }
  removeEntry(name: string): Promise<void> {
    this.files.delete(name);
    this.folders.delete(name);
    return Promise.resolve();
  }
  async *keys(): AsyncGenerator<string> {
    yield* this.files.keys();
  }
}

let root: Folder;
let folder: Folder;
let changes: number;
let turn: Promise<unknown>;

beforeEach(async () => {
  root = new Folder();
  folder = await root.getDirectoryHandle("recent work");
  changes = 0;
  turn = Promise.resolve();
});

/** The works as seen by one tab. Tabs take turns, as with Web Locks. */
function tab(): RecentWorks {
  return new RecentWorks({
    root: () => Promise.resolve(root as unknown as FileSystemDirectoryHandle),
    alone: (work) => {
      const done = turn.then(work);
      turn = done.catch(() => undefined);
      return done;
    },
    changed: () => void changes++,
  });
}

const arranging: Snapshot["arranging"] = { spacing_mm: 2, turn_deg: 0 };

/** Work on models of these contents, which are also their names. */
function work(contents: readonly string[], query = ""): Snapshot {
  const model = (content: string): Snapshot["models"][number] => ({ name: content.slice(0, 9), file: new Blob([content]), reading: {}, copies: 1, pose: "", weights: null });
  return { query, models: contents.map(model), selected: 0, arranging, placed: [] };
}

const names = async (works = tab()): Promise<string[]> => (await works.list()).map(({ work: { models } }) => models.map(({ name }) => name).join("+"));

const recent = (id: string, bytes = 1): RecentWork => {
  const models = [{ name: id, file: id, reading: {}, copies: 1, pose: "", weights: null }];
  return { id, bytes, changed_ms: 0, work: { query: "", models, selected: 0, arranging, placed: [] } };
};

test("the newest works stay, as many and as much as there is room for", () => {
  const many = Array.from({ length: MOST_WORKS + 3 }, (_, i) => recent(i.toString(16)));
  expect(indexWith(many, recent("ff")).map(({ id }) => id)).toEqual(["ff", "0", "1", "2", "3", "4", "5", "6"]);
  expect(indexWith(many.slice(0, 3), recent("1")).map(({ id }) => id)).toEqual(["1", "0", "2"]);
  const heavy = [recent("a", 1), recent("b", MOST_BYTES / 2), recent("c", 1)];
  expect(indexWith(heavy, recent("d", MOST_BYTES / 2)).map(({ id }) => id)).toEqual(["d", "a"]);
  // The same work of an earlier visit is kept once.
  expect(indexWith([{ ...recent("a"), id: "b" }, recent("c")], recent("a")).map(({ id }) => id)).toEqual(["a", "c"]);
});

test("an index is checked", () => {
  const good = recent("a");
  const noModels = { ...good, work: { ...good.work, models: [] } };
  const outside = { ...good, work: { ...good.work, models: [{ ...good.work.models[0], file: "../x" }] } };
  expect(indexIn(JSON.stringify([good, null, { ...good, bytes: "1" }, { ...good, id: "../x" }, noModels, outside]))).toEqual([good]);
  for (const text of ["", "{", "null", "{}"]) expect(indexIn(text)).toEqual([]);
});

test("work is kept with all that belongs to it, in place of its earlier state, and opened again", async () => {
  const works = tab();
  await works.keep("1", work(["cup"]));
  await works.keep("2", work(["ball"]));
  const [cup, ball] = work(["cup", "ball"]).models;
  if (cup === undefined || ball === undefined) throw new Error("no models");
  const weights = Float32Array.of(0.25, 1);
  const snapshot: Snapshot = { ...work([], "tolerance=0.05"), models: [{ ...cup, copies: 3, pose: "rotation=0%2C0%2C1%2C0" }, { ...ball, weights }], selected: 1, placed: [{ model: 0, x_mm: 4, y_mm: 5 }] };
  await works.keep("1", snapshot);
  expect(await names()).toEqual(["cup+ball", "ball"]);
  expect(changes).toBe(3);
  const [newest] = await works.list();
  const opened = newest === undefined ? null : await works.open(newest);
  expect({ ...opened, models: opened?.models.map(({ file: _file, ...rest }) => rest) }).toEqual({ ...snapshot, models: snapshot.models.map(({ file: _file, ...rest }) => rest) });
  expect(await Promise.all((opened?.models ?? []).map(({ file }) => file.text()))).toEqual(["cup", "ball"]);
  // The ball is stored once, for both works.
  expect(folder.files.size).toBe(4);
});

test("work has a picture until it is deleted, and deleting all leaves nothing", async () => {
  const works = tab();
  const ball = await works.keep("1", work(["ball"]));
  const cup = await works.keep("2", work(["cup"]));
  if (ball === null || cup === null) throw new Error("not kept");
  expect(await works.picture(ball)).toBeNull();
  await works.setPicture(ball, new Blob(["png"]));
  expect(await (await works.picture(ball))?.text()).toBe("png");
  await works.delete(ball);
  expect(await names()).toEqual(["cup"]);
  expect(folder.files.size).toBe(2);
  await works.setPicture(ball, new Blob(["png"]));
  expect(folder.files.size).toBe(2);
  expect(await works.open(ball)).toBeNull();
  await works.deleteAll();
  expect(root.folders.size).toBe(0);
  expect(await names()).toEqual([]);
});

test("where the browser has no room, the oldest works go, and one that does not fit at all is not kept", async () => {
  const works = tab();
  folder.room = 2000;
  for (const name of ["a", "b", "c"]) await works.keep(name, work([name.repeat(600)]));
  expect((await names()).map(([letter]) => letter)).toEqual(["c", "b"]);
  expect(await works.keep("d", work(["d".repeat(3000)]))).toBeNull();
  const big = work(["big"]);
  expect(await works.keep("big", { ...big, models: big.models.map((it) => ({ ...it, file: { size: MOST_BYTES + 1 } as Blob })) })).toBeNull();
  expect(await works.keep("e", work(["e"]))).not.toBeNull();
  expect(await names()).toEqual(["e"]);
});

test("a tab that is closed while it keeps work leaves none on offer, and the next work clears up behind it", async () => {
  const works = tab();
  await works.keep("a", work(["a"]));
  folder.broken = (name) => name !== "index.json";
  expect(await works.keep("b", work(["b"]))).toBeNull();
  expect(await names()).toEqual(["a"]);
  expect(folder.files.size).toBe(3);
  folder.broken = () => false;
  await works.keep("c", work(["c"]));
  expect(await names()).toEqual(["c", "a"]);
  expect(folder.files.size).toBe(3);
});

test("tabs take turns: none loses the other's work", async () => {
  const [one, two] = [tab(), tab()];
  await Promise.all(["a", "b", "c", "d"].map((name, i) => (i % 2 === 0 ? one : two).keep(name, work([name]))));
  expect((await names()).sort()).toEqual(["a", "b", "c", "d"]);
});
