import { readFile } from "node:fs/promises";
import { beforeAll, expect, test } from "vitest";
import { initSync, Plate, price, Slicer } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";

beforeAll(async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
});

const silent = (): undefined => undefined;

test.each([
  [{ tolerence: 0.05 }, "unknown field `tolerence`: did you mean `tolerance`?"],
  [{ resin: { layer_mm: 0.05, exposure: 3 } }, "unknown field `exposure`: did you mean `exposure_s`?"],
  [{ supports: { strenght: "light" } }, "unknown field `strenght`: did you mean `strength`?"],
  [{ hollow: { wall: 2 } }, "unknown field `wall`: did you mean `wall_mm`?"],
  [{ metric: "cups", rays: 64 }, "unknown variant `cups`"],
  [{ tolerance: NaN }, "tolerance: a number is not finite"],
  [{ rays: 64.5 }, "invalid type: floating point `64.5`"],
])("options that are misspelt are refused: %j", async (options, said) => {
  const slicer = new Slicer(binaryStl(exampleTriangles()), {});
  await expect(slicer.plan(options as object, silent)).rejects.toMatchObject({ code: "bad-options", message: expect.stringContaining(said) });
  slicer.free();
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
  expect(failure(() => price({ currency: "EUR", setupp: 1 } as never, new Float64Array([1, 1, 1]), null))).toEqual(refused("did you mean `setup`?"));
  expect(failure(() => new Slicer(file, { plate: 1 } as never))).toEqual(refused("did you mean `plate_number`?"));
  const slicer = new Slicer(file, {});
  await slicer.plan({ rays: 64, backend: "cpu", tolerance: undefined, resin: { exposure_s: 2.5, layer_mm: undefined } } as object, silent);
  expect(failure(() => slicer.inspect({ wall: 1 } as never, silent))).toEqual(refused("did you mean `wall_mm`?"));
  const plate = new Plate();
  plate.add(slicer);
  expect(failure(() => plate.arrange({ options: { printer: "mars-4-ultra" }, models: [{ copys: 2 }] } as never))).toEqual(refused("did you mean `copies`?"));
});
