/** The npm package, installed from its tarball into pages of somebody else, built by their bundlers, and run. */
import { execFileSync, spawnSync } from "node:child_process";
import { cp, mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Browser } from "playwright-core";
import { build } from "vite";
import { afterAll, beforeAll, expect, test } from "vitest";
import webpack from "webpack";
import { main as pack } from "../package/build.js";
import { launch } from "./browser.js";
import { sphere } from "./solids.js";
import { serveFolder } from "./static.js";

const packed = fileURLToPath(new URL("../dist-package", import.meta.url));
const source = fileURLToPath(new URL("./consumer", import.meta.url));
const compiler = fileURLToPath(new URL("../node_modules/typescript/bin/tsc", import.meta.url));

let browser: Browser;
let consumer: string;

beforeAll(async () => {
  await pack();
  const [tarball] = (await readdir(packed)).filter((name) => name.endsWith(".tgz"));
  consumer = await mkdtemp(join(tmpdir(), "cusp-consumer-"));
  await cp(source, consumer, { recursive: true });
  await writeFile(join(consumer, "ball.stl"), sphere(10, 96).bytes);
  await writeFile(join(consumer, "package.json"), JSON.stringify({ name: "consumer", private: true, type: "module" }));
  // The tarball has no dependencies, so that this needs no network.
  const install = ["install", "--offline", "--no-audit", "--no-fund", "--loglevel=error", join(packed, tarball ?? "")];
  execFileSync("npm", install, { cwd: consumer, stdio: "inherit" });
  browser = await launch();
}, 120_000);

afterAll(async () => {
  await browser.close();
  await rm(consumer, { recursive: true, force: true });
});

/** Runs the page in `folder` under the policy that the guide names, and gives what element and headless API made. */
async function run(folder: string): Promise<{ element: string; headless: string; globals: string[] }> {
  const served = await serveFolder(folder);
  const context = await browser.newContext();
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  page.on("request", (request) => {
    const address = request.url();
    if (!address.startsWith(served.address) && !address.startsWith("blob:")) complaints.push(address);
  });
  await page.addInitScript(() => {
    const before = new Set(Object.getOwnPropertyNames(window));
    Object.defineProperty(document, "newGlobals", {
      value: () => Object.getOwnPropertyNames(window).filter((name) => !before.has(name)),
    });
  });
  try {
    await page.goto(served.address);
    const done = page.waitForSelector("body[data-headless][data-element]", { timeout: 20_000 });
    await done.catch((error: unknown) => {
      throw new Error([...complaints, String(error)].join("\n"));
    });
    const { dataset, globals } = await page.evaluate(() => ({
      dataset: { ...document.body.dataset },
      globals: (document as unknown as { newGlobals(): string[] }).newGlobals(),
    }));
    expect(complaints).toEqual([]);
    return { element: dataset["element"] ?? "", headless: dataset["headless"] ?? "", globals };
  } finally {
    await context.close();
    await served.close();
  }
}

async function works(folder: string, ownGlobals: (name: string) => boolean = () => false): Promise<void> {
  await cp(join(consumer, "ball.stl"), join(folder, "ball.stl"), { force: true });
  const { element, headless, globals } = await run(folder);
  expect(headless).toMatch(new RegExp(`^1 ball.stl ${element} (cpu|gpu) true$`));
  expect(Number(element)).toBeGreaterThan(134);
  expect(globals.filter((name) => !ownGlobals(name))).toEqual([]);
}

test("its types hold for a strict compiler that looks into libraries", () => {
  const options = ["--noEmit", "--strict", "--target", "es2022", "--module", "esnext", "--moduleResolution", "bundler"];
  const { stdout } = spawnSync(process.execPath, [compiler, ...options, "--lib", "es2023,dom,dom.iterable", "types.ts"], {
    cwd: consumer,
    encoding: "utf8",
  });
  expect(stdout).toBe("");
});

test("built by Vite", async () => {
  const outDir = join(consumer, "vite");
  await build({ root: consumer, configFile: false, logLevel: "error", build: { outDir, target: "es2022" } });
  await works(outDir);
});

test("built by webpack", async () => {
  const path = join(consumer, "webpack");
  const compilation = webpack({
    mode: "production",
    context: consumer,
    entry: "./main.js",
    output: { path, filename: "main.js", module: true },
    experiments: { outputModule: true },
    performance: { hints: false },
  });
  const stats = await new Promise<webpack.Stats | undefined>((resolve, reject) =>
    compilation?.run((error, stats) => (error ? reject(error) : resolve(stats))),
  );
  expect(stats?.toJson({ all: false, errors: true, warnings: true })).toMatchObject({ errors: [], warnings: [] });
  await cp(join(consumer, "index.html"), join(path, "index.html"));
  // webpack keeps track of its own chunks by one global.
  await works(path, (name) => name.startsWith("webpackChunk"));
});

test("from a plain web server, without a bundler", async () => {
  const folder = join(consumer, "plain");
  await cp(join(consumer, "node_modules/cusp-slicer"), join(folder, "cusp-slicer"), { recursive: true });
  await cp(join(consumer, "index.html"), join(folder, "index.html"));
  const script = await readFile(join(consumer, "main.js"), "utf8");
  const own = script.replace(`"cusp-slicer"`, `"./cusp-slicer/index.js"`).replace(`"cusp-slicer/element"`, `"./cusp-slicer/element.js"`);
  await writeFile(join(folder, "main.js"), own);
  await works(folder);
});
