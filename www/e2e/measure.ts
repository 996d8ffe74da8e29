/**
 * Measures how long the page takes from the drop of a model, and its memory: `npm run measure -- MODEL [HEIGHT_MM [RAYS [BACKEND]]]`. The
 * model is a file, `example`, which is the page's example with 111,600 facets, or a number: a ball of about that many facets.
 *
 * Each of five rounds, or as many as `--rounds` says, has a browser of its own, so that nothing is kept from the round before; the median
 * counts. On one page the model is only looked at, on the other the print file is downloaded as well, as soon as its plan is there. Somebody
 * takes a while to find a file: the drop is `--after` seconds after the page is there, 2 if it does not say.
 *
 * With `--against DIR`, the `dist` folder of another build, rounds of both alternate. A table then has their medians, and how many times
 * as much the other takes: the median over the pairs of rounds, so that a machine that becomes slower meanwhile slows down both.
 *
 * `--directions` measures the search for an orientation instead, `--cancel` how soon calls that are aborted end.
 */
import { readFile, readdir } from "node:fs/promises";
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

const USAGE = "usage: npm run measure -- MODEL [HEIGHT_MM [RAYS [BACKEND]]] [--against DIR] [--rounds N] [--after SECONDS] [--directions | --cancel]";
/** The longest run that is waited for, on a machine with other work. */
const PATIENCE_MS = 120_000;

/** What is measured, and how. */
interface Measured {
  file: DroppedFile;
  query: string;
  rounds: number;
  after_ms: number;
}

interface Round {
  layers: number;
  plan_ms: number;
  /** Until the first picture of the model is on the view's canvas. */
  view_ms: number;
  zip_ms: number;
  /** The most memory that the processes of pages have held; `undefined` where the system does not say. */
  megabytes: number | undefined;
  timings: string;
}

/** The figures of a round, by their names. */
const FIGURES: readonly (readonly [name: string, of: (round: Round) => number | undefined])[] = [
  ["drop to plan, ms", (it) => it.plan_ms],
  ["drop to view, ms", (it) => it.view_ms],
  ["drop to print file, ms", (it) => it.zip_ms],
  ["memory of the page, MB", (it) => it.megabytes],
  ["layers", (it) => it.layers],
];

export async function main(args: string[]): Promise<void> {
  const [text, flag] = [{ type: "string" }, { type: "boolean" }] as const;
  const options = { against: text, rounds: { ...text, default: "5" }, after: { ...text, default: "2" }, directions: flag, cancel: flag };
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
  await pages(folders, { file, query: `?backend=${backend}&height=${height}&rays=${rays}`, rounds, after_ms: 1000 * Number(values.after) });
}

async function fileOf(model: string): Promise<DroppedFile> {
  if (model === "example") return { name: model, bytes: binaryStl(finer(exampleTriangles())) };
  if (!(Number(model) > 0)) return { name: basename(model), bytes: await readFile(model) };
  const { bytes } = sphere(20, 2 * Math.round((1 + Math.sqrt(1 + Number(model))) / 2));
  return { name: `ball of ${(bytes.length - 84) / 50} facets`, bytes };
}

/** Measures the built page in each folder, round by round: one, or another build and ours. */
async function pages(folders: readonly string[], measured: Measured): Promise<void> {
  const served: Served[] = [];
  try {
    for (const folder of folders) served.push(await serve(folder));
    const builds = served.map(({ address }) => ({ address, rounds: [] as Round[] }));
    for (let i = 0; i <= measured.rounds; i++) {
      for (const { address, rounds } of i % 2 === 0 ? builds : builds.toReversed()) {
        const done = await apart(address, measured);
        // The first round of each warms the system's cache of files.
        if (i > 0) rounds.push(done);
        console.error(`round ${i} of ${measured.rounds}, ${address}: plan ${Math.round(done.plan_ms)} ms, view ${Math.round(done.view_ms)} ms, zip ${Math.round(done.zip_ms)} ms`);
      }
    }
    const [before, now] = builds;
    if (before !== undefined && now !== undefined) return await compare(folders, before, now, measured);
    const { rounds = [] } = before ?? {};
    for (const [name, of] of FIGURES) console.log(`${name.padEnd(24)} ${spread(rounds.map(of))}`);
    console.log(`of the first:  ${rounds[0]?.timings}`);
  } finally {
    await Promise.all(served.map((it) => it.close()));
  }
}

interface Build {
  address: string;
  rounds: readonly Round[];
}

/** Prints a table of what two builds took. */
async function compare(folders: readonly string[], before: Build, now: Build, { query, file }: Measured): Promise<void> {
  console.log(`${folders[0]} before, ${folders[1]} now\n`);
  console.log("| | before | now | before / now |\n|---|---:|---:|---:|");
  for (const [name, of] of FIGURES) {
    const [old, recent] = [before.rounds.map(of), now.rounds.map(of)];
    console.log(row(name, median(old), median(recent), median(old.map((value, i) => ratio(value, recent[i])))));
  }
  const [oldModules, modules] = [await wasmSizes(folders[0] ?? ""), await wasmSizes(folders[1] ?? "")];
  for (const name of new Set([...modules.keys(), ...oldModules.keys()])) {
    console.log(pair(`\`${name}\`, gzipped, KB`, oldModules.get(name), modules.get(name)));
  }
  console.log(pair("loaded before the 3-D view, beside the wasm, gzipped, KB", await loads(before.address + query, file), await loads(now.address + query, file)));
}

/** A round in a browser of its own, so that its memory is that of one page. */
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
    // Records, inside the page and by its own clock, when it reports that it is done.
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

/** Runs before the page's own scripts: records when the plan is shown, and when the view has the first picture of the model. */
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

/** Drops a model and waits for its plan and its picture, which nothing disturbs. */
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

/** The gzipped size of each module of a built page, in kilobytes, by its name. */
async function wasmSizes(folder: string): Promise<Map<string, number>> {
  const assets = join(folder, "assets");
  const sizes = new Map<string, number>();
  for (const file of (await readdir(assets)).sort()) {
    const name = /^(\w+?)(_bg)?-.*\.wasm$/.exec(file)?.[1];
    if (name !== undefined) sizes.set(name, gzipSync(await readFile(join(assets, file)), { level: 9 }).length / 1e3);
  }
  return sizes;
}

/** What the page loads before its 3-D view, in kilobytes: in another language than English, whose texts come with the rest. */
async function loads(address: string, file: DroppedFile): Promise<number> {
  const browser = await launch(SOFTWARE_GPU);
  try {
    const { page } = await open(browser, address, { locale: "de-DE" });
    const sizes = await beforeView(page);
    await page.reload();
    await state(page, "empty");
    await drop(page, file);
    await state(page, "done", PATIENCE_MS);
    // The last of it is the chart.
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

/** The middle value, of those that there are. */
function median(values: readonly (number | undefined)[]): number | undefined {
  const sorted = values.filter((it) => it !== undefined).sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}

const inMegabytes = (bytes: number | undefined): number | undefined => (bytes === undefined ? undefined : bytes / 1e6);

const ratio = (before?: number, now?: number): number | undefined =>
  before === undefined || now === undefined ? undefined : before / now;

const pair = (name: string, before?: number, now?: number): string => row(name, before, now, ratio(before, now), 1);

/** Times need no fraction, and memory neither. */
function row(name: string, before?: number, now?: number, times?: number, digits = 0): string {
  const figure = (value: number | undefined, digits: number): string => value?.toFixed(digits) ?? "–";
  return `| ${name} | ${figure(before, digits)} | ${figure(now, digits)} | ${figure(times, 2)} |`;
}
