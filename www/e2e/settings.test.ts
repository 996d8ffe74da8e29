/** Settings as a user changes them: the plan follows, what cannot be is explained, and the address has them. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { fetchLanguage, languageOf, LANGUAGES } from "../src/texts/index.js";
import { download, drop, layers, settled, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };

async function opened(query = ""): Promise<Page> {
  const page = await start(query);
  await drop(page, ballFile);
  await state(page, "done");
  return page;
}

test("settings plan again by themselves, are explained where they make no sense, undone, and in the address", async () => {
  const page = await opened("?rays=512");
  const usual = await layers(page);
  const field = page.getByLabel("Tolerance", { exact: true });
  const metric = page.getByLabel("Measure errors by");
  const [undo, redo] = [page.getByRole("button", { name: "Undo" }), page.getByRole("button", { name: "Redo" })];
  expect(await undo.isDisabled()).toBe(true);

  await field.fill("55");
  await expect.poll(() => field.getAttribute("aria-invalid")).toBe("true");
  expect(await page.locator("#tolerance-hint").innerText()).toContain("55 µm is 0.055 mm");
  expect(await layers(page)).toBe(usual);
  await field.fill("0.055");
  await settled(page);
  const fine = await layers(page);
  expect(fine).toBeGreaterThan(usual);
  await page.getByLabel("Scale to height").fill("30");
  await settled(page);
  expect(await words(page)).toContain("30.0 × 30.0 × 30.0 mm");
  const tall = await layers(page);
  const { search } = new URL(page.url());
  expect(search).toBe("?rays=512&height=30&tolerance=0.055");

  await page.getByText("Uniform", { exact: true }).click();
  await page.getByLabel("Layer thickness").fill("0.1");
  await settled(page);
  expect(await layers(page)).toBe(300);
  await undo.click();
  await settled(page);
  await metric.focus();
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await layers(page)).toBe(tall);
  await page.keyboard.press("Control+Shift+z");
  await redo.click();
  await settled(page);
  expect(await layers(page)).toBe(300);
  expect(await redo.isDisabled()).toBe(true);

  // The address gives the same plan again.
  expect(await layers(await opened(search))).toBe(tall);
});

test("by each metric: a plan within its tolerance, in its unit, and a tolerance is kept for the metric that it was typed for", async () => {
  const page = await opened("?rays=512&metric=area&tolerance=12");
  const field = page.getByLabel("Tolerance", { exact: true });
  expect(await field.inputValue()).toBe("12");
  for (const [name, unit, usual] of [
    ["Step height", "mm", "0.065"],
    ["Deviation", "mm", "0.0325"],
    ["Surface roughness", "mm", "0.1"],
    ["Area deviation", "%", "12"],
    ["Volume deviation", "mm³", null],
  ] as const) {
    await page.getByLabel("Measure errors by").selectOption(name);
    await settled(page);
    // The field shows the tolerance that the core took: the usual one, or more if that was necessary.
    const tolerance = await field.inputValue();
    if (usual === null) expect(Number(tolerance), name).toBeGreaterThan(0);
    else expect(tolerance, name).toBe(usual);
    expect(await page.locator(".field", { has: field }).locator(".unit").innerText(), name).toBe(unit);
    const own = (await page.locator("tr.own").innerText()).replace(/\s+/g, " ");
    const found = /^This plan (\d+) (?:\d+ h )?\d+ min ([\d.]+) ?(mm³|mm|%) within tolerance$/.exec(own);
    expect(found?.[3], `${name}: ${own}`).toBe(unit);
    expect(Number(found?.[2]), name).toBeLessThanOrEqual(Number(tolerance));
    expect(Number(found?.[1]), name).toBe(await layers(page));
  }
});

test("where no plan holds the model is shown all the same, and why, and an offer leads out; later the last plan stays", async () => {
  const page = await start("?rays=512&tolerance=0.01");
  await drop(page, ballFile);
  await state(page, "error");
  await page.waitForSelector("cusp-view");
  const alert = page.locator(".stage").getByRole("alert");
  expect(await alert.innerText()).toContain("No plan keeps the tolerance all the way up");
  // Another plan with the same settings would fail in the same way.
  await alert.getByRole("button", { name: "Close" }).click();
  expect(await page.getByRole("button", { name: "Plan the layers" }).count()).toBe(0);
  await page.getByLabel("Tolerance", { exact: true }).fill("0.011");
  await state(page, "error");
  await alert.getByRole("button", { name: /^Tolerance/ }).click();
  await settled(page);
  const count = await layers(page);
  expect(count).toBeGreaterThan(134);

  await page.getByLabel("Tolerance", { exact: true }).fill("0.02");
  await state(page, "error");
  const beside = page.getByRole("alert");
  expect(await beside.innerText()).toMatch(/within 0\.02\smm: from z = [\d.]+ to [\d.]+\smm even a layer of 0\.05\smm exceeds it/);
  expect(await layers(page)).toBe(count);
  expect(await words(page)).toContain("This is the last plan that worked");
  await beside.getByRole("button", { name: "Layers from 0.02 mm" }).click();
  await settled(page);
  expect(await layers(page)).toBeGreaterThan(400);
  expect(await page.getByLabel("Thinnest layer").inputValue()).toBe("0.02");
});

test("the quality slider goes through the best plans, and says what is gained", async () => {
  const page = await opened();
  const slider = page.getByRole("slider", { name: "Quality" });
  await slider.focus();
  await page.keyboard.press("End");
  await settled(page);
  const fine = await layers(page);
  const said = page.locator("cusp-quality .gain");
  expect((await said.innerText()).replace(/\s+/g, " ")).toMatch(/^\d+% less time than the quickest uniform layers within tolerance \(0.05\d* mm, /);
  await page.keyboard.press("Home");
  await settled(page);
  expect(await layers(page)).toBeLessThan(fine);
  expect((await said.innerText()).replace(/\s+/g, " ")).toMatch(/^\d+% less time than the quickest uniform layers within tolerance \(0.\d+ mm, /);
  expect(Number(await page.getByLabel("Tolerance", { exact: true }).inputValue())).toBeGreaterThan(0.1);
});

test("printers are listed by maker; one gives pixels and file, and what it cannot do a button beside it mends", async () => {
  const page = await opened("?backend=cpu");
  const list = page.getByLabel("Printer", { exact: true });
  const makers = await list.locator("optgroup").evaluateAll((groups) => groups.map((it) => (it as HTMLOptGroupElement).label));
  expect(makers).toEqual(makers.toSorted(new Intl.Collator("en").compare));
  expect(makers).toEqual(expect.arrayContaining(["Anycubic", "Elegoo", "Phrozen", "Prusa"]));

  await list.selectOption("sl1s");
  await settled(page);
  expect(await page.locator("details.figures").evaluate((it) => it.textContent)).toMatch(/1,620 × 2,560 pixels of 0\.05/);
  expect(await page.getByLabel("Resolution").count()).toBe(0);
  await page.getByLabel("Scale to height").fill("120");
  await state(page, "error");
  const problem = page.getByRole("alert");
  expect(await problem.innerText()).toContain("The model is too large for this printer");
  await problem.getByRole("button", { name: /^Scale to 80\.\d mm$|^Scale to 81 mm$/ }).click();
  await settled(page);
  expect(Number(await page.getByLabel("Scale to height").inputValue())).toBeLessThanOrEqual(81);

  // Its own file has one thickness for all layers, unlike an adaptive plan.
  await page.getByLabel("Scale to height").fill("10");
  await settled(page);
  await page.getByRole("button", { name: /Download print file/ }).click();
  await state(page, "error");
  await problem.getByRole("button", { name: /^Uniform layers of 0\.\d+ mm \(\d+ layers\)$/ }).click();
  await settled(page);
  expect(await page.locator("#file").innerText()).toContain("The Prusa SL1S SPEED reads it directly.");
  expect((await download(page)).suggestedFilename()).toBe("ball-cusp.sl1s");

  // Another takes one thickness whatever its file can hold, and says so before the file is made.
  await list.selectOption({ label: "Photon Mono M5s" });
  await page.getByText("Adaptive", { exact: true }).click();
  await settled(page);
  const warning = page.locator(".warning", { hasText: "Anycubic Photon Mono M5s takes one thickness for all layers" });
  await warning.getByRole("button", { name: /^Uniform layers of 0\.\d+ mm \(\d+ layers\)$/ }).click();
  await settled(page);
  expect(await warning.count()).toBe(0);
  expect((await download(page)).suggestedFilename()).toBe("ball-cusp.pm5s");
});

test("a printer of one's own is opened from a file, kept in the address, and stays in the list; one that is refused changes nothing", async () => {
  const page = await opened("?backend=cpu");
  const list = page.getByLabel("Printer", { exact: true });
  const open = async (name: string, text: string): Promise<void> => {
    await list.selectOption("Own printer…");
    await page.locator("cusp-settings input[type=file]").setInputFiles({ name, mimeType: "application/json", buffer: Buffer.from(text) });
  };
  const problem = page.getByRole("alert");
  const mine = { model: "Big One", pixels: [2000, 1000], pitch_um: [60, 60], volume_mm: [120, 60, 200], format: "goo", reads: ["goo"] };

  await list.selectOption("Own printer…");
  expect(await page.locator("#printer-hint").innerText()).toBe("A JSON file with at least pixels, pitch_um and volume_mm.");
  expect(await page.getByLabel("Open its description").count()).toBe(1);

  await open("big.json", "solid");
  await state(page, "error");
  expect(await problem.innerText()).toContain("This file does not describe a printer in JSON");
  await open("big.json", JSON.stringify({ ...mine, volume_mm: undefined }));
  await expect.poll(() => problem.innerText()).toContain("missing field `volume_mm`");
  await open("big.json", JSON.stringify({ ...mine, step_mm: -1 }));
  await expect.poll(() => problem.innerText()).toContain("The printer big cannot have this step_mm; correct its description.");
  await open("big.json", JSON.stringify({ ...mine, note: "x".repeat(64_000) }));
  await expect.poll(() => problem.innerText()).toContain("A printer’s description has at most 64,000 bytes");
  expect(await page.evaluate(() => [document.querySelector("cusp-workbench")?.printer, localStorage.getItem("cusp.printer")])).toEqual(["", null]);
  await open("big.json", JSON.stringify(mine));
  await settled(page);
  expect(await list.locator("option:checked").innerText()).toBe("Big One");
  expect(await page.locator("#printer-hint").innerText()).toMatch(/^Big One: 2,000 × 1,000 pixels of 60\u00a0µm/);
  expect(await page.locator("#file").innerText()).toMatch(/^A \.goo file\. The Big One reads it directly\./);
  const count = await layers(page);

  await list.selectOption("saturn-3");
  await settled(page);
  await list.selectOption("Big One");
  await settled(page);
  expect(await list.locator("option:checked").innerText()).toBe("Big One");
  const again = await opened(new URL(page.url()).search);
  expect(await again.getByLabel("Printer", { exact: true }).locator("option:checked").innerText()).toBe("Big One");
  expect(await layers(again)).toBe(count);
});

test("numbers are typed with units, in the language's decimals; the field is tidied when it is left", async () => {
  const page = await start("?locale=de");
  await drop(page, ballFile);
  await state(page, "done");
  const field = page.getByLabel("Toleranz", { exact: true });
  const search = (): string => new URL(page.url()).search;
  expect(await field.inputValue()).toBe("0,065");
  expect(await page.getByLabel("Auf Höhe skalieren").getAttribute("placeholder")).toBe("20,0");
  await field.fill("");
  await settled(page);
  expect(await field.getAttribute("placeholder")).toBe("0,065");

  await field.pressSequentially("55");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.type("_");
  await page.keyboard.press("Backspace");
  // The caret stays between the digits, and the text as it was typed.
  await page.keyboard.type("0");
  expect(await field.inputValue()).toBe("505");
  await field.fill("55 µm");
  await settled(page);
  expect(await field.inputValue()).toBe("55 µm");
  expect(search()).toContain("tolerance=0.055");
  await field.blur();
  expect(await field.inputValue()).toBe("0,055");

  // What cannot be read stays, and says why.
  const words = page.locator("#tolerance-hint");
  for (const [typed, said] of [
    ["5 s", "Dieses Feld nimmt mm, µm, cm, in oder thou."],
    ["1.000", "Geben Sie die Zahl ohne Tausendertrennzeichen ein."],
  ] as const) {
    await field.fill(typed);
    await field.blur();
    await expect.poll(() => words.innerText()).toBe(said);
    expect(await field.inputValue()).toBe(typed);
  }
  // Whatever changes the setting from elsewhere shows in the field, even while it has the focus.
  await field.focus();
  await page.evaluate(() => {
    const element = document.querySelector<CuspWorkbench>("cusp-workbench");
    if (element !== null) element.query = "tolerance=0,05";
  });
  await expect.poll(() => field.inputValue()).toBe("0,05");

  const exposure = page.getByLabel("Belichtung", { exact: true });
  expect(await exposure.getAttribute("placeholder")).toBe("3");
  await exposure.fill("2500 ms");
  await exposure.blur();
  expect(await exposure.inputValue()).toBe("2,5");
  await settled(page);
  expect(search()).toContain("exposure=2.5");
});

test("the page speaks every language, by choice or because the browser does, whatever the browser's language is called", async () => {
  // WebKit's is "C" if LANG is, which is no tag of a language.
  const before = (): void => {
    Object.defineProperties(Navigator.prototype, { language: { get: () => "C" }, languages: { get: () => ["C"] } });
  };
  const page = await start("?rays=512", { before });
  await drop(page, ballFile);
  await state(page, "done");
  await page.waitForSelector("cusp-chart .plot canvas");
  expect(await page.locator("html").getAttribute("lang")).toBe("en");
  for (const code of LANGUAGES) {
    await fetchLanguage(code);
    await page.locator("select", { has: page.locator("option[lang=de]") }).selectOption(code);
    await expect.poll(() => words(page)).toContain(languageOf(code).texts.plan.download);
    expect((await page.locator("html").getAttribute("lang"))?.slice(0, 2)).toBe(code);
  }
  expect(new URL(page.url()).searchParams.get("locale")).toBe(LANGUAGES.at(-1));
  const mexican = await start("", { locale: "es-MX" });
  expect(await mexican.title()).toMatch(/^Cusp: capas/);
});
