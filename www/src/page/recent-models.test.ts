import { beforeEach, expect, test } from "vitest";
import { indexIn, indexWith, MOST_BYTES, MOST_MODELS, RecentModels, type RecentModel } from "./recent-models.js";

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
  folder = await root.getDirectoryHandle("recent models");
  changes = 0;
  turn = Promise.resolve();
});

/** The models as seen by one tab. Tabs take turns, as with Web Locks. */
function tab(): RecentModels {
  return new RecentModels({
    root: () => Promise.resolve(root as unknown as FileSystemDirectoryHandle),
    alone: (work) => {
      const done = turn.then(work);
      turn = done.catch(() => undefined);
      return done;
    },
    changed: () => void changes++,
  });
}

const names = async (models = tab()): Promise<string[]> => (await models.list()).map(({ name }) => name);
const model = (id: string, bytes = 1): RecentModel => ({ id, name: id, bytes, opened_ms: 0 });

test("the newest models stay, as many and as much as there is room for", () => {
  const many = Array.from({ length: MOST_MODELS + 3 }, (_, i) => model(i.toString(16)));
  expect(indexWith(many, model("ff")).map(({ id }) => id)).toEqual(["ff", "0", "1", "2", "3", "4", "5", "6"]);
  expect(indexWith(many.slice(0, 3), model("1")).map(({ id }) => id)).toEqual(["1", "0", "2"]);
  const heavy = [model("a", 1), model("b", MOST_BYTES / 2), model("c", 1)];
  expect(indexWith(heavy, model("d", MOST_BYTES / 2)).map(({ id }) => id)).toEqual(["d", "a"]);
});

test("an index is checked", () => {
  expect(indexIn(JSON.stringify([model("a"), null, { ...model("b"), bytes: "1" }, model("../x")]))).toEqual([model("a")]);
  for (const text of ["", "{", "null", "{}"]) expect(indexIn(text)).toEqual([]);
});

test("a model is kept once, by name and content, and opened again with its name", async () => {
  const models = tab();
  await models.keep("ball.stl", new Blob(["ball"]));
  await models.keep("cup.stl", new Blob(["cup"]));
  await models.keep("ball.stl", new Blob(["ball"]));
  await models.keep("ball.stl", new Blob(["bal2"]));
  expect(await names()).toEqual(["ball.stl", "ball.stl", "cup.stl"]);
  expect(changes).toBe(4);
  const [, , cup] = await models.list();
  const file = cup === undefined ? null : await models.open(cup);
  expect([file?.name, await file?.text()]).toEqual(["cup.stl", "cup"]);
});

test("a model has a picture until it is deleted, and deleting all leaves nothing", async () => {
  const models = tab();
  const ball = await models.keep("ball.stl", new Blob(["ball"]));
  const cup = await models.keep("cup.stl", new Blob(["cup"]));
  if (ball === null || cup === null) throw new Error("not kept");
  expect(await models.picture(ball)).toBeNull();
  await models.setPicture(ball, new Blob(["png"]));
  expect(await (await models.picture(ball))?.text()).toBe("png");
  await models.delete(ball);
  expect(await names()).toEqual(["cup.stl"]);
  expect([...folder.files.keys()].sort()).toEqual([cup.id, "index.json"].sort());
  await models.setPicture(ball, new Blob(["png"]));
  expect(folder.files.size).toBe(2);
  expect(await models.open(ball)).toBeNull();
  await models.deleteAll();
  expect(root.folders.size).toBe(0);
  expect(await names()).toEqual([]);
});

test("where the browser has no room, the oldest models go, and a model that does not fit at all is not kept", async () => {
  const models = tab();
  folder.room = 1000;
  for (const name of ["a", "b", "c"]) await models.keep(name, new Blob([name.repeat(300)]));
  expect(await names()).toEqual(["c", "b"]);
  expect(await models.keep("d", new Blob(["d".repeat(2000)]))).toBeNull();
  expect(await models.keep("big", { size: MOST_BYTES + 1 } as Blob)).toBeNull();
  expect(await models.keep("e", new Blob(["e"]))).not.toBeNull();
  expect(await names()).toEqual(["e"]);
});

test("a tab that is closed while it keeps a model leaves none on offer, and the next model clears up behind it", async () => {
  const models = tab();
  await models.keep("a", new Blob(["a"]));
  folder.broken = (name) => name !== "index.json";
  expect(await models.keep("b", new Blob(["b"]))).toBeNull();
  expect(await names()).toEqual(["a"]);
  expect(folder.files.size).toBe(3);
  folder.broken = () => false;
  await models.keep("c", new Blob(["c"]));
  expect(await names()).toEqual(["c", "a"]);
  expect(folder.files.size).toBe(3);
});

test("tabs take turns: none loses the other's model", async () => {
  const [one, two] = [tab(), tab()];
  await Promise.all(["a", "b", "c", "d"].map((name, i) => (i % 2 === 0 ? one : two).keep(name, new Blob([name]))));
  expect((await names()).sort()).toEqual(["a", "b", "c", "d"]);
});
