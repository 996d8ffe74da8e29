import { beforeAll, expect, test } from "vitest";
import { Job, price } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { jobOf, planOf, startCore } from "./core.node-fixture.js";

beforeAll(startCore);

const silent = (): undefined => undefined;

test.each([
  [{ tolerence: 0.05 }, "unknown field `tolerence`: did you mean `tolerance`?"],
  [{ resin: { layer_mm: 0.05, exposure: 3 } }, "unknown field `exposure`: did you mean `exposure_s`?"],
  [{ supports: { strenght: "light" } }, "unknown field `strenght`: did you mean `strength`?"],
  [{ hollow: { wall: 2 } }, "unknown field `wall`: did you mean `wall_mm`?"],
  [{ metric: "cups", rays: 64 }, "unknown variant `cups`"],
  [{ tolerance: NaN }, "tolerance: a number is not finite"],
  [{ rays: 64.5 }, "invalid type: floating point `64.5`"],
  [{ tolerance: "thin" }, "invalid type: string \"thin\""],
  [{ resin: [2.5] }, "invalid type: sequence, expected struct Resin"],
  [{ rotation: [0, 0, 0, 1, 0] }, "invalid length 5"],
  [{ rotation: [0, 0, NaN, 1] }, "a number is not finite"],
  [{ planner: { kind: "uniform", layer: 0.05 } }, "missing field `layer_mm`"],
  [{ metric: { cusp: 1 } }, "invalid type: map, expected enum Metric"],
  [{ hollow: { wall_mm: () => 2 } }, "wall_mm: a function or a symbol is no value"],
])("options that are misspelt are refused: %j", async (options, said) => {
  const job = jobOf(binaryStl(exampleTriangles()));
  await expect(planOf(job, options as object)).rejects.toMatchObject({ code: "bad-options", message: expect.stringContaining(said) });
  job.free();
});

test("so are prices, limits, models of a plate and choices of reading, and what is undefined counts as absent", async () => {
  const file = binaryStl(exampleTriangles());
  const refused = (said: string): object => expect.objectContaining({ code: "bad-options", message: expect.stringContaining(said) });
  const failure = (call: () => unknown): unknown => {
    try {
      return call();
    } catch (error) {
      return error;
    }
  };
  expect(failure(() => price({ currency: "EUR", setupp: 1 } as never, new Float64Array([1, 1, NaN, 1]), null))).toEqual(refused("did you mean `setup`?"));
  expect(failure(() => new Job().add(file, { plate: 1 } as never))).toEqual(refused("did you mean `plate_number`?"));
  const job = jobOf(file);
  await planOf(job, { rays: 64, backend: "cpu", tolerance: undefined, resin: { exposure_s: 2.5, layer_mm: undefined } } as object);
  expect(failure(() => job.inspect(0, { wall: 1 } as never, silent))).toEqual(refused("did you mean `wall_mm`?"));
  expect(failure(() => job.arrange({ options: { printer: "mars-4-ultra" }, models: [{ copys: 2 }] } as never))).toEqual(refused("did you mean `copies`?"));
});
