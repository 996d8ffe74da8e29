/** Browsers whose language is not a BCP 47 tag: WebKit's is "C" if LANG is, others have "en-US@posix". */
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, inject, test } from "vitest";
import { drop, launch, state } from "./browser.js";
import { builtShop } from "./built.js";
import { servePacked } from "./packed.js";
import type { Served } from "./serve.js";
import { sphere } from "./solids.js";
import { serveFolder } from "./static.js";

const html = `<!doctype html><html><meta charset="utf-8" /><title>Shop</title>
<script type="module" src="cusp-slicer/element.js"></script>
<body><cusp-slicer src="ball.stl"></cusp-slicer></body></html>`;

let browser: Browser;
let packed: Served;
let shop: Served;
const pages: Page[] = [];
const complaints: string[] = [];

beforeAll(async () => {
  packed = await servePacked({ "index.html": html, "ball.stl": sphere(10, 96).bytes });
  shop = await serveFolder(await builtShop(), "");
  browser = await launch();
}, 240_000);

afterAll(async () => {
  await browser.close();
  await Promise.all([packed.close(), shop.close()]);
});

afterEach(async () => {
  await Promise.all(pages.splice(0).map((page) => page.context().close()));
  complaints.length = 0;
});

/** Opens a page in a browser that reports this language, and records its errors. */
async function start(address: string, language: string, block?: RegExp): Promise<Page> {
  const page = await (await browser.newContext({ serviceWorkers: "block" })).newPage();
  pages.push(page);
  await page.addInitScript((language) => {
    Object.defineProperties(Navigator.prototype, {
      language: { get: () => language },
      languages: { get: () => [language] },
    });
  }, language);
  if (block !== undefined) await page.route(block, (route) => route.abort());
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  await page.goto(address);
  return page;
}

/** Number of pixels that the chart has drawn; null if there is no chart. */
const drawn = (page: Page): Promise<number | null> =>
  page.locator("cusp-chart").evaluate(({ shadowRoot }) => {
    const canvas = shadowRoot?.querySelector<HTMLCanvasElement>(".plot canvas");
    const pixels = canvas?.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data;
    return pixels?.filter((value, i) => i % 4 === 3 && value > 0).length ?? null;
  });

async function expectChart(page: Page): Promise<void> {
  await expect.poll(() => drawn(page)).toBeGreaterThan(10_000);
}

for (const language of ["C", "en-US@posix"]) {
  test(`the page shows a plan and its chart where the language is ${language}`, async () => {
    const page = await start(inject("address"), language);
    await state(page, "empty");
    await drop(page, { name: "ball.stl", bytes: sphere(10, 96).bytes });
    await state(page, "done");
    await expectChart(page);
    expect(await page.locator(".download").innerText()).toBe("Download print file");
    expect(await page.evaluate(() => document.documentElement.lang)).toBe("en");
    expect(complaints).toEqual([]);
  });
}

test("so does the element of the package", async () => {
  const page = await start(packed.address, "C");
  await state(page, "done");
  await expectChart(page);
  expect(complaints).toEqual([]);
});

test("without the chart's code the rest works, and the page is told", async () => {
  const page = await start(packed.address, "de", /uPlot/i);
  await page.evaluate(() => {
    document.querySelector("cusp-slicer")?.addEventListener("cusp-error", ({ detail }) => {
      const { code, detail: about } = detail;
      document.body.dataset.told = JSON.stringify({ code, about });
    });
  });
  await state(page, "done");
  expect(await page.locator("cusp-chart p").innerText()).toContain("Dieser Teil der Seite ließ sich nicht laden.");
  expect(JSON.parse((await page.locator("body").getAttribute("data-told")) ?? "")).toMatchObject({
    code: "part-failed",
    about: { part: "chart" },
  });
  expect(await page.locator(".download").isEnabled()).toBe(true);
});

test("and a shop has a price", async () => {
  const page = await start(shop.address, "C");
  await state(page, "empty");
  await page.getByRole("button", { name: "Try our goblet" }).click();
  await state(page, "done");
  await expect.poll(() => page.locator("#order").isEnabled()).toBe(true);
  expect(complaints).toEqual([]);
});
