/** The element on a third-party page, from the published package: attributes, events, methods, prices, and errors. */
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspSlicer } from "../src/element/index.js";
import { broken } from "./axe.js";
import { packedPages } from "./packed-pages.js";
import { cup, floating, prism, sphere } from "./solids.js";

const html = `<!doctype html><html lang="de"><meta charset="utf-8" /><title>Shop</title>
<script type="module" src="main.js"></script><body></body></html>`;
// Script of the page: records events, and registers the class under its own name.
const main = `
import "./cusp-slicer/element.js";
import { CuspSlicer } from "./cusp-slicer/element-class.js";
customElements.define("shop-slicer", class extends CuspSlicer {});
const told = [];
for (const name of ["cusp-load", "cusp-plan", "cusp-progress", "cusp-export", "cusp-error", "cusp-change"]) {
  document.addEventListener(name, ({ target, detail }) => told.push([target.id, name, detail]));
}
Object.assign(document, { told });
document.body.dataset.ready = "";
`;

interface Told {
  told: [id: string, name: string, detail: Record<string, unknown>][];
}

const { start, complaints } = packedPages(
  { "index.html": html, "main.js": main, "ball.stl": sphere(10, 48).bytes, "small.stl": sphere(5, 48).bytes, "floating.stl": floating(6, 3), "block.stl": prism(12, 8).bytes, "mug.stl": cup(10, 8, 1.5), "bad.stl": "no" },
  "fr-FR",
);

const done = (page: Page, id: string): Promise<unknown> => page.waitForSelector(`#${id}[state=done]`);

const events = (page: Page, id: string): Promise<string[]> =>
  page.evaluate((id) => (document as unknown as Told).told.filter(([from]) => from === id).map(([, name]) => name), id);
/** Progress of the plan in each event of an element. */
const planned = (page: Page, id: string): Promise<number[]> =>
  page.evaluate((id) => {
    const told = (document as unknown as Told).told.filter(([from, name, { task }]) => from === id && name === "cusp-progress" && task === "plan");
    return told.map(([, , { done }]) => done as number);
  }, id);

/** Drops both files on the element. */
async function dropBoth(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const transfer = new DataTransfer();
    for (const name of ["ball.stl", "block.stl"]) transfer.items.add(new File([await (await fetch(name)).arrayBuffer()], name));
    document.querySelector("cusp-slicer")?.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
}

const listed = (page: Page): Promise<string[]> => page.locator("cusp-plate .name").allInnerTexts();

test("two of them work side by side, each with its own model, settings and language; one out of view fetches nothing, and all share one module", async () => {
  const page = await start("");
  const modules: string[] = [];
  page.on("request", (request) => void (request.url().endsWith(".wasm") && modules.push(request.url())));
  await page.evaluate(() => {
    const far = Object.assign(document.createElement("cusp-slicer"), { id: "far" });
    far.style.marginTop = "200vh";
    document.body.append(far);
  });
  await page.waitForSelector("#far[state=empty]");
  // Browsers report visibility after a frame.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  expect([modules, page.workers().length]).toEqual([[], 0]);
  await page.evaluate((markup) => document.body.prepend(document.createRange().createContextualFragment(markup)),
    `<cusp-slicer id="a" src="small.stl" tolerance="0.05" locale="en"></cusp-slicer>` +
      `<shop-slicer id="b" src="small.stl" layer-min="0.04" layer-max="0.1" metric="area" tolerance="0.2" panels="plan"></shop-slicer>`,
  );
  await done(page, "a");
  await done(page, "b");
  const found = await page.evaluate(() =>
    ["a", "b"].map((id) => {
      const { result } = document.querySelector<CuspSlicer>(`#${id}`) ?? {};
      const { tolerance, metric, layer_min_mm, layer_max_mm } = result?.options ?? {};
      return { tolerance, metric, layer_min_mm, layer_max_mm };
    }),
  );
  expect(found).toEqual([
    { tolerance: 0.05, metric: "cusp", layer_min_mm: 0.05, layer_max_mm: 0.15 },
    { tolerance: 0.2, metric: "area", layer_min_mm: 0.04, layer_max_mm: 0.1 },
  ]);
  expect(await page.locator("#a .download").innerText()).toBe("Download print file");
  // The page is German, its reader French; the page's language takes precedence.
  expect(await page.locator("#b .download").innerText()).toBe("Druckdatei herunterladen");
  expect(await page.locator("#b cusp-chart").count()).toBe(0);
  for (const id of ["a", "b"]) {
    const names = await events(page, id);
    expect(names.filter((name) => name !== "cusp-progress" && name !== "cusp-change")).toEqual(["cusp-load", "cusp-plan"]);
    const done = await planned(page, id);
    expect(done).toEqual(done.toSorted((a, b) => a - b));
    // The last steps may come after the plan, and are not reported then.
    expect(done.at(-1)).toBeGreaterThan(0);
  }
  const workers = page.workers().length;
  await page.locator("#far").scrollIntoViewIfNeeded();
  await expect.poll(() => page.workers().length).toBe(workers + 1);
  expect(modules).toHaveLength(1);
});

test("methods load, plan, export and cancel; a shop takes the print file instead of the browser, and its warnings", async () => {
  const page = await start(`<cusp-slicer id="a"></cusp-slicer>`);
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element === null) throw new Error("there is no element");
    // A `DOMException` has its own numeric code.
    const name = (error: Error & { code?: unknown }): string => (typeof error.code === "string" ? error.code : error.name);
    const early = await element.plan().catch(name);
    const none = await element.export().catch(name);
    const bad = await element.load("bad.stl").catch(name);
    const model = await element.load("small.stl");
    const first = await element.plan();
    element.tolerance = 0.05;
    const second = await element.plan();
    const file = await element.export();
    const { query } = element;
    element.query = "layerMin=7";
    const fault = await element.plan().catch(name);
    element.query = query;
    element.tolerance = 0.06;
    const cancelled = element.plan().catch(name);
    element.cancel();
    return {
      errors: [early, none, bad, fault],
      model: model.name,
      layers: [first.report.layers, second.report.layers],
      file: [file.name, file.blob.size > 1000],
      cancelled: await cancelled,
    };
  });
  expect(found).toMatchObject({
    errors: ["no-model", "no-plan", "unknown-file-kind", "bad-options"],
    model: "small.stl",
    file: ["small-cusp.zip", true],
    cancelled: "AbortError",
  });
  expect(found.layers[1]).toBeGreaterThan(found.layers[0] ?? 0);
  expect(await events(page, "a")).toContain("cusp-error");

  // A floating part causes a warning with a sentence, both in the plan and in the file.
  const warnings = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    element?.setAttribute("locale", "en");
    await element?.load("floating.stl");
    return [(await element?.plan())?.report.warnings, (await element?.export())?.warnings];
  });
  expect(warnings[0]).toMatchObject([{ code: "black-layers" }]);
  expect(warnings[1]).toEqual(warnings[0]);
  await expect.poll(() => page.locator("#a .warning").first().innerText()).toMatch(/^\d+ layers of the plan are black, from 6\.\d+\u00a0mm up/);

  const saved: string[] = [];
  page.on("download", (download) => saved.push(download.suggestedFilename()));
  await page.evaluate(() => document.querySelector("#a")?.addEventListener("cusp-export", (event) => event.preventDefault(), { once: true }));
  await page.locator("#a .download").click();
  await expect.poll(() => events(page, "a")).toContain("cusp-export");
  // The browser handles the next one again, and saves it first.
  await page.locator("#a .download").click();
  await expect.poll(() => saved).toEqual(["floating-cusp.zip"]);
});

test("attributes that make no sense are for the page's developer: told, and the last good value stays", async () => {
  const page = await start("");
  const warnings: string[] = [];
  page.on("console", (message) => void (message.type() === "warning" && warnings.push(message.text())));
  const wrong = `tolerance="abc" metric="cups" panels="foo" layer-min="7" format="zip" printer="nobody-s" backend="tpu" quality="high" fixed="price"`;
  await page.evaluate((wrong) => {
    document.body.append(document.createRange().createContextualFragment(`<cusp-slicer id="a" src="small.stl" locale="e" ${wrong}></cusp-slicer>`));
  }, wrong);
  await done(page, "a");
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element === null) throw new Error("there is no element");
    const { tolerance, metric, panels, layerMin, format, printer, fixed } = element;
    element.setAttribute("tolerance", "0.05");
    element.setAttribute("tolerance", "thin");
    element.tolerance = Number.NaN;
    const { report } = await element.plan();
    const told = (document as unknown as Told).told.filter(([, name]) => name === "cusp-error").map(([, , detail]) => detail["detail"]);
    const codes = (document as unknown as Told).told.filter(([, name]) => name === "cusp-error").map(([, , detail]) => detail["code"]);
    const state = { state: element.state, problems: element.shadowRoot?.querySelectorAll("[part=problem]").length };
    return { taken: { tolerance, metric, panels, layerMin, format, printer, fixed }, told, codes, tolerance: report.tolerance, ...state };
  });
  const usual = { tolerance: null, metric: "cusp", panels: null, layerMin: 0.05, format: null, printer: "", fixed: null };
  expect(found).toMatchObject({ taken: usual, tolerance: 0.05, state: "done", problems: 0 });
  expect(new Set(found.codes)).toEqual(new Set(["bad-attribute"]));
  const values = (found.told as { attribute: string; value: unknown }[]).map(({ attribute, value }) => `${attribute}=${String(value)}`);
  expect(values.slice().sort()).toEqual([
    ...["backend=tpu", "fixed=price", "format=zip", "layer-min=7", "locale=e", "metric=cups", "panels=foo", "printer=nobody-s"],
    ...["quality=high", "tolerance=NaN", "tolerance=abc", "tolerance=thin"],
  ]);
  await expect.poll(() => warnings.filter((text) => text.startsWith("<cusp-slicer>: "))).toHaveLength(values.length);
  expect(warnings.join("\n")).toContain(`metric="cups" is none of cusp, deviation, filament-roundness, roughness, area, volume; the last good value stays`);
  expect(found.told).toContainEqual(expect.objectContaining({ attribute: "printer", known: expect.arrayContaining(["saturn-3-ultra"]) }));
});

test("what the page has fixed is shown, and neither form, offer nor undo changes it", async () => {
  const page = await start(
    `<cusp-slicer id="a" src="small.stl" locale="en" printer="sl1s" format="uvj" fixed="printer format layer-min"></cusp-slicer>`,
  );
  await done(page, "a");
  const field = (name: string): ReturnType<Page["locator"]> => page.locator("#a").getByLabel(name, { exact: true });
  for (const name of ["Printer", "Print file", "Thinnest layer"]) expect(await field(name).isDisabled(), name).toBe(true);
  for (const name of ["Tolerance", "Thickest layer", "Measure errors by"]) expect(await field(name).isDisabled(), name).toBe(false);
  expect(await page.locator("#a #printer-hint").innerText()).toMatch(/^Set by this page\. /);
  await page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.setAttribute("printer", "mars-4-ultra"));
  await field("Scale to height").fill("120");
  await page.waitForSelector("#a[state=error]");
  await expect.poll(() => page.locator("#a cusp-settings .offers button").allInnerTexts()).toEqual([expect.stringMatching(/^Scale to \d/)]);
  const settings = await page.evaluate(() => {
    const element = document.querySelector<CuspSlicer>("#a");
    element?.undo();
    if (element) element.query = "printer=saturn-3-ultra&format=png&tolerance=0.06";
    return [element?.printer, element?.format, element?.tolerance];
  });
  expect(settings).toEqual(["mars-4-ultra", "uvj", 0.06]);
});

test("a printer of the page's own is a property, and customers cannot bring another", async () => {
  const page = await start(`<cusp-slicer id="a" src="small.stl" locale="en" fixed="printer"></cusp-slicer>`);
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element === null) throw new Error("there is no element");
    const volume_mm: [number, number, number] = [40, 40, 40];
    element.printer = { name: "ours", model: "Our Printer", pixels: [800, 800], pitch_um: [50, 50], volume_mm, format: "goo", reads: ["prz"] };
    const theirs = { ...element.printer, name: "ours", pixels: [10, 10] };
    element.query = `printer=${JSON.stringify(theirs)}&tolerance=0.06`;
    await element.load("small.stl");
    const { report } = await element.plan();
    const { width, height } = report.mask;
    return { printer: report.printer, mask: [width, height], tolerance: report.tolerance, name: (await element.export()).name };
  });
  expect(found).toEqual({ printer: "ours", mask: [800, 800], tolerance: 0.06, name: "small-cusp.prz" });
  expect(await page.locator("#a #printer-hint").innerText()).toMatch(/^Set by this page\. Our Printer: 800 × 800 pixels/);
  // The page decides whether the printer was tried with several thicknesses.
  expect(await page.locator("#a .warning").count()).toBe(0);
});

test("colours and corners are the page's to set; it is light or dark, and from right to left, as its place is", async () => {
  const page = await start(
    `<cusp-slicer id="a" src="small.stl" panels="plan"></cusp-slicer>` +
      `<div id="dark" dir="rtl"><cusp-slicer id="b" src="small.stl" panels="plan"></cusp-slicer></div>`,
  );
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(
      "#a { --cusp-accent: rgb(1, 2, 3); --cusp-radius: 0px; } #dark { color-scheme: dark; } #a::part(plan) { border-width: 7px; }",
    );
    document.adoptedStyleSheets = [sheet];
  });
  await done(page, "a");
  await done(page, "b");
  const style = (id: string, selector: string, property: string): Promise<string> =>
    page.locator(`#${id} ${selector}`).evaluate((element, name) => getComputedStyle(element).getPropertyValue(name), property);
  expect(await style("a", ".download", "background-color")).toBe("rgb(1, 2, 3)");
  expect(await style("a", ".card", "border-top-left-radius")).toBe("0px");
  expect(await style("a", ".card", "border-top-width")).toBe("7px");
  expect(await style("a", ".card", "background-color")).toBe("rgb(255, 255, 255)");
  expect(await style("b", ".card", "background-color")).toBe("rgb(27, 30, 37)");
  for (const width of [1280, 390]) {
    await page.setViewportSize({ width, height: 900 });
    const { count, card } = await page.evaluate(() => {
      const root = document.querySelector("#b")?.shadowRoot;
      const box = (selector: string): DOMRect | undefined => root?.querySelector(selector)?.getBoundingClientRect();
      return { count: box(".count")?.right ?? 0, card: box(".card[part=plan]")?.right ?? 1 };
    });
    expect(card - count).toBeLessThan(40);
    expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBe(0);
  }
});

test("the price of a shop stands under the result, and follows quality and copies", async () => {
  const page = await start(`<cusp-slicer id="a" src="small.stl" printer="saturn-3-ultra" locale="de"></cusp-slicer>`);
  await done(page, "a");
  const priced = (): Promise<{ total: number; copies: number } | null> =>
    page.evaluate(() => {
      const { price } = document.querySelector<CuspSlicer>("#a") ?? {};
      return price ? { total: price.total, copies: price.copies } : null;
    });
  expect(await priced()).toBeNull();
  await page.evaluate(() => {
    const slicer = document.querySelector<CuspSlicer>("#a");
    if (slicer !== null) slicer.prices = { currency: "EUR", setup: 300, machine_per_h: 3600, resin_per_ml: 100 };
  });
  await expect.poll(priced).toMatchObject({ copies: 1 });
  const first = (await priced())?.total ?? 0;
  const { print_time_s, resin_ml } = await page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.result?.report ?? { print_time_s: 0, resin_ml: 0 });
  expect(first).toBe(300 + Math.round(print_time_s) + Math.round(resin_ml * 100));
  const written = `Preis ${(first / 100).toLocaleString("de", { minimumFractionDigits: 2 })}\u00a0€`;
  await expect.poll(() => page.locator("#a .price").innerText()).toBe(written);
  await page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.setAttribute("layer-max", "0.06"));
  await expect.poll(async () => (await priced())?.total ?? 0).toBeGreaterThan(first);
  const field = page.locator("#a .copies-row input").first();
  await field.fill("3");
  await field.press("Enter");
  await expect.poll(priced).toMatchObject({ copies: 3 });
  // Invalid prices are the page's fault, and do not affect the plan.
  await page.evaluate(() => {
    const slicer = document.querySelector<CuspSlicer>("#a");
    if (slicer !== null) slicer.prices = { currency: "euro" };
  });
  await expect.poll(() => events(page, "a")).toContain("cusp-error");
  expect(await page.locator("#a").getAttribute("state")).toBe("done");
  expect(await priced()).toBeNull();
});

test("files that are dropped together stand on one plate, in a list in the model's card", async () => {
  const page = await start(`<main><h1>Shop</h1><cusp-slicer id="a" printer="mars-4-ultra" locale="en"></cusp-slicer></main>`);
  await dropBoth(page);
  await done(page, "a");
  await page.locator("cusp-plate").waitFor();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await page.locator(".model cusp-plate").count()).toBe(1);
  await page.locator("[part=quality] cusp-quality").waitFor();
  expect(await broken(page)).toEqual([]);
  await page.getByRole("button", { name: "One more: Copies of block.stl" }).click();
  await done(page, "a");
  const copies = page.getByRole("textbox", { name: "Copies of block.stl" });
  await expect.poll(() => copies.inputValue()).toBe("2");
});

test("a page adds models with copies and poses of their own, and has the plans and files of all plates", async () => {
  const page = await start(`<cusp-slicer id="a" printer="mars-4-ultra" src="ball.stl" panels="plan"></cusp-slicer>`);
  await done(page, "a");
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("cusp-slicer");
    if (element === null) throw new Error("there is no element");
    const loaded: string[] = [];
    element.addEventListener("cusp-load", ({ detail }) => loaded.push(detail.name));
    const alone = element.plates;
    // Not awaited: both are added, in order.
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

test("the element checks nothing before its card of findings is open, and then shows where they are", async () => {
  const page = await start(`<cusp-slicer id="a" src="mug.stl" locale="en" panels="layers findings"></cusp-slicer>`);
  await done(page, "a");
  const check = (): Promise<unknown> => page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.check);
  expect(await check()).toBeNull();
  await page.locator("#a details.findings > summary").click();
  await page.waitForSelector("cusp-findings [data-verdict]");
  expect(await check()).not.toBeNull();
  const finding = page.locator("cusp-findings button[aria-pressed]").first();
  await finding.click();
  expect(await finding.getAttribute("aria-pressed")).toBe("true");
  await page.waitForSelector("cusp-mask canvas[data-marked]");
});

test("taken out of the page it rests, and put back it works on", async () => {
  const page = await start(`<cusp-slicer id="a" src="small.stl"></cusp-slicer>`);
  await done(page, "a");
  await expect.poll(() => page.workers().length).toBeGreaterThan(0);
  const element = await page.evaluateHandle(() => {
    const element = document.querySelector<CuspSlicer>("#a");
    element?.remove();
    return element;
  });
  await expect.poll(() => page.workers().length).toBe(0);
  const layers = await page.evaluate(async (element) => {
    if (element === null) return 0;
    document.body.append(element);
    element.tolerance = 0.055;
    return (await element.plan()).report.layers;
  }, element);
  expect(layers).toBeGreaterThan(67);
});

test("a part that cannot be fetched says so in its panel and to the page, and comes when it is tried again", async () => {
  const page = await start("");
  const blocked = /\/(cusp-view|uPlot)[^/]*\.js/;
  await page.route(blocked, (route) => route.abort());
  await page.evaluate(() =>
    document.body.append(
      document
        .createRange()
        .createContextualFragment(`<cusp-slicer id="a" src="small.stl" panels="plan view profile" locale="en"></cusp-slicer>`),
    ),
  );
  await done(page, "a");
  const failure = (panel: string): Locator => page.locator(`${panel} .part-failed`);
  await failure("cusp-model").waitFor();
  await failure("cusp-chart").waitFor();
  expect(await failure("cusp-model").innerText()).toContain("This part of the page could not be loaded.");
  const errors = await page.evaluate(() =>
    (document as unknown as Told).told
      .filter(([, name]) => name === "cusp-error")
      .map(([id, , { code, detail }]) => ({ id, code, detail })),
  );
  const expected = ["view", "chart"].map((part) => ({
    id: "a",
    code: "part-failed",
    detail: { part, system: expect.stringMatching(/^Failed to fetch/) as string },
  }));
  expect(errors).toHaveLength(expected.length);
  expect(errors).toEqual(expect.arrayContaining(expected));
  // The plan is unaffected.
  expect(await page.locator("#a").getAttribute("state")).toBe("done");

  await page.unroute(blocked);
  await failure("cusp-model").getByRole("button", { name: "Try again" }).click();
  await page.locator("cusp-view").waitFor();
  await failure("cusp-chart").getByRole("button", { name: "Try again" }).click();
  await page.locator("cusp-chart .plot canvas").waitFor();
  expect(await page.locator(".part-failed").count()).toBe(0);
  const unloaded = complaints.splice(0);
  expect(unloaded.filter((text) => !text.startsWith("Failed to load resource"))).toEqual([]);
  expect(unloaded.length).toBeGreaterThan(0);
});
