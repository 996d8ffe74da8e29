import { expect, test } from "vitest";
import { SlicerError } from "../../api/error.js";
import type { PlateModel, PlatesPlan } from "../../api/index.js";
import { model, planOf } from "./fake-slicer.js";
import { planned, session, settle, slicer } from "./session-fixture.js";

/** A plate that reads every file and plans at once. */
function plates(): void {
  let ids = 0;
  Object.assign(slicer.plate, {
    add: async (file: File): Promise<PlateModel> => ({ ...model, id: ++ids, name: file.name ?? "a.stl", file, own: {} }),
    update: async () => undefined,
    remove: async () => undefined,
    setWeights: async () => undefined,
    plan: async (): Promise<PlatesPlan> => ({ schema: 2, plates: [planOf(33)], print_time_s: 1, resin_ml: 1 }),
  });
}

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
  Object.assign(slicer.plate, { add: () => Promise.reject(new SlicerError("file-unreadable", "no")) });
  await session.add([ring]);
  await settle();
  expect(session.failure?.error.code).toBe("file-unreadable");
  expect(session.result?.report.layers).toBe(10);
  expect(session.plate.entries).toHaveLength(1);
});

test("each model keeps its pose, and undo does not reach into the pose of another", async () => {
  await planned(10);
  plates();
  session.change({ height: "5" });
  await settle();
  slicer.last.resolve(planOf(5));
  await settle();
  await session.add([ring]);
  await settle();
  session.plate.select(1);
  slicer.last.resolve(model);
  await settle();
  expect(session.model?.name).toBe("ring.stl");
  expect(session.settings.height).toBe("");
  expect(session.canUndo).toBe(false);
  session.plate.select(0);
  slicer.last.resolve(model);
  await settle();
  expect(session.settings.height).toBe("5");
  expect(session.plate.entries.map(({ own }) => own.height_mm)).toEqual([5, undefined]);
});
