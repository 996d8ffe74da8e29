/** Models of every format, in a real browser. What reads other formats than STL is fetched with the first of them. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { drop, layers, requests, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { objOf, sphere, threeMfOf } from "./solids.js";

const { bytes } = sphere(10, 48);
const [stl, obj, threeMf] = [bytes, objOf(bytes), threeMfOf(bytes)];

const start = pages();

/** The requests for the module of readers, from now on: one for each worker that opens a model. */
const fetches = (page: Page, isOffline?: () => boolean): Promise<string[]> => requests(page, /cusp_models_bg[^/]*\.wasm$/, isOffline);

test("an STL, an OBJ and a 3MF of one model have one plan, and the readers are fetched for the last two", async () => {
  const page = await start("?rays=256");
  const fetched = await fetches(page);
  const plans: number[] = [];
  for (const [name, file] of [["ball.stl", stl], ["ball.obj", obj], ["ball.3mf", threeMf]] as const) {
    await drop(page, { name, bytes: file });
    await expect.poll(() => words(page)).toContain(name);
    await state(page, "done", 60_000);
    plans.push(await layers(page));
    expect(fetched.length > 0, name).toBe(file !== stl);
  }
  expect(new Set(plans).size).toBe(1);
});

test("without the readers' module a 3MF says so, and opens once it can be fetched", async () => {
  const page = await start("?rays=256");
  let isOffline = true;
  await fetches(page, () => isOffline);
  await drop(page, { name: "ball.3mf", bytes: threeMf });
  await state(page, "error", 60_000);
  await expect.poll(() => words(page)).toContain("could not be loaded: models");
  isOffline = false;
  await drop(page, { name: "again.3mf", bytes: threeMf });
  await state(page, "done", 60_000);
});

test("damage in a 3MF is told with its part", async () => {
  const page = await start("?rays=256");
  await drop(page, { name: "cut.3mf", bytes: threeMf.slice(0, threeMf.length / 2) });
  await state(page, "error", 60_000);
  await expect.poll(() => words(page)).toContain("3MF");
});
