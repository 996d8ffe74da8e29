/** The plan comes first: what is fetched and compiled before a model is there, and when the view is shown. */
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, inject, test } from "vitest";
import { drop, launch, SOFTWARE_GL, USUAL, visit } from "./browser.js";
import { sphere } from "./solids.js";

const ball = { name: "ball.stl", bytes: sphere(10, 96).bytes };

let browser: Browser;

beforeAll(async () => {
  browser = await launch(SOFTWARE_GL);
});

afterAll(async () => {
  await browser.close();
});

declare global {
  interface Window {
    /** What happened, in order. */
    seen: string[];
  }
}

/** Runs before the page's own scripts: notes calls to workers, the element's states, and when the view gets its canvas. */
function note(): void {
  const seen: string[] = (window.seen = []);
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (message: { path?: string[] }, moved?: Transferable[] | StructuredSerializeOptions) {
    const call = message.path?.join(".") ?? "";
    if (call !== "") seen.push(call);
    // A plan that is never made.
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

/** A page that notes what happens, and the names of the scripts that it fetches. */
async function noted(query = "", before: () => void = () => undefined): Promise<{ page: Page; scripts: string[] }> {
  const page = await (await browser.newContext(USUAL)).newPage();
  const scripts: string[] = [];
  page.on("request", (request) => scripts.push(request.url().split("/").at(-1) ?? ""));
  await page.addInitScript(note);
  await page.addInitScript(before);
  await visit(page, inject("address") + query);
  return { page, scripts };
}

const seen = (page: Page): Promise<string[]> => page.evaluate(() => window.seen);

test("the view is shown once the plan is, and has the model from the worker that read it", async () => {
  const { page } = await noted();
  await drop(page, ball);
  await page.locator("cusp-view canvas").waitFor();
  const order = await seen(page);
  expect(order.indexOf("plan")).toBeGreaterThan(order.indexOf("open"));
  expect(order.indexOf("done")).toBeGreaterThan(order.indexOf("plan"));
  expect(order.indexOf("view")).toBeGreaterThan(order.indexOf("done"));
  await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain("20.0");
  expect((await seen(page)).filter((it) => it === "open" || it === "positions" || it === "boot")).toEqual(["boot", "open"]);
});

test("the view does not wait for a plan that takes long", async () => {
  const { page } = await noted("?hangs");
  await drop(page, ball);
  await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain("20.0");
  expect(await page.locator("cusp-workbench").getAttribute("state")).toBe("busy");
});

test("an idle page fetches the view and has a plan compiled before there is a model", async () => {
  const { page, scripts } = await noted();
  await expect.poll(() => scripts.some((name) => name.startsWith("cusp-view"))).toBe(true);
  await expect.poll(() => seen(page)).toContain("rehearse");
  expect(await seen(page)).not.toContain("view");
});

test("for whoever saves data, the view is fetched with the first model", async () => {
  const { page, scripts } = await noted("", () => {
    Object.defineProperty(navigator, "connection", { value: { saveData: true } });
  });
  await expect.poll(() => seen(page)).toContain("rehearse");
  await page.waitForLoadState("networkidle");
  expect(scripts.filter((name) => name.startsWith("cusp-view"))).toEqual([]);
  await drop(page, ball);
  await page.locator("cusp-view canvas").waitFor();
});
