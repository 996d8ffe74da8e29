import { expect, test } from "vitest";
import type { WorkerHandle } from "./calls.js";
import { fakePlate } from "./fake-plate.js";
import { fetchedPlate } from "./fetched-plate.js";
import { createPlate, type RunningPlate } from "./plate.js";
import type { SlicerWorker } from "./wire.js";

function plateOver(log: string[]): RunningPlate {
  const spawn = (): WorkerHandle => {
    const remote = { boot: async () => ({}), ...fakePlate(async (what) => void log.push(what)) } as unknown as SlicerWorker;
    return { remote, terminate: () => undefined, onBroken: () => undefined };
  };
  return createPlate(spawn, { module: null, address: "" });
}

test("calls that are made before the code is there keep their order", async () => {
  const log: string[] = [];
  const plate = fetchedPlate(async () => plateOver(log));
  void plate.add(new Blob(["cup"]));
  const planned = plate.plan({ tolerance: 1 });
  void plate.add(new Blob(["ring"]));
  await planned;
  expect(await plate.models()).toHaveLength(2);
  expect(log).toEqual(["add cup", "plan 1 of cup, 1 copies", "add ring"]);
});

test("code that does not arrive is an error, and the next call fetches it again", async () => {
  let times = 0;
  const plate = fetchedPlate(async () => {
    if (++times === 1) throw new Error("offline");
    return plateOver([]);
  });
  await expect(plate.models()).rejects.toMatchObject({ code: "part-failed", detail: { part: "plate", system: "offline" } });
  expect(await plate.models()).toEqual([]);
});

test("a plate that is disposed of before its code arrives accepts no call", async () => {
  const plate = fetchedPlate(async () => plateOver([]));
  const added = plate.add(new Blob(["cup"]));
  plate.dispose();
  await expect(added).rejects.toMatchObject({ name: "AbortError" });
});
