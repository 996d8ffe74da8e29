/** Settings as a user changes them: the plan follows, invalid ones are explained, and the URL has them. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { fetchLanguage, languageOf } from "../src/texts/index.js";
import { choosePrinter, download, drop, layers, settled, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };

async function opened(query = "?rays=512"): Promise<Page> {
  const page = await start(query);
  await drop(page, ballFile);
  await state(page, "done");
  return page;
}

test("settings plan again by themselves, are explained where they make no sense, undone, and in the address", async () => {
  const page = await opened();
  const usual = await layers(page);
  const field = page.getByLabel("Tolerance", { exact: true });
  const metric = page.getByLabel("Measure errors by");
  expect(await page.getByRole("button", { name: "Undo" }).isDisabled()).toBe(true);

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
  expect(new URL(page.url()).search).toBe("?rays=512&height=30&tolerance=0.055");

  await metric.selectOption("Volume deviation");
  await settled(page);
  // The field shows the tolerance chosen by the core, in the metric's unit.
  const tolerance = await field.inputValue();
  expect(await page.locator(".field", { has: field }).locator(".unit").innerText()).toBe("mm³");
  const own = (await page.locator("tr.own").innerText()).replace(/\s+/g, " ");
  const found = /^This plan (\d+) (?:\d+ h )?\d+ min ([\d.]+) ?mm³ within tolerance$/.exec(own);
  expect(Number(found?.[2]), own).toBeLessThanOrEqual(Number(tolerance));
  expect(Number(found?.[1])).toBe(await layers(page));
  await metric.focus();
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await layers(page)).toBe(tall);
  expect(await field.inputValue()).toBe("0.055");
});

test("an overcure puts undersides where the model has them, and the result says how far off they are", async () => {
  const page = await opened("?rays=512&overcure=0.02&retained=0.9");
  await page.locator("details.figures > summary").click();
  const undersides = /([\d.]+) mm off on average, ([\d.]+) mm at most \(([\d.]+) mm without compensation\)/;
  await expect.poll(() => words(page)).toMatch(undersides);
  const [, mean, largest, before] = (undersides.exec(await words(page)) ?? []).map(Number) as [number, number, number, number];
  expect(before).toBeGreaterThan(0.1);
  expect(largest).toBeLessThan(before);
  expect(mean).toBeLessThan(0.04);
  // Its fields are in the address, so that they show.
  const retained = page.getByLabel("Retained dose");
  expect(await retained.inputValue()).toBe("0.9");
  await page.getByLabel("Print-through: overcure").fill("");
  await settled(page);
  expect(await retained.count()).toBe(0);
  expect(await words(page)).not.toMatch(undersides);
});

test("where no plan holds the model is shown all the same, and why, and an offer leads out; later the last plan stays", async () => {
  const page = await start("?rays=512&tolerance=0.01");
  await drop(page, ballFile);
  await state(page, "error");
  await page.waitForSelector("cusp-view");
  const alert = page.locator(".stage").getByRole("alert");
  expect(await alert.innerText()).toContain("No plan keeps the tolerance all the way up");
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

test("a printer gives pixels and file, and what it cannot do a button beside it mends; one of one's own comes from a file and stays in address and list", async () => {
  const page = await opened("?backend=cpu&rays=512");
  const list = page.getByLabel("Printer", { exact: true });
  await choosePrinter(page, "sl1s");
  await settled(page);
  await page.locator("details.figures summary").click();
  await expect.poll(() => page.locator("details.figures").evaluate((it) => it.textContent)).toMatch(/1,620 × 2,560 pixels of 0\.05/);
  expect(await page.getByLabel("Resolution").count()).toBe(0);
  await page.getByLabel("Scale to height").fill("120");
  await state(page, "error");
  const problem = page.getByRole("alert");
  expect(await problem.innerText()).toContain("The model is too large for this printer");
  await problem.getByRole("button", { name: /^Scale to 80\.\d mm$|^Scale to 81 mm$/ }).click();
  await expect.poll(async () => Number(await page.getByLabel("Scale to height").inputValue())).toBeLessThanOrEqual(81);
  // A smaller model is quicker to plan.
  await page.getByLabel("Scale to height").fill("10");
  await settled(page);
  // Its format has one thickness for all layers, so they are uniform; an adaptive plan is possible, but has no file.
  const given = page.getByText(/takes one thickness for all layers, so they are uniform: \d+ instead of \d+\./);
  await given.waitFor();
  await page.getByText("Adaptive", { exact: true }).click();
  await settled(page);
  expect(await given.count()).toBe(0);
  await page.getByRole("button", { name: /Download print file/ }).click();
  await state(page, "error");
  await problem.getByRole("button", { name: /^Uniform layers of 0\.\d+ mm \(\d+ layers\)$/ }).click();
  await settled(page);
  expect(await page.locator("#file").innerText()).toContain("The Prusa SL1S SPEED reads it directly.");
  expect((await download(page)).suggestedFilename()).toBe("ball-cusp.sl1s");

  const open = async (text: string): Promise<void> => {
    await choosePrinter(page, "none of these");
    await page.locator("cusp-settings input[type=file]").setInputFiles({ name: "big.json", mimeType: "application/json", buffer: Buffer.from(text) });
  };
  await open("solid");
  await state(page, "error");
  expect(await problem.innerText()).toContain("This file does not describe a printer in JSON");
  // A refused printer replaces nothing.
  const mine = { model: "Big One", pixels: [2000, 1000], pitch_um: [60, 60], volume_mm: [120, 60, 200], format: "goo", reads: ["goo"] };
  await open(JSON.stringify({ ...mine, step_mm: -1 }));
  await expect.poll(() => problem.innerText()).toContain("The description of the printer big has an invalid step_mm; correct it.");
  expect(await page.evaluate(() => document.querySelector("cusp-workbench")?.printer)).toBe("sl1s");
  await open(JSON.stringify(mine));
  await settled(page);
  expect(await list.inputValue()).toBe("Big One");
  expect(await page.locator("#printer-hint").innerText()).toMatch(/^Big One: 2,000 × 1,000 pixels of 60\u00a0µm/);
  const count = await layers(page);
  await choosePrinter(page, "elegoo saturn 3");
  await settled(page);
  await list.click();
  await page.getByRole("option", { name: "Big One" }).click();
  await settled(page);
  // The URL reproduces the plan.
  const again = await opened(new URL(page.url()).search);
  expect(await again.getByLabel("Printer", { exact: true }).inputValue()).toBe("Big One");
  expect(await layers(again)).toBe(count);
});

test("numbers are typed with units, in the language's decimals; the field is tidied when it is left", async () => {
  const page = await opened("?rays=512&locale=de");
  const field = page.getByLabel("Toleranz", { exact: true });
  expect(await field.inputValue()).toBe("0,065");
  expect(await page.getByLabel("Auf Höhe skalieren").getAttribute("placeholder")).toBe("20,0");

  await field.fill("");
  await field.pressSequentially("55");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.type("_");
  await page.keyboard.press("Backspace");
  // The caret stays between the digits, and the text as typed.
  await page.keyboard.type("0");
  expect(await field.inputValue()).toBe("505");
  await field.fill("55 µm");
  await settled(page);
  expect(await field.inputValue()).toBe("55 µm");
  expect(new URL(page.url()).search).toContain("tolerance=0.055");
  await field.blur();
  expect(await field.inputValue()).toBe("0,055");

  // Unreadable input stays, with an explanation.
  await field.fill("1.000");
  await field.blur();
  await expect.poll(() => page.locator("#tolerance-hint").innerText()).toBe("Geben Sie die Zahl ohne Tausendertrennzeichen ein.");
  expect(await field.inputValue()).toBe("1.000");
  // Changes from elsewhere show in the field, even while it has the focus.
  await field.focus();
  await page.evaluate(() => {
    const element = document.querySelector<CuspWorkbench>("cusp-workbench");
    if (element !== null) element.query = "tolerance=0,05";
  });
  await expect.poll(() => field.inputValue()).toBe("0,05");
});

test("the page speaks a language by choice or because the browser does, whatever the browser's language is called", async () => {
  // WebKit's language is "C" if LANG is, which is not a valid language tag.
  const before = (): void => {
    Object.defineProperties(Navigator.prototype, { language: { get: () => "C" }, languages: { get: () => ["C"] } });
  };
  const page = await start("?rays=512", { before });
  await drop(page, ballFile);
  await state(page, "done");
  await page.waitForSelector("cusp-chart .plot canvas");
  expect(await page.locator("html").getAttribute("lang")).toBe("en");
  await fetchLanguage("zh");
  await page.locator("select", { has: page.locator("option[lang=de]") }).selectOption("zh");
  await expect.poll(() => words(page)).toContain(languageOf("zh").texts.plan.download);
  expect((await page.locator("html").getAttribute("lang"))?.slice(0, 2)).toBe("zh");
  expect(new URL(page.url()).searchParams.get("locale")).toBe("zh");
  const mexican = await start("", { locale: "es-MX" });
  expect(await mexican.title()).toMatch(/^Cusp: capas/);
});
