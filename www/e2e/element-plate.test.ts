/** Several models in the element on a third-party page: dropped, added by script, counted, and left out by a page that knows one. */
import type { BrowserContextOptions, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspSlicer } from "../src/element/index.js";
import { broken } from "./axe.js";
import { packedPages } from "./packed-pages.js";
import { prism, sphere } from "./solids.js";

const pages = packedPages(
  {
    "index.html": `<!doctype html><html lang="en"><title>Shop</title><script type="module" src="main.js"></script>`,
    "main.js": `import "./cusp-slicer/element.js"; document.body.dataset.ready = "";`,
    "ball.stl": sphere(10, 48).bytes,
    "block.stl": prism(12, 8).bytes,
  },
  "en-GB",
);

/** Opens a page with an element that has these attributes, or none. */
const start = (attributes: string, options?: BrowserContextOptions): Promise<Page> =>
  pages.start(`<main><h1>Shop</h1><cusp-slicer ${attributes}></cusp-slicer></main>`, options);

const state = (page: Page, wanted: string): Promise<unknown> => page.waitForSelector(`cusp-slicer[state=${wanted}]`);

/** Drops both files on the element. */
async function dropBoth(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const transfer = new DataTransfer();
    for (const name of ["ball.stl", "block.stl"]) transfer.items.add(new File([await (await fetch(name)).arrayBuffer()], name));
    document.querySelector("cusp-slicer")?.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
}

const listed = (page: Page): Promise<string[]> => page.locator("cusp-plate .name").allInnerTexts();

test("files that are dropped together stand on one plate, in a list in the model's card", async () => {
  const page = await start(`printer="mars-4-ultra"`);
  await dropBoth(page);
  await state(page, "done");
  await page.locator("cusp-plate").waitFor();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await page.locator(".model cusp-plate").count()).toBe(1);
  expect(await page.locator("[part=quality]").innerText()).toContain("A plate is planned for the tolerance");
  expect(await broken(page)).toEqual([]);
  // Copies, and undo by keyboard.
  await page.getByRole("button", { name: "One more: Copies of block.stl" }).click();
  await state(page, "done");
  const copies = page.getByRole("textbox", { name: "Copies of block.stl" });
  await expect.poll(() => copies.inputValue()).toBe("2");
  await page.getByRole("button", { name: "Remove ball.stl" }).click();
  await expect.poll(() => listed(page)).toEqual(["block.stl"]);
  await state(page, "done");
  await page.locator(".open-other").getByText("Open another").focus();
  await page.keyboard.press("Control+z");
  await expect.poll(() => listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await copies.inputValue()).toBe("2");
  await page.keyboard.press("Control+z");
  await expect.poll(() => copies.inputValue()).toBe("1");
  await state(page, "done");
});

test("a page adds models with copies and poses of their own, and has the plans and files of all plates", async () => {
  const page = await start(`printer="mars-4-ultra" src="ball.stl" panels="plan"`);
  await state(page, "done");
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("cusp-slicer");
    if (element === null) throw new Error("there is no element");
    const loaded: string[] = [];
    element.addEventListener("cusp-load", ({ detail }) => loaded.push(detail.name));
    const alone = element.plates;
    // Not awaited: both are added, one after the other.
    const adding = element.add("block.stl", { copies: 20, height_mm: 4 }, "low.stl");
    const bad = element.add("main.js").catch((error: { code: string }) => error.code);
    const again = element.add(new URL("ball.stl", location.href), { copies: 20 });
    const names = [(await adding).name, await bad, (await again).name];
    await element.plan();
    const { plates } = element;
    const files = [await element.export(), await element.export(1)].map(({ name }) => name);
    return {
      names,
      loaded,
      models: element.models.map(({ name, own }) => ({ name, ...own })),
      alone: alone?.plates.length,
      plates: plates?.plates.length,
      isSum: plates?.print_time_s === plates?.plates.reduce((sum, { report }) => sum + report.print_time_s, 0),
      files,
    };
  });
  expect(found).toEqual({
    names: ["low.stl", "unknown-file-kind", "ball.stl"],
    loaded: ["low.stl", "ball.stl"],
    models: [
      { name: "ball.stl", copies: 1 },
      { name: "low.stl", copies: 20, height_mm: 4 },
      { name: "ball.stl", copies: 20 },
    ],
    alone: 1,
    plates: 2,
    isSum: true,
    files: ["plate-1-cusp.goo", "plate-2-cusp.goo"],
  });
  expect(await page.locator("cusp-plate").count()).toBe(0);
});

test("the first model that a page adds is opened, in its own pose", async () => {
  const page = await start(`printer="mars-4-ultra"`);
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("cusp-slicer");
    await element?.add("block.stl", { copies: 2, height_mm: 4 });
    const plan = await element?.plan();
    return [plan?.report.height_mm, plan?.report.plate?.placements.length, element?.models.length];
  });
  expect(found).toEqual([4, 2, 1]);
  await page.locator("cusp-plate").waitFor();
  expect(await page.getByLabel("Scale to height").inputValue()).toBe("4");
});

test("a page without the panel opens the first of several files, and shows no copies", async () => {
  const page = await start(`printer="mars-4-ultra" panels="open model plan"`);
  await dropBoth(page);
  await state(page, "done");
  expect(await page.locator(".files").innerText()).toContain("Model 1 of 2");
  expect(await page.locator(".copies, cusp-plate").count()).toBe(0);
});
