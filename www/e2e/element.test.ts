/** The element on a third-party page, from the package as it is published. */
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspSlicer } from "../src/element/index.js";
import { packedPages } from "./packed-pages.js";
import { floating, prism, sphere } from "./solids.js";

const html = `<!doctype html><html lang="de"><meta charset="utf-8" /><title>Shop</title>
<script type="module" src="main.js"></script><body></body></html>`;
// What the page's own script would do: record events, and register the class under its own name.
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
  { "index.html": html, "main.js": main, "ball.stl": sphere(10, 96).bytes, "prism.stl": prism(10, 20).bytes, "floating.stl": floating(6, 3), "bad.stl": "no" },
  "fr-FR",
);

const done = (page: Page, id: string): Promise<unknown> => page.waitForSelector(`#${id}[state=done]`);

const events = (page: Page, id: string): Promise<string[]> =>
  page.evaluate((id) => (document as unknown as Told).told.filter(([from]) => from === id).map(([, name]) => name), id);
/** The progress of the plan in each event of an element. */
const planned = (page: Page, id: string): Promise<number[]> =>
  page.evaluate((id) => {
    const told = (document as unknown as Told).told.filter(([from, name, { task }]) => from === id && name === "cusp-progress" && task === "plan");
    return told.map(([, , { done }]) => done as number);
  }, id);

test("two of them work side by side, each with its own model, settings and language", async () => {
  const page = await start(
    `<cusp-slicer id="a" src="ball.stl" tolerance="0.05" locale="en"></cusp-slicer>` +
      `<shop-slicer id="b" src="ball.stl" layer-min="0.04" layer-max="0.1" metric="area" tolerance="0.2" panels="plan"></shop-slicer>`,
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
  // The page is German, its reader French: the page's language takes precedence.
  expect(await page.locator("#b .download").innerText()).toBe("Druckdatei herunterladen");
  expect(await page.locator("#b cusp-chart").count()).toBe(0);
  for (const id of ["a", "b"]) {
    const names = await events(page, id);
    expect(names.filter((name) => name !== "cusp-progress" && name !== "cusp-change")).toEqual(["cusp-load", "cusp-plan"]);
    const done = await planned(page, id);
    expect(done).toEqual(done.toSorted((a, b) => a - b));
    // The last steps may come after the plan, and are then not reported.
    expect(done.at(-1)).toBeGreaterThan(0);
  }
});

test("methods: load, plan, export, cancel", async () => {
  const page = await start(`<cusp-slicer id="a"></cusp-slicer>`);
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element === null) throw new Error("there is no element");
    // A `DOMException` has its own code, which is a number.
    const name = (error: Error & { code?: unknown }): string => (typeof error.code === "string" ? error.code : error.name);
    const early = await element.plan().catch(name);
    const none = await element.export().catch(name);
    const bad = await element.load("bad.stl").catch(name);
    const model = await element.load("ball.stl");
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
    model: "ball.stl",
    file: ["ball-cusp.zip", true],
    cancelled: "AbortError",
  });
  expect(found.layers[1]).toBeGreaterThan(found.layers[0] ?? 0);
  expect(await events(page, "a")).toContain("cusp-error");
});

test("a part that hangs in the air is warned of, in words and in the plan, whatever panels there are", async () => {
  const page = await start(`<cusp-slicer id="a" src="floating.stl" locale="en" panels="plan"></cusp-slicer>`);
  await done(page, "a");
  const [said] = await page.locator("#a .warning").allInnerTexts();
  expect(said).toMatch(/^\d+ layers of the plan are black, from 6\.\d+\u00a0mm up/);
  const warnings = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    return [element?.result?.report.warnings, (await element?.export())?.warnings];
  });
  expect(warnings[0]).toMatchObject([{ code: "black-layers" }]);
  expect(warnings[1]).toEqual(warnings[0]);
});

test("a thumbnail is a PNG of the model in its layers", async () => {
  const page = await start(`<cusp-slicer id="a" src="ball.stl" panels="plan"></cusp-slicer>`);
  await done(page, "a");
  const found = await page.evaluate(async () => {
    const blob = await document.querySelector<CuspSlicer>("#a")?.thumbnail(120);
    if (blob === undefined) throw new Error("there is no element");
    const picture = await createImageBitmap(blob);
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const pen = canvas.getContext("2d");
    pen?.drawImage(picture, 0, 0);
    const { data = new Uint8ClampedArray() } = pen?.getImageData(0, 0, picture.width, picture.height) ?? {};
    const at = (x: number, y: number): number[] => [...data.slice(4 * (y * picture.width + x), 4 * (y * picture.width + x) + 4)];
    const colours = new Set<string>();
    for (let y = 0; y < picture.height; y++) colours.add(at(60, y).join());
    return { type: blob.type, size: [picture.width, picture.height], corner: at(0, 0)[3], middle: at(60, 60)[3], colours: colours.size };
  });
  expect(found).toMatchObject({ type: "image/png", size: [120, 120], corner: 0, middle: 255 });
  // The ball has thin layers at its poles and thick ones at its equator.
  expect(found.colours).toBeGreaterThan(10);
});

test("a shop takes the print file instead of the browser", async () => {
  const page = await start(`<cusp-slicer id="a" src="ball.stl" format="uvj"></cusp-slicer>`);
  await done(page, "a");
  const saved: string[] = [];
  page.on("download", (download) => saved.push(download.suggestedFilename()));
  await page.evaluate(() => document.querySelector("#a")?.addEventListener("cusp-export", (event) => event.preventDefault()));
  await page.locator("#a .download").click();
  await expect.poll(() => events(page, "a")).toContain("cusp-export");
  const name = await page.evaluate(
    () => (document as unknown as Told).told.find(([, name]) => name === "cusp-export")?.[2]["name"],
  );
  expect(name).toBe("ball-cusp.uvj");
  await page.waitForTimeout(300);
  expect(saved).toEqual([]);
});

test("attributes that make no sense are for the page's developer: told, and the last good value stays", async () => {
  const page = await start("");
  const warnings: string[] = [];
  page.on("console", (message) => void (message.type() === "warning" && warnings.push(message.text())));
  const wrong = `tolerance="abc" metric="cups" panels="foo" layer-min="7" format="zip" printer="nobody-s" backend="tpu" quality="high" fixed="price"`;
  await page.evaluate((wrong) => {
    document.body.append(document.createRange().createContextualFragment(`<cusp-slicer id="a" src="ball.stl" locale="e" ${wrong}></cusp-slicer>`));
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
  expect(warnings.join("\n")).toContain(`metric="cups" is none of cusp, deviation, thread, roughness, area, volume; the last good value stays`);
  expect(found.told).toContainEqual(expect.objectContaining({ attribute: "printer", known: expect.arrayContaining(["saturn-3-ultra"]) }));
});

test("what the page has fixed is shown, and neither form, offer nor undo changes it", async () => {
  const page = await start(
    `<cusp-slicer id="a" src="ball.stl" locale="en" printer="sl1s" format="uvj" fixed="printer format layer-min"></cusp-slicer>`,
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
  const page = await start(`<cusp-slicer id="a" src="ball.stl" locale="en" fixed="printer"></cusp-slicer>`);
  const found = await page.evaluate(async () => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element === null) throw new Error("there is no element");
    const volume_mm: [number, number, number] = [40, 40, 40];
    element.printer = { name: "ours", model: "Our Printer", pixels: [800, 800], pitch_um: [50, 50], volume_mm, format: "goo", reads: ["prz"] };
    const theirs = { ...element.printer, name: "ours", pixels: [10, 10] };
    element.query = `printer=${JSON.stringify(theirs)}&tolerance=0.06`;
    await element.load("ball.stl");
    const { report } = await element.plan();
    const { width, height } = report.mask;
    return { printer: report.printer, mask: [width, height], tolerance: report.tolerance, name: (await element.export()).name };
  });
  expect(found).toEqual({ printer: "ours", mask: [800, 800], tolerance: 0.06, name: "ball-cusp.prz" });
  expect(await page.locator("#a #printer-hint").innerText()).toMatch(/^Set by this page\. Our Printer: 800 × 800 pixels/);
  // Whether it was tried with several thicknesses is the page's business.
  expect(await page.locator("#a .warning").count()).toBe(0);
});

test("a prism comes out the same at every quality: a sentence stands in place of the slider", async () => {
  const page = await start(`<cusp-slicer id="a" src="prism.stl" locale="en"></cusp-slicer>`);
  await done(page, "a");
  const said = page.locator("#a cusp-quality .single");
  expect(await said.innerText()).toBe("Every quality gives this model the same layers.");
  expect(await page.locator("#a cusp-quality input").count()).toBe(0);
  expect(await page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.quality)).toBe(1);
});

test("a quality is a place on the curve: finer takes longer", async () => {
  const page = await start(`<cusp-slicer id="a" src="ball.stl" quality="0"></cusp-slicer>`);
  const layers = (): Promise<number> =>
    page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.result?.report.layers ?? 0);
  await expect.poll(() => page.evaluate(() => document.querySelector<CuspSlicer>("#a")?.query)).toContain("tolerance");
  await done(page, "a");
  const coarse = await layers();
  await page.evaluate(() => {
    const element = document.querySelector<CuspSlicer>("#a");
    if (element !== null) element.quality = 1;
  });
  await expect.poll(layers).toBeGreaterThan(coarse);
});

test("colours and corners are the page's to set, and it is light or dark as its place is", async () => {
  const page = await start(
    `<cusp-slicer id="a" src="ball.stl" panels="plan"></cusp-slicer>` +
      `<div id="dark"><cusp-slicer id="b" src="ball.stl" panels="plan"></cusp-slicer></div>`,
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
});

test.each([1280, 390])("from right to left it mirrors, and nothing sticks out: %i px", async (width) => {
  const viewport = { width, height: 900 };
  const page = await start(`<div dir="rtl"><cusp-slicer id="a" src="ball.stl"></cusp-slicer></div>`, { viewport });
  await done(page, "a");
  const { count, card } = await page.evaluate(() => {
    const root = document.querySelector("#a")?.shadowRoot;
    const box = (selector: string): DOMRect | undefined => root?.querySelector(selector)?.getBoundingClientRect();
    return { count: box(".count")?.right ?? 0, card: box(".card[part=plan]")?.right ?? 1 };
  });
  expect(card - count).toBeLessThan(40);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(overflow).toBe(0);
});

test("the price of a shop stands under the result, and follows quality and copies", async () => {
  const page = await start(`<cusp-slicer id="a" src="ball.stl" printer="saturn-3-ultra" locale="de"></cusp-slicer>`);
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
  // Prices that cannot be used are the page's fault, and leave the plan alone.
  await page.evaluate(() => {
    const slicer = document.querySelector<CuspSlicer>("#a");
    if (slicer !== null) slicer.prices = { currency: "euro" };
  });
  await expect.poll(() => events(page, "a")).toContain("cusp-error");
  expect(await page.locator("#a").getAttribute("state")).toBe("done");
  expect(await priced()).toBeNull();
});

test("taken out of the page it rests, and put back it works on", async () => {
  const page = await start(`<cusp-slicer id="a" src="ball.stl"></cusp-slicer>`);
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
  expect(layers).toBeGreaterThan(134);
});

test("a part that cannot be fetched says so in its panel and to the page, and comes when it is tried again", async () => {
  const page = await start("");
  const blocked = /\/(cusp-view|thumbnails|uPlot)[^/]*\.js/;
  await page.route(blocked, (route) => route.abort());
  await page.evaluate(() =>
    document.body.append(
      document
        .createRange()
        .createContextualFragment(`<cusp-slicer id="a" src="ball.stl" panels="plan view profile orientation" locale="en"></cusp-slicer>`),
    ),
  );
  await done(page, "a");
  const failure = (panel: string): Locator => page.locator(`${panel} .part-failed`);
  await failure("cusp-model").waitFor();
  await failure("cusp-chart").waitFor();
  expect(await failure("cusp-model").innerText()).toContain("This part of the page could not be loaded.");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  await failure("cusp-orientation").waitFor();
  const errors = await page.evaluate(() =>
    (document as unknown as Told).told
      .filter(([, name]) => name === "cusp-error")
      .map(([id, , { code, detail }]) => ({ id, code, detail })),
  );
  const expected = ["view", "chart", "pictures"].map((part) => ({
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
  await failure("cusp-orientation").getByRole("button", { name: "Try again" }).click();
  await page.locator("cusp-orientation canvas[data-drawn]").first().waitFor();
  expect(await page.locator(".part-failed").count()).toBe(0);
  const unloaded = complaints.splice(0);
  expect(unloaded.filter((text) => !text.startsWith("Failed to load resource"))).toEqual([]);
  expect(unloaded.length).toBeGreaterThan(0);
});
