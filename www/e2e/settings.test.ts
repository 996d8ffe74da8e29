/** Settings as a user changes them: quality, undo, the address, languages, pasting; and the viewer of masks. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { download, drop, layers, maskOf, openPanel, settled, state, words } from "./browser.js";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { LANGUAGES } from "../src/texts/index.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

const ballFile = { name: "ball.stl", bytes: sphere(10, 96).bytes };

async function opened(query = ""): Promise<Page> {
  const page = await start(query);
  await drop(page, ballFile);
  await state(page, "done");
  return page;
}

test("the quality slider goes through the best plans, and says what is gained", async () => {
  const page = await opened();
  const slider = page.getByRole("slider", { name: "Quality" });
  await slider.focus();
  await page.keyboard.press("End");
  await settled(page);
  const fine = await layers(page);
  const said = page.locator("cusp-quality .gain");
  expect((await said.innerText()).replace(/\s+/g, " ")).toMatch(/^Same quality as uniform 0.05 mm, \d+% less time\.$/);
  await page.keyboard.press("Home");
  await settled(page);
  expect(await layers(page)).toBeLessThan(fine);
  expect((await said.innerText()).replace(/\s+/g, " ")).toMatch(/^\d+% less time than uniform 0.05 mm\. The largest step is/);
  expect(Number(await page.getByLabel("Tolerance", { exact: true }).inputValue())).toBeGreaterThan(0.1);
});

test("settings are undone and redone, by button and by keyboard; typing in a field stays the browser's", async () => {
  const page = await opened();
  const field = page.getByLabel("Tolerance", { exact: true });
  const [undo, redo] = [page.getByRole("button", { name: "Undo" }), page.getByRole("button", { name: "Redo" })];
  expect(await undo.isDisabled()).toBe(true);
  await field.fill("0.05");
  await settled(page);
  await page.getByLabel("Measure errors by").selectOption("Area deviation");
  await settled(page);
  await undo.click();
  await settled(page);
  expect(await field.inputValue()).toBe("0.05");
  await page.getByLabel("Measure errors by").focus();
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await field.inputValue()).toBe("0.065");
  await page.keyboard.press("Control+Shift+z");
  await settled(page);
  expect(await field.inputValue()).toBe("0.05");
  await redo.click();
  await settled(page);
  expect(await page.getByLabel("Measure errors by").inputValue()).toBe("area");
  expect(await redo.isDisabled()).toBe(true);
});

test("the address has the settings, so that it gives the same plan again", async () => {
  const page = await opened();
  await page.getByLabel("Scale to height").fill("30");
  await page.getByLabel("Tolerance", { exact: true }).fill("0.055");
  await settled(page);
  const count = await layers(page);
  const { search } = new URL(page.url());
  expect(search).toBe("?height=30&tolerance=0.055");
  const again = await opened(search);
  expect(await layers(again)).toBe(count);
  await again.getByLabel("Scale to height").fill("");
  await again.getByLabel("Tolerance", { exact: true }).fill("0.065");
  await settled(again);
});

test("a model is hollowed by the thickness of its walls, and drained", async () => {
  const page = await opened();
  const report = (): Promise<{ resin_ml: number; layers: number; hollowed?: { void_ml: number; drains: unknown[] } }> =>
    page.evaluate(() => {
      const report = document.querySelector<CuspWorkbench>("cusp-workbench")?.result?.report;
      if (report === undefined) throw new Error("no result");
      return report;
    });
  const solid = await report();
  await openPanel(page, "Hollow");
  expect(await page.locator("cusp-settings").getByLabel("Drain holes").count()).toBe(0);
  await page.getByLabel("Hollow, with walls of").fill("2");
  await settled(page);
  const hollow = await report();
  expect(hollow.layers).toBe(solid.layers);
  expect(hollow.hollowed?.drains).toHaveLength(1);
  expect(solid.resin_ml - hollow.resin_ml).toBeGreaterThan(hollow.hollowed?.void_ml ?? Infinity);
  await page.getByLabel("In the void").selectOption("Lattice of struts");
  await page.locator("cusp-settings").getByLabel("Drain holes").selectOption("None");
  await settled(page);
  const filled = await report();
  expect(filled.resin_ml).toBeGreaterThan(hollow.resin_ml);
  expect(filled.hollowed?.drains).toEqual([]);
  expect(new URL(page.url()).search).toBe("?infill=lattice&drain=none&wall=2");
  await page.getByLabel("Hollow, with walls of").fill("0,2");
  await expect.poll(() => page.getByText("0.4 to 50").count()).toBe(1);
});

test("a model is supported, and stands that much higher", async () => {
  const page = await opened();
  const report = (): Promise<{ resin_ml: number; height_mm: number; supported?: { lift_mm: number; points: unknown[]; support_ml: number } }> =>
    page.evaluate(() => {
      const report = document.querySelector<CuspWorkbench>("cusp-workbench")?.result?.report;
      if (report === undefined) throw new Error("no result");
      return report;
    });
  const size = page.locator("cusp-workbench .model dd").first();
  const [bare, own] = [await report(), await size.innerText()];
  await openPanel(page, "Support");
  await page.getByLabel("Supports").selectOption("Medium");
  await settled(page);
  const supported = await report();
  expect(supported.height_mm - bare.height_mm).toBeCloseTo(5, 6);
  expect(supported.supported?.points.length).toBeGreaterThan(3);
  expect(supported.resin_ml - bare.resin_ml).toBeCloseTo(supported.supported?.support_ml ?? 0, 3);
  expect(await page.getByText("The model prints with supports, not hollowed.").count()).toBe(1);
  // The model itself is as large as before.
  expect(await size.innerText()).toBe(own);
  expect(new URL(page.url()).search).toBe("?supports=medium");
  await page.getByLabel("Supports").selectOption("None");
  await settled(page);
  expect(await report()).toMatchObject({ resin_ml: bare.resin_ml, height_mm: bare.height_mm });
});

test("the page speaks the reader's language, and another when asked", async () => {
  const page = await start("", { locale: "es-MX" });
  expect(await page.title()).toMatch(/^Cusp: capas/);
  await drop(page, ballFile);
  await state(page, "done");
  expect(await words(page)).toMatch(/\d+ ?% menos que uniforme/);
  await page.getByLabel("Idioma").selectOption("中文");
  await expect.poll(() => words(page)).toContain("公差相同");
  expect(await page.locator("html").getAttribute("lang")).toBe("zh");
  expect(new URL(page.url()).search).toBe("?locale=zh");
});

test("a file is pasted", async () => {
  const page = await start();
  await page.evaluate((bytes) => {
    const clipboardData = new DataTransfer();
    clipboardData.items.add(new File([Uint8Array.from(bytes)], "pasted.stl"));
    document.body.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, [...ballFile.bytes]);
  await state(page, "done");
  expect(await page.locator(".model-name").innerText()).toBe("pasted.stl");
});

test("masks are played from below, and stop at the top", async () => {
  const page = await opened("?planner=uniform&uniform=0.15");
  const count = await layers(page);
  await openPanel(page, "Mask");
  const slider = page.getByRole("slider", { name: "Layer", exact: true });
  await slider.fill(String(count - 4));
  await maskOf(page, count - 5);
  await page.getByRole("button", { name: "Play" }).click();
  await maskOf(page, count - 1);
  await expect.poll(() => page.getByRole("button", { name: "Play" }).count()).toBe(1);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => {
    const root = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-mask")?.shadowRoot;
    return Number(root?.querySelector("canvas")?.dataset["layer"]) > 2;
  });
  await page.getByRole("button", { name: "Pause" }).click();
});

test("a mask is zoomed into, to its very pixels, and moved by keyboard", async () => {
  const page = await opened();
  await openPanel(page, "Mask");
  const canvas = page.locator("cusp-mask canvas");
  /** Numbers of white and of grey pixels in the middle row. */
  const row = (): Promise<{ lit: number; grey: number }> =>
    canvas.evaluate((it) => {
      const canvas = it as HTMLCanvasElement;
      const { data } = canvas.getContext("2d")?.getImageData(0, canvas.height >> 1, canvas.width, 1) ?? { data: [] };
      const values = Array.from(data).filter((_, i) => i % 4 === 0);
      return { lit: values.filter((v) => v === 255).length, grey: values.filter((v) => v > 0 && v < 255).length };
    });
  await expect.poll(async () => (await row()).lit).toBeGreaterThan(0);
  for (let i = 0; i < 5; i++) await page.getByRole("button", { name: "Zoom in" }).click();
  expect(await page.locator("cusp-mask .zoom").innerText()).toContain("32 ×");
  const { lit } = await row();
  // A quarter from the left, the rim of the ball is at 1/2 - √3/4 from the top; an arrow key moves by an eighth of the view.
  await canvas.focus();
  for (let i = 0; i < 0.25 * 32 * 8; i++) await page.keyboard.press("ArrowLeft");
  for (let i = 0; i < (Math.sqrt(3) / 4) * 32 * 8; i++) await page.keyboard.press("ArrowUp");
  await expect.poll(async () => (await row()).lit).toBeLessThan(lit);
  expect((await row()).lit).toBeGreaterThan(0);
  expect((await row()).grey).toBe(0);
  await page.keyboard.press("-");
  expect(await page.locator("cusp-mask .zoom").innerText()).toContain("16 ×");
});

test("a printer gives pixels and file; a model too large for it is scaled to fit by a button beside it", async () => {
  const page = await opened("?backend=cpu");
  await page.getByLabel("Printer").selectOption("sl1s");
  await settled(page);
  expect(await page.locator("details.figures").evaluate((it) => it.textContent)).toMatch(/1,620 × 2,560 pixels of 0\.05/);
  expect(await page.getByLabel("Resolution").count()).toBe(0);
  await page.getByLabel("Printer").selectOption("mars-2");
  await settled(page);
  expect(await page.locator("#file").innerText()).toBe(
    "A ChiTuBox zip. The Elegoo Mars 2 reads .ctb: convert it with UVtools first. " +
      "The model prints as it is: no supports, not hollowed.",
  );
  await page.getByLabel("Printer").selectOption("sl1s");
  await settled(page);

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
  const saved = await download(page);
  expect(saved.suggestedFilename()).toBe("ball-cusp.sl1s");
});

test("the printers are listed by maker, and the file of one that takes one thickness is a button away", async () => {
  const page = await opened("?backend=cpu");
  const list = page.getByLabel("Printer", { exact: true });
  const makers = await list.locator("optgroup").evaluateAll((groups) => groups.map((it) => (it as HTMLOptGroupElement).label));
  expect(makers).toEqual(makers.toSorted(new Intl.Collator("en").compare));
  expect(makers).toEqual(expect.arrayContaining(["Anycubic", "Elegoo", "Phrozen", "Prusa"]));
  const saturns = await list.locator("optgroup[label=Elegoo] option").allInnerTexts();
  expect(saturns.indexOf("Saturn 4 Ultra 16K")).toBe(saturns.indexOf("Saturn 4 Ultra 12K") + 1);

  await list.selectOption({ label: "Photon Mono M5s" });
  await settled(page);
  expect(await page.getByLabel("Print file").locator("option").first().innerText()).toBe("The printer’s own");
  expect(await page.locator("#format-hint").innerText()).toBe("Anycubic, to 2023");
  const warning = page.locator(".warning", { hasText: "Anycubic Photon Mono M5s takes one thickness for all layers" });
  const offer = warning.getByRole("button", { name: /^Uniform layers of 0\.\d+ mm \(\d+ layers\)$/ });
  const offered = await offer.innerText();
  await offer.click();
  await settled(page);
  expect(await warning.count()).toBe(0);
  expect(offered).toContain(`(${await layers(page)} layers)`);
  expect(await page.locator("#file").innerText()).toMatch(/^A \.pm5s file\. The Anycubic Photon Mono M5s reads it directly\./);
  expect((await download(page)).suggestedFilename()).toBe("ball-cusp.pm5s");
});

test("a printer of one's own is opened from a file, kept in the address, and stays in the list", async () => {
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

test.each(LANGUAGES)("no list cuts its choice, no label its text, at 260 px: %s", async (locale) => {
  for (const query of ["", "&printer=photon-mono-m5s"]) {
    const page = await start(`?locale=${locale}${query}`);
    await drop(page, ballFile);
    await state(page, "done");
    const form = page.locator("cusp-settings");
    const cut = await form.evaluate((it) => {
      it.style.width = "260px";
      const root = it.shadowRoot;
      const pen = document.createElement("canvas").getContext("2d");
      if (!root || pen === null) throw new Error("there is no form");
      const found: string[] = [];
      for (const select of root.querySelectorAll("select")) {
        const style = getComputedStyle(select);
        pen.font = style.font;
        const room = select.clientWidth - Number.parseFloat(style.paddingInlineStart) - Number.parseFloat(style.paddingInlineEnd);
        if (select.id === "printer" && select.value !== "" && select.title === "") found.push("printer without a title");
        for (const { text, parentElement } of select.options) {
          // A printer's name may be long: it ends in an ellipsis, and the title has all of it.
          if (parentElement?.localName !== "optgroup" && pen.measureText(text).width > room) found.push(text);
        }
      }
      for (const label of root.querySelectorAll<HTMLElement>("label, legend, .hint")) if (label.scrollWidth > label.clientWidth + 1) found.push(label.innerText);
      if (it.scrollWidth > 260) found.push("form");
      return found;
    });
    expect(cut).toEqual([]);
    // Without fonts of its own the page measures in those of the machine; still, what most people change is in sight.
    const label = form.locator("label[for=height]");
    const top = (await form.boundingBox())?.y ?? 0;
    expect(((await label.boundingBox())?.y ?? 0) - top).toBeLessThan(740);
  }
});

test("in forced colours the chosen half and a fault can be told without colour", async () => {
  const page = await start("", {}, true);
  await page.emulateMedia({ forcedColors: "active" });
  await drop(page, ballFile);
  await state(page, "done");
  const form = page.locator("cusp-settings");
  const [chosen, other] = await form.locator(".choice").first().locator("label").evaluateAll((labels) => labels.map((it) => getComputedStyle(it).backgroundColor));
  expect(chosen).not.toBe(other);
  await page.getByLabel("Tolerance", { exact: true }).fill("x");
  await page.getByLabel("Tolerance", { exact: true }).blur();
  await form.locator(".box.wrong").waitFor();
  expect(await form.locator(".box.wrong").evaluate((it) => getComputedStyle(it).outlineStyle)).toBe("solid");
});

test("a nozzle brings the limits of its layers, for filament printers alone", async () => {
  const page = await opened();
  expect(await page.getByLabel("Nozzle").count()).toBe(0);
  await page.getByLabel("Print file", { exact: true }).selectOption("PrusaSlicer (filament)");
  await settled(page);
  const nozzle = page.getByLabel("Nozzle");
  expect(await nozzle.getAttribute("placeholder")).toBe("0.4");
  const before = await layers(page);
  await nozzle.fill("0.8");
  await settled(page);
  expect(await page.getByLabel("Thickest layer").inputValue()).toBe("0.6");
  expect(await layers(page)).toBeLessThan(before);
  await nozzle.fill("3");
  await expect.poll(() => page.locator("#nozzle-hint").innerText()).toContain("0.15 to 2 mm");
});

test("the unit of a file that states none is chosen, and undone", async () => {
  const page = await opened();
  const unit = page.getByLabel("The file is in");
  expect(await unit.inputValue()).toBe("millimeter");
  await unit.selectOption("centimeters");
  await settled(page);
  await expect.poll(() => words(page)).toContain("200.0 × 200.0 × 200.0 mm");
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await unit.inputValue()).toBe("millimeter");
});
