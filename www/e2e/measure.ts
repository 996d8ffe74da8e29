/**
 * Measures the time of the page from the drop of a model, and its memory: `npm run measure -- MODEL [HEIGHT_MM [RAYS [BACKEND]]]`. The
 * model is a file, `example` for the page's example with 111,600 facets, or a number for a ball of about that many facets.
 *
 * Each of five rounds, or as many as given by `--rounds`, uses a new browser, so that no cache remains; the result is the median. On one
 * page the model is only viewed, on the other its print file is also downloaded, as soon as the plan is ready. The drop is `--after`
 * seconds after the page has loaded, 2 by default, since users take a while to find a file.
 *
 * With `--against DIR`, the `dist` folder of another build, rounds of both alternate. A table then has their medians, and the ratio of the
 * other build to ours: the median over the pairs of rounds, so that a machine that slows down meanwhile affects both.
 *
 * With `--native PROGRAM`, the command line plans and slices the same model between the rounds, with its 2048 rays, and ratios of
 * the page to it are printed.
 *
 * `--directions` measures the orientation search instead, `--cancel` the delay of aborted calls.
 */
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { gzipSync } from "node:zlib";
import type { Browser } from "playwright-core";
import { binaryStl, exampleTriangles } from "../src/page/example.js";
import { drop, launch, layers, open, SOFTWARE_GL, SOFTWARE_GPU, state, USUAL, visit, type DroppedFile } from "./browser.js";
import { beforeView, whole } from "./loaded.js";
import { cancels, directions } from "./measure-calls.js";
import { serve, type Served } from "./serve.js";
import { finer, sphere } from "./solids.js";
import { resident } from "./usage.js";

const USAGE = "usage: npm run measure -- MODEL [HEIGHT_MM [RAYS [BACKEND]]] [--against DIR] [--native PROGRAM] [--rounds N] [--after SECONDS] [--directions | --cancel]";
/** Timeout of a run, for a machine with other work. */
const PATIENCE_MS = 120_000;

/** Subject and options of a measurement. */
interface Measured {
  file: DroppedFile;
  query: string;
  rounds: number;
  after_ms: number;
  /** Times the command line on the same model. */
  native: () => Pick<Round, "native_plan_ms" | "native_zip_ms">;
}

interface Round {
  layers: number;
  plan_ms: number;
  /** Until the first picture of the model is on the view's canvas. */
  view_ms: number;
  zip_ms: number;
  /** Peak memory of the page processes; undefined if the system does not report it. */
  megabytes: number | undefined;
  /** Times of the command line, from its start to its end; undefined if it was not asked for. */
  native_plan_ms?: number;
  native_zip_ms?: number;
  timings: string;
}

/** Figures of a round, by name. */
const FIGURES: readonly (readonly [name: string, of: (round: Round) => number | undefined])[] = [
  ["drop to plan, ms", (it) => it.plan_ms],
  ["drop to view, ms", (it) => it.view_ms],
  ["drop to print file, ms", (it) => it.zip_ms],
  ["memory of the page, MB", (it) => it.megabytes],
  ["layers", (it) => it.layers],
  ["native plan, ms", (it) => it.native_plan_ms],
  ["native print file, ms", (it) => it.native_zip_ms],
  ["plan, page / native, %", (it) => ratio(100 * it.plan_ms, it.native_plan_ms)],
  ["print file, page / native, %", (it) => ratio(100 * it.zip_ms, it.native_zip_ms)],
];

export async function main(args: string[]): Promise<void> {
  const [text, flag] = [{ type: "string" }, { type: "boolean" }] as const;
  const options = { against: text, native: text, rounds: { ...text, default: "5" }, after: { ...text, default: "2" }, directions: flag, cancel: flag };
  const { positionals, values } = parseArgs({ args, allowPositionals: true, options });
  const [model, height = "60", rays = "2048", backend = "auto"] = positionals;
  if (model === undefined) throw new Error(USAGE);
  const file = await fileOf(model);
  const rounds = Number(values.rounds);
  console.log(`${file.name}, ${height} mm high, ${rays} rays, backend ${backend}, ${rounds} rounds`);
  if (values.directions) return directions(file.bytes, Number(height), rounds);
  if (values.cancel) return cancels(file.bytes, Number(height), rounds);
  const folders = [fileURLToPath(new URL("../dist", import.meta.url))];
  if (values.against !== undefined) folders.unshift(resolve(values.against));
  const query = `?backend=${backend}&height=${height}&rays=${rays}`;
  const scratch = await mkdtemp(join(tmpdir(), "cusp-measure-"));
  try {
    const native = values.native === undefined ? () => ({}) : await commandLine(resolve(values.native), file, scratch, ["--height", height]);
    await pages(folders, { file, query, rounds, after_ms: 1000 * Number(values.after), native });
  } finally {
    await rm(scratch, { recursive: true });
  }
}

/** Returns a function that times the command line. */
async function commandLine(program: string, file: DroppedFile, scratch: string, options: string[]): Promise<Measured["native"]> {
  const model = join(scratch, "model.stl");
  await writeFile(model, file.bytes);
  const time = (...args: string[]): number => {
    const start = performance.now();
    execFileSync(program, [...args, model, ...options], { stdio: "ignore" });
    return performance.now() - start;
  };
  return () => ({ native_plan_ms: time("plan"), native_zip_ms: time("slice", "-o", join(scratch, "model.zip")) });
}

async function fileOf(model: string): Promise<DroppedFile> {
  if (model === "example") return { name: model, bytes: binaryStl(finer(exampleTriangles())) };
  if (!(Number(model) > 0)) return { name: basename(model), bytes: await readFile(model) };
  const { bytes } = sphere(20, 2 * Math.round((1 + Math.sqrt(1 + Number(model))) / 2));
  return { name: `ball of ${(bytes.length - 84) / 50} facets`, bytes };
}

/** Measures the built page in each folder, in alternate rounds: one build, or another and ours. */
async function pages(folders: readonly string[], measured: Measured): Promise<void> {
  const served: Served[] = [];
  try {
    for (const folder of folders) served.push(await serve(folder));
    const builds = served.map(({ address }) => ({ address, rounds: [] as Round[] }));
    for (let i = 0; i <= measured.rounds; i++) {
      for (const { address, rounds } of i % 2 === 0 ? builds : builds.toReversed()) {
        const done = { ...(await apart(address, measured)), ...measured.native() };
        // The first round of each warms the system's file cache.
        if (i > 0) rounds.push(done);
        console.error(`round ${i} of ${measured.rounds}, ${address}: plan ${Math.round(done.plan_ms)} ms, view ${Math.round(done.view_ms)} ms, zip ${Math.round(done.zip_ms)} ms`);
      }
    }
    const [before, now] = builds;
    if (before !== undefined && now !== undefined) return await compare(folders, before, now, measured);
    const { rounds = [] } = before ?? {};
    for (const [name, of] of FIGURES) {
      const values = rounds.map(of);
      if (values.some((it) => it !== undefined)) console.log(`${name.padEnd(28)} ${spread(values)}`);
    }
    console.log(`of the first:  ${rounds[0]?.timings}`);
  } finally {
    await Promise.all(served.map((it) => it.close()));
  }
}

interface Build {
  address: string;
  rounds: readonly Round[];
}

/** Prints a table that compares two builds. */
async function compare(folders: readonly string[], before: Build, now: Build, { query, file }: Measured): Promise<void> {
  console.log(`${folders[0]} before, ${folders[1]} now\n`);
  console.log("| | before | now | before / now |\n|---|---:|---:|---:|");
  for (const [name, of] of FIGURES) {
    const [old, recent] = [before.rounds.map(of), now.rounds.map(of)];
    if (recent.every((it) => it === undefined)) continue;
    console.log(row(name, median(old), median(recent), median(old.map((value, i) => ratio(value, recent[i])))));
  }
  const [oldModules, modules] = [await wasmSizes(folders[0] ?? ""), await wasmSizes(folders[1] ?? "")];
  for (const name of new Set([...modules.keys(), ...oldModules.keys()])) {
    console.log(pair(`\`${name}\`, gzipped, KB`, oldModules.get(name), modules.get(name)));
  }
  console.log(pair("loaded before the 3-D view, beside the wasm, gzipped, KB", await loads(before.address + query, file), await loads(now.address + query, file)));
}

/** A round in a new browser, whose memory is then that of one page. */
async function apart(address: string, measured: Measured): Promise<Round> {
  const browser = await launch(SOFTWARE_GL);
  try {
    return await round(browser, address, measured);
  } finally {
    await browser.close();
  }
}

async function round(browser: Browser, address: string, { file, query, after_ms }: Measured): Promise<Round> {
  const looked = await look(browser, address + query, file, after_ms);
  const { page } = await open(browser, address + query);
  try {
    await page.waitForTimeout(after_ms);
    // Records its completion inside the page, by its own clock.
    await page.evaluate(() => {
      const app = document.querySelector("cusp-workbench");
      const root = document.documentElement;
      if (app === null) throw new Error("there is no page");
      new MutationObserver(() => {
        if (app.getAttribute("state") !== "done") return;
        if (root.dataset["plan"] === undefined) {
          root.dataset["plan"] = String(performance.now());
          app.shadowRoot?.querySelector<HTMLButtonElement>(".download")?.click();
        } else {
          root.dataset["zip"] ??= String(performance.now());
        }
      }).observe(app, { attributeFilter: ["state"] });
    });
    const saved = page.waitForEvent("download", { timeout: PATIENCE_MS });
    const dropped = await drop(page, file);
    await saved;
    await state(page, "done", PATIENCE_MS);
    const moment = async (name: string): Promise<number> =>
      Number(await page.locator("html").getAttribute(`data-${name}`)) - dropped;
    return {
      ...looked,
      layers: await layers(page),
      zip_ms: await moment("zip"),
      megabytes: inMegabytes(await resident(browser, "VmHWM")),
      timings: (await page.locator("details.quiet").first().evaluate((it) => it.textContent)).replace(/\s+/g, " ").trim(),
    };
  } finally {
    await page.context().close();
  }
}

/** Runs before the page's own scripts: records when the plan is shown, and when the view shows the first picture of the model. */
function watch(facets: number): void {
  const note = (name: string): string => (document.documentElement.dataset[name] ??= String(performance.now()));
  let isDrawn = false;
  const drawn = (gl: WebGL2RenderingContext, corners: number): void => {
    isDrawn ||= corners >= 3 * facets;
    // A large model is drawn offscreen first.
    if (isDrawn && gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) === null) note("view");
  };
  const { drawArrays, drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawArrays = function (mode, first, count) {
    drawArrays.call(this, mode, first, count);
    drawn(this, count);
  };
  WebGL2RenderingContext.prototype.drawElements = function (mode, count, type, offset) {
    drawElements.call(this, mode, count, type, offset);
    drawn(this, 0);
  };
  new MutationObserver(() => {
    const app = document.querySelector("cusp-workbench");
    if (app?.getAttribute("state") === "done") note("plan");
  }).observe(document, { subtree: true, attributeFilter: ["state"] });
}

/** Drops a model and waits, undisturbed, for its plan and its picture. */
async function look(browser: Browser, address: string, file: DroppedFile, after_ms: number): Promise<Pick<Round, "plan_ms" | "view_ms">> {
  const context = await browser.newContext(USUAL);
  try {
    const page = await context.newPage();
    await page.addInitScript(watch, (file.bytes.length - 84) / 50);
    await visit(page, address);
    await page.waitForTimeout(after_ms);
    const dropped = await drop(page, file);
    await state(page, "done", PATIENCE_MS);
    const moment = async (name: string): Promise<number> => Number(await page.locator(`html[data-${name}]`).getAttribute(`data-${name}`)) - dropped;
    return { plan_ms: await moment("plan"), view_ms: await moment("view") };
  } finally {
    await context.close();
  }
}

/** Gzipped size of each module of a built page, in kilobytes, by name. */
async function wasmSizes(folder: string): Promise<Map<string, number>> {
  const assets = join(folder, "assets");
  const sizes = new Map<string, number>();
  for (const file of (await readdir(assets)).sort()) {
    const name = /^(\w+?)(_bg)?-.*\.wasm$/.exec(file)?.[1];
    if (name !== undefined) sizes.set(name, gzipSync(await readFile(join(assets, file)), { level: 9 }).length / 1e3);
  }
  return sizes;
}

/** Download before the 3-D view, in kilobytes, in a language other than English, so as to include its texts. */
async function loads(address: string, file: DroppedFile): Promise<number> {
  const browser = await launch(SOFTWARE_GPU);
  try {
    const { page } = await open(browser, address, { locale: "de-DE" });
    const sizes = await beforeView(page);
    await page.reload();
    await state(page, "empty");
    await drop(page, file);
    await state(page, "done", PATIENCE_MS);
    // The chart is loaded last.
    await page.waitForSelector(".u-over");
    return whole(sizes) / 1e3;
  } finally {
    await browser.close();
  }
}

function spread(values: readonly (number | undefined)[]): string {
  const sorted = values.filter((it) => it !== undefined).map(Math.round).sort((a, b) => a - b);
  return `${sorted[Math.floor(sorted.length / 2)]} (${sorted[0]} to ${sorted.at(-1)})`;
}

/** Median of the defined values. */
function median(values: readonly (number | undefined)[]): number | undefined {
  const sorted = values.filter((it) => it !== undefined).sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}

const inMegabytes = (bytes: number | undefined): number | undefined => (bytes === undefined ? undefined : bytes / 1e6);

const ratio = (before?: number, now?: number): number | undefined =>
  before === undefined || now === undefined ? undefined : before / now;

const pair = (name: string, before?: number, now?: number): string => row(name, before, now, ratio(before, now), 1);

/** Times and memory need no fraction. */
function row(name: string, before?: number, now?: number, times?: number, digits = 0): string {
  const figure = (value: number | undefined, digits: number): string => value?.toFixed(digits) ?? "–";
  return `| ${name} | ${figure(before, digits)} | ${figure(now, digits)} | ${figure(times, 2)} |`;
}
