import { expect, test, vi } from "vitest";
import { SlicerError } from "../../api/error.js";
import type { Loaded, Plan } from "../../api/index.js";
import { model, planOf } from "./fake-slicer.js";
import { planned, session, settle, slicer, start } from "./session-fixture.js";

/** A slicer that reads every file that is added, and plans several copies at once. */
function plates(): void {
  let ids = 1;
  const { plan } = slicer;
  Object.assign(slicer, {
    add: async (file: File, own = {}, { name, reading = {} }: { name?: string; reading?: object } = {}): Promise<Loaded> => {
      if (reading === UNREADABLE) throw new SlicerError("file-unreadable", "nothing");
      return { ...model, id: ++ids, name: name ?? file.name ?? "a.stl", file, own, reading };
    },
    update: async () => undefined,
    remove: async () => undefined,
    plan: (...given: Parameters<typeof plan>): Promise<Plan> => (session.plate.isSeveral ? Promise.resolve(planOf(33)) : plan(...given)),
  });
}

const UNREADABLE = { plate_number: 3 };

const ring = new File(["ring"], "ring.stl");

test("a model that is added is planned with the open one, which stays selected", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  await settle();
  expect(session.result?.report.layers).toBe(33);
  expect(session.model?.name).toBe("a.stl");
  expect(session.plate.entries.map(({ model }) => model.name)).toEqual(["a.stl", "ring.stl"]);
});

test("a file that cannot be added is explained, and the plan stays", async () => {
  await planned(10);
  Object.assign(slicer, { add: () => Promise.reject(new SlicerError("file-unreadable", "no")) });
  await session.add([ring]);
  await settle();
  expect(session.failure?.error.code).toBe("file-unreadable");
  expect(session.result?.report.layers).toBe(10);
  expect(session.plate.entries).toHaveLength(1);
});

/** Selects a model and waits until it is planned. */
async function select(place: number): Promise<void> {
  session.plate.select(place);
  await settle();
}

test("another plate of a project is read in the place of the selected model, whose copies stay", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  session.plate.setCopies(0, 3);
  await settle();
  const reading = { plate_number: 2 };
  await session.reread(reading);
  await settle();
  expect(names()).toEqual(["a.stl", "ring.stl"]);
  expect(session.plate.entries.map(({ copies }) => copies)).toEqual([3, 1]);
  expect(session.model?.reading).toBe(reading);
  expect(session.result?.report.layers).toBe(33);
  // If the new plate cannot be read, the model stays.
  expect(await session.reread(UNREADABLE)).toBeNull();
  expect(session.plate.entries[0]?.model.reading).toBe(reading);
});

const names = (): string[] => session.plate.entries.map(({ model }) => model.name);

test("each model keeps its pose, and undo goes back to the model whose pose it changes", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  await settle();
  session.change({ height: "5" });
  // Not planned yet.
  await select(1);
  expect(session.model?.name).toBe("ring.stl");
  expect(session.settings.height).toBe("");
  expect(session.plate.entries.map(({ own }) => own.height_mm)).toEqual([5, undefined]);
  session.undo();
  await settle();
  expect(session.model?.name).toBe("a.stl");
  expect(session.settings.height).toBe("");
  expect(session.plate.entries.map(({ own }) => own.height_mm)).toEqual([undefined, undefined]);
  session.redo();
  await settle();
  expect(session.model?.name).toBe("ring.stl");
  expect(session.plate.entries.map(({ own }) => own.height_mm)).toEqual([5, undefined]);
});

test("a model that was added goes with undo, and comes back with redo", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  await settle();
  session.undo();
  expect(names()).toEqual(["a.stl"]);
  expect(slicer.last.what).toBe("plan");
  session.redo();
  await settle();
  expect(names()).toEqual(["a.stl", "ring.stl"]);
});

test("a removed model comes back to its place, with its copies and weights", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  await settle();
  session.plate.setCopies(0, 3);
  const weights = Float32Array.of(0.5);
  session.setWeights(weights, true);
  await settle();
  session.plate.remove(0);
  await settle();
  expect([names(), session.weights]).toEqual([["ring.stl"], null]);
  session.undo();
  await settle();
  expect(names()).toEqual(["a.stl", "ring.stl"]);
  expect(session.plate.entries[0]).toMatchObject({ copies: 3, weights });
  expect(session.weights).toBe(weights);
});

test("copies are undone like typing, and settings keep steps of their own between them", async () => {
  await planned(10);
  plates();
  session.plate.setCopies(0, 2);
  session.plate.setCopies(0, 3);
  await settle();
  session.change({ tolerances: { volume: "20" } });
  await settle();
  session.undo();
  await settle();
  expect([session.settings.tolerances, session.plate.entries[0]?.copies]).toEqual([{}, 3]);
  session.undo();
  expect(session.plate.entries[0]?.copies).toBe(1);
  expect(session.canUndo).toBe(false);
  session.redo();
  expect(session.plate.entries[0]?.copies).toBe(3);
});

test("a drag is one step; undone, the copy is back where it stood, by hand or arranged", async () => {
  await planned(10);
  plates();
  session.plate.setCopies(0, 2);
  await settle();
  session.plate.placements = [0, 9].map((x_mm) => ({ model: 0, plate: 0, x_mm, y_mm: 0, turn_deg: 0 }));
  for (const x_mm of [10, 11, 12]) session.plate.move([{ place: 1, x_mm }], false);
  session.plate.move([{ place: 1, x_mm: 13 }], true);
  await settle();
  session.plate.move([{ place: 1, x_mm: 18 }], false);
  session.plate.move([{ place: 1, x_mm: 20 }], true);
  await settle();
  const stood = (): (number | undefined)[] => session.plate.placed.map(({ x_mm }) => x_mm);
  session.undo();
  expect(stood()).toEqual([0, 13]);
  session.undo();
  expect(stood()).toEqual([]);
  expect(session.plate.entries[0]?.copies).toBe(2);
});

test("a model opened in place of others is a step back to them, with their copies and settings", async () => {
  await planned(10);
  plates();
  await session.add([ring]);
  session.change({ rotation: "0,0,1,0" });
  session.plate.setCopies(1, 2);
  await settle();
  const { job } = session.plate.state;
  await planned(12);
  expect([names(), session.settings.rotation]).toEqual([["a.stl"], ""]);
  session.undo();
  await settle();
  expect([names(), session.settings.rotation]).toEqual([["a.stl", "ring.stl"], "0,0,1,0"]);
  expect(session.plate.entries.map(({ copies }) => copies)).toEqual([1, 2]);
  expect(session.plate.state.job).toBe(job);
  expect(session.result?.report.layers).toBe(33);
  session.redo();
  await settle();
  expect([names(), session.settings.rotation]).toEqual([["a.stl"], ""]);
});

test("models are added with copies and a pose of their own; without an open one, the first is opened", async () => {
  plates();
  const adding = session.addAll([
    { source: new Blob(["cup"]), own: { copies: 2, height_mm: 7 }, name: "cup.stl" },
    { source: ring, own: { rotation: [0, 0, 2, 0] } },
  ]);
  slicer.last.resolve({ ...model, name: "cup.stl" });
  const added = await adding;
  expect(added?.map(({ name }) => name)).toEqual(["cup.stl", "ring.stl"]);
  await settle();
  const { entries } = session.plate;
  expect(entries.map(({ copies, own }) => ({ copies, ...own }))).toEqual([
    { copies: 2, height_mm: 7 },
    { copies: 1, rotation: [0, 0, 1, 0] },
  ]);
  expect(entries[1]?.pose.rotation).toBe("0,0,1,0");
  expect(session.settings.height).toBe("7");
  expect(session.canUndo).toBe(true);
});

test.each([false, true])("another session goes on with the work: models, copies, poses, weights, placements and settings; as a project: %s", async (isProject) => {
  await planned(10);
  plates();
  await session.add([ring]);
  session.plate.setCopies(0, 3);
  session.change({ tolerances: { cusp: "0.03" }, supports: "medium", points: "1,2,3,,0" });
  session.setWeights(Float32Array.of(0.5), true);
  await select(1);
  session.change({ height: "5" });
  session.plate.placements = [0, 9, 20, 30].map((x_mm) => ({ model: 0, plate: 0, x_mm, y_mm: 0, turn_deg: 0 }));
  session.plate.move([{ place: 1, x_mm: 12 }], true);
  await settle();
  const { snapshot, settings } = session;
  if (snapshot === null) throw new Error("no snapshot");
  const before = session.plate.entries;
  expect((await session.saveProject())?.name).toBe("a-project.3mf");

  start();
  const reopening = isProject ? session.openProject(new File([], "a-project.3mf")) : session.reopen(snapshot);
  await vi.advanceTimersByTimeAsync(0);
  slicer.last.resolve(model);
  await reopening;
  await settle();
  expect(session.settings).toEqual(settings);
  expect(session.model?.name).toBe("ring.stl");
  const facts = ({ model: { name }, copies, pose, own, weights }: (typeof before)[number]): object => ({ name, copies, pose, own, weights });
  expect(session.plate.entries.map(facts)).toEqual(before.map(facts));
  expect(session.plate.placed.map(({ x_mm }) => x_mm)).toEqual([0, 12, 20, 30]);
  expect(session.snapshot).toEqual({ ...snapshot, models: snapshot.models.map((it, i) => ({ ...it, file: session.plate.entries[i]?.model.file })) });
  expect(session.canUndo).toBe(false);
});

test("a project of another program gives its models, copies, poses and places, its printer and its tolerance", async () => {
  plates();
  const own = [{ copies: 2, height_mm: 7 }, { rotation: [0, 0, 1, 0] as [number, number, number, number] }];
  const job = { options: { printer: "mars-4-ultra", tolerance: 0.04, metric: "cusp" as const }, models: own, placements: [{ model: 0, x_mm: 1, y_mm: 2 }] };
  slicer.projects.push({ part: { job, models: [{ name: "cup.stl" }, { name: "ring.stl" }] }, files: [{ file: new Blob(["cup"]), weights: null }, { file: new Blob(["ring"]), weights: null }] });
  const opening = session.openProject(new File([], "job.3mf"));
  await vi.advanceTimersByTimeAsync(0);
  slicer.last.resolve({ ...model, name: "cup.stl" });
  expect(await opening).toBe(true);
  await settle();
  expect(session.settings).toMatchObject({ printer: "mars-4-ultra", tolerances: { cusp: "0.04" }, height: "7" });
  expect(session.plate.entries.map(({ copies, own }) => ({ copies, ...own }))).toEqual([{ copies: 2, height_mm: 7 }, { copies: 1, rotation: [0, 0, 1, 0] }]);
  expect(session.plate.placed).toEqual(job.placements);
});
