/** Third-party pages with the package for a test file: one server for all. Fails on unexpected errors at the end. */
import type { BrowserContextOptions, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect } from "vitest";
import { servePacked } from "./packed.js";
import type { Served } from "./serve.js";
import { tabs } from "./tabs.js";

export interface PackedPages {
  /** Opens the page with this body, and waits for its `data-ready`. */
  start(body: string, options?: BrowserContextOptions): Promise<Page>;
  /** Errors of the pages since last taken. A test that leaves any fails. */
  complaints: string[];
}

/** Call once at the top of a test file. `files` are those of {@link servePacked}. */
export function packedPages(files: Readonly<Record<string, string | Uint8Array>>, locale: string, flags?: readonly string[]): PackedPages {
  let served: Served;
  const own = tabs(flags);
  const complaints: string[] = [];

  beforeAll(async () => {
    served = await servePacked(files);
  }, 120_000);

  afterAll(() => served.close());

  afterEach(async ({ task }) => {
    await own.giveBack(task.result?.state === "fail");
    expect(complaints.splice(0)).toEqual([]);
  });

  const start = async (body: string, options: BrowserContextOptions = {}): Promise<Page> => {
    const page = await own.take({ locale, ...options });
    page.on("pageerror", (error) => complaints.push(error.message));
    page.on("console", (message) => {
      if (message.type() === "error") complaints.push(message.text());
    });
    await page.goto(served.address);
    await page.waitForSelector("body[data-ready]", { state: "attached" });
    // Through a range, since the policy also applies to generated markup.
    await page.evaluate((body) => document.body.append(document.createRange().createContextualFragment(body)), body);
    return page;
  };
  return { start, complaints };
}
