/**
 * Measures how long the page takes from the drop of a model: `npm run measure -- FILE.stl [HEIGHT_MM [RAYS [BACKEND]]]`.
 *
 * Each round has a fresh page, so that nothing is kept from the round before; the median counts.
 */
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import type { Browser } from "playwright-core";
import { drop, launch, layers, open, state } from "./browser.js";
import { serve } from "./serve.js";

const ROUNDS = 5;

interface Round {
  layers: number;
  plan_ms: number;
  zip_ms: number;
  timings: string;
}

export async function main([file, height = "60", rays = "2048", backend = "auto"]: string[]): Promise<void> {
  if (file === undefined) throw new Error("usage: npm run measure -- FILE.stl [HEIGHT_MM [RAYS [BACKEND]]]");
  const bytes = await readFile(file);
  const served = await serve();
  const browser = await launch();
  try {
    const rounds: Round[] = [];
    const address = `${served.address}?backend=${backend}&height=${height}&rays=${rays}`;
    for (let i = 0; i < ROUNDS; i++) rounds.push(await round(browser, address, { name: basename(file), bytes }));
    const first = rounds[0];
    console.log(`${basename(file)}, ${height} mm high, ${rays} rays, backend ${backend}, ${ROUNDS} rounds`);
    console.log(`layers         ${first?.layers}`);
    console.log(`drop to plan   ${spread(rounds.map(({ plan_ms }) => plan_ms))}`);
    console.log(`drop to zip    ${spread(rounds.map(({ zip_ms }) => zip_ms))} (download pressed as soon as the plan is there)`);
    console.log(`of the first:  ${first?.timings}`);
  } finally {
    await browser.close();
    await served.close();
  }
}

async function round(browser: Browser, address: string, file: { name: string; bytes: Uint8Array }): Promise<Round> {
  const { page } = await open(browser, address);
  try {
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
    const saved = page.waitForEvent("download");
    const dropped = await drop(page, file);
    await saved;
    await state(page, "done");
    const moment = async (name: string): Promise<number> =>
      Number(await page.locator("html").getAttribute(`data-${name}`)) - dropped;
    return {
      layers: await layers(page),
      plan_ms: await moment("plan"),
      zip_ms: await moment("zip"),
      timings: (await page.locator("details.quiet").first().evaluate((it) => it.textContent)).replace(/\s+/g, " ").trim(),
    };
  } finally {
    await page.context().close();
  }
}

function spread(values: number[]): string {
  const sorted = values.map(Math.round).sort((a, b) => a - b);
  return `${sorted[Math.floor(sorted.length / 2)]} ms (${sorted[0]} to ${sorted.at(-1)})`;
}
