/** The package on another origin than the page, as from a CDN, and workers that cannot start. */
import { cp, mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, test } from "vitest";
import type * as Api from "../src/api/index.js";
import { launch } from "./browser.js";
import { builtPackage } from "./built.js";
import type { Served } from "./serve.js";
import { sphere } from "./solids.js";
import { ALLOW_ALL, policyFor, serveFolder } from "./static.js";

declare global {
  interface Window {
    api: typeof Api;
  }
}

const TRUSTED_TYPES = "require-trusted-types-for 'script'; trusted-types cusp lit-html";

let browser: Browser;
let page: Page;
/** The package, on an origin with CORS. */
let cdn: Served;
let origin: string;
/** The package on an origin without CORS, and on one that serves scripts as HTML. */
let closed: Served;
let mistyped: Served;
let folder: string;
const closing: (() => Promise<void>)[] = [];

beforeAll(async () => {
  const packed = await builtPackage();
  cdn = await serveFolder(packed, "", ALLOW_ALL);
  ({ origin } = new URL(cdn.address));
  closed = await serveFolder(packed, "");
  mistyped = await serveFolder(packed, "", { ...ALLOW_ALL, "content-type": "text/html" });
  folder = await mkdtemp(join(tmpdir(), "cusp-origins-"));
  await writeFile(join(folder, "ball.stl"), sphere(10, 48).bytes);
  await writeFile(
    join(folder, "index.html"),
    `<!doctype html><meta charset="utf-8" /><title>Shop</title><script type="module" src="${cdn.address}element.js"></script>
    <script type="module" src="main.js"></script><cusp-slicer assets="${cdn.address}" src="ball.stl"></cusp-slicer>`,
  );
  await writeFile(join(folder, "main.js"), `window.api = await import("${cdn.address}index.js");`);
  await writeFile(join(folder, "frame.html"), `<!doctype html><title>Frame</title><iframe sandbox="allow-scripts" src="./"></iframe>`);
  browser = await launch();
}, 120_000);

afterAll(async () => {
  await browser.close();
  await Promise.all([cdn.close(), closed.close(), mistyped.close(), rm(folder, { recursive: true })]);
});

afterEach(async () => {
  await page.context().close();
  for (const close of closing.splice(0)) await close();
});

/** Opens a page of another origin under a policy. Returns its errors. */
async function open(path: string, policy: string): Promise<string[]> {
  const shop = await serveFolder(folder, policy, ALLOW_ALL);
  closing.push(() => shop.close());
  page = await (await browser.newContext({ locale: "en-GB" })).newPage();
  const complaints: string[] = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  await page.goto(shop.address + path);
  return complaints;
}

test("the element and the headless slicer come from another origin, under a strict policy with Trusted Types", async () => {
  const complaints = await open("", `${policyFor(origin)}; ${TRUSTED_TYPES}`);
  await page.waitForSelector("cusp-slicer[state=done]");
  const layers = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    const { report } = await slicer.plan({ rays: 512 });
    await slicer.export();
    slicer.dispose();
    return report.layers;
  });
  expect(layers).toBeGreaterThan(100);
  expect(complaints).toEqual([]);
});

test("in a sandboxed frame, to which its own host is another origin", async () => {
  const complaints = await open("frame.html", `${policyFor(origin)}; frame-src *`);
  await page.frameLocator("iframe").locator("cusp-slicer[state=done]").waitFor();
  expect(complaints).toEqual([]);
});

/** A classic script that reads the script to load from the end of its own URL, and accepts only its own origin. */
const LIKE_TURBOPACK = `
const address = decodeURIComponent(location.hash.slice(1));
if (new URL(address).origin !== location.origin) throw new Error("from another origin");
importScripts(address);`;

/** Writes the package into a folder as Turbopack builds it, with workers that start from such a script. */
async function buildLikeTurbopack(built: string): Promise<void> {
  await cp(await builtPackage(), built, { recursive: true });
  await writeFile(join(built, "turbopack.js"), LIKE_TURBOPACK);
  const module = /new URL\(`\.\/worker\.js`,import\.meta\.url\),\{type:`module`,/;
  const classic = "new URL(`./turbopack.js#${encodeURIComponent(new URL(`./worker.js`,import.meta.url))}`,import.meta.url),{";
  for (const name of (await readdir(built)).filter((name) => name.endsWith(".js"))) {
    const code = await readFile(join(built, name), "utf8");
    const isWorker = name === "worker.js";
    await writeFile(join(built, name), isWorker ? code.replaceAll("import.meta.url", "location.href") : code.replace(module, () => classic));
  }
}

test("a worker starts that reads at the end of its address what to load, as Turbopack's does", async () => {
  const built = join(folder, "turbopack");
  await buildLikeTurbopack(built);
  const other = await serveFolder(built, "", ALLOW_ALL);
  closing.push(() => other.close());
  await writeFile(
    join(folder, "turbopack.html"),
    `<!doctype html><title>Shop</title><script type="module" src="${other.address}element.js"></script><cusp-slicer src="ball.stl"></cusp-slicer>`,
  );
  const complaints = await open("turbopack.html", policyFor(new URL(other.address).origin));
  await page.waitForSelector("cusp-slicer[state=done]");
  expect(await Promise.all(page.workers().map((worker) => worker.evaluate(() => location.href)))).toContain(
    `${other.address}turbopack.js#${encodeURIComponent(`${other.address}worker.js`)}`,
  );
  expect(complaints).toEqual([]);
});

/** Errors of a slicer with these assets, for two calls. */
async function failures(assets: string): Promise<unknown> {
  await page.waitForFunction(() => "api" in window);
  return page.evaluate(async (assets) => {
    const slicer = window.api.createSlicer({ assets });
    const failure = (): Promise<unknown> => slicer.printers().then(() => "it started", ({ code, detail }) => [code, detail]);
    const both = [await failure(), await failure()];
    slicer.dispose();
    return both;
  }, assets);
}

/** Expected errors of a refused worker, for two calls: the second starts another worker. */
function refused(system: string): unknown {
  const once = ["worker-failed", { system }];
  return [once, once];
}

test("a worker that cannot start rejects with a code of its own, whatever stands in its way", async () => {
  const gone = await serveFolder(folder);
  await gone.close();
  await open("", policyFor("http://127.0.0.1:*"));
  for (const assets of [`${cdn.address}nowhere/`, mistyped.address, closed.address, gone.address]) {
    expect(await failures(assets)).toEqual(refused(expect.stringContaining(`${assets}worker.js`) as string));
  }
  await page.context().close();

  await open("", policyFor(origin).replace(/worker-src [^;]*/, "worker-src 'none'"));
  expect(await failures(cdn.address)).toEqual(refused(`${cdn.address}worker.js could not be loaded`));
  await page.waitForSelector("cusp-slicer[state=error]");
  expect(await page.getByRole("alert").innerText()).toContain("tell its operator");
  await page.context().close();

  await open("", `${policyFor(origin)}; ${TRUSTED_TYPES.replace("cusp ", "")}`);
  expect(await failures(cdn.address)).toEqual(refused(expect.stringContaining("TrustedScriptURL") as string));
});
