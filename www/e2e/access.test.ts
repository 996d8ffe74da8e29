/** What an accessibility checker finds in each state of the page, light and dark. */
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { drop, openPanel, settled, SOFTWARE_GL, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages(SOFTWARE_GL);

test.each(["light", "dark"] as const)("nothing is amiss in any state: %s", async (colorScheme) => {
  const page = await start("", { colorScheme, reducedMotion: "reduce" });
  expect(await broken(page)).toEqual([]);

  await drop(page, { name: "notes.txt", bytes: new Uint8Array(1) });
  await state(page, "error");
  expect(await broken(page)).toEqual([]);

  await drop(page, { name: "ball.stl", bytes: sphere(10, 96).bytes });
  await state(page, "done");
  expect(await broken(page)).toEqual([]);

  await openPanel(page, "Turn");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  await page.locator("cusp-orientation .pose").first().waitFor();
  await page.getByRole("application", { name: "Sphere of directions" }).press("ArrowRight");
  await page.getByRole("button", { name: "Use this orientation" }).waitFor();
  expect(await broken(page)).toEqual([]);

  await page.getByRole("radio", { name: "What matters" }).click();
  await page.getByRole("checkbox", { name: "Fill a smooth region" }).check();
  expect(await broken(page)).toEqual([]);

  await openPanel(page, "Slice");
  await page.getByLabel("Tolerance", { exact: true }).fill("0.02");
  await state(page, "error");
  expect(await broken(page)).toEqual([]);

  await page.getByLabel("Tolerance", { exact: true }).fill("x");
  await expect.poll(() => page.getByLabel("Tolerance", { exact: true }).getAttribute("aria-invalid")).toBe("true");
  expect(await broken(page)).toEqual([]);

  await page.getByLabel("Tolerance", { exact: true }).fill("0.065");
  await page.getByText("Uniform", { exact: true }).click();
  await settled(page);
  expect(await broken(page)).toEqual([]);

  await page.getByText("Adaptive", { exact: true }).click();
  await page.getByLabel("Measure errors by").selectOption("volume");
  await page.getByText("More settings").click();
  await page.locator("details.figures summary").click();
  await settled(page);
  expect(await broken(page)).toEqual([]);

  await page.getByLabel("Printer", { exact: true }).selectOption("photon-mono-m5s");
  await settled(page);
  await page.locator(".warning .offers button").waitFor();
  await page.getByLabel("Printer", { exact: true }).selectOption("Own printer…");
  await page.getByLabel("Open its description").waitFor({ state: "attached" });
  expect(await broken(page)).toEqual([]);
});
