import { expect, test } from "vitest";
import { fakeReport, fakeWorkers } from "./fake-worker.js";
import { createSlicer, SCHEMA, type Slicer } from "./index.js";
import type { Options } from "./wire.js";

/** A slicer over fake workers of this much memory each, and a log of their calls. */
function faked(memory_bytes = 0): { slicer: Slicer; log: string[] } {
  const log: string[] = [];
  const spawn = fakeWorkers(log, (_, work) => ({
    memory: () => memory_bytes,
    calibrateLayers: async (options, progress) => {
      await work("towers");
      progress("masks", 0.5, 0.75);
      if (options.format === "sl1") throw { code: "uniform-only", message: "no", detail: null };
      if (options.format === "ctb") await new Promise(() => undefined);
      return { blob: new Blob(["towers"]), report: fakeReport({ options }) };
    },
  }));
  return { slicer: createSlicer({ spawn }), log };
}

test("results carry the schema version", async () => {
  const { slicer } = faked();
  const file = new Blob(["a"]);
  const model = await slicer.load(file, { name: "a.stl" });
  expect(model).toMatchObject({ schema: SCHEMA, name: "a.stl", info: { facets: 1 } });
  expect(model.file).toBe(file);
  expect((await slicer.plan()).schema).toBe(SCHEMA);
  expect(await slicer.check()).toMatchObject({ schema: SCHEMA, verdict: "review" });
  expect((await slicer.tradeoff()).schema).toBe(SCHEMA);
  expect((await slicer.preview()).schema).toBe(SCHEMA);
  expect(await slicer.mask(1)).toMatchObject({ layer: 1, width: 9, height: 2 });
});

test("export() uses the last plan, or makes one for the given options", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  await slicer.export({ tolerance: 1 });
  await slicer.export({ tolerance: 1 });
  await slicer.export();
  await slicer.export({ tolerance: 2 });
  expect(log).toEqual(["1: add a", "1: plan 1 of a", "1: archive 0", "1: archive 0", "1: archive 0", "1: plan 2 of a", "1: archive 0"]);
});

test("a stream delivers the chunks in order", async () => {
  const { slicer } = faked();
  await slicer.load(new Blob(["a"]));
  const chunks: number[][] = [];
  for await (const chunk of slicer.exportStream({}) as unknown as AsyncIterable<Uint8Array>) chunks.push([...chunk]);
  expect(chunks).toEqual([[...new TextEncoder().encode("z")], [...new TextEncoder().encode("ip")]]);
});

test("a stream that fails reports its error, and the slicer works on after a stream is cancelled", async () => {
  const { slicer, log } = faked();
  await expect(slicer.exportStream({}).getReader().read()).rejects.toMatchObject({ code: "no-model" });
  await slicer.load(new Blob(["a"]));
  await slicer.exportStream({}).cancel();
  expect(log.filter((line) => line.endsWith("ended")).length).toBeLessThanOrEqual(1);
  expect(await (await slicer.export({})).blob.text()).toBe("zip");
});

test("positions come from a worker of their own, which reads the model on first use", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  expect(log).toEqual(["1: add a"]);
  await slicer.positions();
  await slicer.load(new Blob(["b"]));
  await slicer.positions();
  expect(log).toEqual(["1: add a", "2: add a", "2: positions of a", "1: add b", "1: remove a", "2: remove a", "2: add b", "2: positions of b"]);
});

test("the worker of previews gives its memory back when another model is loaded", async () => {
  const { slicer, log } = faked(2 ** 30);
  await slicer.load(new Blob([new Uint8Array(2 ** 24)]));
  await slicer.preview();
  log.length = 0;
  await slicer.load(new Blob([new Uint8Array(2 ** 24)]));
  await expect.poll(() => log.filter((line) => line.endsWith("ended"))).toEqual(["2: ended"]);
});

test("a model comes with its positions if they are asked for, from the worker that has read it", async () => {
  const { slicer, log } = faked();
  const { positions, info } = await slicer.load(new Blob(["a"]), { positions: true });
  expect([positions?.length, info.facets]).toEqual([9, 1]);
  expect(await slicer.load(new Blob(["b"]))).not.toHaveProperty("positions");
  expect(log).toEqual(["1: add a", "1: add b", "1: remove a"]);
});

test("weights are copied, apply to all later calls, and make export() plan again", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  const weights = Float32Array.of(0.5);
  const painted = slicer.setWeights(weights);
  weights[0] = 0;
  await painted;
  await slicer.export({ tolerance: 1 });
  await slicer.preview();
  await slicer.setWeights(null);
  await slicer.export({ tolerance: 1 });
  const main = ["1: add a", "1: weigh a 0.5", "1: plan 1 of a*0.5", "1: archive 0", "1: weigh a equally", "1: plan 1 of a", "1: archive 0"];
  expect(log.filter((line) => line.startsWith("1"))).toEqual(main);
  expect(log.filter((line) => line.startsWith("2"))).toEqual(["2: add a", "2: weigh a 0.5", "2: preview a"]);
});

test("weights that the core refuses are dropped, and a newly opened model has none", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  await slicer.setWeights(Float32Array.of(0.5));
  await expect(slicer.setWeights(Float32Array.of(2))).rejects.toMatchObject({ code: "weights-out-of-range" });
  await slicer.plan({ tolerance: 1 });
  await slicer.load(new Blob(["b"]));
  await slicer.plan({ tolerance: 1 });
  expect(log).toEqual(["1: add a", "1: weigh a 0.5", "1: weigh a 2", "1: plan 1 of a*0.5", "1: add b", "1: remove a", "1: plan 1 of b"]);
});

test("a print file uses the weights of its plan, even from a fresh worker", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  await slicer.setWeights(Float32Array.of(0.25));
  await slicer.plan({ tolerance: 1 });
  await slicer.setWeights(null);
  slicer.rest();
  // The print file is that of the last plan, which is replayed with its own weights.
  await slicer.export();
  await slicer.plan({ tolerance: 2 });
  const after = log.slice(log.indexOf("1: ended"));
  expect(after.filter((line) => !line.endsWith("ended"))).toEqual([
    "2: add a",
    "2: weigh a 0.25",
    "2: plan 1 of a*0.25",
    "2: archive 0",
    "2: weigh a equally",
    "2: plan 2 of a",
  ]);
});

test("weights are written to a file and read back", async () => {
  const { slicer } = faked();
  await slicer.load(new Blob(["a"]));
  const file = await slicer.weightsFile(Float32Array.of(0.5, 1));
  expect(await slicer.readWeights(file)).toEqual(Float32Array.of(0.5, 1));
  expect(await slicer.saliency()).toEqual(Float32Array.of(0.5));
});

test.each([1.5, -1, NaN, Infinity, "3", null])("a layer or plate %o is refused before the core takes it for another", async (value) => {
  const { slicer, log } = faked();
  const layer = value as number;
  const refused = (argument: string): unknown => ({ code: "bad-number", detail: { argument, value } });
  await expect(slicer.mask(layer)).rejects.toMatchObject(refused("layer") as object);
  await expect(slicer.mask(0, { plate: layer })).rejects.toMatchObject(refused("plate") as object);
  await expect(slicer.check({}, { plate: layer })).rejects.toMatchObject(refused("plate") as object);
  await expect(slicer.export(undefined, { plate: layer })).rejects.toMatchObject(refused("plate") as object);
  expect(log).toEqual([]);
});

test("a print file has a name, a media type and warnings", async () => {
  const { slicer } = faked();
  await slicer.load(new Blob(["a"]), { name: "cup.STL" });
  const { blob, ...file } = await slicer.export({});
  expect(file).toEqual({
    schema: SCHEMA,
    name: "cup-cusp.uvj",
    type: "application/octet-stream",
    warnings: [{ code: "inside-out" }],
  });
  expect(blob.type).toBe(file.type);
});

test("test towers need no model, are named after the printer, and report progress", async () => {
  const { slicer } = faked();
  const stages: string[] = [];
  const { blob, report, ...file } = await slicer.calibrateLayers(
    { printer: "saturn-3" },
    { onProgress: (stage, fraction, done) => stages.push(`${stage} ${fraction} ${done}`) },
  );
  expect(file).toEqual({
    schema: SCHEMA,
    name: "towers-saturn-3.uvj",
    type: "application/octet-stream",
    warnings: [{ code: "inside-out" }],
  });
  expect([await blob.text(), blob.type]).toEqual(["towers", file.type]);
  expect(report.mask.height).toBe(2);
  expect(stages).toEqual(["masks 0.5 0.75"]);
  const own = { pixels: [1, 1], pitch_um: [50, 50], volume_mm: [1, 1, 1] } satisfies Options["printer"];
  const names = [{ printer: { ...own, name: "big" } }, { printer: own }, {}].map(async (options) => (await slicer.calibrateLayers(options)).name);
  expect(await Promise.all(names)).toEqual(["towers-big.uvj", "towers-cusp.uvj", "towers-cusp.uvj"]);
});

test("test towers leave the model and the last plan alone, also if they fail or are aborted", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  await slicer.plan({ tolerance: 1 });
  await slicer.calibrateLayers();
  await expect(slicer.calibrateLayers({ format: "sl1" })).rejects.toMatchObject({ code: "uniform-only" });
  const abort = new AbortController();
  const writing = slicer.calibrateLayers({ format: "ctb" }, { signal: abort.signal });
  const outcome = expect(writing).rejects.toMatchObject({ name: "AbortError" });
  await new Promise((resolve) => setTimeout(resolve));
  abort.abort();
  await outcome;
  await slicer.export();
  expect(log).toEqual(["1: add a", "1: plan 1 of a", "2: towers", "2: towers", "2: towers", "2: ended", "1: archive 0"]);
});

test("calls keep their order without await: those after a load use its model", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  const address = URL.createObjectURL(new Blob(["b"]));
  void slicer.load(address);
  void slicer.plan({ tolerance: 1 });
  void slicer.positions();
  const file = slicer.export({ tolerance: 2 });
  // Made after the export, whose plan it must not change.
  void slicer.plan({ tolerance: 3 });
  const mask = slicer.mask(0);
  void slicer.load(new Blob(["c"]));
  expect((await mask).width).toBe(3);
  await file;
  await slicer.plan({ tolerance: 4 });
  const main = ["add a", "add b", "remove a", "plan 1 of b", "plan 2 of b", "archive 0", "plan 3 of b", "mask 0 of plate 0, 3", "add c", "remove b", "plan 4 of c"];
  const positions = log.find((line) => line.endsWith(": positions of b"))?.[0] ?? "";
  expect(log.filter((line) => line.startsWith("1")).map((line) => line.slice(3))).toEqual(main);
  expect(log).toContain(`${positions}: add b`);
});

test("weights apply to the calls made after them, and a failed load changes nothing", async () => {
  const { slicer, log } = faked();
  await slicer.load(new Blob(["a"]));
  void slicer.plan({ tolerance: 1 });
  void slicer.setWeights(Float32Array.of(0.5));
  void slicer.plan({ tolerance: 2 });
  const failed = slicer.load("nonsense:x");
  const planned = slicer.plan({ tolerance: 3 });
  await expect(failed).rejects.toMatchObject({ code: "fetch-failed" });
  await planned;
  expect(log).toEqual(["1: add a", "1: plan 1 of a", "1: weigh a 0.5", "1: plan 2 of a*0.5", "1: plan 3 of a*0.5"]);
});
