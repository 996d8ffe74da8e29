/** Fetches of the page, their timing, and failures. */
import type { Page } from "playwright-core";
import { expect, inject, test } from "vitest";
import { broken } from "./axe.js";
import { drop, layers, openPanel, state, USUAL, visit } from "./browser.js";
import { beforeView, whole } from "./loaded.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";
import { tabs, type TabOptions } from "./tabs.js";

const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };

const start = pages();
/** Tabs of the same browser, returned to the pool like those of {@link start}. */
const take = (options: TabOptions = {}): Promise<Page> => tabs().take({ ...USUAL, ...options });

test("loaded once, the page opens and slices without a network", async () => {
  const page = await start("", { serviceWorkers: "allow" });
  await page.evaluate(async () => void (await navigator.serviceWorker.ready));
  await page.context().setOffline(true);
  await page.goto(`${inject("address")}?height=20&rays=512`);
  await page.waitForSelector("cusp-workbench[state=empty]");
  // A local file needs no network.
  await page.getByLabel(/Choose a file/).setInputFiles({ name: ball.name, mimeType: "", buffer: Buffer.from(ball.bytes) });
  await state(page, "done");
  expect(await layers(page)).toBeGreaterThan(134);
  // Parts fetched when shown come from the cache.
  await page.waitForSelector("cusp-chart .plot canvas");
  await openPanel(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
  await page.context().setOffline(false);
});

test("the page is forbidden to send anything anywhere", async () => {
  const page = await take();
  await visit(page, inject("address"));
  const forbidden = await page.evaluate(
    () =>
      new Promise<string>((resolve) => {
        document.addEventListener("securitypolicyviolation", (event) => resolve(event.effectiveDirective), { once: true });
        fetch("http://localhost:9/").catch(() => undefined);
      }),
  );
  expect(forbidden).toBe("connect-src");
});

test("a slicer that cannot be fetched says what to do, and is fetched again with the next file", async () => {
  const page = await take();
  let isThere = false;
  await page.route(/\.wasm$/, (route) => (isThere ? route.continue() : route.abort()));
  await visit(page, inject("address"));
  await drop(page, ball);
  await state(page, "error");
  const alert = page.getByRole("alert");
  await expect.poll(() => alert.innerText()).toContain("The slicer could not be started");
  expect(await alert.innerText()).toContain("Reload the page.");
  isThere = true;
  await drop(page, ball);
  await state(page, "done");
});

test("each part that a newer version has replaced says so in one sentence and leads on; nothing is left uncaught, and slicing goes on", async () => {
  const page = await take();
  let gone = /^never$/;
  await page.route(/\/assets\//, (route) => (gone.test(route.request().url()) ? route.fulfill({ status: 404 }) : route.continue()));
  const { complaints } = await visit(page, inject("address"));
  // The slicer is loaded, and the view is prefetched.
  await page.waitForLoadState("networkidle");
  const notice = page.locator("#notice");
  const says = async (words: string): Promise<void> => {
    await expect.poll(() => notice.innerText()).toContain(words);
    expect(await broken(page)).toEqual([]);
    await notice.getByRole("button", { name: "Close" }).click();
    await notice.waitFor({ state: "detached" });
  };
  const press = (name: string): Promise<void> => page.getByRole("button", { name, exact: true }).click();
  const goo = { name: "ball.goo", bytes: new Uint8Array(4096) };

  // First only the reader's module is missing, then also its code.
  for (gone of [/cusp_reader|\/worker-/, /\.(js|wasm)/]) {
    await drop(page, goo);
    await says("The reader of print files could not be loaded, so ball.goo is not open. Reload the page");
  }
  for (const name of ["Presets", "Recent work", "Keys", "Try the example"]) {
    await press(name);
    await says("This part of the page could not be loaded");
  }
  await page.getByLabel("Language").selectOption("de");
  await says("This part of the page could not be loaded");

  await drop(page, ball);
  await state(page, "done");
  // What keeps the work.
  await says("This part of the page could not be loaded");
  await openPanel(page, "Check");
  // The chart and the findings.
  await expect.poll(() => page.getByRole("alert").count()).toBe(2);
  for (const text of await page.getByRole("alert").allInnerTexts()) expect(text).toMatch(/^This part of the page could not be loaded\..* reload the page\.\s+Try again$/);
  expect(complaints.filter((it) => !it.startsWith("Failed to load resource"))).toEqual([]);

  await press("Presets");
  gone = /^never$/;
  await notice.getByRole("button", { name: "Reload" }).click();
  await state(page, "empty");
  await page.locator("[popovertarget=saved]").click();
  await page.locator("cusp-saved .panel").first().waitFor();
});

declare global {
  interface Window {
    /** Recorded events, in order. */
    seen: string[];
  }
}

/**
 * Runs before the page's own scripts: records calls to workers, the element's states, and the creation of the view's context. `?saves`
 * reports data saving.
 */
function note(): void {
  const seen: string[] = (window.seen = []);
  if (location.search.includes("saves")) Object.defineProperty(navigator, "connection", { value: { saveData: true } });
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (message: { path?: string[] }, moved?: Transferable[] | StructuredSerializeOptions) {
    const call = message.path?.join(".") ?? "";
    if (call !== "") seen.push(call);
    // This plan never finishes.
    if (call === "plan" && location.search.includes("hangs")) return;
    postMessage.call(this, message, { transfer: Array.isArray(moved) ? moved : (moved?.transfer ?? []) });
  };
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...options: unknown[]) {
    if (kind === "webgl2" && !seen.includes("view")) seen.push("view");
    return (getContext as (...given: unknown[]) => unknown).call(this, kind, ...options);
  } as typeof getContext;
  new MutationObserver(() => {
    const state = document.querySelector("cusp-workbench")?.getAttribute("state") ?? "";
    if (seen.at(-1) !== state) seen.push(state);
  }).observe(document, { subtree: true, attributeFilter: ["state"] });
}

/** A page that records its events, and the names of the scripts that it fetches. */
async function noted(query = ""): Promise<{ page: Page; scripts: string[] }> {
  const page = await take({ before: note });
  const scripts: string[] = [];
  page.on("request", (request) => scripts.push(request.url().split("/").at(-1) ?? ""));
  await visit(page, inject("address") + query);
  return { page, scripts };
}

const seen = (page: Page): Promise<string[]> => page.evaluate(() => window.seen);

test("an idle page fetches the view and compiles a plan before there is a model; then the plan comes first, and the view has its model", async () => {
  const { page, scripts } = await noted();
  await expect.poll(() => scripts.some((name) => name.startsWith("cusp-view"))).toBe(true);
  await expect.poll(() => seen(page)).toContain("warmUp");
  expect(await seen(page)).not.toContain("view");
  await drop(page, ball);
  await expect.poll(() => seen(page)).toContain("view");
  const order = await seen(page);
  expect(order.indexOf("plan")).toBeGreaterThan(order.indexOf("add"));
  expect(order.indexOf("done")).toBeGreaterThan(order.indexOf("plan"));
  expect(order.indexOf("view")).toBeGreaterThan(order.indexOf("done"));
  // The worker that has read the model also serves the view, so the model is read once.
  expect(order.filter((it) => it === "add" || it === "positions" || it === "boot")).toEqual(["boot", "add"]);

  const slow = await noted("?hangs");
  await drop(slow.page, ball);
  await expect.poll(() => seen(slow.page)).toContain("view");
  expect(await slow.page.locator("cusp-workbench").getAttribute("state")).toBe("busy");
});

test("for whoever saves data, the view is fetched with the first model", async () => {
  const { page, scripts } = await noted("?saves");
  await expect.poll(() => seen(page)).toContain("warmUp");
  await page.waitForLoadState("networkidle");
  expect(scripts.filter((name) => name.startsWith("cusp-view"))).toEqual([]);
  await drop(page, ball);
  await expect.poll(() => scripts.some((name) => name.startsWith("cusp-view"))).toBe(true);
});

test("what the page loads before its 3-D view, beside the wasm, is at most 140 KB", async () => {
  const page = await start("?rays=512", { locale: "de-DE" });
  const sizes = await beforeView(page);
  await page.reload();
  await state(page, "empty");
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector(".u-over");
  expect(sizes.size).toBeGreaterThan(4);
  expect(whole(sizes), [...sizes].map(([name, size]) => `${name} ${size}`).join("\n")).toBeLessThanOrEqual(140_000);
});
