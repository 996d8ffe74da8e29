import { beforeEach, expect, test } from "vitest";
import { fakeWorkers } from "./fake-worker.js";
import { createSlicer, type Slicer } from "./index.js";

/** The calls to the fake workers, in order: `worker number: call`. */
let log: string[];
let hang: boolean;
let memory_bytes: number;
let slicer: Slicer;

beforeEach(() => {
  log = [];
  hang = false;
  memory_bytes = 0;
  const spawn = fakeWorkers(log, () => ({ memory: () => memory_bytes }), async () => {
    if (hang) await new Promise(() => undefined);
  });
  slicer = createSlicer({ spawn });
});

const file = (text: string): Blob => new Blob([text]);

test("models are added in order, and a plan has their copies", async () => {
  const cup = await slicer.add(file("cup"), {}, { name: "cup.stl" });
  const ring = await slicer.add(file("ring"), { copies: 20, tolerance: 0.1 });
  expect(cup).toMatchObject({ schema: 3, name: "cup.stl", own: {}, info: { facets: 1 } });
  expect(ring.own).toEqual({ copies: 20, tolerance: 0.1 });
  expect(ring.id).not.toBe(cup.id);
  const plan = await slicer.plan({ tolerance: 1 });
  expect(plan).toMatchObject({ schema: 3, print_time_s: 60, resin_ml: 3 });
  expect(plan.plates.map(({ profile }) => [...profile])).toEqual([[1], [2]]);
  expect(log).toEqual(["1: add cup", "1: add ring", "1: plan 1 of cup ring×20"]);
});

test("a plan has the supports of each model, and without supports none", async () => {
  await slicer.add(file("cup"), { copies: 2 });
  await slicer.add(file("ring"));
  expect(await slicer.plan({ tolerance: 1 })).not.toHaveProperty("supports");
  const { supports } = await slicer.plan({ tolerance: 1, supports: {} });
  expect(supports?.map((positions) => [...positions])).toEqual([[0], [1]]);
});

test("a call that is not awaited takes its place", async () => {
  void slicer.add(file("cup"));
  const planned = slicer.plan({ tolerance: 1 });
  void slicer.add(file("ring"));
  await planned;
  expect((await slicer.models()).map(({ id }) => id)).toEqual([1, 2]);
  expect(log).toEqual(["1: add cup", "1: plan 1 of cup", "1: add ring"]);
});

test("updates keep what they do not name, and `undefined` leaves it to the job", async () => {
  const { id } = await slicer.add(file("cup"), { copies: 3, height_mm: 20 });
  expect((await slicer.update(id, { copies: 5, height_mm: undefined })).own).toEqual({ copies: 5 });
});

test("a removed model leaves the worker before the next call that is about the others", async () => {
  const { id } = await slicer.add(file("cup"));
  await slicer.add(file("ring"));
  await slicer.remove(id);
  log.length = 0;
  await slicer.plan({ tolerance: 1 });
  expect(log).toEqual(["1: remove cup", "1: plan 1 of ring"]);
});

test("a model that is not there is an error, and the others stay", async () => {
  await slicer.add(file("cup"));
  const missing = { code: "plate-no-model", detail: { model_number: 7, models: 1 } };
  await expect(slicer.remove(7)).rejects.toMatchObject(missing);
  await expect(slicer.update(7, {})).rejects.toMatchObject(missing);
  await expect(slicer.positions({ model: 7 })).rejects.toMatchObject(missing);
  await expect(slicer.setWeights(null, { model: 7 })).rejects.toMatchObject(missing);
  expect(await slicer.models()).toHaveLength(1);
});

test("a file that cannot be read leaves the others as they were", async () => {
  await slicer.add(file("cup"));
  await expect(slicer.add(file("bad"))).rejects.toMatchObject({ code: "empty-file" });
  await slicer.plan({ tolerance: 1 });
  expect(log.at(-1)).toBe("1: plan 1 of cup");
});

test("cancelling a plan ends the worker; the next one gets the files, the weights and the last good plan", async () => {
  const { id } = await slicer.add(file("cup"));
  await slicer.add(file("ring"), { copies: 2 });
  await slicer.setWeights(Float32Array.of(0.5), { model: id });
  await slicer.plan({ tolerance: 1 });
  hang = true;
  const abort = new AbortController();
  const cancelled = expect(slicer.plan({ tolerance: 2 }, { signal: abort.signal })).rejects.toMatchObject({ name: "AbortError" });
  await new Promise((resolve) => setTimeout(resolve));
  abort.abort();
  await cancelled;
  hang = false;
  log.length = 0;
  expect(await slicer.mask(3, { plate: 1 })).toMatchObject({ layer: 3, width: 1, height: 2 });
  expect(log).toEqual(["2: add cup", "2: add ring", "2: weigh cup 0.5", "2: plan 1 of cup*0.5 ring×2", "2: mask 3 of plate 1, 1"]);
});

test("a worker that has grown far beyond what is left is replaced, and the others are read again", async () => {
  await slicer.add(file("cup"));
  const { id } = await slicer.add(file("ring"));
  await slicer.add(file("vase"));
  memory_bytes = 2 ** 30;
  await slicer.plan({ tolerance: 1 });
  await slicer.remove(id);
  log.length = 0;
  await slicer.plan({ tolerance: 1 });
  await slicer.plan({ tolerance: 2 });
  expect(log).toEqual(["1: ended", "2: add cup", "2: add vase", "2: plan 1 of cup vase", "2: plan 2 of cup vase"]);
});

test("a slicer without models gives its memory back", async () => {
  const { id } = await slicer.add(file("cup"));
  memory_bytes = 2 ** 30;
  await slicer.remove(id);
  await expect.poll(() => log).toEqual(["1: add cup", "1: ended"]);
});

test("refused weights do not apply to later calls", async () => {
  const { id } = await slicer.add(file("cup"));
  await slicer.setWeights(Float32Array.of(0.5), { model: id });
  const tooLarge = { code: "weights-out-of-range" };
  await expect(slicer.setWeights(Float32Array.of(2), { model: id })).rejects.toMatchObject(tooLarge);
  await slicer.plan({ tolerance: 1 });
  expect(log.at(-1)).toBe("1: plan 1 of cup*0.5");
  // Calls made before the refusal keep their changes.
  const refused = slicer.setWeights(Float32Array.of(3), { model: id });
  const changed = slicer.update(id, { copies: 2 });
  await expect(refused).rejects.toMatchObject(tooLarge);
  await changed;
  await slicer.plan({ tolerance: 2 });
  expect(log.at(-1)).toBe("1: plan 2 of cup*0.5×2");
});

test("a print file is named by its plate, and made from the last plan", async () => {
  await slicer.add(file("cup"), { copies: 2 }, { name: "cup.stl" });
  await expect(slicer.export()).rejects.toMatchObject({ code: "no-plan" });
  await slicer.plan({ tolerance: 1 });
  expect(await slicer.export(undefined, { plate: 1 })).toMatchObject({ schema: 3, name: "plate-2-cusp.uvj", type: "application/octet-stream" });
});

test("placements, arranged or not, reach the core with the models", async () => {
  await slicer.add(file("cup"));
  await slicer.add(file("ring"));
  const placements = await slicer.arrange({}, { spacing_mm: 1 });
  expect(placements.map(({ model }) => model)).toEqual([0, 1]);
  expect(await slicer.problems({}, placements)).toEqual([]);
});

test("a price is that of all copies on all plates of the last plan", async () => {
  await slicer.add(file("cup"), { copies: 2 });
  await expect(slicer.price({ currency: "EUR" })).rejects.toMatchObject({ code: "no-plan" });
  await slicer.plan({ tolerance: 1 });
  log.length = 0;
  await slicer.price({ currency: "EUR" }, { finish: "sanded" });
  const item = { copies: 2, resin_ml: 1.5, print_time_s: 15 };
  expect(log).toEqual([`1: price of ${JSON.stringify([item, item])}, sanded`]);
});

test("a model that is loaded takes the place of all others, once it is read", async () => {
  await slicer.add(file("cup"), { copies: 2 });
  await slicer.add(file("ring"));
  await expect(slicer.load(file("bad"))).rejects.toMatchObject({ code: "empty-file" });
  expect(await slicer.models()).toHaveLength(2);
  const { id, own } = await slicer.load(file("vase"));
  expect([(await slicer.models()).map((model) => model.id), own]).toEqual([[id], {}]);
  await slicer.plan({ tolerance: 1 });
  expect(log.slice(2)).toEqual(["1: add bad", "1: add vase", "1: remove cup", "1: remove ring", "1: plan 1 of vase"]);
});

test("calls about a model are about the first, or the one that is named", async () => {
  await slicer.add(file("cup"));
  const { id } = await slicer.add(file("ring"));
  await slicer.preview();
  await slicer.preview({}, { model: id });
  expect(log.slice(2)).toEqual(["2: add cup", "2: preview cup", "2: remove cup", "2: add ring", "2: preview ring"]);
  await slicer.plan({ tolerance: 1 });
  log.length = 0;
  await slicer.plugs({ model: id });
  expect(log).toEqual(["1: plugs of ring, 1"]);
});

test("a stream of all print files makes each when it is read", async () => {
  await slicer.add(file("cup"), { copies: 3 });
  await slicer.plan({ tolerance: 1 });
  log.length = 0;
  const files = slicer.exportAll().getReader();
  expect((await files.read()).value?.name).toBe("plate-1-cusp.uvj");
  expect(log).toEqual(["1: archive 0"]);
  expect((await files.read()).value?.name).toBe("plate-2-cusp.uvj");
  expect((await files.read()).done).toBe(true);
});

test("a stream of all print files ends where there is another plan, and when it is cancelled", async () => {
  await slicer.add(file("cup"), { copies: 3 });
  await slicer.plan({ tolerance: 1 });
  const files = slicer.exportAll().getReader();
  await files.read();
  await slicer.plan({ tolerance: 2 });
  await expect(files.read()).rejects.toMatchObject({ code: "no-plan" });
  const others = slicer.exportAll();
  const abort = new AbortController();
  const given = slicer.exportAll({ signal: abort.signal }).getReader();
  await others.cancel();
  abort.abort();
  await expect(given.read()).rejects.toMatchObject({ name: "AbortError" });
});

test("a curve is that of a plate, for the options that are given, and the last plan stays", async () => {
  await slicer.add(file("cup"), { copies: 3 });
  await slicer.plan({ tolerance: 1 });
  log.length = 0;
  await slicer.tradeoff({ rays: 9 }, 5, { plate: 1 });
  await slicer.mask(0);
  expect(log).toEqual(["1: tradeoff 5 of plate 1, 9 rays", "1: mask 0 of plate 0, 1"]);
});
