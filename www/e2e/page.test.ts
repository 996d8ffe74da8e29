/** From a model to a print file, in a real browser: opening, refusing, planning, viewing, saving. */
import { mkdir, mkdtemp, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { decode } from "fast-png";
import { unzipSync, zipSync } from "fflate";
import { expect, inject, test } from "vitest";
import { download, drop, layers, maskOf, openPanel, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { objOf, projectOf, sphere, threeMfOf } from "./solids.js";

/** The fields of the manifest that the tests read. */
interface Manifest {
  layers: number;
  mask: { width: number; height: number; pitch_mm: number };
  layer_files: { file: string; z_mm: number; thickness_mm: number; lit_pixels: number }[];
}

const ball = sphere(10, 96);
const ballFile = { name: "ball.stl", bytes: ball.bytes };

const start = pages();

test("a dropped model is planned, looked through by keyboard, and its masks add up to its volume", async () => {
  const page = await start("?rays=512");
  await drop(page, ballFile);
  await state(page, "done");

  const text = await words(page);
  expect(text).toContain("ball.stl");
  expect(text).toContain("20.0 × 20.0 × 20.0 mm");
  expect(text).toContain("Watertight");
  expect(text).toMatch(/\d+% fewer than the best uniform layers within tolerance/);
  expect(text).toMatch(/Coarsest uniform, 0.15 mm 13[34] \d+ min 0.1[45]\d* mm over tolerance/);
  expect(text).toMatch(/Time (\d+ h )?\d+ min \d+ layers/);
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

/** Number of lit pixels of a one-bit picture, whose rows are padded with dark pixels to whole bytes. */
function litPixels({ data, depth }: ReturnType<typeof decode>): number {
  expect(depth).toBe(1);
  let lit = 0;
  for (const byte of data) for (let rest = byte; rest > 0; rest >>= 1) lit += rest & 1;
  return lit;
}

test("a model is pasted, chosen or opened by Control and O, as STL, OBJ or 3MF: the plan is the same", async () => {
  const { bytes } = sphere(10, 48);
  const page = await start("?rays=512");
  const plans: number[] = [];
  const opened = async (name: string): Promise<void> => {
    await expect.poll(() => page.locator(".model-name").allInnerTexts()).toEqual([name]);
    await state(page, "done");
    plans.push(await layers(page));
  };
  await page.getByLabel(/Choose a file/).setInputFiles({ name: "chosen.obj", mimeType: "", buffer: Buffer.from(objOf(bytes)) });
  await opened("chosen.obj");
  const again = async (): Promise<void> => {
    await page.reload();
    await state(page, "empty");
  };
  await again();
  await page.evaluate((bytes) => {
    const clipboardData = new DataTransfer();
    clipboardData.items.add(new File([Uint8Array.from(bytes)], "pasted.stl"));
    document.body.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, [...bytes]);
  await opened("pasted.stl");
  await again();
  const opening = page.waitForEvent("filechooser");
  // Playwright subscribes to the dialog by a command, which must be answered before the key.
  await page.evaluate(() => undefined);
  await page.keyboard.press("Control+o");
  await (await opening).setFiles({ name: "opened.3mf", mimeType: "", buffer: Buffer.from(threeMfOf(bytes)) });
  await opened("opened.3mf");
  expect(new Set(plans).size).toBe(1);
  // A project is read by plate: on the second, two models stand next to each other.
  await drop(page, { name: "project.3mf", bytes: projectOf(bytes) });
  await opened("project.3mf");
  await page.getByLabel("Plate 1 of 2 is read.").selectOption("Plate 2 of 2");
  const list = page.getByLabel("Plate 2 of 2 is read.");
  await list.waitFor();
  await state(page, "done");
  expect(await list.inputValue()).toBe("2");
  const facets = 2 * (bytes.length - 84) / 50;
  expect(await page.locator(".model").innerText()).toContain(facets.toLocaleString("en"));
});

test("files, links and folders that will not do are refused in words, and the page goes on with the model before", async () => {
  const page = await start("?rays=512");
  const alert = page.getByRole("alert");
  await drop(page, { name: "notes.txt", bytes: new TextEncoder().encode("hello") });
  await state(page, "error");
  expect(await alert.innerText()).toContain("notes.txt could not be opened");
  await drop(page, ballFile);
  await state(page, "done");
  const count = await layers(page);

  const stl = ball.bytes;
  const refused: readonly [name: string, bytes: Uint8Array, said: string][] = [
    ["prose.stl", new TextEncoder().encode("once upon a time there was no solid at all"), "prose.stl"],
    ["half.stl", stl.slice(0, stl.length / 2), "half.stl is cut short"],
    ["cut.3mf", threeMfOf(stl).slice(0, 5000), "3MF"],
    ["model.zip", zipSync({ "model.stl": stl }), "unpack it, and open the model inside"],
  ];
  for (const [name, bytes, said] of refused) {
    await drop(page, { name, bytes });
    await expect.poll(() => words(page)).toContain(said);
    await state(page, "error");
    // The previous model remains usable.
    expect(await page.locator(".model-name").innerText()).toBe("ball.stl");
    expect(await layers(page)).toBe(count);
  }
  await openPanel(page, "Mask");
  await page.getByRole("button", { name: "Layer below", exact: true }).click();
  await alert.getByRole("button", { name: "Close" }).click();
  await state(page, "done");
  // A model is recognised whatever its name.
  await drop(page, { name: "ball", bytes: stl });
  await state(page, "done");
  expect(await page.locator(".model-name").innerText()).toBe("ball");

  const folder = await mkdtemp(join(inject("scratch"), "things-"));
  const cdp = await page.context().newCDPSession(page);
  const dropped = async (data: { items: { mimeType: string; data: string }[]; files: string[] }): Promise<void> => {
    for (const type of ["dragEnter", "dragOver", "drop"] as const) {
      await cdp.send("Input.dispatchDragEvent", { type, x: 600, y: 400, data: { ...data, dragOperationsMask: 1 } });
    }
  };
  await dropped({ items: [{ mimeType: "text/uri-list", data: "https://models.example/ball.stl" }], files: [] });
  await expect.poll(() => alert.innerText()).toMatch(/^models\.example could not be opened\s+This is a link, not a file\./);
  await writeFile(join(folder, "notes.txt"), "hello");
  await dropped({ items: [], files: [folder] });
  await expect.poll(() => alert.innerText()).toContain("The folder holds no STL, 3MF or OBJ file.");
  await mkdir(join(folder, "parts"));
  await writeFile(join(folder, "parts/deep.stl"), stl);
  await dropped({ items: [], files: [folder] });
  // Beside the open model; without a printer, the plate has a usual size.
  await expect.poll(() => page.locator("cusp-plate .name").allInnerTexts()).toEqual(["ball", "deep.stl"]);
  expect(await page.locator(".model").innerText()).toContain("192 × 120");
  await state(page, "done");
});
