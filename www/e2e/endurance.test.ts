/**
 * Hundreds of jobs in one tab take no more memory than the first ones: twenty models in turn, each read, planned, looked at and
 * written into a print file. 80 jobs, or 2,000 by `npm run endurance`.
 */
import { expect, test } from "vitest";
import { pages } from "./pages.js";
import { cup, floating, objOf, prism, sealed, sphere, threeMfOf } from "./solids.js";
import { megabytes, resident, said, watchUsage, type Usage } from "./usage.js";
import { SOFTWARE_GL } from "./view-pages.js";

const JOBS = process.env["ENDURANCE"] === undefined ? 80 : 2000;
/** After so many jobs, each model with each of the settings, all that is made once exists. The tenth job would be too early. */
const WARM = 40;
/** How often memory is looked at, jobs. */
const EVERY = JOBS / 5;
/** All panels of a wide page, and a view that software draws quickly. */
const VIEWPORT = { width: 1280, height: 400 };
/** The browser compiles what is called often: 1.3 MB in the first few hundred jobs, and little afterwards. */
const CODE_BYTES = 2.5e6;
/** Ports that carried progress are freed only when the worker's own garbage collector runs. */
const LISTENER_SLACK = 100;

/** What a user chooses before a round of all models: zips of masks, or files of a printer. */
const SETTINGS = ["rays=128", "rays=128&printer=mars-4-ultra&metric=area"];

/** Twenty models of several kinds and sizes, in all formats, as files. */
function models(): { name: string; bytes: Uint8Array }[] {
  const balls = [1, 1.5, 2, 2.5].map((radius, i) => sphere(radius, 32 + 16 * i).bytes);
  const blocks = [3, 4, 5, 6].map((side) => prism(side, 8 - side).bytes);
  const cups = [4, 5, 6].map((side) => cup(side, side / 2, 1));
  const apart = [1, 1.5].map((side) => floating(side, 0.5));
  const closed = [3, 4].map((side) => sealed(side, 1));
  const plain = [...balls, ...blocks, ...cups, ...apart, ...closed, prism(1, 4).bytes];
  return [
    ...plain.map((bytes, i) => ({ name: `${i}.stl`, bytes })),
    ...plain.slice(0, 2).map((bytes, i) => ({ name: `${i}.obj`, bytes: objOf(bytes) })),
    ...plain.slice(2, 4).map((bytes, i) => ({ name: `${i}.3mf`, bytes: threeMfOf(bytes) })),
  ];
}

declare global {
  interface Window {
    models: { name: string; bytes: Blob }[];
  }
}

/** Runs in the page: a job for each model, with these settings. Returns what each made, in short. */
async function round(query: string): Promise<string[]> {
  const element = document.querySelector("cusp-workbench");
  if (element === null) throw new Error("there is no page");
  element.query = query;
  if (element.model !== null) await element.plan();
  const made: string[] = [];
  for (const { name, bytes } of window.models) {
    // Like a file that somebody drops: bytes of its own.
    await element.load(new File([await bytes.arrayBuffer()], name));
    const { report } = await element.plan();
    const { bits } = await element.slicer.mask(report.layers >> 1);
    const { blob } = await element.export();
    const sums = await Promise.all([new Uint8Array(bits), await blob.arrayBuffer()].map((it) => crypto.subtle.digest("SHA-256", it)));
    made.push([name, report.layers, ...sums.map((sum) => new Uint8Array(sum).join("."))].join(" "));
  }
  return made;
}

const start = pages(SOFTWARE_GL);

test("hundreds of jobs in one tab take no more memory than the first ones", async () => {
  const page = await start("", { viewport: VIEWPORT }, true);
  const usage = await watchUsage(page);
  const files = models();
  await page.route("**/e2e-models/*", (route) => {
    const file = files[Number(route.request().url().split("/").at(-1))];
    return route.fulfill({ body: Buffer.from(file?.bytes ?? []), contentType: "application/octet-stream" });
  });
  await page.evaluate(
    async (names) => {
      const fetched = names.map(async (name, i) => ({ name, bytes: await (await fetch(`e2e-models/${i}`)).blob() }));
      window.models = await Promise.all(fetched);
    },
    files.map(({ name }) => name),
  );

  const first: string[][] = [];
  const used: Usage[] = [];
  for (let done = 0; done < JOBS; ) {
    const turn = (done / files.length) % SETTINGS.length;
    const made = await page.evaluate(round, SETTINGS[turn] ?? "");
    // A job makes what it made at first.
    expect(made).toEqual((first[turn] ??= made));
    done += files.length;
    if (done !== WARM && done % EVERY !== 0) continue;
    const now = await usage();
    used.push(now);
    const bytes = await resident(page.context().browser(), "VmRSS");
    console.log(`${done} jobs: ${said(now)}, ${bytes === undefined ? "" : `process of ${megabytes(bytes)} MB`}`);
  }

  const [early, late] = [used[0], used.at(-1)];
  if (early === undefined || late === undefined) throw new Error("nothing was measured");
  const inAll = ({ heap, core }: Usage): number => core.reduce((sum, bytes) => sum + bytes, heap);
  expect(inAll(late)).toBeLessThan(1.1 * inAll(early));
  expect(late.heap).toBeLessThan(early.heap + CODE_BYTES);
  expect(late.nodes).toBeLessThan(1.1 * early.nodes);
  expect(late.listeners).toBeLessThan(1.1 * early.listeners + LISTENER_SLACK);
  expect(late.contexts).toBe(early.contexts);
  expect(late.core).toHaveLength(early.core.length);
  for (const [i, bytes] of late.core.entries()) expect(bytes, `of worker ${i}`).toBeLessThan(1.1 * (early.core[i] ?? 0));
}, 60_000 + 2000 * JOBS);
