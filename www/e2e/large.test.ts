/** A large model in the page: its main thread must do little of the work. */
import { expect, test } from "vitest";
import { download, openPanel, settled, SOFTWARE_GL, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const large = { name: "large.stl", bytes: sphere(10, 400).bytes };
/** Enough for options, names and handles. The positions alone are 6 MB. */
const MESSAGES_BYTES = 10_000;
/** Maximum number of corners drawn directly on the canvas. The model has half a million. */
const CORNERS = 100_000;

interface Meter {
  /** Bytes of files that were read in the page itself. */
  read: number;
  /** Bytes that the page copied into messages to its workers. */
  copied: number;
  /** Maximum number of corners in one call that draws directly on the canvas, which may block the page until the picture is ready. */
  drawn: number;
}

declare global {
  interface Window {
    meter: Meter;
  }
}

/** Runs before the page's own scripts: measures reading, copying and drawing on its main thread. */
function meter(): void {
  // Work that is kept, a second after the last change, would be read as well.
  localStorage.setItem("cusp.work", "off");
  const found: Meter = { read: 0, copied: 0, drawn: 0 };
  window.meter = found;
  const { arrayBuffer, text } = Blob.prototype;
  Blob.prototype.arrayBuffer = function () {
    found.read += this.size;
    return arrayBuffer.call(this);
  };
  Blob.prototype.text = function () {
    found.read += this.size;
    return text.call(this);
  };
  const { readAsArrayBuffer } = FileReader.prototype;
  FileReader.prototype.readAsArrayBuffer = function (blob) {
    found.read += blob.size;
    readAsArrayBuffer.call(this, blob);
  };
  const weigh = (value: unknown, moved: readonly unknown[]): number => {
    if (ArrayBuffer.isView(value)) return moved.includes(value.buffer) ? 0 : value.byteLength;
    if (value instanceof ArrayBuffer) return moved.includes(value) ? 0 : value.byteLength;
    if (Array.isArray(value)) return value.reduce<number>((sum, it) => sum + weigh(it, moved), 0);
    // A module is shared, a file is a handle, a port is transferred.
    if (value === null || typeof value !== "object" || Object.getPrototypeOf(value) !== Object.prototype) return 8;
    return Object.values(value).reduce<number>((sum, it) => sum + weigh(it, moved), 0);
  };
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (message: unknown, moved?: Transferable[] | StructuredSerializeOptions) {
    const transfer = Array.isArray(moved) ? moved : (moved?.transfer ?? []);
    found.copied += weigh(message, transfer);
    postMessage.call(this, message, { transfer });
  };
  const { drawArrays, drawElements } = WebGL2RenderingContext.prototype;
  const drawn = (gl: WebGL2RenderingContext, count: number): void => {
    if (gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) === null) found.drawn = Math.max(found.drawn, count);
  };
  WebGL2RenderingContext.prototype.drawArrays = function (mode, first, count) {
    drawn(this, count);
    drawArrays.call(this, mode, first, count);
  };
  WebGL2RenderingContext.prototype.drawElements = function (mode, count, type, offset) {
    drawn(this, count);
    drawElements.call(this, mode, count, type, offset);
  };
}

const start = pages(SOFTWARE_GL);

test("a large model is read, planned, drawn and saved beside the page, whose thread reads, copies and draws none of it", async () => {
  const page = await start("?height=6", { viewport: { width: 1280, height: 400 }, deviceScaleFactor: 0.5, before: meter });
  await page.getByLabel(/Choose a file/).setInputFiles({ name: large.name, mimeType: "", buffer: Buffer.from(large.bytes) });
  await state(page, "done");
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain("6.0");
  await page.getByLabel("Tolerance", { exact: true }).fill("0.05");
  await settled(page);
  await (await download(page)).path();
  await state(page, "done");
  await expect.poll(() => page.evaluate(() => window.meter.drawn)).toBeGreaterThan(0);
  const { read, copied, drawn } = await page.evaluate(() => window.meter);
  // Its beginning tells a model from a print file.
  expect(read).toBeLessThanOrEqual(1024);
  expect(copied).toBeLessThan(MESSAGES_BYTES);
  expect(drawn).toBeLessThan(CORNERS);
});
