/** Third-party pages with the package, made from the snippets in docs/embed.md. */
import { cp, mkdir, mkdtemp, readdir, readFile, rm, symlink, writeFile } from "node:fs/promises";
import { execFileSync } from "node:child_process";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Browser, Page } from "playwright-core";
import { expect } from "vitest";
import { builtPackage } from "./built.js";
import type { Served } from "./serve.js";
import { sphere } from "./solids.js";

export const www = fileURLToPath(new URL("..", import.meta.url));

/** Packages used by the pages besides ours, from the front end's own packages. */
const BESIDE = ["react", "react-dom", "@types/react", "@types/react-dom", "vue", "svelte", "preact", "solid-js", "csstype"];
const TOOLS = ["vite", "@vitejs/plugin-vue", "@sveltejs/vite-plugin-svelte", "esbuild"];

export interface Workplace {
  /** Folder with only the package in its node_modules. */
  readonly bare: string;
  /** Folder that also has the frameworks and bundlers. */
  readonly folder: string;
  /** Creates a folder with these files, next to the package and the frameworks. */
  app(name: string, files: Readonly<Record<string, string>>): Promise<string>;
  close(): Promise<void>;
}

/** Packs the package and installs it from its tarball, once for all pages. */
export async function workplace(): Promise<Workplace> {
  const packed = await builtPackage();
  const [tarball = ""] = (await readdir(packed)).filter((name) => name.endsWith(".tgz"));
  const root = await mkdtemp(join(tmpdir(), "cusp-apps-"));
  const [bare, folder] = [join(root, "bare"), join(root, "full")];
  await mkdir(bare);
  await writeFile(join(bare, "package.json"), JSON.stringify({ name: "consumer", private: true, type: "module" }));
  // The tarball has no dependencies, so this needs no network.
  const install = ["install", "--offline", "--no-audit", "--no-fund", "--loglevel=error", join(packed, tarball)];
  execFileSync("npm", install, { cwd: bare, stdio: "inherit" });
  await cp(bare, folder, { recursive: true });
  for (const name of [...BESIDE, ...TOOLS]) {
    const place = join(folder, "node_modules", name);
    await mkdir(dirname(place), { recursive: true });
    await symlink(join(www, "node_modules", name), place, "dir");
  }
  return {
    bare,
    folder,
    async app(name, files) {
      const place = join(folder, name);
      await write(place, files);
      return place;
    },
    close: () => rm(root, { recursive: true, force: true }),
  };
}

export async function write(folder: string, files: Readonly<Record<string, string>>): Promise<void> {
  for (const [path, text] of Object.entries(files)) {
    await mkdir(dirname(join(folder, path)), { recursive: true });
    await writeFile(join(folder, path), text);
  }
}

/** Files and commands shown in a section of the guide: "```jsx src/App.jsx" begins a file, "```sh" commands. */
export async function snippets(heading: string): Promise<{ files: Record<string, string>; commands: string[] }> {
  const guide = await readFile(join(www, "../docs/embed.md"), "utf8");
  const files: Record<string, string> = {};
  const commands: string[] = [];
  let at = "";
  for (const [, title, kind, path = "", text = ""] of guide.matchAll(/^#+ ([^\n]+)$|^```(\w+)(?: (\S+))?\n(.*?)^```$/gms)) {
    if (title !== undefined) at = title;
    if (kind === undefined || at !== heading) continue;
    if (path !== "") files[path] = text;
    if (kind === "sh") commands.push(text);
  }
  return { files, commands };
}

export interface Ran {
  page: Page;
  /** Properties of `window` created by the page. */
  globals: string[];
}

/**
 * Uses a page as a visitor does: opens a model, views its layers, and saves the print file. `look` inspects the result; `others` are
 * further permitted origins.
 */
export async function visit(browser: Browser, served: Served, look: (ran: Ran) => Promise<void>, others: readonly string[] = []): Promise<void> {
  const context = await browser.newContext({ locale: "en-GB", viewport: { width: 1280, height: 900 } });
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  page.on("request", (request) => {
    const address = request.url();
    if (![served.address, "blob:", ...others].some((start) => address.startsWith(start))) complaints.push(address);
  });
  await page.addInitScript(() => {
    const before = new Set(Object.getOwnPropertyNames(window));
    Object.defineProperty(document, "newGlobals", {
      value: () => Object.getOwnPropertyNames(window).filter((name) => !before.has(name)),
    });
  });
  try {
    await page.goto(served.address);
    const ball = { name: "ball.stl", mimeType: "model/stl", buffer: Buffer.from(sphere(4, 32).bytes) };
    await page.locator("cusp-slicer input[type=file]").first().setInputFiles(ball);
    await page.waitForSelector("cusp-slicer[state=done]", { timeout: 30_000 });
    await expect.poll(() => page.evaluate(() => customElements.get("cusp-view") !== undefined), { message: "cusp-view" }).toBe(true);
    // Its code has loaded, and reports that drawing is impossible here.
    await page.locator("cusp-view .unavailable").waitFor();
    const [file] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: /Download print file/ }).click(),
    ]);
    const beginning = file.suggestedFilename().endsWith(".goo") ? "V3.0" : "PK\u0003\u0004";
    expect((await readFile(await file.path())).subarray(0, 4).toString("latin1")).toBe(beginning);
    const globals = await page.evaluate(() => (document as unknown as { newGlobals(): string[] }).newGlobals());
    await look({ page, globals });
    expect(complaints).toEqual([]);
  } catch (error) {
    throw new Error([...complaints, String(error)].join("\n"), { cause: error });
  } finally {
    await context.close();
    await served.close();
  }
}
