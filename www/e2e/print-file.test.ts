/** Print files on the page: their facts, masks and faults, and files of other kinds. */
import type { Locator, Page } from "playwright-core";
import { unzipSync, zipSync } from "fflate";
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { downloaded, drop, layers, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };

const start = pages();

/** The view of the print file, once read. */
async function opened(page: Page): Promise<Locator> {
  const view = page.locator("cusp-print");
  await view.locator(".verdict").waitFor();
  return view;
}

/** Slices the ball on the page. Returns the print file and its number of layers. */
async function sliced(page: Page): Promise<{ name: string; bytes: Buffer; count: number }> {
  await drop(page, ballFile);
  await state(page, "done");
  return { ...(await downloaded(page)), count: await layers(page) };
}

const litOf = (text: string): number => Number(/([\d,]+) pixels lit/.exec(text)?.[1]?.replaceAll(",", ""));

test("a downloaded print file dropped again shows its settings and masks, and leaves the model open", async () => {
  const page = await start("?printer=mars-4-ultra");
  const file = await sliced(page);
  expect(file.name).toBe("ball-cusp.goo");
  await drop(page, file);
  const view = await opened(page);
  await expect.poll(() => page.locator("cusp-workbench").isVisible()).toBe(false);
  const facts = (await view.locator(".facts").innerText()).replaceAll("\u00a0", " ");
  expect(facts).toContain("The file is whole");
  for (const fact of ["goo V3.0", "Elegoo Mars 4 Ultra", `${file.count} layers of`, "20.000 mm", "4, 30 s each", "mirrored"]) {
    expect(facts).toContain(fact);
  }
  // The volume of a ball of 20 mm is 4.19 ml.
  expect(facts).toMatch(/4\.1\d ml by the file, 4\.1\d ml by the masks/);

  const slider = view.getByRole("slider", { name: "Layer", exact: true });
  const mask = view.locator("cusp-mask canvas");
  const lit = async (layer: number): Promise<number> => {
    await expect.poll(() => mask.getAttribute("data-layer")).toBe(String(layer));
    return litOf(await view.locator("[aria-live]").innerText());
  };
  const middle = await lit(Math.floor(file.count / 2));
  await slider.focus();
  await page.keyboard.press("Home");
  const first = await lit(0);
  expect(middle).toBeGreaterThan(10 * first);
  await page.keyboard.press("End");
  expect(await lit(file.count - 1)).toBeLessThan(middle);
  expect(await broken(page)).toEqual([]);

  await page.keyboard.press("Escape");
  await view.waitFor({ state: "detached" });
  await state(page, "done");
  expect(await words(page)).toContain("ball.stl");
  expect(await layers(page)).toBe(file.count);
});

test("print files that are damaged say where and how, in the page's language, and what is whole of them can be looked at", async () => {
  const page = await start("?rays=512");
  const { bytes } = await sliced(page);
  const files = unzipSync(bytes);
  delete files["layers/00005.png"];
  await drop(page, { name: "gap.zip", bytes: zipSync(files) });
  const view = await opened(page);
  expect(await view.locator(".verdict").innerText()).toContain("1 layer is damaged, starting with layer 6: there is no layers/00005.png");
  const slider = view.getByRole("slider", { name: "Layer", exact: true });
  await slider.fill("6");
  await expect.poll(() => view.locator("[aria-live]").innerText()).toContain("This layer cannot be read.");
  await slider.fill("7");
  await expect.poll(() => view.locator("cusp-mask canvas").getAttribute("data-layer")).toBe("6");

  const encrypted = new Uint8Array(4096);
  encrypted.set([0x07, 0x01, 0xfd, 0x12]);
  await drop(page, { name: "secret.ctb", bytes: encrypted });
  await expect.poll(() => view.locator(".verdict").innerText()).toContain("save it again as plain CTB, as GOO");
  expect(await broken(page)).toEqual([]);

  await page.getByRole("combobox", { name: "Language" }).selectOption("de");
  await drop(page, { name: "cut.zip", bytes: bytes.subarray(0, bytes.length - 20) });
  await expect.poll(() => view.locator(".verdict").innerText()).toMatch(/abgeschnitten|beschädigt/);
  await view.getByText("Schließen").click();
  await view.waitFor({ state: "detached" });
});

test("a print file gives its printer, which is then described in a form of numbers", async () => {
  const page = await start("?printer=mars-4-ultra");
  const file = await sliced(page);
  const fresh = await start("");
  await drop(fresh, file);
  await (await opened(fresh)).getByRole("button", { name: "Slice for this printer" }).click();
  await expect.poll(() => new URL(fresh.url()).searchParams.get("printer")).toBe("mars-4-ultra");
  await drop(fresh, ballFile);
  await state(fresh, "done");

  // A printer that is not in the list.
  const list = fresh.getByRole("combobox", { name: "Printer" });
  await list.click();
  await list.fill("own");
  await fresh.getByRole("option", { name: "Own printer…" }).click();
  const form = fresh.locator("cusp-printer-form");
  for (const [label, text] of [["Name", "Mine"], ["Pixels across", "3000"], ["Pixels deep", "2000"], ["Pixel width (µm)", "30"], ["Height (mm)", "120"]] as const) {
    await form.getByLabel(label).fill(text);
    await form.getByLabel(label).press("Tab");
  }
  const printer = (): Promise<unknown> => fresh.evaluate(() => document.querySelector("cusp-workbench")?.printer);
  await expect.poll(printer).toMatchObject({ model: "Mine", pixels: [3000, 2000], pitch_um: [30, 30], volume_mm: [90, 60, 120] });
  await form.getByLabel("Print file").selectOption("goo");
  await expect.poll(printer).toMatchObject({ format: "goo" });
  await state(fresh, "done");
  const name = (await downloaded(fresh)).name;
  expect(name).toBe("ball-cusp.goo");
  expect(await broken(fresh)).toEqual([]);
});
