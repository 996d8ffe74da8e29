/** A first visit and later ones: remembered settings, the tour, and the list of keys. */
import { readFile } from "node:fs/promises";
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { choosePrinter, drop, dropBeside, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const cube = { name: "small ball.stl", bytes: sphere(5, 24).bytes };

const query = (page: Page): Promise<string> => page.evaluate(() => document.querySelector("cusp-workbench")?.query ?? "");
const isFocused = (locator: Locator): Promise<boolean> => locator.evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === it);

/** Opens another URL of the page, with the browser's stored data. */
async function visitAgain(page: Page, address = "."): Promise<void> {
  await page.goto(new URL(address, page.url().replace(/\?.*$/, "")).href);
  await state(page, "empty");
}

test("the printer that a person chose is there at the next visit; what the address asks for wins", async () => {
  const page = await start();
  await choosePrinter(page, "saturn 3 ultra");
  await visitAgain(page);
  expect(await query(page)).toBe("printer=saturn-3-ultra");
  await visitAgain(page, "?printer=photon-mono-m5s");
  expect(await query(page)).toBe("printer=photon-mono-m5s");
});

test("a browser that keeps nothing has all else", async () => {
  const page = await start("?rays=512");
  const script = await page.addInitScript(() => {
    Object.defineProperty(globalThis, "localStorage", { get: () => { throw new DOMException("no", "SecurityError"); } });
    delete (FileSystemFileHandle.prototype as Partial<FileSystemFileHandle>).createWritable;
  });
  await visitAgain(page);
  await drop(page, ball);
  await state(page, "done");
  expect(await page.getByRole("button", { name: "Recent work" }).count()).toBe(0);
  expect(await page.locator("cusp-tour").count()).toBe(0);
  await page.getByRole("button", { name: "Presets" }).click();
  await page.getByLabel("Save the current settings as").fill("Fine");
  await page.getByRole("button", { name: "Save", exact: true }).click();
  expect(await page.locator("cusp-saved").getByRole("status").innerText()).toContain("storage is full or switched off");
  await script.dispose();
});

test("settings are saved, applied, renamed and deleted by keyboard, saved as a file for the command line, and a link to them is copied", async () => {
  const page = await start("?height=12&tolerance=0.02");
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
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
  await expect.poll(() => panel.locator(".row").allInnerTexts()).toEqual(["coarse", "Fine"]);
  await expect.poll(() => panel.getByRole("button", { name: "coarse", exact: true }).getAttribute("aria-current")).toBe("true");
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
  await panel.getByRole("button", { name: "Delete “Fine”" }).press("Enter");
  await expect.poll(() => said.innerText()).toContain("“Fine” deleted.");
  await expect.poll(() => isFocused(panel.getByRole("button", { name: "Undo" }))).toBe(true);
  await page.keyboard.press("Enter");
  expect(await panel.locator(".row").allInnerTexts()).toEqual(["Fine", "Quick"]);
  await visitAgain(page, "?height=12&tolerance=0.02");
  await page.getByRole("button", { name: "Presets" }).click();
  await expect.poll(() => panel.locator(".row").allInnerTexts()).toEqual(["Fine", "Quick"]);

  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save as cusp.toml" }).click()]);
  expect(file.suggestedFilename()).toBe("cusp.toml");
  const text = await readFile(await file.path(), "utf8");
  expect(text).toContain("tolerance = 0.02\n");
  // The height is the model's.
  expect(text).not.toContain("height");
  expect(await said.innerText()).toBe("cusp.toml saved.");
  await panel.getByRole("button", { name: /^Copy link/ }).click();
  await expect.poll(() => said.innerText()).toBe("Link copied.");
  const link = await page.evaluate(() => navigator.clipboard.readText());
  expect(link).toBe(page.url());
  await page.evaluate(() => {
    navigator.clipboard.writeText = () => Promise.reject(new DOMException("no", "NotAllowedError"));
  });
  await panel.getByRole("button", { name: /^Copy link/ }).click();
  const shown = panel.getByLabel("Copy this link");
  await expect.poll(() => isFocused(shown)).toBe(true);
  expect(await shown.inputValue()).toBe(link);
  // The panel uses the page's language, and follows its changes.
  await page.getByLabel("Language").selectOption("de");
  await panel.getByRole("button", { name: "Link zu diesen Einstellungen kopieren" }).waitFor();
});

/** Files kept by the page, without their pictures, which need drawing. */
const kept = (page: Page): Promise<string[]> =>
  page.evaluate(async () => {
    const root = await navigator.storage.getDirectory();
    const folder = await root.getDirectoryHandle("recent work").catch(() => null);
    const names: string[] = [];
    if (folder !== null) for await (const name of folder.keys()) if (!name.endsWith(".png")) names.push(name.replace(/^[0-9a-f]{32}$/, "file"));
    return names.sort();
  });

test("work is kept, continued by keyboard at the next visit with supports, copies and placements, and deleted when that is switched off", async () => {
  const page = await start("?rays=512");
  const panel = page.locator("#recent cusp-recent");
  const button = page.getByRole("button", { name: "Recent work" });
  await drop(page, ball);
  await expect.poll(() => kept(page)).toEqual(["file", "index.json"]);
  await state(page, "done");
  await page.evaluate(() => Object.assign(document.querySelector("cusp-workbench") ?? {}, { query: "printer=mars-4-ultra&supports=light&height=8&points=0,0,0,,1" }));
  await dropBeside(page, cube);
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  await page.locator("cusp-plate").getByRole("button", { name: /^One more/ }).first().click();
  await state(page, "done");
  await settled(page);
  const work = (): Promise<unknown> =>
    page.evaluate(() => {
      const element = document.querySelector("cusp-workbench");
      return { query: element?.query, models: element?.models.map(({ name, own }) => ({ name, own })) };
    });
  const before = await work();
  await expect.poll(() => kept(page)).toEqual(["file", "file", "index.json"]);
  // All of it is kept, so that the page closes without a question.
  await page.waitForTimeout(1500);
  expect(await page.evaluate(() => window.dispatchEvent(new Event("beforeunload", { cancelable: true })))).toBe(true);

  await visitAgain(page);
  const offer = page.locator(".recent cusp-recent");
  await offer.getByRole("button", { name: /^ball\.stl and 1 more/ }).waitFor();
  expect(await broken(page), "without a model").toEqual([]);
  await offer.getByRole("button", { name: /^ball\.stl and 1 more/ }).press("Enter");
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  expect(await work()).toEqual(before);

  // The example is not a file of the user. Other work is listed beside the first.
  await visitAgain(page);
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  await drop(page, cube);
  await state(page, "done");
  await button.focus();
  await page.keyboard.press("Enter");
  const names = (list = panel): Promise<string[]> =>
    list.locator(".row span").allInnerTexts().then((all) => all.map((it) => it.split("\n")[0] ?? ""));
  await expect.poll(names).toEqual(["small ball.stl", "ball.stl and 1 more"]);
  expect(await broken(page)).toEqual([]);
  await panel.getByRole("button", { name: "Delete ball.stl and 1 more" }).press("Enter");
  await expect.poll(names).toEqual(["small ball.stl"]);
  await expect.poll(() => isFocused(panel.getByRole("button", { name: "Delete small ball.stl" }))).toBe(true);
  await panel.getByRole("checkbox").uncheck();
  await expect.poll(() => kept(page)).toEqual([]);
  expect(await panel.getByRole("status").innerText()).toBe("All work deleted from this browser.");
});

test("a store that is full or fails keeps nothing, says so once, and slicing goes on", async () => {
  const page = await start();
  const panel = page.locator("#recent cusp-recent");
  const notice = page.locator("#notice");
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
  await page.waitForTimeout(1500);
  expect(await notice.count()).toBe(0);
  await page.getByRole("button", { name: "Recent work" }).click();
  await panel.getByRole("checkbox").uncheck();
  await expect.poll(() => panel.getByRole("status").innerText()).toContain("storage is full or switched off");
});

test("question mark opens the list of keys and the tour, except where somebody types and where it is switched off", async () => {
  const page = await start("?rays=512");
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

  await page.keyboard.press("?");
  await page.getByRole("button", { name: "Show the tour" }).click();
  const tour = page.getByRole("region", { name: "Short tour" });
  await tour.waitFor();
  await page.keyboard.press("Escape");
  expect(await tour.count()).toBe(0);
  await page.getByRole("button", { name: "Keys" }).click();
  await dialog.getByRole("checkbox", { name: "Open this list with ?" }).uncheck();
  await dialog.getByRole("button", { name: "Close" }).click();
  await page.keyboard.press("?");
  expect(await dialog.count()).toBe(0);
});
