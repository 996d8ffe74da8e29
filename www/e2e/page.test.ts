/** The page as a person uses it, in a real browser. */
import { readFile } from "node:fs/promises";
import { decode } from "fast-png";
import { unzipSync } from "fflate";
import { expect, inject, test } from "vitest";
import { download, drop, launch, layers, maskOf, open, openPanel, settled, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

/** What the tests read from the manifest. */
interface Manifest {
  layers: number;
  mask: { width: number; height: number; pitch_mm: number };
  layer_files: { file: string; z_mm: number; thickness_mm: number; lit_pixels: number }[];
}

const ball = sphere(10, 96);
const ballFile = { name: "ball.stl", bytes: ball.bytes };

const start = pages();

test("a dropped model is planned, looked through by keyboard, and its masks add up to its volume", async () => {
  const page = await start();
  await drop(page, ballFile);
  await state(page, "done");

  const text = await words(page);
  expect(text).toContain("ball.stl");
  expect(text).toContain("20.0 × 20.0 × 20.0 mm");
  expect(text).toContain("Watertight");
  expect(text).toMatch(/\d+% fewer than uniform 0.05 mm \(400\), same tolerance/);
  expect(text).toMatch(/Uniform 0.15 mm 13[34] \d+ min 0.1[45]\d* mm over tolerance/);
  expect(text).toMatch(/\d+ layers about (\d+ h )?\d+ min to print/);
  const count = await layers(page);
  expect(count).toBeGreaterThan(134);
  expect(count).toBeLessThan(400);

  await openPanel(page, "Mask");
  const slider = page.getByRole("slider", { name: "Layer", exact: true });
  const middle = Number(await slider.inputValue());
  await maskOf(page, middle - 1);
  await slider.focus();
  await page.keyboard.press("ArrowUp");
  await maskOf(page, middle);
  await page.keyboard.press("Home");
  await maskOf(page, 0);
  expect(await slider.getAttribute("aria-valuetext")).toMatch(new RegExp(`^Layer 1 of ${count}, at 0.000\u00a0mm, `));
  await page.keyboard.press("End");
  await maskOf(page, count - 1);

  const file = await download(page);
  expect(file.suggestedFilename()).toBe("ball-cusp.zip");
  const files = unzipSync(await readFile(await file.path()));
  const manifest = JSON.parse(new TextDecoder().decode(files["manifest.json"])) as Manifest;
  expect(manifest.layers).toBe(count);
  expect(manifest.layer_files).toHaveLength(count);
  let volume = 0;
  let top = 0;
  for (const layer of manifest.layer_files) {
    const png = decode(files[layer.file] ?? new Uint8Array());
    expect([png.width, png.height]).toEqual([manifest.mask.width, manifest.mask.height]);
    const lit = litPixels(png);
    expect(lit).toBe(layer.lit_pixels);
    volume += lit * manifest.mask.pitch_mm ** 2 * layer.thickness_mm;
    top += layer.thickness_mm;
    expect(layer.z_mm).toBeCloseTo(top, 6);
  }
  expect(Math.abs(volume / ball.volume_mm3 - 1)).toBeLessThan(0.01);
});

/** Lit pixels of a one-bit picture, whose rows are padded to whole bytes with dark ones. */
function litPixels({ data, depth }: ReturnType<typeof decode>): number {
  expect(depth).toBe(1);
  let lit = 0;
  for (const byte of data) for (let rest = byte; rest > 0; rest >>= 1) lit += rest & 1;
  return lit;
}

test("a click in the chart looks at the layer of that height", async () => {
  const page = await start();
  await drop(page, ballFile);
  await state(page, "done");
  const plot = page.locator(".u-over");
  const box = await plot.boundingBox();
  if (box === null) throw new Error("there is no chart");
  await plot.click({ position: { x: box.width / 2, y: box.height / 4 } });
  const said = await page.getByRole("slider", { name: "Layer in the view" }).getAttribute("aria-valuetext");
  expect(Number(/at (\d+\.\d+)/.exec(said ?? "")?.[1])).toBeCloseTo(15, 0);
});

test("the example opens from the keyboard, and focus goes to the model", async () => {
  const page = await start();
  await page.getByRole("button", { name: "Try the example" }).focus();
  await page.keyboard.press("Enter");
  await state(page, "done");
  expect(await layers(page)).toBeGreaterThan(267);
  expect(await page.evaluate(() => document.querySelector("cusp-workbench")?.shadowRoot?.activeElement?.textContent)).toBe("goblet.stl");
  // The focus is for screen readers there: nothing can be done with a name, and a ring would only puzzle.
  expect(await page.locator(".model-name").evaluate((it) => getComputedStyle(it).outlineStyle)).toBe("none");
  await page.getByRole("status").filter({ hasText: /layers planned/ }).waitFor();
});

test("a file chosen in the dialogue opens like a dropped one", async () => {
  const page = await start();
  await page.getByLabel(/Choose a file/).setInputFiles({ name: "ball.stl", mimeType: "", buffer: Buffer.from(ball.bytes) });
  await state(page, "done");
  expect(await page.locator(".model-name").innerText()).toBe("ball.stl");
});

test("files that will not do are refused in words, and the page goes on", async () => {
  const page = await start();
  await drop(page, { name: "notes.txt", bytes: new TextEncoder().encode("hello") });
  await state(page, "error");
  expect(await page.getByRole("alert").innerText()).toContain("notes.txt is not a model that Cusp reads");

  await drop(page, { name: "prose.stl", bytes: new TextEncoder().encode("once upon a time there was no solid at all") });
  await expect.poll(() => page.getByRole("alert").innerText()).toContain("prose.stl");

  await drop(page, ballFile);
  await state(page, "done");
  const count = await layers(page);

  await drop(page, { name: "half.stl", bytes: ball.bytes.slice(0, ball.bytes.length / 2) });
  await state(page, "error");
  expect(await page.getByRole("alert").innerText()).toContain("half.stl is cut short");
  // The previous model is still there and still responds.
  expect(await page.locator(".model-name").innerText()).toBe("ball.stl");
  expect(await layers(page)).toBe(count);
  await openPanel(page, "Mask");
  await page.getByRole("button", { name: "Layer below" }).click();
  await page.getByRole("button", { name: "Close" }).click();
  await state(page, "done");
});

test("of several files the STLs are opened, as models of one plate", async () => {
  const page = await start("?printer=mars-4-ultra");
  await drop(page, { name: "notes.txt", bytes: new Uint8Array(3) }, ballFile, { name: "other.stl", bytes: ball.bytes });
  await state(page, "done");
  expect(await page.locator("cusp-plate .name").allInnerTexts()).toEqual(["ball.stl", "other.stl"]);
});

test("settings plan again by themselves; nonsense is explained where it stands", async () => {
  const page = await start();
  await drop(page, ballFile);
  await state(page, "done");
  const count = await layers(page);

  await page.getByLabel("Tolerance", { exact: true }).fill("0.055");
  await settled(page);
  expect(await layers(page)).toBeGreaterThan(count);

  await page.getByLabel("Tolerance", { exact: true }).fill("55");
  const field = page.getByLabel("Tolerance", { exact: true });
  await expect.poll(() => field.getAttribute("aria-invalid")).toBe("true");
  expect(await page.locator("#tolerance-hint").innerText()).toContain("55 µm is 0.055 mm");
  await field.fill("0.065");
  await settled(page);
  expect(await layers(page)).toBe(count);

  await page.getByLabel("Scale to height").fill("40");
  await settled(page);
  expect(await words(page)).toContain("40.0 × 40.0 × 40.0 mm");

  await page.getByText("Uniform", { exact: true }).click();
  await page.getByLabel("Layer thickness").fill("0.1");
  await settled(page);
  expect(await layers(page)).toBe(400);
});

test("infeasible settings name the height and offer a way out; the last plan stays", async () => {
  const page = await start();
  await drop(page, ballFile);
  await state(page, "done");
  const count = await layers(page);
  await page.getByLabel("Tolerance", { exact: true }).fill("0.02");
  await state(page, "error");
  const alert = page.getByRole("alert");
  expect(await alert.innerText()).toContain("No plan keeps the tolerance all the way up");
  expect(await alert.innerText()).toMatch(/within 0\.02\smm: from z = [\d.]+ to [\d.]+\smm even a layer of 0\.05\smm exceeds it/);
  expect(await layers(page)).toBe(count);
  expect(await words(page)).toContain("This is the last plan that worked");
  await alert.getByRole("button", { name: "Layers from 0.02 mm" }).click();
  await settled(page);
  expect(await layers(page)).toBeGreaterThan(400);
  expect(await page.getByLabel("Thinnest layer").inputValue()).toBe("0.02");
});

test("by each metric: a plan within its tolerance, in its unit", async () => {
  const page = await start();
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  for (const [name, unit, usual] of [
    ["Step height", "mm", "0.065"],
    ["Deviation", "mm", "0.0325"],
    ["Surface roughness", "mm", "0.1"],
    ["Area deviation", "%", "10"],
    ["Volume deviation", "mm³", null],
  ] as const) {
    await page.getByLabel("Measure errors by").selectOption(name);
    await settled(page);

    // The field shows the tolerance that the core took: the usual one, or more if that was necessary.
    const field = page.getByLabel("Tolerance", { exact: true });
    const tolerance = await field.inputValue();
    if (usual === null) expect(Number(tolerance), name).toBeGreaterThan(1);
    else expect(tolerance, name).toBe(usual);
    expect(await page.locator(".field", { has: field }).locator(".unit").innerText(), name).toBe(unit);

    const own = (await page.locator("tr.own").innerText()).replace(/\s+/g, " ");
    const found = /^This plan (\d+) (?:\d+ h )?\d+ min ([\d.]+) ?(mm³|mm|%) within tolerance$/.exec(own);
    expect(found, `${name}: ${own}`).not.toBeNull();
    expect(found?.[3], name).toBe(unit);
    expect(Number(found?.[2]), name).toBeLessThanOrEqual(Number(tolerance));
    expect(Number(found?.[1]), name).toBe(await layers(page));
    expect(await page.getByRole("slider", { name: "Profile and plan" }).count(), name).toBe(1);
  }
});

test("a tolerance is kept for the metric that it was typed for", async () => {
  const page = await start("?metric=area&tolerance=12");
  await drop(page, ballFile);
  await state(page, "done");
  const field = page.getByLabel("Tolerance", { exact: true });
  const metric = page.getByLabel("Measure errors by");
  expect(await field.inputValue()).toBe("12");
  await metric.selectOption("cusp");
  await settled(page);
  expect(await field.inputValue()).toBe("0.065");
  await metric.selectOption("area");
  await settled(page);
  expect(await field.inputValue()).toBe("12");
  // An empty field leaves the value to the core, and stays empty so that another number can be typed.
  await field.fill("");
  await settled(page);
  expect(await field.inputValue()).toBe("");
  expect(await field.getAttribute("placeholder")).toBe("10");
  expect(await field.getAttribute("aria-invalid")).toBe("false");
});

test.each([
  ["cusp", "?metric=cusp&tolerance=0.02"],
  ["deviation", "?metric=deviation&tolerance=0.01"],
  ["roughness", "?metric=roughness&tolerance=0.06"],
  ["area", "?metric=area&tolerance=5"],
  ["volume", "?metric=volume&tolerance=0.06"],
  ["cusp over bins of 1 µm", "?metric=cusp&tolerance=0.0521&layerMin=0.055"],
  ["cusp in motor steps", "?metric=cusp&tolerance=0.04&step=0.0025"],
  ["area in the least time", "?metric=area&tolerance=7&minimize=time"],
])("where no plan holds, by %s, either offer leads to one that does", async (_, query) => {
  const page = await start(query);
  await drop(page, ballFile);
  await state(page, "error");
  const offers = page.getByRole("alert").getByRole("button", { name: /^(Tolerance|Layers from)/ });
  await offers.first().waitFor();
  const names = await offers.allInnerTexts();
  expect(names.map((name) => name.replace(/ [\d.]+\s?(mm³|mm|%)$/, ""))).toEqual(["Tolerance", "Layers from"]);
  const typed = await page.getByLabel("Tolerance", { exact: true }).inputValue();
  const thinnest = await page.getByLabel("Thinnest layer").inputValue();
  for (const name of names) {
    await page.getByRole("alert").getByRole("button", { name }).click();
    await settled(page);
    expect(await page.locator("tr.own").innerText(), name).toContain("within tolerance");
    // Back to the settings without a plan, for the other offer.
    await page.getByLabel("Tolerance", { exact: true }).fill(typed);
    await page.getByLabel("Thinnest layer").fill(thinnest);
    await state(page, "error");
  }
});

test("more settings: the least time, planes at flats, the motor step", async () => {
  const page = await start();
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  const planes = async (): Promise<number> => {
    const figures = await page.locator("details.figures").evaluate((it) => it.textContent);
    return Number(/Planes at flats\s*(\d+)/.exec(figures)?.[1]);
  };
  expect(await planes()).toBeGreaterThan(0);
  await page.getByText("More settings").click();

  await page.getByText("Off", { exact: true }).click();
  await settled(page);
  expect(await planes()).toBe(0);

  await page.locator("cusp-settings").getByText("Print time", { exact: true }).click();
  await settled(page);
  expect(await words(page)).toMatch(/less time than uniform/);

  await page.getByLabel("Motor step").fill("0.02");
  await settled(page);
  expect(await words(page)).toContain("Uniform 0.06 mm");
  await page.getByLabel("Motor step").fill("0");
  await expect.poll(() => page.getByLabel("Motor step").getAttribute("aria-invalid")).toBe("true");
});

test("the pointer over the chart reads the profile", async () => {
  const page = await start("?metric=volume");
  await drop(page, ballFile);
  await state(page, "done");
  const plot = page.locator(".u-over");
  await plot.hover();
  // The middle of a ball of 10 mm radius.
  const said = page.locator("cusp-chart .foot");
  await expect.poll(() => said.innerText()).toMatch(/At (9\.9|10\.0)\d\d\smm: a section of 31\d(\.\d)?\smm²/);
  await page.mouse.move(0, 0);
  await expect.poll(() => said.innerText()).toContain("Click to see a layer.");
});

test.each([
  ["narrow and light", { viewport: { width: 390, height: 844 } }],
  ["narrow and dark", { viewport: { width: 390, height: 844 }, colorScheme: "dark" as const }],
  ["very narrow", { viewport: { width: 320, height: 640 } }],
  ["wide and dark", { viewport: { width: 1280, height: 900 }, colorScheme: "dark" as const }],
])("nothing sticks out sideways: %s", async (_, options) => {
  const page = await start("", options);
  const overflow = (): Promise<number> =>
    page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(await overflow()).toBe(0);
  await drop(page, { name: `${"a-very-long-name-".repeat(8)}.txt`, bytes: new Uint8Array(1) });
  await state(page, "error");
  expect(await overflow()).toBe(0);
  await drop(page, { name: `${"a-very-long-name-".repeat(8)}.stl`, bytes: ball.bytes });
  await state(page, "done");
  expect(await overflow()).toBe(0);
});

test("the page is forbidden to send anything anywhere", async () => {
  // Not `start`, which fails on the browser's errors: here they are expected.
  const browser = await launch();
  try {
    const { page } = await open(browser, inject("address"));
    const forbidden = await page.evaluate(
      () =>
        new Promise<string>((resolve) => {
          document.addEventListener("securitypolicyviolation", (event) => resolve(event.effectiveDirective), { once: true });
          fetch("http://localhost:9/").catch(() => undefined);
        }),
    );
    expect(forbidden).toBe("connect-src");
  } finally {
    await browser.close();
  }
});
