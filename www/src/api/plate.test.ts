import { beforeEach, expect, test } from "vitest";
import type { WorkerHandle } from "./calls.js";
import { fakePlate } from "./fake-plate.js";
import { createPlate, type RunningPlate } from "./plate.js";
import type { Price, SlicerWorker } from "./wire.js";

/** The calls to the fake workers, in order: `worker number: call`. */
let log: string[];
let hang: boolean;
let memory_bytes: number;
let plate: RunningPlate;

beforeEach(() => {
  log = [];
  hang = false;
  memory_bytes = 0;
  let workers = 0;
  const spawn = (): WorkerHandle => {
    const number = ++workers;
    const work = async (what: string): Promise<void> => {
      log.push(`${number}: ${what}`);
      if (hang) await new Promise(() => undefined);
    };
    const price: SlicerWorker["price"] = (_, items, finish) => {
      void work(`price of ${JSON.stringify(items)}, ${finish}`);
      return { total: 1 } as Price;
    };
    const remote = { boot: async () => ({}), memory: () => memory_bytes, ...fakePlate(work), price } as unknown as SlicerWorker;
    return { remote, terminate: () => log.push(`${number}: ended`), onBroken: () => undefined };
  };
  plate = createPlate(spawn, { module: null, address: "" });
});

const file = (text: string): Blob => new Blob([text]);

test("models are added in order, and a plan has their copies", async () => {
  const cup = await plate.add(file("cup"), {}, { name: "cup.stl" });
  const ring = await plate.add(file("ring"), { copies: 20, tolerance: 0.1 });
  expect(cup).toMatchObject({ schema: 2, name: "cup.stl", own: {}, info: { facets: 1 } });
  expect(ring.own).toEqual({ copies: 20, tolerance: 0.1 });
  expect(ring.id).not.toBe(cup.id);
  const plan = await plate.plan({ tolerance: 1 });
  expect(plan).toMatchObject({ schema: 2, print_time_s: 60, resin_ml: 3 });
  expect(plan.plates.map(({ profile }) => [...profile])).toEqual([[1], [2]]);
  expect(log).toEqual(["1: add cup", "1: add ring", "1: plan 1 of cup ring, 1 20 copies"]);
});

test("a plan has the supports of each model, and without supports none", async () => {
  await plate.add(file("cup"), { copies: 2 });
  await plate.add(file("ring"));
  expect(await plate.plan({ tolerance: 1 })).not.toHaveProperty("supports");
  const { supports } = await plate.plan({ tolerance: 1, supports: {} });
  expect(supports?.map((positions) => [...positions])).toEqual([[0], [1]]);
});

test("a call that is not awaited takes its place", async () => {
  void plate.add(file("cup"));
  const planned = plate.plan({ tolerance: 1 });
  void plate.add(file("ring"));
  await planned;
  expect((await plate.models()).map(({ id }) => id)).toEqual([1, 2]);
  expect(log).toEqual(["1: add cup", "1: plan 1 of cup, 1 copies", "1: add ring"]);
});

test("updates keep what they do not name, and `undefined` leaves it to the job", async () => {
  const { id } = await plate.add(file("cup"), { copies: 3, height_mm: 20 });
  expect((await plate.update(id, { copies: 5, height_mm: undefined })).own).toEqual({ copies: 5 });
});

test("a removed model leaves the worker before the next call that is about the others", async () => {
  const { id } = await plate.add(file("cup"));
  await plate.add(file("ring"));
  await plate.remove(id);
  log = [];
  await plate.plan({ tolerance: 1 });
  expect(log).toEqual(["1: remove cup", "1: plan 1 of ring, 1 copies"]);
});

test("a model that is not on the plate is an error, and the others stay", async () => {
  await plate.add(file("cup"));
  const missing = { code: "plate-no-model", detail: { model_number: 7, models: 1 } };
  await expect(plate.remove(7)).rejects.toMatchObject(missing);
  await expect(plate.update(7, {})).rejects.toMatchObject(missing);
  await expect(plate.positions(7)).rejects.toMatchObject(missing);
  await expect(plate.setWeights(7, null)).rejects.toMatchObject(missing);
  expect(await plate.models()).toHaveLength(1);
});

test("a file that cannot be read leaves the plate as it was", async () => {
  await plate.add(file("cup"));
  await expect(plate.add(file("bad"))).rejects.toMatchObject({ code: "empty-file" });
  await plate.plan({ tolerance: 1 });
  expect(log.at(-1)).toBe("1: plan 1 of cup, 1 copies");
});

test("cancelling a plan ends the worker; the next one gets the files, the weights and the last good plan", async () => {
  const { id } = await plate.add(file("cup"));
  await plate.add(file("ring"), { copies: 2 });
  await plate.setWeights(id, Float32Array.of(0.5));
  await plate.plan({ tolerance: 1 });
  hang = true;
  const abort = new AbortController();
  const cancelled = expect(plate.plan({ tolerance: 2 }, { signal: abort.signal })).rejects.toMatchObject({ name: "AbortError" });
  await new Promise((resolve) => setTimeout(resolve));
  abort.abort();
  await cancelled;
  hang = false;
  log = [];
  expect(await plate.mask(1, 3)).toMatchObject({ layer: 3, width: 8, height: 2 });
  expect(log).toEqual(["2: add cup", "2: add ring", "2: plan 1 of cup*0.5 ring, 1 2 copies", "2: mask 3 of plate 1"]);
});

test("a worker that has grown far beyond what is left on the plate is replaced, and the others are read again", async () => {
  await plate.add(file("cup"));
  const { id } = await plate.add(file("ring"));
  await plate.add(file("vase"));
  memory_bytes = 2 ** 30;
  await plate.plan({ tolerance: 1 });
  await plate.remove(id);
  log = [];
  await plate.plan({ tolerance: 1 });
  await plate.plan({ tolerance: 2 });
  expect(log).toEqual(["1: ended", "2: add cup", "2: add vase", "2: plan 1 of cup vase, 1 1 copies", "2: plan 2 of cup vase, 1 1 copies"]);
});

test("an empty plate gives its memory back", async () => {
  const { id } = await plate.add(file("cup"));
  memory_bytes = 2 ** 30;
  await plate.remove(id);
  await expect.poll(() => log).toEqual(["1: add cup", "1: ended"]);
});

test("refused weights do not apply to later calls", async () => {
  const { id } = await plate.add(file("cup"));
  await plate.setWeights(id, Float32Array.of(0.5));
  await expect(plate.setWeights(id, Float32Array.of(2))).rejects.toMatchObject({ code: "weights-out-of-range" });
  await plate.plan({ tolerance: 1 });
  expect(log.at(-1)).toBe("1: plan 1 of cup*0.5, 1 copies");
});

test("a print file is named by its plate, and made from the last plan", async () => {
  await plate.add(file("cup"), {}, { name: "cup.stl" });
  await expect(plate.export(0)).rejects.toMatchObject({ code: "no-plan" });
  await plate.plan({ tolerance: 1 });
  expect(await plate.export(1)).toMatchObject({ schema: 2, name: "plate-2-cusp.uvj", type: "application/octet-stream" });
});

test("placements, arranged or not, reach the core with the models", async () => {
  await plate.add(file("cup"));
  await plate.add(file("ring"));
  const placements = await plate.arrange({}, { spacing_mm: 1 });
  expect(placements.map(({ model }) => model)).toEqual([0, 1]);
  expect(await plate.problems({}, placements)).toEqual([]);
});

test("a price is that of all copies on all plates of the last plan", async () => {
  await plate.add(file("cup"), { copies: 2 });
  await expect(plate.price({ currency: "EUR" })).rejects.toMatchObject({ code: "no-plan" });
  await plate.plan({ tolerance: 1 });
  log = [];
  await plate.price({ currency: "EUR" }, { finish: "sanded" });
  const item = { copies: 2, resin_ml: 1.5, print_time_s: 15 };
  expect(log).toEqual([`1: price of ${JSON.stringify([item, item])}, sanded`]);
});
