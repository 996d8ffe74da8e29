/** A first visit and the ones after it: what the page remembers, the tour, and the list of keys. */
import { readFile } from "node:fs/promises";
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { downloaded, drop, layers, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const cube = { name: "small ball.stl", bytes: sphere(5, 24).bytes };

const query = (page: Page): Promise<string> => page.evaluate(() => document.querySelector("cusp-workbench")?.query ?? "");
const isFocused = (locator: Locator): Promise<boolean> => locator.evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === it);

/** The page at another address, with what the browser has kept. */
async function visitAgain(page: Page, address = "."): Promise<void> {
  await page.goto(new URL(address, page.url().replace(/\?.*$/, "")).href);
  await state(page, "empty");
}

test("the printer that a person chose is there at the next visit, its file one click from the drop; what the address asks for wins", async () => {
  const page = await start();
  await drop(page, ball);
  await state(page, "done");
  await page.getByLabel("Printer", { exact: true }).selectOption("saturn-3-ultra");
  await settled(page);
  await page.getByLabel("Tolerance", { exact: true }).fill("0.055");
  await settled(page);
  await visitAgain(page);
  expect(await query(page)).toBe("printer=saturn-3-ultra");
  await drop(page, ball);
  await state(page, "done");
  expect((await downloaded(page)).name).toBe("ball-cusp.goo");
  await visitAgain(page, "?printer=photon-mono-m5s");
  expect(await query(page)).toBe("printer=photon-mono-m5s");
  await visitAgain(page);
  expect(await query(page)).toBe("printer=saturn-3-ultra");

  await page.evaluate(() => localStorage.setItem("cusp.printer", "printer=gone&exposure=3"));
  await visitAgain(page);
  await expect.poll(() => query(page)).toBe("");
  await drop(page, ball);
  await state(page, "done");
});

test("a browser that keeps nothing has all else", async () => {
  const page = await start();
  const script = await page.addInitScript(() => {
    Object.defineProperty(globalThis, "localStorage", { get: () => { throw new DOMException("no", "SecurityError"); } });
    delete (FileSystemFileHandle.prototype as Partial<FileSystemFileHandle>).createWritable;
  });
  await visitAgain(page);
  await drop(page, ball);
  await state(page, "done");
  expect(await page.getByRole("button", { name: "Recent models" }).count()).toBe(0);
  expect(await page.locator("cusp-tour").count()).toBe(0);
  await page.getByRole("button", { name: "Presets" }).click();
  await page.getByLabel("Save the current settings as").fill("Fine");
  await page.getByRole("button", { name: "Save", exact: true }).click();
  expect(await page.locator("cusp-saved").getByRole("status").innerText()).toContain("storage is full or switched off");
  await script.dispose();
});

test("settings are saved, applied, renamed, replaced and deleted by keyboard, and stay clear of the model's own", async () => {
  const page = await start("?tolerance=0.02&height=12");
  const panel = page.locator("cusp-saved");
  const said = panel.getByRole("status");
  const save = async (name: string): Promise<void> => {
    await panel.getByLabel("Save the current settings as").fill(name);
    await page.keyboard.press("Enter");
  };
  await page.getByRole("button", { name: "Presets" }).focus();
  await page.keyboard.press("Enter");
  await save("Fine");
  await expect.poll(() => said.innerText()).toBe("“Fine” saved.");
  await page.evaluate(() => document.querySelector("cusp-workbench")?.setAttribute("tolerance", "0.08"));
  await expect.poll(() => query(page)).toBe("height=12&tolerance=0.08");
  await page.keyboard.press("Escape");
  expect(await panel.isVisible()).toBe(false);
  await page.keyboard.press("Enter");
  await save("coarse");
  expect(await panel.locator(".row").allInnerTexts()).toEqual(["coarse", "Fine"]);
  expect(await panel.getByRole("button", { name: "coarse", exact: true }).getAttribute("aria-current")).toBe("true");
  expect(await broken(page)).toEqual([]);

  await panel.getByRole("button", { name: "Fine", exact: true }).press("Enter");
  expect(await query(page)).toBe("height=12&tolerance=0.02");
  await expect.poll(() => panel.isVisible()).toBe(false);

  await page.getByRole("button", { name: "Presets" }).click();
  await panel.getByRole("button", { name: "Rename “coarse”" }).press("Enter");
  const field = panel.getByRole("textbox", { name: "Rename “coarse”" });
  await expect.poll(() => isFocused(field)).toBe(true);
  await page.keyboard.press("Escape");
  expect(await panel.isVisible()).toBe(true);
  await page.keyboard.press("Enter");
  await page.keyboard.type("Quick");
  await page.keyboard.press("Enter");
  await expect.poll(() => panel.locator(".row").allInnerTexts()).toEqual(["Fine", "Quick"]);
  // Under a name in use, the button says what it does.
  await panel.getByLabel("Save the current settings as").fill("quick");
  await panel.getByRole("button", { name: "Replace" }).click();

  await panel.getByRole("button", { name: "Delete “Fine”" }).press("Enter");
  await expect.poll(() => said.innerText()).toContain("“Fine” deleted.");
  await expect.poll(() => isFocused(panel.getByRole("button", { name: "Undo" }))).toBe(true);
  await page.keyboard.press("Enter");
  expect(await panel.locator(".row").allInnerTexts()).toEqual(["Fine", "quick"]);
  await visitAgain(page);
  await page.getByRole("button", { name: "Presets" }).click();
  await expect.poll(() => panel.locator(".row").allInnerTexts()).toEqual(["Fine", "quick"]);
});

test("settings are saved as a file for the command line, and a link to them is copied, or shown where the browser does not let the page copy", async () => {
  const page = await start("?height=12&tolerance=0.02", { permissions: ["clipboard-read", "clipboard-write"] });
  const panel = page.locator("cusp-saved");
  await page.getByRole("button", { name: "Presets" }).click();
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save as cusp.toml" }).click()]);
  expect(file.suggestedFilename()).toBe("cusp.toml");
  const text = await readFile(await file.path(), "utf8");
  expect(text).toContain("tolerance = 0.02\n");
  // The height is the model's.
  expect(text).not.toContain("height");
  expect(await page.locator("cusp-saved").getByRole("status").innerText()).toBe("cusp.toml saved.");
  await panel.getByRole("button", { name: /^Copy link/ }).click();
  await expect.poll(() => panel.getByRole("status").innerText()).toBe("Link copied.");
  const link = await page.evaluate(() => navigator.clipboard.readText());
  expect(link).toBe(page.url());
  await page.evaluate(() => {
    navigator.clipboard.writeText = () => Promise.reject(new DOMException("no", "NotAllowedError"));
  });
  await panel.getByRole("button", { name: /^Copy link/ }).click();
  const field = panel.getByLabel("Copy this link");
  await expect.poll(() => isFocused(field)).toBe(true);
  expect(await field.inputValue()).toBe(link);
  expect(await broken(page)).toEqual([]);
  // The panel speaks the page's language, also when that changes.
  await page.getByLabel("Language").selectOption("de");
  await panel.getByRole("button", { name: "Link zu diesen Einstellungen kopieren" }).waitFor();
});

/** The files that the page keeps, without their pictures: nothing is drawn here. */
const kept = (page: Page): Promise<string[]> =>
  page.evaluate(async () => {
    const root = await navigator.storage.getDirectory();
    const folder = await root.getDirectoryHandle("recent models").catch(() => null);
    const names: string[] = [];
    if (folder !== null) for await (const name of folder.keys()) if (!name.endsWith(".png")) names.push(name.replace(/^[0-9a-f]+/, "model"));
    return names.sort();
  });

test("models are kept if the person allows it, opened again by keyboard, and deleted when it is switched off", async () => {
  const page = await start();
  const panel = page.locator("#recent cusp-recent");
  const button = page.getByRole("button", { name: "Recent models" });
  await drop(page, ball);
  await state(page, "done");
  expect(await kept(page)).toEqual([]);
  await button.click();
  expect(await broken(page)).toEqual([]);
  // From now on, and the open one.
  await panel.getByRole("checkbox", { name: "Keep models in this browser" }).check();
  await expect.poll(() => kept(page)).toEqual(["index.json", "model"]);
  await drop(page, cube);
  await expect.poll(() => kept(page)).toEqual(["index.json", "model", "model"]);
  await state(page, "done");

  // A page without a model begins with them.
  await visitAgain(page);
  const atStart = page.locator(".recent cusp-recent");
  await atStart.getByRole("button", { name: /^small ball\.stl/ }).waitFor();
  expect(await broken(page)).toEqual([]);
  await atStart.getByRole("button", { name: /^small ball\.stl/ }).press("Enter");
  await state(page, "done");
  expect(await page.evaluate(() => document.querySelector("cusp-workbench")?.model?.name)).toBe("small ball.stl");

  await visitAgain(page);
  // The example is no file of the person's.
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  await button.focus();
  await page.keyboard.press("Enter");
  const names = (list = panel): Promise<string[]> =>
    list.locator(".row span").allInnerTexts().then((all) => all.map((it) => it.split("\n")[0] ?? ""));
  await expect.poll(names).toEqual(["small ball.stl", "ball.stl"]);
  expect(await broken(page)).toEqual([]);
  await panel.getByRole("button", { name: /^ball\.stl/ }).press("Enter");
  await expect.poll(() => page.evaluate(() => document.querySelector("cusp-workbench")?.model?.name)).toBe("ball.stl");
  await state(page, "done");
  expect(await layers(page)).toBeGreaterThan(100);
  expect(await panel.isVisible()).toBe(false);
  await button.click();
  await expect.poll(names).toEqual(["ball.stl", "small ball.stl"]);

  await panel.getByRole("button", { name: "Delete ball.stl" }).press("Enter");
  await expect.poll(names).toEqual(["small ball.stl"]);
  await expect.poll(() => isFocused(panel.getByRole("button", { name: "Delete small ball.stl" }))).toBe(true);
  await panel.getByRole("checkbox").uncheck();
  await expect.poll(() => kept(page)).toEqual([]);
  expect(await panel.getByRole("status").innerText()).toBe("All models deleted from this browser.");
});

test("a store of models that is full or fails keeps none, says so, and slicing goes on", async () => {
  const page = await start("", {}, true);
  const panel = page.locator("#recent cusp-recent");
  const notice = page.locator("#notice");
  await page.getByRole("button", { name: "Recent models" }).click();
  await panel.getByRole("checkbox").check();
  await page.evaluate(() => {
    FileSystemFileHandle.prototype.createWritable = () => Promise.reject(new DOMException("full", "QuotaExceededError"));
  });
  await drop(page, ball);
  await state(page, "done");
  await expect.poll(() => notice.innerText()).toContain("ball.stl was not kept for the next visit");
  expect(await broken(page)).toEqual([]);
  await notice.getByRole("button", { name: "Close" }).click();

  await page.evaluate(() => {
    navigator.storage.getDirectory = () => Promise.reject(new DOMException("no", "UnknownError"));
  });
  await drop(page, cube);
  await state(page, "done");
  await expect.poll(() => notice.innerText()).toContain("small ball.stl was not kept");
  await page.getByRole("button", { name: "Recent models" }).click();
  await panel.getByRole("checkbox").uncheck();
  await expect.poll(() => panel.getByRole("status").innerText()).toContain("storage is full or switched off");
});

test("two tabs share the list of recent models", async () => {
  const page = await start();
  await page.getByRole("button", { name: "Recent models" }).click();
  await page.getByRole("checkbox", { name: "Keep models in this browser" }).check();
  const other = await page.context().newPage();
  await other.goto(page.url());
  await state(other, "empty");
  await Promise.all([drop(other, ball), drop(page, cube)]);
  await page.getByRole("button", { name: "Recent models" }).click();
  await expect.poll(() => page.locator("#recent .row").count()).toBe(2);
  await expect.poll(() => kept(page)).toEqual(["index.json", "model", "model"]);
});

test("the tour is shown on the first visit, takes no focus, and comes again when asked for", async () => {
  const page = await start();
  await page.evaluate(() => localStorage.removeItem("cusp.tour"));
  await page.getByRole("button", { name: "Try the example" }).focus();
  await page.keyboard.press("Enter");
  await state(page, "done");
  const tour = page.getByRole("region", { name: "Short tour" });
  await tour.waitFor();
  expect(await page.evaluate(() => document.querySelector("cusp-workbench")?.shadowRoot?.activeElement?.textContent)).toBe("goblet.stl");
  expect(await broken(page)).toEqual([]);
  for (const title of ["Look at the model", "Step by step"]) {
    expect(await tour.innerText()).toContain(title);
    await tour.getByRole("button", { name: "Next" }).press("Enter");
  }
  expect(await tour.innerText()).toContain("Take the file");
  await tour.getByRole("button", { name: "Done" }).press("Enter");
  expect(await tour.count()).toBe(0);

  await visitAgain(page);
  await drop(page, ball);
  await state(page, "done");
  await page.keyboard.press("?");
  await page.getByRole("button", { name: "Show the tour" }).click();
  await tour.waitFor();
  await page.keyboard.press("Escape");
  expect(await tour.count()).toBe(0);
});

test("on a phone, by touch, cards and panels stay in the window and clear of the bar", async () => {
  const page = await start("?locale=de", { viewport: { width: 390, height: 844 }, hasTouch: true });
  const inside = async (it: Locator): Promise<void> => {
    const { x, y, width, height } = (await it.boundingBox()) ?? { x: -1, y: -1, width: 0, height: 0 };
    expect(Math.min(x, y)).toBeGreaterThanOrEqual(0);
    expect(x + width).toBeLessThanOrEqual(390);
    expect(y + height).toBeLessThanOrEqual(844);
  };
  for (const id of ["recent", "saved"]) {
    await page.locator(`[popovertarget=${id}]`).tap();
    await page.locator(`#${id} .panel`).first().waitFor();
    await inside(page.locator(`#${id}`));
    await page.keyboard.press("Escape");
  }
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(390);

  await page.evaluate(() => localStorage.removeItem("cusp.tour"));
  await page.locator(".offers button").tap();
  await state(page, "done");
  const card = page.locator("cusp-tour .card");
  const bar = await page.locator("cusp-workbench .bar-panels").locator("..").boundingBox();
  for (const step of [1, 2, 3]) {
    await expect.poll(() => card.locator(".quiet").innerText()).toContain(String(step));
    await inside(card);
    const box = await card.boundingBox();
    expect((box?.y ?? 0) + (box?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
    await card.getByRole("button").last().tap();
  }
  await expect.poll(() => card.count()).toBe(0);
});

test("question mark opens the list of keys, except where somebody types and where it is switched off", async () => {
  const page = await start();
  const dialog = page.getByRole("dialog", { name: "Keys" });
  await drop(page, ball);
  await state(page, "done");
  const field = page.getByLabel("Tolerance", { exact: true });
  const typed = await field.inputValue();
  await field.press("End");
  await page.keyboard.press("?");
  expect(await field.inputValue()).toBe(`${typed}?`);
  expect(await dialog.count()).toBe(0);
  await field.fill(typed);
  await settled(page);

  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await slider.focus();
  await page.keyboard.press("?");
  await dialog.waitFor();
  expect(await broken(page)).toEqual([]);
  await page.keyboard.press("Escape");
  expect(await dialog.count()).toBe(0);
  expect(await isFocused(slider)).toBe(true);

  await page.getByRole("button", { name: "Keys" }).click();
  await dialog.getByRole("checkbox", { name: "Open this list with ?" }).uncheck();
  await dialog.getByRole("button", { name: "Close" }).click();
  await page.keyboard.press("?");
  expect(await dialog.count()).toBe(0);
});
