/** Several models on the page: added, counted, arranged, moved, on several plates, and downloaded. */
import { execFile } from "node:child_process";
import { mkdtemp, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import type { Locator, Page } from "playwright-core";
import { expect, inject, test } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { broken } from "./axe.js";
import { choosePrinter, downloaded, drop, dropBeside, openPanel, settled, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { prism, sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const blockFile = { name: "block.stl", bytes: prism(12, 8).bytes };

const start = pages();

/** The names in the list of models. */
const listed = (page: Page): Promise<string[]> => page.locator("cusp-plate .name").allInnerTexts();

const copies = (page: Page, name: string): Locator => page.getByRole("textbox", { name: `Copies of ${name}` });

test("of files that are dropped together the models stand on one plate, and become one print file that can be read", async () => {
  const page = await start();
  await drop(page, { name: "notes.txt", bytes: new Uint8Array(3) }, ballFile, blockFile);
  await state(page, "done");
  // Without a printer the plate has a usual size.
  await expect.poll(() => page.locator(".model").innerText()).toContain("192 × 120");
  await choosePrinter(page, "mars 4 ultra");
  await settled(page);
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await words(page)).toContain("each");
  // The trade-off curve is the plate's, and each model has its findings.
  await page.locator("cusp-quality").waitFor();
  await openPanel(page, "Check");
  expect(await page.locator("cusp-findings .verdict").innerText()).toBeTruthy();
  await openPanel(page, "Slice");
  const file = await downloaded(page);
  expect(file.name).toBe("plate-1-cusp.goo");
  await drop(page, file);
  const view = page.locator("cusp-print");
  await view.locator(".verdict").waitFor();
  const facts = (await view.locator(".facts").innerText()).replaceAll("\u00a0", " ");
  expect(facts).toContain("The file is whole");
  // A ball of 4.19 ml and a block of 1.15 ml.
  expect(facts).toMatch(/5\.3\d ml by the file, 5\.3\d ml by the masks/);
  await page.keyboard.press("Escape");
  await view.waitFor({ state: "detached" });
  // On a phone the models are on the sheet of the result.
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByRole("button", { name: "Show the result" }).click();
  await page.getByText("Models on the plate").waitFor();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await broken(page)).toEqual([]);
});

test("copies are typed and stepped, and fill a second plate, which has a print file of its own", async () => {
  const page = await start("?printer=mars-4-ultra");
  await drop(page, ballFile);
  await state(page, "done");
  await page.getByRole("button", { name: "One more: Copies of ball.stl" }).click();
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  expect(await copies(page, "ball.stl").inputValue()).toBe("2");
  await copies(page, "ball.stl").fill("many");
  await copies(page, "ball.stl").press("Enter");
  expect(await page.locator("cusp-plate").getByRole("alert").innerText()).toBe("Enter a number, 1 to 1,000.");
  expect(await copies(page, "ball.stl").inputValue()).toBe("many");
  expect(await broken(page)).toEqual([]);
  // 153 × 78 mm has room for 20 balls of 20 mm.
  await copies(page, "ball.stl").fill("21");
  await copies(page, "ball.stl").press("Enter");
  await page.getByText("Plate 1 of 2").waitFor();
  await state(page, "done");
  const saved: string[] = [];
  page.on("download", (download) => saved.push(download.suggestedFilename()));
  await page.getByRole("button", { name: "Download all plates" }).click();
  await expect.poll(() => saved).toEqual(["plate-1-cusp.goo", "plate-2-cusp.goo"]);
  await page.getByRole("button", { name: "Next plate" }).click();
  await page.getByText("Plate 2 of 2").waitFor();
  expect((await downloaded(page)).name).toBe("plate-2-cusp.goo");
});

test("a model is added to the open one, which the page keeps from being closed; each has its own pose; removed, the other is as it was alone", async () => {
  const page = await start("?printer=mars-4-ultra&height=8");
  await page.evaluate(() => localStorage.setItem("cusp.work", "off"));
  await drop(page, ballFile);
  await state(page, "done");
  const alone = await downloaded(page);
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByText("Add model").click()]);
  await chooser.setFiles({ name: blockFile.name, mimeType: "model/stl", buffer: Buffer.from(blockFile.bytes) });
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  // Leaving the page would lose the placements, which this browser does not keep, so it asks.
  const [question] = await Promise.all([page.waitForEvent("dialog"), page.close({ runBeforeUnload: true })]);
  expect(question.type()).toBe("beforeunload");
  await question.dismiss();
  await page.locator("cusp-plate .name", { hasText: "ball.stl" }).click();
  await expect.poll(() => page.locator(".model > .figures").first().innerText()).toMatch(/× 8\.0\smm/);
  // The height field applies to the selected model.
  await page.locator("cusp-plate .name", { hasText: "block.stl" }).click();
  await expect.poll(() => page.locator(".model-name").innerText()).toBe("block.stl");
  await state(page, "done");
  await page.getByRole("button", { name: "Remove block.stl" }).click();
  await expect.poll(() => page.locator(".model-name").innerText()).toBe("ball.stl");
  await state(page, "done");
  expect(await page.locator("cusp-plate").count()).toBe(0);
  const again = await downloaded(page);
  expect(again.name).toBe("ball-cusp.goo");
  expect(again.bytes.equals(alone.bytes)).toBe(true);
});


const program = findCusp();

test("a project that is saved gives the same print file in the command line, and the same plate on the page", async (context) => {
  if (program === null) return context.skip("no native cusp: name it in the variable CUSP, or build it in ../target");
  const page = await start();
  await drop(page, ballFile);
  await state(page, "done");
  await page.evaluate(() => Object.assign(document.querySelector("cusp-workbench") ?? {}, { query: "printer=mars-4-ultra&tolerance=0.08&supports=light&wall=1.5&height=9" }));
  await dropBeside(page, blockFile);
  await page.locator("cusp-plate").getByRole("button", { name: /^One more/ }).first().click();
  await settled(page);
  await state(page, "done");
  const print = await downloaded(page);
  const [saved] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save project" }).click()]);
  expect(saved.suggestedFilename()).toBe("ball-project.3mf");
  const path = await saved.path();

  const folder = await mkdtemp(join(inject("scratch"), "project-"));
  const project = { name: "ball-project.3mf", bytes: await readFile(path) };
  await writeFile(join(folder, project.name), project.bytes);
  await promisify(execFile)(program, ["slice", join(folder, project.name), "--allow-floating", "-o", join(folder, "print.goo")]);
  expect((await readFile(join(folder, "print.goo"))).equals(print.bytes)).toBe(true);

  const other = await start();
  await drop(other, project);
  await other.locator("cusp-plate").waitFor();
  await settled(other);
  await state(other, "done");
  expect(await listed(other)).toEqual(["ball.stl", "block.stl"]);
  expect(await other.getByLabel("Printer", { exact: true }).inputValue()).toBe("Elegoo Mars 4 Ultra");
  expect((await downloaded(other)).bytes.equals(print.bytes)).toBe(true);
});
