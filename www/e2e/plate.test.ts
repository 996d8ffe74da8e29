/** Several models on the page: added, counted, arranged, moved, on several plates, and downloaded. */
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspView } from "../src/view/cusp-view.js";
import { broken } from "./axe.js";
import { downloaded, drop, openPanel, settled, SOFTWARE_GL, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { prism, sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const blockFile = { name: "block.stl", bytes: prism(12, 8).bytes };

const start = pages(SOFTWARE_GL);

/** The names in the list of models. */
const listed = (page: Page): Promise<string[]> => page.locator("cusp-plate .name").allInnerTexts();

const copies = (page: Page, name: string): Locator => page.getByRole("textbox", { name: `Copies of ${name}` });

const moved = (page: Page): Locator => page.locator("cusp-plate").getByText("Copies stand where they were moved.");

/** Drops both and waits for their plan. */
async function both(query = "?printer=mars-4-ultra"): Promise<Page> {
  const page = await start(query);
  await drop(page, ballFile, blockFile);
  await state(page, "done");
  await page.locator("cusp-plate").waitFor();
  return page;
}

test("files that are dropped together stand on one plate, and become one print file that can be read", async () => {
  const page = await both();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await words(page)).toContain("each");
  const file = await downloaded(page);
  expect(file.name).toBe("plate-1-cusp.goo");
  expect(await broken(page)).toEqual([]);
  await drop(page, file);
  const view = page.locator("cusp-print");
  await view.locator(".verdict").waitFor();
  const facts = (await view.locator(".facts").innerText()).replaceAll("\u00a0", " ");
  expect(facts).toContain("The file is whole");
  // A ball of 4.19 ml and a block of 1.15 ml.
  expect(facts).toMatch(/5\.3\d ml by the file, 5\.3\d ml by the masks/);
});


test("copies are typed and stepped, and fill a second plate, which has a print file of its own", async () => {
  const page = await start("?printer=mars-4-ultra");
  await drop(page, ballFile);
  await state(page, "done");
  await page.getByRole("button", { name: "One more: Copies of ball.stl" }).click();
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  expect(await copies(page, "ball.stl").inputValue()).toBe("2");
  // What is no number of copies goes back.
  await copies(page, "ball.stl").fill("many");
  await copies(page, "ball.stl").press("Enter");
  expect(await copies(page, "ball.stl").inputValue()).toBe("2");
  // On 153 × 78 mm there is room for 20 balls of 20 mm.
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

test("a model is added to the open one; each has its own pose; removed, the other is as it was alone", async () => {
  const page = await start("?printer=mars-4-ultra&height=8");
  await drop(page, ballFile);
  await state(page, "done");
  const alone = await downloaded(page);
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByText("Add model").click()]);
  await chooser.setFiles({ name: blockFile.name, mimeType: "model/stl", buffer: Buffer.from(blockFile.bytes) });
  await page.locator("cusp-plate").waitFor();
  await state(page, "done");
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  await page.locator("cusp-plate .name", { hasText: "ball.stl" }).click();
  await expect.poll(() => page.locator(".model > .figures").first().innerText()).toMatch(/× 8\.0\smm/);
  // The height is that of the selected model.
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

test("a copy is moved by keyboard; one that overlaps another is told, and arranging puts it back", async () => {
  const page = await both();
  await page.getByRole("radio", { name: "Move on the plate" }).click();
  const scene = page.locator("cusp-view .scene");
  await scene.focus();
  await scene.press("ArrowDown");
  await moved(page).waitFor();
  await state(page, "done");
  // To the right, into the block.
  for (let i = 0; i < 2; i++) await scene.press("Shift+ArrowRight");
  await state(page, "error");
  expect(await page.getByRole("alert").innerText()).toContain("Copy 1 of model 1 and copy 1 of model 2 overlap on plate 1");
  expect(await broken(page)).toEqual([]);
  await page.getByRole("button", { name: "Arrange", exact: true }).click();
  await state(page, "done");
  expect(await moved(page).count()).toBe(0);
});

test("copies, moves and removals are undone and redone, by keyboard and by button", async () => {
  const page = await both();
  await page.getByRole("button", { name: "One more: Copies of block.stl" }).click();
  await state(page, "done");
  await page.getByRole("radio", { name: "Move on the plate" }).click();
  const scene = page.locator("cusp-view .scene");
  await scene.focus();
  await scene.press("ArrowDown");
  await moved(page).waitFor();
  await settled(page);
  await page.getByRole("button", { name: "Remove block.stl" }).click();
  await expect.poll(() => page.locator("cusp-plate").count()).toBe(0);
  await settled(page);
  const undo = page.getByRole("button", { name: "Undo" });
  await undo.click();
  await moved(page).waitFor();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  await settled(page);
  await scene.focus();
  await page.keyboard.press("Control+z");
  await expect.poll(() => moved(page).count()).toBe(0);
  expect(await copies(page, "block.stl").inputValue()).toBe("2");
  await page.keyboard.press("Control+z");
  await expect.poll(() => copies(page, "block.stl").inputValue()).toBe("1");
  await settled(page);
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+Shift+z");
  await moved(page).waitFor();
  expect(await copies(page, "block.stl").inputValue()).toBe("2");
  await settled(page);
});

test("a copy is dragged with the pointer, and stays where it is released", async () => {
  const page = await both();
  await page.getByRole("radio", { name: "Move on the plate" }).click();
  const canvas = page.locator("cusp-view canvas");
  const { x, y, width, height } = (await canvas.boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  // The ball stands left of the middle: where exactly, the camera knows. A press beside it turns the view.
  let isMoved = false;
  for (let part = 0.2; part < 0.8 && !isMoved; part += 0.05) {
    const at = { x: x + part * width, y: y + 0.5 * height };
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x, at.y + 12, { steps: 4 });
    await page.mouse.up();
    isMoved = (await moved(page).count()) + (await page.getByRole("alert").count()) > 0;
  }
  expect(isMoved).toBe(true);
});

test("every copy has the supports of its model, and keeps them while it is moved and turned", async () => {
  const page = await start("?printer=mars-4-ultra&supports=light");
  await drop(page, ballFile, blockFile);
  await state(page, "done");
  await page.getByRole("button", { name: "One more: Copies of ball.stl" }).click();
  await settled(page);
  const view = page.locator("cusp-view");
  /** Numbers of facets: of each copy, and of the selected one, which is drawn as the model. */
  const facets = (): Promise<{ copies: number[]; selected: number }> =>
    view.evaluate(({ copies, supports }: CuspView) => ({
      copies: copies.map((copy) => (copy.supports?.length ?? 0) / 9),
      selected: (supports?.length ?? 0) / 9,
    }));
  await expect.poll(async () => (await facets()).copies.length).toBe(3);
  const { copies: before, selected } = await facets();
  // Two balls, and a block, which stands on its base and yet is lifted.
  expect(Math.min(...before)).toBeGreaterThan(100);
  expect(new Set(before).size).toBe(2);
  expect(before).toContain(selected);
  const turned = (): Promise<number[]> => view.evaluate(({ copies }: CuspView) => copies.map(({ turn_deg }) => turn_deg));
  const places = await turned();
  await page.getByRole("radio", { name: "Move on the plate" }).click();
  const scene = page.locator("cusp-view .scene");
  await scene.focus();
  await scene.press("r");
  await settled(page);
  expect(await turned()).not.toEqual(places);
  expect((await facets()).copies).toEqual(before);
  // In another pose the model has other ones.
  await page.getByLabel("Scale to height").fill("15");
  await settled(page);
  await expect.poll(async () => (await facets()).copies.every((count) => count > 0)).toBe(true);
  await openPanel(page, "Support");
  await page.getByLabel("Supports").selectOption("None");
  await settled(page);
  expect(await facets()).toEqual({ copies: [0, 0, 0], selected: 0 });
});

test("without a printer the plate has no size, and the page asks for one", async () => {
  const page = await start();
  await drop(page, ballFile, blockFile);
  await state(page, "error");
  expect(await page.getByRole("alert").innerText()).toContain("choose a printer");
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
});

test("on a phone the models are on the sheet of the result, in the person's language", async () => {
  const page = await start("?printer=mars-4-ultra", { viewport: { width: 390, height: 844 }, locale: "de-DE" });
  await drop(page, ballFile, blockFile);
  await state(page, "done");
  await page.getByRole("button", { name: "Ergebnis zeigen" }).click();
  await page.getByText("Modelle auf der Platte").waitFor();
  expect(await listed(page)).toEqual(["ball.stl", "block.stl"]);
  expect(await broken(page)).toEqual([]);
});
